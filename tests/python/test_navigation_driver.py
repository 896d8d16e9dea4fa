"""The driver of planners: rates, latencies, faults, and the same result in each run; planners of scenes and processes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.envs.assets import asset_folder
from gloam.navigation import Arrived, Driver, MapSource, Observation, Planner, Rig, Spacing, Task, Velocity, Waypoints, make_planner
from gloam.navigation.planner import Answer
from gloam.navigation.recorded import map_of_log
from gloam.navigation.scene import drive, planner_of, task_of
from navigation_scene import arena

GOAL = (0.2, -0.4)


class Scripted(Planner):
    """Answers with what it is given, and keeps its observations."""

    def __init__(self, answers: list[object], rate: float = 4.0, latency: float = 0.1) -> None:
        self.answers, self.rate, self.latency = answers, rate, latency
        self.seen: list[Observation] = []

    def reset(self, task: Task) -> None:
        self.seen.clear()

    def plan(self, observation: Observation) -> Answer:
        self.seen.append(observation)
        answer = self.answers[min(len(self.seen), len(self.answers)) - 1]
        if isinstance(answer, Exception):
            raise answer
        return answer  # type: ignore[return-value]


@pytest.fixture(scope="module")
def world() -> gloam.World:
    return arena().compile()


@pytest.fixture
def sim(world: gloam.World) -> Iterator[gloam.Simulation]:
    with gloam.Simulation(world) as made:
        yield made


def commanded(sim: gloam.Simulation) -> list[tuple[float, float]]:
    """Time and forward goal of each command that the simulation applies from now on."""
    robot, sent = sim.robots["go"], []
    send = robot.command

    def note(vx: float = 0.0, vy: float = 0.0, yaw_rate: float = 0.0, vz: float = 0.0) -> None:
        sent.append((round(sim.time, 3), vx))
        send(vx, vy, yaw_rate, vz)

    robot.command = note  # type: ignore[method-assign]
    return sent


def test_answers_apply_after_the_latency_at_the_rate(sim: gloam.Simulation) -> None:
    planner = Scripted([Velocity(0.1), Velocity(0.2), Velocity(0.3)], rate=4, latency=0.15)
    driver = Driver(sim, Rig("go"), planner)
    sent = commanded(sim)
    driver._robot = sim.robots["go"]
    driver.run(Task("go"), 1.0)
    assert [round(o.time, 3) for o in planner.seen] == [0, 0.25, 0.5, 0.75]
    assert sent[:3] == [(0.15, 0.1), (0.4, 0.2), (0.65, 0.3)]


def test_faults_stop_the_robot_and_are_counted(sim: gloam.Simulation) -> None:
    faults = [ValueError("broken"), Velocity(math.nan), Waypoints(np.zeros((1, 2)), 3), "left"]
    planner = Scripted([Velocity(0.3), *faults], rate=10, latency=0)
    driver = Driver(sim, Rig("go"), planner, timeout=0.5)
    sent = commanded(sim)
    driver._robot = sim.robots["go"]
    driver.run(Task("go"), 1.0)
    assert driver.stats.invalid == driver.stats.plans - 1
    assert driver.stats.error == "ValueError: broken"
    assert sent[0] == (0.0, 0.3)
    assert sent[1][1] == 0 and 0.5 <= sent[1][0] <= 0.6


def test_an_arrival_ends_the_calls(sim: gloam.Simulation) -> None:
    planner = Scripted([Velocity(0.1), Arrived()])
    driver = Driver(sim, Rig("go"), planner)
    driver.run(Task("go"), 2.0)
    assert driver.has_arrived and driver.stats.plans == 2


def test_missing_parts_and_rates_are_rejected(sim: gloam.Simulation) -> None:
    seeing = Scripted([])
    seeing.needs = frozenset({"image"})  # type: ignore[misc]
    with pytest.raises(gloam.UsageError, match="needs a camera"):
        Driver(sim, Rig("go"), seeing)
    with pytest.raises(gloam.UsageError, match="rate above 0"):
        Driver(sim, Rig("go"), Scripted([], rate=-1))
    with pytest.raises(gloam.NotFoundError, match="there is no planner 'rout'"):
        make_planner("rout")


def test_rigs_have_the_named_parts_or_the_first_ones(world: gloam.World) -> None:
    assert Rig.of(world) == Rig("go", world.cameras[0], "lidar") and world.cameras[0].startswith("go/")
    assert Rig.of(world, "go", world.cameras[-1]).camera == world.cameras[-1]
    for names, cause in ((("no",), "robot 'no'"), (("go", "no"), "camera 'no'"), (("", "", "no"), "LiDAR 'no'")):
        with pytest.raises(gloam.NotFoundError, match=f"there is no {cause}; there are: "):
            Rig.of(world, *names)
    empty = gloam.Scene.from_dict({"environment": {"file": "environments/arena/arena.xml"}}, folder=asset_folder()).compile()
    with pytest.raises(gloam.NotFoundError, match="no robot ''; there are: none"):
        Rig.of(empty)


def test_a_log_becomes_a_map(world: gloam.World, tmp_path: Path) -> None:
    with gloam.Simulation(world) as sim, sim.record(tmp_path / "run.mcap", ("/clock", "/tf*")):
        sim.robots["go"].command(vx=0.4)
        sim.run_until(time=2.0)
        place = np.array(sim.robots["go"].pose.p)
    made = map_of_log(tmp_path / "run.mcap", tmp_path, Spacing("time", 0.5), (32, 24))
    assert made.source == MapSource.of(world, world.cameras[0])
    assert np.diff([node.time for node in made.nodes]) == pytest.approx(0.5) and made.nodes[0].image.shape == (24, 32, 3)
    assert made.nodes[0].pose[:2] == pytest.approx((-1.4, 0.2), abs=0.05)
    assert math.dist(made.nodes[-1].pose[:2], place[:2]) < 0.15, "at most a quarter of a second before the end"
    with pytest.raises(gloam.NotFoundError, match="camera 'no'"):
        map_of_log(tmp_path / "run.mcap", tmp_path, Spacing("time", 0.5), who=("", "no"))


@pytest.mark.parametrize("name", ["straight", "route", "route_mppi", "lidar"])
def test_baselines_reach_the_goal_and_repeat(world: gloam.World, name: str) -> None:
    hashes = set()
    for _ in range(2):
        with gloam.Simulation(world) as sim:
            driver = Driver(sim, Rig("go", lidar="lidar"), make_planner(name))
            driver.run(Task("go", goal=GOAL, world=world, radius=0.4), 12.0, lambda s: driver.has_arrived)
            assert driver.has_arrived and driver.stats.invalid == 0
            assert math.dist(sim.robots["go"].pose.p[:2], GOAL) < 0.5
            hashes.add(sim.hash)
            driver.close()
    assert len(hashes) == 1, "the same run gives the same state"


def test_planners_reject_incomplete_tasks() -> None:
    for name in ("straight", "route", "route_mppi", "lidar", "replay", "gloam"):
        try:
            planner = make_planner(name)
        except gloam.Error:
            continue  # without weights
        with pytest.raises(gloam.UsageError):
            planner.reset(Task("go"))


def test_the_scene_selects_a_planner() -> None:
    scene = arena(
        planner={"type": "straight", "top_speed": 0.3, "rate": 5, "latency": 0.2},
        goal=[{"robot": "go", "position": [*GOAL, 0], "radius": 0.4}],
    )
    world = scene.compile()
    planner, task = planner_of(scene), task_of(scene, world)
    assert (planner.rate, planner.latency) == (5, 0.2)
    assert task.goal == GOAL and task.top_speed == 0.3 and task.radius == 0.4
    with gloam.Simulation(world) as sim:
        assert drive(sim, 12.0).has_arrived


def test_files_of_a_planner_are_found_beside_the_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scene").mkdir()
    (tmp_path / "scene" / "own.onnx").touch()
    (tmp_path / "scene" / "box.xml").write_text('<mujoco><worldbody><body><geom size="0.1"/></body></worldbody></mujoco>')
    (tmp_path / "scene" / "scene.toml").write_text(
        '[[robot]]\nname = "box"\nfile = "box.xml"\n[planner]\ntype = "gnm"\nweights = "own.onnx"\n'
    )
    given = []
    monkeypatch.setattr("gloam.navigation.scene.make_planner", lambda name, **options: given.append(options) or Scripted([]))
    planner_of(gloam.Scene(tmp_path / "scene" / "scene.toml"))
    assert given == [{"weights": tmp_path / "scene" / "own.onnx"}]


def test_scenes_with_wrong_planners_are_rejected() -> None:
    with pytest.raises(gloam.InputError, match="robot 'no' does not exist"):
        arena(planner={"type": "route", "robot": "no"})
    with pytest.raises(gloam.InputError, match="needs an 'address'"):
        arena(planner={"type": "external"})
    with pytest.raises(gloam.InputError, match="'command' or an 'address'"):
        arena(planner={"type": "route", "command": "x"})
    with pytest.raises(gloam.UsageError, match="has no \\[planner\\]"):
        planner_of(arena())
