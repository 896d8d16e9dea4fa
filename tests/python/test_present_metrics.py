"""open_metrics() accumulates at record.metrics_rate, as a recorded run does, whatever the rate of the topic /metrics."""
from __future__ import annotations

from pathlib import Path

import gloam
import pytest
from scenes import QUADRUPED


@pytest.mark.parametrize("rate", [100, 40])
def test_metrics_are_those_of_a_recorded_run(tmp_path: Path, rate: int) -> None:
    scene = gloam.Scene.from_dict({"sim": {"duration": 1.0}, "record": {"metrics_rate": rate}, "topic": [{"name": "/metrics", "rate": 5}],
                                   "robot": [{"name": "dog", "file": str(QUADRUPED), "keyframe": "home", "controller": {"type": "trot"}}]})
    report = gloam.run(scene, tmp_path / "run", outputs=["metrics"])
    with gloam.load(scene) as sim:
        metrics = sim.open_metrics()
        sim.run_until(1.0)
        found = metrics.latest()
        with sim.subscribe(["/metrics"]) as heard:
            sim.run_until(2.0)
            assert len(list(heard)) == 6, "five a second, and the first"
    energies = [name for name in found if "energy" in name]
    assert energies
    for name in energies:
        assert found[name] == pytest.approx(report.results[name], rel=1e-6), name
