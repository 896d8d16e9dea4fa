"""Descriptions of worlds, simulations and logs: frozen dataclasses that become JSON."""
from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import gloam
import numpy as np
import pytest
from scenes import QUADRUPED, ball_file, ball_scene


def plain(row: object) -> object:
    assert dataclasses.is_dataclass(row) and not isinstance(row, type)
    return json.loads(json.dumps(dataclasses.asdict(row)))


def test_topics_have_the_kind_and_name_of_their_source(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        topics = {topic.name: topic for topic in sim.topics()}
        assert topics == {topic.name: topic for topic in sim.world.topics()}
    image = topics["/small/image_raw"]
    assert (image.type, image.source_kind, image.source_name) == ("sensor_msgs/msg/Image", "camera", "small")
    assert image.rate == 50 and image.is_large and not image.is_input
    odometry = topics["/go/odom"]
    assert (odometry.source_kind, odometry.source_name) == ("robot", "go")
    assert (topics["/contacts"].source_kind, topics["/contacts"].source_name) == ("simulation", "contacts")
    assert {topic.source_kind for topic in topics.values()} == {"simulation", "robot", "camera", "sensor"}
    assert all(isinstance(plain(topic), dict) for topic in topics.values())
    with pytest.raises(dataclasses.FrozenInstanceError):
        image.rate = 3  # type: ignore[misc]


def test_a_world_lists_its_streams_inputs_and_metrics(tmp_path: Path) -> None:
    scene = gloam.Scene.from_dict({
        "robot": [{"name": "dog", "file": str(QUADRUPED), "controller": {"type": "trot"}}],
        "camera": [{"name": "eye", "rate": 25, "position": [0, -3, 1], "look_at": [0, 0, 0]}],
        "lidar": [{"name": "roof", "position": [0, 0, 2]}],
        "randomize": [{"option": "camera.eye.width", "choice": [320]}],
    })
    world = scene.compile()
    eye = next(stream for stream in world.streams() if stream.kind == "camera" and stream.name == "eye")
    assert eye.rate == 25 and eye.frame_id == "eye_optical_frame" and "rgb" in eye.outputs
    assert world.lidars == ["roof"]
    controls = next(i for i in world.inputs() if i.kind == "controls")
    assert controls.name == "dog" and controls.count == 12 and len(controls.elements) == 12
    length = next(m for m in world.metrics() if m.name.endswith("path_length_m"))
    assert length.unit == "m" and not length.declared
    info = world.info
    assert info is world.info and info.nu == 12 and info.nq == 19 and info.mass > 1 and info.timestep == world.timestep
    assert info.drawn == {"camera.eye.width": "320"}
    assert "dog/trunk" in info.bodies and info.probes == ()
    for row in (eye, controls, length, info):
        plain(row)


def test_contacts_labels_and_stats(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim:
        assert all("skin" not in contact.geoms for contact in sim.contacts())
        sim.run_until(2.0)
        contact = next(contact for contact in sim.contacts() if "skin" in contact.geoms)
        assert contact.geoms == ("floor", "skin")
        assert contact.normal == pytest.approx((0, 0, 1)) and contact.force[2] == pytest.approx(9.81, abs=0.1)
        assert contact.position[2] == pytest.approx(0, abs=0.01) and contact.distance < 0
        labels = {label.geom: label for label in sim.labels()}
        assert labels["skin"].body == labels["skin"].instance_name == "ball" and labels["skin"].part > 0
        assert plain(labels["skin"]) == dataclasses.asdict(labels["skin"])
        sim.sensors["where"].open(callback=lambda sample: None)
        sim.step(10)
        stats = sim.stats
        assert stats.step == sim.step_count and stats.time == sim.time and stats.hash == sim.hash and stats.pace == "lockstep"
        [cost] = stats.sensors
        assert "where" in cost.name
        plain(stats)


def test_logs_are_described(tmp_path: Path) -> None:
    with gloam.load(ball_file(tmp_path)) as sim, sim.record(tmp_path / "run.mcap", ["/clock", "/tf"]):
        sim.run_until(0.5)
    log = gloam.replay(tmp_path / "run.mcap")
    assert set(log) >= {"/clock", "/tf"} and log.info.has_run and log.info.damage == ""
    clock = next(topic for topic in log.topics if topic.name == "/clock")
    assert clock.type == "rosgraph_msgs/msg/Clock" and clock.messages > 1 and clock.rate > 0
    plain(log.info)
    data = (tmp_path / "run.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) * 2 // 3])
    recovery = gloam.Log(tmp_path / "cut.mcap").recover(tmp_path / "whole.mcap")
    assert not recovery.is_whole and recovery.messages > 0 and recovery.damage


def test_frames_describe_their_objects_and_lens(tmp_path: Path) -> None:
    with gloam.load(ball_scene(tmp_path)) as sim:
        frame = sim.cameras["small"].render(("boxes", "depth"), tier="direct", spp=1)
    ball = next(view for view in frame.objects if view.name == "go")
    assert 0 < ball.visibility <= 1 and ball.pixels > 0 and len(ball.box) == 4
    assert isinstance(ball.pose, gloam.Pose) and np.isfinite(ball.center).all()
    assert frame.info.frame_id == "small_optical_frame" and list(frame.info.d) == frame.D
    assert (frame.width, frame.height, frame.camera, frame.warmup) == (32, 24, "small", False)
