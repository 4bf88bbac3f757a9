#!/usr/bin/env python3
"""What a collapse costs by the size of the mesh: microseconds of CPU, for each method.

    cargo build --release --bin lodmark --example scene
    python3 benches/curve.py                                 # 70 thousand to 1.7 million triangles; about 3 minutes
    python3 benches/curve.py --methods memoryless --runs 3   # one method, more closely

Whole processes on one thread down to a hundredth of the triangles; CPU seconds (user and system) less those of a process
that only copies the mesh, over the number of collapses. So preparation, queue, pictures and polishing are counted in,
and reading, welding and writing are not. The least of several runs counts. The surface is one height field (`waves`) at
growing resolution, and the bunny and the dragon of LODMARK_MODELS where they are there: their shapes differ, so a line
is drawn through the height fields only. `growth` is the exponent of that line: 0 is flat, linear time.

Writes curve.csv and curve.svg into target/curve or the folder that --out names.
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODELS = Path(os.environ.get("LODMARK_MODELS", ROOT / "../shared/models"))
# Squares along a side; twice their square is the number of triangles.
SIDES = [187, 296, 469, 660, 920]
METHODS = ["memoryless", "quadric", "image"]
COLOURS = {"memoryless": "#1b6ca8", "quadric": "#2e8b57", "image": "#b8621b"}


def cpu_seconds(command):
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{message.decode(errors='replace')}")
    return usage.ru_utime + usage.ru_stime


class Meter:
    """Runs of one program."""

    def __init__(self, lodmark, runs, folder):
        self.lodmark, self.runs, self.folder = lodmark, runs, folder

    def seconds(self, mesh, arguments):
        out, report = self.folder / "out.ply", self.folder / "report.json"
        command = [self.lodmark, "simplify", "-q", "--threads", "1", mesh, out, "--json", report, *arguments]
        least = min(cpu_seconds(command) for _ in range(self.runs))
        return least, json.loads(report.read_text())

    def rows(self, name, mesh, methods):
        copying, report = self.seconds(mesh, ["--triangles", 10**9])
        triangles = report["triangles_in"]
        for method in methods:
            seconds, report = self.seconds(mesh, ["--triangles", triangles // 100, "--method", method])
            collapses = sum(phase["counters"]["collapses"] for phase in report["phases"])
            row = [method, name, triangles, collapses, seconds - copying, (seconds - copying) / collapses * 1e6]
            print(f"| {method} | {name} | {triangles:,} | {row[4]:.2f} | {row[5]:.2f} |", flush=True)
            yield row


def exponent(points):
    logs = [(math.log(n), math.log(max(cost, 1e-9))) for n, cost in points]
    mx, my = (sum(p[i] for p in logs) / len(logs) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)


def figure(rows):
    """Triangles on a logarithmic axis; cost from 0."""
    width, height, left, bottom = 640, 420, 60, 50
    low, high = (f(math.log10(row[2]) for row in rows) for f in (min, max))
    span = max(high - low, 1e-3)
    top = max(row[5] for row in rows) * 1.1

    def place(n, cost):
        x = left + (math.log10(n) - low) / span * (width - left - 30)
        return x, height - bottom - cost / top * (height - bottom - 20)

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="white"/>',
    ]
    step = 10 ** math.floor(math.log10(top / 2))
    step *= next(k for k in (1, 2, 5, 10) if top / (k * step) <= 8)
    for i in range(math.floor(top / step) + 1):
        x, y = place(10**low, i * step)
        parts.append(f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{width - 30}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{x - 6:.1f}" y="{y + 4:.1f}" text-anchor="end">{i * step:g}</text>')
    for n in sorted({row[2] for row in rows if row[1] == "waves"} or {row[2] for row in rows}):
        x, y = place(n, 0)
        parts.append(f'<text x="{x:.1f}" y="{y + 16:.1f}" text-anchor="middle">{n // 1000:,} k</text>')
    parts.append(f'<text x="{width / 2}" y="{height - 12}" text-anchor="middle">triangles; microseconds of CPU per collapse</text>')
    for i, method in enumerate(dict.fromkeys(row[0] for row in rows)):
        colour = COLOURS.get(method, "#555")
        waves = [(row[2], row[5]) for row in rows if row[:2] == [method, "waves"]]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in (place(*p) for p in waves))
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for _, name, n, _, _, cost in (row for row in rows if row[0] == method):
            x, y = place(n, cost)
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour if name == "waves" else "white"}" stroke="{colour}"/>')
            if name != "waves":
                parts.append(f'<text x="{x + 6:.1f}" y="{y - 5:.1f}" fill="{colour}">{name}</text>')
        growth = f": growth {exponent(waves):+.2f}" if len(waves) > 1 else ""
        parts.append(f'<text x="{left + 12}" y="{36 + 16 * i}" fill="{colour}">{method}{growth}</text>')
    return "\n".join([*parts, "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
    parser.add_argument("--methods", default=",".join(METHODS), help="which, with commas between [all three]")
    parser.add_argument("--runs", type=int, default=1, help="processes per point; the fastest counts [1]")
    parser.add_argument("--out", type=Path, metavar="DIR", default=ROOT / "target/curve", help="where curve.csv and curve.svg go")
    options = parser.parse_args()
    scene = options.lodmark.parent / "examples/scene"
    for program in (options.lodmark, scene):
        if not program.exists():
            sys.exit(f"{program} does not exist; expected: cargo build --release --bin lodmark --example scene")
    print("| method | mesh | triangles | CPU seconds | microseconds per collapse |\n|---|---|---|---|---|", flush=True)
    rows, methods = [], options.methods.split(",")
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        meter = Meter(options.lodmark, max(options.runs, 1), folder)
        for side in SIDES:
            mesh = folder / "waves.ply"
            cpu_seconds([scene, "waves", side, mesh])
            rows += meter.rows("waves", mesh, methods)
        for name in ("bunny", "dragon"):
            if (MODELS / f"{name}.ply").exists():
                rows += meter.rows(name, MODELS / f"{name}.ply", methods)
            else:
                print(f"left out: {MODELS / name}.ply is not there", file=sys.stderr)
    print()
    for method in methods:
        waves = [(row[2], row[5]) for row in rows if row[:2] == [method, "waves"]]
        costs = [cost for _, cost in waves]
        print(f"{method}: growth {exponent(waves):+.3f}, dearest over cheapest {max(costs) / min(costs):.2f}")
    options.out.mkdir(parents=True, exist_ok=True)
    with (options.out / "curve.csv").open("w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["method", "mesh", "triangles", "collapses", "cpu_seconds", "microseconds_per_collapse"])
        writer.writerows([*row[:4], f"{row[4]:.3f}", f"{row[5]:.4f}"] for row in rows)
    (options.out / "curve.svg").write_text(figure(rows))
    print(f"written: {options.out}/curve.csv and curve.svg")


if __name__ == "__main__":
    main()
