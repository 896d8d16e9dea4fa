"""Samples of the training: observations, goals and labels from the table of views and its images."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from .labels import MAX_STEPS, SPACING

MEAN, STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)  # of ImageNet


@dataclass(frozen=True)
class Sampling:
    """context: images before the current one; far: share of goals beyond MAX_STEPS, up to `farthest` steps; negative:
    share of goals that are elsewhere, at least `apart` [m] away; mixed: share of goals of another condition."""

    context: int = 3
    far: float = 0.15
    farthest: int = 30
    negative: float = 0.12
    apart: float = 3.0
    mixed: float = 0.3


@dataclass(frozen=True)
class Batch:
    """observation: (n, context + 1, 64, 85, 3) uint8, oldest first; goal: (n, 64, 85, 3) uint8; dist: (n,) steps;
    action: (n, 5, 4); positive: (n,) bool, false for goals elsewhere, whose action has no meaning; condition: (n,) of
    the observation; goal_condition: (n,)."""

    observation: Tensor
    goal: Tensor
    dist: Tensor
    action: Tensor
    positive: Tensor
    condition: Tensor
    goal_condition: Tensor


class Data:
    """All views on one device.

    Errors: OSError if a file is missing; ValueError if no place of `places` has images of the conditions.
    """

    def __init__(self, folder: Path, conditions: Sequence[str], places: Sequence[int], device: str) -> None:
        with np.load(folder / "routes.npz") as file:
            table = {name: file[name] for name in file.files}
        self.spacing = float(table["view_spacing"])
        rows, offset, images = len(table["place"]), 0, []
        place_of = np.full((len(conditions), rows), -1, np.int64)  # image of a view in each condition, -1: none
        for number, condition in enumerate(conditions):
            with np.load(folder / f"images_{condition}.npz") as file:
                keep = np.isin(table["place"][file["rows"]], list(places))
                images.append(torch.from_numpy(file["images"][keep]))
                mine = file["rows"][keep]
            place_of[number, mine] = offset + np.arange(len(mine))
            offset += len(mine)
        if offset == 0:
            raise ValueError(f"{folder} has no images of {', '.join(conditions)} of the places {list(places)}")
        self.images = torch.cat(images).to(device)
        self.image = torch.from_numpy(place_of).to(device)
        self.conditions, self.device = list(conditions), device
        self.anchors = torch.nonzero(self.image >= 0)  # (m, 2): condition, view
        self._table(table)

    def _table(self, table: dict[str, np.ndarray]) -> None:
        def tensor(values: np.ndarray) -> Tensor:
            return torch.from_numpy(np.ascontiguousarray(values)).to(self.device)

        place, route, drive = table["place"], table["route"].astype(np.int64), table["drive"]
        same = np.concatenate([[False], (route[1:] == route[:-1]) & (drive[1:] == drive[:-1])])
        index = np.arange(len(route))
        self.before = tensor(np.where(same, index - 1, index))  # the view before, on the same drive
        first, count = np.zeros(route.max() + 1, np.int64), np.zeros(route.max() + 1, np.int64)
        on_path = np.flatnonzero(drive == 0)
        first[route[on_path][::-1]] = on_path[::-1]  # of equal indices, the last assignment holds
        np.add.at(count, route[on_path], 1)
        self.first, self.count = tensor(first), tensor(count)  # views on the path of each route
        self.place, self.route = tensor(place.astype(np.int64)), tensor(route)
        self.along, self.position = tensor(table["along"]), tensor(table["pose"][:, :2])
        self.action = tensor(table["action"])

    def sample(self, count: int, generator: torch.Generator, sampling: Sampling) -> Batch:
        """A random batch. The generator is of this device."""

        def uniform() -> Tensor:
            return torch.rand(count, generator=generator, device=self.device)

        pick = self.anchors[(uniform() * len(self.anchors)).long().clamp(max=len(self.anchors) - 1)]
        condition, anchor = pick[:, 0], pick[:, 1]
        goal, dist = self._goals(anchor, uniform(), uniform() < sampling.far, sampling)
        other = (uniform() * len(self.conditions)).long().clamp(max=len(self.conditions) - 1)
        change = (uniform() < sampling.mixed) & (self.image[other, goal] >= 0)
        goal_condition = torch.where(change, other, condition)
        stray = self.anchors[(uniform() * len(self.anchors)).long().clamp(max=len(self.anchors) - 1)]
        gap = torch.linalg.vector_norm(self.position[stray[:, 1]] - self.position[anchor], dim=1)
        elsewhere = (self.place[stray[:, 1]] != self.place[anchor]) | (gap > sampling.apart)
        negative = (uniform() < sampling.negative) & elsewhere
        goal = torch.where(negative, stray[:, 1], goal)
        goal_condition = torch.where(negative, stray[:, 0], goal_condition)
        dist = torch.where(negative, torch.full_like(dist, float(MAX_STEPS)), dist)
        seen = [anchor]
        ratio = SPACING / self.spacing
        jitter = uniform()
        for steps in range(1, sampling.context + 1):
            # Observations are a step apart, views two: round to one of the views about the place.
            views = (steps * ratio + jitter - 0.5).round().long().clamp(min=0)
            seen.append(self._earlier(anchor, views))
        observation = torch.stack([self.images[self.image[condition, view]] for view in reversed(seen)], 1)
        image = self.images[self.image[goal_condition, goal]]
        return Batch(observation, image, dist, self.action[anchor], ~negative, condition, goal_condition)

    def _goals(self, anchor: Tensor, draw: Tensor, far: Tensor, sampling: Sampling) -> tuple[Tensor, Tensor]:
        """Views on the anchors' paths, 0 … MAX_STEPS (far: … farthest) steps ahead, and their distances."""
        steps = torch.where(far, MAX_STEPS + draw * (sampling.farthest - MAX_STEPS), draw * MAX_STEPS)
        route = self.route[anchor]
        wanted = ((self.along[anchor] + steps * SPACING) / self.spacing).round().long()
        goal = self.first[route] + torch.minimum(wanted.clamp(min=0), self.count[route] - 1)
        dist = ((self.along[goal] - self.along[anchor]) / SPACING).clamp(0, MAX_STEPS)
        return goal, dist

    def _earlier(self, view: Tensor, count: Tensor) -> Tensor:
        """The view `count` views before on the same drive; its first view where there are fewer."""
        for step in range(int(count.max()) if len(count) else 0):
            view = torch.where(count > step, self.before[view], view)
        return view


def normalised(images: Tensor) -> Tensor:
    """(n, k, 64, 85, 3) in 0 … 1 to the network's (n, 3 k, 64, 85)."""
    mean, std = (torch.tensor(values, device=images.device) for values in (MEAN, STD))
    scaled = (images - mean) / std
    return scaled.permute(0, 1, 4, 2, 3).flatten(1, 2)


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
