"""Network of the navigation policy, with the inputs and outputs of GNM (Shah et al., arXiv:2210.03370)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from .labels import MAX_STEPS, WAYPOINTS

ROWS, COLUMNS = 8, 11  # of feature maps


@dataclass(frozen=True)
class Size:
    """widths: channels of the encoder at 1/2, 1/4 and 1/8 of the resolution; features: of the head; groups: of the
    normalisation, which makes no difference between training and one image at a time."""

    widths: tuple[int, int, int] = (24, 48, 96)
    features: int = 256
    groups: int = 8


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
    the goal image are in the current one, as in networks for optical flow (Dosovitskiy et al. 2015); the head turns them
    and the current features into distance and waypoints. Waypoints are sums of steps, as in GNM.
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
        self.key = nn.Conv2d(third, 64, 1)
        self.sharpness = nn.Parameter(torch.tensor(2.5))
        self.matches = _layer(ROWS * COLUMNS, 64, 1, 1, size.groups)
        self.joined = nn.Sequential(
            _layer(2 * third + 64 + 3, third, 3, 1, size.groups), Residual(third, size.groups), _layer(third, 48, 1, 1, size.groups)
        )
        self.head = nn.Sequential(
            nn.Flatten(), nn.Linear(48 * ROWS * COLUMNS, size.features), nn.SiLU(), nn.Linear(size.features, size.features), nn.SiLU()
        )
        self.dist = nn.Linear(size.features, 1)
        self.action = nn.Linear(size.features, 4 * WAYPOINTS)
        y, x = torch.meshgrid(torch.linspace(-1, 1, ROWS), torch.linspace(-1, 1, COLUMNS), indexing="ij")
        self.register_buffer("places", torch.stack([x.flatten(), y.flatten()], 1))  # (88, 2): x right, y down

    def forward(self, obs_img: Tensor, goal_img: Tensor) -> tuple[Tensor, Tensor]:
        """dist and action."""
        seen, sought = self.encoder(obs_img), self.encoder(goal_img)
        features = self.head(self.joined(torch.cat([seen, sought, *self._correlated(seen, sought)], 1)))
        raw = self.action(features).reshape(-1, WAYPOINTS, 4).float()
        places = torch.cumsum(raw[:, :, :2], 1)
        headings = functional.normalize(raw[:, :, 2:], dim=2, eps=1e-6)
        return self.dist(features).float() * MAX_STEPS, torch.cat([places, headings], 2)

    def _correlated(self, seen: Tensor, sought: Tensor) -> tuple[Tensor, Tensor]:
        """Maps over the current image: features of the correlations (n, 64, 8, 11), and the displacement of the matching
        part of the goal image with its certainty (n, 3, 8, 11)."""
        here = functional.normalize(self.key(seen).flatten(2), dim=1, eps=1e-4)  # (n, 64, 88)
        there = functional.normalize(self.key(sought).flatten(2), dim=1, eps=1e-4)
        similar = torch.matmul(here.transpose(1, 2), there)  # (n, 88 here, 88 there)
        share = torch.softmax(similar * torch.exp(self.sharpness), 2)
        move = torch.matmul(share, self.places.to(share.dtype)) - self.places.to(share.dtype)
        flow = torch.cat([move, share.amax(2, keepdim=True)], 2).transpose(1, 2).reshape(-1, 3, ROWS, COLUMNS)
        maps = similar.transpose(1, 2).reshape(-1, ROWS * COLUMNS, ROWS, COLUMNS)
        return self.matches(maps), flow


def parameters_of(policy: nn.Module) -> int:
    """Number of trained values."""
    return sum(value.numel() for value in policy.parameters())
