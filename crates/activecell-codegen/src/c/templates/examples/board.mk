# The board of `make board`: @BOARD@.
#
# The wave takes @WAVE_BYTES@ bytes of RAM, the map @MAP_BYTES@ of flash.
# cortex_m.ld tells the linker what there is. If even the largest board has not enough, TOO_LARGE says so.
CPU       ?= @CPU@
MACHINE   ?= @MACHINE@
TOO_LARGE :=@TOO_LARGE@
