"""Memory of a simulation for the package `mujoco`: MjModel and MjData on the same arrays, without a copy."""
from __future__ import annotations

import importlib.util
import sys
import weakref
from typing import Any

import numpy as np

from gloam import _core


def _fits(version: str) -> bool:
    """Structs are the same within a minor version of MuJoCo."""
    return version.split(".")[:2] == _core.mujoco_version().split(".")[:2]


class MujocoMemory:
    """Creates the mjData of a simulation with the package, which then owns it."""

    def __init__(self, mujoco: Any) -> None:
        self._mujoco = mujoco
        self._models: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()  # by the address of their mjData
        self._datas: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()
        self._guarded: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()  # models whose other arrays are read only

    @classmethod
    def for_this_process(cls) -> MujocoMemory | None:
        """None if the package is missing or has another version."""
        if "mujoco" not in sys.modules and importlib.util.find_spec("mujoco") is None:
            return None
        try:
            import mujoco
        except ImportError:
            return None
        if not _fits(mujoco.__version__) or not hasattr(mujoco.MjModel, "_from_model_ptr"):
            return None
        return cls(mujoco)

    @staticmethod
    def required(memory: MujocoMemory | None) -> MujocoMemory:
        if memory is not None:
            return memory
        wanted = ".".join(_core.mujoco_version().split(".")[:2])
        raise ImportError(f"sim.model and sim.data need version {wanted}.x of the package mujoco, imported or installed before the "
                          f"simulation is created: pip install 'mujoco~={wanted}.0'; sim.memory.array(…) works without it")

    def make(self, keeper: Any) -> tuple[int, Any]:
        """(address of a new mjData, what keeps it and its model), for a model of the simulation's, whose arrays `keeper` keeps."""
        model = self._mujoco.MjModel._from_model_ptr(keeper.lend())
        weakref.finalize(model, lambda _: None, keeper).atexit = False  # arrays of the model outlive the simulation
        data = self._mujoco.MjData(model)
        self._models[data._address] = model
        self._datas[data._address] = data
        return data._address, (data, model)

    def data(self, memory: Any) -> Any:
        return self._datas[memory.data_address]

    def model(self, memory: Any) -> Any:
        """The model, in which only arrays of live fields are writable: the others cannot change while physics uses
        them."""
        address = memory.data_address
        model = self._models[address]
        if self._guarded.get(address) is not model:
            writable = set(_core.writable_model_arrays())
            for name in dir(model):
                array = getattr(model, name, None) if not name.startswith("_") else None
                if isinstance(array, np.ndarray) and name not in writable:
                    array.flags.writeable = False
            self._guarded[address] = model
        return model
