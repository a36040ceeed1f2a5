#!/usr/bin/env bash
# The benchmarks with one command: `make bench`, or `make bench QUICK=1`. See docs/benchmarks.md. With `fleet`, those of
# groups: `make bench-fleet`. See docs/benchmarks-fleet.md.
# Everything is installed and written inside bench/; nothing needs root.
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
# The folder of real maps, seen from where this was called, else beside the project.
DATA=$(realpath "${ACTIVECELL_DATA:-$project/../shared/data}" 2> /dev/null || true)
cd "$project/bench"

QUICK=${QUICK:-}
if [ -n "$QUICK" ]; then
    export BENCH_SECONDS=0.3 BENCH_LEAST=5 BENCH_TIMEOUT=60
else
    export BENCH_SECONDS=${BENCH_SECONDS:-1.0} BENCH_LEAST=10
fi
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1
OUT=out/results.jsonl
WORK=out/work
BENCH=target/native/release/activecell-bench
PYTHON=.venv/bin/python

say() { printf '\n== %s\n' "$*" >&2; }

# One core for everything that is measured: the last one, which has the fewest interrupts.
pin=()
if command -v taskset > /dev/null; then pin=(taskset -c "$(($(env -u OMP_NUM_THREADS nproc) - 1))"); fi
rust() { "${pin[@]}" "$BENCH" run "$WORK" "$OUT" "$@"; }
python() { "${pin[@]}" "$PYTHON" peers.py "$WORK" "$OUT" "$@"; }
node_() { "${pin[@]}" node peers.mjs "$WORK" "$OUT" "$@"; }

# One method on one map in a process of its own, for its peak memory. A wrong answer (status 1) stops the run; a
# method that needs too much time is noted, and left out on larger maps of the kind.
alone() { # PART CASE METHOD, with the program in $runner
    local status=0
    if grep -q "\"case\": \"${2%-*}-.*\"method\": \"$3\", \"stopped\"" "$OUT"; then return; fi
    timeout "${BENCH_TIMEOUT:-150}" "${pin[@]}" "${runner[@]}" "$@" 2> out/alone.log || status=$?
    case $status in
    0) ;;
    124 | 137)
        echo "  $3 on $2: stopped (status $status: no time or no memory)" >&2
        printf '{"case": "%s", "part": "%s", "method": "%s", "stopped": %d}\n' "$2" "$1" "$3" "$status" >> "$OUT"
        ;;
    *)
        cat out/alone.log >&2
        exit 1
        ;;
    esac
}

# The methods in growing maps: runner, part, largest side at which it ends in bearable time and memory, name.
GROWING='rust paths 8192 ours
rust paths 8192 queue
rust paths 4096 pathfinding astar
rust paths 2048 grid_pathfinding
python paths 8192 pyastar2d
python paths 4096 tcod A*
python paths 4096 scipy bfs
node paths 8192 l1-path-finder
rust fields 8192 ours
rust fields 8192 ours compact
rust fields 8192 ours reachable
rust fields 8192 queue
rust fields 8192 pathfinding bfs_reach
python fields 8192 tcod dijkstra2d
python fields 8192 scipy dijkstra
python fields 4096 scikit-image MCP
python fields 2048 igraph'

install() {
    say "building and installing (once)"
    # Ours and the crates for this very machine; the packages of Python and Node are as their makers built them.
    RUSTFLAGS="-C target-cpu=native" cargo build --release --quiet --target-dir target/native
    if [ ! -e .venv/done ] || [ requirements.txt -nt .venv/done ]; then
        python3 -m venv .venv
        .venv/bin/pip install --quiet --disable-pip-version-check -r requirements.txt
        touch .venv/done
    fi
}

install_node() {
    have_node=
    if ! command -v npm > /dev/null || ! command -v node > /dev/null; then
        say "Node is missing: l1-path-finder is NOT measured"
    elif [ -e node_modules/l1-path-finder ] || npm ci --silent --no-audit --no-fund > /dev/null; then
        have_node=1
    else
        say "npm could not install its packages: l1-path-finder is NOT measured"
    fi
}

grow() {
    "$BENCH" list "$WORK" grow | while read -r case size; do
        printf '%s\n' "$GROWING" | while read -r language part largest method; do
            if [ "$size" -gt "$largest" ] || { [ "$language" = node ] && [ -z "$have_node" ]; }; then continue; fi
            case $language in
            rust) runner=("$BENCH" run "$WORK" "$OUT") ;;
            python) runner=("$PYTHON" peers.py "$WORK" "$OUT") ;;
            node) runner=(node peers.mjs "$WORK" "$OUT") ;;
            esac
            alone "$part" "$case" "$method" < /dev/null
        done
        echo "  $case" >&2
    done
}

# The planner for groups: map, scenario in the data folder (`-`: the map's random one), robots (0: all rows), lattice.
FLEET='random-32-32-20 - 100,400 square
random-32-32-20 - 400 hex
random-64-64-20 - 1000 square
random-64-64-20 - 1000 hex
empty-48-48 - 1000 square
empty-48-48 - 1000 hex
room-64-64-8 - 1000 square
room-64-64-8 - 1000 hex
maze-32-32-4 - 0 square
maze-128-128-2 - 1000 square
maze-128-128-2 - 1000 hex
warehouse-10-20-10-2-1 - 1000 square
warehouse-10-20-10-2-1 - 1000 hex
warehouse-20-40-10-2-2 mapf/warehouse-20-40-10-2-2-10000agents-1 1000,2000,5000,10000 square
warehouse-20-40-10-2-2 mapf/warehouse-20-40-10-2-2-10000agents-1 1000,10000 hex
den520d - 1000 square
den520d - 1000 hex
ost003d - 1000 square
brc202d - 1000 square
Berlin_1_256 - 1000 square
random-32-32-20 mapf/dense/random-32-32-20-random-1 800 square
puzzles/connector mapf/puzzles/connector 0 square
puzzles/corners mapf/puzzles/corners 0 square
puzzles/dislike-example mapf/puzzles/dislike-example 0 square
puzzles/loop mapf/puzzles/loop 0 square
puzzles/loop-chain mapf/puzzles/loop-chain 0 square
puzzles/string mapf/puzzles/string 0 square
puzzles/tree mapf/puzzles/tree 0 square
puzzles/tunnel mapf/puzzles/tunnel 0 square'

fleet() {
    local start=$SECONDS out=out/fleet.jsonl map scen robots lattices number lattice seconds
    if [ ! -d "$DATA/mapf" ]; then
        say "no maps in ${DATA:-the folder named}/mapf: set ACTIVECELL_DATA"
        exit 1
    fi
    install
    mkdir -p out && rm -f "$out"
    say "groups"
    while read -r map scen robots lattices; do
        if [ "$scen" = - ]; then scen=mapf/$map-random-1; fi
        for lattice in ${lattices//,/ }; do
            for number in ${robots//,/ }; do
                seconds=${QUICK:+2}
                case $map in puzzles/*) seconds=1 ;; esac
                "$BENCH" fleet "$DATA/mapf/$map.map" "$DATA/$scen.scen" "$number" "$lattice" "${seconds:-30}" "$out"
            done
        done
        echo "  $map" >&2
    done <<< "$FLEET"
    MINUTES=$(((SECONDS - start + 30) / 60)) "$PYTHON" fleet.py "$out" ../docs
}

main() {
    local start=$SECONDS
    install
    install_node
    mkdir -p out && rm -rf "$WORK" "$OUT"
    if [ ! -d "$DATA" ]; then
        say "no real maps in ${DATA:-the folder named} (set ACTIVECELL_DATA): synthetic maps alone"
        DATA=
    fi
    say "maps and right answers"
    "$BENCH" prepare "$WORK" ${DATA:+--data "$DATA"} ${QUICK:+--quick}
    say "queries"
    rust paths - -
    python paths - -
    if [ -n "$have_node" ]; then node_ paths - -; fi
    say "whole fields"
    rust fields - -
    python fields - -
    say "repair"
    rust repair - - # nothing while the core is built without it
    say "growing maps, each method in a process of its own"
    grow
    say "report"
    rm -f "$WORK"/*.bin
    {
        "$PYTHON" peers.py versions
        if [ -n "$have_node" ]; then node peers.mjs versions; fi
    } > out/versions.jsonl
    MINUTES=$(((SECONDS - start + 30) / 60)) "$PYTHON" report.py out ../docs
}

case ${1:-} in
fleet) fleet ;;
*) main ;;
esac
