/*
 * The map: @WIDTH@ columns, @HEIGHT@ rows of @LATTICE@, @FREE@ cells free. 1 is an obstacle; two rows and columns
 * of obstacles lie around it, as ac_map in activecell.h asks for.
 */
#include "activecell.h"

static const uint32_t rows[@LENGTH@] = {
@ROWS@};

const ac_map ac_floor = { rows, AC_FLOOR_WIDTH, AC_FLOOR_HEIGHT, @WORDS@U };
