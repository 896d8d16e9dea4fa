"""Simulations from Python: stepping, live arrays, commands, instants to go back to."""
from __future__ import annotations

import faulthandler
import gc
import threading
import time
import weakref
from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file, ball_scene


@pytest.fixture
def sim(tmp_path: Path) -> gloam.Simulation:
    return gloam.load(ball_file(tmp_path))


def test_a_ball_falls_as_newton_says(sim: gloam.Simulation) -> None:
    z = sim.joints["free"].qpos
    sim.step(100)
    t = sim.time
    assert t == pytest.approx(0.2)
    assert z[2] == pytest.approx(1 - 9.81 / 2 * t * (t + sim.timestep), abs=1e-9)  # semi-implicit Euler
    assert sim.bodies["ball"].pose.p[2] == pytest.approx(z[2], abs=1e-12)
    assert sim.bodies["ball"].velocity[2] == pytest.approx(-9.81 * t, abs=1e-9)


def test_arrays_are_the_memory_that_is_stepped(sim: gloam.Simulation) -> None:
    qpos = sim.memory.array("qpos")
    address = qpos.__array_interface__["data"][0]
    assert sim.joints["free"].qpos.__array_interface__["data"][0] == address
    before = qpos.copy()
    sim.step()
    assert not np.array_equal(qpos, before)
    assert sim.memory.array("qpos").__array_interface__["data"][0] == address


def test_what_is_written_is_input_of_the_next_step(sim: gloam.Simulation) -> None:
    joint = sim.joints["free"]
    joint.qpos[:3] = (0.5, 0, 2)
    joint.qvel[:] = 0
    sim.step()
    assert joint.qpos[0] == pytest.approx(0.5)
    assert joint.qpos[2] == pytest.approx(2, abs=1e-4)


def test_what_is_written_is_in_the_log(sim: gloam.Simulation, tmp_path: Path) -> None:
    with sim.record(tmp_path / "run.mcap", ["/clock"]):
        for i in range(20):
            sim.joints["elbow"].qvel[0] = 0.1 * i
            sim.step(5)
    found = gloam.replay(tmp_path / "run.mcap").verify()
    assert found.differing_steps == 0 and found.steps == 100, found


def test_options_that_are_set_at_first_are_in_the_log(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(("depth",), tier="direct", spp=1)
        sim.set("sim.duration", 3)
        with sim.record(tmp_path / "run.mcap", ["/clock"]):
            assert camera.next().index == 0
            sim.step(50)
        found = gloam.replay(tmp_path / "run.mcap").verify()
        assert (found.differing_steps, found.runs) == (0, 1) and found.steps >= 50, found
        sim.reset()
        sim.bodies["go/ball"].push(force=(5, 0, 0))
        sim.set("sim.duration", 4)
        sim.step(20)
        assert sim.bodies["go/ball"].velocity[0] > 0.1, "a Command that waits is kept"


def test_what_is_not_finite_is_refused_and_nothing_changes(sim: gloam.Simulation) -> None:
    sim.step(5)
    qpos = sim.memory.array("qpos")
    before, hash_before = qpos.copy(), sim.hash
    qpos[2] = np.nan
    with pytest.raises(gloam.InputError, match="finite"):
        sim.step()
    assert np.array_equal(qpos, before) and sim.hash == hash_before
    sim.step()
    for value in (np.nan, np.inf):
        with pytest.raises(gloam.Error, match="finite"):
            sim.actuators["motor"].control = value


def test_memory_of_the_model_is_read_only(sim: gloam.Simulation) -> None:
    with pytest.raises(ValueError, match="read-only"):
        sim.memory.array("geom_size")[0] = 1
    with pytest.raises(gloam.NotFoundError):
        sim.memory.array("qposs")


def test_arrays_outlive_a_recompile_and_the_end(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    joint = sim.joints["go/elbow"]
    old = joint.qpos
    sim.step(10)
    seen = old.copy()
    sim.set("render.spp", 2)
    sim.step(10)
    assert np.array_equal(old, seen), "no longer stepped, still readable"
    assert joint.qpos is not old and not np.array_equal(joint.qpos, seen), "the joint of that name goes on"
    new = joint.qpos
    sim.close()
    del sim
    gc.collect()
    assert np.isfinite(new).all() and np.isfinite(old).all()


def test_a_thing_that_a_recompile_took_away_raises(tmp_path: Path) -> None:
    sim = gloam.load(ball_scene(tmp_path))
    elbow = sim.joints["go/elbow"]
    scene = gloam.Scene.from_dict({"robot": [{"name": "dog", "file": str(QUADRUPED)}]}, tmp_path, root="/")
    sim.recompile(scene)
    with pytest.raises(gloam.InputError):
        _ = elbow.qpos
    assert list(sim.robots) == ["dog"]


def test_the_seed_and_the_number_of_calls_change_nothing(tmp_path: Path) -> None:
    hashes = set()
    for chunk in (1, 7, 200):
        with gloam.load(QUADRUPED, seed=3) as sim:
            while sim.step_count < 200:
                sim.step(min(chunk, 200 - sim.step_count))
            hashes.add(sim.hash)
    assert len(hashes) == 1
    with gloam.load(QUADRUPED, seed=4) as sim:
        sim.step(200)
        assert sim.hash not in hashes, "the chain begins from the seed"


def test_checkpoints_go_back_to_the_bit(sim: gloam.Simulation) -> None:
    sim.step(20)
    there = sim.checkpoint()
    sim.step(30)
    end = sim.hash
    sim.restore(there)
    assert sim.hash == there.hash and sim.time == pytest.approx(there.time)
    sim.step(30)
    assert sim.hash == end
    sim.reset()
    assert sim.step_count == 0 and sim.joints["free"].qpos[2] == 1


def test_a_robot_is_driven_and_claimed() -> None:
    scene = gloam.Scene.from_dict({"robot": [{"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "controller": {"type": "trot"}}]})
    with gloam.load(scene) as sim:
        dog = sim.robots["dog"]
        assert len(dog.joint_names) == 12 and dog.controls.shape == (12,)
        dog.command(vx=0.5)
        sim.run_until(2.0)
        assert dog.pose.p[0] == pytest.approx(1.0, abs=0.3)
        with dog.claim():
            dog.command(vx=0.1)
            with pytest.raises(gloam.Error, match="claim"), dog.claim():
                pass
        dog.place((1, 2, 0.35), yaw=np.pi / 2)
        sim.step()
        assert dog.pose.p[:2] == pytest.approx((1, 2), abs=1e-3) and dog.pose.yaw == pytest.approx(np.pi / 2, abs=1e-2)
        with pytest.raises(gloam.UsageError, match="12"):
            dog.controls = [0.0, 1.0]


def test_a_hook_comes_before_each_step_and_its_exception_is_raised(sim: gloam.Simulation) -> None:
    times: list[float] = []
    sim.on_step(lambda memory: times.append(memory.time))
    sim.step(3)
    assert times == pytest.approx([0, 0.002, 0.004])

    def fail(_: object) -> None:
        raise ZeroDivisionError("in the hook")

    sim.on_step(fail)
    with pytest.raises(ZeroDivisionError, match="in the hook"):
        sim.step(10)
    sim.on_step(None)
    sim.step()


def test_physics_that_fails_tells_and_a_reset_goes_on(sim: gloam.Simulation) -> None:
    sim.joints["free"].qvel[:] = 1e300
    with pytest.raises(gloam.DivergedError):
        sim.step(50)
    sim.reset()
    sim.step(10)
    assert sim.joints["free"].qpos[2] < 1


def test_metrics_topics_and_inputs(tmp_path: Path) -> None:
    scene = gloam.Scene.from_dict({"robot": [{"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "controller": {"type": "trot"}}]})
    with gloam.load(scene) as sim:
        with sim.open_metrics() as metrics, sim.subscribe(["/tf", "/clock"]) as heard:
            sim.publish("/dog/cmd_vel", {"linear": {"x": 0.4}})
            sim.run_until(1.0)
            messages = list(heard)
            values = metrics.latest()
        assert {m.topic for m in messages} == {"/tf", "/clock"}
        last = [m for m in messages if m.topic == "/clock"][-1].decode()
        assert last["clock"]["sec"] + 1e-9 * last["clock"]["nanosec"] == pytest.approx(1.0)
        assert values["dog.x_m"] == pytest.approx(sim.robots["dog"].pose.p[0], abs=0.01) and values["dog.x_m"] > 0.2
        with pytest.raises(gloam.UsageError, match="lineer"):
            sim.publish("/dog/cmd_vel", {"lineer": {"x": 0.4}})
        with pytest.raises(gloam.UsageError, match="cmd_vell"):
            sim.publish("/dog/cmd_vell", {})


def assert_freed(gone: weakref.ref[gloam.Simulation]) -> None:
    """Waits: the callback of the last sample may still run."""
    end = time.monotonic() + 10
    while gone() is not None and time.monotonic() < end:
        gc.collect()
        time.sleep(0.01)
    if gone() is not None:
        faulthandler.dump_traceback(all_threads=True)
    assert gone() is None, [type(holder) for holder in gc.get_referrers(gone())]


def test_a_simulation_that_nobody_holds_is_freed(sim: gloam.Simulation) -> None:
    made = gloam.load(QUADRUPED)
    sensor = made.sensors[made.world.sensors[0]]
    sensor.open(callback=lambda sample: made.time)  # a cycle through what C++ keeps
    made.on_step(lambda memory: made)
    made.step(2)
    gone = weakref.ref(made)
    del made, sensor
    assert_freed(gone)


def test_an_exception_of_a_callback_does_not_keep_a_simulation() -> None:
    made = gloam.load(QUADRUPED)
    entered, stepped = threading.Event(), threading.Event()

    def callback(sample: object, made: gloam.Simulation = made) -> None:
        entered.set()
        stepped.wait(10)  # no later call raises the exception
        made.joints["no such joint"]  # the traceback refers to `made`

    made.sensors[made.world.sensors[0]].open(required=False, callback=callback)
    made.step(2)
    assert entered.wait(10)
    gone = weakref.ref(made)
    del made, callback
    stepped.set()
    assert_freed(gone)
