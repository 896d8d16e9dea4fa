"""The example that trains PPO runs, where its learner is installed."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "python" / "point_goal_ppo.py"


@pytest.mark.slow
def test_the_example_prints_a_curve():
    pytest.importorskip("skrl")
    pytest.importorskip("jax")
    command = [sys.executable, str(EXAMPLE), "--steps", "4100", "--worlds", "4"]
    printed = subprocess.run(command, check=True, timeout=300, capture_output=True, text=True).stdout
    (last,) = [line for line in printed.splitlines() if line.strip().startswith("4096")]
    assert 0 <= float(last.split()[1]) <= 100
