"""Episodes of the navigation benchmark: pairs, outcomes, resumption, and how adversity changes planners."""

from __future__ import annotations

import errno
import json
import math
import shutil
from dataclasses import asdict, fields, replace
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.navigation import Arrived, Observation, Planner, Task, Velocity, register_planner
from gloam.navigation.benchmark.demonstration import SPACING, TURN, poses_along
from gloam.navigation.benchmark.episode import EpisodeSpec, Touched, Watch, run_episode
from gloam.navigation.benchmark.options import File, Option
from gloam.navigation.benchmark.places import LEVELS, ROBOT, Course, Pair, scene_of
from gloam.navigation.benchmark.request import REQUEST_FILE, Request
from gloam.navigation.benchmark.runner import Workers, run
from navigation_replay import measured


@pytest.fixture(scope="module")
def course() -> Course:
    return Course("house")


def test_pairs_are_reachable_at_every_level_and_shared(course: Course) -> None:
    pairs = [course.pair(seed) for seed in range(8)]
    again = [course.pair(seed) for seed in range(8)]
    assert [p.start for p in pairs] == [p.start for p in again]
    assert len({p.start for p in pairs}) == 8
    for pair in pairs:
        assert 3.9 <= pair.shortest <= 12.5
        assert math.dist(pair.path[0], pair.start[:2]) < 0.11 and math.dist(pair.path[-1], pair.goal) < 0.11
        assert pair.shortest >= math.dist(pair.start[:2], pair.goal) - 0.2
        blocked = [course.grid.blocked[course.grid.index(p)] for p in pair.path]
        assert np.mean(blocked) < 0.05, "smoothing may cut a corner by a cell"
    keys = {(level, EpisodeSpec("a", "house", level, 3).pair_seed) for level in LEVELS}
    assert len({seed for _, seed in keys}) == 1
    with pytest.raises(gloam.UsageError, match="no paths"):
        course.pair(1, reach=(500.0, 600.0))
    with pytest.raises(gloam.NotFoundError, match="there is no scene 'home'"):
        scene_of("home", "none")


def test_an_episode_repeats_and_is_measured_again_from_its_log(course: Course, tmp_path: Path) -> None:
    spec = EpisodeSpec("straight", "house", "none", 0)
    pair = course.pair(spec.pair_seed)
    results = [run_episode(spec, pair, tmp_path / str(k), tmp_path / "maps") for k in range(2)]
    assert results[0]["outcome"] == "collided" and results[0]["collisions"] > 0, "the way is blocked"
    assert results[0]["hash"] == results[1]["hash"]
    log = tmp_path / "0" / "run.mcap"
    read = json.loads((tmp_path / "0" / "episode.json").read_text())
    again = measured(read, log)
    for name in ("outcome", "success", "collisions", "collisions_by_object"):
        assert again[name] == read[name], name
    for name in ("time", "path_length", "final_distance"):
        assert again[name] == pytest.approx(read[name], abs=1e-9), name
    assert sum(read["collisions_by_object"].values()) == len(read["touches"]) == read["collisions"]
    assert read["track"][-1][0] == pytest.approx(1.0 + read["time"]) and len(read["track"]) == pytest.approx(2 * read["time"], abs=2)
    with pytest.raises(AssertionError, match="another state"):
        measured(read | {"hash": "0x0"}, log)
    with pytest.raises(AssertionError, match="begins elsewhere"):
        measured(read | {"start": [0.0, 0.0, 0.0]}, log)


def test_a_success_has_a_log_that_verifies(course: Course, tmp_path: Path) -> None:
    spec = EpisodeSpec("route", "house", "none", 1)
    result = run_episode(spec, course.pair(spec.pair_seed), tmp_path / "e", tmp_path / "maps")
    assert result["outcome"] == "success" and result["final_distance"] < 1.0
    assert result["visibility_mean"] == result["visibility_min"] == pytest.approx(100_000), "the air is clear"
    assert gloam.replay(tmp_path / "e" / "run.mcap").verify().is_equal


class _Tired(Planner):
    """Considers itself to be at the goal from the beginning."""

    uses_map = False

    def reset(self, task: Task) -> None:
        pass

    def plan(self, observation: Observation) -> Arrived:
        return Arrived()


class _Nan(_Tired):
    def plan(self, observation: Observation) -> Velocity:  # type: ignore[override]
        return Velocity(vx=math.nan)


def test_a_planner_that_stops_elsewhere_is_lost_and_one_without_answers_is_stuck(course: Course, tmp_path: Path) -> None:
    for name, planner, outcome, share in (("tired", _Tired, "lost", 0.0), ("nan", _Nan, "stuck", 1.0)):
        register_planner(name, planner)
        result = run_episode(EpisodeSpec(name, "house", "none", 0, log=False), course.pair(1), tmp_path / name, tmp_path / "maps")
        assert result["outcome"] == outcome and result["invalid"] == share * result["plans"] > -1, name
        assert result["time"] == pytest.approx(15.0, abs=0.2) and result["path_length"] < 0.2


def test_maps_have_more_nodes_in_turns() -> None:
    corner = Pair((0, 0, 0), (4, 4), ((0, 0), (4, 0), (4, 4)), 8.0)
    poses = np.array(poses_along(corner))
    assert np.allclose(poses[0], (0, 0, 0)) and np.allclose(poses[-1], (4, 4, math.pi / 2), atol=1e-6)
    steps, turns = np.hypot(*np.diff(poses[:, :2], axis=0).T), np.diff(poses[:, 2])
    assert steps.max() < SPACING + 1e-6 and turns.max() < TURN + 0.02
    assert np.median(steps) == pytest.approx(SPACING, rel=0.1) and steps.min() < 0.25 * SPACING
    straight = Pair((0, 0, 0), (4, 0), ((0, 0), (4, 0)), 4.0)
    assert np.allclose(np.diff(np.array(poses_along(straight)), axis=0), (SPACING, 0, 0), atol=1e-6)


def test_a_start_at_the_goal_succeeds_at_once(course: Course, tmp_path: Path) -> None:
    pair = course.pair(5)
    here = Pair(pair.start, pair.start[:2], (pair.start[:2], pair.start[:2]), 0.0)
    result = run_episode(EpisodeSpec("straight", "house", "none", 0, log=False), here, tmp_path / "e", tmp_path / "maps")
    assert result["outcome"] == "success" and result["time"] < 0.1 and result["log"] is None


def test_a_planner_that_cannot_start_is_an_error(course: Course, tmp_path: Path) -> None:
    spec = EpisodeSpec("gnm", "house", "none", 0, log=False)
    result = run_episode(spec, course.pair(spec.pair_seed), tmp_path / "e", tmp_path / "maps")
    assert result["outcome"] == "error" and "needs weights" in result["message"] and not result["success"]


class _Breaks(_Tired):
    """Raises an exception when an episode begins."""

    def __init__(self, error: str = "", file: str = "") -> None:
        full, gone = OSError(errno.ENOSPC, "disk is full"), ConnectionResetError("no answer")
        self._error = {"full": full, "gone": gone, "log": gloam.PartialError("cannot write the log", file)}[error]

    def reset(self, task: Task) -> None:
        raise self._error


register_planner("breaks", _Breaks)


def test_a_full_disk_is_no_failure_of_the_planner(course: Course, tmp_path: Path) -> None:
    spec = EpisodeSpec("breaks", "house", "none", 0, log=False, options=(("error", "full"),))
    with pytest.raises(OSError, match="disk is full"):
        run_episode(spec, course.pair(spec.pair_seed), tmp_path / "e", tmp_path / "maps")
    gone = replace(spec, options=(("error", "gone"),))
    result = run_episode(gone, course.pair(spec.pair_seed), tmp_path / "f", tmp_path / "maps")
    assert result["outcome"] == "error" and "no answer" in result["message"]
    log = replace(spec, options=(("error", "log"), ("file", str(tmp_path / "g/run.mcap"))))
    with pytest.raises(gloam.PartialError, match="cannot write the log"):
        run_episode(log, course.pair(spec.pair_seed), tmp_path / "g", tmp_path / "maps")


class _Robot:
    def __init__(self, sim: _Sim) -> None:
        self.pose = gloam.Pose(np.array([*sim.at, 0.3]), np.array([1.0, 0, 0, 0]))


class _Sim:
    """A simulation's side of Watch: a place and contacts over time."""

    def __init__(self) -> None:
        self.time, self.at, self.hits = 0.0, (0.0, 0.0), []

    @property
    def robots(self) -> dict[str, _Robot]:
        return {ROBOT: _Robot(self)}

    def contacts(self) -> list[gloam.Contact]:
        place, force, torque = np.array([0, 0, 0.2]), np.array([1.0, 0, 0]), np.zeros(3)
        return [
            gloam.Contact((f"{ROBOT}/trunk", name), place, np.array(normal, float), 0.0, force, torque) for name, normal in self.hits
        ]


def test_collisions_count_once_per_touch() -> None:
    sim, touched = _Sim(), Touched()
    for k in range(60):
        sim.time = 0.05 * k
        sim.hits = [("living/chair_2/collider_1", (1, 0, 0)), ("floor/plane", (0, 0, 1))] if k < 20 or k > 40 else []
        touched.sample(sim)  # type: ignore[arg-type]
    assert touched.by_object == {"chair": 2} and touched.total() == 2


def test_outcomes() -> None:
    def watched(steps: int, speed: float, hits: bool) -> Watch:
        sim, watch = _Sim(), Watch((3.0, 0.0))
        sim.hits = [("wall_1/c", (1, 0, 0))] if hits else []
        for k in range(steps):
            sim.time, sim.at = 0.05 * k, (speed * 0.05 * k, 0.0)
            if watch(sim):  # type: ignore[arg-type]
                break
        return watch

    assert watched(200, 0.5, False).outcome == "success"
    assert watched(400, 0.0, False).outcome == "stuck"
    assert watched(400, 0.0, True).outcome == "collided"
    assert watched(40, 0.5, False).outcome == ""


def test_requests_are_checked(tmp_path: Path) -> None:
    for bad, message in (
        (Request(("no",)), "no planner"), (Request(("route",), ("moon",)), "no scene"),
        (Request(("route",), levels=("much",)), "no level"), (Request(()), "name each"),
        (Request(("route", "route")), "name each"), (Request(("route",), episodes=0), "1 to 100000"),
    ):  # fmt: skip
        with pytest.raises(gloam.Error, match=message):
            run(bad, tmp_path / "x")


def test_a_request_survives_its_file_and_is_continued(tmp_path: Path) -> None:
    request = Request(("route", "own"), ("house",), ("none", "minor"), 3, 5, "path", False, (Option("own", "type", "route"),), (File("p.py", "12"),))
    same_as_default = [f.name for f in fields(Request) if getattr(request, f.name) == getattr(Request(()), f.name)]
    assert same_as_default == ["machine", "version", "started"], "each option is compared below"
    request.keep(tmp_path)
    kept = Request.read(tmp_path / REQUEST_FILE)
    assert replace(kept, machine="", version="", started="") == request
    assert kept.machine and kept.started and kept.version == gloam.__version__
    (tmp_path / REQUEST_FILE).write_text(json.dumps(asdict(replace(kept, started="2020-01-01", machine="another"))))
    for episodes, most in ((9, 9), (2, 9)):
        replace(request, episodes=episodes).keep(tmp_path)
        assert Request.read(tmp_path / REQUEST_FILE) == replace(kept, started="2020-01-01", episodes=most)
    for name, value in (("planners", ("route",)), ("seed", 6), ("tier", "direct"), ("log", True), ("plugins", ())):
        with pytest.raises(gloam.UsageError, match=rf"another benchmark \({name} differ\)"):
            replace(request, **{name: value}).keep(tmp_path)
    (tmp_path / REQUEST_FILE).write_text("{")
    with pytest.raises(gloam.InputError, match="request.json"):
        request.keep(tmp_path)


@pytest.mark.slow
def test_runs_continue_and_adversity_is_paired(tmp_path: Path) -> None:
    request = Request(("straight", "route"), ("house",), ("none", "major"), 1)
    first = run(request, tmp_path, Workers(1))
    assert len(first) == 4 and {r["outcome"] for r in first if r["planner"] == "route"} == {"success"}
    assert len({tuple(r["start"]) for r in first}) == 1
    kept = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("episode.json")}
    gone = tmp_path / "episodes" / "straight" / "house" / "none" / "0000"
    before = json.loads((gone / "episode.json").read_text())["hash"]
    shutil.rmtree(gone)
    second = run(request, tmp_path, Workers(1))
    assert [r["hash"] for r in second] == [r["hash"] for r in first]
    assert json.loads((gone / "episode.json").read_text())["hash"] == before
    same = [p for p, time in kept.items() if p.stat().st_mtime_ns == time]
    assert len(same) == 3, "finished episodes are not run again"
    with pytest.raises(gloam.UsageError, match="another benchmark"):
        run(Request(("straight",), ("house",), ("none", "major"), 1), tmp_path)
