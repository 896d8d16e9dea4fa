"""What the tests of `import gloam` share: the package of the source tree, the module that GLOAM_BUILT names."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests")]
os.environ["PYTHONPATH"] = str(ROOT / "python")  # of processes that tests start
os.environ.setdefault("GLOAM_BUILT", str(ROOT / "build" / "release" / "python" / "gloam"))

import fetch_data  # noqa: E402
from e2e.support import PENDULUM  # noqa: E402

os.environ.setdefault("GLOAM_TEST_DATA", str(fetch_data.default_folder()))

settings.register_profile("gloam", deadline=None, derandomize=True, database=None)
settings.load_profile("gloam")


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """A cache of the run's own, where the caller named none."""
    os.environ.setdefault("GLOAM_CACHE", str(tmp_path_factory.mktemp("cache")))


@pytest.fixture(scope="session")
def examples() -> Path:
    """The folder examples/."""
    return ROOT / "examples"


@pytest.fixture
def pendulum(tmp_path: Path) -> Path:
    """A model of one hinge "hinge" with a motor "motor", and a camera "side"."""
    path = tmp_path / "pendulum.xml"
    path.write_text(PENDULUM)
    return path


RunPython = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def run_python(tmp_path: Path) -> RunPython:
    """Runs text in a Python of its own: run_python(code, expect=0, timeout=60, **variables). A crash fails the test."""

    def run(code: str, *, expect: int = 0, timeout: float = 60, **variables: str) -> subprocess.CompletedProcess[str]:
        result = subprocess.run(
            [sys.executable, "-X", "faulthandler", "-c", code],
            cwd=tmp_path,
            text=True,
            capture_output=True,
            stdin=subprocess.DEVNULL,
            timeout=timeout,
            env={**os.environ, **variables},
        )
        assert result.returncode == expect, f"ended with {result.returncode}\n{result.stdout}\n{result.stderr}"
        return result

    return run
