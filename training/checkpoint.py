"""Checkpoints: the arrays of a pytree and its training's progress in one .npz file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jax
import numpy as np


def save(path: Path, tree: Any, **extra: Any) -> None:
    """Writes beside `path` first, so that a stopped program leaves the former checkpoint."""
    leaves = [np.asarray(leaf) for leaf in jax.tree_util.tree_leaves(tree)]
    arrays = {f"leaf{number:03d}": leaf for number, leaf in enumerate(leaves)}
    draft = path.with_suffix(".draft.npz")
    np.savez(draft, **arrays, **{name: np.asarray(value) for name, value in extra.items()})
    draft.replace(path)


def load(path: Path, like: Any) -> tuple[Any, dict[str, np.ndarray]]:
    """The tree, with the structure of `like`, and the extra arrays. Raises ValueError: other shapes than `like`'s."""
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    leaves, structure = jax.tree_util.tree_flatten(like)
    names = [f"leaf{number:03d}" for number in range(len(leaves))]
    for name, leaf in zip(names, leaves, strict=True):
        if name not in arrays or arrays[name].shape != np.shape(leaf):
            raise ValueError(f"{path}: is the checkpoint of another network ({name})")
    tree = jax.tree_util.tree_unflatten(structure, [jax.numpy.asarray(arrays.pop(name)) for name in names])
    return tree, arrays


def progress(path: Path) -> int:
    """The number of iterations that a checkpoint contains."""
    with np.load(path, allow_pickle=False) as file:
        return int(file["iteration"])
