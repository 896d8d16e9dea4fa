"""gloam.evaluate has the order, names, defaults and units of `gloam evaluate`."""
from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import gloam
import numpy as np
import pytest

ROOT = Path(gloam.home())


def trajectory(seed: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    times = np.arange(400) * 0.05
    p = np.stack([3 * np.cos(times), 2 * np.sin(times), 0.3 * np.sin(2 * times)], axis=1) + rng.normal(0, 0.02, (400, 3))
    yaw = times + rng.normal(0, 0.01, 400)
    q = np.stack([np.cos(yaw / 2), 0 * yaw, 0 * yaw, np.sin(yaw / 2)], axis=1)
    return times, np.concatenate([p, q], axis=1)


def write_tum(file: Path, times: Any, poses: Any) -> Path:
    file.write_text("".join(f"{t!r} {x!r} {y!r} {z!r} {qx!r} {qy!r} {qz!r} {qw!r}\n"
                            for t, (x, y, z, qw, qx, qy, qz) in zip(times.tolist(), poses.tolist(), strict=True)))
    return file


@pytest.mark.parametrize("options", [{}, {"align": "none"}, {"align": "sim3", "rpe_delta": 5.0, "rpe_unit": "f"}, {"rpe_delta": 20.0, "rpe_unit": "deg"},
                                     {"rpe_delta": 0.5, "rpe_unit": "s", "all_pairs": True}, {"offset": 0.01, "max_difference": 0.02}])
def test_it_agrees_with_the_command_line(tmp_path: Path, options: dict[str, Any]) -> None:
    estimate, reference = write_tum(tmp_path / "estimate.tum", *trajectory(1)), write_tum(tmp_path / "reference.tum", *trajectory(2))
    words = [word for name, value in options.items()
             for word in ([f"--{name.replace('_', '-')}"] if value is True else [f"--{name.replace('_', '-')}", str(value)])]
    program = Path(os.environ["GLOAM_BUILT"]).parents[1] / "bin" / "gloam"
    told = subprocess.run([program, "evaluate", estimate, "--reference", reference, "--json", *words], capture_output=True, text=True, check=True)
    wanted = json.loads(told.stdout)
    found = gloam.evaluate(estimate, reference, **options)
    for key in ("reference_poses", "estimate_poses", "pairs", "reference_length_m", "estimate_length_m"):
        assert found[key] == pytest.approx(wanted[key], rel=1e-12)
    assert found["align"]["by"] == wanted["align"]["by"] and found["align"]["scale"] == pytest.approx(wanted["align"]["scale"])
    for error in ("ate", "rpe"):
        for part in ("translation_m", "angle_rad", "full"):
            statistics = dict(found[error][part])
            assert len(statistics.pop("values")) == statistics["count"]
            assert statistics == pytest.approx(wanted[error][part], rel=1e-12)
    assert found["rpe"]["delta"] == wanted["rpe"]["delta"] and found["rpe"]["delta_unit"] == wanted["rpe"]["delta_unit"]


def test_arrays_and_short_trajectories() -> None:
    times, poses = trajectory(1)
    short = gloam.evaluate((times[:3], poses[:3] * [.01, .01, .01, 1, 1, 1, 1]), (times[:3], poses[:3] * [.01, .01, .01, 1, 1, 1, 1]), align="none")
    assert short["rpe"] is None and short["ate"]["translation_m"]["rmse"] == 0
    with pytest.raises(gloam.Error):
        gloam.evaluate((times[:3], poses[:3]), (times[:3], poses[:3]), align="none", rpe_delta=1000.0)
    with pytest.raises(gloam.UsageError, match="sim3"):
        gloam.evaluate((times, poses), (times, poses), align="se4")
