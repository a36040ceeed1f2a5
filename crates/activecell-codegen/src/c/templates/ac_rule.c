/*
 * The published rule: which neighbour becomes the next active cell.
 *
 * After Alzoubi and Miraz, Enhancing Robot Navigation Efficiency Using Cellular Automata with Active
 * Cells.
 */
#include "activecell.h"
#include "ac_bit.h"

@DECIDE_FUNCTION@
@LANE_FUNCTION@
/* How far two numbers are apart. */
static uint32_t apart(uint32_t a, uint32_t b)
{
    uint32_t difference = a - b;
    if (a < b) {
        difference = b - a;
    }
    return difference;
}

/* 1 if the first of two numbers is less. They are below 2^31. */
static uint32_t less(uint32_t a, uint32_t b)
{
    return (a - b) >> 31U;
}

/* Where the second of two numbers lies: 0 if they are equal, 1 if it is greater, 2 if it is less. */
static uint32_t side(uint32_t a, uint32_t b)
{
    return less(a, b) + (2U * less(b, a));
}

@GEOMETRY@
ac_cell ac_neighbour(ac_cell cell, ac_move direction)
{
    /* Columns and rows to the right and down, and one more. */
    static const uint8_t right[@PARITIES@][AC_DIRECTIONS] = @RIGHT@;
    static const uint8_t down[AC_DIRECTIONS] = @DOWN@;
    ac_cell next = cell;
    if (direction < AC_DIRECTIONS) {
        const uint32_t x = ((uint32_t)cell.x + right[@PARITY@][direction]) - 1U;
        const uint32_t y = ((uint32_t)cell.y + down[direction]) - 1U;
        next.x = (uint16_t)x;
        next.y = (uint16_t)y;
    }
    return next;
}

/* The word in which a cell of the map lies, and its place there. */
static uint32_t word_of(const ac_map *map, ac_cell cell)
{
    return (((uint32_t)cell.y + 2U) * map->words) + (((uint32_t)cell.x + 2U) >> 5U);
}

static uint32_t shift_of(ac_cell cell)
{
    return ((uint32_t)cell.x + 2U) & 31U;
}

bool ac_is_free(const ac_map *map, ac_cell cell)
{
    bool is_free = false;
    if ((cell.x < map->width) && (cell.y < map->height)) {
        const uint32_t word = map->rows[word_of(map, cell)];
        is_free = ((word >> shift_of(cell)) & 1U) == 0U;
    }
    return is_free;
}

bool ac_map_set(uint32_t *rows, const ac_map *map, ac_cell cell, bool is_obstacle)
{
    const bool is_inside = (cell.x < map->width) && (cell.y < map->height);
    if (is_inside) {
        const uint32_t bit = (uint32_t)1U << shift_of(cell);
        uint32_t *const word = &rows[word_of(map, cell)];
        *word = is_obstacle ? (*word | bit) : (*word & ~bit);
    }
    return is_inside;
}

/* A cell of a row. */
static uint32_t at(uint32_t row, uint32_t bit)
{
    return (row >> bit) & 1U;
}

/* Lanes, each moved to the next, and a cell of a row in the lowest. */
static uint32_t with(uint32_t lanes, uint32_t row, uint32_t bit)
{
    return (lanes << 1U) | at(row, bit);
}

uint32_t ac_window(const ac_map *map, ac_cell cell)
{
    const uint32_t words = map->words;
    /* From two rows above and two columns to the left, as the map begins with two of obstacles. */
@SLICES@
    /* The lanes, the last one first. */
@WINDOW@
    return ring1 | (ahead << 8U) | (between << 16U);
}

ac_move ac_decide(uint32_t window, uint32_t bearing)
{
    const ac_decide_@NAME@_outputs outputs = ac_decide_@NAME@(
        window & @ONES@,
        (window >> 8U) & @ONES@,
        (window >> 16U) & @ONES@,
        bearing & AC_SECTOR,
        ac_bit((bearing & AC_NEAR) != 0U));
    return (outputs.enclosed != 0U) ? AC_ENCLOSED : ac_lane_number(outputs.go);
}

ac_move ac_next(const ac_map *map, ac_cell cell, ac_cell target)
{
    ac_move move = AC_OUTSIDE;
    if ((cell.x < map->width) && (cell.y < map->height)) {
        move = AC_ARRIVED;
        if ((cell.x != target.x) || (cell.y != target.y)) {
            move = ac_decide(ac_window(map, cell), ac_bearing(cell, target));
        }
    }
    return move;
}

void ac_replay_start(ac_replay *replay, const ac_map *map, ac_cell from, ac_cell target)
{
    replay->map = map;
    replay->cell = from;
    replay->target = target;
    replay->mark = from;
    replay->since = 0U;
    replay->until = 1U;
}

/*
 * The rule has no memory, so a robot that comes back to a cell circles for ever. One cell is
 * remembered, and another one instead of it after 1, 2, 4, 8, ... steps: R. Brent, An Improved Monte
 * Carlo Factorization Algorithm, BIT 20, 1980.
 */
ac_move ac_replay_step(ac_replay *replay)
{
    ac_move move = ac_next(replay->map, replay->cell, replay->target);
    if (move < AC_DIRECTIONS) {
        const ac_cell next = ac_neighbour(replay->cell, move);
        if (replay->since == replay->until) {
            replay->mark = replay->cell;
            replay->since = 0U;
            replay->until *= 2U;
        }
        if ((next.x == replay->mark.x) && (next.y == replay->mark.y)) {
            move = AC_TRAPPED;
        } else {
            replay->cell = next;
            replay->since += 1U;
        }
    }
    return move;
}
