"""The Python peers of the benchmarks, called as their documents show. bench/run.sh runs it.

    peers.py WORK OUT paths|fields - -             measure all methods on all maps, append records to OUT
    peers.py WORK OUT paths|fields CASE METHOD     one method on one growing map
    peers.py versions                              names and versions as JSON

Times are CPU time of the thread. Graphs and arrays that a peer needs are made outside the timed part.
"""

import gc
import json
import os
import statistics
import sys
import time
from importlib import metadata

import numpy as np

PASSES = 3
SECONDS = float(os.environ.get("BENCH_SECONDS", "2"))
LEAST = int(os.environ.get("BENCH_LEAST", "10"))
PACKAGES = ["numpy", "scipy", "scikit-image", "igraph", "pyastar2d", "tcod"]


def edges(free):
    """Pairs of neighbouring free cells, each once, as cell numbers."""
    number = np.arange(free.size, dtype=np.int32).reshape(free.shape)
    across, down = free[:, :-1] & free[:, 1:], free[:-1] & free[1:]
    first = np.concatenate([number[:, :-1][across], number[:-1][down]])
    second = np.concatenate([number[:, 1:][across], number[1:][down]])
    return first, second


def scipy_graph(free):
    import scipy.sparse

    first, second = edges(free)
    both = np.concatenate([first, second]), np.concatenate([second, first])
    ones = np.ones(len(both[0]), dtype=np.float64)
    return scipy.sparse.csr_array((ones, both), shape=(free.size, free.size))


def igraph_graph(free):
    import igraph

    return igraph.Graph(n=free.size, edges=np.stack(edges(free), axis=1))


class Pyastar2d:
    def __init__(self, free):
        import pyastar2d

        self.weights = np.where(free, np.float32(1), np.float32(np.inf))
        self.search = pyastar2d.astar_path

    def find(self, sx, sy, tx, ty):
        return self.search(self.weights, (sy, sx), (ty, tx), allow_diagonal=False)

    def steps(self, answer):
        return None if answer is None else len(answer) - 1


class TcodAstar:
    def __init__(self, free):
        import tcod.path

        self.search = tcod.path.AStar(free.astype(np.int8), diagonal=0)

    def find(self, sx, sy, tx, ty):
        return self.search.get_path(sy, sx, ty, tx)

    def steps(self, answer):
        return len(answer) or None  # without the start


class ScipyPaths:
    """A breadth-first tree of the whole part, then the way back; scipy offers nothing that stops at a target."""

    def __init__(self, free):
        import scipy.sparse.csgraph

        self.graph, self.width = scipy_graph(free), free.shape[1]
        self.search = scipy.sparse.csgraph.breadth_first_order

    def find(self, sx, sy, tx, ty):
        start = sy * self.width + sx
        _, before = self.search(self.graph, start, directed=True, return_predecessors=True)
        at = ty * self.width + tx
        path = [at]
        while at != start:
            at = before[at]
            if at < 0:
                return None
            path.append(at)
        return path

    def steps(self, answer):
        return None if answer is None else len(answer) - 1


class SkimagePaths:
    def __init__(self, free):
        import skimage.graph

        self.mcp = skimage.graph.MCP(np.where(free, 1.0, -1.0), fully_connected=False)

    def find(self, sx, sy, tx, ty):
        self.mcp.find_costs([(sy, sx)], [(ty, tx)])
        return self.mcp.traceback((ty, tx))

    def steps(self, answer):
        return len(answer) - 1


class IgraphPaths:
    def __init__(self, free):
        self.graph, self.width = igraph_graph(free), free.shape[1]

    def find(self, sx, sy, tx, ty):
        return self.graph.get_shortest_path(sy * self.width + sx, ty * self.width + tx)

    def steps(self, answer):
        return len(answer) - 1


class TcodField:
    def __init__(self, free):
        import tcod.path

        self.cost, self.search = free.astype(np.int8), tcod.path.dijkstra2d
        self.far = np.iinfo(np.int32).max

    def field(self, x, y):
        distance = np.full(self.cost.shape, self.far, dtype=np.int32)
        distance[y, x] = 0
        return self.search(distance, self.cost, cardinal=1, diagonal=None, out=distance)

    def steps(self, answer):
        return answer, answer != self.far


class ScipyField:
    def __init__(self, free):
        import scipy.sparse.csgraph

        self.graph, self.width = scipy_graph(free), free.shape[1]
        self.search = scipy.sparse.csgraph.dijkstra

    def field(self, x, y):
        return self.search(self.graph, indices=y * self.width + x, unweighted=True)

    def steps(self, answer):
        return answer, np.isfinite(answer)


class ScipyOrder(ScipyField):
    """Breadth-first order and predecessors: no distances, so only the number of reached cells is compared."""

    def __init__(self, free):
        import scipy.sparse.csgraph

        super().__init__(free)
        self.search = scipy.sparse.csgraph.breadth_first_order

    def field(self, x, y):
        return self.search(self.graph, y * self.width + x, directed=True, return_predecessors=True)

    def check(self, answer, wanted):
        assert len(answer[0]) == wanted["reached"], "scipy order reached another number of cells"


class SkimageField:
    def __init__(self, free):
        import skimage.graph

        self.mcp = skimage.graph.MCP(np.where(free, 1.0, -1.0), fully_connected=False)

    def field(self, x, y):
        return self.mcp.find_costs([(y, x)])[0]

    def steps(self, answer):
        return answer - 1, np.isfinite(answer)  # the start's own cost counts too


class IgraphField:
    def __init__(self, free):
        self.graph, self.width = igraph_graph(free), free.shape[1]

    def field(self, x, y):
        return self.graph.distances(source=[y * self.width + x])[0]

    def steps(self, answer):
        answer = np.array(answer)
        return answer, np.isfinite(answer)


PATHS = {
    "pyastar2d": Pyastar2d,
    "tcod A*": TcodAstar,
    "scipy bfs": ScipyPaths,
    "scikit-image MCP": SkimagePaths,
    "igraph": IgraphPaths,
}
FIELDS = {
    "tcod dijkstra2d": TcodField,
    "scipy dijkstra": ScipyField,
    "scipy bfs (no distances)": ScipyOrder,
    "scikit-image MCP": SkimageField,
    "igraph": IgraphField,
}


def digest(steps, reached):
    """As Digest in src/cases.rs, in pieces, so that big maps need little memory."""
    steps, reached = np.ravel(steps), np.ravel(reached)
    count, furthest, total = 0, 0, 0
    for at in range(0, steps.size, 1 << 20):
        here = np.flatnonzero(reached[at : at + (1 << 20)]).astype(np.uint64)
        if not here.size:
            continue
        values = steps[at : at + (1 << 20)][here].astype(np.uint64)
        place = (here + np.uint64(at + 1)) * np.uint64(0x9E3779B97F4A7C15)
        total += int(((values + np.uint64(1)) * place).sum(dtype=np.uint64))
        count += here.size
        furthest = max(furthest, int(values.max()))
    return {"reached": count, "furthest": furthest, "sum": str(total % (1 << 64))}


def memory_kb(line):
    """The peak (VmHWM:) or present (VmRSS:) memory; nothing but Linux has it."""
    try:
        with open("/proc/self/status") as status:
            return next(int(text.split()[1]) for text in status if text.startswith(line))
    except OSError:
        return None


def run_paths(case, method):
    times, start = [], time.monotonic()
    for turn in range(PASSES):
        for i, (sx, sy, tx, ty, wanted) in enumerate(case["tasks"][: None if turn == 0 else len(times)]):
            if time.monotonic() - start > SECONDS and (turn > 0 or i >= LEAST):
                break
            clock = time.thread_time_ns()
            answer = method.find(sx, sy, tx, ty)
            us = (time.thread_time_ns() - clock) / 1e3
            steps = method.steps(answer)
            assert steps == wanted, f"from {sx},{sy} to {tx},{ty}: {steps} steps, the plain queue needs {wanted}"
            if turn == 0:
                times.append([])
            times[i].append(us)
    return {"us": [statistics.median_high(passes) for passes in times]}


def run_fields(case, method):
    ms, start, peak = [], time.monotonic(), None
    while not ms or (len(ms) < 9 and time.monotonic() - start < SECONDS / 2):
        clock = time.thread_time_ns()
        answer = method.field(*case["target"])
        ms.append((time.thread_time_ns() - clock) / 1e6)
        if len(ms) == 1:
            peak = memory_kb("VmHWM:")
            if hasattr(method, "check"):
                method.check(answer, case["field"])
            else:
                found = digest(*method.steps(answer))
                assert found == case["field"], f"the field is {found}, the plain queue's is {case['field']}"
        del answer
    return {"ms": statistics.median_high(ms), "runs": len(ms), "peak_kb": peak}


def main():
    if sys.argv[1:] == ["versions"]:
        found = {name: metadata.version(name) for name in PACKAGES}
        print(json.dumps({"Python": sys.version.split()[0], **found}))
        return
    work, out, part, only_case, only_method = sys.argv[1:]
    with open(os.path.join(work, "map.json" if only_case == "-" else "grow.json")) as file:
        cases = json.load(file)
    kinds, measure = {"paths": (PATHS, run_paths), "fields": (FIELDS, run_fields)}[part]
    for case in cases:
        if only_case not in ("-", case["name"]):
            continue
        path = os.path.join(work, case["name"] + ".bin")
        free = np.fromfile(path, dtype=np.uint8).reshape(case["height"], case["width"]) == 0
        for name, kind in kinds.items():
            if only_method not in ("-", name):
                continue
            before, start = memory_kb("VmRSS:"), time.monotonic()
            method = kind(free)
            setup_ms = (time.monotonic() - start) * 1e3
            gc.collect()
            gc.disable()
            try:
                record = measure(case, method)
            except AssertionError as error:
                sys.exit(f"{name} on {case['name']}: {error}")
            gc.enable()
            record.setdefault("peak_kb", memory_kb("VmHWM:"))
            record |= {"case": case["name"], "part": part, "method": name, "clock": "thread CPU time"}
            record |= {"setup_ms": setup_ms, "before_kb": before}
            with open(out, "a") as file:
                file.write(json.dumps(record) + "\n")
            del method
        print(f"  {part} {case['name']}", file=sys.stderr)


main()
