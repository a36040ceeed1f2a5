/*
 * A Cortex-M board: the route of the wave from the map's first free cell to its last, written through
 * semihosting.
 *
 *   arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb -std=c99 -Os -ffreestanding -nostdlib \
 *       -Iinclude -Iexamples -T examples/cortex_m.ld examples/cortex_m.c examples/startup.c src/ac_*.c \
 *       -lgcc -o route.elf
 *   qemu-system-arm -M microbit -nographic -semihosting-config enable=on,target=native -kernel route.elf
 */
#include "activecell.h"
#include "startup.h"

static uint32_t memory[AC_FLOOR_WAVE_WORDS];

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

static void write_cell(ac_cell cell)
{
    host_write(" (");
    host_write_number(cell.x);
    host_write(",");
    host_write_number(cell.y);
    host_write(")");
}

int main(void)
{
    ac_wave wave;
    ac_cell cell = free_cell(false);
    ac_move move = AC_FULL;
    if (ac_wave_start(&wave, &ac_floor, free_cell(true), memory, AC_FLOOR_WAVE_WORDS)) {
        ac_wave_flood(&wave);
        move = ac_wave_next(&wave, cell);
    }
    host_write("wave:");
    while (move < AC_DIRECTIONS) {
        write_cell(cell);
        cell = ac_neighbour(cell, move);
        move = ac_wave_next(&wave, cell);
    }
    write_cell(cell);
    host_write((move == AC_ARRIVED) ? " arrived\n" : " no way\n");
    return (move == AC_ARRIVED) ? 0 : 1;
}
