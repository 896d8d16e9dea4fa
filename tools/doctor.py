#!/usr/bin/env python3
"""Reports the state of this machine: hardware, compilers, packages, downloads and the build, and how to fix faults.

It installs, builds and writes nothing. Exit code 0: nothing required is missing; 1: something is.
"""
import argparse
import ctypes.util
import json
import os
import platform
import re
import shutil
import socket
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRESET = os.environ.get("GLOAM_PRESET") or "release"
COMPILERS = range(12, 15)  # versions of GCC that are supported


def check(name, ok, found, fix="", needed=True):
    return {"name": name, "ok": bool(ok), "needed": needed, "found": str(found), "fix": "" if ok else fix}


def output(*command):
    """The first line that a command prints, or "" if it fails."""
    try:
        lines = subprocess.run(command, capture_output=True, text=True, timeout=10).stdout.splitlines()
    except (OSError, subprocess.TimeoutExpired):
        lines = []
    return lines[0] if lines else ""


def text(path):
    try:
        return Path(path).read_text()
    except OSError:
        return ""


def machine():
    system = os.environ.get("GLOAM_SYSTEM", platform.system())
    yield check("operating system", "is tested here" in system or "supported" in system, system,
                "Gloam is tested on Debian 12 and supports Debian 13", needed=False)
    cpu = text("/proc/cpuinfo")
    model = re.search(r"^model name\s*:\s*(.*)", cpu, re.M)
    flags = set((re.search(r"^flags\s*:\s*(.*)", cpu, re.M) or ["", ""])[1].split())
    yield check("processor", platform.machine() == "x86_64" and "sse4_2" in flags,
                f"{platform.machine()}, {model[1] if model else 'unknown model'}, {os.cpu_count()} cores", "an x86-64 processor with SSE 4.2 is needed")
    yield check("AVX2", "avx2" in flags, "yes" if "avx2" in flags else "no",
                "rendering is slower without it; ./gloam builds for the older instruction set", needed=False)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    yield check("memory", memory >= 3.5, f"{memory:.1f} GiB", "the build needs about 4 GiB; add swap or build with fewer jobs")
    free = shutil.disk_usage(ROOT).free / 2**30
    yield check("disk space here", free >= 3, f"{free:.1f} GiB free", "the setup and the build need about 3 GiB")
    driver = ctypes.util.find_library("cuda")
    cards = [found[1] for file in Path("/proc/driver/nvidia/gpus").glob("*/information") if (found := re.search(r"Model:\s*(.*)", text(file)))]
    yield check("NVIDIA GPU", driver, f"{', '.join(cards) or 'unknown model'}, {driver}" if driver else "none",
                "optional: without a GPU and its driver, Gloam renders on the CPU", needed=False)


def missing_packages():
    """Lists of packages for ./gloam and for ./gloam test that are not installed. Empty without dpkg."""
    wanted = [os.environ.get(name, "").split() for name in ("GLOAM_RUN_PACKAGES", "GLOAM_TEST_PACKAGES")]
    if not any(wanted) or not shutil.which("dpkg-query"):
        return [], []
    command = ["dpkg-query", "-W", "-f=${Package} ${db:Status-Status}\n", *wanted[0], *wanted[1]]
    printed = subprocess.run(command, capture_output=True, text=True).stdout.splitlines()
    installed = {line.split()[0] for line in printed if line.endswith(" installed")}
    return [[package for package in packages if package not in installed] for packages in wanted]


def tools():
    version = re.search(r"^project\(gloam VERSION ([\d.]+)", text(ROOT / "CMakeLists.txt"), re.M)
    yield check("Gloam", version, version[1] if version else "unknown version", "this is not a complete copy of the repository")
    gcc = output("g++", "-dumpfullversion")
    supported = gcc.split(".")[0] in map(str, COMPILERS)
    yield check("compiler", gcc, f"g++ {gcc}" if gcc else "missing", "apt-get install g++ (or run ./gloam setup)")
    if gcc:
        yield check("compiler version", supported, "supported" if supported else "unknown",
                    f"Gloam is tested with GCC {COMPILERS[0]} to {COMPILERS[-1]}", needed=False)
    for tool, package in [("cmake", "cmake"), ("ninja", "ninja-build")]:
        yield check(tool, shutil.which(tool), output(tool, "--version").removeprefix("cmake version ") or "missing",
                    f"apt-get install {package} (or run ./gloam setup)")
    headers = (Path(sysconfig.get_path("include")) / "Python.h").exists()
    yield check("Python for import gloam", sys.version_info >= (3, 11) and headers, f"{platform.python_version()}, headers "
                f"{'found' if headers else 'missing'}", "needs 3.11 or newer; apt-get install python3-dev (or run ./gloam python)", needed=False)
    toolkit = shutil.which("nvcc") or next((str(file) for file in (Path("/usr/local/cuda/bin/nvcc"), ROOT / ".venv/cuda/nvidia/cu13/bin/nvcc")
                                            if file.exists()), None)
    yield check("CUDA compiler", toolkit, toolkit or "none", "optional: GLOAM_PRESET=cuda ./gloam setup downloads it", needed=False)
    run, test = missing_packages()
    for name, missing, needed in [("Debian packages", run, True), ("packages for ./gloam test", test, False)]:
        yield check(name, not missing, "missing: " + " ".join(missing) if missing else "all", "apt-get install " + " ".join(missing), needed)


def downloads_and_build():
    wheels = ROOT / ".venv/wheels"
    for name, library in [("MuJoCo 4.0.1", "mujoco/libmujoco.so.4.0.1"), ("eiquadprog", "cmeel.prefix/lib/libeiquadprog.so")]:
        there = (wheels / library).exists()
        yield check(name, there, "in .venv/wheels" if there else "missing", "run ./gloam setup to download it")
    denoiser = (wheels / "pyoidn/oidn/lib/libOpenImageDenoise.so.2").exists()
    yield check("Open Image Denoise", denoiser, "in .venv/wheels" if denoiser else "missing",
                "run ./gloam setup to download it; without it, Gloam uses its own filter", needed=False)
    program = ROOT / "build" / PRESET / "bin" / "gloam"
    yield check("build", program.exists(), f"build/{PRESET}" if program.exists() else "not built yet", "run ./gloam setup")
    if program.exists():
        result = subprocess.run([str(program), "--version"], capture_output=True, text=True)
        reason = (result.stderr.strip().splitlines() or ["?"])[-1]
        yield check("the program starts", result.returncode == 0, result.stdout.split("\n")[0] or reason, f"error: {reason}; rebuild with ./gloam setup")


def surroundings():
    cache = Path(os.environ.get("GLOAM_CACHE") or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "gloam")
    try:
        folder = cache  # may not exist yet; this command does not create it
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        with tempfile.TemporaryFile(dir=folder):
            pass
        yield check("cache folder", True, "writable")
    except OSError as error:
        yield check("cache folder", False, error.strerror, "make it writable, or set GLOAM_CACHE to a writable folder", needed=False)
    with socket.socket() as probe:
        busy = probe.connect_ex(("127.0.0.1", 8080)) == 0
    yield check("port 8080 for --view", not busy, "in use" if busy else "free", "use --port 0", needed=False)


def main():
    parser = argparse.ArgumentParser(prog="./gloam doctor", description=__doc__, epilog="Example: ./gloam doctor --json",
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print the findings as JSON")
    args = parser.parse_args()
    found = [item for part in (machine, tools, downloads_and_build, surroundings) for item in part()]
    ready = all(item["ok"] or not item["needed"] for item in found)
    if args.json:
        print(json.dumps(found, indent=2))
        return 0 if ready else 1
    for item in found:
        mark = "ok  " if item["ok"] else ("MISS" if item["needed"] else "note")
        print(f"{mark} {item['name']:<26} {item['found']}" + (f"\n     {'':<26} -> {item['fix']}" if item["fix"] else ""))
    print("ready" if ready else "not ready: run the commands after ->, or ./gloam setup, which runs them all")
    return 0 if ready else 1


if __name__ == "__main__":
    sys.exit(main())
