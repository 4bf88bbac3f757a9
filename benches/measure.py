#!/usr/bin/env python3
"""What lodmark makes, in numbers: every figure is a whole process, file to file, as a user would type it.

    cargo build --release --bin lodmark --example scene
    benches/measure.py table                     the table of the README; --write puts it there
    benches/measure.py table --runs 1 --only 'bunny'          a quick look at some rows
    benches/measure.py table --race              and other programs on the same meshes, in the same run
    benches/measure.py table --psnr              only: PSNR over meshoptimizer's meshes in LODMARK_PEERS
    benches/measure.py curve                     microseconds of CPU a collapse by the size of the mesh, for each method
    benches/measure.py never-worse               is image-driven simplification ever worse than the memoryless method?
    benches/measure.py billboards                quads and growth on the two pinned scenes

Models come from LODMARK_MODELS, meshes that other programs made of them from LODMARK_PEERS, scenes from `benches/scene.rs`;
what is absent is left out and said to be. `measure.py COMMAND --help` tells how each measures.
"""

import argparse
import csv
import hashlib
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODELS = Path(os.environ.get("LODMARK_MODELS", ROOT / "../shared/models"))
PEERS = Path(os.environ.get("LODMARK_PEERS", ROOT / "../shared/peers"))


class Failed(Exception):
    """A process that did not succeed."""


class Run:
    """A whole process: `wall`, `user` and `cpu` seconds, peak memory in `mb`, and what it said in `out`."""

    def __init__(self, command, environment=None):
        with tempfile.TemporaryFile() as answer, tempfile.TemporaryFile() as talk:
            start = time.monotonic()
            process = subprocess.Popen(list(map(str, command)), stdout=answer, stderr=talk, env=environment)
            _, status, usage = os.wait4(process.pid, 0)
            self.wall = time.monotonic() - start
            process.returncode = os.waitstatus_to_exitcode(status)
            answer.seek(0), talk.seek(0)
            self.out, said = answer.read().decode(), talk.read().decode(errors="replace")
        self.user, self.cpu, self.mb = usage.ru_utime, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        if process.returncode != 0:
            raise Failed(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{said}")


class Bench:
    """The programs under test, the options of the command line, and a folder that goes away."""

    def __init__(self, options, folder):
        self.options, self.folder = options, Path(folder)
        self.scene = options.lodmark.parent / "examples/scene"

    def lodmark(self, *words, report=True):
        """Runs lodmark; the process and its report."""
        path = self.folder / f"{os.getpid()}-{abs(hash(words))}.json"
        run = Run([self.options.lodmark, words[0], "-q", *words[1:], *(["--json", path] if report else [])])
        return run, json.loads(path.read_text()) if report else None

    def compare(self, reference, candidates, *more):
        return self.lodmark("compare", *more, reference, *candidates)[1]["candidates"]

    def wanted(self, name):
        return not self.options.only or re.search(self.options.only, name)

    def model(self, *paths):
        """True where all files are there; says so where one is not."""
        missing = [str(path) for path in paths if not path.exists()]
        if missing:
            print(f"left out: {', '.join(missing)} is not there", file=sys.stderr)
        return not missing


def row(cells):
    line = f"| {' | '.join(cells)} |"
    print(line, file=sys.stderr if row.quiet else sys.stdout, flush=True)
    return line


row.quiet = False


def head(*cells):
    line = row(cells)
    print("|" + "---|" * len(cells), file=sys.stderr if row.quiet else sys.stdout, flush=True)
    return [line, "|" + "---|" * len(cells)]


def slope(points):
    """The exponent of a line through the logarithms."""
    logs = [(math.log(n), math.log(max(s, 1e-9))) for n, s in points]
    mx, my = (sum(p[i] for p in logs) / len(logs) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)


def figure(path, series, axis):
    """Series by name over a logarithmic axis of triangles, from 0, each with its exponent."""
    width, height, left, bottom = 640, 420, 70, 50
    points = [p for found in series.values() for p in found]
    low, high = (f(math.log10(n) for n, _ in points) for f in (min, max))
    top = max(y for _, y in points) * 1.1

    def place(n, y):
        x = left + (math.log10(n) - low) / max(high - low, 1e-3) * (width - left - 30)
        return x, height - bottom - y / top * (height - bottom - 20)

    text = '<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}">{}</text>'.format
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="white"/>',
        text(width / 2, height - 12, "middle", "black", f"triangles; {axis}"),
    ]
    for i in range(6):
        x, y = place(10**low, i * top / 5)
        parts.append(f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{width - 30}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(text(x - 6, y + 4, "end", "black", f"{i * top / 5:.3g}"))
    for n in sorted({n for n, _ in points}):
        parts.append(text(place(n, 0)[0], height - bottom + 16, "middle", "black", f"{n // 1000:,} k"))
    for i, (name, found) in enumerate(series.items()):
        colour = ["#1b6ca8", "#2e8b57", "#b8621b", "#7a4b94"][i % 4]
        line = [f"{x:.1f},{y:.1f}" for x, y in (place(*p) for p in found)]
        parts.append(f'<polyline points="{" ".join(line)}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += ['<circle cx="{}" cy="{}" r="3" fill="{}"/>'.format(*p.split(","), colour) for p in line]
        growth = f": exponent {slope(found):+.2f}" if len(found) > 1 else ""
        parts.append(text(left + 12, 36 + 16 * i, "start", colour, name + growth))
    path.write_text("\n".join([*parts, "</svg>", ""]))


def write_csv(path, names, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as out:
        csv.writer(out).writerows([names, *rows])


# --- table: model, arguments of `simplify`, and the peer whose RMS is the divisor.
LINDSTROM_TURK, GARLAND_HECKBERT = "cgal-lindstrom-turk", "cgal-garland-heckbert"
ROWS = [
    ("bunny", "1333", ["--preset", "fast"], LINDSTROM_TURK),
    ("bunny", "1333", [], LINDSTROM_TURK),
    ("bunny", "1333", ["--preset", "best"], LINDSTROM_TURK),
    ("bunny", "304", [], LINDSTROM_TURK),
    ("dragon", "8191", [], LINDSTROM_TURK),
    ("bunny", "1333", ["--shading", "gouraud"], LINDSTROM_TURK),
    ("bunny", "1333", ["--shading", "mixed"], LINDSTROM_TURK),
    ("dragon", "8191", ["--method", "memoryless"], LINDSTROM_TURK),
    ("dragon", "8191", ["--method", "quadric"], GARLAND_HECKBERT),
]
PROGRAMS = ["fast-simplification", "meshoptimizer", "pyfqmr", "pymeshlab"]
BEGIN, END = "<!-- table: begin (benches/measure.py table --write) -->", "<!-- table: end -->"


def named_rows(bench):
    """Name, model, level, arguments, file of the model and file of the peer, of every row that can be measured."""
    for model, level, more, by in ROWS:
        arguments = ["--triangles", level, *more]
        name = f"{model} `{' '.join(arguments)}`"
        source, rival = MODELS / f"{model}.ply", PEERS / f"{model}-{level}-{by}.ply"
        if bench.wanted(name) and bench.model(source, rival):
            yield name, model, level, arguments, source, rival


def ratios(ours, theirs):
    return {key: ours[key] / theirs[key] for key in ("rms_flat", "rms_gouraud")}


def table(bench):
    """Every row of the README's table.

    Seconds are the least wall time of several whole processes (other work on the machine only ever adds), with the peak
    memory of the largest. Ratios are RMS by `lodmark compare` over that of the mesh which CGAL made of the same model by
    its Lindstrom-Turk simplification, for the quadric row by its Garland-Heckbert one: no baseline of our own can drift.
    `--race` times programs that pip has (benches/peers: versions and hashes are pinned; installed below target/peers the
    first time), each in a Python of its own, and says what simplification alone took in it.
    """
    options = bench.options
    if options.psnr:
        return psnr(bench)
    row.quiet = True
    lines = head("command: `lodmark simplify MODEL OUT ...`", "seconds", "MB", "flat RMS", "ratio", "Gouraud RMS", "ratio", "folds, flipped")
    out = bench.folder / "out.ply"
    for name, _, _, arguments, source, rival in named_rows(bench):
        runs = [bench.lodmark("simplify", source, out, *arguments, report=False)[0] for _ in range(options.runs)]
        ours, theirs = bench.compare(source, [out, rival])
        cells = [f"{min(r.wall for r in runs):.2f}", f"{max(r.mb for r in runs):.0f}"]
        for key, ratio in ratios(ours, theirs).items():
            cells += [f"{ours[key]:.3f}", f"{ratio:.3f}"]
        lines.append(row([name, *cells, f"{ours['folded_edges']}, {ours['flipped_faces']}"]))
    print("\n".join(lines))
    if options.race:
        print("\n" + "\n".join(race(bench)))
    if options.write:
        readme = ROOT / "README.md"
        text = readme.read_text()
        if options.only or text.count(BEGIN) != 1 or text.count(END) != 1:
            sys.exit("README.md: expected one pair of table marks, and a run of all rows")
        before, after = text.split(BEGIN)[0], text.split(END)[1]
        scratch = readme.with_suffix(".md.new")
        scratch.write_text(before + "\n".join([BEGIN, *lines, END]) + after)
        scratch.replace(readme)


def installed(package):
    """The folder with a package of benches/peers; what has its name is complete."""
    requirements = ROOT / "benches/peers" / f"{package}.txt"
    stamp = hashlib.sha256(requirements.read_bytes() + sys.version.encode()).hexdigest()[:16]
    folder = ROOT / "target/peers" / f"{package}-{stamp}"
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as partial:
            pip = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--require-hashes", "--disable-pip-version-check"]
            Run([*pip, "--target", f"{partial}/packages", "-r", requirements])
            Path(partial, "packages").rename(folder)
    return str(folder)


def race(bench):
    lines = head("program", "model", "triangles", "seconds", "alone", "MB", "flat ratio", "Gouraud ratio", "folds, flipped")
    levels, out = {}, bench.folder / "out.ply"
    for _, model, level, _, source, rival in named_rows(bench):
        levels.setdefault((model, level), (source, rival))
    for (model, level), (source, rival) in levels.items():
        for program in PROGRAMS:
            try:
                path = os.pathsep.join(installed(package) for package in ("numpy", program))
                command = [sys.executable, ROOT / "benches/peers/race.py", program, source, out, level]
                environment = os.environ | {"PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"}
                runs = [Run(command, environment) for _ in range(bench.options.runs)]
            except Failed as failed:
                print(f"left out: {program} on {model}: {str(failed).strip().splitlines()[-1]}", file=sys.stderr)
                continue
            ours, theirs = bench.compare(source, [out, rival])
            # A program may print as well; the last word is ours.
            alone = min(float(r.out.split()[-1]) for r in runs)
            cells = [program, model, str(ours["candidate"]["triangles"]), f"{min(r.wall for r in runs):.2f}", f"{alone:.2f}"]
            cells += [f"{max(r.mb for r in runs):.0f}", *(f"{ratio:.3f}" for ratio in ratios(ours, theirs).values())]
            lines.append(row([*cells, f"{ours['folded_edges']}, {ours['flipped_faces']}"]))
    return lines


def psnr(bench):
    """By how many decibels the default beats meshoptimizer's meshes, at every level that there is."""
    gains, out = {"psnr_flat": [], "psnr_gouraud": []}, bench.folder / "out.ply"
    head("mesh", "triangles: theirs, ours", "flat dB: theirs, ours", "gain", "Gouraud dB: theirs, ours", "gain")
    for rival in sorted(PEERS.glob("*-meshoptimizer.ply")):
        model, level, _ = rival.stem.split("-", 2)
        source = MODELS / f"{model}.ply"
        if not bench.model(source):
            continue
        bench.lodmark("simplify", source, out, "--triangles", level, report=False)
        ours, theirs = bench.compare(source, [out, rival])
        cells = [f"{model} {level}", f"{theirs['candidate']['triangles']}, {ours['candidate']['triangles']}"]
        for key, found in gains.items():
            found.append(ours[key] - theirs[key])
            cells += [f"{theirs[key]:.2f}, {ours[key]:.2f}", f"{found[-1]:+.2f}"]
        row(cells)
    if gains["psnr_flat"]:
        means = [sum(found) / len(found) for found in gains.values()]
        print(f"mean over {len(gains['psnr_flat'])} levels: flat {means[0]:+.2f} dB, Gouraud {means[1]:+.2f} dB")


# --- curve: squares along a side; twice their square is the number of triangles.
SIDES = [187, 296, 469, 660, 920]


def curve(bench):
    """What a collapse costs by the size of the mesh, 70 thousand to 1.7 million triangles; about 3 minutes.

    Whole processes on one thread down to a hundredth of the triangles; CPU seconds (user and system) less those of a
    process that only copies the mesh, over the number of collapses. So preparation, queue, pictures and polishing are
    counted in, and reading, welding and writing are not. The least of several runs counts. The surface is one height
    field (`waves`) at growing resolution, and the bunny and the dragon where they are there: their shapes differ, so the
    line goes through the height fields only. Its exponent is 0 where time is linear.
    """
    head("method", "mesh", "triangles", "CPU seconds", "microseconds per collapse")
    methods, rows = bench.options.methods.split(","), []
    meshes = [("waves", side) for side in SIDES] + [(name, None) for name in ("bunny", "dragon")]
    for name, side in meshes:
        mesh = bench.folder / "waves.ply" if side else MODELS / f"{name}.ply"
        if side:
            Run([bench.scene, "waves", side, mesh])
        if not bench.model(mesh):
            continue

        def least(*arguments):
            command = ["simplify", "--threads", 1, mesh, bench.folder / "out.ply", *arguments]
            runs = [bench.lodmark(*command) for _ in range(bench.options.runs)]
            return min(run.cpu for run, _ in runs), runs[0][1]

        copying, report = least("--triangles", 10**9)
        triangles = report["triangles_in"]
        for method in methods:
            seconds, report = least("--triangles", triangles // 100, "--method", method)
            collapses = sum(phase["counters"]["collapses"] for phase in report["phases"])
            seconds -= copying
            rows.append([method, name, triangles, collapses, seconds, seconds / collapses * 1e6])
            row([method, name, f"{triangles:,}", f"{seconds:.2f}", f"{rows[-1][5]:.2f}"])
    waves = {method: [(r[2], r[5]) for r in rows if r[:2] == [method, "waves"]] for method in methods}
    for method, points in waves.items():
        costs = [cost for _, cost in points]
        print(f"{method}: growth {slope(points):+.3f}, dearest over cheapest {max(costs) / min(costs):.2f}")
    out = bench.options.out or ROOT / "target/curve"
    names = ["method", "mesh", "triangles", "collapses", "cpu_seconds", "microseconds_per_collapse"]
    write_csv(out / "curve.csv", names, [[*r[:4], f"{r[4]:.3f}", f"{r[5]:.4f}"] for r in rows])
    figure(out / "curve.svg", waves, "microseconds of CPU per collapse")
    print(f"written: {out}/curve.csv and curve.svg")


# --- never-worse: the levels of the paper's table and of the peers' meshes, and coarser and finer ones.
MODEL_LEVELS = {"spot.obj": [2_000, 500, 100], "bunny.ply": [2_899, 1_333, 304], "dragon.ply": [8_191]}
# Shares of a scene's triangles; levels below this many are no longer the scene.
SHARES, LEAST = [0.5, 0.1], 8
BILLBOARD_SCENES = ["city 20 21", "forest 2500 250"]
DRIVERS = ["flat", "gouraud", "mixed", "memoryless"]
# What no picture and no file shows.
LEAST_RMS, LEAST_DISTANCE = 0.005, 1e-7
# Name of a ratio, whose result, by which figure, and whether it is held against 1.
RATIOS = [
    ("flat", "flat", "rms_flat", True),
    ("gouraud", "gouraud", "rms_gouraud", True),
    ("mixed", "mixed", "rms_mixed", True),
    ("distance", "flat", "distance_mean", True),
    ("mixed, flat", "mixed", "rms_flat", False),
    ("mixed, gouraud", "mixed", "rms_gouraud", False),
]


def inputs(bench):
    """Names, files and levels."""
    scenes = [(name, ["mesh", name]) for name in Run([bench.scene, "names"]).out.split()]
    for name, words in scenes + [(name, name.split()) for name in BILLBOARD_SCENES]:
        if bench.wanted(name):
            file = bench.folder / f"{'-'.join(words)}.obj"
            Run([bench.scene, *words, file] + ([] if words[0] == "mesh" else [bench.folder / "cell.json"]))
            triangles = sum(line.startswith("f ") for line in file.open())
            yield name, file, [n for n in (round(share * triangles) for share in SHARES) if n >= LEAST]
    for name, levels in MODEL_LEVELS.items():
        if bench.wanted(name) and bench.model(MODELS / name):
            yield name, MODELS / name, levels


def judged(bench, file, level):
    """What `compare` says of the result of every driver."""
    outs = {driver: bench.folder / f"{driver}.ply" for driver in DRIVERS}

    def simplify(driver):
        own = ["--shading", driver, "--preset", bench.options.preset]
        own = ["--method", "memoryless"] if driver == "memoryless" else own
        # One thread each, and several runs at a time: results do not depend on it.
        return bench.lodmark("simplify", "--threads", 1, file, outs[driver], "--triangles", level, *own)[1]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        reports = list(pool.map(simplify, DRIVERS))
    found = dict(zip(DRIVERS, bench.compare(file, outs.values(), "--distance-samples", 100_000)))
    for figures, report in zip(found.values(), reports):
        figures["triangles"] = report["triangles_out"]
        figures["rms_mixed"] = math.hypot(figures["rms_flat"], figures["rms_gouraud"]) / math.sqrt(2)
    return found


def never_worse(bench):
    """Every level by images that are shaded flat, by Gouraud and mixed, and by the memoryless method.

    Each result is judged by `lodmark compare` with the shading that drove it (mixed: root of the mean of both squares, as
    the driving views are half of each; both single ratios are printed as well), and a flat-driven result by its mean
    surface distance too. Ratios are to the memoryless mesh of the same level. A ratio above 1 is marked `**so**`, and the
    exit code is 1. Where neither result can be told from the original (both below 0.005 levels, or 1e-7 of the diagonal)
    the ratio is `=`.
    """
    head("input", "triangles", "flat", "Gouraud", "mixed", "distance, flat-driven", "mixed: flat, Gouraud")
    kept = ["triangles", "rms_flat", "rms_gouraud", "distance_mean", "distance_max", "folded_edges"]
    rows, worse = [], []
    for name, file, levels in inputs(bench):
        for level in levels:
            found, text = judged(bench, file, level), {}
            for key, driver, figure_, held in RATIOS:
                ours, theirs = found[driver][figure_], found["memoryless"][figure_]
                if max(ours, theirs) <= (LEAST_DISTANCE if figure_ == "distance_mean" else LEAST_RMS):
                    text[key] = "="
                    continue
                ratio = ours / theirs if theirs > 0 else math.inf
                text[key] = f"{ratio:.3f}"
                if held and ratio > 1:
                    text[key] = f"**{text[key]}**"
                    worse.append(f"{name} {level} {key}")
            counts = sorted({figures["triangles"] for figures in found.values()})
            cells = [text[key] for key, *_, held in RATIOS if held]
            count = " to ".join(map(str, dict.fromkeys([counts[0], counts[-1]])))
            row([name, count, *cells, f"{text['mixed, flat']}, {text['mixed, gouraud']}"])
            rows += [[name, level, driver, *map(figures.get, kept)] for driver, figures in found.items()]
    if bench.options.csv:
        write_csv(bench.options.csv, ["input", "target", "driver", *kept], rows)
    print(f"\n{len(worse)} of {len(rows)} ratios are above 1" + (f": {', '.join(worse)}" if worse else ""))
    sys.exit(1 if worse else 0)


# --- billboards
ANGLES = [0.05, 0.1, 0.2, 0.5]
SCENES = {"city": ["city", "20", "21"], "forest": ["forest", "10000", "500"]}
TREES = (2500, 5000, 10000, 20000, 40000)
GROWTH = {
    "city": [["city", str(10 * k), str(10 * k)] for k in (1, 2, 4, 6, 8)],
    "forest": [["forest", str(n), "500"] for n in TREES],
    "forest of one density": [["forest", str(n), f"{5 * math.sqrt(n):.6f}"] for n in TREES],
}
GROWTH_ANGLE = 0.1


class Scene:
    """A scene and its cell as files."""

    def __init__(self, bench, words):
        name = "-".join(words)
        self.bench, self.mesh, self.cell = bench, bench.folder / f"{name}.obj", bench.folder / f"{name}.json"
        Run([bench.scene, *words, self.mesh, self.cell])

    def billboards(self, texels, *arguments):
        command = ["billboards", self.mesh, self.bench.folder / "out", "--cell", self.cell, "--threads", 1]
        return self.bench.lodmark(*command, "--texels", texels, *arguments)

    def triangles(self):
        """Corners of the triangles, from the file, with code of its own."""
        lines = [line.split() for line in self.mesh.read_text().splitlines()]
        positions = [tuple(map(float, words[1:4])) for words in lines if words[:1] == ["v"]]
        faces = (words[1:] for words in lines if words[:1] == ["f"])
        return [[positions[int(corner.split("/")[0]) - 1] for corner in face] for face in faces]

    def coplanar_groups(self):
        planes = set()
        for a, b, c in self.triangles():
            u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            largest = max(normal, key=abs)
            normal = [math.copysign(n / math.hypot(*normal), n * largest) for n in normal]
            # Single precision leaves some 1e-7 of a normal and of a coordinate.
            offset = sum(n * x for n, x in zip(normal, a))
            planes.add((*(round(n, 5) + 0.0 for n in normal), round(offset, 4) + 0.0))
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


def billboards(bench):
    """Billboards on a city of 4,200 triangles before a half-space of viewers and a forest of 20,000 around a segment.

    Each angle stands beside two baselines: one quad per group of coplanar triangles, counted here from the file, and the
    view-independent billboard cloud (Decoret et al. 2003, by the same selection) whose tolerance is the distance that the
    angle allows at the nearest row in every direction: its distance to the cell times the sine. The paper neglects the
    vertical error, which for the roofs of a city is `--any-height`; without that option the heights of roofs are bounded
    too. A share compares like with like: a quad is two triangles. Growth: user CPU seconds of whole processes on one
    thread with textures of one texel (the number of texels, not of faces, decides what drawing costs), least of several;
    the exponent is the slope of a line through the logarithms. `--out` takes growth.csv and growth.svg.
    """
    head(
        "scene", "angle", "quads: walls + roofs", "share", "roofs at any height", "view-independent (tolerance)", "coplanar groups",
        "displaced across", "up or down", "at any height",
    )  # fmt: skip
    share = lambda report: 100.0 * (2 * report["quads"] + report["triangles_kept"]) / report["triangles_in"]
    for name, words in SCENES.items():
        scene = Scene(bench, words)
        groups, nearest = scene.coplanar_groups(), scene.nearest()
        for angle in ANGLES:
            tolerance = nearest * math.sin(math.radians(angle))
            ours = scene.billboards(16, "--error-deg", angle)[1]
            flat = scene.billboards(16, "--error-deg", angle, "--any-height")[1]
            rigid = scene.billboards(16, "--error-abs", repr(tolerance))[1]
            counts = f"{ours['quads_vertical']} + {ours['quads_horizontal']} = {ours['quads']}"
            cells = [name, f"{angle}°", counts, f"{share(ours):.2f} %", f"{flat['quads']} ({share(flat):.2f} %)"]
            cells += [f"{rigid['quads']} ({tolerance:.5f})", str(groups), f"{ours['displacement_horizontal_deg']:.4f}°"]
            row(cells + [f"{report['displacement_vertical_deg']:.3f}°" for report in (ours, flat)])
    if bench.options.quads:
        return
    print()
    head("scene", "triangles", "user seconds", "quads")
    rows = []
    for name, sizes in GROWTH.items():
        for words in sizes:
            scene = Scene(bench, words)
            runs = [scene.billboards(1, "--error-deg", GROWTH_ANGLE) for _ in range(bench.options.runs)]
            report = runs[0][1]
            rows.append((name, report["triangles_in"], min(run.user for run, _ in runs), report["quads"]))
            row([name, str(rows[-1][1]), f"{rows[-1][2]:.2f}", str(rows[-1][3])])
    series = {name: [r[1:3] for r in rows if r[0] == name] for name in GROWTH}
    for name, points in series.items():
        print(f"{name}: seconds grow with triangles to the power of {slope(points):.2f}")
    if bench.options.out:
        names = ["scene", "triangles", "user_seconds", "quads"]
        write_csv(bench.options.out / "growth.csv", names, [[n, t, f"{s:.3f}", q] for n, t, s, q in rows])
        figure(bench.options.out / "growth.svg", series, "user seconds")


def main():
    about = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = about.add_subparsers(required=True, metavar="COMMAND")

    def command(run, runs=None):
        name = run.__name__.replace("_", "-")
        own = commands.add_parser(name, description=run.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
        own.set_defaults(run=run, only=None)
        own.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
        if runs:
            own.add_argument("--runs", type=int, default=runs, help=f"processes per figure; the fastest counts [{runs}]")
        return own

    own = command(table, 3)
    own.add_argument("--only", metavar="REGEX", help="rows whose name matches")
    own.add_argument("--race", action="store_true", help="time other programs as well, installed by pip")
    own.add_argument("--psnr", action="store_true", help="only measure PSNR over meshoptimizer's meshes")
    own.add_argument("--write", action="store_true", help="replace the table in README.md")
    own = command(curve, 1)
    own.add_argument("--methods", default="memoryless,quadric,image", help="which, with commas between [all three]")
    own.add_argument("--out", type=Path, metavar="DIR", help="where curve.csv and curve.svg go [target/curve]")
    own = command(never_worse)
    own.add_argument("--only", metavar="REGEX", help="inputs whose name matches")
    own.add_argument("--preset", default="default", help="recipe of the image method [default]")
    own.add_argument("--csv", type=Path, help="write all figures there")
    own = command(billboards, 3)
    own.add_argument("--quads", action="store_true", help="leave the growth out")
    own.add_argument("--out", type=Path, metavar="DIR", help="where to put growth.csv and growth.svg")
    options = about.parse_args()
    for program in [options.lodmark] + [options.lodmark.parent / "examples/scene"] * (options.run is not table):
        if not program.exists():
            sys.exit(f"{program} does not exist; expected: cargo build --release --bin lodmark --example scene")
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        try:
            options.run(Bench(options, folder))
        except Failed as failed:
            sys.exit(str(failed))


if __name__ == "__main__":
    main()
