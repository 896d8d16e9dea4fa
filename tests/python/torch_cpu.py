"""PyTorch on the CPU for tests, from the one wheel that PyPI has: it is linked with CUDA's libraries, 2.5 GB of wheels.

None of their functions is called without a card, so empty libraries of their names take their places; only CUDA's small
runtime is the real one.

    python3 tests/python/torch_cpu.py

fetches it (540 MB, once) and prints the folder.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import fetch_data  # noqa: E402

REQUIREMENTS = Path(__file__).resolve().parent / "torch_requirements.txt"


def tell(*command: str | Path) -> str:
    result = subprocess.run(
        [str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    if result.returncode != 0:
        raise RuntimeError(f"{command[0]}: {(result.stdout.strip().splitlines() or ['failed'])[-1]}")
    return result.stdout


def data_of(files: list[Path], library: str) -> dict[str, str]:
    """Variables (name: version) that files look up in a library when they are loaded; functions are looked up later."""
    found = {}
    for file in files:
        versions = re.search(rf"File: {re.escape(library)} .*\n((?: .*Name: .*\n)*)", tell("readelf", "-VW", file))
        names = re.findall(r"Name: (\S+)", versions.group(1)) if versions else []
        for name, version in re.findall(r"R_X86_64_GLOB_DAT +\w+ (\w+)@(\S+) \+", tell("readelf", "-rW", file)):
            if version in names:
                found[name] = version
    return found


def make_empty(libraries: set[str], files: list[Path], folder: Path) -> None:
    folder.mkdir()
    for library in libraries:
        data = data_of(files, library)
        source, versions = folder / "empty.c", folder / "versions"
        source.write_text("".join(f"char {name}[4096];\n" for name in data))
        versions.write_text("".join(f"{version} {{ *; }};\n" for version in set(data.values())) or "{ *; };\n")
        tell(
            "gcc",
            "-shared",
            "-o",
            folder / library,
            f"-Wl,-soname,{library}",
            f"-Wl,--version-script={versions}",
            source,
        )


def torch_cpu() -> tuple[Path, str]:
    """Folder to import `torch` from, and the LD_LIBRARY_PATH that it needs. RuntimeError where there is no network."""
    wanted = hashlib.sha256(REQUIREMENTS.read_bytes() + Path(__file__).read_bytes()).hexdigest()[:8]
    root = fetch_data.default_folder() / f"torch-{sys.version_info.major}.{sys.version_info.minor}-{wanted}"
    root.mkdir(parents=True, exist_ok=True)
    packages, empty = root / "packages", root / "empty"
    with open(root / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (root / "done").exists():
            for folder in (packages, empty):
                shutil.rmtree(folder, ignore_errors=True)
            tell(
                sys.executable,
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
                "--no-deps",
                "--no-compile",
                "--require-hashes",
                "--only-binary=:all:",
                "--target",
                packages,
                "-r",
                REQUIREMENTS,
            )
            files = sorted((packages / "torch" / "lib").glob("*.so*"))
            asked = {name for file in files for name in re.findall(r"NEEDED.*\[(.*)\]", tell("readelf", "-d", file))}
            here = {path.name for path in packages.rglob("*.so*")}
            known = tell("/sbin/ldconfig", "-p")
            make_empty({name for name in asked - here if f"\t{name} " not in known}, files, empty)
            (root / "done").touch()
    runtime = next(packages.rglob("libcudart.so.*")).parent
    return packages, f"{empty}{os.pathsep}{runtime}"


if __name__ == "__main__":
    print(torch_cpu()[0])


def torch_or_skip() -> tuple[Path, str]:
    """torch_cpu(); skips the test where PyTorch cannot be prepared."""
    import pytest

    if shutil.which("gcc") is None or shutil.which("readelf") is None:
        pytest.skip("stand-ins for CUDA's libraries are made with gcc")
    try:
        return torch_cpu()
    except RuntimeError as error:
        pytest.skip(f"no PyTorch: {error}")
