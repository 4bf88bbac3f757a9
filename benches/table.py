#!/usr/bin/env python3
"""The table of the README, measured: every row is one command, file to file, as a user would type it.

    cargo build --release && python3 benches/table.py            # print the table
    python3 benches/table.py --write                             # and put it into README.md
    python3 benches/table.py --runs 1 --only 'bunny'             # a quick look at some rows

Seconds are the least wall time of several whole processes (minimum, because other work on the machine only ever adds),
with the peak memory of the largest. Ratios are RMS by `lodmark compare` over that of the mesh which CGAL made of the same
model (in LODMARK_PEERS) by its Lindstrom-Turk simplification, for the quadric row by its Garland-Heckbert one, so no
baseline of our own can drift. Needs the models and peers; a row whose files are absent is left out and said to be.
"""

import argparse
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


def run(command):
    """Wall seconds and peak memory in MB of a whole process."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--lodmark", type=Path, default=ROOT / "target/release/lodmark", help="the release build")
    parser.add_argument("--runs", type=int, default=3, help="processes per row; the fastest counts [3]")
    parser.add_argument("--only", metavar="REGEX", help="rows whose name matches")
    parser.add_argument("--write", action="store_true", help="replace the table in README.md")
    options = parser.parse_args()
    if not options.lodmark.exists():
        sys.exit(f"{options.lodmark} does not exist; expected a release build: cargo build --release")
    table = "\n".join(measure(options.lodmark, max(options.runs, 1), options.only))
    print(table)
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
