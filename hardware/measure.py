"""Everything that docs/hardware.md says of size and speed, measured anew and written there: `make hardware`.

Place and route take the tools of hardware/requirements*.txt, the firmware gcc for ARM and QEMU (`make deps`). With QUICK=1
the large designs are left out and nothing is written. Arguments name the parts to measure: decisions, windowed, fabric, player,
firmware; without any, all.
"""

import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from synthesis import ECP5, HX8K, ROOT, SEEDS, bare_luts, measure, ports, registered

WORK = ROOT / "target" / "hardware"
DOCUMENT = ROOT / "docs" / "hardware.md"
QUICK = bool(os.environ.get("QUICK"))
ACTIVECELL = ROOT / "target" / "release" / "activecell"


def note(text: str) -> None:
    print(f"{time.strftime('%H:%M:%S')} {text}", file=sys.stderr, flush=True)


def bundle(name: str, width: int, height: int, *options: str) -> Path:
    """A navigator for a random map, a fifth of it obstacles."""
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    chance = random.Random(width * 1000 + height)
    rows = ["".join("#" if chance.random() < 0.2 else "." for _ in range(width)) for _ in range(height)]
    (folder / "map.txt").write_text("\n".join(rows) + "\n")
    subprocess.run(
        [ACTIVECELL, "generate", "verilog", folder / "map.txt", "-o", folder, "-q", *options],
        check=True, stdout=subprocess.DEVNULL)
    return folder


def sources(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in (folder / "rtl").glob("*.v"))


def table(heads: list[str], rows: list[list[object]]) -> str:
    shown = lambda cell: f"{cell:.2f}" if isinstance(cell, float) and cell < 10 else f"{cell:.1f}" if isinstance(cell, float) else str(cell)
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(map(shown, row)) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def decisions() -> str:
    """One decision between registers, on both parts."""
    rows = []
    for lattice in ("square", "hex"):
        folder = bundle(f"rule_{lattice}", 16, 16, "--lattice", lattice)
        for module in (f"decide_{lattice}", f"sector_{lattice}", "control_next"):
            if module == "control_next" and lattice == "hex":
                continue
            note(module)
            source = (folder / "rtl" / f"{module}.v").read_text()
            (folder / "top.v").write_text(registered(module, ports(source, module)))
            row: list[object] = [f"`{module}`", bare_luts(HX8K, folder, [f"rtl/{module}.v"], module)]
            for part in (HX8K, ECP5):
                found = measure(part, folder, [f"rtl/{module}.v", "top.v"])
                row += [found.luts, round(found.mhz), found.ns]
            rows.append(row)
    heads = ["circuit", "LUTs alone"]
    heads += [f"{part.name}: {what}" for part in (HX8K, ECP5) for what in ("LUTs", "MHz", "ns")]
    return table(heads, rows)


def windowed() -> str:
    cases = [("square", 64), ("square", 256), ("hex", 64), ("hex", 256)]
    rows = []
    for lattice, side in cases[:1] if QUICK else cases:
        # The border takes four columns and rows of the memory.
        folder = bundle(f"windowed_{lattice}_{side}", side - 4, side - 4, "--lattice", lattice)
        for part in (HX8K, ECP5):
            note(f"windowed {lattice} {side} {part.name}")
            found = measure(part, folder, sources(folder), f"windowed_{lattice}", 60)
            rows.append([f"{lattice}, {side} x {side}", part.name, found.luts, found.flip_flops, found.rams,
                         found.mhz, found.ns])
    return table(["memory", "part", "LUTs", "flip-flops", "block RAMs", "MHz", "ns a step"], rows)


def fabric() -> str:
    cases = [
        ("square", 8, 8, HX8K), ("square", 16, 16, HX8K), ("square", 20, 20, HX8K), ("hex", 16, 16, HX8K),
        ("square", 24, 25, ECP5), ("hex", 24, 25, ECP5),
    ]
    rows = []
    for lattice, width, height, part in cases[:1] if QUICK else cases:
        for fixed in (False, True):
            note(f"fabric {lattice} {width} x {height} {'wired in' if fixed else 'loadable'} {part.name}")
            options = ["--lattice", lattice] + (["--fixed-map"] if fixed else [])
            folder = bundle(f"fabric_{lattice}_{width}x{height}_{fixed}", width, height, *options)
            found = measure(part, folder, sources(folder), "fabric", 150, seeds=(1,) if width > 8 else SEEDS)
            cells = width * height
            # Walls in every other row leave one way, there and back through the rows between them.
            steps = width * ((height + 1) // 2) + height // 2 - 1
            serpentine_us = (2 * steps + 7) / found.mhz
            rows.append([f"{lattice}, {width} x {height}", "wired in" if fixed else "loadable", part.name, found.luts,
                         found.luts / cells, found.flip_flops, found.mhz, serpentine_us])
    return table(["cells", "map", "part", "LUTs", "LUTs a cell", "flip-flops", "MHz", "serpentine, us"], rows)


def player() -> str:
    rows = []
    for part in (HX8K, ECP5):
        note(f"player {part.name}")
        folder = bundle("player", 64, 64)
        found = measure(part, folder, sources(folder), "player_top")
        rows.append([part.name, found.luts, found.flip_flops, found.rams, found.mhz])
    return table(["part", "LUTs", "flip-flops", "block RAMs", "MHz"], rows)


def firmware() -> str:
    """Sizes and instructions, from the tests that also judge them."""
    note("firmware")
    done = subprocess.run(
        ["cargo", "test", "--release", "-q", "-p", "activecell-codegen", "--test", "firmware", "--", "--nocapture",
         "code_is_small", "a_step_takes", "misra", "latency"],
        cwd=ROOT, text=True, capture_output=True)
    said = done.stdout + done.stderr
    if done.returncode != 0 or "NOT RUN" in said:
        raise SystemExit(f"hardware: the tests of the firmware did not run (make deps?):\n{said[-2000:]}")
    # The dots that tell of tests stand before some of the lines.
    kept = sorted(line.strip(". ") for line in said.splitlines())
    bytes_of, instructions = (board_table(kept, measured) for measured in ("bytes of", "instructions"))
    rest = "".join(f"- {line}\n" for line in kept if re.match(r"(square|hex): .*(MISRA|ns)", line))
    return f"Bytes of code, and of the map of 64 x 64:\n\n{bytes_of}\nInstructions, mean:\n\n{instructions}\n{rest}"


def board_table(lines: list[str], measured: str) -> str:
    """A row for each line like `square M4: bytes of window 460, step 681`, a column for each name."""
    found = [re.match(rf"(square|hex) (\S+): {measured} (.*)", line) for line in lines]
    rows = [[lattice, core, *re.split(r"[,;] ", values)] for lattice, core, values in (line.groups() for line in found if line)]
    heads = ["cells", "core", *(value.rsplit(" ", 1)[0] for value in rows[0][2:])]
    return table(heads, [[*row[:2], *(value.rsplit(" ", 1)[1] for value in row[2:])] for row in rows])


def main() -> None:
    subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "activecell-cli"], cwd=ROOT, check=True)
    parts = (decisions, windowed, fabric, player, firmware)
    wanted = set(sys.argv[1:]) or {part.__name__ for part in parts}
    for part in (part for part in parts if part.__name__ in wanted):
        found = part()
        print(f"\n{part.__name__}\n\n{found}", flush=True)
        text = DOCUMENT.read_text()
        begin, end = f"<!-- {part.__name__} -->\n", f"<!-- end {part.__name__} -->"
        if begin not in text or end not in text:
            raise SystemExit(f"hardware: {DOCUMENT} has no place for {part.__name__}")
        head, rest = text.split(begin, 1)
        text = head + begin + "\n" + found + "\n" + end + rest.split(end, 1)[1]
        if not QUICK:
            DOCUMENT.with_suffix(".new").write_text(text)
            DOCUMENT.with_suffix(".new").replace(DOCUMENT)


if __name__ == "__main__":
    main()
