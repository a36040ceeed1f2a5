.PHONY: sim example synth clean $(DESIGNS:%=sim-%) $(DESIGNS:%=example-%) $(DESIGNS:%=synth-%)

sim: $(DESIGNS:%=sim-%)
example: $(DESIGNS:%=example-%)
synth: $(FITTING:%=synth-%)
	@for design in $(filter-out $(FITTING),$(DESIGNS)); do \
	    echo "$$design: left out, an HX8K is too small for it; make synth-$$design tries"; done
