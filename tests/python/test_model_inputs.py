"""Changes of the model while it runs: inputs that logs keep, replays repeat and resets take back; without a recompile."""
from __future__ import annotations

from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file

mujoco = pytest.importorskip("mujoco")

FIELDS = {"gravity": "opt.gravity", "wind": "opt.wind", "body_mass": "body_mass", "geom_friction": "geom_friction",
          "actuator_gain": "actuator_gainprm", "actuator_bias": "actuator_biasprm", "dof_armature": "dof_armature", "dof_damping": "dof_damping",
          "dof_frictionloss": "dof_frictionloss", "joint_stiffness": "jnt_stiffness"}


def verified(log: Path) -> bool:
    found = gloam.replay(log).verify()
    assert found.states > 0
    return found.is_equal


@pytest.mark.parametrize("field", FIELDS)
def test_live_fields_reach_mujoco_in_double_precision(field: str) -> None:
    with gloam.load(QUADRUPED) as sim:
        before = sim.value(FIELDS[field])
        wanted = before + np.linspace(0.1, 0.3, len(before)) * (field != "body_mass" or before > 0)
        sim.set_live_field(field, wanted)
        sim.step()
        assert np.array_equal(sim.value(FIELDS[field]), wanted)
        sim.reset()
        assert np.array_equal(sim.value(FIELDS[field]), before)
    with gloam.load(QUADRUPED) as sim:
        sim.set_live_field("gravity", [0, 0, -3.7])
        sim.step()
        assert sim.value("opt.gravity")[2] == -3.7


def test_what_is_written_into_the_model_is_logged_and_taken_back(tmp_path: Path) -> None:
    with gloam.load(QUADRUPED) as sim:
        model = sim.model
        before = {name: getattr(model, name).copy() for name in ("body_mass", "body_inertia", "geom_friction", "dof_damping", "actuator_gainprm")}
        gravity = model.opt.gravity.copy()
        with sim.record(tmp_path / "run.mcap", topics=["/tf"]):
            sim.step(50)
            model.body_mass[1] *= 1.5
            model.opt.gravity[2] = -3.7
            model.geom_friction[:, 0] = 0.31
            model.dof_damping[-1] += 0.123456789
            model.actuator_gainprm[0, 0] *= 0.9
            sim.step()
            assert sim.memory.array("body_mass")[1] == before["body_mass"][1] * 1.5 and model.opt.gravity[2] == -3.7
            assert np.allclose(model.body_inertia[1], 1.5 * before["body_inertia"][1])
            sim.step(99)
        assert verified(tmp_path / "run.mcap")
        sim.reset()
        for name, values in before.items():
            assert np.array_equal(getattr(model, name), values), name
        assert np.array_equal(model.opt.gravity, gravity)
    with gloam.load(QUADRUPED) as sim:
        sim.step(50)
        sim.set_live_field("body_mass", [before["body_mass"][1] * 1.5], 1)
        changed = sim.model
        changed.opt.gravity[2] = -3.7
        sim.step(100)
        assert sim.value("opt.gravity")[2] == -3.7


def test_gravity_that_is_written_moves_the_ball(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        sim.model.opt.gravity[2] = 0
        sim.step(100)
        assert sim.joints["free"].qpos[2] == 1.0
        sim.reset()
        sim.step(100)
        assert sim.joints["free"].qpos[2] < 0.99


def test_what_cannot_change_says_so(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        model = sim.model
        with pytest.raises(ValueError, match="read-only"):
            model.geom_size[:] = 2
        with pytest.raises(ValueError, match="read-only"):
            model.geom_size = np.ones_like(model.geom_size)
        sim.step()
        for write in (lambda: setattr(sim.model.opt, "timestep", 0.01), lambda: sim.model.geom("skin").size.__setitem__(0, 2.0)):
            before = sim.joints["free"].qpos.copy()
            write()
            with pytest.raises(gloam.UsageError, match="opt.timestep|geom_size"):
                sim.step()
            assert np.array_equal(sim.joints["free"].qpos, before) and model.geom("skin").size[0] == 0.1 and model.opt.timestep == 0.002
            sim.step()
        sim.model.body_mass[1] = -1
        with pytest.raises(gloam.UsageError, match="mass"):
            sim.step()
        assert model.body_mass[1] == 1
        sim.step()


def test_what_a_hook_writes_into_the_model_applies_a_step_later(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        model = sim.model

        def float_away(memory: object) -> None:
            if sim.step_count == 10:
                model.opt.gravity[2] = 1.0

        sim.on_step(float_away)
        sim.step(20)
        assert sim.value("opt.gravity")[2] == 1.0


def test_dynamics_per_episode_without_a_recompile(tmp_path: Path) -> None:
    scene = gloam.Scene.from_dict({"robot": [{"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "controller": {"type": "trot"}},
                                             {"name": "other", "file": str(QUADRUPED), "keyframe": "home", "position": [2.0, 0.0, 0.0]}]})
    with gloam.load(scene) as sim:
        world = sim.world
        names = ("body_mass", "geom_friction", "actuator_gainprm", "actuator_biasprm", "dof_armature", "dof_damping")
        before = {name: sim.memory.array(name).copy() for name in names}
        with sim.record(tmp_path / "run.mcap", topics=["/tf"]):
            for factor in (0.7, 1.3):
                sim.robots["dog"].scale_dynamics(mass=factor, friction=factor, gains=factor, armature=factor, damping=factor)
                sim.robots["other"].scale_dynamics(mass=2.0)
                sim.step(60)
                for name in names:
                    now = sim.memory.array(name)
                    assert not np.array_equal(now, before[name]) or not before[name].any(), name
                body = sim.world.bodies.index("dog/trunk")
                assert sim.memory.array("body_mass")[body] == before["body_mass"][body] * factor
                assert sim.memory.array("body_mass")[sim.world.bodies.index("other/trunk")] == before["body_mass"][body] * 2.0
                sim.reset()
                for name in names:
                    assert np.array_equal(sim.memory.array(name), before[name]), name
        assert sim.world is world
        sim.scale_dynamics(friction=0.5)
        sim.step()
        assert np.array_equal(sim.memory.array("geom_friction"), before["geom_friction"] * 0.5)
        for wrong in ({"mass": 0.0}, {"mass": [1.0, 2.0]}, {"friction": float("nan")}):
            with pytest.raises(gloam.UsageError):
                sim.scale_dynamics(**wrong)
    assert verified(tmp_path / "run.mcap")


def test_environments_draw_dynamics_for_each_episode(tmp_path: Path) -> None:
    pytest.importorskip("gymnasium")
    scene = {"robot": [{"name": "go", "file": ball_file(tmp_path).name}]}
    env = gloam.make_env(gloam.Scene.from_dict(scene, tmp_path), {"where": {"sensor": "go/where"}}, {"controls": "go", "low": [-1], "high": [1]},
                         dynamics={"mass": (0.5, 2.0), "friction": (0.5, 1.5)})
    masses = []
    for seed in (1, None, 1):
        env.reset(seed=seed)
        env.step(np.zeros(1))
        masses.append(env.sim.memory.array("body_mass").copy())
    assert np.array_equal(masses[0], masses[2]) and not np.array_equal(masses[0], masses[1])
    assert 0.5 <= masses[0][1] <= 2.0 and masses[0][1] != 1.0
    with pytest.raises(ValueError, match="dynamics"):
        gloam.make_env(gloam.Scene.from_dict(scene, tmp_path), {"where": {"sensor": "go/where"}}, {"controls": "go", "low": [-1], "high": [1]},
                       dynamics={"mas": (0.5, 2.0)})


def test_arrays_of_robots_take_effect_or_refuse(tmp_path: Path) -> None:
    dog = {"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "position": [0.0, 0.0, 0.1]}
    with gloam.load({"robot": [dog]}) as sim:
        robot = sim.robots["dog"]
        with sim.record(tmp_path / "run.mcap", topics=["/tf"]):
            robot.controls[:] = 0.02
            sim.step(20)
            assert np.all(robot.controls == 0.02)
            robot.qpos[0] = 0.1
            robot.qvel[:] = 0
            sim.step()
            assert robot.qpos[0] == pytest.approx(0.1, abs=0.02)
        for values in (robot.pose.p, robot.velocity, robot.angular_velocity, robot.root.pose.q, sim.sensors[next(iter(sim.sensors))].values):
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 3
        with pytest.raises(TypeError, match="assign the whole"):
            sim.scene["robot.dog.position"][0] = 3
    assert verified(tmp_path / "run.mcap")


def test_controls_that_lie_apart_are_read_only(tmp_path: Path) -> None:
    two = """<mujoco><worldbody>
      <body name="a" pos="0 0 1"><joint name="a" axis="0 1 0"/><geom size=".1" pos=".2 0 0"/></body>
      <body name="b" pos="1 0 1"><joint name="b" axis="0 1 0"/><geom size=".1" pos=".2 0 0"/></body></worldbody>
      <actuator><motor joint="a"/><motor joint="b"/></actuator></mujoco>"""
    (tmp_path / "two.xml").write_text(two)
    with gloam.load(tmp_path / "two.xml") as sim:
        for robot in sim.robots.values():
            controls = robot.controls
            if controls.flags.writeable:
                controls[:] = 0.5
                sim.step()
                assert np.all(robot.controls == 0.5)
            else:
                with pytest.raises(ValueError, match="read-only"):
                    controls[:] = 0.5
