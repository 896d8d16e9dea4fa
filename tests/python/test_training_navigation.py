"""Training of the navigation policy: paths, labels, scenes, samples, shapes, publication."""

from __future__ import annotations

import json
import stat
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import gloam  # noqa: E402
from gloam.navigation.grid import Grid  # noqa: E402
from training.navigation import labels, pairs, paths, publish, render_all, routes, scenes  # noqa: E402


def two_rooms() -> Grid:
    """A floor of 10 x 6 m with a wall at x = 5 m and a door of 1.4 m."""
    blocked = np.zeros((61, 101), bool)
    blocked[0], blocked[-1], blocked[:, 0], blocked[:, -1] = True, True, True, True
    blocked[:, 49:52] = True
    blocked[23:37, 49:52] = False
    return Grid((0.0, 0.0), 0.1, blocked)


def straight() -> labels.Path:
    return labels.Path(np.column_stack([np.linspace(0, 5, 101), np.zeros(101)]))


def test_labels_of_a_straight_path_are_steps_ahead() -> None:
    turned = 0.7
    points = straight().points @ np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])
    path = labels.Path(points)
    for pose, along in (((0.0, 0.0, turned), 0.0), ((*path.at(4.9), turned), 4.9)):  # the last goes on beyond the end
        found = labels.waypoints(path, np.array(pose), along)
        assert np.allclose(found, [[k, 0, 1, 0] for k in range(1, 6)], atol=1e-6)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_labels_of_a_quarter_circle_lie_on_it(side: float) -> None:
    radius = 1.2
    angle = np.linspace(0, np.pi / 2, 400)
    path = labels.Path(radius * np.column_stack([np.sin(angle), side * (1 - np.cos(angle))]))
    pose = np.array([radius * np.sin(0.3), side * radius * (1 - np.cos(0.3)), side * 0.3])
    found = labels.waypoints(path, pose, 0.3 * radius)
    turned = 0.1 * np.arange(1, 6) / radius
    wanted = np.column_stack(
        [10 * radius * np.sin(turned), side * 10 * radius * (1 - np.cos(turned)), np.cos(turned), side * np.sin(turned)]
    )
    assert np.abs(found - wanted).max() < 1e-3


def test_labels_lead_back_to_the_path() -> None:
    found = labels.waypoints(straight(), np.array([1.0, 0.3, 0.4]), 1.0)
    y = 0.3 + 0.1 * (np.sin(0.4) * found[:, 0] + np.cos(0.4) * found[:, 1])
    assert y[-1] < 0.25 and y[-1] < y[-2] < y[-3] and found[-1, 3] < np.sin(-0.4), "it heads for the path"
    behind = labels.waypoints(straight(), np.array([1.0, 0.0, 2.5]), 1.0)
    steps = np.linalg.norm(np.diff(behind[:, :2], axis=0), axis=1)
    assert steps.max() < 0.2, "it turns before it goes"
    assert np.allclose(np.arctan2(behind[:, 3], behind[:, 2]), -0.25 * np.arange(1, 6))


def test_distances_are_steps_up_to_twenty() -> None:
    assert np.allclose(labels.distance_steps(1.0, [0.5, 1.0, 1.55, 3.0, 9.0]), [0, 0, 5.5, 20, 20])


@pytest.mark.parametrize("points", [np.zeros((1, 2)), np.zeros((3, 3)), np.zeros((3, 2)), np.full((2, 2), np.nan)])
def test_a_path_needs_different_finite_points(points: np.ndarray) -> None:
    with pytest.raises(ValueError, match="a path needs"):
        labels.Path(points)


def test_paths_stay_in_the_free_space_and_keep_their_distance() -> None:
    space = two_rooms()
    path = paths.plan(space, np.array([1.0, 1.0]), np.array([9.0, 5.0]))
    assert path is not None and all(space.is_free(point) for point in path.points)
    through = path.points[np.abs(path.points[:, 0] - 5.0) < 0.15]
    assert len(through) > 0 and np.abs(through[:, 1] - 2.95).max() < 0.35, "near the middle of the door"
    assert np.linalg.norm(path.points[0] - (1, 1)) < 0.1 and np.linalg.norm(path.points[-1] - (9, 5)) < 0.1
    assert 8.9 < path.length < 11


def test_there_is_no_path_through_walls() -> None:
    space = two_rooms()
    space.blocked[:, 49:52] = True
    assert paths.plan(space, np.array([1.0, 1.0]), np.array([9.0, 5.0])) is None


def test_drives_stray_within_the_free_space() -> None:
    space = two_rooms()
    path = paths.plan(space, np.array([1.0, 1.0]), np.array([9.0, 5.0]))
    assert path is not None
    gaps = []
    for seed in range(5):
        poses, along = paths.deviating_drive(path, space, np.random.default_rng(seed), paths.Deviation())
        assert all(space.is_free(pose[:2]) for pose in poses) and (np.diff(along) >= 0).all()
        gaps += [np.linalg.norm(pose[:2] - path.at(at)) for pose, at in zip(poses, along, strict=True)]
    assert 0.05 < np.mean(gaps) < 0.25 and max(gaps) > 0.2


def make_views(seed: int = 3, count: int = 100) -> routes.Views:
    parts = [routes.place_views(two_rooms(), count, place, 10 * place, seed) for place in range(2)]
    return routes.joined(parts)


def test_views_follow_the_seed() -> None:
    first, again, other = make_views(), make_views(), make_views(4)
    for field in fields(routes.Views):
        assert np.array_equal(getattr(first, field.name), getattr(again, field.name)), field.name
    assert len(first) >= 200 and not np.array_equal(first.pose[:50], other.pose[:50])


def test_pairs_overlap_across_free_space() -> None:
    space = two_rooms()
    rng = np.random.default_rng(2)
    poses = np.array([[*space.sample(rng), rng.uniform(-np.pi, np.pi)] for _ in range(400)])
    rule = pairs.PairRule(per_view=8)
    found = pairs.pairs_of(poses, space, np.random.default_rng(1), rule)
    assert len(found.anchor) > 400 and np.bincount(found.anchor).max() <= 8
    start, offset = poses[found.anchor], poses[found.goal, :2] - poses[found.anchor, :2]
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    aside = np.abs(labels.wrap(bearing - start[:, 2]))
    assert ((aside <= rule.aside) == found.ahead).all() and 0.2 < found.ahead.mean() < 0.8
    assert np.abs(labels.wrap(poses[found.goal, 2] - start[:, 2])).max() <= rule.turned
    turning = np.maximum(aside - np.pi / 4, 0) / 0.25
    assert np.allclose(found.dist, 10 * np.hypot(*offset.T) + turning, atol=1e-4) and found.dist.max() <= 22 + 9.5
    through = (start[:, 0] - 5) * (poses[found.goal, 0] - 5) < 0  # from one room into the other
    cross = start[:, 1] + (5 - start[:, 0]) / np.where(through, offset[:, 0], 1.0) * offset[:, 1]
    assert through.any() and (np.abs(cross[through] - 2.95) < 0.8).all(), "only through the door"
    left = found.action[:, -1, 1] > 0
    assert (left == (labels.wrap(bearing - start[:, 2]) > 0))[(np.abs(found.action[:, -1, 1]) > 0.05) & found.ahead].all()
    none = pairs.pairs_of(poses[:1], space, np.random.default_rng(1), rule)
    assert none.action.shape == (0, 5, 4) and len(none.dist) == 0


def test_places_differ_from_the_benchmark_and_follow_the_seed() -> None:
    some = scenes.places(4, 2)
    assert some == scenes.places(4, 2) and len({place.name for place in some}) == 6
    assert all(place.seed >= 1000 for place in some)
    assert {place.level for place in some if place.kind == "house"} == {"minor", "major"}
    with pytest.raises(ValueError, match="at least one place"):
        scenes.places(0, 0)


def test_the_camera_is_where_the_robot_has_it() -> None:
    file = Path(__file__).resolve().parents[2] / "assets/robots/quadruped/quadruped.xml"
    with gloam.load(file) as sim:
        sim.step()
        number = sim.world.info.sites.index("front_stereo_mount")
        # Relative to the trunk in the keyframe home: 0.3 m high.
        local = np.array(sim.memory.array("site_xpos"))[number] - np.array(sim.memory.array("qpos"))[:3]
    assert np.allclose(local[:2], (scenes.AHEAD, scenes.LEFT), atol=2e-3)
    assert abs(local[2] + 0.3 - scenes.HEIGHT) < 2e-3
    poses = np.tile([[1.0, 2.0, 0.5]], (400, 1))
    position, turn = scenes.camera_poses(poses, np.random.default_rng(1))
    assert np.allclose(np.linalg.norm(turn, axis=1), 1) and np.abs(position[:, 2] - 0.31).max() < 0.03
    w, x, y, z = turn.mean(0)
    ahead = -np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    wanted = np.array([np.cos(0.5) * np.cos(0.087), np.sin(0.5) * np.cos(0.087), -np.sin(0.087)])
    assert np.abs(ahead - wanted).max() < 0.01, "5 degrees down"


def test_scenes_compile_with_all_cameras(tmp_path: Path) -> None:
    place = scenes.places(1, 0)[0]
    views = make_views(count=10)
    routes.write_place(place, views, tmp_path)
    clear, adverse = (tmp_path / f"house_1000_{name}.toml" for name in scenes.CONDITIONS)
    world = gloam.Scene(clear).compile()
    assert [name for name in world.cameras if name.startswith("v")] == [scenes.view_name(k) for k in range(len(views))]
    assert "[adversity]" in adverse.read_text() and "[adversity]" not in clear.read_text()


def program(folder: Path, body: str) -> str:
    file = folder / "program"
    file.write_text(f"#!{sys.executable}\nimport sys, pathlib, time\nout = pathlib.Path(sys.argv[-1])\n{body}\n")
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    return str(file)


def test_rendering_reports_failures_and_resumes(tmp_path: Path) -> None:
    (tmp_path / "scenes").mkdir()
    for name in ("house_1_clear", "house_2_clear"):
        (tmp_path / "scenes" / f"{name}.toml").write_text("[[camera]]\n[[camera]]\n")
    written = "[(out / f'v{k:05d}{kind}.png').touch() for k in range(2) for kind in ('', '_depth')]"
    broken = "\n".join(["if 'house_2' in str(out): sys.exit('no light')", written])
    renderer = render_all.Renderer(program(tmp_path, broken), "cpu", 1e18)
    first = render_all.render_all(tmp_path, renderer, 2)
    assert [report["state"] for report in first] == ["done", "failed"] and "no light" in first[1]["message"]
    again = render_all.render_all(tmp_path, renderer, 2)
    assert [report["state"] for report in again] == ["kept", "failed"]
    late = render_all.render_all(tmp_path, render_all.Renderer("none", "cpu", 0.0), 1)
    assert [report["state"] for report in late] == ["kept", "late"]
    missing = render_all.render_all(tmp_path, render_all.Renderer("/no/program", "cpu", 1e18), 1)
    assert missing[1]["state"] == "failed" and "/no/program" in missing[1]["message"]


def test_packed_images_keep_their_rows_and_millimetres(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    np.savez(tmp_path / "routes.npz", names=np.array(["house_1", "house_2"]), place=np.array([0, 1, 1]))
    for name, count in (("house_1", 0), ("house_2", 2)):  # the first one failed
        folder = tmp_path / "images" / f"{name}_clear"
        folder.mkdir(parents=True)
        for k in range(count):
            image.fromarray(np.full((64, 85, 3), 10 + k, np.uint8)).save(folder / f"v{k:05d}.png")
            image.fromarray(np.full((64, 85), 1000 * k + 500, np.uint16)).save(folder / f"v{k:05d}_depth.png")
    assert render_all.pack(tmp_path, "clear") == 2 and render_all.pack(tmp_path, "adversity") == 0
    with np.load(tmp_path / "images_clear.npz") as packed:
        assert packed["rows"].tolist() == [1, 2] and packed["images"][:, 0, 0, 0].tolist() == [10, 11]
        assert packed["depths"][:, -1, -1].tolist() == [500, 1500] and packed["depths"].dtype == np.uint16
    with np.load(tmp_path / "images_adversity.npz") as packed:
        assert packed["images"].shape == (0, 64, 85, 3) and packed["depths"].shape == (0, 64, 85)


def metrics(conditions: list[str]) -> dict[str, Any]:
    part = {"dist_mae": 1.5, "waypoint_m": 0.02, "direction_cos": 0.99, "heading_cos": 0.98, "negative_dist": 17.0}
    part |= {"goal_gain_m": 0.03, "samples": 100.0}
    return {
        "settings": {"conditions": conditions, "seconds": 100.0, "batch": 1024, "seed": 1},
        "parameters": 1_500_000,
        "steps": 4321,
        "device": "cpu",
        "places": {"training": ["a", "b"], "validation": ["c"]},
        "images": {"training": 2000, "validation": 500},
        "validation": {"clear": part, "adversity": part, "all": part},
        "onnx": {"bytes": 6_000_000, "largest_difference": 1e-5},
    }


def test_the_card_has_the_measures(tmp_path: Path) -> None:
    (tmp_path / "policy.onnx").write_bytes(b"x")
    (tmp_path / "curves.csv").write_text("seconds\n")
    (tmp_path / "metrics.json").write_text(json.dumps(metrics(["clear", "adversity"])))
    publish.publish(tmp_path, tmp_path, tmp_path / "card")
    card = (tmp_path / "card/README.md").read_text()
    assert "4,321 steps" in card and "1.50 million" in card and "{{" not in card
    assert "| 0.020 | 0.020 | 0.020 | 0.020 |" in card and "adversity, trained on clear only" in card
    with pytest.raises(KeyError):
        publish.filled("{{ unknown }}", {})


def test_a_failed_export_is_not_published(tmp_path: Path) -> None:
    (tmp_path / "metrics.json").write_text(json.dumps({**metrics(["clear"]), "onnx": {"bytes": 0, "error": "no opset"}}))
    with pytest.raises(ValueError, match="no opset"):
        publish.publish(tmp_path, None, tmp_path / "card")
