#!/usr/bin/env python3
"""Reports missing requirements of this machine and how to fix them. Exit code 0: nothing required is missing; 1: something is."""
import argparse
import ctypes.util
import json
import os
import platform
import shutil
import socket
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def check(name, ok, found, mend="", needed=True):
    return {"name": name, "ok": bool(ok), "needed": needed, "found": str(found), "mend": "" if ok else mend}


def cpu_flags():
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("flags"):
                return set(line.split(":", 1)[1].split())
    except OSError:
        pass
    return set()


def installed(package):
    if not shutil.which("dpkg-query"):
        return None
    result = subprocess.run(["dpkg-query", "-W", "-f=${db:Status-Status}", package], capture_output=True, text=True)
    return result.stdout == "installed"


def missing_of(variable):
    """Packages of a list of ./gloam that are not installed."""
    return [package for package in os.environ.get(variable, "").split() if installed(package) is False]


def checks():
    system = os.environ.get("GLOAM_SYSTEM", platform.system())
    yield check("operating system", "is tested here" in system or "supported" in system, system,
                "Gloam is tested on Debian 12 and supports Debian 13", needed=False)
    flags = cpu_flags()
    yield check("processor", platform.machine() == "x86_64" and "sse4_2" in flags,
                f"{platform.machine()}, {'AVX2' if 'avx2' in flags else 'no AVX2'}", "an x86-64 processor with SSE 4.2 is needed")
    yield check("AVX2", "avx2" in flags, "yes" if "avx2" in flags else "no",
                "rendering is slower without it; ./gloam builds for the older instruction set", needed=False)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    yield check("memory", memory >= 3.5, f"{memory:.1f} GiB", "the build needs about 4 GiB; add swap or build with fewer jobs")
    free = shutil.disk_usage(ROOT).free / 2**30
    yield check("disk space here", free >= 3, f"{free:.1f} GiB free", "the setup and the build need about 3 GiB")
    for tool, package in [("python3", "python3"), ("cmake", "cmake"), ("ninja", "ninja-build"), ("g++", "g++")]:
        path = shutil.which(tool)
        yield check(tool, path, path or "missing", f"apt-get install {package} (or run ./gloam setup)")
    headers = Path(sysconfig.get_path("include")) / "Python.h"
    yield check("Python for import gloam", sys.version_info >= (3, 11) and headers.exists(), f"{platform.python_version()}, headers "
                f"{'found' if headers.exists() else 'missing'}", "needs 3.11 or newer; apt-get install python3-dev (or run ./gloam python)",
                needed=False)
    missing = missing_of("GLOAM_RUN_PACKAGES")
    yield check("Debian packages", not missing, "all" if not missing else "missing: " + " ".join(missing),
                "apt-get install " + " ".join(missing))
    missing = missing_of("GLOAM_TEST_PACKAGES")
    yield check("packages for ./gloam test", not missing, "all" if not missing else "missing: " + " ".join(missing),
                "apt-get install " + " ".join(missing), needed=False)
    mujoco = ROOT / ".venv/wheels/mujoco/libmujoco.so.4.0.1"
    yield check("MuJoCo 4.0.1", mujoco.exists(), "in .venv/wheels" if mujoco.exists() else "missing", "run ./gloam setup to download it")
    programs = ROOT / ".venv/wheels/cmeel.prefix/lib/libeiquadprog.so"
    yield check("eiquadprog", programs.exists(), "in .venv/wheels" if programs.exists() else "missing", "run ./gloam setup to download it")
    oidn = ROOT / ".venv/wheels/pyoidn/oidn/lib/libOpenImageDenoise.so.2"
    yield check("Open Image Denoise", oidn.exists(), "in .venv/wheels" if oidn.exists() else "missing",
                "run ./gloam setup to download it; without it, Gloam uses its own filter", needed=False)
    program = ROOT / "build/release/bin/gloam"
    yield check("the build", program.exists(), "built" if program.exists() else "not built yet", "run ./gloam setup")
    if program.exists():
        result = subprocess.run([str(program), "--version"], capture_output=True, text=True)
        why = (result.stderr.strip().splitlines() or ["?"])[-1]
        yield check("the program starts", result.returncode == 0, result.stdout.split("\n")[0] or why, f"error: {why}; rebuild with ./gloam setup")
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
    driver = ctypes.util.find_library("cuda")
    yield check("NVIDIA driver", driver, driver or "none", "optional: without it, Gloam renders on the CPU", needed=False)


def main():
    parser = argparse.ArgumentParser(prog="./gloam doctor", description=__doc__, epilog="Example: ./gloam doctor --json")
    parser.add_argument("--json", action="store_true", help="print the findings as JSON")
    args = parser.parse_args()
    found = list(checks())
    if args.json:
        print(json.dumps(found, indent=2))
    else:
        for item in found:
            mark = "ok  " if item["ok"] else ("MISS" if item["needed"] else "note")
            print(f"{mark} {item['name']:<26} {item['found']}" + (f"\n     {'':<26} -> {item['mend']}" if item["mend"] else ""))
    return 0 if all(item["ok"] or not item["needed"] for item in found) else 1


if __name__ == "__main__":
    sys.exit(main())
