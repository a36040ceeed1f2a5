/*
 * A plain program: the route of the wave and the ways of the two local rules, from the map's first free
 * cell to its last.
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

/* The first free cell of the map, or the last one. */
static ac_cell free_cell(bool is_last)
{
    ac_cell found = { 0U, 0U };
    bool is_found = false;
    ac_cell cell;
    for (cell.y = 0U; cell.y < AC_FLOOR_HEIGHT; ++cell.y) {
        for (cell.x = 0U; cell.x < AC_FLOOR_WIDTH; ++cell.x) {
            if (ac_is_free(&ac_floor, cell) && (is_last || !is_found)) {
                found = cell;
                is_found = true;
            }
        }
    }
    return found;
}

static void follow_wave(ac_cell from, ac_cell target)
{
    ac_wave wave;
    ac_cell cell = from;
    ac_move move = AC_FULL;
    if (ac_wave_start(&wave, &ac_floor, target, memory, AC_FLOOR_WAVE_WORDS)) {
        ac_wave_flood(&wave);
        move = ac_wave_next(&wave, cell);
    }
    printf("wave:");
    while (move < AC_DIRECTIONS) {
        printf(" (%u,%u)", (unsigned)cell.x, (unsigned)cell.y);
        cell = ac_neighbour(cell, move);
        move = ac_wave_next(&wave, cell);
    }
    printf(" (%u,%u) %s\n", (unsigned)cell.x, (unsigned)cell.y, word(move));
}

static void learn(ac_cell from, ac_cell target)
{
    ac_learning learning;
    ac_cell cell = from;
    unsigned long steps = 0UL;
    ac_move move = AC_FULL;
    if (ac_learning_start(&learning, target, levels, AC_FLOOR_LEVELS)) {
        move = ac_learning_step(&learning, &ac_floor, cell);
    }
    while (move < AC_DIRECTIONS) {
        cell = ac_neighbour(cell, move);
        ++steps;
        move = ac_learning_step(&learning, &ac_floor, cell);
    }
    printf("learning: %s after %lu steps\n", word(move), steps);
}

static void replay(ac_cell from, ac_cell target)
{
    ac_replay robot;
    unsigned long steps = 0UL;
    ac_move move;
    ac_replay_start(&robot, from, target);
    move = ac_replay_step(&robot, &ac_floor);
    while (move < AC_DIRECTIONS) {
        ++steps;
        move = ac_replay_step(&robot, &ac_floor);
    }
    printf("published: %s after %lu steps\n", word(move), steps);
}

int main(void)
{
    const ac_cell from = free_cell(false);
    const ac_cell target = free_cell(true);
    follow_wave(from, target);
    learn(from, target);
    replay(from, target);
    return 0;
}
