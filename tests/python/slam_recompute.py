"""Recomputes the numbers of a SLAM benchmark's page from its raw files, with NumPy alone: slam_recompute.py FOLDER.

It shares no code with the benchmark: alignment by Umeyama's formula, sums by hand. Prints the differences, and ends with 1 if one
exceeds a millionth.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import numpy as np


def read(file: Path) -> np.ndarray:
    rows = [line.split() for line in file.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return np.array(rows, float).reshape(-1, 8)


def umeyama(x: np.ndarray, y: np.ndarray, with_scale: bool) -> tuple[float, np.ndarray, np.ndarray]:
    mx, my = x.mean(0), y.mean(0)
    u, d, vt = np.linalg.svd((y - my).T @ (x - mx) / len(x))
    sign = np.diag([1, 1, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    turn = u @ sign @ vt
    scale = float(np.trace(np.diag(d) @ sign) / ((x - mx) ** 2).sum(1).mean()) if with_scale else 1.0
    return scale, turn, my - scale * turn @ mx


def length(p: np.ndarray) -> float:
    return float(np.sqrt((np.diff(p, axis=0) ** 2).sum(1)).sum())


def recomputed(run: Path, case: Path, sensors: str) -> dict[str, float | None]:
    truth = read(case / ("truth_lidar.tum" if sensors == "lidar" else "truth.tum"))
    poses = read(run / "poses.tum") if (run / "poses.tum").exists() else np.zeros((0, 8))
    period = np.median(np.diff(truth[:, 0]))
    nearest = [int(np.argmin(abs(truth[:, 0] - t))) for t in poses[:, 0]]
    pairs = [(k, n) for k, n in enumerate(nearest) if abs(truth[n, 0] - poses[k, 0]) <= period / 2]
    answer: dict[str, float | None] = {"ate_se3": None, "ate_sim3": None, "coverage": 0.0}
    if len(pairs) >= 3:
        x, y = poses[[k for k, _ in pairs], 1:4], truth[[n for _, n in pairs], 1:4]
        for name, with_scale in (("ate_se3", False), ("ate_sim3", True)):
            scale, turn, move = umeyama(x, y, with_scale)
            answer[name] = float(np.sqrt(((scale * x @ turn.T + move - y) ** 2).sum(1).mean()))
            if with_scale == (sensors == "mono"):
                answer["coverage"] = scale * length(poses[:, 1:4]) / length(truth[:, 1:4])
    with (run / "frames.csv").open() as file:
        states = [row["state"] for row in csv.DictReader(file)]
    answer["tracked"] = states.count("tracked") / len(truth)
    have = np.array([bool(len(poses)) and min(abs(poses[:, 0] - t)) <= period / 2 for t in truth[:, 0]])
    steps = np.sqrt((np.diff(truth[:, 1:4], axis=0) ** 2).sum(1))
    answer["completeness"] = float((steps * have[1:] * have[:-1]).sum() / steps.sum())
    return answer


def differences(out: Path, sensors: dict[str, str]) -> list[str]:
    """A line per number of results.csv that is not the recomputed one. sensors: of each method."""
    bad = []
    with (out / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if row["state"] != "ok":
            continue
        run = out / "runs" / row["method"] / row["scene"] / row["level"] / f"{int(row['number']):04}"
        for name, value in recomputed(run, out / "cases" / row["scene"] / row["level"], sensors[row["method"]]).items():
            told = float(row[name]) if row[name] else None
            if told is None and value is None:
                continue
            if told is None or value is None or abs(told - value) > 1e-6 * max(1, abs(value)):
                bad.append(f"{run}: {name} is {value}, but the table has {told}")
    return bad if rows else ["there are no runs"]


def main() -> None:
    from gloam.slam.methods import load_method

    out = Path(sys.argv[1])
    methods = [load_method(name) for name in json.loads((out / "request.json").read_text())["methods"]]
    bad = differences(out, {method.name: method.sensors for method in methods})
    print("\n".join(bad) or "all numbers agree")
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()
