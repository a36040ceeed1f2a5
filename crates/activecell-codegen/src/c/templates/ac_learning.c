/*
 * The rule that learns: each cell keeps a level, at first its distance to the target, which only rises.
 * The robot raises that of its cell above the lowest of its free neighbours and moves to the lowest.
 *
 * LRTA*: R. Korf, Real-Time Heuristic Search, Artificial Intelligence 42, 1990. The table is
 * open-addressed: an entry lies at the place that its cell's hash says, or at the next vacant one.
 */
#include "activecell.h"

#define VACANT 0xFFFFFFFFU
#define VISITED 1U

bool ac_learning_start(ac_learning *learning, const ac_map *map, ac_cell target, ac_level *levels,
                       uint32_t capacity)
{
    const bool is_power = (capacity > 1U) && ((capacity & (capacity - 1U)) == 0U);
    if (is_power) {
        uint32_t place;
        for (place = 0U; place < capacity; ++place) {
            levels[place].cell = VACANT;
            levels[place].learnt = 0U;
        }
        learning->map = map;
        learning->levels = levels;
        learning->capacity = capacity;
        learning->used = 0U;
        learning->frontier = 0U;
        learning->farthest = 0U;
        learning->target = target;
    }
    return is_power;
}

/* The place of a cell's entry, or of the vacant one where it would lie. One entry is always vacant. */
static uint32_t place_of(const ac_learning *learning, ac_cell cell)
{
    const uint32_t key = ((uint32_t)cell.y << 16U) | cell.x;
    /*
     * The product with 2^32 divided by the golden ratio, its upper half folded in: D. Knuth, Searching
     * and Sorting.
     */
    const uint32_t product = key * 2654435769U;
    const uint32_t ones = learning->capacity - 1U;
    uint32_t place = (product ^ (product >> 16U)) & ones;
    while ((learning->levels[place].cell != key) && (learning->levels[place].cell != VACANT)) {
        place = (place + 1U) & ones;
    }
    return place;
}

/* Takes a free cell into the table, as seen and not visited. False if the table is full. */
static bool see(ac_learning *learning, ac_cell cell)
{
    const uint32_t place = place_of(learning, cell);
    bool is_known = true;
    if (learning->levels[place].cell == VACANT) {
        is_known = learning->used < (learning->capacity - 1U);
        if (is_known) {
            const uint32_t distance = ac_distance(cell, learning->target);
            learning->levels[place].cell = ((uint32_t)cell.y << 16U) | cell.x;
            learning->used += 1U;
            learning->frontier += 1U;
            if (distance > learning->farthest) {
                learning->farthest = distance;
            }
        }
    }
    return is_known;
}

/* Visits a cell: takes it and its free neighbours into the table. False if the table is full. */
static bool visit(ac_learning *learning, ac_cell cell)
{
    bool is_known = see(learning, cell);
    if (is_known) {
        const uint32_t place = place_of(learning, cell);
        if ((learning->levels[place].learnt & VISITED) == 0U) {
            ac_move direction;
            for (direction = 0U; direction < AC_DIRECTIONS; ++direction) {
                const ac_cell next = ac_neighbour(cell, direction);
                if (ac_is_free(learning->map, next)) {
                    is_known = see(learning, next) ? is_known : false;
                }
            }
            if (is_known) {
                learning->levels[place].learnt |= VISITED;
                learning->frontier -= 1U;
            }
        }
    }
    return is_known;
}

/* The level of a cell that was seen. */
static uint32_t level_of(const ac_learning *learning, ac_cell cell)
{
    const uint32_t learnt = learning->levels[place_of(learning, cell)].learnt >> 1U;
    return ac_distance(cell, learning->target) + learnt;
}

/*
 * The free neighbour of the lowest level, of equals the first in the order of the rule; raises the
 * cell's own level. AC_UNREACHABLE if that shows that no way leads on.
 */
static ac_move lowest(ac_learning *learning, ac_cell cell)
{
    static const uint8_t order[@SECTORS@][AC_DIRECTIONS] = {
@ORDER@    };
    const uint32_t sector = ac_bearing(cell, learning->target) & AC_SECTOR;
    const uint32_t distance = ac_distance(cell, learning->target);
    ac_level *const own = &learning->levels[place_of(learning, cell)];
    ac_move move = AC_UNREACHABLE;
    uint32_t least = 0xFFFFFFFFU;
    uint32_t place;
    for (place = 0U; place < AC_DIRECTIONS; ++place) {
        const ac_cell next = ac_neighbour(cell, order[sector][place]);
        if (ac_is_free(learning->map, next)) {
            const uint32_t level = level_of(learning, next);
            if (level < least) {
                least = level;
                move = order[sector][place];
            }
        }
    }
    if ((move < AC_DIRECTIONS) && ((least + 1U) > distance)) {
        const uint32_t raised = (2U * ((least + 1U) - distance)) | VISITED;
        if (raised > own->learnt) {
            own->learnt = raised;
        }
    }
    /*
     * Levels never exceed the steps to a cell not yet visited and its distance from there: if one does,
     * there is none that can be reached. Cells that were seen free may have been closed since.
     */
    if ((move < AC_DIRECTIONS) && (least >= (learning->used + learning->farthest))) {
        move = AC_UNREACHABLE;
    }
    return move;
}

ac_move ac_learning_step(ac_learning *learning, ac_cell cell)
{
    ac_move move;
    if ((cell.x >= learning->map->width) || (cell.y >= learning->map->height)) {
        move = AC_OUTSIDE;
    } else if (ac_distance(cell, learning->target) == 0U) {
        move = AC_ARRIVED;
    } else if (!visit(learning, cell)) {
        move = AC_FULL;
    } else if (learning->frontier == 0U) {
        /* All cells of the part of the floor where the robot is were visited. */
        move = AC_UNREACHABLE;
    } else {
        move = lowest(learning, cell);
    }
    return move;
}
