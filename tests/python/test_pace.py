"""The pace in which simulation time waits for sensors, and what they cost."""
import time

import pytest

import gloam

MODEL = """<mujoco><option timestep="0.002"/><worldbody><light pos="0 0 3"/><geom type="plane" size="1 1 .1"/>
<body pos="0 0 1"><freejoint/><geom size=".1"/></body><camera name="eye" pos="0 -2 1" xyaxes="1 0 0 0 0 1"/></worldbody></mujoco>"""


@pytest.fixture
def model(tmp_path):
    file = tmp_path / "ball.xml"
    file.write_text(MODEL)
    return file


def test_time_waits_for_sensors_and_stats_tell_their_cost(model):
    with gloam.load(model, pace="sensors") as sim:
        frames = []

        def slow(frame):
            time.sleep(0.02)
            frames.append(frame)

        sim.cameras["eye"].open(("depth",), width=8, height=8, rate=100, required=False, callback=slow)
        sim.run_until(0.2)
        stats = sim.stats
        assert stats.pace == "sensors"
        [cost] = stats.sensors
        assert cost.name == "camera 'eye'" and cost.rate == 100
        assert cost.dropped == 0 and cost.achieved == pytest.approx(100)
        assert cost.messages > 10 and cost.wall_ms >= 20 and cost.waited_ms >= 0


def test_a_wrong_pace_has_a_hint(model):
    with pytest.raises(gloam.UsageError, match="sensors"):
        gloam.load(model, pace="sensor")
