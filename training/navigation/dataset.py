"""Samples of the training: observations, goals and labels from the tables of routes.py and the images."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from .labels import MAX_STEPS, SPACING
from .matches import Sight

TURN = 0.15  # in five steps, from which a view counts as turning [rad]
MEAN, STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)  # of ImageNet


@dataclass(frozen=True)
class Sampling:
    """Shares of goals. crossing: any view whose image overlaps, instead of one on the anchor's path; turning: of these,
    from anchors that turn; far: on the path beyond MAX_STEPS, up to `farthest` steps; negative: elsewhere, at least
    `apart` [m] away; mixed: of another condition."""

    crossing: float = 0.5
    turning: float = 0.5
    far: float = 0.1
    farthest: int = 30
    negative: float = 0.1
    apart: float = 3.0
    mixed: float = 0.4


@dataclass(frozen=True)
class Batch:
    """observation, goal: (n, 64, 85, 3) uint8; dist: (n,) steps; action: (n, 5, 4); positive: (n,) bool, false for
    goals elsewhere or behind, whose action has no meaning; condition: (n,) of the observation; goal_condition: (n,);
    sights: geometry of both images."""

    observation: Tensor
    goal: Tensor
    dist: Tensor
    action: Tensor
    positive: Tensor
    condition: Tensor
    goal_condition: Tensor
    sights: tuple[Sight, Sight]


@dataclass(frozen=True)
class _Aim:
    """Anchors and their goals: condition, rows of the views, distance [steps], waypoints, whether these have a meaning."""

    condition: Tensor
    anchor: Tensor
    goal: Tensor
    dist: Tensor
    action: Tensor
    ahead: Tensor


class Data:
    """All views on one device.

    Errors: OSError if a file is missing; ValueError if no place of `places` has images of the conditions.
    """

    def __init__(self, folder: Path, conditions: Sequence[str], places: Sequence[int], device: str) -> None:
        with np.load(folder / "routes.npz") as file:
            table = {name: file[name] for name in file.files}
        self.spacing = float(table["view_spacing"])
        rows, offset = len(table["place"]), 0
        images: list[Tensor] = []
        depths: list[Tensor] = []
        place_of = np.full((len(conditions), rows), -1, np.int64)  # image of a view in each condition, -1: none
        for number, condition in enumerate(conditions):
            with np.load(folder / f"images_{condition}.npz") as file:
                keep = np.isin(table["place"][file["rows"]], list(places))
                images.append(torch.from_numpy(file["images"][keep]))
                depths.append(torch.from_numpy(file["depths"][keep]).half() / 1000)
                mine = file["rows"][keep]
            place_of[number, mine] = offset + np.arange(len(mine))
            offset += len(mine)
        if offset == 0:
            raise ValueError(f"{folder} has no images of {', '.join(conditions)} of the places {list(places)}")
        self.images, self.depths = torch.cat(images).to(device), torch.cat(depths).to(device)
        self.image = torch.from_numpy(place_of).to(device)
        self.conditions, self.device = list(conditions), device
        self.anchors = torch.nonzero(self.image >= 0)  # (m, 2): condition, view
        self._table(table)

    def _table(self, table: dict[str, np.ndarray]) -> None:
        def tensor(values: np.ndarray) -> Tensor:
            return torch.from_numpy(np.ascontiguousarray(values)).to(self.device)

        route = table["route"].astype(np.int64)
        first, count = np.zeros(route.max() + 1, np.int64), np.zeros(route.max() + 1, np.int64)
        on_path = np.flatnonzero(table["drive"] == 0)
        first[route[on_path][::-1]] = on_path[::-1]  # of equal indices, the last assignment holds
        np.add.at(count, route[on_path], 1)
        self.first, self.count = tensor(first), tensor(count)  # views on the path of each route
        self.place, self.route = tensor(table["place"].astype(np.int64)), tensor(route)
        self.along, self.position = tensor(table["along"]), tensor(table["pose"][:, :2])
        self.camera, self.rotation = tensor(table["camera"][:, :3]), _rotations(tensor(table["camera"][:, 3:]))
        self.action = tensor(table["action"])
        turn = torch.atan2(self.action[:, -1, 3], self.action[:, -1, 2]).abs()
        self.turning = self.anchors[turn[self.anchors[:, 1]] > TURN]
        self.pair_anchor = tensor(table["pair_anchor"].astype(np.int64))
        self.pair_goal = tensor(table["pair_goal"].astype(np.int64))
        self.pair_dist, self.pair_action = tensor(table["pair_dist"]), tensor(table["pair_action"])
        self.pair_ahead = tensor(table["pair_ahead"])
        seen = (self.image[:, self.pair_anchor] >= 0) & (self.image[:, self.pair_goal] >= 0)
        self.pairs = torch.nonzero(seen)  # (p, 2): condition, pair

    def sample(self, count: int, generator: torch.Generator, sampling: Sampling) -> Batch:
        """A random batch. The generator is of this device."""

        def is_drawn(share: float) -> Tensor:
            return torch.rand(count, generator=generator, device=self.device) < share

        ahead, across = self._ahead(count, generator, sampling), self._across(count, generator)
        aim = _chosen(is_drawn(sampling.crossing if len(self.pairs) else 0.0), across, ahead)
        other = self._draw(len(self.conditions), count, generator)
        change = is_drawn(sampling.mixed) & (self.image[other, aim.goal] >= 0)
        goal_condition = torch.where(change, other, aim.condition)
        stray = self.anchors[self._draw(len(self.anchors), count, generator)]
        gap = torch.linalg.vector_norm(self.position[stray[:, 1]] - self.position[aim.anchor], dim=1)
        elsewhere = (self.place[stray[:, 1]] != self.place[aim.anchor]) | (gap > sampling.apart)
        negative = is_drawn(sampling.negative) & elsewhere
        goal = torch.where(negative, stray[:, 1], aim.goal)
        goal_condition = torch.where(negative, stray[:, 0], goal_condition)
        dist = torch.where(negative, torch.full_like(aim.dist, float(MAX_STEPS)), aim.dist)
        seen, sought = self.image[aim.condition, aim.anchor], self.image[goal_condition, goal]
        sights = self._sight(seen, aim.anchor), self._sight(sought, torch.where(negative, stray[:, 1], aim.goal))
        return Batch(
            self.images[seen], self.images[sought], dist, aim.action, aim.ahead & ~negative, aim.condition, goal_condition, sights
        )

    def _sight(self, image: Tensor, view: Tensor) -> Sight:
        # Places have coordinates of their own: they are set apart, so that goals elsewhere match nothing.
        apart = self.place[view, None] * self.camera.new_tensor([0.0, 0.0, 1000.0])
        return Sight(self.depths[image].float(), self.camera[view] + apart, self.rotation[view])

    def _draw(self, below: int, count: int, generator: torch.Generator) -> Tensor:
        return (torch.rand(count, generator=generator, device=self.device) * below).long().clamp(max=max(below - 1, 0))

    def _ahead(self, count: int, generator: torch.Generator, sampling: Sampling) -> _Aim:
        """Views on the anchors' paths, 0 … MAX_STEPS (far: … farthest) steps ahead."""
        pick = self.anchors[self._draw(len(self.anchors), count, generator)]
        if len(self.turning):
            turns = torch.rand(count, generator=generator, device=self.device) < sampling.turning
            pick = torch.where(turns[:, None], self.turning[self._draw(len(self.turning), count, generator)], pick)
        condition, anchor = pick[:, 0], pick[:, 1]
        draw = torch.rand(count, generator=generator, device=self.device)
        far = torch.rand(count, generator=generator, device=self.device) < sampling.far
        steps = torch.where(far, MAX_STEPS + draw * (sampling.farthest - MAX_STEPS), draw * MAX_STEPS)
        route = self.route[anchor]
        wanted = ((self.along[anchor] + steps * SPACING) / self.spacing).round().long()
        goal = self.first[route] + torch.minimum(wanted.clamp(min=0), self.count[route] - 1)
        dist = ((self.along[goal] - self.along[anchor]) / SPACING).clamp(0, MAX_STEPS)
        return _Aim(condition, anchor, goal, dist, self.action[anchor], torch.ones_like(far))

    def _across(self, count: int, generator: torch.Generator) -> _Aim:
        """Pairs of views, of any drives."""
        if not len(self.pairs):
            none = torch.zeros(count, dtype=torch.long, device=self.device)
            return _Aim(none, none, none, none.float(), self.action[none], none.bool())
        pick = self.pairs[self._draw(len(self.pairs), count, generator)]
        condition, pair = pick[:, 0], pick[:, 1]
        dist = self.pair_dist[pair].clamp(0, MAX_STEPS)
        return _Aim(condition, self.pair_anchor[pair], self.pair_goal[pair], dist, self.pair_action[pair], self.pair_ahead[pair])


def _chosen(first: Tensor, yes: _Aim, no: _Aim) -> _Aim:
    condition, anchor, goal, dist, ahead = (
        torch.where(first, getattr(yes, name), getattr(no, name)) for name in ("condition", "anchor", "goal", "dist", "ahead")
    )
    return _Aim(condition, anchor, goal, dist, torch.where(first[:, None, None], yes.action, no.action), ahead)


def _rotations(quaternion: Tensor) -> Tensor:
    """(n, 3, 3) of unit quaternions (n, 4) w, x, y, z."""
    w, x, y, z = quaternion.unbind(1)
    rows = [
        *(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        *(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        *(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    ]
    return torch.stack(rows, 1).reshape(-1, 3, 3)


def normalised(images: Tensor) -> Tensor:
    """(n, 64, 85, 3) in 0 … 1 to the network's (n, 3, 64, 85)."""
    mean, std = (torch.tensor(values, device=images.device) for values in (MEAN, STD))
    return ((images - mean) / std).permute(0, 3, 1, 2)


def split(names: Sequence[str], every: int = 6) -> tuple[list[int], list[int]]:
    """Numbers of the places for training and for validation: of each kind, every sixth place, beginning with the third
    (for few places with the last), so that no image of a validation place is trained."""
    training, validation = [], []
    kinds = sorted({name.rsplit("_", 1)[0] for name in names})
    for kind in kinds:
        mine = [number for number, name in enumerate(names) if name.rsplit("_", 1)[0] == kind]
        held = mine[2::every] if len(mine) > 2 else mine[1:]
        validation += held
        training += [number for number in mine if number not in held]
    return sorted(training), sorted(validation)
