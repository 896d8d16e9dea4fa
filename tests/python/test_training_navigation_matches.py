"""Training of the navigation policy: cells of two images that match, and what the losses make of them. Requires PyTorch."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

torch = pytest.importorskip("torch")

from training.navigation import matches, measures, model  # noqa: E402

FOCAL = 32 / math.tan(math.radians(matches.FOVY) / 2)
AHEAD = torch.tensor([[[0.0, 0, -1], [-1, 0, 0], [0, 1, 0]]])  # a camera that looks along x with z up


def facing_a_wall(distance: float, aside: float = 0.0, turned: float = 0.0) -> matches.Sight:
    """A camera before the wall x = 3 m, `aside` to the left and turned to the left [rad]."""
    c, s = math.cos(turned), math.sin(turned)
    rotation = torch.tensor([[[c, -s, 0], [s, c, 0], [0, 0, 1.0]]]) @ AHEAD
    across = (torch.arange(85) - 42) / FOCAL  # right per ahead
    depth = (distance / (c + s * across)).expand(1, 64, 85)  # a ray is ahead + across * right = (c + s across) along x
    return matches.Sight(depth.contiguous(), torch.tensor([[3.0 - distance, aside, 0.3]]), rotation)


def pixels(found: matches.Matches) -> torch.Tensor:
    """(88, 2): columns and rows that the weighted cells stand for [px]."""
    rows, columns = found.cells // model.COLUMNS, found.cells % model.COLUMNS
    return torch.stack([(columns * found.weights).sum(2), (rows * found.weights).sum(2)], 2)[0] * model.CELL


def grid() -> torch.Tensor:
    rows, columns = torch.meshgrid(torch.arange(8) * 8.0, torch.arange(11) * 8.0, indexing="ij")
    return torch.stack([columns.flatten(), rows.flatten()], 1)


def test_an_image_matches_itself() -> None:
    found = matches.matches(facing_a_wall(2.0), facing_a_wall(2.0))
    assert bool(found.is_seen.all()) and torch.allclose(pixels(found), grid(), atol=1e-3)


def test_a_step_to_the_left_moves_the_wall_to_the_right() -> None:
    found = matches.matches(facing_a_wall(2.0), facing_a_wall(2.0, aside=0.4))
    moved = grid() + torch.tensor([0.4 * FOCAL / 2.0, 0])
    inside = moved[:, 0] <= 84
    assert torch.equal(found.is_seen[0], inside)
    kept = inside & (moved[:, 0] <= 80)  # beyond the last cell's middle there is no cell to the right
    assert torch.allclose(pixels(found)[kept], moved[kept], atol=1e-2)


def test_a_step_ahead_enlarges_the_wall() -> None:
    found = matches.matches(facing_a_wall(2.0), facing_a_wall(1.0))
    middle = torch.tensor([42.0, 31.5])
    larger = middle + 2 * (grid() - middle)
    inside = ((larger >= 0) & (larger <= 2 * middle)).all(1)
    assert torch.equal(found.is_seen[0], inside) and 10 < int(inside.sum()) < 44
    kept = inside & (larger[:, 0] <= 80) & (larger[:, 1] <= 56)
    assert torch.allclose(pixels(found)[kept], larger[kept], atol=1e-2)


def test_a_surface_behind_another_is_not_seen() -> None:
    there = facing_a_wall(2.0)
    there.depth[:, :, 43:] = 0.5  # a post before the right half
    found = matches.matches(facing_a_wall(2.0), there)
    assert torch.equal(found.is_seen[0], grid()[:, 0] < 43)
    assert not bool(matches.matches(matches.Sight(there.depth * 0, there.position, there.rotation), there).is_seen.any())


def test_mirror_images_match_in_mirrored_places() -> None:
    here, there = facing_a_wall(2.0), facing_a_wall(1.6, aside=0.2, turned=0.3)
    yes = torch.tensor([True])
    mirrored = [matches.mirrored_sight(sight, yes) for sight in (here, there)]
    other = [facing_a_wall(2.0), facing_a_wall(1.6, aside=-0.2, turned=-0.3)]
    assert torch.allclose(pixels(matches.matches(*mirrored)), pixels(matches.matches(*other)), atol=1e-2)
    kept = matches.mirrored_sight(here, ~yes)
    assert torch.equal(kept.rotation, here.rotation) and torch.equal(kept.depth, here.depth)


def test_relative_poses_are_ahead_and_left() -> None:
    found = matches.relative_poses(facing_a_wall(2.0), facing_a_wall(1.6, aside=0.2, turned=0.3))
    assert torch.allclose(found, torch.tensor([[0.4, 0.2, math.cos(0.3), math.sin(0.3)]]), atol=1e-5)
    back = matches.relative_poses(facing_a_wall(1.6, aside=0.2, turned=0.3), facing_a_wall(2.0))
    wanted = [-0.4 * math.cos(0.3) - 0.2 * math.sin(0.3), 0.4 * math.sin(0.3) - 0.2 * math.cos(0.3)]
    assert torch.allclose(back[0, :2], torch.tensor(wanted), atol=1e-5)


def test_the_geometry_loss_is_least_for_the_truth() -> None:
    here, there = facing_a_wall(2.0), facing_a_wall(1.7, aside=0.3)

    def scores(found: matches.Matches) -> torch.Tensor:
        made = torch.zeros(1, 88, 89).scatter_add(2, found.cells, found.weights)
        made = torch.where(found.is_seen[:, :, None], made, torch.eye(89)[-1])
        return (made + 1e-9).log()

    forth, back = scores(matches.matches(here, there)), scores(matches.matches(there, here))
    depths = tuple(matches.cell_depths(sight.depth).log() for sight in (here, there))
    batch = type("Batch", (), {"sights": (here, there)})()

    def loss(**changed: object) -> float:
        parts = {"dist": None, "action": None, "here_there": forth, "there_here": back, "depths": depths}
        parts["pose"] = matches.relative_poses(here, there)
        return float(measures.geometry_loss(model.Answer(**{**parts, **changed}), batch, measures.Weights()))

    least = loss()
    for changed in ({"here_there": back}, {"there_here": forth}, {"depths": depths[::-1]}, {"pose": torch.zeros(1, 4)}):
        assert loss(**changed) > least + 1e-3, changed.keys()
