#!/usr/bin/env python3
"""Is image-driven simplification ever worse than the memoryless method that it starts from?

    cargo build --release --bin lodmark --example scene
    python3 benches/never_worse.py                           # all models, levels and generated scenes
    python3 benches/never_worse.py --only 'spot|engine'      # some of them
    python3 benches/never_worse.py --csv target/never.csv    # all figures too
    python3 benches/never_worse.py --preset best             # another recipe

Every level is simplified by images that are shaded flat, by Gouraud and mixed, and by the memoryless method; each result
is judged by `lodmark compare` with the shading that drove it (mixed: root of the mean of both squares, as the driving
views are half of each; both single ratios are printed as well), and a flat-driven result by its mean surface distance
too. Ratios are to the memoryless mesh of the same level. A ratio above 1 is marked `**so**`, and the exit code is 1.
Where neither result can be told from the original (both below 0.005 levels, or 1e-7 of the diagonal) the ratio is `=`.

Models come from LODMARK_MODELS, scenes from `examples/scene.rs`: all that it has names for, and both kinds that
billboards are measured on.
"""

import argparse
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODELS = Path(os.environ.get("LODMARK_MODELS", ROOT / "../shared/models"))
# The levels of the paper's table and of the peers' meshes, and coarser and finer ones.
MODEL_LEVELS = {
    "spot.obj": [2_000, 500, 100],
    "bunny.ply": [2_899, 1_333, 304],
    "dragon.ply": [8_191],
}
# Shares of a scene's triangles; levels below this many are no longer the scene.
SHARES, LEAST = [0.5, 0.1], 8
BILLBOARD_SCENES = [["city", "20", "21"], ["forest", "2500", "250"]]
DRIVERS = ["flat", "gouraud", "mixed"]
# What no picture and no file shows.
LEAST_RMS, LEAST_DISTANCE = 0.005, 1e-7


def run(command):
    """Standard output of a command; ends the program where it fails."""
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def inputs(scene, lodmark, folder, only):
    """Names, files and levels."""
    scenes = [(name, ["mesh", name]) for name in run([scene, "names"]).split()]
    scenes += [(" ".join(words), words) for words in BILLBOARD_SCENES]
    for name, words in scenes:
        if only and not re.search(only, name):
            continue
        file = folder / f"{'-'.join(words)}.obj"
        run([scene, *words, file] + ([] if words[0] == "mesh" else [folder / "cell.json"]))
        triangles = sum(line.startswith("f ") for line in file.open())
        levels = [round(share * triangles) for share in SHARES]
        yield name, file, [n for n in levels if n >= LEAST]
    for name, levels in MODEL_LEVELS.items():
        if only and not re.search(only, name):
            continue
        if (MODELS / name).exists():
            yield name, MODELS / name, levels
        else:
            print(f"left out: {MODELS / name} is not there", file=sys.stderr)


def measure(lodmark, file, level, folder, options):
    """What `compare` says of each result, by driver."""
    drivers = [*DRIVERS, "memoryless"]
    outs = {driver: folder / f"{driver}.ply" for driver in drivers}

    def simplify(driver):
        own = ["--method", "memoryless"] if driver == "memoryless" else ["--shading", driver, *options]
        report = folder / f"{driver}.json"
        # One thread each, and several runs at a time: results do not depend on it.
        command = [lodmark, "simplify", "-q", "--threads", 1, file, outs[driver], "--triangles", level, *own]
        run([*command, "--json", report])
        return json.loads(report.read_text())["triangles_out"]

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        reached = dict(zip(drivers, pool.map(simplify, drivers)))
    report = folder / "compare.json"
    run([lodmark, "compare", "-q", "--distance-samples", 100_000, file, *outs.values(), "--json", report])
    found = dict(zip(outs, json.loads(report.read_text())["candidates"]))
    for driver, figures in found.items():
        figures["triangles"] = reached[driver]
        squares = figures["rms_flat"] ** 2 + figures["rms_gouraud"] ** 2
        figures["rms_mixed"] = math.sqrt(squares / 2)
    return found


def ratio(ours, theirs, least):
    if max(ours, theirs) <= least:
        return None
    return ours / theirs if theirs > 0 else math.inf


def ratios(found):
    """Every ratio that is held against 1 or is of interest, by its name."""
    base = found["memoryless"]

    def of(driver, key, least=LEAST_RMS):
        return ratio(found[driver][key], base[key], least)

    return {
        "flat": of("flat", "rms_flat"),
        "gouraud": of("gouraud", "rms_gouraud"),
        "mixed": of("mixed", "rms_mixed"),
        "distance": of("flat", "distance_mean", LEAST_DISTANCE),
        "mixed, flat": of("mixed", "rms_flat"),
        "mixed, gouraud": of("mixed", "rms_gouraud"),
    }


HELD = ["flat", "gouraud", "mixed", "distance"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
    parser.add_argument("--only", metavar="REGEX", help="inputs whose name matches")
    parser.add_argument("--preset", default="default", help="recipe of the image method [default]")
    parser.add_argument("--csv", type=Path, help="write all figures there")
    options = parser.parse_args()
    scene = options.lodmark.parent / "examples/scene"
    for program in (options.lodmark, scene):
        if not program.exists():
            sys.exit(f"{program} does not exist; expected: cargo build --release --bin lodmark --example scene")
    print("| input | triangles | flat | Gouraud | mixed | distance, flat-driven | mixed: flat, Gouraud |")
    print("|---|---|---|---|---|---|---|", flush=True)
    rows, worse = [], []
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        for name, file, levels in inputs(scene, options.lodmark, folder, options.only):
            for level in levels:
                found = measure(options.lodmark, file, level, folder, ["--preset", options.preset])
                of = ratios(found)
                text = {key: "=" if r is None else f"{r:.3f}" for key, r in of.items()}
                for key in HELD:
                    if of[key] is not None and of[key] > 1:
                        text[key] = f"**{text[key]}**"
                        worse.append(f"{name} {level} {key}")
                counts = sorted({found[driver]["triangles"] for driver in found})
                count = " to ".join(map(str, [counts[0], counts[-1]] if len(counts) > 1 else counts))
                cells = [text[key] for key in HELD] + [f"{text['mixed, flat']}, {text['mixed, gouraud']}"]
                print(f"| {name} | {count} | {' | '.join(cells)} |", flush=True)
                for driver, figures in found.items():
                    kept = ["triangles", "rms_flat", "rms_gouraud", "distance_mean", "distance_max", "folded_edges"]
                    rows.append([name, level, driver] + [figures.get(key) for key in kept])
    if options.csv:
        with options.csv.open("w", newline="") as out:
            writer = csv.writer(out)
            writer.writerow(["input", "target", "driver", *kept])
            writer.writerows(rows)
    print(f"\n{len(worse)} of {len(rows)} ratios are above 1" + (f": {', '.join(worse)}" if worse else ""))
    sys.exit(1 if worse else 0)


if __name__ == "__main__":
    main()
