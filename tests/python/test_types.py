"""Types: the package, its module's stub and all examples under mypy --strict."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def merged(folder: Path) -> Path:
    """The package with its module's stub beside it, as a wheel has them."""
    package = folder / "gloam"
    shutil.copytree(ROOT / "python" / "gloam", package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(Path(os.environ["GLOAM_BUILT"]) / "_core.pyi", package)
    return package


def mypy(folder: Path, *files: Path) -> subprocess.CompletedProcess[str]:
    """mypy with the settings of pyproject.toml, run in `folder`. Its cache is kept beside the environment."""
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--config-file",
        ROOT / "pyproject.toml",
        "--python-executable",
        sys.executable,
        "--cache-dir",
        Path(sys.prefix).parent / "mypy_cache",
        *files,
    ]
    return subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        text=True,
        capture_output=True,
        env={**os.environ, "MYPYPATH": str(folder), "PYTHONPATH": ""},
    )


def test_package_and_examples_have_types_throughout(tmp_path: Path) -> None:
    package = merged(tmp_path)
    examples = sorted((ROOT / "examples" / "python").glob("*.py"))
    assert examples
    result = mypy(tmp_path, package, *examples)
    assert result.returncode == 0, result.stdout + result.stderr


def test_a_wrong_call_is_seen(tmp_path: Path) -> None:
    merged(tmp_path)
    (tmp_path / "wrong.py").write_text(
        'import gloam\n\nsim = gloam.load("house.toml")\nsim.step("two")\nsim.no_such_thing\n'
    )
    result = mypy(tmp_path, tmp_path / "wrong.py")
    assert result.returncode == 1
    assert 'has incompatible type "str"' in result.stdout and "no_such_thing" in result.stdout
    assert "2 errors" in result.stdout, result.stdout
