#!/usr/bin/env python3
"""Billboards on two pinned scenes, measured: every row is one command, file to file, as a user would type it.

    cargo build --release --bin lodmark --example scene
    python3 benches/billboards.py                            # print both tables
    python3 benches/billboards.py --out DIR                  # and put growth.csv and growth.svg there
    python3 benches/billboards.py --quads                    # the tables of quads only

The scenes are made by `examples/scene.rs`: a city of 4,200 triangles before a half-space of viewers, a forest of 20,000
triangles around a segment of viewers. Each angle stands beside two baselines: one quad per group of coplanar triangles,
counted here from the file, and the view-independent billboard cloud (Décoret et al. 2003, by the same selection) whose
tolerance is the distance that the angle allows at the nearest row in every direction: its distance to the cell times the
sine. The paper neglects the vertical error, which for the roofs of a city is `--any-height`; without that option the
heights of roofs are bounded too. A share compares like with like: a quad is two triangles.

Growth: user CPU seconds of whole processes on one thread with textures of one texel (the number of texels, not of
faces, decides what drawing costs), least of several; the exponent is the slope of a line through the logarithms.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ANGLES = [0.05, 0.1, 0.2, 0.5]
SCENES = {"city": ["city", "20", "21"], "forest": ["forest", "10000", "500"]}
GROWTH = {
    "city": [["city", str(10 * k), str(10 * k)] for k in (1, 2, 4, 6, 8)],
    "forest": [["forest", str(n), "500"] for n in (2500, 5000, 10000, 20000, 40000)],
    "forest of one density": [["forest", str(n), f"{5 * math.sqrt(n):.6f}"] for n in (2500, 5000, 10000, 20000, 40000)],
}
GROWTH_ANGLE = 0.1


def run(command):
    """User CPU seconds of a whole process."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{message.decode(errors='replace')}")
    return usage.ru_utime


class Scene:
    """A scene and its cell as files."""

    def __init__(self, program, words, folder):
        name = "-".join(words)
        self.mesh, self.cell, self.folder = folder / f"{name}.obj", folder / f"{name}.json", folder
        run([program, *words, self.mesh, self.cell])

    def billboards(self, lodmark, arguments, texels):
        report = self.folder / "report.json"
        command = [lodmark, "billboards", self.mesh, self.folder / "out", "--cell", self.cell, "--json", report]
        seconds = run([*command, "--quiet", "--threads", "1", "--texels", str(texels), *arguments])
        return seconds, json.loads(report.read_text())

    def triangles(self):
        """Corners of the triangles, from the file, with code of its own."""
        positions, triangles = [], []
        for line in self.mesh.read_text().splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                positions.append(tuple(map(float, rest[:3])))
            elif word == "f":
                triangles.append([positions[int(corner.split("/")[0]) - 1] for corner in rest])
        return triangles

    def coplanar_groups(self):
        planes = set()
        for a, b, c in self.triangles():
            u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.sqrt(sum(n * n for n in normal))
            normal = [n / length for n in normal]
            largest = max(range(3), key=lambda i: abs(normal[i]))
            sign = math.copysign(1.0, normal[largest])
            # Single precision leaves some 1e-7 of a normal and of a coordinate.
            offset = sign * sum(n * x for n, x in zip(normal, a))
            planes.add((*(round(sign * n, 5) + 0.0 for n in normal), round(offset, 4) + 0.0))
        return len(planes)

    def nearest(self):
        """The least distance in plan between the triangles and the cell of this scene."""
        if self.mesh.name.startswith("city"):
            return min(p[1] for t in self.triangles() for p in t) + 6.0
        least = math.inf
        for t in self.triangles():
            ends = sorted({(p[0], p[1]) for p in t})
            (x0, y0), (x1, y1) = ends[0], ends[-1]
            for i in range(65):
                x, y = x0 + (x1 - x0) * i / 64, y0 + (y1 - y0) * i / 64
                least = min(least, math.hypot(max(abs(x) - 10.0, 0.0), y))
        return least


def share(report):
    return 100.0 * (2 * report["quads"] + report["triangles_kept"]) / report["triangles_in"]


def quads(lodmark, program, folder):
    rows = [
        "| scene | angle | quads: walls + roofs | share | roofs at any height | view-independent (tolerance) | coplanar groups "
        "| displaced across | up or down | at any height |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name, words in SCENES.items():
        scene = Scene(program, words, folder)
        groups, nearest = scene.coplanar_groups(), scene.nearest()
        for angle in ANGLES:
            _, ours = scene.billboards(lodmark, ["--error-deg", str(angle)], 16)
            _, flat = scene.billboards(lodmark, ["--error-deg", str(angle), "--any-height"], 16)
            tolerance = nearest * math.sin(math.radians(angle))
            _, rigid = scene.billboards(lodmark, ["--error-abs", repr(tolerance)], 16)
            cells = [
                name,
                f"{angle}°",
                f"{ours['quads_vertical']} + {ours['quads_horizontal']} = {ours['quads']}",
                f"{share(ours):.2f} %",
                f"{flat['quads']} ({share(flat):.2f} %)",
                f"{rigid['quads']} ({tolerance:.5f})",
                str(groups),
                f"{ours['displacement_horizontal_deg']:.4f}°",
                f"{ours['displacement_vertical_deg']:.3f}°",
                f"{flat['displacement_vertical_deg']:.3f}°",
            ]
            rows.append(f"| {' | '.join(cells)} |")
            print(rows[-1], file=sys.stderr)
    return rows


def growth(lodmark, program, folder, runs):
    """(series, triangles, user seconds, quads)"""
    found = []
    for name, sizes in GROWTH.items():
        for words in sizes:
            scene = Scene(program, words, folder)
            timed = [scene.billboards(lodmark, ["--error-deg", str(GROWTH_ANGLE)], 1) for _ in range(runs)]
            seconds, report = min(t[0] for t in timed), timed[0][1]
            found.append((name, report["triangles_in"], seconds, report["quads"]))
            print(f"{name}: {found[-1][1]} triangles, {seconds:.2f} s, {report['quads']} quads", file=sys.stderr)
    return found


def slope(points):
    logs = [(math.log(n), math.log(max(s, 1e-3))) for n, s in points]
    mx, my = (sum(p[i] for p in logs) / len(logs) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)


def series(found):
    return {name: [(n, s) for series, n, s, _ in found if series == name] for name in GROWTH}


def figure(found):
    """Both axes logarithmic, with a line of slope 1 through the last point of each series."""
    width, height, left, bottom = 640, 420, 70, 50
    ns, ss = [f[1] for f in found], [max(f[2], 0.01) for f in found]
    low = [math.floor(math.log10(min(ns))), math.floor(math.log10(min(ss)))]
    high = [math.ceil(math.log10(max(ns))), math.ceil(math.log10(max(ss)))]

    def place(n, s):
        x = left + (math.log10(n) - low[0]) / (high[0] - low[0]) * (width - left - 20)
        y = height - bottom - (math.log10(max(s, 0.01)) - low[1]) / (high[1] - low[1]) * (height - bottom - 20)
        return f"{x:.1f},{min(max(y, 20), height - bottom):.1f}"

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for k in range(low[0], high[0] + 1):
        x, y = place(10.0**k, 10.0 ** low[1]).split(",")
        parts.append(f'<line x1="{x}" y1="20" x2="{x}" y2="{y}" stroke="#ddd"/><text x="{x}" y="{float(y) + 16}" text-anchor="middle">{10**k:,}</text>')
    for k in range(low[1], high[1] + 1):
        x, y = place(10.0 ** low[0], 10.0**k).split(",")
        parts.append(f'<line x1="{x}" y1="{y}" x2="{width - 20}" y2="{y}" stroke="#ddd"/><text x="{left - 6}" y="{y}" text-anchor="end">{10.0**k:g} s</text>')
    parts.append(f'<text x="{width / 2}" y="{height - 12}" text-anchor="middle">triangles</text>')
    for i, (name, points) in enumerate(series(found).items()):
        colour = ["#1b6ca8", "#2e8b57", "#b8621b"][i % 3]
        (n, s), first = points[-1], points[0][0]
        line = " ".join(place(*p) for p in points)
        parts.append(f'<polyline points="{place(first, s * first / n)} {place(n, s)}" fill="none" stroke="{colour}" stroke-dasharray="4 4" opacity="0.6"/>')
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{p.split(",")[0]}" cy="{p.split(",")[1]}" r="3" fill="{colour}"/>' for p in line.split()]
        parts.append(f'<text x="{left + 12}" y="{36 + 16 * i}" fill="{colour}">{name}: exponent {slope(points):.2f} (dashed: 1)</text>')
    return "\n".join([*parts, "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
    parser.add_argument("--scene", type=Path, default=ROOT / "target/release/examples/scene", help="the program that makes scenes")
    parser.add_argument("--runs", type=int, default=3, help="processes per point of the growth; the fastest counts [3]")
    parser.add_argument("--quads", action="store_true", help="leave the growth out")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to put growth.csv and growth.svg")
    options = parser.parse_args()
    for program in (options.lodmark, options.scene):
        if not program.exists():
            sys.exit(f"{program} does not exist; expected release builds: cargo build --release --bin lodmark --example scene")
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        print("\n".join(quads(options.lodmark, options.scene, folder)))
        if options.quads:
            return
        found = growth(options.lodmark, options.scene, folder, max(options.runs, 1))
    print("\n| scene | triangles | user seconds | quads |\n|---|---|---|---|")
    print("\n".join(f"| {name} | {n} | {s:.2f} | {q} |" for name, n, s, q in found))
    for name, points in series(found).items():
        print(f"{name}: seconds grow with triangles to the power of {slope(points):.2f}")
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
        lines = ["scene,triangles,user_seconds,quads", *(f"{name},{n},{s:.3f},{q}" for name, n, s, q in found)]
        (options.out / "growth.csv").write_text("\n".join(lines) + "\n")
        (options.out / "growth.svg").write_text(figure(found))


if __name__ == "__main__":
    main()
