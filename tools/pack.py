#!/usr/bin/env python3
"""Makes a bundle that runs on a bare machine: `./gloam pack [FILE]`, default build/gloam.tar.gz.

    gloam/bin/            the program, its test and its measurement of the card
    gloam/lib/gloam/      every library they need but the C library's own
    gloam/share/gloam/    assets and examples

Programs look for libraries beside themselves ($ORIGIN); nothing has to be installed but the card's driver.
"""
import argparse
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAMS = ["gloam", "gloam_cuda_test", "bench_cuda_rate"]
MOST_BYTES = 40 << 20
# Parts of the C library: those of the machine that runs the bundle.
OF_THE_SYSTEM = re.compile(r"^(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|resolv|util)\.so)")


def libraries(program):
    """Name and file of every library that the program needs."""
    listing = subprocess.run(["ldd", program], check=True, text=True, stdout=subprocess.PIPE).stdout
    for line in listing.splitlines():
        name, _, rest = line.strip().partition(" => ")
        name = name.split()[0]
        if OF_THE_SYSTEM.match(Path(name).name):
            continue
        file = rest.split(" (")[0]
        if not file or "not found" in file:
            sys.exit(f"gloam: error: {program} needs {name}, which is not on this machine")
        yield name, Path(file).resolve()


def fill(folder, build):
    (folder / "bin").mkdir(parents=True)
    (folder / "lib" / "gloam").mkdir(parents=True)
    for name in PROGRAMS:
        program = folder / "bin" / name
        shutil.copy2(build / "bin" / name, program)
        subprocess.run(["strip", program], check=True)
        for library, file in libraries(build / "bin" / name):
            shutil.copy2(file, folder / "lib" / "gloam" / library)
    plugins = ROOT / ".venv" / "wheels" / "mujoco" / "plugin"
    if plugins.is_dir():
        shutil.copytree(plugins, folder / "lib" / "gloam" / "plugin")
    for name in ("assets", "examples"):
        shutil.copytree(ROOT / name, folder / "share" / "gloam" / name)
    shutil.copy2(ROOT / "LICENSE", folder)


def main():
    parser = argparse.ArgumentParser(prog="./gloam pack", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "build" / "gloam.tar.gz")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "gloam"
        fill(folder, args.build)
        with tarfile.open(args.file, "w:gz") as bundle:
            bundle.add(folder, "gloam")
    size = args.file.stat().st_size
    print(args.file)
    print(f"gloam: {size / (1 << 20):.1f} MiB", file=sys.stderr)
    if size > MOST_BYTES:
        sys.exit(f"gloam: error: a bundle may have {MOST_BYTES >> 20} MiB")


if __name__ == "__main__":
    main()
