/*
 * The map: @WIDTH@ columns and @HEIGHT@ rows of @LATTICE@.
 * @FREE@ cells are free (0). Around it lie two rows and columns of obstacles, as ac_map in activecell.h
 * says.
 */
#include "activecell.h"

static const uint32_t rows[@LENGTH@] = {
@ROWS@};

const ac_map ac_floor = { rows, AC_FLOOR_WIDTH, AC_FLOOR_HEIGHT, @WORDS@U };
