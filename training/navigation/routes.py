"""Writes the scenes and the table of views of the training: `./gloam python -m training.navigation.routes --out DIR`.

DIR/scenes/PLACE_CONDITION.toml has one camera per view; DIR/routes.npz has the arrays of `Views` and, with the prefix
pair_, of `Pairs`; DIR/places.json has the names of the places.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path as File
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.navigation.free_space import free_space, shared_space
from gloam.navigation.grid import Grid

from .labels import Path, waypoints
from .pairs import PairRule, Pairs, pairs_of
from .paths import VIEW_SPACING, Deviation, deviating_drive, nominal_drive, plan
from .scenes import CONDITIONS, Place, camera_poses, cameras_toml, place_toml, places

Array = NDArray[np.float64]
Table = TypeVar("Table", "Views", Pairs)
RADIUS = 0.32  # of the free space around the trunk's centre [m]; the camera is 0.31 m ahead of it
LENGTHS = (4.0, 12.0)  # of paths [m]


@dataclass(frozen=True)
class Views:
    """Rows of a table of n views. place: number; route: number, unique over all places; drive: 0 on the path, 1 straying;
    along: progress on the path [m]; pose: (n, 3) x, y, yaw [m, rad]; action: (n, 5, 4) label (labels.waypoints); camera:
    (n, 7) its position [m] and orientation w, x, y, z."""

    place: NDArray[np.int32]
    route: NDArray[np.int32]
    drive: NDArray[np.int8]
    along: NDArray[np.float32]
    pose: NDArray[np.float32]
    action: NDArray[np.float32]
    camera: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.place)


def joined(parts: Sequence[Table]) -> Table:
    """All rows of tables of one type, in order."""
    kind = type(parts[0])
    return kind(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(kind)))


def route_views(path: Path, space: Grid, rng: np.random.Generator, place: int, route: int) -> Views:
    """Views of two drives of a path: on it, and straying from it."""
    parts = []
    for drive in (0, 1):
        poses, along = nominal_drive(path) if drive == 0 else deviating_drive(path, space, rng, Deviation())
        action = np.array([waypoints(path, pose, at) for pose, at in zip(poses, along, strict=True)])
        count = len(poses)
        parts.append(
            Views(
                np.full(count, place, np.int32),
                np.full(count, route, np.int32),
                np.full(count, drive, np.int8),
                along.astype(np.float32),
                poses.astype(np.float32),
                action.astype(np.float32),
                np.column_stack(camera_poses(poses, rng)).astype(np.float32),
            )
        )
    return joined(parts)


def place_views(space: Grid, views: int, place: int, first_route: int, seed: int) -> Views:
    """Views of as many random routes as give at least `views`; UsageError if no path of LENGTHS is found."""
    rng = np.random.default_rng((seed, place))
    parts: list[Views] = []
    for _ in range(50):
        goal = space.sample(rng)
        field = space.distances(goal)
        try:
            start = space.sample(rng, field, LENGTHS)
        except gloam.UsageError:
            continue
        path = plan(space, start, goal)
        if path is None or path.length < 0.8 * LENGTHS[0]:
            continue
        parts.append(route_views(path, space, rng, place, first_route + len(parts)))
        if sum(map(len, parts)) >= views:
            break
    if not parts:
        raise gloam.UsageError(f"there is no path of {LENGTHS[0]} to {LENGTHS[1]} m")
    return joined(parts)


def space_of(place: Place, folder: File) -> Grid:
    """Floor of a place that is free in every condition. Errors: of gloam."""
    worlds = [gloam.Scene.parse(place_toml(place, condition), folder).compile() for condition in CONDITIONS]
    return shared_space([free_space(world, (), RADIUS) for world in worlds])


def write_place(place: Place, views: Views, folder: File) -> None:
    """Writes the scenes of a place; all conditions have the same cameras."""
    cameras = cameras_toml(views.camera[:, :3], views.camera[:, 3:])
    for condition in CONDITIONS:
        (folder / f"{place.name}_{condition}.toml").write_text(place_toml(place, condition) + cameras)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=File, required=True, help="folder for the scenes and routes.npz")
    parser.add_argument("--houses", type=int, default=20)
    parser.add_argument("--warehouses", type=int, default=10)
    parser.add_argument("--views", type=int, default=250, help="per place, at least")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(arguments)
    scenes = options.out / "scenes"
    scenes.mkdir(parents=True, exist_ok=True)
    parts: list[Views] = []
    pairs: list[Pairs] = []
    names: list[str] = []
    for place in places(options.houses, options.warehouses):
        begin = time.monotonic()
        try:
            first = int(parts[-1].route.max()) + 1 if parts else 0
            space = space_of(place, scenes)
            views = place_views(space, options.views, len(parts), first, options.seed)
        except gloam.Error as error:
            print(f"{place.name}: skipped: {error}", flush=True)
            continue
        write_place(place, views, scenes)
        pairs.append(place_pairs(views, space, sum(map(len, parts)), options.seed))
        parts.append(views)
        names.append(place.name)
        routes = f"{len(np.unique(views.route))} routes, {len(pairs[-1].anchor)} pairs"
        print(f"{place.name}: {len(views)} views, {routes}, {time.monotonic() - begin:.1f} s", flush=True)
        save(joined(parts), joined(pairs), names, options.out / "routes.npz")
        (options.out / "places.json").write_text(json.dumps(names))


def place_pairs(views: Views, space: Grid, first: int, seed: int) -> Pairs:
    """Pairs of the views of a place, whose first row in the table of all places is `first`."""
    rng = np.random.default_rng((seed, first))
    pairs = pairs_of(views.pose.astype(np.float64), space, rng, PairRule())
    return replace(pairs, anchor=pairs.anchor + np.int32(first), goal=pairs.goal + np.int32(first))


def save(views: Views, pairs: Pairs, names: Sequence[str], file: File) -> None:
    """Writes the tables, with the places' names and the spacing of the views."""
    table = {field.name: getattr(views, field.name) for field in fields(Views)}
    table |= {f"pair_{field.name}": getattr(pairs, field.name) for field in fields(Pairs)}
    np.savez_compressed(file, **table, names=np.array(names), view_spacing=np.float32(VIEW_SPACING))


if __name__ == "__main__":
    main()
