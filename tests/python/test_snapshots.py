"""World.snapshot(): instants of given configurations, against closed forms and simulations."""
from __future__ import annotations

import math
from pathlib import Path

import gloam
import numpy as np
import pytest
from gloam.simulation import _alive
from scenes import ball_file, ball_scene

FAST = {"tier": "direct", "spp": 1, "denoise": False}
HAND = """<mujoco><worldbody><light pos="0 0 3"/>
<body name="hand" mocap="true" pos="0 0 1"><geom size=".2"/></body>
<body name="ball" pos="0 0 3"><freejoint/><geom size=".1"/></body>
<camera name="front" pos="0 -3 1" xyaxes="1 0 0 0 0 1"/></worldbody></mujoco>"""


def test_poses_and_contacts_of_a_configuration(tmp_path: Path) -> None:
    world = gloam.Scene(ball_file(tmp_path)).compile()
    qpos = np.array([0.5, 0, 0.09, 2, 0, 0, 0, 0.3])  # 1 cm in the floor, a quaternion that is not of unit length
    at = world.snapshot(qpos, time=1.5)
    assert (at.time, at.step) == (1.5, 750) and at.world is world and "1.5" in repr(at)
    assert at.value("qpos").tolist() == [0.5, 0, 0.09, 1, 0, 0, 0, 0.3] and not at.value("qvel").any()
    assert at.pose("ball").p.tolist() == [0.5, 0, 0.09]
    assert at.pose("arm").q == pytest.approx([math.cos(0.15), 0, math.sin(0.15), 0])
    [contact] = at.contacts()
    assert contact.geoms == ("floor", "skin") and contact.distance == pytest.approx(-0.01)
    assert at.hash == world.snapshot(list(qpos), 1.5).hash != world.snapshot(qpos).hash
    with pytest.raises(gloam.NotFoundError, match="ball"):
        at.pose("bal")


def test_its_image_is_that_of_a_simulation_in_this_state(tmp_path: Path) -> None:
    world = ball_scene(tmp_path).compile()
    with gloam.Simulation(world) as sim:
        qpos = sim.memory.array("qpos").copy()
        assert world.snapshot(qpos).hash == sim.hash
        frames = [sim.cameras["small"].render(**FAST), world.snapshot(qpos).render("small", **FAST)]
    for channel in ("rgb", "depth", "ids"):
        assert np.array_equal(*(getattr(frame, channel) for frame in frames)), channel


def test_rendering_a_configuration_makes_no_other_simulation(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        before = len(_alive)
        sim.step(5)
        hash_before, qpos = sim.hash, sim.memory.array("qpos").copy()
        qpos[:3] = 0.3, 0, 1.2
        there = sim.cameras["small"].render(("depth",), qpos=qpos, **FAST)
        assert len(_alive) == before and sim.hash == hash_before and sim.step_count == 5
        assert np.array_equal(there.depth, sim.world.snapshot(qpos, sim.time).render("small", ("depth",), **FAST).depth)


def test_mocap_bodies_are_where_they_are_now(tmp_path: Path) -> None:
    (tmp_path / "hand.xml").write_text(HAND)
    size = {"width": 33, "height": 33, **FAST}
    with gloam.load(tmp_path / "hand.xml") as sim:
        qpos = sim.memory.array("qpos").copy()
        near = gloam.Pose(np.array([0.0, -1.0, 1.0]), np.array([1.0, 0, 0, 0]))
        sim.bodies["hand"].set_mocap(near)
        sim.step()
        assert sim.cameras["front"].render(("depth",), qpos=qpos, **size).depth[16, 16] == pytest.approx(1.8, abs=1e-3)
        assert sim.world.snapshot(qpos).render("front", ("depth",), **size).depth[16, 16] == pytest.approx(2.8, abs=1e-3)
        at = sim.world.snapshot(qpos, mocap=[near])
        assert at.pose("hand").p[1] == -1 and at.render("front", ("depth",), **size).depth[16, 16] == pytest.approx(1.8, abs=1e-3)
        with pytest.raises(gloam.UsageError, match="mocap"):
            sim.world.snapshot(qpos, mocap=[near, near])


def test_wrong_configurations_raise(tmp_path: Path) -> None:
    world = gloam.Scene(ball_file(tmp_path)).compile()
    qpos = np.zeros(8)
    for wrong in ([1.0, 2.0], np.zeros(9), [*qpos[:7], float("nan")], [*qpos[:7], float("inf")]):
        with pytest.raises(ValueError, match="qpos"):
            world.snapshot(wrong)
    for time in (-1.0, float("nan"), 1e12):
        with pytest.raises(gloam.UsageError, match="time"):
            world.snapshot(qpos, time)
    for wrong in ("up", None):
        with pytest.raises(TypeError):
            world.snapshot(wrong)  # type: ignore[arg-type]


def test_effects_have_not_begun() -> None:
    scene = gloam.Scene.from_dict({
        "environment": {"file": str(Path(gloam.home()) / "assets/environments/arena/arena.xml")},
        "gas": [{"name": "air", "position": [0, 0, 1], "size": [2, 2, 2], "voxel": 0.2}],
        "smoke": [{"name": "pot", "position": [0, 0, 0.3], "size": [0.4, 0.4, 0.2], "rate": 0.01}],
        "water": [{"name": "pool", "position": [3, 0, 0.1], "size": [1, 1], "depth": 0.5, "wave_height": 0.03, "wave_period": 0.9}],
        "camera": [{"name": "eye", "position": [-3, 0, 1.5], "look_at": [0, 0, 0.5], "width": 16, "height": 12}],
    }, root="/")
    world = scene.compile()
    frame = world.snapshot(np.zeros(world.info.nq), 2.0).render("eye", ("rgb", "depth"), **FAST)
    assert np.isfinite(frame.depth).any()
