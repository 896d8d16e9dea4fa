"""Hints at names that nearly fit, what objects show of themselves, and copies: pickled, deep, by spec."""
from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file, ball_scene


def test_names_that_nearly_fit_are_told(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    with gloam.load(scene) as sim:
        robot = sim.robots["go"]
        for ask, near in ((lambda: sim.joints["go/elbo"], "go/elbow"), (lambda: robot.joints["fre"], "free"), (lambda: robot.actuators["moter"], "motor"),
                          (lambda: sim.memory.array("qposs"), "qpos"), (lambda: sim.value("qposs"), "qpos"), (lambda: sim.cameras["smal"], "small"),
                          (lambda: robot.set_joint_goals({"fre": 0.1}), "free"), (lambda: sim.set_live_field("gravit", [0, 0, 0]), "gravity"),
                          (lambda: gloam.describe("weather.visibilty"), "visibility"), (lambda: gloam.describe("wether.visibility"), "weather"),
                          (lambda: gloam.describe("robot.go.positon"), "position"), (lambda: sim.set("weather.visibilty", 3), "visibility"),
                          (lambda: scene["camera.smal.width"], "small"), (lambda: sim.publish("/clok", {}), ""),
                          (lambda: gloam.evaluate("a.tum", "b.tum", rpe_unit="mm"), "a.tum")):
            with pytest.raises(gloam.Error) as raised:
                ask()
            assert near in str(raised.value), str(raised.value)
    assert gloam.describe("weather.visibility") and gloam.describe("robot.anything.position") and gloam.describe("camera")


def test_a_message_shows_what_it_is(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim, sim.subscribe(["/clock"]) as heard:
        sim.step(20)
        shown = repr(next(iter(heard)))
        assert "/clock" in shown and "rosgraph_msgs" in shown


def test_scenes_pickle_and_copy(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    scene["camera.small.width"] = 40
    model = gloam.Scene(ball_file(tmp_path))
    for original in (scene, model):
        for same in (pickle.loads(pickle.dumps(original)), copy.deepcopy(original), copy.copy(original)):
            assert same.to_toml() == original.to_toml() and same.name == original.name
            assert same.compile(progress=False).bodies == original.compile(progress=False).bodies
    changed = copy.deepcopy(scene)
    changed["camera.small.width"] = 50
    assert scene["camera.small.width"] == 40
    file = tmp_path / "scene.toml"
    file.write_text('[[robot]]\nname = "go"\nfile = "ball.xml"\n')
    again = pickle.loads(pickle.dumps(gloam.Scene(file)))
    assert again.file.samefile(file) and again.compile(progress=False).robots == ["go"]


def test_options_are_copies_that_say_so(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    position = scene["camera.small.position"]
    assert position == [0.0, -3.0, 1.0] and list(position) == position and pickle.loads(pickle.dumps(position)) == position
    for change in (lambda: position.__setitem__(2, 5.0), lambda: position.append(1), lambda: position.sort()):
        with pytest.raises(TypeError, match="assign the whole"):
            change()
    scene["camera.small.position"] = [*position[:2], 5.0]
    assert scene["camera.small.position"] == [0.0, -3.0, 5.0]


def test_what_runs_says_what_to_send_instead(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        for thing, hint in ((sim, "scene"), (sim.world, "scene")):
            for way in (pickle.dumps, copy.deepcopy):
                with pytest.raises(TypeError, match=hint):
                    way(thing)


def test_environments_copy_by_their_spec() -> None:
    gym = pytest.importorskip("gymnasium")
    cloudpickle = pytest.importorskip("cloudpickle")
    env = gym.make("gloam/Reach-v0")
    first, _ = env.reset(seed=1)
    env.step(env.action_space.sample())
    ways: tuple[Any, ...] = (copy.deepcopy, lambda e: pickle.loads(pickle.dumps(e)), lambda e: cloudpickle.loads(cloudpickle.dumps(e)))
    for way in ways:
        again = way(env)
        assert again.unwrapped is not env.unwrapped
        seen, _ = again.reset(seed=1)
        assert np.array_equal(np.concatenate([np.ravel(v) for v in _values(seen)]), np.concatenate([np.ravel(v) for v in _values(first)]))
        again.close()
    env.close()
    bare = gloam.make_env({"robot": [{"name": "go", "file": str(QUADRUPED)}]}, {"joints": {"joints": "go"}})
    with pytest.raises(TypeError, match="gym.make"):
        pickle.dumps(bare)
    bare.close()


def _values(observation: Any) -> list[Any]:
    return list(observation.values()) if isinstance(observation, dict) else [observation]
