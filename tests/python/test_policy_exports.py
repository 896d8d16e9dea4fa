"""Settings of examples/policies: each framework's observation, written here from its source, against the networks' inputs.

A network of one random layer stands for the policy: its actions contain every number of the observation.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402

from policy_fixtures import write_network  # noqa: E402

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "policies"
LEGS = ("FL", "FR", "RL", "RR")
DEPTH_FIRST = [f"{leg}_{part}_joint" for leg in LEGS for part in ("hip", "thigh", "calf")]
BREADTH_FIRST = [f"{leg}_{part}_joint" for part in ("hip", "thigh", "calf") for leg in LEGS]
GO1 = [f"{leg}_{part}_joint" for leg in ("FR", "FL", "RR", "RL") for part in ("hip", "thigh", "calf")]
STEP_X, STEP_HEIGHT = 0.4, 0.05  # where the ground rises [m]
COMMAND = np.array([0.4, -0.1, 0.3])

SCENE = """
[sim]
timestep = 0.002
[[robot]]
name = "go"
model = "quadruped"
[robot.controller]
type = "policy"
network = "policy.onnx"
settings = "settings.toml"
goals = [{{ time = 0, vx = {}, vy = {}, yaw_rate = {} }}]
[environment]
file = "step.xml"
"""
STEP = f"""<mujoco><worldbody><geom type="plane" size="5 5 1"/>
<geom type="box" size="2 5 {STEP_HEIGHT / 2}" pos="{STEP_X + 2} 0 {STEP_HEIGHT / 2}"/></worldbody></mujoco>"""


def ground(x: float) -> float:
    return STEP_HEIGHT if x > STEP_X else 0.0


def heights(base: np.ndarray, R: np.ndarray, order: str) -> np.ndarray:
    """Base height − 0.5 − ground over a grid of 1.6 m x 1.0 m that turns with the base's yaw."""
    yaw = np.arctan2(R[1, 0], R[0, 0])
    xs, ys = np.linspace(-0.8, 0.8, 17), np.linspace(-0.5, 0.5, 11)
    points = [(x, y) for y in ys for x in xs] if order == "x_fastest" else [(x, y) for x in xs for y in ys]
    return np.array([base[2] - 0.5 - ground(base[0] + np.cos(yaw) * x - np.sin(yaw) * y) for x, y in points])


class Body:
    """The parts that all frameworks measure, from MuJoCo's state."""

    def __init__(self, qpos: np.ndarray, qvel: np.ndarray, names: list[str], default: np.ndarray, action: np.ndarray) -> None:
        w, x, y, z = qpos[3:7]
        self.R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                           [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                           [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        rows = [DEPTH_FIRST.index(name) for name in names]
        self.position = qpos[:3]
        self.lin_vel, self.ang_vel = self.R.T @ qvel[:3], qvel[3:6]  # of a free joint: world, body
        self.gravity = self.R.T @ [0, 0, -1]
        self.joint_pos, self.joint_vel, self.action = qpos[7:][rows] - default, qvel[6:][rows], action


def isaac_lab(b: Body) -> np.ndarray:
    return np.hstack([b.lin_vel, b.ang_vel, b.gravity, COMMAND, b.joint_pos, b.joint_vel, b.action,
                      np.clip(heights(b.position, b.R, "x_fastest"), -1, 1)])


def legged_gym(b: Body) -> np.ndarray:
    return np.hstack([2 * b.lin_vel, 0.25 * b.ang_vel, b.gravity, COMMAND * [2, 2, 0.25], b.joint_pos, 0.05 * b.joint_vel, b.action,
                      5 * np.clip(heights(b.position, b.R, "y_fastest"), -1, 1)])


def playground(b: Body) -> np.ndarray:
    return np.hstack([b.lin_vel, b.ang_vel, b.gravity, b.joint_pos, b.joint_vel, b.action, COMMAND])


def positions(names: list[str], hip_left: float, front: float, rear: float, calf: float) -> np.ndarray:
    values = {"hip": lambda leg: hip_left if leg[1] == "L" else -hip_left, "thigh": lambda leg: front if leg[0] == "F" else rear, "calf": lambda _: calf}
    return np.array([values[name.split("_")[1]](name[:2]) for name in names])


@pytest.mark.parametrize(
    ("file", "observe", "size", "names", "default", "gains", "scale"),
    [("isaac_lab_go2", isaac_lab, 235, BREADTH_FIRST, positions(BREADTH_FIRST, 0.1, 0.8, 1.0, -1.5), (25, 0.5), 0.25),
     ("legged_gym_a1", legged_gym, 235, DEPTH_FIRST, positions(DEPTH_FIRST, 0.1, 0.8, 1.0, -1.5), (20, 0.5), 0.25),
     ("playground_go1", playground, 48, GO1, positions(GO1, -0.1, 0.9, 0.9, -1.8), (35, 0.5), 0.5)],
)
def test_the_network_gets_the_framework_s_observation(tmp_path: Path, file: str, observe, size: int, names: list[str], default: np.ndarray,  # noqa: ANN001
                                                      gains: tuple[float, float], scale: float) -> None:
    weights = (0.02 * np.random.default_rng(3).normal(size=(12, size))).astype(np.float32)
    write_network(tmp_path / "policy.onnx", weights)
    shutil.copy(EXAMPLES / f"{file}.toml", tmp_path / "settings.toml")
    (tmp_path / "step.xml").write_text(STEP)
    (tmp_path / "scene.toml").write_text(SCENE.format(*COMMAND))
    rows = [DEPTH_FIRST.index(name) for name in names]
    kp, kd = gains
    action = np.zeros(12)
    with gloam.load(tmp_path / "scene.toml") as sim:
        qpos, qvel, ctrl = (sim.memory.array(name) for name in ("qpos", "qvel", "ctrl"))
        for step in range(300):
            before = Body(qpos.copy(), qvel.copy(), names, default, action)
            if step % 10 == 0:
                action = weights.astype(float) @ observe(before)
            sim.step(1)
            torque = kp * (scale * action - before.joint_pos) - kd * before.joint_vel
            within = np.abs(torque) < 23
            assert np.allclose(ctrl[rows][within], torque[within], atol=2e-3), f"step {step}"
            assert within.sum() > 6
        assert np.abs(action).max() > 0.05
