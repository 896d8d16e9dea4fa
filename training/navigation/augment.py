"""Random changes of images and mirror images, on the device of the images."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import torch
from torch import Tensor
from torch.nn import functional

from .dataset import Batch
from .matches import mirrored_sight


@dataclass(frozen=True)
class Augmentation:
    """Ranges. gain: of brightness, as a power of two; tint: of each channel, likewise; contrast: relative; shift: share
    of the image; noise: standard deviation, of 0 … 1; blur, erase: share of the images."""

    gain: float = 0.7
    tint: float = 0.12
    contrast: float = 0.25
    shift: float = 0.03
    noise: float = 0.02
    blur: float = 0.25
    erase: float = 0.25


def mirrored(batch: Batch, mirror: Tensor) -> Batch:
    """The batch with left and right exchanged where `mirror` (n,) is true."""
    sign = torch.where(mirror, -1.0, 1.0)[:, None]
    action = batch.action.clone()
    action[:, :, 1] *= sign
    action[:, :, 3] *= sign
    is_mirrored = mirror[:, None, None, None]
    observation = torch.where(is_mirrored, batch.observation.flip(2), batch.observation)
    goal = torch.where(is_mirrored, batch.goal.flip(2), batch.goal)
    here, there = batch.sights
    sights = mirrored_sight(here, mirror), mirrored_sight(there, mirror)
    return replace(batch, observation=observation, goal=goal, action=action, sights=sights)


def changed(images: Tensor, generator: torch.Generator, ranges: Augmentation) -> Tensor:
    """Images (n, h, w, 3) uint8 as 0 … 1 floats with random light, shift, blur, noise and erased boxes."""
    count, height, width, _ = images.shape

    def uniform(*shape: int) -> Tensor:
        return 2 * torch.rand((count, *shape), generator=generator, device=images.device) - 1

    x = images.permute(0, 3, 1, 2).float() / 255
    x = x * torch.exp2(ranges.gain * uniform(1, 1, 1) + ranges.tint * uniform(3, 1, 1))
    middle = x.mean((1, 2, 3), keepdim=True)
    x = (middle + (x - middle) * (1 + ranges.contrast * uniform(1, 1, 1))).clamp(0, 1)
    move = torch.zeros(count, 2, 3, device=images.device)
    scale = 1 + ranges.shift * uniform()
    move[:, 0, 0], move[:, 1, 1] = scale, scale
    move[:, :, 2] = ranges.shift * uniform(2)
    grid = functional.affine_grid(move, [count, 3, height, width], align_corners=False)
    x = functional.grid_sample(x, grid, padding_mode="border", align_corners=False)
    soft = functional.avg_pool2d(functional.pad(x, (1, 1, 1, 1), mode="replicate"), 3, 1)
    x = torch.where((uniform(1, 1, 1) * 0.5 + 0.5) < ranges.blur, soft, x)
    x = x * _kept(uniform, height, width, ranges.erase)
    noise = torch.randn(x.shape, generator=generator, device=images.device) * ranges.noise
    x = (x + noise * (uniform(1, 1, 1) * 0.5 + 0.5)).clamp(0, 1)
    return x.permute(0, 2, 3, 1)


def _kept(uniform: Callable[..., Tensor], height: int, width: int, share: float) -> Tensor:
    """1 outside a random box, 0 inside, (n, 1, h, w); no box in 1 - share of the samples."""
    middle, half = uniform(2), (uniform(2) * 0.5 + 0.5) * 0.3 + 0.05
    half = torch.where((uniform(1) * 0.5 + 0.5) < share, half, torch.zeros_like(half))
    y = torch.linspace(-1, 1, height, device=middle.device)
    x = torch.linspace(-1, 1, width, device=middle.device)
    inside_y = (y[None] - middle[:, :1]).abs() < half[:, :1]
    inside_x = (x[None] - middle[:, 1:]).abs() < half[:, 1:]
    return 1.0 - (inside_y[:, :, None] & inside_x[:, None, :]).float()[:, None]
