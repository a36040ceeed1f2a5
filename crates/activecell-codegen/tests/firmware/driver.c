/*
 * Puts the firmware to the test: reads numbers, writes numbers, all of 32 bits; what they should be the caller knows.
 */
#include "activecell.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static uint32_t get(void)
{
    uint32_t number = 0U;
    if (fread(&number, sizeof number, 1U, stdin) != 1U) {
        exit(2);
    }
    return number;
}

static void put(uint32_t number)
{
    (void)fwrite(&number, sizeof number, 1U, stdout);
}

static ac_cell get_cell(void)
{
    ac_cell cell;
    cell.x = (uint16_t)get();
    cell.y = (uint16_t)get();
    return cell;
}

static void put_cell(ac_cell cell)
{
    put(((uint32_t)cell.y << 16U) | cell.x);
}

static uint32_t *words(uint32_t count)
{
    uint32_t *const memory = malloc((size_t)count * sizeof *memory);
    if (memory == NULL) {
        exit(3);
    }
    return memory;
}

/* Every neighbourhood, in the order of the core's bits; every sector; far and near. A byte each. */
static void decide(void)
{
    uint32_t bits;
    for (bits = 0U; bits < (1UL << (3U * AC_DIRECTIONS)); ++bits) {
        uint32_t window = bits & ((1U << AC_DIRECTIONS) - 1U);
        uint32_t sector;
        uint32_t place;
        for (place = 0U; place < AC_DIRECTIONS; ++place) {
            window |= ((bits >> (AC_DIRECTIONS + (2U * place))) & 1U) << (8U + place);
            window |= ((bits >> (AC_DIRECTIONS + (2U * place) + 1U)) & 1U) << (16U + place);
        }
        for (sector = 0U; sector < (2U * AC_DIRECTIONS); ++sector) {
            (void)putchar((int)ac_decide(window, sector));
            (void)putchar((int)ac_decide(window, sector | AC_NEAR));
        }
    }
}

/* Every state, also those that are none, and every input. */
static void control(void)
{
    uint32_t state;
    for (state = 0U; state < 8U; ++state) {
        uint32_t inputs;
        for (inputs = 0U; inputs < 256U; ++inputs) {
            put(ac_control_step(state, inputs));
            put(ac_control_outputs(state));
        }
    }
}

/* All pairs of a cell in the middle of an even or odd row and another one: sector, distance, neighbours. */
static void sectors(void)
{
    const uint32_t side = get();
    uint32_t row;
    for (row = 0U; row < 2U; ++row) {
        const ac_cell from = { (uint16_t)(side / 2U), (uint16_t)((side / 2U) + row) };
        ac_cell to;
        uint32_t direction;
        for (direction = 0U; direction < AC_DIRECTIONS; ++direction) {
            put_cell(ac_neighbour(from, direction));
        }
        for (to.y = 0U; to.y < side; ++to.y) {
            for (to.x = 0U; to.x < side; ++to.x) {
                put(ac_bearing(from, to));
                put(ac_distance(from, to));
            }
        }
    }
}

static ac_map get_map(void)
{
    ac_map map;
    uint32_t *rows;
    uint32_t length;
    uint32_t word;
    map.width = get();
    map.height = get();
    map.words = (map.width + 4U + 31U) / 32U;
    length = ((map.height + 4U) * map.words) + 1U;
    rows = words(length);
    for (word = 0U; word < length; ++word) {
        rows[word] = get();
    }
    map.rows = rows;
    return map;
}

static void windows(const ac_map *map)
{
    ac_cell cell;
    for (cell.y = 0U; cell.y < map->height; ++cell.y) {
        for (cell.x = 0U; cell.x < map->width; ++cell.x) {
            put(ac_window(map, cell));
        }
    }
}

static void replay(const ac_map *map, ac_cell from, ac_cell target)
{
    ac_replay robot;
    ac_move move;
    ac_replay_start(&robot, map, from, target);
    do {
        put_cell(robot.cell);
        move = ac_replay_step(&robot);
    } while (move < AC_DIRECTIONS);
    put(0xFFFFFFFFU);
    put(move);
    put(robot.since + 1U);
}

static void learn(const ac_map *map, ac_cell from, ac_cell target, uint32_t capacity)
{
    ac_level *const levels = malloc((size_t)capacity * sizeof *levels);
    ac_learning learning;
    ac_cell cell = from;
    ac_move move = AC_OUTSIDE;
    if ((levels == NULL) || !ac_learning_start(&learning, map, target, levels, capacity)) {
        exit(4);
    }
    for (;;) {
        put_cell(cell);
        move = ac_learning_step(&learning, cell);
        if (move >= AC_DIRECTIONS) {
            break;
        }
        cell = ac_neighbour(cell, move);
    }
    put(0xFFFFFFFFU);
    put(move);
    put(learning.used);
    free(levels);
}

static void wave_of(const ac_map *map, ac_cell target)
{
    const uint32_t size = ac_wave_words(map);
    uint32_t *const memory = words(size);
    ac_wave wave;
    ac_cell cell;
    if (ac_wave_start(&wave, map, target, memory, size - 1U) || !ac_wave_start(&wave, map, target, memory, size)) {
        exit(5);
    }
    ac_wave_flood(&wave);
    for (cell.y = 0U; cell.y < map->height; ++cell.y) {
        for (cell.x = 0U; cell.x < map->width; ++cell.x) {
            put(ac_wave_next(&wave, cell));
        }
    }
    free(memory);
}

static void tasks(void)
{
    const ac_map map = get_map();
    uint32_t count = get();
    windows(&map);
    for (; count > 0U; --count) {
        const ac_cell from = get_cell();
        const ac_cell target = get_cell();
        const uint32_t capacity = get();
        replay(&map, from, target);
        learn(&map, from, target, capacity);
        wave_of(&map, target);
    }
}

/* All maps of 4 x 4, all targets: the steps from every cell, 255 where no way leads; a byte each. */
static void small(void)
{
    uint32_t number;
    for (number = 0U; number < 65536U; ++number) {
        uint32_t rows[9];
        uint32_t memory[16];
        const ac_map map = { rows, 4U, 4U, 1U };
        uint32_t place;
        for (place = 0U; place < 9U; ++place) {
            rows[place] = 0xFFFFFFFFU;
        }
        for (place = 0U; place < 16U; ++place) {
            rows[(place / 4U) + 2U] ^= (((number >> place) & 1U) ^ 1U) << ((place % 4U) + 2U);
        }
        for (place = 0U; place < 16U; ++place) {
            const ac_cell target = { (uint16_t)(place % 4U), (uint16_t)(place / 4U) };
            ac_wave wave;
            uint32_t start;
            if (!ac_wave_start(&wave, &map, target, memory, sizeof memory / sizeof memory[0])) {
                continue;
            }
            ac_wave_flood(&wave);
            for (start = 0U; start < 16U; ++start) {
                ac_cell cell = { (uint16_t)(start % 4U), (uint16_t)(start / 4U) };
                ac_move move = ac_wave_next(&wave, cell);
                int steps = 0;
                while ((move < AC_DIRECTIONS) && (steps < 100)) {
                    cell = ac_neighbour(cell, move);
                    move = ac_is_free(&map, cell) ? ac_wave_next(&wave, cell) : AC_OUTSIDE;
                    ++steps;
                }
                (void)putchar((move == AC_ARRIVED) ? steps : ((move == AC_UNREACHABLE) ? 255 : 254));
            }
        }
    }
}

/* Learns the way to a target, on the map that it is given; if that is not true, it bumps into what is there. */
static ac_move learns(const ac_map *map, uint32_t *rows, const ac_map *truth, ac_cell from, ac_cell target)
{
    ac_level levels[32];
    ac_learning learning;
    ac_cell cell = from;
    ac_move move;
    uint32_t steps = 0U;
    if (!ac_learning_start(&learning, map, target, levels, 32U)) {
        exit(4);
    }
    for (move = ac_learning_step(&learning, cell); move < AC_DIRECTIONS; move = ac_learning_step(&learning, cell)) {
        const ac_cell next = ac_neighbour(cell, move);
        if (ac_is_free(truth, next)) {
            cell = next;
        } else if (!ac_map_set(rows, map, next, true) || ac_is_free(map, next)) {
            exit(6);
        }
        if (++steps > 10000U) {
            exit(8);
        }
    }
    return move;
}

static void clear(uint32_t *rows, const ac_map *map, bool is_obstacle)
{
    ac_cell cell;
    for (cell.y = 0U; cell.y <= map->height; ++cell.y) {
        for (cell.x = 0U; cell.x <= map->width; ++cell.x) {
            if (ac_map_set(rows, map, cell, is_obstacle) != ((cell.x < map->width) && (cell.y < map->height))) {
                exit(6);
            }
        }
    }
}

/* All maps of 4 x 4, all targets, all starts: how it ends with the map and without it; a byte each. */
static void learn_small(void)
{
    uint32_t number;
    for (number = 0U; number < 65536U; ++number) {
        uint32_t rows[9];
        uint32_t unknown[9];
        const ac_map truth = { rows, 4U, 4U, 1U };
        const ac_map map = { unknown, 4U, 4U, 1U };
        uint32_t task;
        memset(rows, 0xFF, sizeof rows);
        memset(unknown, 0xFF, sizeof unknown);
        for (task = 0U; task < 16U; ++task) {
            const ac_cell cell = { (uint16_t)(task % 4U), (uint16_t)(task / 4U) };
            (void)ac_map_set(rows, &truth, cell, ((number >> task) & 1U) != 0U);
        }
        for (task = 0U; task < 256U; ++task) {
            const ac_cell target = { (uint16_t)((task / 16U) % 4U), (uint16_t)(task / 64U) };
            const ac_cell from = { (uint16_t)(task % 4U), (uint16_t)((task / 4U) % 4U) };
            if (ac_is_free(&truth, target) && ac_is_free(&truth, from)) {
                (void)putchar((int)learns(&truth, rows, &truth, from, target));
                clear(unknown, &map, false);
                (void)putchar((int)learns(&map, unknown, &truth, from, target));
            }
        }
    }
}

static void course(void)
{
    ac_course robot;
    uint32_t count;
    ac_course_start(&robot, get());
    for (count = get(); count > 0U; --count) {
        ac_segment segments[2] = { { 0U, 0U }, { 0U, 0U } };
        const uint32_t used = ac_course_move(&robot, segments, get());
        put(robot.heading);
        put(used);
        put(segments[0].motion);
        put(segments[0].ticks);
        put(segments[1].motion);
        put(segments[1].ticks);
    }
}

static void player(void)
{
    const uint32_t count = get();
    ac_segment *const segments = malloc(((size_t)count + 1U) * sizeof *segments);
    ac_player robot;
    ac_player twin;
    uint32_t clocks;
    uint32_t place;
    if (segments == NULL) {
        exit(3);
    }
    for (place = 0U; place < count; ++place) {
        segments[place].motion = get();
        segments[place].ticks = get();
    }
    ac_player_start(&robot, segments, count);
    ac_player_start(&twin, segments, count);
    for (clocks = get(); clocks > 0U; --clocks) {
        const bool go = get() != 0U;
        const uint32_t ticks = get();
        const uint32_t obstacles = get();
        const uint32_t outputs = ac_player_advance(&robot, go, ticks, obstacles);
        uint32_t tick;
        uint32_t others = ac_player_clock(&twin, go, ticks > 0U, obstacles);
        for (tick = 1U; tick < ticks; ++tick) {
            others = ac_player_clock(&twin, go, true, obstacles);
        }
        if ((others != outputs) || (twin.state != robot.state) || (twin.segment != robot.segment)
            || (twin.ticks != robot.ticks)) {
            exit(7);
        }
        put(outputs);
        put(robot.state);
        put(robot.segment);
        put(robot.ticks);
        put(ac_player_is_done(&robot) ? 1U : 0U);
    }
    free(segments);
}

/* Nanoseconds a decision, and a step, over a map and a task. */
static void latency(void)
{
    const ac_map map = get_map();
    const ac_cell from = get_cell();
    const ac_cell target = get_cell();
    const uint32_t rounds = 20000000U;
    uint32_t sum = 0U;
    uint32_t round;
    ac_cell cell = from;
    clock_t begin = clock();
    for (round = 0U; round < rounds; ++round) {
        sum += ac_decide((round * 2654435769U) >> (32U - 24U), round & 7U);
    }
    put((uint32_t)(((double)(clock() - begin) / CLOCKS_PER_SEC) * 1e12 / rounds));
    begin = clock();
    for (round = 0U; round < rounds; ++round) {
        const ac_move move = ac_next(&map, cell, target);
        cell = (move < AC_DIRECTIONS) ? ac_neighbour(cell, move) : from;
    }
    put((uint32_t)(((double)(clock() - begin) / CLOCKS_PER_SEC) * 1e12 / rounds));
    put(sum + cell.x);
}

int main(int count, char **arguments)
{
    static const struct {
        const char *name;
        void (*run)(void);
    } modes[] = {
        { "decide", decide }, { "control", control }, { "sectors", sectors }, { "tasks", tasks },
        { "small", small },   { "player", player },   { "latency", latency }, { "learns", learn_small },
        { "course", course },
    };
    size_t mode;
    for (mode = 0U; mode < (sizeof modes / sizeof modes[0]); ++mode) {
        if ((count == 2) && (strcmp(arguments[1], modes[mode].name) == 0)) {
            modes[mode].run();
            return 0;
        }
    }
    return 1;
}
