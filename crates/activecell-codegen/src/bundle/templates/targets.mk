.PHONY: sim synth clean $(DESIGNS:%=sim-%) $(DESIGNS:%=synth-%)

sim: $(DESIGNS:%=sim-%)
synth: $(FITTING:%=synth-%)
	@for design in $(filter-out $(FITTING),$(DESIGNS)); do \
	    echo "$$design: left out, an HX8K is too small for it; make synth-$$design tries"; done
