"""Losses of the training, and measures of a validation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn import functional

from .dataset import Batch, Data, Sampling, normalised
from .labels import MAX_STEPS, SPACING
from .matches import Matches, cell_depths, matches, relative_poses
from .model import Answer

Network = Callable[[Tensor, Tensor], tuple[Tensor, Tensor]]


@dataclass(frozen=True)
class Weights:
    """alpha: share of the distance in the loss, as in GNM; heading: of the cosine loss, relative to the waypoints;
    scale: of waypoints in the squared error [steps]; match, depth, pose: of the losses that teach geometry."""

    alpha: float = 0.5
    heading: float = 1.0
    scale: float = 2.5
    match: float = 0.1
    depth: float = 0.1
    pose: float = 0.2


def loss(dist: Tensor, action: Tensor, batch: Batch, weights: Weights) -> Tensor:
    """alpha MSE(dist / 20) + (1 - alpha) (MSE of waypoints + 1 - cos of headings), where goals are on the path."""
    distance = functional.mse_loss(dist[:, 0] / MAX_STEPS, batch.dist / MAX_STEPS)
    valid = batch.positive.float()
    place = ((action[:, :, :2] - batch.action[:, :, :2]) / weights.scale).square().mean((1, 2))
    heading = 1 - (action[:, :, 2:] * batch.action[:, :, 2:]).sum(2).mean(1)
    total = valid.sum().clamp(min=1)
    motion = ((place + weights.heading * heading) * valid).sum() / total
    return weights.alpha * distance + (1 - weights.alpha) * motion


def geometry_loss(answer: Answer, batch: Batch, weights: Weights) -> Tensor:
    """Loss of the cells that match (cross entropy), the depth of the cells (absolute error of the logarithm) and the
    relative pose of views that share a tenth of their cells (m, smooth absolute error)."""
    here, there = batch.sights
    forth, back = matches(here, there), matches(there, here)
    match = (_match_loss(answer.here_there, forth) + _match_loss(answer.there_here, back)) / 2
    depth = torch.zeros((), device=match.device)
    for estimate, sight in zip(answer.depths, batch.sights, strict=True):
        true = cell_depths(sight.depth)
        error = (estimate.float() - true.clamp(0.05, 40).log()).abs() * (true > 0)
        depth = depth + error.mean() / 2
    shared = (forth.is_seen.float().mean(1) > 0.1).float()
    gap = functional.smooth_l1_loss(answer.pose, relative_poses(here, there), reduction="none", beta=0.2).mean(1)
    pose = (gap * shared).sum() / shared.sum().clamp(min=1)
    return weights.match * match + weights.depth * depth + weights.pose * pose


def _match_loss(scores: Tensor, true: Matches) -> Tensor:
    share = functional.log_softmax(scores.float(), 2)
    found = -(share.gather(2, true.cells) * true.weights).sum(2)
    return torch.where(true.is_seen, found, -share[:, :, -1]).mean()


@torch.no_grad()
def validate(network: Network, data: Data, batches: int, size: int, seed: int = 0) -> dict[str, dict[str, float]]:
    """Measures on random samples without augmentation, by condition of the observation.

    dist_mae: of goals on the path [steps]; waypoint_m: mean distance of the waypoints from their labels [m];
    direction_cos: of the direction of the third waypoint; heading_cos; negative_dist: mean answer to goals elsewhere
    [steps]; goal_gain_m: by how much other goals of the batch increase waypoint_m, 0 if goals are ignored; samples.
    """
    generator = torch.Generator(data.device).manual_seed(seed)
    rows: list[Tensor] = []
    for _ in range(batches):
        batch = data.sample(size, generator, Sampling())
        observation, goal = normalised(batch.observation.float() / 255), normalised(batch.goal.float() / 255)
        dist, action = network(observation, goal)
        _, astray = network(observation, goal.roll(1, 0))
        gap = _gap(action, batch.action)
        label = batch.action[:, 2, :2]
        direction = functional.cosine_similarity(action[:, 2, :2], label, dim=1)
        heading = (action[:, :, 2:] * batch.action[:, :, 2:]).sum(2).mean(1)
        error = (dist[:, 0] - batch.dist).abs()
        columns = [batch.condition, batch.positive, error, gap, direction, heading, dist[:, 0]]
        rows.append(torch.stack([column.float() for column in (*columns, _gap(astray, batch.action) - gap)], 1).cpu())
    table = torch.cat(rows)
    parts = {name: table[table[:, 0] == number] for number, name in enumerate(data.conditions)}
    answer = {name: _means(part) for name, part in parts.items() if len(part)}
    return {**answer, "all": _means(table)} if len(data.conditions) > 1 else answer


def _gap(action: Tensor, label: Tensor) -> Tensor:
    return torch.linalg.vector_norm(action[:, :, :2] - label[:, :, :2], dim=2).mean(1) * SPACING


def _means(table: Tensor) -> dict[str, float]:
    here, away = table[table[:, 1] > 0], table[table[:, 1] == 0]
    names = ["dist_mae", "waypoint_m", "direction_cos", "heading_cos"]
    means = {name: float(here[:, 2 + number].mean()) for number, name in enumerate(names)}
    gain = {"negative_dist": float(away[:, 6].mean()), "goal_gain_m": float(here[:, 7].mean())}
    return {**{name: round(value, 4) for name, value in {**means, **gain}.items()}, "samples": float(len(table))}
