# make demo    build, route a robot across a floor plan on both lattices with all three rules
# make test    format, lints, documentation, all tests
# make tools   what the proofs of the hardware run with (yosys, z3), into .venv; make test calls it
# make deps    what only root can install, for more of those proofs: GHDL, Icarus, ARM gcc, QEMU, cppcheck (optional)
# make docs    the pictures of the documents, drawn anew
# make bench   every method beside its peers, 20 minutes (QUICK=1: a few); writes docs/benchmarks.md
# make bench-fleet  groups of robots for 30 s an instance, 15 minutes (QUICK=1: 1); writes docs/benchmarks-fleet.md
# make hardware  LUTs, clocks, code sizes and instructions of what is generated, an hour (QUICK=1: 3 minutes; PARTS="player
#                firmware": these alone); writes docs/hardware.md
# make count   instruction counts of the hot loops against those kept (UPDATE=1 keeps the new ones)
# make clean   remove everything that was built

ACTIVECELL := $(or $(CARGO_TARGET_DIR),target)/release/activecell
OFFICE := maps/office.yaml --cell 0.5 --radius 0.2 --from 1.2m,1.5m --to 19m,11m
DEBIAN := iverilog ghdl gcc-arm-none-eabi qemu-system-arm cppcheck

.PHONY: demo test tools deps docs bench bench-fleet hardware count clean

demo: $(ACTIVECELL)
	@mkdir -p out
	@for lattice in square hex; do for rule in published learning wave; do \
	    printf '\n== office, %s, rule %s\n' $$lattice $$rule; \
	    $(ACTIVECELL) route $(OFFICE) --lattice $$lattice --rule $$rule --draw never \
	        --save out/$$lattice-$$rule.json \
	        --picture out/$$lattice-$$rule.svg --picture out/$$lattice-$$rule.png \
	        --picture out/$$lattice-$$rule.gif; \
	    status=$$?; if [ $$status -ne 0 ] && [ $$status -ne 3 ]; then exit $$status; fi; \
	done; done
	@printf '\n== office, squares, in the terminal\n'
	@$(ACTIVECELL) route $(OFFICE) --draw always | head -26
	@printf '\n== office, how far the robot can be trusted\n'
	@$(ACTIVECELL) route maps/office.yaml --cell 0.5 --from 1.2m,1.5m --to 19m,11m --robot maps/robot.toml \
	    --draw never --save out/run.json --picture out/certificate.png
	@printf '\n== the same, driven 10,000 times without sensors, and once with sensors where a tenth of the obstacles is unknown\n'
	@$(ACTIVECELL) simulate out/run.json --trials 10000 --picture out/offline.png
	@$(ACTIVECELL) simulate maps/office-run.json --mode task --missing 0.1 --seed 3 --picture out/task.gif
	@printf '\n== 30 robots in a warehouse, planned together, then executed by robots that are late\n'
	@$(ACTIVECELL) fleet maps/warehouse.map --scen maps/warehouse.scen --time-limit 2 \
	    --save out/plan.json --picture out/fleet.svg --picture out/fleet.gif
	@$(ACTIVECELL) simulate out/plan.json --delay-chance 0.1 --max-delay 10 --slow 0.2 --trials 100
	@printf '\nThe pictures are in out/: .svg and .png show the route, .gif the wave and the robot moving.\n'
	@ls out/*.svg out/*.png out/*.gif

$(ACTIVECELL): FORCE
	@echo "building (a minute the first time) …"
	@cargo build --release --quiet -p activecell-cli
FORCE:

test: tools
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet
	cargo test --workspace -- --nocapture --test-threads 2

tools: .venv/tools-done

.venv/tools-done: hardware/requirements.txt
	@echo "installing yosys and z3 into .venv (200 MB) …"
	@python3 -m venv .venv && .venv/bin/pip install --quiet --disable-pip-version-check -r $< \
	    && touch $@ || echo "not installed: tests that need them will say that they did not run"

deps:
	@if [ "$$(id -u)" = 0 ]; then apt-get update -qq && apt-get install -y -qq --no-install-recommends $(DEBIAN); \
	    else echo "as root: apt-get install $(DEBIAN)"; fi

docs: $(ACTIVECELL)
	$(ACTIVECELL) route $(OFFICE) --draw never --picture docs/pictures/office-square.png -q > /dev/null
	$(ACTIVECELL) route $(OFFICE) --draw never --lattice hex --picture docs/pictures/office-hex.png --picture docs/pictures/office-hex.gif -q > /dev/null
	$(ACTIVECELL) route maps/detour.txt --from S --to F --rule published --draw never --picture docs/pictures/detour.svg > /dev/null
	$(ACTIVECELL) route maps/beyond.txt --from S --to F --rule published --draw never --picture docs/pictures/beyond.svg > /dev/null
	-$(ACTIVECELL) route maps/trap.txt --from S --to F --rule published --draw never --picture docs/pictures/trap.svg > /dev/null
	$(ACTIVECELL) route maps/office.yaml --cell 0.5 --from 1.2m,1.5m --to 19m,11m --robot maps/robot.toml --draw never --picture docs/pictures/certificate.png -q > /dev/null
	$(ACTIVECELL) route maps/hills.asc --from 6m,20m --to 52m,30m --draw never --picture docs/pictures/hills.png > /dev/null
	$(ACTIVECELL) table control --picture docs/pictures/control.svg > /dev/null
	cargo run -q -p activecell-picture --example prediction > docs/pictures/prediction.svg
	$(ACTIVECELL) calibrate logs/monday logs/tuesday logs/friday --robot logs/robot.toml --picture docs/pictures/calibration.svg > /dev/null
	$(ACTIVECELL) fleet maps/shelves.txt --random -n 250 --step-limit 20000 --picture docs/pictures/fleet.gif -q > /dev/null
	$(ACTIVECELL) fleet maps/shelves.txt --random -n 60 --lattice hex --step-limit 20000 --picture docs/pictures/fleet-ways.png -q > /dev/null
	$(ACTIVECELL) simulate maps/office-run.json --trials 4000 --picture docs/pictures/simulate-offline.png -q > /dev/null
	$(ACTIVECELL) simulate maps/office-run.json --mode task --robot maps/quick.toml --movers 6 --mover-speed 0.25 --seed 4 --picture docs/pictures/simulate-movers.gif -q > /dev/null
	$(ACTIVECELL) simulate maps/office-run.json --mode task --missing 0.1 --seed 3 --picture docs/pictures/simulate-task.png --picture docs/pictures/simulate-task.gif -q > /dev/null

bench:
	@QUICK=$(QUICK) bench/run.sh

bench-fleet:
	@QUICK=$(QUICK) bench/run.sh fleet

hardware: tools .venv/place-and-route-done
	@QUICK=$(QUICK) .venv/bin/python hardware/measure.py $(PARTS)

.venv/place-and-route-done: hardware/requirements-place-and-route.txt | .venv/tools-done
	@echo "installing place and route into .venv (400 MB) …"
	@.venv/bin/pip install --quiet --disable-pip-version-check -r $< && touch $@

# Built for any machine, so that the counts do not depend on this one.
count:
	cd bench && RUSTFLAGS= cargo run --release --quiet --target-dir target/plain -- \
	    count instructions.json $(if $(UPDATE),--update)

clean:
	cargo clean
	rm -rf out .venv bench/out bench/target bench/.venv bench/node_modules
