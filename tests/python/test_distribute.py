"""Many runs by gloam.distribute: the list of a folder, errors, and what a kill leaves."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam import distribute
from gloam._distribute.cluster import cluster
from gloam._distribute.jobs import Failure, RolloutJob, SceneSource, work
from gloam._distribute.manifest import Manifest, publish, read_task

BALL = """<mujoco><worldbody>
  <geom type="plane" size="2 2 .1"/>
  <body name="ball" pos="0 0 .5"><freejoint name="free"/><geom size=".1" rgba="1 0 0 1"/></body>
</worldbody></mujoco>"""
SCENE = """
[sim]
duration = 0.2
timestep = 0.005
[environment]
file = "ball.xml"
[[camera]]
name = "cam"
position = [1, 0, 0.5]
look_at = [0, 0, 0.2]
width = 32
height = 24
rate = 10
[render]
tier = "direct"
spp = 1
[record]
outputs = ["png"]
"""
SKIES = '[[randomize]]\noption = "camera.cam.fovy"\nuniform = [30, 60]\n'


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "ball.xml").write_text(BALL)
    (tmp_path / "skies.toml").write_text(SKIES)
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path / "scene.toml"


def throw(sim: gloam.Simulation, seed: int, folder: Path) -> Mapping[str, Any]:
    """Throws the ball by the seed."""
    rng = np.random.default_rng(seed)
    sim.joints["free"].set(qvel=rng.normal(size=6))
    sim.step(40)
    (folder / "note.txt").write_text(f"seed {seed}")
    return {"position": sim.bodies["ball"].pose.p, "seed": np.int64(seed)}


def fail_at_three(sim: gloam.Simulation, seed: int, folder: Path) -> None:
    if seed == 3 and not (Path(os.environ["GLOAM_TEST_MARKS"]) / "mended").exists():
        raise ValueError("three is not liked")
    sim.step(seed)


def _manifest(
    out: Path, seeds: list[int], request: Mapping[str, Any] | None = None, overwrite: bool = False
) -> Manifest:
    return Manifest(out, "test", request or {"a": 1}, seeds, overwrite)


def _finish(out: Path, name: str, seed: int) -> None:
    assert work(lambda folder, _: (folder.mkdir(), {})[1], str(out), name, seed, 1) is None


def _states(out: Path) -> list[str]:
    return [task["state"] for task in json.loads((out / "manifest.json").read_text())["tasks"]]


def test_list_goes_on_with_what_is_missing(tmp_path: Path) -> None:
    first = _manifest(tmp_path / "out", [5, 6, 7])
    _finish(first.out, "0001", 6)
    (first.out / ".part-0002-abc").mkdir()  # of a worker that died
    first.write()
    assert _states(first.out) == ["waiting", "done", "waiting"]
    first.close()
    again = _manifest(tmp_path / "out", [5, 6, 7, 8])
    assert again.missing() == [0, 2, 3] and not list(again.out.glob(".part-*"))
    again.errors[0] = "why"
    again.write()
    assert _states(again.out) == ["failed", "done", "waiting", "waiting"]
    again.close()


def test_list_of_another_request_is_left_alone(tmp_path: Path) -> None:
    _manifest(tmp_path, [1]).close()
    with pytest.raises(gloam.UsageError, match="another request"):
        _manifest(tmp_path, [1], {"a": 2})
    _manifest(tmp_path, [1]).close()


def test_seeds_of_another_call_are_not_taken_for_its_own(tmp_path: Path) -> None:
    first = _manifest(tmp_path, [1])
    _finish(tmp_path, "0000", 1)
    first.close()
    with pytest.raises(gloam.UsageError, match="made with seed 1, not 9"):
        _manifest(tmp_path, [9])
    _manifest(tmp_path, [9], overwrite=True).close()
    assert not (tmp_path / "0000").exists()


def test_a_strangers_folder_is_never_taken_or_removed(tmp_path: Path) -> None:
    (tmp_path / "0000").mkdir()
    (tmp_path / "0000" / "thesis.txt").write_text("years of work")
    for overwrite in (False, True):
        with pytest.raises(gloam.UsageError, match="no task made it"):
            _manifest(tmp_path, [1], overwrite=overwrite)
    assert (tmp_path / "0000" / "thesis.txt").exists()


def test_one_call_at_a_time(tmp_path: Path) -> None:
    first = _manifest(tmp_path, [1])
    with pytest.raises(gloam.UsageError, match="another call works"):
        _manifest(tmp_path, [1])
    first.close()
    _manifest(tmp_path, [1]).close()


@pytest.mark.parametrize(
    "text, says", [("{", "damaged"), ("[]", "no list of tasks"), ('{"tasks": 3}', "no list of tasks")]
)
def test_damaged_lists(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(gloam.InputError, match=says):
        _manifest(tmp_path, [1])


def test_damaged_task(tmp_path: Path) -> None:
    (tmp_path / "0000").mkdir()
    (tmp_path / "0000" / "task.json").write_text('{"seed": ')
    with pytest.raises(gloam.InputError, match="damaged.*made again"):
        _manifest(tmp_path, [1])


def test_of_two_workers_the_first_one_counts(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "task.json").write_text(json.dumps({"seed": 1, "by": name}))
    assert publish(tmp_path / "a", tmp_path / "0000") and not publish(tmp_path / "b", tmp_path / "0000")
    assert read_task(tmp_path / "0000") == {"seed": 1, "by": "a"}


def test_a_task_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def job(folder: Path, seed: int) -> dict[str, Any]:
        folder.mkdir()
        (folder / "half").touch()
        raise gloam.InputError("no", "x.toml", 3)

    assert work(job, str(tmp_path), "0000", 1, 1) == Failure("x.toml:3: no")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments, says",
    [
        ({"count": 0}, "from 1 on"),
        ({"count": True}, "from 1 on"),
        ({"count": 2, "seeds": [1]}, "1 seeds are given for 2"),
        ({"count": 2, "seeds": [1, 1]}, "twice"),
        ({"count": 1, "seeds": -1}, "0 … 2"),
        ({"count": 1, "seeds": [2**64]}, "0 … 2"),
    ],
)
def test_wrong_seeds(scene: Path, tmp_path: Path, arguments: dict[str, Any], says: str) -> None:
    with pytest.raises(gloam.UsageError, match=says):
        distribute.rollouts(scene, throw, out=tmp_path / "out", **arguments)


def test_wrong_arguments(scene: Path, tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="a gloam.Policy or a function"):
        distribute.rollouts(scene, None, 1, out=tmp_path / "out")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a scene is a path"):
        distribute.rollouts(None, throw, 1, out=tmp_path / "out")
    with pytest.raises(gloam.UsageError, match="none.toml cannot be read"):
        distribute.rollouts(tmp_path / "none.toml", throw, 1, out=tmp_path / "out")
    with pytest.raises(gloam.UsageError, match="none.mcap cannot be read"):
        distribute.variants(tmp_path / "none.mcap", tmp_path / "skies.toml", 1, tmp_path / "out")


def test_without_ray_the_error_says_what_to_install(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match="pip install ray"):
        distribute.rollouts(scene, throw, 1, out=tmp_path / "out")


def test_results_that_no_file_holds(scene: Path, tmp_path: Path) -> None:
    def job(result: Any) -> str:
        made = work(RolloutJob(SceneSource(str(scene)), lambda *_: result), str(tmp_path), "0000", 1, 1)
        assert made is not None
        return made.error

    assert "cannot be written" in job({"x": float("nan")}) and "cannot be written" in job({"x": object()})
    assert "returns a dict or None, not a int" in job(3)


slow = pytest.mark.slow


@pytest.fixture(scope="module")
def two_workers() -> Iterator[Any]:
    pytest.importorskip("ray")
    with cluster(None, 2) as made:
        yield made


@slow
def test_cluster_listens_on_loopback_only(two_workers: Any) -> None:
    assert [node["NodeManagerAddress"] for node in two_workers.nodes()] == ["127.0.0.1"]


@slow
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


@slow
def test_errors_of_one_do_not_lose_the_others(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    marks = str(tmp_path)

    def job(sim: gloam.Simulation, seed: int, folder: Path) -> None:
        os.environ["GLOAM_TEST_MARKS"] = marks
        fail_at_three(sim, seed, folder)

    with pytest.raises(gloam.PartialError, match="1 of 5 tasks failed; seed 3: ValueError: three is not liked"):
        distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None)
    assert _states(tmp_path / "out") == ["done", "done", "failed", "done", "done"]
    before = (tmp_path / "out" / "0000" / "task.json").stat().st_mtime_ns
    assert distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None, required=False).failed[0].seed == 3
    (tmp_path / "mended").touch()
    assert len(distribute.rollouts(scene, job, 5, out=tmp_path / "out", topics=None).done) == 5
    assert (tmp_path / "out" / "0000" / "task.json").stat().st_mtime_ns == before
    with pytest.raises(gloam.UsageError, match="another request"):
        distribute.rollouts(scene, throw, 5, out=tmp_path / "out", topics=None)


@slow
def test_rollouts_of_a_policy(two_workers: Any, tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    pytest.importorskip("onnx")
    from policy_fixtures import held_policy, write_scene

    scene, policy = write_scene(tmp_path), held_policy(tmp_path)
    arguments: dict[str, Any] = {"robot": "bot", "command": (0.5, 0, 0), "topics": None}
    with pytest.raises(gloam.UsageError, match="needs a duration above 0 s, not None"):
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


@slow
def test_scenes_from_code_and_settings(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    made = gloam.Scene(scene)
    made["sim.timestep"] = 0.002

    def job(sim: gloam.Simulation, seed: int, folder: Path) -> dict[str, Any]:
        return {"timestep": sim.timestep, "bodies": len(sim.world.bodies), "fovy": sim.scene["camera.cam.fovy"]}

    report = distribute.rollouts(made, job, 1, out=tmp_path / "a", topics=None, settings={"camera.cam.fovy": 33.0})
    assert report.tasks[0].values["result"] == {"timestep": 0.002, "bodies": 2, "fovy": 33.0}
    tables = {"sim": {"timestep": 0.004}, "camera": [{"name": "cam", "position": [1, 0, 1], "fovy": 44.0}]}
    report = distribute.rollouts(tables, job, 1, out=tmp_path / "b", topics=None)
    assert report.tasks[0].values["result"] == {"timestep": 0.004, "bodies": 1, "fovy": 44.0}


@slow
def test_ctrl_c_ends_a_call_that_goes_on_later(scene: Path, tmp_path: Path) -> None:
    pytest.importorskip("ray")
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
    states = _states(tmp_path / "out")
    assert states.count("done") == len(list((tmp_path / "out").glob("00*"))) < 100 and "failed" not in states


@slow
def test_what_cannot_be_sent(two_workers: Any, scene: Path, tmp_path: Path) -> None:
    with gloam.load(scene) as held, pytest.raises(gloam.UsageError, match="cannot be sent to workers"):
        distribute.rollouts(scene, lambda sim, seed, folder: {"t": held.time}, 1, out=tmp_path / "out")


@slow
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


@slow
def test_kills_of_a_worker_and_of_the_call(scene: Path, tmp_path: Path) -> None:
    """A worker dies at seed 3 and its task is done again; the call dies after some tasks and goes on."""
    pytest.importorskip("ray")
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
    assert _states(out) == ["done"] * 10
    for index in range(10):
        folder = out / f"{index:04}"
        assert (folder / "parts.txt").read_text() == "".join(f"{index + 1} {part}\n" for part in range(4))
        assert read_task(folder)["result"] == {"twice": 2 * (index + 1)}  # type: ignore[index]
        assert folder.name not in there or (folder / "task.json").stat().st_mtime_ns == there[folder.name]
    begun = [int(line) for line in (marks / "begun").read_text().split()]
    assert begun.count(3) >= 2 and all(begun.count(int(name) + 1) == 1 for name in there if name != "0002")
