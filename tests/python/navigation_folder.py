"""A folder as `gloam bench nav` leaves it, with synthetic episodes: `python navigation_folder.py FOLDER` writes a large one."""

from __future__ import annotations

import json
import random
import sys
from pathlib import Path
from typing import Any

OBJECTS = ("chair", "table leg", "door frame", "sofa", "plant", "shelf", "pallet", "person")
SKILL = {"route": 0.97, "gnm": 0.9, "vint": 0.93}
HARDER = {"none": 0.0, "minor": 0.22, "major": 0.68}
FAILURES = ("collided", "fell", "stuck", "lost", "timed_out")


def write_request(folder: Path, **changes: Any) -> dict[str, Any]:
    """Writes request.json and returns it."""
    request = {
        "planners": list(SKILL),
        "scenes": ["house", "warehouse"],
        "levels": list(HARDER),
        "episodes": 20,
        "seed": 7,
        "tier": "interactive",
        "log": True,
        "machine": "8 cores, no GPU",
        "version": "0.9.0",
        "started": "2025-06-01T12:00:00Z",
    } | changes
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "request.json").write_text(json.dumps(request))
    return request


def episode(planner: str, scene: str, level: str, number: int, **changes: Any) -> dict[str, Any]:
    """A successful episode without collisions, with changes."""
    return {
        "planner": planner, "scene": scene, "level": level, "episode": number, "seed": number,
        "start": [0.0, float(number), 0.0], "goal": [6.0, float(number)], "shortest": 6.0, "limit": 120.0,
        "outcome": "success", "success": True, "collisions": 0, "collisions_by_object": {}, "time": 20.0,
        "path_length": 7.5, "final_distance": 0.4, "visibility_mean": 30.0, "visibility_min": 25.0, "plans": 80,
        "late": 0, "invalid": 0, "wall_seconds": 40.0, "cpu_seconds": 70.0, "tier": "interactive", "log": None,
        "hash": "0x1", "message": "", "track": [], "touches": [],
    } | changes  # fmt: skip


def write_episode(folder: Path, values: dict[str, Any], **changes: Any) -> Path:
    """Writes the episode's file and returns its path."""
    path = folder / "episodes" / values["planner"] / values["scene"] / values["level"] / f"{values['episode']:04d}"
    path.mkdir(parents=True, exist_ok=True)
    (path / "episode.json").write_text(json.dumps(values | changes))
    return path / "episode.json"


def write_folder(folder: Path, missing: int = 0, **changes: Any) -> dict[str, Any]:
    """Writes a benchmark of random but plausible episodes; the last cell lacks `missing` episodes. Returns the request."""
    request = write_request(folder, **changes)
    draw = random.Random(request["seed"])
    cells = [(p, s, v) for p in request["planners"] for s in request["scenes"] for v in request["levels"]]
    for cell in cells:
        for number in range(request["episodes"] - (missing if cell == cells[-1] else 0)):
            values = _draw(draw, cell, number)
            path = write_episode(folder, values)
            (path.parent / values["log"]).write_bytes(b"")
    return request


def _draw(draw: random.Random, cell: tuple[str, str, str], number: int) -> dict[str, Any]:
    planner, scene, level = cell
    harder = HARDER.get(level, 0.3) + (0.12 if scene == "warehouse" else 0.0)
    success = draw.random() < SKILL.get(planner, 0.9) - harder
    objects: dict[str, int] = {}
    for _ in range(min(draw.randrange(1 + int(2 + 14 * harder)), 12)):
        name = OBJECTS[min(int(draw.expovariate(0.5)), len(OBJECTS) - 1)]
        objects[name] = objects.get(name, 0) + 1
    shortest = round(5 + 3 * ((number * 7919) % 17) / 17, 3)
    path = shortest * draw.uniform(1.02, 1.6)
    failure = "error" if draw.random() < 0.04 else draw.choice(FAILURES)
    sight = {"none": 60.0, "minor": 14.0, "major": 3.5}.get(level, 10.0) * draw.uniform(0.8, 1.2)
    plans = draw.randrange(60, 240)
    return episode(
        *cell, number, shortest=shortest, outcome="success" if success else failure, success=success,
        collisions=sum(objects.values()), collisions_by_object=objects, path_length=path if success else path * draw.random(),
        time=path / 0.3 if success else draw.uniform(5, 120),
        final_distance=draw.uniform(0.1, 0.5) if success else draw.uniform(1, shortest),
        visibility_mean=sight, visibility_min=sight * 0.6, plans=plans, late=draw.randrange(3), invalid=int(draw.random() < 0.05),
        wall_seconds=draw.uniform(20, 60), cpu_seconds=draw.uniform(40, 110), log="run.mcap",
        message="the planner's process ended with status 1" if failure == "error" and not success else "",
    )  # fmt: skip


if __name__ == "__main__":
    write_folder(Path(sys.argv[1]), missing=3)
