/*
 * A plain program: the task of the program M by the wave and by the two local rules, and M, played.
 * It looks whether all is as the generator knew it, and returns 1 if not, after lines that say what differs.
 *
 *   cc -std=c99 -O2 -Iinclude examples/main.c src/ac_*.c -o route && ./route
 */
#include "activecell.h"

#include <stdio.h>

static uint32_t memory[AC_FLOOR_WAVE_WORDS];
static ac_level levels[AC_FLOOR_LEVELS];

static const char *word(ac_move move)
{
    static const char *const words[] = { "arrived", "enclosed", "trapped", "unreachable", "full", "outside" };
    return (move < AC_ARRIVED) ? "moving" : words[move - AC_ARRIVED];
}

/* A checksum (FNV-1a) of the rule's decisions on 65,536 inputs: on squares there are no others. */
static uint32_t decisions(void)
{
    const uint32_t ones = ((uint32_t)1U << AC_DIRECTIONS) - 1U;
    uint32_t sum = 2166136261U;
    uint32_t number;
    for (number = 0U; number < 65536U; ++number) {
        const uint32_t input = number * 2654435769U;
        const uint32_t sector = (input >> 1U) % (2U * AC_DIRECTIONS);
        const uint32_t ring1 = (input >> 4U) & ones;
        const uint32_t ahead = (input >> (4U + AC_DIRECTIONS)) & ones;
        const uint32_t between = (input >> (4U + (2U * AC_DIRECTIONS))) & ones;
        const uint32_t bearing = sector | (((input & 1U) != 0U) ? AC_NEAR : 0U);
        sum = (sum ^ ac_decide(ring1 | (ahead << 8U) | (between << 16U), bearing)) * 16777619U;
    }
    return sum;
}

/* Whether the wave's way arrives, after as many steps as it should. */
static bool follow_wave(ac_cell from, ac_cell target)
{
    ac_wave wave;
    ac_cell cell = from;
    uint32_t steps = 0U;
    ac_move move = AC_FULL;
    if (ac_wave_start(&wave, &ac_floor, target, memory, AC_FLOOR_WAVE_WORDS)) {
        ac_wave_flood(&wave);
        move = ac_wave_next(&wave, cell);
    }
    printf("wave:");
    while ((move < AC_DIRECTIONS) && (steps != AC_PROGRAM_STEPS)) {
        printf(" (%u,%u)", (unsigned)cell.x, (unsigned)cell.y);
        cell = ac_neighbour(cell, move);
        ++steps;
        move = ac_wave_next(&wave, cell);
    }
    printf(" (%u,%u) %s\n", (unsigned)cell.x, (unsigned)cell.y, word(move));
    return (move == AC_ARRIVED) && (steps == AC_PROGRAM_STEPS);
}

/* Whether the rule that learns arrives. */
static bool learn(ac_cell from, ac_cell target)
{
    ac_learning learning;
    ac_cell cell = from;
    unsigned long steps = 0UL;
    ac_move move = AC_FULL;
    if (ac_learning_start(&learning, &ac_floor, target, levels, AC_FLOOR_LEVELS)) {
        move = ac_learning_step(&learning, cell);
    }
    while (move < AC_DIRECTIONS) {
        cell = ac_neighbour(cell, move);
        ++steps;
        move = ac_learning_step(&learning, cell);
    }
    printf("learning: %s after %lu steps\n", word(move), steps);
    return move == AC_ARRIVED;
}

/* The published rule may also be trapped, or be enclosed. */
static void replay(ac_cell from, ac_cell target)
{
    ac_replay robot;
    unsigned long steps = 0UL;
    ac_move move;
    ac_replay_start(&robot, &ac_floor, from, target);
    move = ac_replay_step(&robot);
    while (move < AC_DIRECTIONS) {
        ++steps;
        move = ac_replay_step(&robot);
    }
    printf("published: %s after %lu steps\n", word(move), steps);
}

/* Whether the robot moves until the last tick of the program M, and rests once it is done. */
static bool play(void)
{
    const uint32_t moves = AC_OUT_DRIVE | AC_OUT_LEFT | AC_OUT_RIGHT;
    uint32_t outputs = AC_OUT_CALM;
    bool is_right = true;
    ac_player player;
    uint32_t segment;
    ac_player_start(&player, ac_program, AC_PROGRAM_COUNT);
    for (segment = 0U; segment < player.count; ++segment) {
        is_right = is_right && (player.segment == segment) && (player.ticks == 0U);
        outputs = ac_player_advance(&player, true, ac_program[segment].ticks, 0U);
        is_right = is_right && ((outputs & moves) != 0U);
    }
    is_right = is_right && (ac_player_is_done(&player) == (player.count == 0U));
    while (!ac_player_is_done(&player)) {
        outputs = ac_player_advance(&player, true, 0U, 0U);
    }
    printf("program: %lu segments played\n", (unsigned long)AC_PROGRAM_COUNT);
    return is_right && (player.segment == player.count) && ((outputs & moves) == 0U);
}

static bool check(bool is_right, const char *what)
{
    if (!is_right) {
        printf("FAIL: %s\n", what);
    }
    return is_right;
}

int main(void)
{
    const ac_cell from = { AC_PROGRAM_FROM_X, AC_PROGRAM_FROM_Y };
    const ac_cell target = { AC_PROGRAM_TO_X, AC_PROGRAM_TO_Y };
    bool is_right = check(decisions() == AC_RULE_CHECKSUM, "ac_decide is not the rule that was generated");
    is_right = check(follow_wave(from, target), "the wave's way is not as long as the program's") && is_right;
    is_right = check(learn(from, target), "the rule that learns does not arrive") && is_right;
    replay(from, target);
    is_right = check(play(), "the player does not play the program to its end") && is_right;
    if (is_right) {
        printf("PASS: rule, ways and program are those that were generated\n");
    }
    return is_right ? 0 : 1;
}
