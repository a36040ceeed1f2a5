/*
 * A Cortex-M board: a shortest way for the task of the program M, written through semihosting.
 *
 *   arm-none-eabi-gcc -mcpu=@CPU@ -mthumb -std=c99 -Os -ffreestanding -nostdlib \
 *       -Iinclude -Iexamples -T examples/cortex_m.ld examples/cortex_m.c examples/startup.c src/ac_*.c \
 *       -lgcc -o route.elf
 *   qemu-system-arm -M @MACHINE@ -nographic -semihosting-config enable=on,target=native -kernel route.elf
 */
#include "activecell.h"
#include "startup.h"

static uint32_t memory[AC_FLOOR_WAVE_WORDS];

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
    const ac_cell target = { AC_PROGRAM_TO_X, AC_PROGRAM_TO_Y };
    ac_cell cell = { AC_PROGRAM_FROM_X, AC_PROGRAM_FROM_Y };
    uint32_t steps = 0U;
    ac_move move = AC_FULL;
    ac_wave wave;
    bool is_right;
    if (ac_wave_start(&wave, &ac_floor, target, memory, AC_FLOOR_WAVE_WORDS)) {
        ac_wave_flood(&wave);
        move = ac_wave_next(&wave, cell);
    }
    host_write("wave:");
    while ((move < AC_DIRECTIONS) && (steps != AC_PROGRAM_STEPS)) {
        write_cell(cell);
        cell = ac_neighbour(cell, move);
        ++steps;
        move = ac_wave_next(&wave, cell);
    }
    write_cell(cell);
    is_right = (move == AC_ARRIVED) && (steps == AC_PROGRAM_STEPS);
    host_write(is_right ? " arrived\n" : "\nFAIL: the wave's way is not as long as the program's\n");
    return is_right ? 0 : 1;
}
