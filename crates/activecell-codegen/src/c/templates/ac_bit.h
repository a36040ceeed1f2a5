/*
 * Logic on words: a condition as a bit.
 */
#ifndef AC_BIT_H
#define AC_BIT_H

#include <stdbool.h>
#include <stdint.h>

/** 1 if the condition holds, else 0. */
static inline uint32_t ac_bit(bool condition)
{
    uint32_t bit = 0U;
    if (condition) {
        bit = 1U;
    }
    return bit;
}

#endif
