# make sim      builds the plain example with the strictest warnings, and runs it: it checks itself
# make size     the size of each part on a Cortex-M, if its compiler is there
# make board    the example for a Cortex-M board, run in QEMU
# make clean    removes what was built

CC       ?= cc
ARM      ?= arm-none-eabi-
QEMU     ?= qemu-system-arm

# CPU and MACHINE: a board on which the map and its wave have room.
include examples/board.mk

STRICT   := -std=c99 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wcast-qual \
            -Wstrict-prototypes -Wmissing-prototypes -Wundef -Werror -Iinclude
EMBEDDED := $(STRICT) -mcpu=$(CPU) -mthumb -Os -ffreestanding -ffunction-sections
SOURCES  := $(wildcard src/*.c)
HEADERS  := $(wildcard include/*.h src/*.h examples/*.h)

.PHONY: sim size board clean

sim: build/route
	build/route

build/route: examples/main.c $(SOURCES) $(HEADERS)
	@mkdir -p build
	$(CC) $(STRICT) -O2 examples/main.c $(SOURCES) -o $@

size: $(SOURCES) $(HEADERS)
	@mkdir -p build
	cd build && $(ARM)gcc $(EMBEDDED:-Iinclude=-I../include) -c $(SOURCES:%=../%) && $(ARM)size *.o

board: build/board.elf
	$(QEMU) -M $(MACHINE) -nographic -semihosting-config enable=on,target=native -kernel $<

build/board.elf: examples/cortex_m.c examples/startup.c examples/cortex_m.ld $(SOURCES) $(HEADERS)
	$(if $(TOO_LARGE),$(error no board: $(TOO_LARGE)))
	@mkdir -p build
	$(ARM)gcc $(EMBEDDED) -Iexamples -nostdlib -T examples/cortex_m.ld -Wl,--gc-sections \
	    examples/cortex_m.c examples/startup.c $(SOURCES) -lgcc -o $@

clean:
	rm -rf build
