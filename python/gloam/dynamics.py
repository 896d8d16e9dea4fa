"""Masses, friction, gains, armature and damping that change while a simulation runs, as logged inputs."""
from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import UsageError

if TYPE_CHECKING:
    from .simulation import Simulation

_AFFINE = 1  # mjGAIN_AFFINE, mjBIAS_AFFINE; below it: fixed, none
QUANTITIES = ("mass", "friction", "gains", "armature", "damping")
Doubles = NDArray[np.float64]
Ids = NDArray[np.intp]
_WIDTH = {"geom_friction": 3, "actuator_gain": 10, "actuator_bias": 10}  # numbers of an element; else one


class Dynamics:
    """Factors of the values in the files, for a whole model or for one robot."""

    def __init__(self, sim: Simulation, root: int | None = None, actuators: Sequence[int] | None = None) -> None:
        self._sim = sim
        bodies = _bodies_below(sim.memory.array("body_parentid"), root)
        geom_bodies = sim.memory.array("geom_bodyid")
        self._bodies = bodies
        self._geoms = np.arange(len(geom_bodies)) if root is None else np.flatnonzero(np.isin(geom_bodies, bodies))
        self._dofs = np.flatnonzero(np.isin(sim.memory.array("dof_bodyid"), bodies))
        self._actuators = np.arange(len(sim.memory.array("actuator_trntype"))) if actuators is None else np.array(actuators, dtype=np.intp)

    @property
    def counts(self) -> dict[str, int]:
        """How many elements have each quantity."""
        return {"mass": len(self._bodies), "friction": len(self._geoms), "gains": len(self._actuators), "armature": len(self._dofs),
                "damping": len(self._dofs)}

    def scale(self, *, mass: ArrayLike | None = None, friction: ArrayLike | None = None, gains: ArrayLike | None = None,
              armature: ArrayLike | None = None, damping: ArrayLike | None = None) -> None:
        """See Simulation.scale_dynamics(). Raises UsageError: a factor that is not positive and finite, another number of them, gains of muscles."""
        if gains is not None:
            self._check_gains()
        fields = (("mass", "body_mass", mass, self._bodies), ("friction", "geom_friction", friction, self._geoms),
                  ("gains", "actuator_gain", gains, self._actuators), ("gains", "actuator_bias", gains, self._actuators),
                  ("armature", "dof_armature", armature, self._dofs), ("damping", "dof_damping", damping, self._dofs))
        checked = [(field, ids, _factors(what, given, len(ids))) for what, field, given, ids in fields if given is not None]
        for field, ids, factors in checked:
            self._scale(field, ids, factors)

    def _scale(self, field: str, ids: Ids, factors: Doubles) -> None:
        nominal: Doubles = np.asarray(self._sim._core_world.live_field(field), dtype=np.float64)
        width = _WIDTH.get(field, 1)
        values = nominal.reshape(-1, width)[ids] * factors[:, None]
        for first, end in _runs(ids):
            self._sim.set_live_field(field, values[first:end].ravel(), int(ids[first]) * width)

    def _check_gains(self) -> None:
        memory = self._sim.memory
        gains, biases = memory.array("actuator_gaintype")[self._actuators], memory.array("actuator_biastype")[self._actuators]
        for actuator, gain, bias in zip(self._actuators, gains, biases, strict=True):
            if gain > _AFFINE or bias > _AFFINE:
                name = self._sim.world.actuators[actuator]
                raise UsageError(f"gains: actuator '{name}' is a muscle or has a law of its own, which cannot be scaled",
                                 hint='set its parameters with set_live_field("actuator_gain", …)')


def _bodies_below(parents: Any, root: int | None) -> Ids:
    """The body `root` and all that hang from it; None = all but the world."""
    if root is None:
        return np.arange(1, len(parents))
    below = np.zeros(len(parents), dtype=np.bool_)
    below[root] = True
    for body in range(root + 1, len(parents)):  # parents come first
        below[body] |= below[parents[body]]
    return np.flatnonzero(below)


def _runs(ids: Ids) -> list[tuple[int, int]]:
    """Places [first, end) at which the ids follow one another."""
    cuts = [0, *(np.flatnonzero(np.diff(ids) != 1) + 1).tolist(), len(ids)]
    return [(first, end) for first, end in itertools.pairwise(cuts) if end > first]


def _factors(what: str, given: ArrayLike, count: int) -> Doubles:
    factors = np.asarray(given, dtype=np.float64)
    if not (np.isfinite(factors).all() and (factors > 0).all()):
        raise UsageError(f"{what}: a factor must be a positive number, got {given!r}")
    if factors.ndim == 0:
        return np.full(count, float(factors))
    if factors.shape != (count,):
        raise UsageError(f"{what}: got {factors.size} factors for {count} elements", hint="a single number applies to all of them")
    return factors
