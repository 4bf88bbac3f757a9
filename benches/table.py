#!/usr/bin/env python3
"""The table of the README, measured: every row is one command, file to file, as a user would type it.

    cargo build --release && python3 benches/table.py            # print the table
    python3 benches/table.py --write                             # and put it into README.md
    python3 benches/table.py --runs 1 --only 'bunny'             # a quick look at some rows
    python3 benches/table.py --race                              # and other programs on the same meshes, in the same run
    python3 benches/table.py --psnr                              # only: PSNR over meshoptimizer's meshes in LODMARK_PEERS

Seconds are the least wall time of several whole processes (minimum, because other work on the machine only ever adds),
with the peak memory of the largest. Ratios are RMS by `lodmark compare` over that of the mesh which CGAL made of the same
model (in LODMARK_PEERS) by its Lindstrom-Turk simplification, for the quadric row by its Garland-Heckbert one, so no
baseline of our own can drift. Needs the models and peers; a row whose files are absent is left out and said to be.

`--race` times programs that pip has (benches/peers: versions and hashes are pinned; installed below target/peers the first
time) from file to file like ours, each in a Python of its own, and says what simplification alone took in it. A program
that cannot be had or does not run is left out and said to be. The meshes in LODMARK_PEERS are results of other runs.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODELS = Path(os.environ.get("LODMARK_MODELS", ROOT / "../shared/models"))
PEERS = Path(os.environ.get("LODMARK_PEERS", ROOT / "../shared/peers"))
BEGIN, END = "<!-- table: begin (benches/table.py --write) -->", "<!-- table: end -->"

# Model, arguments of `simplify`, and the peer whose RMS is the divisor.
ROWS = [
    ("bunny", ["--triangles", "1333", "--preset", "fast"], "bunny-1333-cgal-lindstrom-turk"),
    ("bunny", ["--triangles", "1333"], "bunny-1333-cgal-lindstrom-turk"),
    ("bunny", ["--triangles", "1333", "--preset", "best"], "bunny-1333-cgal-lindstrom-turk"),
    ("bunny", ["--triangles", "304"], "bunny-304-cgal-lindstrom-turk"),
    ("dragon", ["--triangles", "8191"], "dragon-8191-cgal-lindstrom-turk"),
    ("bunny", ["--triangles", "1333", "--shading", "gouraud"], "bunny-1333-cgal-lindstrom-turk"),
    ("bunny", ["--triangles", "1333", "--shading", "mixed"], "bunny-1333-cgal-lindstrom-turk"),
    ("dragon", ["--triangles", "8191", "--method", "memoryless"], "dragon-8191-cgal-lindstrom-turk"),
    ("dragon", ["--triangles", "8191", "--method", "quadric"], "dragon-8191-cgal-garland-heckbert"),
]


PROGRAMS = ["fast-simplification", "meshoptimizer", "pyfqmr", "pymeshlab"]


def run(command):
    """Wall seconds and peak memory in MB of a whole process."""
    start = time.monotonic()
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}\n{message.decode(errors='replace')}")
    return seconds, usage.ru_maxrss / 1024


def judge(lodmark, reference, candidates, folder):
    report = folder / "compare.json"
    run([lodmark, "compare", "-q", reference, *candidates, "--json", report])
    return json.loads(report.read_text())["candidates"]


def measure(lodmark, runs, only):
    table = [
        "| command: `lodmark simplify MODEL OUT ...` | seconds | MB | flat RMS | ratio | Gouraud RMS | ratio | folds, flipped |",
        "|---|---|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        for model, arguments, peer in ROWS:
            name = f"{model} `{' '.join(arguments)}`"
            if only and not re.search(only, name):
                continue
            source, rival = MODELS / f"{model}.ply", PEERS / f"{peer}.ply"
            if not source.exists() or not rival.exists():
                print(f"left out: {name}: needs {source} and {rival}", file=sys.stderr)
                continue
            out = folder / "out.ply"
            timed = [run([lodmark, "simplify", "-q", source, out, *arguments]) for _ in range(runs)]
            seconds, memory = min(t[0] for t in timed), max(t[1] for t in timed)
            ours, theirs = judge(lodmark, source, [out, rival], folder)
            cells = []
            for key in ("rms_flat", "rms_gouraud"):
                cells += [f"{ours[key]:.3f}", f"{ours[key] / theirs[key]:.3f}"]
            cells.append(f"{ours['folded_edges']}, {ours['flipped_faces']}")
            table.append(f"| {name} | {seconds:.2f} | {memory:.0f} | {' | '.join(cells)} |")
            print(table[-1], file=sys.stderr)
    return table


def installed(package):
    """The folder with a package of benches/peers; what has its name is complete. A sentence where it cannot be had."""
    requirements = ROOT / "benches/peers" / f"{package}.txt"
    stamp = hashlib.sha256(requirements.read_bytes() + sys.version.encode()).hexdigest()[:16]
    folder = ROOT / "target/peers" / f"{package}-{stamp}"
    if folder.exists():
        return folder, None
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as partial:
        pip = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--require-hashes", "--disable-pip-version-check"]
        done = subprocess.run([*pip, "--target", f"{partial}/packages", "-r", requirements], capture_output=True, text=True)
        if done.returncode != 0:
            return None, f"pip: {(done.stderr.strip().splitlines() or ['failed'])[-1]}"
        Path(partial, "packages").rename(folder)
    return folder, None


def compete(program, source, out, triangles):
    """Wall seconds of the process, of simplification alone, and peak MB; or why there are none."""
    packages = []
    for package in ("numpy", program):
        folder, why = installed(package)
        if folder is None:
            return why
        packages.append(str(folder))
    command = [sys.executable, ROOT / "benches/peers/race.py", program, source, out, triangles]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(packages), "PYTHONDONTWRITEBYTECODE": "1"}
    with tempfile.TemporaryFile() as answer, tempfile.TemporaryFile() as talk:
        start = time.monotonic()
        process = subprocess.Popen(list(map(str, command)), stdout=answer, stderr=talk, env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        answer.seek(0), talk.seek(0)
        if process.returncode != 0:
            said = talk.read().decode(errors="replace").strip().splitlines()
            return said[-1] if said else f"exit code {process.returncode}"
        # A program may print as well; the last line is ours.
        return seconds, float(answer.read().split()[-1]), usage.ru_maxrss / 1024


def race(lodmark, runs, only):
    table = [
        "| program | model | triangles | seconds | alone | MB | flat ratio | Gouraud ratio | folds, flipped |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    levels = {}
    for model, arguments, peer in ROWS:
        if not only or re.search(only, f"{model} `{' '.join(arguments)}`"):
            levels.setdefault((model, arguments[1]), peer)
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        for (model, triangles), peer in levels.items():
            source, rival = MODELS / f"{model}.ply", PEERS / f"{peer}.ply"
            if not source.exists() or not rival.exists():
                continue
            for program in PROGRAMS:
                out = folder / "out.ply"
                timed = [compete(program, source, out, triangles) for _ in range(runs)]
                failed = [t for t in timed if isinstance(t, str)]
                if failed:
                    print(f"left out: {program} on {model}: {failed[0]}", file=sys.stderr)
                    continue
                ours, theirs = judge(lodmark, source, [out, rival], folder)
                cells = [program, model, str(ours["candidate"]["triangles"])]
                cells += [f"{min(t[i] for t in timed):.2f}" for i in (0, 1)] + [f"{max(t[2] for t in timed):.0f}"]
                cells += [f"{ours[key] / theirs[key]:.3f}" for key in ("rms_flat", "rms_gouraud")]
                cells.append(f"{ours['folded_edges']}, {ours['flipped_faces']}")
                table.append(f"| {' | '.join(cells)} |")
                print(table[-1], file=sys.stderr)
    return table


def psnr(lodmark):
    """By how many decibels the default beats meshoptimizer's meshes, at every level that there is."""
    gains = {"psnr_flat": [], "psnr_gouraud": []}
    print("| mesh | triangles: theirs, ours | flat dB: theirs, ours | gain | Gouraud dB: theirs, ours | gain |")
    print("|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = Path(folder)
        for rival in sorted(PEERS.glob("*-meshoptimizer.ply")):
            model, level, _ = rival.stem.split("-", 2)
            source, out = MODELS / f"{model}.ply", folder / "out.ply"
            if not source.exists():
                print(f"left out: {rival.name}: needs {source}", file=sys.stderr)
                continue
            run([lodmark, "simplify", "-q", source, out, "--triangles", level])
            ours, theirs = judge(lodmark, source, [out, rival], folder)
            cells = [f"{model} {level}", f"{theirs['candidate']['triangles']}, {ours['candidate']['triangles']}"]
            for key, found in gains.items():
                found.append(ours[key] - theirs[key])
                cells += [f"{theirs[key]:.2f}, {ours[key]:.2f}", f"{found[-1]:+.2f}"]
            print(f"| {' | '.join(cells)} |", flush=True)
    if gains["psnr_flat"]:
        means = [sum(found) / len(found) for found in gains.values()]
        print(f"mean over {len(gains['psnr_flat'])} levels: flat {means[0]:+.2f} dB, Gouraud {means[1]:+.2f} dB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
    parser.add_argument("--runs", type=int, default=3, help="processes per row; the fastest counts [3]")
    parser.add_argument("--only", metavar="REGEX", help="rows whose name matches")
    parser.add_argument("--race", action="store_true", help="time other programs as well, installed by pip")
    parser.add_argument("--psnr", action="store_true", help="only measure PSNR over meshoptimizer's meshes")
    parser.add_argument("--write", action="store_true", help="replace the table in README.md")
    options = parser.parse_args()
    if not options.lodmark.exists():
        sys.exit(f"{options.lodmark} does not exist; expected a release build: cargo build --release")
    if options.psnr:
        return psnr(options.lodmark)
    table = "\n".join(measure(options.lodmark, max(options.runs, 1), options.only))
    print(table)
    if options.race:
        print("\n" + "\n".join(race(options.lodmark, max(options.runs, 1), options.only)))
    if options.write:
        readme = ROOT / "README.md"
        text = readme.read_text()
        if options.only or text.count(BEGIN) != 1 or text.count(END) != 1:
            sys.exit("README.md: expected one pair of table marks, and a run of all rows")
        head, rest = text.split(BEGIN)
        new = f"{head}{BEGIN}\n{table}\n{END}{rest.split(END)[1]}"
        scratch = readme.with_suffix(".md.new")
        scratch.write_text(new)
        scratch.replace(readme)


if __name__ == "__main__":
    main()
