/*
 * How the headers fit together: the sector of the target, the decision, the control unit.
 *
 *   cc -std=c99 -Iinclude examples/rules.c -o rules && ./rules
 */
#include "ac_control_next.h"
#include "ac_decide_square.h"
#include "ac_sector_square.h"

#include <stdio.h>

/* The number of the one lane that is 1. */
static uint32_t number_of(uint32_t lanes)
{
    uint32_t number = 0U;
    while ((lanes >> number) > 1U) {
        ++number;
    }
    return number;
}

int main(void)
{
    /* The target lies so many columns to the right and rows down: comparisons with 0 are all that counts. */
    const int32_t across = 5;
    const int32_t down = 2;
    const uint32_t sector =
        ac_sector_square(ac_bit(across < 0), ac_bit(across > 0), ac_bit(down < 0), ac_bit(down > 0));
    /* It is a neighbour if one step leads there: on hexagons, if its distance in steps is 1. */
    const uint32_t is_near = ac_bit(((across * across) + (down * down)) == 1);
    /* Lanes are directions clockwise from the top. An obstacle stands below (lane 2), the rest is free. */
    const ac_decide_square_outputs next = ac_decide_square(4U, 0U, 0U, sector, is_near);
    if (next.enclosed != 0U) {
        printf("enclosed\n");
    } else {
        /* The robot faces lane 1, so it drives on: g0, a task is set; g2 to g5 are its obstacle flags. */
        const uint32_t state = ac_control_next(0U, 1U).next_state;
        const ac_control_next_outputs motors = ac_control_next(state, 0U);
        printf("lane %lu, then state %lu with %s\n", (unsigned long)number_of(next.go), (unsigned long)state,
               (motors.q1 != 0U) ? "q1: forward" : "no drive");
    }
    return 0;
}
