/*
 * Decisions and whole routes, on an emulated board or on this machine: prints numbers that must be the same everywhere.
 * FROM_X, FROM_Y, TO_X, TO_Y are given when this is compiled.
 */
#include "activecell.h"
#include "startup.h"

static uint32_t memory[AC_FLOOR_WAVE_WORDS];
static ac_level levels[AC_FLOOR_LEVELS];

int main(void);

/* FNV-1a over words. */
static uint32_t hashed(uint32_t sum, uint32_t word)
{
    return (sum ^ word) * 16777619U;
}

static void say(const char *name, ac_move move, uint32_t steps, uint32_t sum)
{
    host_write(name);
    host_write(" ");
    host_write_number(move);
    host_write(" ");
    host_write_number(steps);
    host_write(" ");
    host_write_number(sum);
    host_write("\n");
}

static uint32_t decisions(void)
{
    uint32_t state = 1U;
    uint32_t sum = 2166136261U;
    uint32_t round;
    for (round = 0U; round < 20000U; ++round) {
        const uint32_t ones = (1U << AC_DIRECTIONS) - 1U;
        uint32_t window;
        uint32_t sector;
        state = (state * 1664525U) + 1013904223U;
        window = (state >> 8U) & (ones | (ones << 8U) | (ones << 16U));
        sector = (state >> 4U) & 15U;
        sector = (sector < (2U * AC_DIRECTIONS)) ? sector : (sector - 8U);
        sum = hashed(sum, ac_decide(window, sector | (((state >> 3U) & 1U) << 4U)));
    }
    return sum;
}

int main(void)
{
    const ac_cell from = { FROM_X, FROM_Y };
    const ac_cell target = { TO_X, TO_Y };
    ac_cell cell = from;
    uint32_t steps = 0U;
    uint32_t sum = 0U;
    ac_wave wave;
    ac_learning learning;
    ac_replay robot;
    ac_move move = AC_FULL;

    say("decisions", 0U, 20000U, decisions());

    if (ac_wave_start(&wave, &ac_floor, target, memory, AC_FLOOR_WAVE_WORDS)) {
        ac_wave_flood(&wave);
        move = ac_wave_next(&wave, cell);
    }
    for (; move < AC_DIRECTIONS; move = ac_wave_next(&wave, cell)) {
        cell = ac_neighbour(cell, move);
        ++steps;
        sum = hashed(sum, move);
    }
    say("wave", move, steps, sum);

    cell = from;
    steps = 0U;
    sum = 0U;
    move = AC_FULL;
    if (ac_learning_start(&learning, &ac_floor, target, levels, AC_FLOOR_LEVELS)) {
        move = ac_learning_step(&learning, cell);
    }
    for (; move < AC_DIRECTIONS; move = ac_learning_step(&learning, cell)) {
        cell = ac_neighbour(cell, move);
        ++steps;
        sum = hashed(sum, move);
    }
    say("learning", move, steps, sum);

    steps = 0U;
    sum = 0U;
    ac_replay_start(&robot, &ac_floor, from, target);
    for (move = ac_replay_step(&robot); move < AC_DIRECTIONS; move = ac_replay_step(&robot)) {
        ++steps;
        sum = hashed(sum, move);
    }
    say("published", move, steps, sum);
    return 0;
}
