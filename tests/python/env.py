"""The Python that the tests of `import gloam` run in: the packages of requirements.txt in a virtual environment.

    python3 tests/python/env.py

makes it in the folder of the tests' data (about 1.3 GB, once) and prints the interpreter.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
import fetch_data  # noqa: E402

REQUIREMENTS = Path(__file__).resolve().parent / "requirements.txt"


def pip(python: Path, *arguments: str | Path) -> None:
    """Runs this interpreter's pip for another. RuntimeError with its last line."""
    command = [sys.executable, "-m", "pip", "--python", python, *arguments, "--quiet", "--disable-pip-version-check"]
    result = subprocess.run(
        [str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if result.returncode != 0:
        raise RuntimeError(f"pip: {(result.stdout.strip().splitlines() or ['failed'])[-1]}")


def contents(requirements: Path) -> bytes:
    """Bytes of a list and of the lists that it includes."""
    data = requirements.read_bytes()
    included = [requirements.parent / line.split()[1] for line in data.decode().splitlines() if line.startswith("-r ")]
    return data + b"".join(map(contents, included))


def python_env(requirements: Path = REQUIREMENTS, base: str | None = None) -> Path:
    """An interpreter with the packages of a list with hashes; kept until the list changes.

    base: interpreter of the environment; None = that of ./gloam python, which the module was built for.
    Raises RuntimeError.
    """
    base = str(Path(base or ROOT / ".venv" / "python" / "bin" / "python").resolve())
    version = subprocess.run(
        [base, "-c", "import sys; print(sys.version)"], capture_output=True, text=True, check=True
    ).stdout
    wanted = hashlib.sha256(contents(requirements) + (base + version).encode()).hexdigest()[:8]
    folder = fetch_data.default_folder() / f"python-{requirements.stem}-{wanted}"
    folder.mkdir(parents=True, exist_ok=True)
    python = folder / "venv" / "bin" / "python"
    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            shutil.rmtree(folder / "venv", ignore_errors=True)
            subprocess.run([base, "-m", "venv", "--without-pip", folder / "venv"], check=True)
            pip(python, "install", "--no-deps", "--require-hashes", "--only-binary=:all:", "-r", requirements)
            (folder / "done").touch()
    return python


def variables() -> dict[str, str]:
    """Environment of a process that imports gloam from the source tree."""
    built = os.environ.get("GLOAM_BUILT", str(ROOT / "build" / "release" / "python" / "gloam"))
    return {**os.environ, "GLOAM_BUILT": built, "PYTHONPATH": str(ROOT / "python")}


if __name__ == "__main__":
    print(python_env())
