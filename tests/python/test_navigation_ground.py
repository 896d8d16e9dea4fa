"""Uneven ground: heights, slopes, water, and free space on it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest
from gloam.navigation.benchmark.episode import Touched
from gloam.navigation.benchmark.places import ROBOT
from gloam.navigation.free_space import free_space
from gloam.navigation.ground import DEEPEST, Ground, height_at

SIZE = 5.0  # half the side of the field [m]


def slope(degrees: float, water: float | None = None) -> Ground:
    """Ground that rises along x, 0 at the middle; water: z of a pond over all of it."""
    x = np.linspace(-SIZE, SIZE, 41)
    ponds = np.empty((0, 5)) if water is None else np.array([[-SIZE, -SIZE, SIZE, SIZE, water]])
    return Ground(np.array([-SIZE, -SIZE]), np.array([SIZE, SIZE]), np.tile(x * math.tan(math.radians(degrees)), (21, 1)), ponds)


def test_heights_are_bilinear_and_continue_at_the_edge() -> None:
    ground = slope(10)
    points = np.array([[0.0, 0.0], [1.23, -4.0], [-2.0, 3.3], [99.0, 0.0]])
    expected = np.clip(points[:, 0], -SIZE, SIZE) * math.tan(math.radians(10))
    assert ground.height(points) == pytest.approx(expected, abs=1e-12)
    assert ground.height(points.reshape(2, 2, 2)) == pytest.approx(expected.reshape(2, 2), abs=1e-12)
    assert height_at(ground, 1.0, 0.0) == pytest.approx(math.tan(math.radians(10))) and height_at(None, 1.0, 0.0) == 0.0


def test_steep_slopes_and_deep_water_are_hard() -> None:
    points = np.array([[-1.0, 0.0], [1.0, 2.0]])
    assert not slope(19).is_hard(points).any() and slope(21).is_hard(points).all()
    assert slope(5, water=DEEPEST).is_hard(points).tolist() == [True, False]
    assert not slope(0, water=0.9 * DEEPEST).is_hard(points).any()


def hill(folder: Path, degrees: float) -> gloam.World:
    """A field that rises along x by `degrees` [deg], with a box on the ground at (2, 1) and a fence around."""
    rise = 2 * SIZE * math.tan(math.radians(degrees))
    share = " ".join(str(k / 40) for _ in range(21) for k in range(41))
    box_z = (2.0 + SIZE) * math.tan(math.radians(degrees))
    (folder / "hill.xml").write_text(f"""<mujoco><asset>
      <hfield name="hill" nrow="21" ncol="41" size="{SIZE} {SIZE} {rise} 1" elevation="{share}"/></asset><worldbody>
      <geom name="ground" type="hfield" hfield="hill"/>
      <geom name="box" type="box" pos="2 1 {box_z}" size="0.3 0.3 0.3"/>
      <geom name="buried" type="box" pos="-2 -1 {3 * math.tan(math.radians(degrees)) - 0.5}" size="0.3 0.3 0.3"/>
      <geom name="branch" type="box" pos="0 3 {SIZE * math.tan(math.radians(degrees)) + 1.5}" size="0.3 0.3 0.3"/>
      </worldbody></mujoco>""")
    tables: dict[str, Any] = {"scene": {"name": "hill"}, "environment": {"file": "hill.xml"}}
    return gloam.Scene.from_dict(tables, folder=folder).compile()


def test_free_space_follows_the_ground(tmp_path: Path) -> None:
    world = hill(tmp_path, 15)
    ground = Ground.of(world)
    assert ground is not None and ground.height(np.array([[-SIZE, 0.0], [SIZE, 0.0], [0.0, 4.0]])) == pytest.approx(
        np.array([0.0, 2, 1]) * SIZE * math.tan(math.radians(15)), abs=1e-3
    )
    grid = free_space(world, (), 0.2)
    assert grid.are_free([[-4.5, 0.0], [4.5, 0.0], [-2.0, -1.0], [0.0, 3.0]]).all(), "low and high ground, buried and above"
    assert not grid.is_free([2.0, 1.0]) and not grid.is_free([2.45, 1.0]) and grid.is_free([2.6, 1.0])
    with pytest.raises(gloam.UsageError, match="no free space"):
        free_space(hill(tmp_path, 25), (), 0.2)


class _Sim:
    """A simulation's side of Touched: one contact."""

    time = 0.0

    def __init__(self, z: float) -> None:
        self._z = z

    def contacts(self) -> list[gloam.Contact]:
        place, forward = np.array([1.0, 0.0, self._z]), np.array([1.0, 0.0, 0.0])
        return [gloam.Contact((f"{ROBOT}/trunk", "rock_1/c"), place, forward, 0.0, forward, np.zeros(3))]


def test_contacts_are_low_above_the_ground() -> None:
    height = height_at(slope(15), 1.0, 0.0)
    for z, count in ((height + 0.02, 0), (height + 0.1, 1)):
        touched = Touched(slope(15))
        touched.sample(_Sim(z))  # type: ignore[arg-type]
        assert touched.total() == count
