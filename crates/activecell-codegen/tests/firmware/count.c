/*
 * Does one thing ROUNDS times, the thing that WHAT names; 0 is nothing, for the difference.
 */
#include "activecell.h"
#include "startup.h"

#define ROUNDS 200U

int main(void);

/* Not static, for no WHAT needs them all. */
uint32_t memory[AC_FLOOR_WAVE_WORDS];
ac_level levels[AC_FLOOR_LEVELS];
ac_wave wave;
ac_learning learning;
ac_player player;
const ac_cell from = { FROM_X, FROM_Y };
const ac_cell target = { TO_X, TO_Y };

static volatile uint32_t sink;

int main(void)
{
    static const ac_segment segments[] = { { AC_RUN_FORWARD, 7U }, { AC_RUN_LEFT, 3U }, { AC_RUN_FORWARD, 9000U } };
    const uint32_t ones = (1U << AC_DIRECTIONS) - 1U;
    ac_cell cell = from;
    uint32_t state = 1U;
    uint32_t round;

#if WHAT == 3 || WHAT == 6 || WHAT == 7
    if (!ac_wave_start(&wave, &ac_floor, target, memory, AC_FLOOR_WAVE_WORDS)) {
        return 1;
    }
#endif
#if WHAT == 3 || WHAT == 6
    ac_wave_flood(&wave);
#endif
#if WHAT == 4 || WHAT == 8
    if (!ac_learning_start(&learning, &ac_floor, target, levels, AC_FLOOR_LEVELS)) {
        return 1;
    }
#endif
    ac_player_start(&player, segments, 3U);
    for (round = 0U; round < ROUNDS; ++round) {
        ac_move move;
        uint32_t sector = (state >> 4U) & 15U;
        state = (state * 1664525U) + 1013904223U;
        sector = (sector < (2U * AC_DIRECTIONS)) ? sector : (sector - 8U);
#if WHAT == 1
        move = ac_decide((state >> 8U) & (ones | (ones << 8U) | (ones << 16U)), sector | ((state << 1U) & AC_NEAR));
#else
        move = (state >> 8U) & (ones | (ones << 8U) | (ones << 16U) | sector);
#endif
#if WHAT == 2
        move = ac_next(&ac_floor, cell, target);
        cell = (move < AC_DIRECTIONS) ? ac_neighbour(cell, move) : from;
#elif WHAT == 3
        move = ac_wave_next(&wave, cell);
        cell = (move < AC_DIRECTIONS) ? ac_neighbour(cell, move) : from;
#elif WHAT == 4
        move = ac_learning_step(&learning, cell);
        cell = (move < AC_DIRECTIONS) ? ac_neighbour(cell, move) : from;
#elif WHAT == 5
        move = ac_player_clock(&player, true, (state >> 31U) != 0U, state & 0x3CU);
#endif
        sink = move;
    }
    sink = cell.x;
    return 0;
}
