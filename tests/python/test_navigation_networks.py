"""Preparation of images, networks and planners of the GNM family."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import gloam
import navigation_fixtures as fixtures
import numpy as np
import pytest
from gloam.navigation import Arrived, MapSource, Node, Observation, Task, TopologicalMap, Waypoints, make_planner
from gloam.navigation.networks.onnx_network import OnnxNetwork, Port
from gloam.navigation.networks.preprocessing import ContextStack, crop_to_aspect, prepare, resize
from gloam.navigation.planners.nomad import Sampling, sample_actions

RANDOM = np.random.default_rng(3)
INPUTS = [Port("obs_img", (1, 18, 64, 85)), Port("goal_img", (1, 3, 64, 85))]
OUTPUTS = [Port("dist", (1, 1)), Port("action", (1, 5, 4))]


def noise(height: int, width: int) -> Any:
    """An image of random pixels."""
    return RANDOM.integers(0, 256, (height, width, 3), np.uint8)


def seen(image: Any, time: float = 0.0) -> Observation:
    """An observation of an image alone."""
    return Observation(time, (0, 0, 0), (0, 0, 0), image)


@pytest.mark.parametrize("size", [(85, 64), (96, 96)])
@pytest.mark.parametrize("shape", [(480, 640), (64, 85), (96, 128), (30, 40), (97, 131), (720, 1280), (500, 300), (300, 310)])
def test_prepares_as_pillow_does(shape: tuple[int, int], size: tuple[int, int]) -> None:
    pillow = pytest.importorskip("PIL.Image")
    image = noise(*shape)
    ours = crop_to_aspect(image)
    height, width = shape
    crop = (height, int(height * 4 / 3)) if width > height else (int(width / (4 / 3)), width)
    left, top = (width - crop[1]) / 2, (height - crop[0]) / 2
    left = math.floor(left) if left < 0 else round(left)  # torchvision pads before it crops
    box = (left, round(top), left + crop[1], round(top) + crop[0])
    theirs = pillow.fromarray(image).crop(box)
    assert np.array_equal(ours, np.asarray(theirs)) or shape == (300, 310)
    assert ours.shape[:2] == crop
    expected = np.asarray(pillow.fromarray(ours).resize(size), np.float64)
    assert np.abs(resize(ours, size) - expected).max() <= 1
    mean, deviation = np.array([0.485, 0.456, 0.406]), np.array([0.229, 0.224, 0.225])
    normal = ((resize(ours, size) / 255 - mean) / deviation).transpose(2, 0, 1)
    assert prepare(image, size).dtype == np.float32
    assert np.allclose(prepare(image, size), normal, atol=1e-5)


def test_black_columns_fill_an_image_that_is_too_narrow() -> None:
    cropped = crop_to_aspect(np.full((300, 310, 3), 9, np.uint8))
    assert cropped.shape == (300, 400, 3)
    assert not cropped[:, :45].any() and not cropped[:, 355:].any() and (cropped[:, 45:355] == 9).all()


def test_stack_repeats_the_first_image_and_keeps_the_order() -> None:
    stack = ContextStack(3, (85, 64))
    images = [fixtures.flat(40 * i) for i in range(6)]

    def levels() -> list[int]:
        red = stacked[0, ::3].mean((1, 2)) * 0.229 + 0.485
        return [round(float(level) * 255) for level in red]

    for i, expected in enumerate([[0, 0, 0, 0], [0, 0, 0, 40], [0, 0, 40, 80], [0, 40, 80, 120], [40, 80, 120, 160]]):
        stacked = stack.push(images[i])
        assert stacked.shape == (1, 12, 64, 85) and levels() == expected
    stack.clear()
    stacked = stack.push(images[5])
    assert levels() == [200] * 4


@pytest.mark.parametrize("image", [np.zeros((4, 4, 4), np.uint8), np.zeros((4, 4, 3)), np.zeros((0, 4, 3), np.uint8), None])
def test_refuses_other_images(image: Any) -> None:
    with pytest.raises(ValueError, match="image"):
        prepare(image, (85, 64))


@pytest.mark.parametrize("backend", ["openvino", "onnxruntime"])
def test_networks_repeat(tmp_path: Path, backend: Any) -> None:
    pytest.importorskip(backend)
    network = OnnxNetwork(fixtures.write_direct(tmp_path / "gnm.onnx"), INPUTS, OUTPUTS, backend)
    obs, goal = RANDOM.standard_normal((1, 18, 64, 85), np.float32), RANDOM.standard_normal((1, 3, 64, 85), np.float32)
    first = network.run(obs_img=obs, goal_img=goal)
    distance = 57.1 * np.abs(obs[:, 15:] - goal).mean()
    assert first["dist"][0, 0] == pytest.approx(distance, rel=1e-5)
    assert np.allclose(first["action"][0], fixtures.STEPS * (1 + distance), rtol=1e-5)
    for _ in range(3):
        again = network.run(obs_img=obs, goal_img=goal)
        assert all(np.array_equal(again[name], first[name]) for name in first)


def test_networks_are_checked(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    path = fixtures.write_direct(tmp_path / "gnm.onnx")
    with pytest.raises(gloam.IoError, match="no such file"):
        OnnxNetwork(tmp_path / "other.onnx", INPUTS, OUTPUTS)
    (tmp_path / "text.onnx").write_text("not a network")
    with pytest.raises(gloam.InputError, match="not a network"):
        OnnxNetwork(tmp_path / "text.onnx", INPUTS, OUTPUTS)
    for ports in ([Port("obs_img", (1, 12, 64, 85)), INPUTS[1]], [INPUTS[0]], [INPUTS[0], Port("goal", (1, 3, 64, 85))]):
        with pytest.raises(gloam.InputError, match=r"must be .*got obs_img: float32 \[1, 18, 64, 85\]") as raised:
            OnnxNetwork(path, ports, OUTPUTS)
        assert raised.value.file == str(path)
    with pytest.raises(gloam.InputError, match="int64"):
        OnnxNetwork(path, INPUTS, [Port("dist", (1, 1), "int64"), OUTPUTS[1]])
    network = OnnxNetwork(path, INPUTS, OUTPUTS)
    obs, goal = np.zeros((1, 18, 64, 85), np.float32), np.zeros((1, 3, 64, 85), np.float32)
    for arrays in ({"obs_img": obs}, {"obs_img": obs[:, 1:], "goal_img": goal}, {"obs_img": obs, "goal_img": goal.astype(float)}):
        with pytest.raises(ValueError, match="must be"):
            network.run(**arrays)


def test_without_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = fixtures.write_direct(tmp_path / "gnm.onnx")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(gloam.UnsupportedError, match="pip install openvino"):
        OnnxNetwork(path, INPUTS, OUTPUTS)


def test_outputs_must_be_finite(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    planner = make_planner("gnm", weights=fixtures.write_direct(tmp_path / "gnm.onnx", spoil=math.nan))
    planner.reset(Task("rover", map=fixtures.grey_map([0, 100])))
    with pytest.raises(ValueError, match="'action' has numbers that are not finite"):
        planner.plan(seen(fixtures.flat(0)))


def test_follows_the_nodes_as_published(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    levels = [0, 20, 40, 60, 80, 100, 120, 140]
    planner = make_planner("gnm", weights=fixtures.write_direct(tmp_path / "gnm.onnx"), radius=2)
    assert planner.image_size == (85, 64) and planner.rate == 4.0
    planner.reset(Task("rover", map=fixtures.grey_map(levels), top_speed=0.4))

    def step(level: int) -> tuple[int, float]:
        answer = planner.plan(seen(fixtures.flat(level)))
        assert isinstance(answer, Waypoints) and answer.chosen == 2
        factor = float(answer.points[0, 0]) / 0.1  # of STEPS: 1 + distance to the node that the robot drives to
        assert np.allclose(answer.points[:, :2], fixtures.STEPS[:, :2] * 0.1 * factor, atol=1e-5)
        return planner.closest, factor - 1

    assert step(0) == (1, pytest.approx(20, rel=0.01))  # node 0 is within 3: to the one after it
    assert step(15) == (1, pytest.approx(5, rel=0.01))  # node 1 is beyond 3
    assert step(38) == (3, pytest.approx(22, rel=0.01))
    assert step(140) == (6, pytest.approx(20, rel=0.02))  # the window ends at node 6
    assert isinstance(planner.plan(seen(fixtures.flat(119))), Arrived)  # node 6 is within 3: node 7 is the last
    planner.reset(Task("rover", map=fixtures.grey_map(levels)))
    assert step(0)[0] == 1


def test_goal_threshold(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    weights = fixtures.write_direct(tmp_path / "gnm.onnx")
    map = fixtures.grey_map([0, 50])
    for threshold, arrives in ((math.inf, True), (10.0, False)):
        planner = make_planner("gnm", weights=weights, goal_threshold=threshold)
        planner.reset(Task("rover", map=map))
        assert isinstance(planner.plan(seen(fixtures.flat(0))), Arrived) == arrives
        assert isinstance(planner.plan(seen(fixtures.flat(48))), Arrived)


def test_context_size_comes_from_the_file(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    planner = make_planner("gloam", weights=fixtures.write_direct(tmp_path / "policy.onnx", context_size=1))
    planner.reset(Task("rover", map=fixtures.grey_map([0, 100])))
    assert isinstance(planner.plan(seen(fixtures.flat(50))), Waypoints | Arrived)
    with pytest.raises(gloam.InputError, match="must be"):
        make_planner("gloam", weights=fixtures.write_direct(tmp_path / "short.onnx", outputs=2))


def test_planners_refuse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    weights = fixtures.write_direct(tmp_path / "gnm.onnx")
    monkeypatch.setattr(gloam, "home", lambda: str(tmp_path))
    with pytest.raises(gloam.IoError, match="no such file"):
        make_planner("gloam")
    for name in ("gnm", "vint", "nomad"):
        with pytest.raises(gloam.UsageError, match="needs weights"):
            make_planner(name)
        with pytest.raises(TypeError, match="speed"):
            make_planner(name, weights=weights, speed=3)
    for options in ({"radius": -1}, {"rate": math.nan}, {"close_threshold": math.nan}, {"waypoint": 64}):
        with pytest.raises(gloam.UsageError, match="must be"):
            make_planner("gnm", weights=weights, **options)
    pytest.importorskip("openvino")
    with pytest.raises(gloam.InputError, match="waypoint 5"):
        make_planner("gnm", weights=weights, waypoint=5)
    planner = make_planner("gnm", weights=weights)
    with pytest.raises(gloam.UsageError, match="before reset"):
        planner.plan(seen(fixtures.flat(0)))
    with pytest.raises(gloam.UsageError, match="follows a map"):
        planner.reset(Task("rover"))
    planner.reset(Task("rover", map=fixtures.grey_map([0])))
    with pytest.raises(ValueError, match="no image"):
        planner.plan(seen(None))


def test_map_of_another_scene(tmp_path: Path, pendulum: Path) -> None:
    pytest.importorskip("openvino")
    world = gloam.load(pendulum).world
    planner = make_planner("gnm", weights=fixtures.write_direct(tmp_path / "gnm.onnx"))
    nodes = [Node(fixtures.flat(0), (0, 0, 0), 0.0)]
    here = MapSource.of(world, "side")
    planner.reset(Task("rover", map=TopologicalMap(nodes, here), world=world))
    for source, match in ((MapSource("kitchen"), "recorded in scene 'kitchen'"), (MapSource(here.scene, "0" * 64), "has changed")):
        with pytest.raises(gloam.UsageError, match=match):
            planner.reset(Task("rover", map=TopologicalMap(nodes, source), world=world))


def reference_ddpm(predict: Any, random: np.random.Generator, samples: int, steps: int) -> Any:
    """DDPM as in Ho et al. 2020, algorithm 2, with x0 clipped, in double precision and by other formulas than ours."""
    cosine = [math.cos((i / steps + 0.008) / 1.008 * math.pi / 2) ** 2 for i in range(steps + 1)]
    alpha = [max(cosine[i + 1] / cosine[i], 0.001) for i in range(steps)]
    bar = [math.prod(alpha[: i + 1]) for i in range(steps)]
    x = random.standard_normal((samples, 8, 2), np.float32).astype(float)
    for t in range(steps - 1, -1, -1):
        x0 = np.clip(x / bar[t] ** 0.5 - (1 / bar[t] - 1) ** 0.5 * predict(x, t), -1, 1)
        if t == 0:
            x = x0  # the posterior of the first step is the estimate itself
            break
        precision = alpha[t] / (1 - alpha[t]) + 1 / (1 - bar[t - 1])  # of the posterior q(x[t-1] | x[t], x0)
        mean = (alpha[t] ** 0.5 / (1 - alpha[t]) * x + bar[t - 1] ** 0.5 / (1 - bar[t - 1]) * x0) / precision
        x = mean + precision**-0.5 * random.standard_normal(x.shape, np.float32)
    steps_of = (x + 1) / 2 * (np.array([5.0, 4.0]) - np.array([-2.5, -4.0])) + np.array([-2.5, -4.0])
    return np.cumsum(steps_of, axis=1)


@pytest.mark.parametrize("steps", [1, 10, 25])
def test_sampler_is_ddpm(steps: int) -> None:
    def predict(x: Any, t: int) -> Any:
        return np.asarray(np.tanh(0.7 * x) + 0.02 * t, x.dtype)

    ours = sample_actions(predict, Sampling(5, steps), np.random.Generator(np.random.Philox(key=9)))
    theirs = reference_ddpm(predict, np.random.Generator(np.random.Philox(key=9)), 5, steps)
    assert ours.shape == (5, 8, 2) and np.abs(ours - theirs).max() < 1e-4
    assert np.abs(np.diff(ours, axis=0)).max() > 0.1 or steps == 1


def test_nomad(tmp_path: Path) -> None:
    pytest.importorskip("openvino")
    planner = make_planner("nomad", weights=fixtures.write_nomad(tmp_path), samples=3)
    assert planner.image_size == (128, 96)
    task = Task("rover", seed=5, map=fixtures.grey_map([0, 40, 80, 120, 160, 200]), top_speed=0.8)
    planner.reset(task)
    first = planner.plan(seen(fixtures.flat(38)))  # node 1 within 3: to node 2
    assert isinstance(first, Waypoints) and planner.closest == 1  # type: ignore[attr-defined]

    def predict(x: Any, t: int) -> Any:
        return 0.9 * x + 0.01 * t + 0.002 * embedding(38, 80)

    expected = reference_ddpm(predict, np.random.Generator(np.random.Philox(key=np.array([5, 0], np.uint64))), 3, 10)[0]
    assert first.points.shape == (8, 2) and np.abs(first.points - expected * 0.8 / 4).max() < 1e-4
    second = planner.plan(seen(fixtures.flat(38)))
    planner.reset(task)
    again = [planner.plan(seen(fixtures.flat(38))) for _ in range(2)]
    assert np.array_equal(again[0].points, first.points) and np.array_equal(again[1].points, second.points)  # type: ignore[union-attr]
    assert not np.array_equal(again[0].points, again[1].points)  # type: ignore[union-attr]
    for level, closest in ((120, 3), (160, 4)):
        assert isinstance(planner.plan(seen(fixtures.flat(level))), Waypoints) and planner.closest == closest  # type: ignore[attr-defined]
    assert isinstance(planner.plan(seen(fixtures.flat(190))), Arrived)
    with pytest.raises(gloam.UsageError, match="samples"):
        make_planner("nomad", weights=tmp_path, samples=0)
    (tmp_path / "nomad_noise.onnx").unlink()
    with pytest.raises(gloam.IoError, match="nomad_noise"):
        make_planner("nomad", weights=tmp_path)


def embedding(here: int, goal: int) -> float:
    """The first number of fixtures.write_nomad's embedding for two levels of grey."""
    return 57.1 * float(np.mean((goal - here) / 255 / np.array([0.229, 0.224, 0.225])))
