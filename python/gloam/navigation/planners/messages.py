"""Messages between Gloam and a planner in another process, and their checks: replies may contain anything.

Requests have several parts, and each has one reply, a JSON object of at most 1 MiB:

1. JSON: {"call": "describe"};
   {"call": "reset", "robot", "seed", "goal": [x, y] or null, "top_speed", "radius"}; or
   {"call": "plan", "time", "pose", "velocity", "parts": [{"name": "image", "dtype": "uint8", "shape": [64, 85, 3]}, …]};
2. … of "plan": the arrays of `parts` in C order, little-endian.

Replies to "describe": {"rate", "latency", "needs": ["image", "depth", "scan"], "image_size": [width, height]}, all of them
optional. Replies to "reset": {}. Replies to "plan": {"velocity": [vx, vy, yaw rate]}, {"waypoints": [[x, y], …],
"chosen": 2} or {"arrived": true}. All of them may be {"error": "text"} instead. Units and frames are as in `Task`,
`Observation`, `Velocity` and `Waypoints` (gloam.navigation.planner).
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..planner import Answer, Arrived, Need, Observation, Planner, Task, Velocity, Waypoints

LONGEST_REPLY = 1 << 20  # [bytes]
MOST_WAYPOINTS = 1024
PARTS: tuple[Need, ...] = ("image", "depth", "scan")
_MOST_SIDE = 8192  # of images [px]


class RefusedError(ValueError):
    """The other side answers with an error."""


@dataclass(frozen=True)
class Description:
    """Declarations of a planner, see `Planner`."""

    rate: float = Planner.rate
    latency: float = Planner.latency
    needs: frozenset[Need] = frozenset({"image"})
    image_size: tuple[int, int] = Planner.image_size


def reset_request(task: Task) -> list[Any]:
    header = {"call": "reset", "robot": task.robot, "seed": task.seed, "goal": task.goal}
    return [json.dumps(header | {"top_speed": task.top_speed, "radius": task.radius}).encode()]


def plan_request(observation: Observation, needs: frozenset[Need]) -> list[Any]:
    arrays = [(name, np.ascontiguousarray(getattr(observation, name))) for name in PARTS if name in needs]
    parts = [{"name": name, "dtype": str(array.dtype), "shape": array.shape} for name, array in arrays]
    header = {"call": "plan", "time": observation.time, "pose": observation.pose, "velocity": observation.velocity, "parts": parts}
    return [json.dumps(header).encode(), *(array.data for _, array in arrays)]


def parsed_reply(data: bytes) -> dict[str, Any]:
    """The object of a reply. Errors: RefusedError with the other side's text; ValueError for anything else."""
    if len(data) > LONGEST_REPLY:
        raise ValueError(f"a reply has at most {LONGEST_REPLY} bytes, got {len(data)}")
    try:
        reply = json.loads(data.decode("utf-8"), parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"a reply is not JSON: {error}") from None
    if not isinstance(reply, dict):
        raise ValueError(f"a reply must be a JSON object, got {_kind(reply)}")
    if "error" in reply:
        raise RefusedError(reply["error"] if isinstance(reply["error"], str) else "no reason given")
    return reply


def description_of(reply: dict[str, Any]) -> Description:
    """Errors: ValueError."""
    default = Description()
    needs = reply.get("needs", sorted(default.needs))
    size = reply.get("image_size", list(default.image_size))
    if not isinstance(needs, list) or not all(isinstance(need, str) and need in PARTS for need in needs):
        raise ValueError(f"'needs' must be a list of {', '.join(PARTS)}")
    if not isinstance(size, list) or len(size) != 2 or not all(type(side) is int and 1 <= side <= _MOST_SIDE for side in size):
        raise ValueError(f"'image_size' must be [width, height] of 1 … {_MOST_SIDE} pixels")
    rate = _number(reply.get("rate", default.rate), "'rate'")
    latency = _number(reply.get("latency", default.latency), "'latency'")
    if rate <= 0 or latency < 0:
        raise ValueError(f"the rate must be above 0 and the latency at least 0, got {rate} Hz and {latency} s")
    return Description(rate, latency, frozenset(needs), (size[0], size[1]))


def answer_of(reply: dict[str, Any]) -> Answer:
    """The answer to an observation in a reply. Errors: ValueError if it is invalid."""
    given = [key for key in ("velocity", "waypoints", "arrived") if key in reply]
    if len(given) != 1:
        raise ValueError(f"an answer has one of 'velocity', 'waypoints' and 'arrived', got {', '.join(given) or 'none'}")
    if "arrived" in reply:
        if reply["arrived"] is not True:
            raise ValueError("'arrived' must be true")
        return Arrived()
    if "velocity" in reply:
        vx, vy, yaw_rate = _numbers(reply["velocity"], (3,), "a velocity")
        return Velocity(vx, vy, yaw_rate)
    rows = reply["waypoints"]
    if not isinstance(rows, list) or not 1 <= len(rows) <= MOST_WAYPOINTS:
        raise ValueError(f"waypoints must be a list of 1 … {MOST_WAYPOINTS}")
    points = [_numbers(row, (2, 4), "a waypoint") for row in rows]
    if len({len(point) for point in points}) != 1:
        raise ValueError("all waypoints must have the same length")
    chosen = reply.get("chosen", min(Waypoints.chosen, len(points) - 1))
    if type(chosen) is not int or not 0 <= chosen < len(points):
        raise ValueError(f"'chosen' must be 0 … {len(points) - 1}")
    return Waypoints(np.array(points, dtype=np.float64), chosen)


def encoded(answer: Answer) -> dict[str, Any]:
    """The reply for an answer."""
    if isinstance(answer, Velocity):
        return {"velocity": [answer.vx, answer.vy, answer.yaw_rate]}
    if isinstance(answer, Waypoints):
        return {"waypoints": np.asarray(answer.points).tolist(), "chosen": answer.chosen}
    return {"arrived": True}


def task_from(header: dict[str, Any]) -> Task:
    """The task of a request "reset"."""
    goal = None if header["goal"] is None else (float(header["goal"][0]), float(header["goal"][1]))
    return Task(header["robot"], header["seed"], goal, top_speed=header["top_speed"], radius=header["radius"])


def observation_from(header: dict[str, Any], arrays: list[bytes]) -> Observation:
    """The observation of a request "plan"."""
    parts = {
        part["name"]: np.frombuffer(data, part["dtype"]).reshape(part["shape"])
        for part, data in zip(header["parts"], arrays, strict=True)
    }
    x, y, yaw = header["pose"]
    vx, vy, yaw_rate = header["velocity"]
    return Observation(header["time"], (x, y, yaw), (vx, vy, yaw_rate), **parts)


def _numbers(values: Any, lengths: tuple[int, ...], name: str) -> list[float]:
    if not isinstance(values, list) or len(values) not in lengths:
        raise ValueError(f"{name} must be a list of {' or '.join(map(str, lengths))} numbers")
    return [_number(value, f"a number of {name}") for value in values]


def _number(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{name} must be a number, got {_kind(value)}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite")
    return number


def _kind(value: Any) -> str:
    return {list: "an array", dict: "an object", str: "a text", type(None): "null", bool: "true or false"}.get(type(value), "a number")


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant} is not a finite number")
