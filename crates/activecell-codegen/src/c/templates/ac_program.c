/*
 * The program M as segments: @COUNT@ straight runs and turns, from @FROM@ to @TO@.
 * @START@
 *
@ROBOT@
 */
#include "activecell.h"

const ac_segment ac_program[@LENGTH@] = {
@SEGMENTS@};
