"""Streams as objects: several of one camera, their ends, waiting, and the scene's settings of images."""
from __future__ import annotations

import gc
import threading
import time
import weakref
from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file, ball_scene

FAST = {"tier": "direct", "spp": 1, "denoise": False}


def test_one_camera_has_several_streams(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"]
        large = camera.open(("depth",), width=64, height=48, **FAST)
        with camera.open(("rgb",), rate=25, **FAST) as small:
            for i in range(3):
                assert small.next().stamp == pytest.approx(i / 25)
        assert not small.is_open and large.is_open
        frames = list(large)
        assert [frame.index for frame in frames] == list(range(len(frames))) and len(frames) >= 5
        assert all(frame.depth.shape == (48, 64) and frame.rgb is None for frame in frames)
        small.close()
        with pytest.raises(gloam.ClosedError):
            small.next()
        assert large.next().index == len(frames)
        assert "CameraStream 'small'" in repr(large) and "closed" in repr(small)


def test_a_stream_ends_when_nothing_refers_to_it_unless_it_has_a_callback(tmp_path: Path) -> None:
    seen: list[int] = []
    with gloam.load(ball_file(tmp_path)) as sim:
        stream = sim.sensors["where"].open()
        sim.sensors["where"].open(callback=lambda sample: seen.append(sample.step))
        gone = weakref.ref(stream)
        del stream
        assert gone() is None
        gc.collect()
        sim.step(30)
        again = sim.sensors["where"].open(callback=lambda sample: None)
        again.close()
        sim.step(30)
    assert len(seen) > 50


def test_the_latest_message_is_of_the_present_run(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        where = sim.sensors["where"].open()
        sim.step(10)
        first = where.latest()
        assert first is not None and first.step == 9 and where.latest() is first
        assert list(where) == [], "latest() has read the older ones"
        sim.reset()
        after = where.latest()
        assert after is None or after.step == 0
        sim.step(3)
        last = where.latest()
        assert last is not None and last.step == 2


def test_messages_are_waited_for_while_it_runs(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path), pace="realtime") as sim:
        where = sim.sensors["where"].open(required=False)
        clock = sim.subscribe(["/clock"])
        sim.run()
        steps = [where.next(timeout=10).step for _ in range(20)]
        assert steps == sorted(set(steps))
        assert clock.next(timeout=10).topic == "/clock"
        sim.pause()
        list(where)
        with pytest.raises(gloam.UsageError, match="iterate"):
            clock.next()
        sim.run()
        closer = threading.Timer(0.3, sim.close)
        closer.start()
        with pytest.raises(gloam.ClosedError):
            while True:
                where.next()
        closer.join(20)


def test_waiting_ends_at_its_timeout(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    scene["camera.small.rate"] = 0.01
    with gloam.load(scene, pace="realtime", speed=0.1) as sim:
        camera = sim.cameras["small"].open(("depth",), **FAST)
        assert camera.next().index == 0
        sim.run()
        start = time.monotonic()
        with pytest.raises(TimeoutError):
            camera.next(timeout=0.2)
        assert 0.2 <= time.monotonic() - start < 5
        with pytest.raises(gloam.UsageError, match="timeout"):
            camera.next(timeout=-1)
        with pytest.raises(gloam.UsageError, match="timeout"):
            camera.next(timeout=float("nan"))


def test_ctrl_c_ends_waiting(tmp_path: Path, run_python) -> None:  # type: ignore[no-untyped-def]
    ball_file(tmp_path)
    told = run_python("""
import gloam, os, signal, threading
signal.signal(signal.SIGINT, signal.default_int_handler)
sim = gloam.load("ball.xml", pace="realtime", speed=1e-6)
where = sim.sensors["where"].open(required=False)
list(where)
sim.run()
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    while True:
        where.next()
except KeyboardInterrupt:
    print("interrupted")
sim.close()
""", timeout=30)
    assert told.stdout == "interrupted\n"


def test_messages_of_a_callback_cannot_be_read(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        where = sim.sensors["where"].open(callback=lambda sample: None)
        with pytest.raises(gloam.UsageError, match="callback"):
            sim.step_until(where)
        assert sim.step_count == 0 and where.latest() is None
        own: list[gloam.SensorStream] = []
        own.append(sim.sensors["where"].open(callback=lambda sample: [stream.latest() for stream in own]))
        with pytest.raises(gloam.UsageError, match="own stream"):
            for _ in range(50):
                sim.step(2)
        own[0].close()
        sim.run("fast")
        with pytest.raises(gloam.UsageError, match="callback"):
            where.next(timeout=1)


def test_step_until_takes_a_stream_of_its_simulation(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim, gloam.load(ball_file(tmp_path)) as other:
        for wrong in (sim.sensors["where"], sim.cameras["front"], other.sensors["where"].open()):
            with pytest.raises(TypeError, match="open stream"):
                sim.step_until(wrong)  # type: ignore[arg-type]
        where = sim.sensors["where"].open(required=False)
        sim.run("fast")
        with pytest.raises(gloam.UsageError, match="running"):
            sim.step_until(where)


def test_callbacks_get_the_same_objects(tmp_path: Path) -> None:
    seen: list[object] = []
    with gloam.load(ball_scene(tmp_path)) as sim:
        sim.cameras["small"].open(("depth",), callback=seen.append, **FAST)
        sim.sensors[sim.world.sensors[0]].open(callback=seen.append)
        sim.subscribe(["/clock"], seen.append)
        sim.run_until(0.1)
    assert {type(message) for message in seen} == {gloam.Frame, gloam.Sample, gloam.Message}


def test_metrics_begin_with_their_stream_and_at_a_reset(tmp_path: Path) -> None:
    scene = gloam.Scene.from_dict({"robot": [{"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "controller": {"type": "trot"}}]})
    with gloam.load(scene) as sim:
        early = sim.open_metrics()
        sim.robots["dog"].command(vx=0.5)
        sim.run_until(1.0)
        late = sim.open_metrics()
        sim.run_until(1.5)
        length = {name: stream.latest()["dog.path_length_m"] for name, stream in (("early", early), ("late", late))}
        assert length["early"] > 0.25 and length["early"] > 1.5 * length["late"] > 0
        assert early.latest() == early.latest(), "reading changes nothing"
        sim.reset()
        assert early.latest().get("dog.path_length_m", 0) < 1e-6
        sim.run_until(0.2)
        assert early.latest()["dog.path_length_m"] < 0.2
        sim.set("sim.duration", 20)
        sim.run_until(0.4)
        assert np.isfinite(early.latest()["dog.x_m"]), "it follows the simulation into another World"
        early.close()
        with pytest.raises(gloam.ClosedError):
            early.latest()


def test_images_have_the_settings_of_the_scene(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    scene.update({"render.tier": "path", "render.spp": 3, "render.denoise": False, "render.ev100": 9.0})
    assert np.unique(gloam.render(scene, camera="small", outputs=("samples",)).samples).tolist() == [3]
    with gloam.load(scene) as sim:
        camera = sim.cameras["small"]
        for frame in (camera.render(("rgb", "samples")), camera.open(("rgb", "samples")).next()):
            assert np.unique(frame.samples).tolist() == [3] and frame.ev100 == 9
        frame = camera.render(("rgb", "samples"), spp=2, ev100=10)
        assert np.unique(frame.samples).tolist() == [2] and frame.ev100 == 10
        at_rest = sim.world.snapshot(sim.memory.array("qpos")).render("small", ("rgb", "samples"))
        assert np.unique(at_rest.samples).tolist() == [3] and at_rest.ev100 == 9
        with pytest.raises(gloam.Error, match="spp"):
            camera.render(spp=0)


def test_samples_or_a_tier_leave_out_the_error_bound_of_the_scene(tmp_path: Path) -> None:
    scene = ball_scene(tmp_path)
    scene.update({"render.error": 0.5, "render.spp": 32, "render.denoise": False})
    with gloam.load(scene) as sim:
        camera = sim.cameras["small"]
        bounded = camera.render(("rgb", "samples")).samples
        assert bounded.min() >= 16 and bounded.max() <= 32
        assert np.unique(camera.render(("rgb", "samples"), spp=2).samples).tolist() == [2]
        assert camera.render(("rgb",), tier="direct", spp=1).rgb.shape == (24, 32, 3)
        assert camera.render(("rgb",), tier="direct").rgb.shape == (24, 32, 3)
        with pytest.raises(gloam.Error, match="path tier"):
            camera.render(("rgb",), tier="direct", error=0.1)
        assert camera.render(("rgb", "samples"), error=0.9).samples.min() >= 16
