"""Network of the navigation policy, with the inputs and outputs of GNM (Shah et al., arXiv:2210.03370)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from .labels import MAX_STEPS, WAYPOINTS


@dataclass(frozen=True)
class Size:
    """context: images before the current one; widths: channels of the stages, each at half the resolution of the one
    before; blocks: per stage; features: of each encoder and of the fusion; groups: of the normalisation."""

    context: int = 3
    widths: tuple[int, ...] = (32, 64, 128, 256)
    blocks: int = 2
    features: int = 256
    groups: int = 8


class Block(nn.Module):
    """Residual depthwise-separable convolution (Chollet 2017), expanded twofold as in Sandler et al. 2018."""

    def __init__(self, inputs: int, outputs: int, stride: int, groups: int) -> None:
        super().__init__()
        inner = 2 * inputs
        self.body = nn.Sequential(
            nn.Conv2d(inputs, inner, 1, bias=False),
            nn.GroupNorm(groups, inner),
            nn.SiLU(inplace=True),
            nn.Conv2d(inner, inner, 3, stride, 1, groups=inner, bias=False),
            nn.GroupNorm(groups, inner),
            nn.SiLU(inplace=True),
            nn.Conv2d(inner, outputs, 1, bias=False),
            nn.GroupNorm(groups, outputs),
        )
        self.skips = stride == 1 and inputs == outputs

    def forward(self, image: Tensor) -> Tensor:
        """(n, inputs, h, w) to (n, outputs, h / stride, w / stride)."""
        out: Tensor = self.body(image)
        return image + out if self.skips else out


class Encoder(nn.Module):
    """Images (n, channels, 64, 85) to features (n, features). The place of what it sees is kept: no global pooling."""

    def __init__(self, channels: int, size: Size) -> None:
        super().__init__()
        layers: list[nn.Module] = [nn.Conv2d(channels, size.widths[0], 5, 2, 2, bias=False)]
        layers += [nn.GroupNorm(size.groups, size.widths[0]), nn.SiLU(inplace=True)]
        before = size.widths[0]
        for stage, width in enumerate(size.widths):
            for block in range(size.blocks):
                layers.append(Block(before, width, 2 if block == 0 and stage > 0 else 1, size.groups))
                before = width
        layers += [nn.Conv2d(before, 32, 1), nn.SiLU(inplace=True), nn.Flatten()]
        self.body = nn.Sequential(*layers)
        self.out = nn.Linear(32 * 4 * 6, size.features)

    def forward(self, image: Tensor) -> Tensor:
        """Features before their activation."""
        features: Tensor = self.out(self.body(image))
        return features


class Policy(nn.Module):
    """obs_img (n, 3 (context + 1), 64, 85), the oldest first, and goal_img (n, 3, 64, 85), normalised as for ImageNet,
    to dist (n, 1) [steps] and action (n, 5, 4): x, y in units of labels.SPACING, cos, sin, in the robot's frame.

    As in GNM, the goal's encoder also sees the observations, and waypoints are sums of the steps before them.
    """

    def __init__(self, size: Size | None = None) -> None:
        super().__init__()
        size = size or Size()
        self.size = size
        channels = 3 * (size.context + 1)
        self.observation = Encoder(channels, size)
        self.goal = Encoder(channels + 3, size)
        self.fusion = nn.Sequential(
            nn.SiLU(), nn.Linear(2 * size.features, size.features), nn.SiLU(), nn.Linear(size.features, size.features)
        )
        self.dist = nn.Sequential(nn.SiLU(), nn.Linear(size.features, 1))
        self.action = nn.Sequential(nn.SiLU(), nn.Linear(size.features, 4 * WAYPOINTS))

    def forward(self, obs_img: Tensor, goal_img: Tensor) -> tuple[Tensor, Tensor]:
        """dist and action."""
        seen, sought = self.observation(obs_img), self.goal(torch.cat([obs_img, goal_img], 1))
        features = self.fusion(torch.cat([seen, sought], 1))
        raw = self.action(features).reshape(-1, WAYPOINTS, 4).float()
        places = torch.cumsum(raw[:, :, :2], 1)
        headings = functional.normalize(raw[:, :, 2:], dim=2, eps=1e-6)
        return self.dist(features).float() * MAX_STEPS, torch.cat([places, headings], 2)


def parameters_of(policy: nn.Module) -> int:
    """Number of trained values."""
    return sum(value.numel() for value in policy.parameters())
