"""Examples, notebooks and the Python of the documents run as they stand."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import nbclient
import nbformat
import pytest

import gloam

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "docs" / "python.md"]
# Examples that need a network or packages of others: their own tests run them.
ELSEWHERE = {"g1_policy.py", "go2_policy.py", "point_goal_ppo.py"}


def blocks(page: Path) -> list[str]:
    """The page's Python; that which needs a package of others for logs is their own."""
    found = re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)
    return [text for text in found if "mcap_ros2" not in text]


def python(*arguments: str | Path, cwd: Path) -> str:
    result = subprocess.run(
        [sys.executable, "-X", "faulthandler", *map(str, arguments)],
        cwd=cwd,
        text=True,
        capture_output=True,
        stdin=subprocess.DEVNULL,
        timeout=600,
        env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "GLOAM_HOME": str(cwd)},
    )
    assert result.returncode == 0, f"{arguments}\n{result.stdout[-3000:]}\n{result.stderr[-3000:]}"
    return result.stdout


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """A folder with examples/ and assets/, as a clone has them, to write into."""
    for name in ("examples", "assets"):
        shutil.copytree(ROOT / name, tmp_path / name)
    return tmp_path


@pytest.mark.parametrize("page", [page for page in PAGES if page.exists() and blocks(page)], ids=lambda page: page.name)
def test_python_of_documents_runs(page: Path, clone: Path) -> None:
    """The blocks of a page are one program; scenes that the page shows as "# examples/NAME.toml" are there."""
    for name, text in re.findall(r"^```toml\n# (examples/\w+\.toml)\n(.*?)^```", page.read_text(), re.M | re.S):
        (clone / name).write_text(text)
    (clone / "page.py").write_text("\n".join(blocks(page)))
    python("page.py", cwd=clone)


@pytest.mark.parametrize(
    "name", sorted(path.name for path in (ROOT / "examples" / "python").glob("*.py") if path.name not in ELSEWHERE)
)
def test_examples_run(name: str, clone: Path) -> None:
    python(f"examples/python/{name}", cwd=clone)


@pytest.mark.parametrize("name", sorted(path.name for path in (ROOT / "examples" / "python").glob("*.ipynb")))
def test_notebooks_run(name: str, clone: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "python"))
    monkeypatch.setenv("IPYTHONDIR", str(clone / "ipython"))
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(clone / "runtime"))
    notebook = nbformat.read(clone / "examples" / "python" / name, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "a notebook is kept without outputs"
    nbclient.NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(clone)}}
    ).execute()
    kinds = {kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})}
    assert {"image/png", "text/html"} <= kinds
    shown: list[Any] = [
        output["data"]["text/html"]
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if "text/html" in output.get("data", {})
    ]
    assert (
        any("<img" in text for text in shown)
        and any("<video" in text for text in shown)
        and any("<details" in text for text in shown)
    )


def test_the_package_finds_its_home() -> None:
    assert (gloam.home() / "examples" / "demo.toml").exists()
