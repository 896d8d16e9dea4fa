"""Cameras, sensors and LiDARs from Python."""
from __future__ import annotations

import gc
from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import ball_file, ball_scene

FAST = {"tier": "direct", "spp": 1, "denoise": False}


def test_frames_come_in_order_at_their_times(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(**FAST)
        for i in range(4):
            frame = sim.step_until(camera)
            assert frame.index == i and frame.stamp == pytest.approx(0.02 * i) and sim.time >= frame.delivery - 1e-9
            assert frame.rgb.shape == (24, 32, 3) and frame.depth.shape == (24, 32) and frame.ids.dtype == np.uint32
        sim.step(100)  # time goes on without the camera
        frame = camera.next()
        assert frame.stamp >= 0.06 + 0.2 - 1e-9 and camera.latest() is frame


def test_the_picture_after_a_reset_is_the_new_worlds(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(**FAST)
        first = camera.next()
        while sim.time < 0.4:
            last = camera.next()
        assert not np.array_equal(first.depth, last.depth), "the ball has fallen"
        sim.reset()
        again = camera.next()
        assert again.index == 0 and np.array_equal(again.depth, first.depth) and np.array_equal(again.rgb, first.rgb)


def test_a_changed_option_changes_the_picture(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(**FAST)
        bright = camera.next().rgb.mean()
        sim.set("light.sun.illuminance", 200.0)
        sim.set("render.ev100", 14)
        dark = sim.cameras["small"].render(**FAST, ev100=14).rgb.mean()
        sim.set("light.sun.illuminance", 20000.0)
        light = sim.cameras["small"].render(**FAST, ev100=14).rgb.mean()
        assert dark < 0.5 * light and bright > 0


def test_arrays_share_the_frames_memory_and_keep_it(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        camera = sim.cameras["small"].open(**FAST)
        frame = sim.step_until(camera)
        one, other = frame.rgb, frame.rgb
        assert one.__array_interface__["data"][0] == other.__array_interface__["data"][0]
        assert np.from_dlpack(one).__array_interface__["data"][0] == one.__array_interface__["data"][0]
        kept = one.copy()
        for _ in range(5):
            sim.step_until(camera)
    del frame, other, sim, camera
    gc.collect()
    assert np.array_equal(one, kept)


def test_depth_is_where_the_ball_is(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        pose = gloam.Pose(np.array([0.0, -3.0, 1.0]), np.array([np.sqrt(0.5), np.sqrt(0.5), 0, 0]))
        frame = sim.cameras["free"].render(("depth", "segmentation"), width=65, height=65, pose=pose, **FAST)
        assert frame.depth[32, 32] == pytest.approx(3 - 0.1, abs=1e-3)
        names = {label.instance: label.instance_name for label in sim.labels()}
        assert names[int(frame.ids[32, 32])] == "ball"
        assert frame.X_WC[:3, 3] == pytest.approx((0, -3, 1))


def test_a_picture_of_a_given_state(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        qpos = sim.memory.array("qpos").copy()
        there = sim.cameras["small"].render(("depth",), **FAST)
        qpos[:3] = (0.3, 0, 1.2)
        other = sim.cameras["small"].render(("depth",), qpos=qpos, **FAST)
        assert not np.array_equal(other.depth, there.depth)
        assert sim.step_count == 0 and np.array_equal(sim.cameras["small"].render(("depth",), **FAST).depth, there.depth)
        sim.joints["go/free"].qpos[:] = qpos[:7]
        sim.step()
        moved = sim.cameras["small"].render(("depth",), **FAST).depth
        seen = np.isfinite(moved) & np.isfinite(other.depth)
        assert np.median(np.abs(moved[seen] - other.depth[seen])) < 1e-3
        with pytest.raises(ValueError):
            sim.cameras["small"].render(("depth",), qpos=[1.0, 2.0], **FAST)


def test_sensors_and_callbacks(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        sensor = sim.sensors["where"]
        sim.step(10)
        assert sensor.values[2] == pytest.approx(sim.joints["free"].qpos[2], abs=0.01)
        heights: list[float] = []
        stream = sensor.open(callback=lambda sample: heights.append(sample.values[2]))
        sim.step(20)
        stream.flush()
        assert len(heights) == 21 and heights == sorted(heights, reverse=True)
        frames: list[gloam.Frame] = []
        camera = sim.cameras["front"].open(("rgb",), width=16, height=12, rate=50, callback=frames.append, **FAST)
        sim.step(100)
        camera.flush()
        assert len(frames) >= 10 and frames[0].rgb.shape == (12, 16, 3)


def test_an_exception_of_a_callback_is_raised(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        sim.sensors["where"].open(callback=lambda sample: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            for _ in range(50):
                sim.step(2)


def test_bad_requests_name_the_nearest(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        with pytest.raises(gloam.Error, match="did you mean 'rgb'"):
            sim.cameras["front"].open(("rgbb",))
        with pytest.raises(gloam.NotFoundError, match="front"):
            _ = sim.cameras["frnt"]
        for wrong in ({"width": -1}, {"rate": -5.0}, {"tier": "fastest"}, {"spp": 0}, {"rate": float("nan")}):
            with pytest.raises((gloam.Error, TypeError)):
                sim.cameras["front"].open(**wrong)


def test_a_viewer_does_not_stand_in_the_way(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim, sim.view() as page:
        assert page.url.startswith("http://127.0.0.1:")
        camera = sim.cameras["small"].open(**FAST)
        for _ in range(3):
            camera.next()
        sim.set("render.spp", 3)
        camera.next()
        sim.reset()
        camera.next()


def test_probes_are_sensors(tmp_path: Path) -> None:
    ball_file(tmp_path)
    scene = gloam.Scene.from_dict({
        "robot": [{"name": "go", "file": "ball.xml"}],
        "sky": {"sun_elevation": 40.0},
        "weather": {"wind": 6.0, "gusts": 0.0, "wind_from": 180.0},
        "probe": [
            {"name": "mast", "quantity": "wind", "position": [0.0, 0.0, 10.0], "rate": 50},
            {"name": "landing", "quantity": "contact_force", "body": "go/ball", "rate": 50},
        ],
    }, tmp_path)
    with gloam.load(scene) as sim:
        assert sim.world.probes == ["mast", "landing"] and sim.sensors["mast"].name == "mast"
        landing, mast = sim.sensors["landing"].open(), sim.sensors["mast"].open()
        for n in range(3):
            sample = mast.next()
            assert sample.stamp == pytest.approx(n / 50) and np.allclose(sample.values, (0, 6, 0))
        sample = landing.latest()
        assert sample is not None and sample.values.shape == (3,) and np.allclose(sample.values, 0), "it falls"
        sim.run_until(2.0)
        sample = landing.latest()
        assert sample is not None and np.allclose(sample.values, (0, 0, 9.81), atol=0.05), "it lies on the floor"
        with pytest.raises(gloam.UsageError, match="open"):
            _ = sim.sensors["mast"].values
        with pytest.raises(KeyError, match="mast"):
            sim.sensors["masts"]
