#!/usr/bin/env python3
"""Creates a bundle that runs on a machine without installed packages: `./gloam pack [FILE]`, default: build/gloam.tar.gz.

    gloam/bin/            the program; with --tests also its GPU test and its GPU benchmark
    gloam/lib/gloam/      all libraries that they need, except the C library
    gloam/lib/gloam/oidn/ Open Image Denoise for the CPU and the GPU, with the networks that Gloam uses
    gloam/share/gloam/    assets and examples

The programs look for libraries next to themselves ($ORIGIN); only the driver of the GPU has to be installed.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TESTS = ["gloam_cuda_test", "bench_cuda_rate"]
MOST_BYTES = 60 << 20
OIDN_VERSION = "2.5.1"
# The networks of quality "balanced" (src/render/film/oidn.cc): light alone, with albedo, with albedo and normal.
NETWORKS = {"rt_hdr", "rt_hdr_alb", "rt_hdr_alb_nrm"}
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
            sys.exit(f"gloam: error: {program} needs {name}, which was not found on this machine")
        yield name, Path(file).resolve()


def without_other_networks(file):
    """Zeros in place of the networks that Gloam never asks for: 45 of 50 MB, which then compress to nothing."""
    sections = subprocess.run(["readelf", "-SW", file], check=True, text=True, stdout=subprocess.PIPE).stdout
    _, _, address, offset = re.search(r"] (\.rodata) +(\w+) +(\w+) (\w+)", sections).groups()
    symbols = subprocess.run(["nm", "-S", "-C", file], check=True, text=True, stdout=subprocess.PIPE).stdout
    data, kept = bytearray(file.read_bytes()), set()
    for start, size, name in re.findall(r"^(\w+) (\w+) \w oidn::blobs::weights::(\w+)$", symbols, re.MULTILINE):
        if name in NETWORKS:
            kept.add(name)
            continue
        begin = int(start, 16) - int(address, 16) + int(offset, 16)
        data[begin:begin + int(size, 16)] = bytes(int(size, 16))
    if kept != NETWORKS:
        sys.exit(f"gloam: error: {file} lacks networks: {', '.join(sorted(NETWORKS - kept))}")
    file.write_bytes(data)


def add_denoiser(folder):
    """TBB is the program's own, which is loaded before."""
    source, lib = ROOT / ".venv" / "wheels" / "pyoidn" / "oidn" / "lib", folder / "lib" / "gloam" / "oidn" / "lib"
    lib.mkdir(parents=True)
    shutil.copy2(source / "libOpenImageDenoise.so.2", lib)
    for part in ("core", "device_cpu", "device_cuda"):
        shutil.copy2(source / f"libOpenImageDenoise_{part}.so.{OIDN_VERSION}", lib)
    without_other_networks(lib / f"libOpenImageDenoise_core.so.{OIDN_VERSION}")


def try_denoiser(folder):
    """Renders with the bundle as a stranger would: a denoiser that does not run would go unseen."""
    env = {key: value for key, value in os.environ.items() if not key.startswith("GLOAM_")}
    robot = folder / "share" / "gloam" / "assets" / "robots" / "quadruped" / "quadruped.xml"
    with tempfile.TemporaryDirectory() as out:
        told = subprocess.run([folder / "bin" / "gloam", "-v", "render", robot, "--camera", "free", "--spp", "1", "--resolution", "64x48",
                               "--device", "cpu", "--out", out], text=True, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, env=env)
    if told.returncode != 0 or "denoiser: Open Image Denoise" not in told.stderr:
        sys.exit(f"gloam: error: the program in the bundle does not denoise:\n{told.stderr}")


def fill(folder, build, programs):
    (folder / "bin").mkdir(parents=True)
    (folder / "lib" / "gloam").mkdir(parents=True)
    for name in programs:
        program = folder / "bin" / name
        shutil.copy2(build / "bin" / name, program)
        subprocess.run(["strip", program], check=True)
        for library, file in libraries(build / "bin" / name):
            shutil.copy2(file, folder / "lib" / "gloam" / library)
    plugins = ROOT / ".venv" / "wheels" / "mujoco" / "plugin"
    if plugins.is_dir():
        shutil.copytree(plugins, folder / "lib" / "gloam" / "plugin")
    add_denoiser(folder)
    for name in ("assets", "examples"):
        shutil.copytree(ROOT / name, folder / "share" / "gloam" / name)
    shutil.copy2(ROOT / "LICENSE", folder)


def main():
    parser = argparse.ArgumentParser(prog="./gloam pack", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "build" / "gloam.tar.gz", help="bundle to write")
    parser.add_argument("--tests", action="store_true", help="add gloam_cuda_test and bench_cuda_rate; the size is then not limited")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "gloam"
        fill(folder, args.build, ["gloam", *(TESTS if args.tests else [])])
        try_denoiser(folder)
        with tarfile.open(args.file, "w:gz") as bundle:
            bundle.add(folder, "gloam")
    size = args.file.stat().st_size
    print(args.file)
    print(f"gloam: {size / (1 << 20):.1f} MiB", file=sys.stderr)
    if size > MOST_BYTES and not args.tests:
        sys.exit(f"gloam: error: a bundle must not exceed {MOST_BYTES >> 20} MiB")


if __name__ == "__main__":
    main()
