/*
 * A minimal start-up for Cortex-M0 and later: vectors, initial memory, semihosting.
 */
#include "startup.h"

/* Of the linker: addresses, as cortex_m.ld sets them. */
extern uint32_t stack_top[];
extern uint32_t data_load[];
extern uint32_t data_start[];
extern uint32_t data_end[];
extern uint32_t bss_start[];
extern uint32_t bss_end[];

int main(void);
void reset(void);

/* Asks the host: ARM, Semihosting for AArch32 and AArch64. */
static void host(uint32_t operation, uintptr_t argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register uintptr_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

void host_write(const char *text)
{
    host(4U, (uintptr_t)text);
}

void host_write_number(uint32_t number)
{
    /* Without a division, which a Cortex-M0 does not have. */
    static const uint32_t tens[] = { 1000000000U, 100000000U, 10000000U, 1000000U, 100000U, 10000U,
                                     1000U,       100U,       10U,       1U };
    char text[11];
    uint32_t length = 0U;
    uint32_t place;
    for (place = 0U; place < 10U; ++place) {
        char digit = '0';
        while (number >= tens[place]) {
            number -= tens[place];
            ++digit;
        }
        if ((length > 0U) || (digit > '0') || (place == 9U)) {
            text[length] = digit;
            ++length;
        }
    }
    text[length] = '\0';
    host_write(text);
}

void host_exit(int32_t code)
{
    host(0x18U, (code == 0) ? 0x20026U : 0x20023U);
    for (;;) {
    }
}

void reset(void)
{
    const volatile uint32_t *from = data_load;
    volatile uint32_t *to;
    for (to = data_start; to < data_end; ++to) {
        *to = *from;
        ++from;
    }
    for (to = bss_start; to < bss_end; ++to) {
        *to = 0U;
    }
    host_exit(main());
}

static void fault(void)
{
    host_write("fault\n");
    host_exit(1);
}

typedef struct {
    uint32_t *stack;
    void (*handlers[15])(void);
} vector_table;

extern const vector_table vectors;

/* Reset, NMI, hard fault and the other exceptions of the core; a board's own interrupts follow. */
const vector_table vectors __attribute__((section(".vectors"), used)) = {
    stack_top,
    { reset, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault,
      fault },
};
