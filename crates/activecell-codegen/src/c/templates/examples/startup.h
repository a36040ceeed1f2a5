/*
 * What a bare Cortex-M needs to say something: semihosting, through a debugger or QEMU.
 */
#ifndef STARTUP_H
#define STARTUP_H

#include <stdint.h>

/** Writes a text. */
void host_write(const char *text);

/** Writes a number. */
void host_write_number(uint32_t number);

/** Ends the program; 0 is success. */
void host_exit(int32_t code);

#endif
