"""Writes docs/benchmarks-fleet.md and its plot from the results of a run. bench/run.sh runs it.

    fleet.py RESULTS DOCS
"""

import json
import os
import sys
from pathlib import Path

from report import fill, machine, number, plt, save, setup_plots, table

# Our line of each lattice and the marks of the peers, in the colours of the other benchmarks.
OURS = {"square": ("#0072b2", "ours, squares"), "hex": ("#56b4e9", "ours, hexagons")}
PEERS = {"lacam3": ("#d55e00", "o", "LaCAM3"), "lg10": ("#009e73", "s", "LG-LaCAM, window 10"), "lg20": ("#cc79a7", "^", "LG-LaCAM, window 20")}
MOMENTS = (1, 10, 30)
# Panels of the plot in a row.
ACROSS = 3


def title(record):
    return f"{record['map']}, {record['robots']}"


def cost_at(record, seconds):
    """The best cost known by then; None if the run ended before, its time being over."""
    costs = [cost for ms, cost in record["history"] if ms <= seconds * 1e3]
    if seconds > record["seconds"] and record["ending"] == "Time":
        return None
    return costs[-1] if costs else "none"


def over(cost, record):
    """The cost over the bound, as text."""
    return cost if isinstance(cost, str) else "–" if cost is None else f"{cost / record['bound']:.3f}"


def ours(record):
    """First plan and costs at the moments."""
    if not record["history"]:
        return ["none"] * (2 + len(MOMENTS))
    ms, cost = record["history"][0]
    return [number(ms), over(cost, record), *(over(cost_at(record, s), record) for s in MOMENTS)]


def peer_costs(peer):
    """All costs that peers reached."""
    return [cost for name in PEERS if isinstance(peer.get(name), list) for cost in peer[name][1:]]


def peers_table(pairs):
    rows = []
    for record, peer in pairs:
        cells = []
        for name in PEERS:
            figures = peer.get(name)
            if isinstance(figures, list):
                costs = [over(cost, record) for cost in figures[1:]]
                cells += [f"{costs[0]} ({number(figures[0])})", *costs[1:]]
            else:
                cells += [figures or "–"] + ["–"] * (name == "lacam3")
        at_ten = cost_at(record, 10)
        best = f"{at_ten / min(peer_costs(peer)):.3f}" if isinstance(at_ten, int) else "–"
        rows.append([title(record), f"{record['bound']:,}".replace(",", " "), *ours(record), best, *cells])
    head = ["map, robots", "bound", "first, ms", "first", *(f"{s} s" for s in MOMENTS), "10 s over best peer"]
    return table([*head, "LaCAM3 first", "LaCAM3 30 s", "LG-LaCAM 10", "LG-LaCAM 20"], rows)


def all_table(records):
    rows = []
    for record in records:
        row = [record["map"], str(record["robots"]), record["lattice"], f"{record['bound']:,}".replace(",", " "), *ours(record)]
        rows.append([*row, str(record["makespan"] or "–"), number((record["peak_kb"] or 0) / 1024)])
    head = ["map", "robots", "lattice", "bound", "first, ms", "first", *(f"{s} s" for s in MOMENTS)]
    return table([*head, "makespan", "memory, MiB"], rows)


def puzzles_line(records):
    if not records:
        return "\n"
    solved = [r for r in records if r["history"]]
    firsts = [r["history"][0][0] for r in solved]
    line = f"Puzzles ({', '.join(r['map'] for r in records)}): {len(solved)} of {len(records)} solved"
    if solved:
        costs = ", ".join(str(r["history"][-1][1]) for r in solved)
        line += f", first plans after {number(min(firsts))} to {number(max(firsts))} ms, costs in the end {costs}"
    return line + ".\n"


def panel(axes, record, hexagons, peer):
    """Cost over bound against time: a line of steps for ours, a mark for each plan of a peer."""
    for run in filter(None, (hexagons, record)):
        colour, label = OURS[run["lattice"]]
        if run["history"]:
            points = [*run["history"], [run["seconds"] * 1e3, run["history"][-1][1]]]
            xs, ys = zip(*((ms / 1e3, cost / run["bound"]) for ms, cost in points))
            axes.step(xs, ys, where="post", color=colour, linewidth=2, label=label)
            axes.plot(xs[0], ys[0], "D", color=colour, markersize=4)
    for name, (colour, marker, label) in PEERS.items():
        figures = peer.get(name)
        if isinstance(figures, list):
            times = [figures[0] / 1e3, 30][: len(figures) - 1]
            ys = [cost / record["bound"] for cost in figures[1:]]
            axes.plot(times, ys, marker, color=colour, linestyle=":", linewidth=1, markersize=6, label=label)
    axes.set_xscale("log")
    axes.set_xlim(0.002, 120)
    axes.set_xticks([0.01, 0.1, 1, 10, 100], ["0.01", "0.1", "1", "10", "100"])
    axes.set_title(title(record), fontsize=9)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.tick_params(labelsize=8)


def plot(pairs, hexagons, path):
    down = -(-len(pairs) // ACROSS)
    figure, grid = plt.subplots(down, ACROSS, figsize=(11, 0.6 + 2.3 * down), squeeze=False)
    panels = [axes for row in grid for axes in row]
    for axes, (record, peer) in zip(panels, pairs):
        panel(axes, record, hexagons.get(title(record)), peer)
    for axes in panels[len(pairs) :]:
        axes.set_visible(False)
    figure.supxlabel("seconds", fontsize=9)
    figure.supylabel("sum of costs / bound", fontsize=9)
    known = {}
    for axes in panels:
        known |= dict(zip(*reversed(axes.get_legend_handles_labels())))
    figure.legend(known.values(), known.keys(), loc="upper center", ncols=len(known), fontsize=8, frameon=False)
    save(figure, path, above=0.35)


def main():
    results, docs = Path(sys.argv[1]), Path(sys.argv[2])
    setup_plots()
    records = [json.loads(line) for line in results.read_text().splitlines()]
    here = Path(__file__).parent
    quoted = {(peer["scen"], peer["robots"]): peer for peer in json.loads((here / "fleet_peers.json").read_text())}
    puzzles = [record for record in records if record["scen"] == record["map"]]
    instances = [record for record in records if record not in puzzles]
    squares = [record for record in instances if record["lattice"] == "square"]
    pairs = [(r, quoted[key]) for r in squares if (key := (r["scen"], r["robots"])) in quoted]
    hexagons = {title(record): record for record in instances if record["lattice"] == "hex"}
    plot(pairs, hexagons, docs / "pictures/bench-fleet.svg")
    busy = os.getloadavg()[2] > 1.5 * os.cpu_count()
    cores = ", ".join(sorted({str(record["threads"]) for record in records}))
    parts = {
        "machine": machine(["cores used", cores]),
        "busy": " **The machine was busy with other work: times are too long, and costs at a time too high.**" * busy,
        "peers": peers_table(pairs),
        "all": all_table(instances),
        "puzzles": puzzles_line(puzzles),
    }
    fill("fleet.md", parts, docs / "benchmarks-fleet.md")


main()
