/*
 * The program M as segments: @COUNT@ straight runs and turns.
 */
#include "activecell.h"

const ac_segment ac_program[AC_PROGRAM_COUNT] = {
@SEGMENTS@};
