"""Parts of two images that show the same surface, from depth images and the poses of the cameras.

Gloam renders depth with every image, so the training knows the correspondences which networks for real images have to
find by themselves. A cell (r, c) of the network's feature maps lies around the pixel (8 r, 8 c).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn import functional

from .model import CELL, COLUMNS, ROWS
from .scenes import FOVY

TOLERANCE = 0.1  # of a depth by which a surface counts as the same one
FARTHEST = 40.0  # of surfaces that count [m]


@dataclass(frozen=True)
class Sight:
    """Geometry of n images. depth: (n, h, w) along the axis [m], 0 where there is no surface; position: (n, 3) [m] and
    rotation: (n, 3, 3) of the camera in the world; it looks along its -z with y up, as in MJCF."""

    depth: Tensor
    position: Tensor
    rotation: Tensor


@dataclass(frozen=True)
class Matches:
    """cells: (n, 88, 4) the cells of the other image around the point that a cell shows; weights: (n, 88, 4) of them, by
    bilinear interpolation; is_seen: (n, 88) whether the other image shows that point."""

    cells: Tensor
    weights: Tensor
    is_seen: Tensor


def mirrored_sight(sight: Sight, mirror: Tensor) -> Sight:
    """The geometry of mirror images where `mirror` (n,) is true: that of the world with -y for y."""
    world = torch.where(mirror[:, None], sight.position.new_tensor([1.0, -1.0, 1.0]), 1.0)
    camera = torch.where(mirror[:, None], sight.position.new_tensor([-1.0, 1.0, 1.0]), 1.0)
    rotation = world[:, :, None] * sight.rotation * camera[:, None, :]
    depth = torch.where(mirror[:, None, None], sight.depth.flip(2), sight.depth)
    return Sight(depth, sight.position * world, rotation)


def cell_depths(depth: Tensor) -> Tensor:
    """(n, 88): depth at the cells [m]."""
    return depth[:, ::CELL, ::CELL].flatten(1)


def matches(here: Sight, there: Sight) -> Matches:
    """Where the points that the cells of `here` show are in the images of `there`."""
    height, width = here.depth.shape[1:]
    focal = height / 2 / math.tan(math.radians(FOVY) / 2)
    middle = here.depth.new_tensor([(width - 1) / 2, (height - 1) / 2])
    # 1. The cells' points in the frame of the other camera.
    rows, columns = torch.meshgrid(torch.arange(ROWS) * CELL, torch.arange(COLUMNS) * CELL, indexing="ij")
    pixels = torch.stack([columns.flatten(), rows.flatten()], 1).to(middle)
    across = (pixels - middle) / focal
    depth = cell_depths(here.depth)
    rays = torch.stack([across[:, 0], -across[:, 1], -torch.ones_like(across[:, 0])], 1)
    world = torch.einsum("nij,nkj->nki", here.rotation, depth[:, :, None] * rays) + here.position[:, None]
    point = torch.einsum("nji,nkj->nki", there.rotation, world - there.position[:, None])
    # 2. Their pixels, and whether the other camera sees that surface there.
    ahead = -point[:, :, 2]
    scale = focal / ahead.clamp(min=1e-3)
    place = torch.stack([point[:, :, 0] * scale, -point[:, :, 1] * scale], 2) + middle
    size = middle * 2
    inside = ((place >= 0) & (place <= size)).all(2) & (ahead > 0.1) & (depth > 0) & (depth < FARTHEST)
    grid = (place / size * 2 - 1).clamp(-2, 2)[:, None]
    found = functional.grid_sample(there.depth[:, None], grid, mode="nearest", align_corners=True)[:, 0, 0]
    is_seen = inside & ((found - ahead).abs() <= TOLERANCE * ahead)
    # 3. The four cells around.
    last = place.new_tensor([COLUMNS - 1.0, ROWS - 1.0])
    cell = torch.minimum((place / CELL).clamp(min=0), last)
    low = torch.minimum(cell.floor(), last - 1)
    share = cell - low
    sides = torch.stack([1 - share, share], 3)  # (n, 88, axis, low or high)
    weights = sides[:, :, 1, :, None] * sides[:, :, 0, None, :]
    first = low[:, :, 1] * COLUMNS + low[:, :, 0]
    offsets = first.new_tensor([0, 1, COLUMNS, COLUMNS + 1])
    return Matches((first[:, :, None] + offsets).long(), weights.flatten(2), is_seen)


def relative_poses(here: Sight, there: Sight) -> Tensor:
    """(n, 4): place of the cameras of `there` ahead and left of those of `here` [m], cosine and sine of their yaw."""
    offset = torch.einsum("nji,nj->ni", here.rotation, there.position - here.position)
    axis = torch.einsum("nji,nj->ni", here.rotation, -there.rotation[:, :, 2])
    level = functional.normalize(torch.stack([-axis[:, 2], -axis[:, 0]], 1), dim=1, eps=1e-6)
    return torch.cat([-offset[:, 2:], -offset[:, :1], level], 1)
