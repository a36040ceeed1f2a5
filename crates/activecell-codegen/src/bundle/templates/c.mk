# make sim      builds the plain examples, and runs them: they check themselves
# make size     the size of each part on a Cortex-M, if its compiler is there
# make board    the example for a Cortex-M board, run in QEMU
# make clean    removes what was built
#
# CFLAGS and LDFLAGS are added to ours; with STRICT=1 warnings are errors.

CC       ?= cc
ARM      ?= arm-none-eabi-
QEMU     ?= qemu-system-arm

# CPU and MACHINE: a board on which the map and its wave have room.
include examples/board.mk

WARNINGS := -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wcast-qual \
            -Wstrict-prototypes -Wmissing-prototypes -Wundef $(if $(filter 1,$(STRICT)),-Werror)
HOST     := -std=c99 $(WARNINGS) -Iinclude -O2 $(CFLAGS)
EMBEDDED := -std=c99 $(WARNINGS) -Iinclude -mcpu=$(CPU) -mthumb -Os -ffreestanding -ffunction-sections
SOURCES  := $(wildcard src/*.c)
HEADERS  := $(wildcard include/*.h src/*.h examples/*.h)
# A change of these builds anew, as one of the sources does.
INPUTS   := $(SOURCES) $(HEADERS) Makefile examples/board.mk build/flags

# $(call needs,PROGRAM,PACKAGE): stops with a hint where a program is missing.
needs = command -v $(1) > /dev/null || { echo "$(1) was not found: install it (Debian: $(2))" >&2; exit 1; }

.PHONY: sim size board clean FORCE

sim: build/main build/robot
	build/main
	build/robot

build/main build/robot: build/%: examples/%.c $(INPUTS)
	@$(call needs,$(firstword $(CC)),gcc)
	$(CC) $(HOST) $< $(SOURCES) $(LDFLAGS) -o $@

# Written only when compilers or flags are others than the last time.
build/flags: FORCE
	@mkdir -p build
	@echo '$(CC) $(HOST) $(LDFLAGS) $(ARM) $(EMBEDDED)' | cmp -s - $@ || \
	    echo '$(CC) $(HOST) $(LDFLAGS) $(ARM) $(EMBEDDED)' > $@

size: $(INPUTS)
	@$(call needs,$(ARM)gcc,gcc-arm-none-eabi)
	cd build && $(ARM)gcc $(EMBEDDED:-Iinclude=-I../include) -c $(SOURCES:%=../%) && $(ARM)size *.o

board: build/board.elf
	@$(call needs,$(QEMU),qemu-system-arm)
	$(QEMU) -M $(MACHINE) -nographic -semihosting-config enable=on,target=native -kernel $<

build/board.elf: examples/cortex_m.c examples/startup.c examples/cortex_m.ld $(INPUTS)
	$(if $(TOO_LARGE),$(error no board: $(TOO_LARGE)))
	@$(call needs,$(ARM)gcc,gcc-arm-none-eabi)
	$(ARM)gcc $(EMBEDDED) -Iexamples -nostdlib -T examples/cortex_m.ld -Wl,--gc-sections \
	    examples/cortex_m.c examples/startup.c $(SOURCES) -lgcc -o $@

clean:
	rm -rf build
