#!/usr/bin/env python3
"""The same bits everywhere: builds lodmark in several ways and holds every build against the goldens.

A lane is a build (debug, release, compiled for this very CPU, for x86-64-v2, for aarch64) with a number of threads. In
every lane `lodmark selfcheck` recomputes the whole golden set. Two builds, and two lanes, run at a time: much of either
keeps one core busy. The aarch64 lane runs aarch64 code under qemu on x86-64:
that tests code generation, SIMD widths and libm, not another floating-point unit.

    tests/reproduce.py                      run the lanes that this machine can; name the others
    tests/reproduce.py --require            fail where one cannot be run
    tests/reproduce.py --provision          first install what the aarch64 lane needs (Debian packages, as root)
    tests/reproduce.py release aarch64      only lanes whose name begins so

Exit code: 0 all lanes equal, 1 a lane differs or fails, 2 a required lane is missing. Writes below target/ only.
"""

import argparse
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
ARM = "aarch64-unknown-linux-gnu"
PACKAGES = [
    "rustc-web",
    "libstd-rust-web-dev:arm64",
    "gcc-aarch64-linux-gnu",
    "libc6-dev-arm64-cross",
    "libc6:arm64",
    "qemu-user-static",
]
# Seconds. Under qemu a program can hang for ever (a wrong C library does that): every command has a limit.
BUILD_LIMIT, RUN_LIMIT, EMULATED_LIMIT, APT_LIMIT = 2400, 600, 1200, 900


def no_arm():
    """Why the aarch64 lane cannot be run here; None where it can."""
    if platform.machine() != "x86_64":
        return f"is emulated on x86-64 only, and this is {platform.machine()}"
    for tool in ["/usr/bin/rustc", "aarch64-linux-gnu-gcc", "qemu-aarch64-static"]:
        if not shutil.which(tool):
            return f"{tool} is not installed"
    command = ["/usr/bin/rustc", "--print", "target-libdir", "--target", ARM]
    found = subprocess.run(command, capture_output=True, text=True, timeout=60)
    if not any(pathlib.Path(found.stdout.strip() or "/nowhere").glob("libstd-*")):
        return "/usr/bin/rustc has no standard library for it"
    if not pathlib.Path("/lib/ld-linux-aarch64.so.1").exists():
        return "the arm64 C library is not installed"
    return None


def not_x86_64():
    machine = platform.machine()
    return None if machine == "x86_64" else f"needs an x86-64 machine, and this is {machine}"


class Build:
    """A way to build lodmark. `sign` is what `selfcheck` must say about itself."""

    def __init__(self, name, arguments, folder, sign, flags=None, missing=lambda: None, arm=False):
        self.name, self.folder, self.sign, self.missing, self.arm = name, folder, sign, missing, arm
        self.command = ["cargo", "build", "--locked", "--bin", "lodmark", *arguments]
        self.environment = dict(os.environ)
        if flags or arm:
            self.command += ["--target-dir", f"target/lanes/{name}"]
            # Line tables change no code, and inlining across the units of one crate little: both cost time.
            self.environment["CARGO_PROFILE_RELEASE_DEBUG"] = "false"
            self.environment["CARGO_PROFILE_RELEASE_LTO"] = "off"
            self.environment.pop("CARGO_ENCODED_RUSTFLAGS", None)
            self.environment["RUSTFLAGS"] = flags or ""
        if arm:
            self.environment["RUSTC"] = "/usr/bin/rustc"
            self.environment["CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER"] = "aarch64-linux-gnu-gcc"
        self.outcome = None

    def begin(self, pool):
        """Begins to build, once; `outcome.result()` is (error or None, seconds)."""
        if self.outcome is None:
            self.outcome = pool.submit(lambda: call(self.command, BUILD_LIMIT, self.environment)[:2])

    def program(self):
        # No -L for qemu: with the cross C library the first thread hangs for ever.
        path = str(ROOT / "target" / self.folder / "lodmark")
        return ["qemu-aarch64-static", path] if self.arm else [path]


def call(command, limit, environment=None):
    """Runs a command from the root: (what went wrong or None, seconds, stdout)."""
    start = time.monotonic()
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=limit,
        )
    except subprocess.TimeoutExpired:
        return f"still running after {limit} s", time.monotonic() - start, ""
    except OSError as error:
        return str(error), time.monotonic() - start, ""
    seconds = time.monotonic() - start
    if done.returncode != 0:
        text = (done.stdout + done.stderr).strip()
        return f"exit code {done.returncode}\n{text[-4000:]}", seconds, done.stdout
    return None, seconds, done.stdout


def lanes():
    debug = Build("debug", [], "debug", "debug build")
    # The program that the tests call: `cargo build` would make another one, without what the tests ask of dependencies.
    debug.command = ["cargo", "test", "--locked", "--no-run", "--test", "all"]
    release = Build("release", ["--release"], "release", "x86_64" if not_x86_64() is None else "release build")
    native = Build("native", ["--release"], "lanes/native/release", "release build", "-C target-cpu=native")
    v2 = Build(
        "x86-64-v2", ["--release"], "lanes/x86-64-v2/release", "sse4.2", "-C target-cpu=x86-64-v2", not_x86_64
    )
    arm = Build(
        "aarch64", ["--release", "--target", ARM], f"lanes/aarch64/{ARM}/release", "aarch64", missing=no_arm, arm=True
    )
    selfcheck = ["selfcheck", "--quiet"]
    yield "debug", debug, selfcheck
    for threads in [1, 2, 3, 8]:
        yield f"release, threads {threads}", release, ["--threads", str(threads), *selfcheck]
    yield "release, files", release, ["golden", "check", "--quiet", "--out", "target/lanes/golden-release"]
    yield "native", native, selfcheck
    yield "x86-64-v2", v2, selfcheck
    for threads in [1, 2, 8]:
        yield f"aarch64 (qemu), threads {threads}", arm, ["--threads", str(threads), *selfcheck]


def provision():
    """Installs what the aarch64 lane needs, unless it is there."""
    if no_arm() is None or not_x86_64() is not None:
        return
    sudo = [] if os.geteuid() == 0 else ["sudo", "-n"]
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    wait = ["-o", "DPkg::Lock::Timeout=300"]
    for command in [
        ["dpkg", "--add-architecture", "arm64"],
        ["apt-get", *wait, "update", "-q"],
        ["apt-get", *wait, "install", "-q", "-y", "--no-install-recommends", *PACKAGES],
    ]:
        print("+", " ".join(command), flush=True)
        wrong, seconds, _ = call([*sudo, *command], APT_LIMIT, environment)
        if wrong:
            # The lane will say that it is missing; other lanes still count.
            print(f"  failed after {seconds:.0f} s: {wrong}", flush=True)
            return
        print(f"  {seconds:.0f} s", flush=True)


def run(name, build, arguments):
    """Runs a lane: (what is wrong or None, the first line that it said, seconds)."""
    wrong, _ = build.outcome.result()
    if wrong:
        return wrong, "", 0.0
    limit = EMULATED_LIMIT if build.arm else RUN_LIMIT
    wrong, seconds, said = call([*build.program(), *arguments], limit)
    first = said.splitlines()[0] if said else ""
    if not wrong and "selfcheck" in arguments and build.sign not in first:
        wrong = f"it should say `{build.sign}`, but says `{first}`"
    return wrong, first, seconds


def main():
    about = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    about.add_argument("--provision", action="store_true", help="install system packages where they are missing")
    about.add_argument("--require", action="store_true", help="a lane that cannot be run is a failure")
    about.add_argument("lane", nargs="*", help="beginnings of names of lanes")
    options = about.parse_args()
    chosen = [lane for lane in lanes() if not options.lane or lane[0].startswith(tuple(options.lane))]
    if not chosen:
        about.error(f"no lane begins with {', '.join(options.lane)}")
    if options.provision and any(build.arm for _, build, _ in chosen):
        provision()
    rows, different, missing, shown = [], [], [], set()
    with ThreadPoolExecutor(2) as builds, ThreadPoolExecutor(2) as runs:
        for _, build, _ in chosen:
            if not build.missing():
                build.begin(builds)
        begun = [(lane, runs.submit(run, *lane) if lane[1].outcome else None) for lane in chosen]
        for (name, build, arguments), outcome in begun:
            command = "lodmark " + " ".join(arguments)
            if not outcome:
                missing.append(f"{name}: {build.missing()}")
                rows.append((name, command, "MISSING", "", ""))
                continue
            wrong, first, seconds = outcome.result()
            print(f"{name} ...\n  {wrong or first}", flush=True)
            if wrong:
                different.append(f"{name}: {wrong}")
            built = "" if build in shown else f"{build.outcome.result()[1]:.0f}"
            shown.add(build)
            rows.append((name, command, "DIFFERS" if wrong else "equal", built, f"{seconds:.1f}"))
    head = ("lane", "command", "result", "build s", "run s")
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(5)]
    print()
    for row in [head, tuple("-" * w for w in widths), *rows]:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    print()
    for title, list_ in [("lanes that differ or fail", different), ("lanes that are missing", missing)]:
        if list_:
            print(f"{title}:")
            for line in list_:
                print(f"  {line}")
    if different:
        return 1
    if missing and options.require:
        print("every lane is required; `tests/reproduce.py --provision` installs what is missing")
        return 2
    print("all lanes that were run are equal" if missing else "all lanes are equal")
    return 0


if __name__ == "__main__":
    sys.exit(main())
