"""Small networks, robots and settings for tests of policies."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import gloam
import numpy as np
import onnx
from gloam.policy import Policy, PolicyDriver
from onnx import TensorProto, helper, numpy_helper

# Two hinges that hang below a floating base. Names of joints and motors differ; the motor of "knee" has a gear.
LEG = """<mujoco model="leg">
  <option timestep="0.005" gravity="0 0 0"/>
  <worldbody>
    <body name="base" pos="0 0 1">
      <freejoint name="root"/>
      <geom type="box" size=".1 .1 .1" mass="5"/>
      <site name="imu"/>
      <body name="thigh" pos="0 0 -.1">
        <joint name="hip" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass="1"/>
        <body name="shank" pos="0 0 -.25">
          <joint name="knee" axis="0 1 0"/>
          <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".03" mass="1"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>{actuators}</actuator>
  <sensor><gyro name="gyro" site="imu"/></sensor>
</mujoco>"""
MOTORS = '<motor name="m_hip" joint="hip"/><motor name="m_knee" joint="knee" gear="2"/>'

POLICY = """
[policy]
rate = 50
joints = ["knee", "hip"]
kp = [10.0, 20.0]
kd = 0.5
default_positions = [0.3, -0.2]
action_scale = 0.5
"""
OBSERVATION = """
[[observation]]
term = "joint_pos"

[[observation]]
term = "joint_vel"

[[observation]]
term = "velocity_commands"
"""


# As mjlab 1.6's rl/exporter_utils.py writes it: lists with commas, parts of entries with semicolons, three decimals,
# numbers also for truth.
MJLAB = {
    "run_path": "local",
    "joint_names": "hip,knee",
    "joint_stiffness": "20.000,10.000",
    "joint_damping": "0.500,0.250",
    "default_joint_pos": "-0.200,0.300",
    "command_names": "twist",
    "observation_names": "base_ang_vel,projected_gravity,joint_pos,actions,command",
    "observation_terms_scale": "0.250;0.500;1.000,1.000,1.000,1.000,2.000",
    "observation_terms_flatten_history_dim": "1.000,1.000,1.000,1.000,1.000",
    "observation_terms_history_length": "0.000,0.000,3.000,0.000,0.000",
    "observation_terms_clip": "-inf;inf,-1.000;1.000,-inf;inf,-inf;inf,-inf;inf",
    "action_scale": "0.500,0.250",
}
MJLAB_SIZE = 3 + 3 + 3 * 2 + 2 + 3


def write_network(
    path: Path,
    weights: np.ndarray,
    bias: np.ndarray | None = None,
    metadata: Mapping[str, str] | None = None,
    inputs: tuple[str, ...] = ("obs",),
) -> Path:
    """An ONNX file: actions = weights @ obs + bias; (outputs, inputs). More `inputs` are declared and not used."""
    outputs, size = weights.shape
    bias = np.zeros(outputs) if bias is None else np.asarray(bias)
    tensors = [
        numpy_helper.from_array(weights.T.astype(np.float32), "w"),
        numpy_helper.from_array(bias.astype(np.float32), "b"),
    ]
    nodes = [helper.make_node("MatMul", ["obs", "w"], ["wx"]), helper.make_node("Add", ["wx", "b"], ["y0"])]
    last = "y0"
    for i, name in enumerate(inputs[1:]):
        nodes.append(helper.make_node("Add", [last, name], [f"y{i + 1}"]))
        last = f"y{i + 1}"
    nodes.append(helper.make_node("Identity", [last], ["actions"]))
    ports = [helper.make_tensor_value_info(inputs[0], TensorProto.FLOAT, [1, size])]
    ports += [helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, 1]) for name in inputs[1:]]
    result = helper.make_tensor_value_info("actions", TensorProto.FLOAT, [1, outputs])
    model = helper.make_model(
        helper.make_graph(nodes, "g", ports, [result], tensors), opset_imports=[helper.make_opsetid("", 17)]
    )
    model.ir_version = 8
    if metadata:
        helper.set_model_props(model, dict(metadata))
    onnx.save(model, path)
    return path


def write_model(folder: Path, actuators: str = MOTORS) -> Path:
    path = folder / "leg.xml"
    path.write_text(LEG.format(actuators=actuators))
    return path


def write_scene(folder: Path, actuators: str = MOTORS, name: str = "bot") -> Path:
    """A scene with one robot, whose joints are NAME/hip and NAME/knee."""
    write_model(folder, actuators)
    path = folder / "scene.toml"
    path.write_text(f'[scene]\nname = "leg"\n[sim]\ntimestep = 0.005\n[[robot]]\nname = "{name}"\nfile = "leg.xml"\n')
    return path


def write_settings(folder: Path, text: str = POLICY + OBSERVATION) -> Path:
    path = folder / "policy.toml"
    path.write_text(text)
    return path


HELD = np.array([0.375, -0.625])  # actions of the network without inputs, exact in f32


def held_policy(folder: Path, terms: str = OBSERVATION, size: int = 7, extra: str = "") -> Policy:
    """Always the actions HELD."""
    return Policy(
        write_network(folder / "p.onnx", np.zeros((2, size)), HELD), write_settings(folder, POLICY + extra + terms)
    )


class Seen:
    """Steps a simulation and keeps the observations of a policy, one for each control period of `every` steps."""

    def __init__(self, sim: gloam.Simulation, drive: PolicyDriver, every: int = 4) -> None:
        self.sim, self.drive, self.every = sim, drive, every
        self.observations: list[np.ndarray] = []

    def step(self, n: int = 1) -> None:
        for _ in range(n):
            acts = self.sim.step_count % self.every == 0
            self.sim.step()
            if acts:
                self.observations.append(self.drive.observation)
