"""`gloam bench nav` on a Ray cluster of two processes: the same results, deaths of workers, and errors."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections import deque
from functools import partial
from pathlib import Path

import gloam
import pytest
from gloam._distribute.cluster import cluster
from gloam.navigation.benchmark.on_cluster import cluster_results
from gloam.navigation.benchmark.options import parse_options, plugin_files
from gloam.navigation.benchmark.pool import Died
from gloam.navigation.benchmark.request import Request
from gloam.navigation.benchmark.runner import Workers, run

pytest.importorskip("ray")
pytest.importorskip("openvino")  # of the walking policy
pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[2]


def do(folder: Path, task: int) -> int:
    """Work of a worker: 3 dies at its first attempt, 4 raises."""
    mark = folder / str(task)
    first = not mark.exists()
    mark.touch()
    if task == 3 and first:
        os.kill(os.getpid(), signal.SIGKILL)
    if task == 4:
        raise KeyError("four")
    return 2 * task


def test_without_a_cluster_nothing_runs(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "tools/navigation/commands.py"), "bench", "--ray", "auto", "--planners", "straight"]
    environment = {**os.environ, "RAY_TMPDIR": str(tmp_path)}  # where a cluster of this machine is not found
    ended = subprocess.run([*command, "--out", str(tmp_path / "out")], env=environment, capture_output=True, text=True, timeout=120)
    assert ended.returncode == 2 and "error: cannot connect to a Ray cluster at 'auto'" in ended.stderr, ended.stderr
    assert not list((tmp_path / "out").glob("episodes/*"))


def test_a_cluster_gives_the_results_of_one_machine(tmp_path: Path) -> None:
    plugin = Path(__file__).with_name("navigation_plugin.py")
    plugins = plugin_files([str(plugin)])
    request = Request(("brief",), ("house",), ("none",), 2, log=False, options=parse_options(["brief.pause=0"]), plugins=plugins)
    alone = run(request, tmp_path / "alone", Workers(1))
    with cluster(None, 2):
        told: list[str] = []
        many = run(request, tmp_path / "many", Workers(cluster="auto"), told.append)
        assert [r["hash"] for r in many] == [r["hash"] for r in alone] and len(told) == 2
        tasks = deque([1, 3, 2])
        made = []
        for task, result in cluster_results(partial(do, tmp_path), tasks, "auto"):
            made.append((task, result))
            if isinstance(result, Died):
                tasks.append(task)
        assert sorted(made, key=str) == sorted([(1, 2), (2, 4), (3, Died()), (3, 6)], key=str)
        with pytest.raises(gloam.Error, match="KeyError: 'four'"):
            list(cluster_results(partial(do, tmp_path), deque([4]), "auto"))
