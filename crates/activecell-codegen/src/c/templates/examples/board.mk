# The board of `make board`: @BOARD@. It has memory enough for the example.
#
# The wave takes @WAVE_BYTES@ bytes of RAM, the map @MAP_BYTES@ of flash; cortex_m.ld tells the linker what there is.
CPU       ?= @CPU@
MACHINE   ?= @MACHINE@
TOO_LARGE :=@TOO_LARGE@
