"""Policies: networks in ONNX files that control robots (docs/policies.md).

policy = gloam.Policy("walk.onnx", "walk.toml")     # the TOML only if the file's metadata is incomplete
drive = policy.attach(sim, "go2")
drive.command(vx=0.5)
sim.run_until(time=5)
"""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._policy.driver import PolicyDriver
from ._policy.metadata import merge, settings_of
from ._policy.network import Network
from ._policy.spec import PolicySpec, Term, build_spec
from ._policy.terms import TERMS, TermInfo
from .errors import DivergedError, InputError, IoError, UsageError

if TYPE_CHECKING:
    from .elements import Robot
    from .simulation import Simulation

PathLike = str | os.PathLike[str]


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise IoError(f"cannot be read: {error.strerror}", str(path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"is not valid TOML: {error}", str(path)) from None


def read_policy_metadata(path: PathLike) -> dict[str, Any]:
    """Reads the metadata of an ONNX file, as {"policy": {...}, "observation": [...]} in the form of a policy's TOML.

    Empty unless the metadata is from mjlab or holosoma. Raises the same errors as Policy.
    """
    return settings_of(Network(Path(path)).metadata, str(path))


class Policy:
    """A network and the specification of its training, `spec`. One thread, f32, on the CPU: the same observation
    gives the same action.

    `settings`: a TOML whose keys replace keys of the file's metadata. Raises ImportError: no package openvino;
    IoError: no such file; InputError: not a network, a malformed TOML, terms that do not fill the network's input,
    missing metadata; UnsupportedError: several inputs.
    """

    def __init__(self, path: PathLike, settings: PathLike | None = None) -> None:
        self.path = Path(path).absolute()
        self.settings = None if settings is None else Path(settings).absolute()
        self._network = Network(self.path)
        place = str(self.settings or self.path)
        known = settings_of(self._network.metadata, str(self.path))
        if self.settings is not None:
            known = merge(known, _read_toml(self.settings), place)
        self.spec: PolicySpec = build_spec(known, place)
        self._check_sizes(place)

    def _check_sizes(self, place: str) -> None:
        spec, network = self.spec, self._network
        if spec.observation_size != network.inputs:
            parts = ", ".join(f"{term.name} {size}" for term, size in zip(spec.terms, spec.term_sizes(), strict=True))
            raise InputError(
                f"the observation terms have {spec.observation_size} numbers, but the network takes {network.inputs}",
                place,
                hint=parts,
            )
        if len(spec.joints) != network.outputs:
            raise InputError(f"there are {len(spec.joints)} joints, but the network outputs {network.outputs} numbers", place)

    def infer(self, observation: ArrayLike) -> NDArray[np.float64]:
        """Actions (n,) of an observation (m,), or (k, n) of (k, m), as output by the network: not clipped, not
        scaled.

        Raises UsageError: another size; DivergedError: an action is not finite.
        """
        array = np.asarray(observation, dtype=np.float32)
        if array.ndim not in (1, 2) or array.shape[-1] != self._network.inputs:
            raise UsageError(
                f"expected an observation of {self._network.inputs} numbers, got shape {array.shape}"
            )
        if array.ndim == 2:
            rows = [self.infer(row) for row in array]
            return np.stack(rows) if rows else np.zeros((0, self._network.outputs))
        action = self._network.run(array)
        if not np.isfinite(action).all():
            joint = self.spec.joints[int(np.flatnonzero(~np.isfinite(action))[0])]
            cause = "its observation is finite" if np.isfinite(array).all() else "its observation is not finite either"
            raise DivergedError(f"the network's action for '{joint}' is not finite, {cause}", str(self.path))
        return action

    def attach(self, sim: Simulation, robot: Robot | str) -> PolicyDriver:
        """Attaches the policy to a robot of a simulation, from the next step; "" = a bare model without robots.

        Raises NotFoundError: joints or actuators that the robot does not have; UnsupportedError: actuators that
        accept no torque; UsageError: a timestep that does not divide the policy's period, a robot that already has a
        policy.
        """
        name = robot if isinstance(robot, str) else getattr(robot, "name", None)
        if name is None:
            raise TypeError(f"expected a robot or its name, got {robot!r}")
        if name and name not in sim.robots:
            sim.robots[name]  # raises, with the nearest name
        return PolicyDriver(self, sim, name)

    def __reduce__(self) -> tuple[type[Policy], tuple[Path, Path | None]]:
        return Policy, (self.path, self.settings)  # read again where it is sent to

    def __repr__(self) -> str:
        sizes = f"{self._network.inputs} -> {self._network.outputs}"
        return f"<gloam.Policy '{self.path.name}': {sizes}, {self.spec.rate:g} Hz>"


__all__ = ["TERMS", "Policy", "PolicyDriver", "PolicySpec", "Term", "TermInfo", "read_policy_metadata"]
