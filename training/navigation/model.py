"""Network of the navigation policy, with the inputs and outputs of GNM (Shah et al., arXiv:2210.03370)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from .labels import MAX_STEPS, WAYPOINTS

CELL = 8  # pixels per cell of feature maps
ROWS, COLUMNS = 8, 11  # of feature maps


@dataclass(frozen=True)
class Size:
    """widths: channels of the encoder at 1/2, 1/4 and 1/8 of the resolution; keys: of the features that are compared;
    joined: channels of the maps behind the comparison; features: of the head; groups: of the normalisation, which makes
    no difference between training and one image at a time."""

    widths: tuple[int, int, int] = (24, 48, 96)
    keys: int = 64
    joined: int = 64
    features: int = 256
    groups: int = 8


@dataclass(frozen=True)
class Answer:
    """dist: (n, 1) [steps]; action: (n, 5, 4). The other fields serve the training only. here_there, there_here: (n, 88, 89)
    scores of the cells of the other image for every cell, the last one of none; depths: of the cells of both images
    (n, 88), logarithms of metres; pose: (n, 4) as matches.relative_poses."""

    dist: Tensor
    action: Tensor
    here_there: Tensor
    there_here: Tensor
    depths: tuple[Tensor, Tensor]
    pose: Tensor


def _layer(inputs: int, outputs: int, kernel: int, stride: int, groups: int) -> nn.Sequential:
    convolution = nn.Conv2d(inputs, outputs, kernel, stride, kernel // 2, bias=False)
    return nn.Sequential(convolution, nn.GroupNorm(groups, outputs), nn.SiLU())


class Residual(nn.Module):
    """Two convolutions of 3x3 around which the input is added (He et al. 2016)."""

    def __init__(self, width: int, groups: int) -> None:
        super().__init__()
        self.body = nn.Sequential(
            _layer(width, width, 3, 1, groups), nn.Conv2d(width, width, 3, 1, 1, bias=False), nn.GroupNorm(groups, width)
        )

    def forward(self, image: Tensor) -> Tensor:
        """The same shape."""
        return functional.silu(image + self.body(image))


class Policy(nn.Module):
    """obs_img and goal_img (n, 3, 64, 85), normalised as for ImageNet, to dist (n, 1) [steps] and action (n, 5, 4): x, y
    in units of labels.SPACING, cos, sin, in the robot's frame.

    One encoder serves both images. Correlations of all features of one image with all of the other show where parts of
    the goal image are in the current one, as in networks for optical flow (Dosovitskiy et al. 2015). The head turns them,
    estimates of depth and the features into distance and waypoints. Waypoints are sums of steps, as in GNM.
    """

    def __init__(self, size: Size | None = None) -> None:
        super().__init__()
        size = size or Size()
        first, second, third = size.widths
        self.encoder = nn.Sequential(
            _layer(3, first, 5, 2, size.groups),
            _layer(first, second, 3, 2, size.groups),
            Residual(second, size.groups),
            _layer(second, third, 3, 2, size.groups),
            Residual(third, size.groups),
            Residual(third, size.groups),
        )
        self.key = nn.Conv2d(third, size.keys, 1)
        self.depth = nn.Conv2d(third, 1, 1)
        self.sharpness = nn.Parameter(torch.tensor(2.5))  # logarithm of the scale of similarities
        self.none = nn.Parameter(torch.tensor(3.0))  # score of no match
        self.matches = _layer(ROWS * COLUMNS, size.joined, 1, 1, size.groups)
        self.reduced = _layer(third, size.joined // 2, 1, 1, size.groups)
        self.joined = nn.Sequential(
            _layer(2 * size.joined + 5, size.joined, 3, 1, size.groups),
            Residual(size.joined, size.groups),
            _layer(size.joined, 48, 1, 1, size.groups),
        )
        self.head = nn.Sequential(
            nn.Flatten(), nn.Linear(48 * ROWS * COLUMNS, size.features), nn.SiLU(), nn.Linear(size.features, size.features), nn.SiLU()
        )
        self.dist = nn.Linear(size.features, 1)
        self.action = nn.Linear(size.features, 4 * WAYPOINTS)
        self.pose = nn.Linear(size.features, 4)
        y, x = torch.meshgrid(torch.linspace(-1, 1, ROWS), torch.linspace(-1, 1, COLUMNS), indexing="ij")
        self.register_buffer("places", torch.stack([x.flatten(), y.flatten()], 1))  # (88, 2): x right, y down

    def forward(self, obs_img: Tensor, goal_img: Tensor) -> tuple[Tensor, Tensor]:
        """dist and action."""
        answer = self.answer(obs_img, goal_img)
        return answer.dist, answer.action

    def answer(self, obs_img: Tensor, goal_img: Tensor) -> Answer:
        """All outputs."""
        seen, sought = self.encoder(obs_img), self.encoder(goal_img)
        here, there = (functional.normalize(self.key(part).flatten(2), dim=1, eps=1e-4) for part in (seen, sought))
        similar = torch.matmul(here.transpose(1, 2), there)  # (n, 88 here, 88 there)
        here_there, there_here = self._scores(similar), self._scores(similar.transpose(1, 2))
        depths = self.depth(seen).flatten(1), self.depth(sought).flatten(1)
        compared = [self.matches(_map(similar.transpose(1, 2))), self._flow(here_there, depths)]
        features = self.head(self.joined(torch.cat([self.reduced(seen), self.reduced(sought), *compared], 1)))
        raw = self.action(features).reshape(-1, WAYPOINTS, 4).float()
        headings = functional.normalize(raw[:, :, 2:], dim=2, eps=1e-6)
        action = torch.cat([torch.cumsum(raw[:, :, :2], 1), headings], 2)
        dist, pose = self.dist(features).float() * MAX_STEPS, self.pose(features).float()
        return Answer(dist, action, here_there, there_here, depths, pose)

    def _scores(self, similar: Tensor) -> Tensor:
        none = self.none.to(similar.dtype).expand(similar.shape[0], similar.shape[1], 1)
        return torch.cat([similar * torch.exp(self.sharpness), none], 2)

    def _flow(self, scores: Tensor, depths: tuple[Tensor, Tensor]) -> Tensor:
        """(n, 5, 8, 11): displacement of the matching part of the goal image, the certainty that there is one, the depth
        here and there."""
        share = torch.softmax(scores, 2)[:, :, :-1]
        certain = share.sum(2, keepdim=True)
        places = self.places.to(share.dtype)
        move = torch.matmul(share, places) - certain * places
        there = torch.matmul(share, depths[1][:, :, None].to(share.dtype))
        return _map(torch.cat([move, certain, depths[0][:, :, None].to(share.dtype), there], 2).transpose(1, 2))


def _map(columns: Tensor) -> Tensor:
    return columns.reshape(-1, columns.shape[1], ROWS, COLUMNS)


def parameters_of(policy: nn.Module) -> int:
    """Number of trained values."""
    return sum(value.numel() for value in policy.parameters())
