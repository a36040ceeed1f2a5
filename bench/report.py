"""Writes docs/benchmarks.md and its plots from the results of a run. bench/run.sh runs it.

    report.py OUT DOCS
"""

import datetime
import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from statistics import mean, median

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

OURS = "ours"
# Colours that stay apart for most eyes (after Wong, Points of view: color blindness, Nature Methods, 2011). The first
# name that a method begins with counts.
COLOURS = {
    "ours compact": "#56b4e9",
    "ours reachable": "#a6d5f2",
    "ours": "#0072b2",
    "queue": "#000000",
    "pathfinding astar": "#e69f00",
    "pathfinding bfs_reach": "#e69f00",
    "pathfinding": "#8c6d31",
    "grid_pathfinding": "#d6c700",
    "pyastar2d": "#009e73",
    "tcod": "#d55e00",
    "scipy bfs (no distances)": "#e8b4d2",
    "scipy": "#cc79a7",
    "scikit-image": "#999999",
    "igraph": "#6a3d9a",
    "l1-path-finder": "#e31a1c",
}


def colour(method):
    return next(colour for name, colour in COLOURS.items() if method.startswith(name))


def number(value):
    """Three digits that count."""
    if value >= 100:
        return f"{value:,.0f}".replace(",", " ")
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def times(ratio):
    return f"×{ratio:.0f}" if ratio >= 9.95 else f"×{ratio:.1f}" if ratio >= 0.095 else f"×{ratio:.3f}"


def quantile(values, share):
    """The smallest value that at least this share of the values does not exceed."""
    values = sorted(values)
    return values[max(0, -(-int(len(values) * share * 1000) // 1000) - 1)]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" + "|---:" * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


class Run:
    """The records of a run, found by part, case and method."""

    def __init__(self, out):
        cases = [case for group in ("map", "grow") for case in json.loads((out / f"work/{group}.json").read_text())]
        self.cases = {case["name"]: case for case in cases}
        records = [json.loads(line) for line in (out / "results.jsonl").read_text().splitlines()]
        self.records = {(r["part"], r["case"], r["method"]): r for r in records}

    def get(self, part, case, method):
        record = self.records.get((part, case, method))
        return None if record is None or "stopped" in record else record

    def methods(self, part, group):
        found = dict.fromkeys(m for (p, c, m) in self.records if p == part and self.cases[c]["group"] == group)
        return list(found)

    def maps(self, group):
        cases = [case for case in self.cases.values() if case["group"] == group]
        # Python sorts stably: synthetic maps stay in the order in which they were made.
        real = {"MovingAI": 0, "ROS": 1, "synthetic": 2}
        return sorted(cases, key=lambda case: (real[case["source"]], case["name"].lower() if case["source"] != "synthetic" else ""))

    def task_us(self, case, method, statistic):
        """The method's figure and its ratio to ours on the same tasks."""
        record, ours = self.get("paths", case, method), self.get("paths", case, OURS)
        if record is None:
            return None
        n = min(len(record["us"]), len(ours["us"])) if ours else 0
        ratio = statistic(record["us"][:n]) / statistic(ours["us"][:n]) if n else None
        return statistic(record["us"]), ratio

    def ns_per_cell(self, case, method):
        record = self.get("fields", case, method)
        return None if record is None else record["ms"] * 1e6 / self.cases[case]["field"]["reached"]


def cell(figure, method):
    if figure is None:
        return "–"
    value, ratio = figure
    return number(value) if method == OURS or ratio is None else f"{number(value)} ({times(ratio)})"


def paths_table(run, statistic, least):
    methods = run.methods("paths", "map")
    rows = []
    for case in run.maps("map"):
        row = [case["name"]]
        for method in methods:
            record = run.get("paths", case["name"], method)
            enough = record is not None and len(record["us"]) >= least
            row.append(cell(run.task_us(case["name"], method, statistic) if enough else None, method))
        rows.append(row)
    return table(["map", *methods], rows)


def samples_table(run):
    methods = run.methods("paths", "map")
    rows = []
    for case in run.maps("map"):
        row = [case["name"], case["source"], f"{case['width']} × {case['height']}", str(len(case["tasks"]))]
        for method in methods:
            record = run.get("paths", case["name"], method)
            row.append("–" if record is None else f"{len(record['us'])}; {number(record['setup_ms'])}")
        rows.append(row)
    return table(["map", "from", "size", "tasks", *methods], rows)


def fields_table(run):
    methods = run.methods("fields", "map")
    rows = []
    for case in run.maps("map"):
        ours = run.ns_per_cell(case["name"], OURS)
        row = [case["name"], f"{case['field']['reached']:,}".replace(",", " ")]
        for method in methods:
            value = run.ns_per_cell(case["name"], method)
            row.append(cell(None if value is None else (value, value / ours if ours else None), method))
        rows.append(row)
    return table(["map", "cells reached", *methods], rows)


def summary_table(run):
    """For every peer the smallest and the middle ratio over all maps."""
    rows = []
    for part, name in [("paths", "query, mean"), ("fields", "whole field")]:
        for method in run.methods(part, "map"):
            if method.startswith(OURS):
                continue
            ratios = []
            for case in run.maps("map"):
                if part == "paths":
                    figure = run.task_us(case["name"], method, mean)
                    ratio = figure and figure[1]
                else:
                    theirs, ours = (run.ns_per_cell(case["name"], m) for m in (method, OURS))
                    ratio = theirs and ours and theirs / ours
                if ratio:
                    ratios.append((ratio, case["name"]))
            if ratios:
                least, most = min(ratios), max(ratios)
                middle = times(median(ratio for ratio, _ in ratios))
                rows.append([f"{name}: {method}", times(least[0]), least[1], middle, times(most[0]), most[1]])
    return table(["against", "least", "on", "middle", "most", "on"], rows)


def growth_tables(run, part):
    """Time and peak memory of each method in maps of growing size."""
    methods = run.methods(part, "grow")
    text = ""
    for kind in dict.fromkeys(name.rsplit("-", 1)[0] for name in (case["name"] for case in run.maps("grow"))):
        cases = [case for case in run.maps("grow") if case["name"].rsplit("-", 1)[0] == kind]
        cases.sort(key=lambda case: case["width"])
        for what in ("ms", "peak"):
            rows = []
            for method in methods:
                row = [method]
                for case in cases:
                    record, ours = (run.get(part, case["name"], m) for m in (method, OURS))
                    if record is None:
                        stopped = run.records.get((part, case["name"], method))
                        row.append("stopped" if stopped else "–")
                        continue
                    if what == "peak":
                        value = (record["peak_kb"] or 0) / 1024
                        base = ours and (ours["peak_kb"] or 0) / 1024
                    elif part == "fields":
                        value, base = record["ms"], ours and ours["ms"]
                    else:
                        n = len(record["us"])
                        value, base = mean(record["us"]) / 1e3, ours and mean(ours["us"][:n]) / 1e3
                    row.append(cell((value, value / base if base else None), method))
                rows.append(row)
            unit = "ms" if what == "ms" else "peak memory of the process, MiB"
            text += f"\n{kind.removeprefix('grow-')}, {unit}:\n\n"
            text += table(["method", *(f"{case['width']}²" for case in cases)], rows)
    return text


def repair_table(run):
    rows = []
    for case in run.maps("map"):
        record = run.get("repair", case["name"], OURS)
        if record is None:
            continue
        us, fresh = record["us"], record["wave_ms"] * 1e3
        row = [case["name"], number(median(us)), number(quantile(us, 0.95)), number(mean(us)), number(max(us))]
        row += [f"{number(us_)} ({times(us_ / mean(us))})" for us_ in (fresh, record["queue_ms"] * 1e3)]
        rows.append(row)
    if not rows:
        return "Not measured: the core as built repairs no fields yet.\n"
    return table(["map", "median", "p95", "mean", "most", "our wave anew (÷ mean)", "plain queue anew (÷ mean)"], rows)


def dots(run, part, value, label, path):
    """A row of dots for each map, one dot a method, on a log scale."""
    maps, methods = run.maps("map"), run.methods(part, "map")
    figure, axes = plt.subplots(figsize=(9, 1.4 + 0.24 * len(maps)))
    for method in methods:
        points = [(value(case["name"], method), y) for y, case in enumerate(maps)]
        points = [(x, y) for x, y in points if x is not None]
        style = {"marker": "D" if method.startswith(OURS) else "o", "s": 30 if method.startswith(OURS) else 18}
        axes.scatter(*zip(*points), color=colour(method), label=method, zorder=3, **style)
    axes.set_xscale("log")
    axes.set_yticks(range(len(maps)), [case["name"] for case in maps], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(label)
    axes.grid(axis="both", color="#dddddd", linewidth=0.6)
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), fontsize=8, frameon=False)
    save(figure, path)


def growth_plot(run, path):
    panels = [("paths", "mean of a query, ms"), ("fields", "whole field, ms")]
    figure, both = plt.subplots(1, 2, figsize=(12, 5))
    for axes, (part, label) in zip(both, panels):
        for method in run.methods(part, "grow"):
            points = []
            for case in run.maps("grow"):
                record = run.get(part, case["name"], method)
                if record and case["name"].startswith("grow-rooms-"):
                    points.append((case["width"], record["ms"] if part == "fields" else mean(record["us"]) / 1e3))
            if points:
                line = {"linewidth": 2.2 if method.startswith(OURS) else 1.1, "marker": "o", "markersize": 3}
                axes.plot(*zip(*sorted(points)), color=colour(method), label=method, **line)
        sizes = sorted({case["width"] for case in run.maps("grow")})
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(sizes, [f"{size}²" for size in sizes])
        axes.set_xlabel("cells (rooms of 64 × 64)")
        axes.set_ylabel(label)
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(fontsize=7, frameon=False)
    save(figure, path)


def save(figure, path, above=0.0):
    """Writes a plot, with so many inches left free above its axes."""
    figure.tight_layout(rect=(0, 0, 1, 1 - above / figure.get_figheight()))
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    plt.close(figure)


def shell(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def machine(*more):
    """What it ran on, with more rows of a name and a text."""
    lines = dict(line.split(":", 1) for line in shell("lscpu").splitlines() if ":" in line)
    lines = {key.strip(): value.strip() for key, value in lines.items()}
    cpu = lines.get("Model name", platform.processor() or platform.machine())
    model = [f"{key.lower()} {lines[key]}" for key in ("CPU family", "Model", "Stepping") if key in lines]
    caches = [f"{key.removesuffix(' cache')} {lines[key]}" for key in lines if key.startswith(("L1d", "L2", "L3"))]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    load = os.getloadavg()[2]
    rows = [
        ["date", datetime.date.today().isoformat()],
        ["processor", ", ".join([cpu, *model])],
        ["caches", "; ".join(caches)],
        ["cores, memory", f"{os.cpu_count()}, {memory:.0f} GiB; load of the last 15 minutes {load:.1f}"],
        ["system", f"{platform.system()} {platform.release()}, {platform.machine()}"],
        ["activecell", shell("git", "describe", "--always", "--dirty") or "unknown"],
        ["compiler", shell("rustc", "--version") + ", `-C target-cpu=native` for everything in Rust"],
        *more,
        ["the run took", f"{os.environ.get('MINUTES', '?')} minutes" + (", in its quick form" if os.environ.get("QUICK") else "")],
    ]
    return "| | |\n|---|---|\n" + "\n".join(f"| {key} | {value} |" for key, value in rows) + "\n"


def peers(out):
    """Their versions."""
    versions = {}
    for line in (out / "versions.jsonl").read_text().splitlines():
        versions |= json.loads(line)
    lock = (Path(__file__).parent / "Cargo.lock").read_text()
    for crate in ("pathfinding", "grid_pathfinding"):
        versions[f"crate {crate}"] = lock.split(f'name = "{crate}"\nversion = "')[1].split('"')[0]
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def fill(template, parts, path):
    """Writes a document: the words of a template with tables in their places."""
    text = (Path(__file__).parent / template).read_text()
    for name, part in parts.items():
        place = f"{{{{{name}}}}}"
        assert place in text, f"{template} has no place for {name}"
        # A part brings the end of its last line, where it has the line for itself.
        alone = f"\n{place}\n" in text
        text = text.replace(f"\n{place}\n", f"\n{part}") if alone else text.replace(place, part)
    path.write_text(text)
    print(f"written: {path}")


def setup_plots():
    matplotlib.rcParams |= {"svg.hashsalt": "activecell", "svg.fonttype": "none", "font.family": "sans-serif"}


def main():
    out, docs = Path(sys.argv[1]), Path(sys.argv[2])
    setup_plots()
    run = Run(out)
    wanting = [r for r in run.records.values() if r.get("stopped")]
    if not all(any(key[2] == OURS for key in run.records if key[0] == part) for part in ("paths", "fields")):
        sys.exit("the results are incomplete: ours is missing")

    def mean_us(case, method):
        figure = run.task_us(case, method, mean)
        return figure and figure[0]

    pictures = docs / "pictures"
    dots(run, "paths", mean_us, "mean of a query, µs", pictures / "bench-queries.svg")
    dots(run, "fields", run.ns_per_cell, "whole field, ns per cell reached", pictures / "bench-fields.svg")
    growth_plot(run, pictures / "bench-growth.svg")

    node = [r["clock"] for r in run.records.values() if r["method"] == "l1-path-finder" and "clock" in r]
    busy = os.getloadavg()[2] > os.cpu_count()
    said = " **The machine was busy: wall times are too long, and all ratios are rough.**"
    parts = {
        "machine": machine(["cores used", "one"], ["peers", peers(out)]),
        "clock": node[0] if node else "not measured in this run",
        "busy": said * busy,
        "summary": summary_table(run),
        "mean": paths_table(run, mean, 1),
        "median": paths_table(run, median, 5),
        "p95": paths_table(run, lambda us: quantile(us, 0.95), 20),
        "p99": paths_table(run, lambda us: quantile(us, 0.99), 100),
        "samples": samples_table(run),
        "fields": fields_table(run),
        "growing-paths": growth_tables(run, "paths"),
        "growing-fields": growth_tables(run, "fields"),
        "stopped": "".join(f"Stopped: {r['method']} on {r['case']} ({r['part']}).\n" for r in wanting),
        "repair": repair_table(run),
    }
    fill("report.md", parts, docs / "benchmarks.md")


if __name__ == "__main__":
    main()
