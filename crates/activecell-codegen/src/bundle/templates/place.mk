	@# The router can go in circles: then another seed.
	@for seed in 1 2 3; do timeout 300 $(NEXTPNR) --hx8k --package ct256 --json build/$*.json \
	    --asc build/$*.asc --seed $$seed --timing-allow-fail --log build/$*.pnr -q && break; done 2> build/$*.err \
	    || { tail -3 build/$*.err; false; }
	@grep -E 'ICESTORM_(LC|RAM): +[0-9]+/' build/$*.pnr | tail -2 | sed 's/Info:[[:space:]]*/    /'
	@grep 'Max frequency' build/$*.pnr | tail -1 | sed 's/.*: Max/    Max/; s/ for clock.*: / /; s/ (.*//'
