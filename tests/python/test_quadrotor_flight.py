"""The catalogue's quadrotor with its motors, propellers and battery: power of hovering, and the flight of
examples/quadrotor_smoke.toml."""
from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gloam

MASS, ROTORS, RADIUS, AIR = 1.325, 4, 0.13, 1.225  # [kg], rotors, [m], [kg/m³]
FIGURE_OF_MERIT = 0.12**1.5 / (2 * math.pi * 0.0201 * 0.12 / 0.26) * math.sqrt(2 / math.pi)


def ideal_power() -> float:
    """Of hovering, by momentum theory: T^1.5 / sqrt(2 ρ A) of each rotor [W]."""
    thrust = MASS * 9.81 / ROTORS
    return ROTORS * thrust**1.5 / math.sqrt(2 * AIR * math.pi * RADIUS**2)


def hovering(**robot: Any) -> gloam.Simulation:
    sim = gloam.load({"robot": [{"name": "drone", "model": "quadrotor", "position": [0, 0, 1.0]} | robot]})
    sim.run_until(time=4)
    return sim


def test_power_of_hovering_is_that_of_momentum_theory_and_of_the_motors() -> None:
    with hovering() as sim:
        drone = sim.robots["drone"]
        speeds, power = drone.motor_speeds, drone.battery["power"]
    assert speeds == pytest.approx([437] * 4, rel=0.01)
    shaft = sum(0.0201 * 1.70e-5 * w**3 for w in speeds)
    currents = 0.0201 * 1.70e-5 * speeds**2 / 0.0125 + 0.5
    heat, friction = 0.075 * sum(currents**2), 0.0125 * 0.5 * sum(speeds)
    print(f"hover: {power:.1f} W, shafts {shaft:.1f} W, momentum theory {ideal_power():.1f} W / {FIGURE_OF_MERIT:.3f}")
    assert shaft == pytest.approx(ideal_power() / FIGURE_OF_MERIT, rel=0.01)
    assert power == pytest.approx(shaft + heat + friction + 7.5, rel=0.002)
    minutes = 82 / power * 60
    print(f"endurance: {minutes:.1f} min of 82 Wh")
    assert 32 < minutes < 38  # Skydio: 35 minutes


def test_an_almost_empty_battery_limits_the_thrust() -> None:
    battery = {"curve": [[0, 9], [1, 17.4]], "nominal_voltage": 15.2, "internal_resistance": 0.04, "capacity": 5.37, "charge": 0.02}
    with hovering(actuators={"idle_power": 7.5, "battery": battery}, controller={"type": "none"}) as sim:
        drone = sim.robots["drone"]
        drone.controls = [13.0] * 4
        sim.run_until(time=4.5)
        thrust = 1.70e-5 * drone.motor_speeds**2
        assert (thrust < 10).all()
        assert drone.battery["voltage"] == pytest.approx(0.0125 * drone.motor_speeds[0] + 0.075 * (0.0201 * thrust[0] / 0.0125 + 0.5), rel=0.05)


def test_motor_models_can_be_left_out() -> None:
    with gloam.load({"robot": [{"name": "drone", "model": "quadrotor", "position": [0, 0, 1], "actuator": []}]}) as sim:
        sim.run_until(time=0.1)
        with pytest.raises(gloam.NotFoundError, match="no actuator models"):
            _ = sim.robots["drone"].battery


def scene(examples: Path, *, rotors: bool) -> dict[str, Any]:
    tables = tomllib.loads((examples / "quadrotor_smoke.toml").read_text())
    del tables["camera"]
    tables["probe"] = [
        {"name": f"{name}{i}", "quantity": quantity, "position": [x, y, z], "rate": 10}
        for quantity, name in (("gas_density", "d"), ("gas_velocity", "v"))
        for i, (x, y, z) in enumerate(PLACES)
    ]
    if not rotors:
        del tables["rotor"]
    return tables


# Around the smoke pot at the origin: near the ground, and at the height of the propellers.
PLACES = [*((1.2 * math.cos(a), 1.2 * math.sin(a), 0.15) for a in np.linspace(0, 2 * math.pi, 8, endpoint=False)), (0.0, 0.0, 0.75)]


def fly(examples: Path, tables: dict[str, Any], log: Path) -> tuple[np.ndarray, dict[str, np.ndarray], float]:
    """Positions at 50 Hz (n, 3), probes at 10 Hz, and the charge of the battery at the end."""
    path, probes = [], {p["name"]: [] for p in tables["probe"]}
    with gloam.load(gloam.Scene.from_dict(tables, folder=examples)) as sim:
        streams = {name: sim.sensors[name].open() for name in probes}
        with sim.record(log, topics=["/tf"]):
            for step in range(1, int(tables["sim"]["duration"] * 50) + 1):
                sim.run_until(time=step / 50)
                path.append(sim.bodies["drone/frame"].pose.p.copy())
                if step % 5 == 0:
                    for name, values in probes.items():
                        sample = streams[name].latest()
                        assert sample is not None
                        values.append(np.array(sample.values))
        charge = sim.robots["drone"].battery["charge"]
    return np.array(path), {name: np.array(values) for name, values in probes.items()}, charge


@pytest.mark.slow
def test_it_flies_its_waypoints_in_gusts_and_its_downwash_moves_the_smoke(examples: Path, tmp_path: Path) -> None:
    tables = scene(examples, rotors=True)
    path, air, charge = fly(examples, tables, tmp_path / "flight.mcap")
    waypoints = tables["robot"][0]["controller"]["flight"]["waypoints"]
    begin = 0
    over = slice(0, 0)  # samples at 10 Hz while it hovers over the pot
    for number, waypoint in enumerate(waypoints):
        away = np.linalg.norm(path[begin:] - waypoint["position"], axis=1)
        first = begin + int(np.argmax(away < 0.2))
        held = np.linalg.norm(path[first + 25:first + 25 + int(waypoint["hold"] * 50)] - waypoint["position"], axis=1)
        error = math.sqrt(np.mean(held**2))
        print(f"waypoint {number}: {error:.3f} m root mean square, at most {held.max():.3f} m")
        assert away.min() < 0.2
        assert error < 0.12 and held.max() < 0.25
        if waypoint["position"][:2] == [0, 0]:
            over = slice((first + 50) // 5, (first + 25 + int(waypoint["hold"] * 50)) // 5)
        begin = first + int(waypoint["hold"] * 50)
    assert 0.9 < charge < 1
    assert gloam.replay(tmp_path / "flight.mcap").verify().is_equal

    _, still, _ = fly(examples, scene(examples, rotors=False), tmp_path / "without.mcap")
    smoke, smoke_still = (np.stack([probes[f"d{i}"][over, 0] for i in range(len(PLACES))]) for probes in (air, still))
    moved = float(np.abs(smoke - smoke_still).sum() / smoke_still.sum())
    down = [float(np.mean(probes[f"v{len(PLACES) - 1}"][over, 2])) for probes in (air, still)]
    print(f"under the rotors {down[0]:.2f} m/s against {down[1]:.2f} m/s; {moved * 100:.0f} % of the smoke is elsewhere")
    assert down[0] < down[1] - 0.5 and down[0] < 0  # without rotors the warm smoke rises
    assert moved > 0.3
