"""Training of the navigation policy: samples, images, network. Requires PyTorch."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

torch = pytest.importorskip("torch")

from training.navigation import augment, dataset, export, matches, measures, model, train  # noqa: E402


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three places of two routes with two drives of 20 views; each image has its row as its colour."""
    place, route, drive, step = (part.ravel() for part in np.meshgrid(range(3), range(2), range(2), range(20), indexing="ij"))
    count = len(place)
    along = (0.2 * step).astype(np.float32)
    pose = np.column_stack([along, 5.0 * route, np.zeros(count)]).astype(np.float32)
    action = np.tile(np.array([[k, 0.1 * k, 0.8, 0.6] for k in range(1, 6)], np.float32), (count, 1, 1))
    table = {"place": place, "route": 2 * place + route, "drive": drive, "along": along, "pose": pose, "action": action}
    # Each view is paired with the next one of its drive; the distance and the label tell pairs from goals on the path.
    anchor = np.flatnonzero(step < 19)
    table |= {"pair_anchor": anchor, "pair_goal": anchor + 1, "pair_dist": np.full(len(anchor), 3.0, np.float32)}
    table["pair_action"] = np.full((len(anchor), 5, 4), 7.0, np.float32)
    table["pair_ahead"] = np.ones(len(anchor), bool)
    upright = np.tile([0.5, 0.5, -0.5, -0.5], (count, 1))  # the camera looks along x
    table["camera"] = np.column_stack([pose[:, :2], np.full(count, 0.3), upright]).astype(np.float32)
    names = np.array([f"house_{number}" for number in range(3)])
    np.savez(tmp_path / "routes.npz", **table, names=names, view_spacing=np.float32(0.2))
    images = np.broadcast_to(np.arange(count, dtype=np.uint8)[:, None, None, None], (count, 64, 85, 3))
    depths = np.full((count, 64, 85), 3000, np.uint16)
    np.savez(tmp_path / "images_clear.npz", images=images, depths=depths, rows=np.arange(count))
    some = np.flatnonzero(place != 1)  # a scene that failed
    np.savez(tmp_path / "images_adversity.npz", images=images[some], depths=depths[some], rows=some)
    return tmp_path


def sample(folder: Path, conditions: list[str], sampling: dataset.Sampling, seed: int = 0) -> dataset.Batch:
    data = dataset.Data(folder, conditions, [0, 1, 2], "cpu")
    return data.sample(500, torch.Generator().manual_seed(seed), sampling)


def test_samples_are_on_the_path_and_within_bounds(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling(negative=0.0, crossing=0.0))
    anchor, goals = batch.observation[:, 0, 0, 0].long(), batch.goal[:, 0, 0, 0].long()
    assert bool((goals // 40 == anchor // 40).all()) and bool(((goals // 20) % 2 == 0).all()), "on the path of the route"
    wanted = (2.0 * (goals % 20 - anchor % 20)).clamp(0, 20)
    assert torch.allclose(batch.dist, wanted.float(), atol=1e-3)
    assert batch.dist.min() >= 0 and batch.dist.max() == 20
    assert bool(batch.positive.all())


def test_goals_across_are_pairs_with_their_own_labels(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling(negative=0.0, crossing=0.5))
    crossing = batch.action[:, 0, 0] == 7.0
    assert 0.4 < crossing.float().mean() < 0.6 and bool((batch.dist[crossing] == 3.0).all())
    anchor, goal = batch.observation[crossing, 0, 0, 0].long(), batch.goal[crossing, 0, 0, 0].long()
    assert bool((goal == anchor + 1).all())
    pairs = dataset.Data(folder, ["adversity"], [0, 1, 2], "cpu").pairs
    assert len(pairs) == 2 * 2 * 2 * 19, "the scene that failed has no pairs"


def test_negatives_are_elsewhere(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling(negative=1.0))
    anchor, goal = batch.observation[:, 0, 0, 0].long(), batch.goal[:, 0, 0, 0].long()
    away = ~batch.positive
    assert away.float().mean() > 0.7 and bool((batch.dist[away] == 20).all())
    other_place = anchor // 80 != goal // 80
    gap = torch.hypot(0.2 * (anchor % 20 - goal % 20), 5.0 * ((anchor // 40) % 2 - (goal // 40) % 2))
    assert bool((other_place | (gap > 3.0))[away].all())


def test_conditions_without_images_are_not_drawn(folder: Path) -> None:
    batch = sample(folder, ["clear", "adversity"], dataset.Sampling(negative=0.0, mixed=1.0))
    place = batch.observation[:, 0, 0, 0].long() // 80
    assert bool((batch.condition[place == 1] == 0).all()) and bool((batch.goal_condition[place == 1] == 0).all())
    assert set(batch.condition.tolist()) == {0, 1} and bool((batch.condition != batch.goal_condition).any())
    with pytest.raises(ValueError, match="no images"):
        dataset.Data(folder, ["adversity"], [1], "cpu")


def test_samples_follow_the_seed(folder: Path) -> None:
    first, again, other = (sample(folder, ["clear"], dataset.Sampling(), seed) for seed in (1, 1, 2))
    assert torch.equal(first.goal, again.goal) and torch.equal(first.dist, again.dist)
    assert not torch.equal(first.goal, other.goal)


def test_places_are_split_without_overlap() -> None:
    names = [f"house_{k}" for k in range(12)] + [f"warehouse_{k}" for k in range(6)]
    training, held = dataset.split(names)
    assert not set(training) & set(held) and len(training) + len(held) == 18 and held == [2, 8, 14]


def test_mirror_images_have_mirrored_labels(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling())
    batch.goal[:, :, 0] = 250
    flipped = augment.mirrored(batch, torch.ones(500, dtype=torch.bool))
    assert bool((flipped.goal[:, :, -1] == 250).all()) and not bool((flipped.goal[:, :, 0] == 250).all())
    assert torch.allclose(flipped.action[:, :, 1], -batch.action[:, :, 1])
    assert torch.equal(flipped.action[:, :, 0], batch.action[:, :, 0])
    kept = augment.mirrored(batch, torch.zeros(500, dtype=torch.bool))
    assert torch.equal(kept.goal, batch.goal) and torch.equal(kept.action, batch.action)


def test_changes_keep_shape_and_range() -> None:
    images = torch.randint(0, 256, (6, 64, 85, 3), dtype=torch.uint8)
    off = augment.Augmentation(0, 0, 0, 0, 0, 0, 0)
    same = augment.changed(images, torch.Generator().manual_seed(0), off)
    assert torch.allclose(same, images.float() / 255, atol=1e-4)
    made = augment.changed(images, torch.Generator().manual_seed(0), augment.Augmentation())
    assert made.shape == images.shape and made.min() >= 0 and made.max() <= 1 and (made - same).abs().mean() > 0.01
    flat = dataset.normalised(same)
    wanted = (images[:, :, :, 2].float() / 255 - dataset.MEAN[2]) / dataset.STD[2]
    assert flat.shape == (6, 3, 64, 85) and torch.allclose(flat[:, 2], wanted, atol=1e-3)


def test_network_has_the_shapes_of_gnm() -> None:
    policy = model.Policy().eval()
    dist, action = policy(torch.randn(2, 3, 64, 85), torch.randn(2, 3, 64, 85))
    assert dist.shape == (2, 1) and action.shape == (2, 5, 4)
    assert torch.allclose(action[:, :, 2:].norm(dim=2), torch.ones(2, 5), atol=1e-4)
    assert 1e6 < model.parameters_of(policy) < 2e6
    with pytest.raises(RuntimeError):
        policy(torch.randn(2, 9, 64, 85), torch.randn(2, 3, 64, 85))


def test_the_loss_ignores_waypoints_of_goals_elsewhere(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling(negative=1.0, crossing=0.0))
    exact = measures.loss(batch.dist[:, None], batch.action, batch, measures.Weights())
    assert float(exact) == pytest.approx(0, abs=1e-6)
    wrong = torch.where(batch.positive[:, None, None], batch.action, batch.action.flip(1) + 3)
    assert float(measures.loss(batch.dist[:, None], wrong, batch, measures.Weights())) == pytest.approx(0, abs=1e-6)
    off = batch.action + torch.tensor([1.0, 0, 0, 0])
    found = float(measures.loss(batch.dist[:, None], off, batch, measures.Weights()))
    assert found == pytest.approx(0.5 * 0.5 / 2.5**2), "half of alpha, half of the coordinates"


def test_goals_elsewhere_match_nothing(folder: Path) -> None:
    batch = sample(folder, ["clear"], dataset.Sampling(negative=1.0))
    here, there = batch.sights
    other_place = here.position[:, 2].round() != there.position[:, 2].round()
    assert other_place.any() and not bool(matches.matches(here, there).is_seen[other_place].any())


def test_training_steps_reduce_the_loss_and_follow_the_seed(folder: Path) -> None:
    def losses() -> list[float]:
        data = dataset.Data(folder, ["clear"], [0, 1], "cpu")
        trainer = train.Trainer(data, train.Settings(batch=16))
        return [float(trainer.step(0.1)) for _ in range(12)]

    first = losses()
    assert np.mean(first[-3:]) < np.mean(first[:3]) and first[:3] == pytest.approx(losses()[:3], rel=1e-4)


def test_weights_are_read_back(tmp_path: Path) -> None:
    policy = model.Policy().eval()
    report = export.write(policy, tmp_path)
    inputs = torch.randn(1, 3, 64, 85), torch.randn(1, 3, 64, 85)
    for a, b in zip(export.load(tmp_path / "weights.npz")(*inputs), policy(*inputs), strict=True):
        assert torch.equal(a, b)
    if "largest_difference" in report:
        assert report["largest_difference"] < 1e-3
