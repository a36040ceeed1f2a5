/*
 * The wave: a free cell beside a reached one is reached at the next step, and remembers the direction.
 * 32 cells at once.
 *
 * Memory, in rows of the map's words: two rows of cells just reached; the plane of cells reached, with
 * a row of zeros above and below; then for each row of the map its @PLANES@ planes of directions. Bits
 * lie as in the map, so what is shifted in from beside the map meets an obstacle there.
 */
#include "activecell.h"

#define PLANES @PLANES@U

/* Where the cells reached of a row of the map begin, rows counted from 1. */
static uint32_t reached_at(const ac_wave *wave, uint32_t row)
{
    return (2U + row) * wave->map->words;
}

/* Where the directions of a row of the map begin. */
static uint32_t planes_at(const ac_wave *wave, uint32_t row)
{
    return (4U + wave->map->height + (PLANES * (row - 1U))) * wave->map->words;
}

/* The cells to the left of those of a word, and to the right. */
static uint32_t from_left(const uint32_t *memory, uint32_t at)
{
    return (memory[at] << 1U) | (memory[at - 1U] >> 31U);
}

static uint32_t from_right(const uint32_t *memory, uint32_t at)
{
    return (memory[at] >> 1U) | (memory[at + 1U] << 31U);
}

uint32_t ac_wave_words(const ac_map *map)
{
    return map->words * (4U + map->height + (PLANES * map->height));
}

bool ac_wave_start(ac_wave *wave, const ac_map *map, ac_cell target, uint32_t *memory, uint32_t words)
{
    const bool is_ready = (words >= ac_wave_words(map)) && ac_is_free(map, target);
    if (is_ready) {
        const uint32_t needed = ac_wave_words(map);
        const uint32_t bit = (uint32_t)target.x + 2U;
        const uint32_t row = (uint32_t)target.y + 1U;
        uint32_t at;
        uint32_t word;
        wave->map = map;
        wave->memory = memory;
        wave->target = target;
        wave->first = row;
        wave->last = row;
        at = reached_at(wave, row) + (bit >> 5U);
        for (word = 0U; word < needed; ++word) {
            memory[word] = (word == at) ? ((uint32_t)1U << (bit & 31U)) : 0U;
        }
    }
    return is_ready;
}

/* The cells of a word that are reached at the next step; notes their directions. */
static uint32_t reach(const ac_wave *wave, uint32_t row, uint32_t word)
{
    const uint32_t words = wave->map->words;
    const uint32_t *const reached = wave->memory;
    const uint32_t level = reached_at(wave, row) + word;
    const uint32_t above = level - words;
    const uint32_t below = level + words;
    const uint32_t closed = wave->map->rows[((row + 1U) * words) + word] | reached[level];
    uint32_t left = ~closed;
    if (closed != 0xFFFFFFFFU) {
        uint32_t *const planes = &wave->memory[planes_at(wave, row) + word];
@PARITY_OF_ROW@        uint32_t taken;
@DIRECTIONS_OF_WAVE@    }
    return ~(closed ^ left);
}

/* Finds the cells of a row that are reached at the next step. Whether there are any. */
static bool reach_row(const ac_wave *wave, uint32_t row)
{
    const uint32_t words = wave->map->words;
    uint32_t some = 0U;
    uint32_t word;
    for (word = 0U; word < words; ++word) {
        const uint32_t fresh = reach(wave, row, word);
        wave->memory[((row & 1U) * words) + word] = fresh;
        some |= fresh;
    }
    return some != 0U;
}

/* Adds them to those reached. */
static void keep_row(const ac_wave *wave, uint32_t row)
{
    const uint32_t words = wave->map->words;
    uint32_t word;
    for (word = 0U; word < words; ++word) {
        wave->memory[reached_at(wave, row) + word] |= wave->memory[((row & 1U) * words) + word];
    }
}

bool ac_wave_spread(ac_wave *wave)
{
    const uint32_t top = (wave->first > 1U) ? (wave->first - 1U) : 1U;
    const uint32_t bottom = (wave->last < wave->map->height) ? (wave->last + 1U) : wave->map->height;
    if (wave->first <= wave->last) {
        uint32_t row;
        wave->first = 1U;
        wave->last = 0U;
        /* A row is kept when the next one has been found from it: all cells step at once. */
        for (row = top; row <= bottom; ++row) {
            if (reach_row(wave, row)) {
                wave->first = (wave->last == 0U) ? row : wave->first;
                wave->last = row;
            }
            if (row > top) {
                keep_row(wave, row - 1U);
            }
        }
        keep_row(wave, bottom);
    }
    return wave->first <= wave->last;
}

void ac_wave_flood(ac_wave *wave)
{
    bool spreads = true;
    while (spreads) {
        spreads = ac_wave_spread(wave);
    }
}

ac_move ac_wave_next(const ac_wave *wave, ac_cell cell)
{
    const ac_map *const map = wave->map;
    ac_move move = AC_OUTSIDE;
    if ((cell.x < map->width) && (cell.y < map->height)) {
        const uint32_t row = (uint32_t)cell.y + 1U;
        const uint32_t word = ((uint32_t)cell.x + 2U) >> 5U;
        const uint32_t shift = ((uint32_t)cell.x + 2U) & 31U;
        if (ac_distance(cell, wave->target) == 0U) {
            move = AC_ARRIVED;
        } else if (((wave->memory[reached_at(wave, row) + word] >> shift) & 1U) == 0U) {
            move = AC_UNREACHABLE;
        } else {
            const uint32_t *const planes = &wave->memory[planes_at(wave, row) + word];
            uint32_t plane;
            move = 0U;
            for (plane = 0U; plane < PLANES; ++plane) {
                move |= ((planes[plane * map->words] >> shift) & 1U) << plane;
            }
        }
    }
    return move;
}
