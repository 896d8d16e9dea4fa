"""gloam.distribute on a cluster of two processes: the same results, errors, kills, and going on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gloam
import pytest
from gloam import distribute
from gloam._distribute.cluster import cluster
from gloam._distribute.jobs import RolloutJob, SceneSource, work
from gloam._distribute.manifest import read_task

from distribute_fixtures import states, throw, write_ball

pytest.importorskip("ray")
pytestmark = pytest.mark.slow


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return write_ball(tmp_path)


def fail_at_three(sim: gloam.Simulation, seed: int, folder: Path) -> None:
    if seed == 3 and not (Path(os.environ["GLOAM_TEST_MARKS"]) / "mended").exists():
        raise ValueError("three is not liked")
    sim.step(seed)


@pytest.fixture(scope="module")
def two_workers() -> Iterator[Any]:
    with cluster(None, 2) as made:
        yield made


def test_cluster_listens_on_loopback_only(two_workers: Any) -> None:
    assert [node["NodeManagerAddress"] for node in two_workers.nodes()] == ["127.0.0.1"]


def test_results_do_not_depend_on_the_workers(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    told: list[float] = []
    report = distribute.rollouts(
        scene, throw, 5, 11, out=tmp_path / "many", progress=lambda task, done, s, left: told.append(done)
    )
    assert [task.seed for task in report.done] == [11, 12, 13, 14, 15] and told[-1] == 1.0 and told == sorted(told)
    (tmp_path / "one").mkdir()
    for task in report.tasks:
        job = RolloutJob(SceneSource(str(scene)), throw, topics=list(distribute.TOPICS))
        assert work(job, str(tmp_path / "one"), task.folder.name, task.seed, 1) is None
        alone = tmp_path / "one" / task.folder.name
        assert read_task(alone) == task.values
        assert (task.folder / "note.txt").read_text() == f"seed {task.seed}"
        log = gloam.replay(task.folder / "run.mcap")
        assert log.verify().differing_steps == 0
    assert len({task.values["hash"] for task in report.tasks}) == 5


def test_errors_of_one_do_not_lose_the_others(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    marks = str(tmp_path)

    def job(sim: gloam.Simulation, seed: int, folder: Path) -> None:
        os.environ["GLOAM_TEST_MARKS"] = marks
        fail_at_three(sim, seed, folder)

    with pytest.raises(gloam.PartialError, match="1 of 5 tasks failed; seed 3: ValueError: three is not liked"):
        distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None)
    assert states(tmp_path / "out") == ["done", "done", "failed", "done", "done"]
    before = (tmp_path / "out" / "0000" / "task.json").stat().st_mtime_ns
    assert distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None, required=False).failed[0].seed == 3
    (tmp_path / "mended").touch()
    assert len(distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None).done) == 5
    assert (tmp_path / "out" / "0000" / "task.json").stat().st_mtime_ns == before
    with pytest.raises(gloam.UsageError, match="another request"):
        distribute.rollouts(scene, throw, 5, out=tmp_path / "out", topics=None)


def test_rollouts_of_a_policy(two_workers: Any, tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    pytest.importorskip("onnx")
    from policy_fixtures import held_policy, write_scene

    scene, policy = write_scene(tmp_path), held_policy(tmp_path)
    arguments: dict[str, Any] = {"robot": "bot", "command": (0.5, 0, 0), "topics": None}
    with pytest.raises(gloam.UsageError, match="needs a duration above 0 s, got None"):
        distribute.rollouts(scene, policy, 2, out=tmp_path / "out", **arguments)
    report = distribute.rollouts(scene, policy, 2, out=tmp_path / "out", duration=0.5, **arguments)
    with gloam.load(scene, seed=2) as sim:
        policy.attach(sim, "bot").command(vx=0.5)
        sim.run_until(time=0.5)
        assert report.tasks[1].values["hash"] == f"{sim.hash:016x}" and report.tasks[1].values["steps"] == 100
    with pytest.raises(gloam.UsageError, match="another request"):
        distribute.rollouts(scene, policy, 2, out=tmp_path / "out", duration=0.6, **arguments)
    again = distribute.rollouts(scene, policy, 2, out=tmp_path / "out", duration=0.6, overwrite=True, **arguments)
    assert [task.values["steps"] for task in again.done] == [120, 120]


def test_scenes_from_code_and_settings(
    two_workers: Any, scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # paths of tables begin where the call is made, wherever workers are
    made = gloam.Scene(scene)
    made["sim.timestep"] = 0.002

    def job(sim: gloam.Simulation, seed: int, folder: Path) -> dict[str, Any]:
        return {"timestep": sim.timestep, "bodies": len(sim.world.bodies), "fovy": sim.scene["camera.cam.fovy"]}

    report = distribute.rollouts(made, job, 1, out=tmp_path / "a", topics=None, settings={"camera.cam.fovy": 33.0})
    assert report.tasks[0].values["result"] == {"timestep": 0.002, "bodies": 2, "fovy": 33.0}
    camera = {"name": "cam", "position": [1, 0, 1], "look_at": [0, 0, 0], "fovy": 44.0}
    tables = {"sim": {"timestep": 0.004}, "environment": {"file": "ball.xml"}, "camera": [camera]}
    report = distribute.rollouts(tables, job, 1, out=tmp_path / "b", topics=None)
    assert report.tasks[0].values["result"] == {"timestep": 0.004, "bodies": 2, "fovy": 44.0}


def test_ctrl_c_ends_a_call_that_goes_on_later(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "marks").mkdir()
    (tmp_path / "marks" / "killed").touch()
    command = [sys.executable, str(Path(__file__).with_name("distribute_job.py")), str(scene), str(tmp_path / "out")]
    process = subprocess.Popen([*command, str(tmp_path / "marks"), "100"], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while len(list((tmp_path / "out").glob("00*"))) < 3:
        assert time.monotonic() < deadline and process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    told = process.communicate(timeout=30)[1]
    assert process.returncode != 0 and "KeyboardInterrupt" in told
    told_states = states(tmp_path / "out")
    assert told_states.count("done") == len(list((tmp_path / "out").glob("00*"))) < 100 and "failed" not in told_states


def test_what_cannot_be_sent(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    with gloam.load(scene) as held, pytest.raises(gloam.UsageError, match="cannot be sent to workers"):
        distribute.rollouts(scene, lambda sim, seed, folder: {"t": held.time}, 1, out=tmp_path / "out")


def test_variants_are_those_of_one_machine(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    with gloam.load(scene) as sim, sim.record(tmp_path / "run.mcap", ["/clock"]):
        sim.run_until(time=0.2)
    report = distribute.variants(tmp_path / "run.mcap", tmp_path / "skies.toml", 3, tmp_path / "many")
    gloam.replay(tmp_path / "run.mcap").variants(tmp_path / "skies.toml", 3, tmp_path / "one")
    pictures = set()
    for task in report.done:
        ours = sorted(p for p in task.folder.rglob("*.png"))
        assert ours
        for picture in ours:
            there = tmp_path / "one" / task.folder.name / picture.relative_to(task.folder)
            assert picture.read_bytes() == there.read_bytes()
        pictures.add(ours[0].read_bytes())
    assert len(pictures) == 3  # the randomised option really changes them
    assert {p.name for p in (tmp_path / "many").iterdir()} == {"0000", "0001", "0002", "manifest.json", ".lock"}


def test_kills_of_a_worker_and_of_the_call(scene: Path, tmp_path: Path) -> None:
    """A worker dies at seed 3 and its task is done again; the call dies after some tasks and goes on."""
    marks, out = tmp_path / "marks", tmp_path / "out"
    marks.mkdir()
    command = [
        sys.executable,
        str(Path(__file__).with_name("distribute_job.py")),
        str(scene),
        str(out),
        str(marks),
        "10",
    ]
    environment = {**os.environ, "GLOAM_TEST_MARKS": str(marks)}
    first = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while len(list(out.glob("00*"))) < 4:
        assert time.monotonic() < deadline and first.poll() is None
        time.sleep(0.01)
    first.send_signal(signal.SIGKILL)
    first.wait()
    there = {folder.name: (folder / "task.json").stat().st_mtime_ns for folder in out.glob("00*")}
    assert (marks / "killed").exists() and 4 <= len(there) < 10
    second = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=200)
    assert second.returncode == 0 and second.stdout.strip().endswith("10"), second.stderr
    assert {p.name for p in out.iterdir()} == {*(f"{i:04}" for i in range(10)), "manifest.json", ".lock"}
    assert states(out) == ["done"] * 10
    for index in range(10):
        folder = out / f"{index:04}"
        assert (folder / "parts.txt").read_text() == "".join(f"{index + 1} {part}\n" for part in range(4))
        assert read_task(folder)["result"] == {"twice": 2 * (index + 1)}  # type: ignore[index]
        assert folder.name not in there or (folder / "task.json").stat().st_mtime_ns == there[folder.name]
    begun = [int(line) for line in (marks / "begun").read_text().split()]
    assert begun.count(3) >= 2 and all(begun.count(int(name) + 1) == 1 for name in there if name != "0002")
