"""A G1 that walks by a network: half a metre per second forwards for five seconds.

    ./gloam python examples/python/g1_policy.py policy.onnx g1.xml

The network is one of PyPI's holosoma-inference 0.1.3, models/loco/g1_29dof/, the model is mjlab 1.6.0's,
asset_zoo/robots/unitree_g1/xmls/g1.xml (docs/policies.md has the commands). That model has neither motors nor armature:
mjlab adds them in Python, here g1_scene() does.
"""

import argparse
import math
import shutil
from pathlib import Path

import gloam

SETTINGS = Path(__file__).with_name("g1_policy.toml")
GROUND = """<mujoco>
  <option integrator="implicitfast"/>
  <worldbody><geom type="plane" size="0 0 0.05"/></worldbody>
</mujoco>"""
SCENE = """
[scene]
name = "g1"

[sim]
timestep = 0.004

[environment]
file = "ground.xml"

[[robot]]
name = "g1"
file = "g1/motors.xml"
"""


def with_motors(model: Path, joints: list[str]) -> str:
    """An MJCF that is the model and a motor for each joint, of the joint's name: the policy's torques are its controls."""
    motors = "\n".join(f'    <motor name="{joint}" joint="{joint}"/>' for joint in joints)
    return f'<mujoco>\n  <include file="{model.name}"/>\n  <actuator>\n{motors}\n  </actuator>\n</mujoco>\n'


def armatures(policy: gloam.Policy) -> str:
    """Overrides of each joint's armature, the inertia of its rotor seen through the gear [kg m²]. mjlab chose stiffness =
    armature (2 pi 10 Hz)², from the data of the motors; the network's gains therefore tell it."""
    text = ""
    for joint, kp in zip(policy.spec.joints, policy.spec.kp):
        text += f'[override.g1.joint."{joint}"]\narmature = {float(kp) / (2 * math.pi * 10) ** 2:.9f}\n'
    return text


def g1_scene(model: Path, policy: gloam.Policy, folder: Path) -> gloam.Scene:
    """The robot of a file on a plane. Its files are copied into `folder`, where logs of the scene find them later."""
    (folder / "ground.xml").write_text(GROUND)
    shutil.copytree(model.parent, folder / "g1", dirs_exist_ok=True)
    (folder / "g1" / "motors.xml").write_text(with_motors(model, list(policy.spec.joints)))
    return gloam.Scene.parse(SCENE + armatures(policy), folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("policy", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("--vx", type=float, default=0.5, help="m/s")
    parser.add_argument("--out", type=Path, default=Path("results/g1"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)

    policy = gloam.Policy(arguments.policy, SETTINGS)
    with gloam.load(g1_scene(arguments.model, policy, arguments.out)) as sim:
        drive = policy.attach(sim, "g1")
        drive.place((0, 0, 0.76))
        drive.command(vx=arguments.vx)
        with sim.record(arguments.out / "run.mcap", ["/clock", "/tf*", "/g1/*"], overwrite=True):
            sim.run_until(time=5)
        position = sim.robots["g1"].pose.p
    print(f"after 5 s: x {position[0]:.2f} m, y {position[1]:.2f} m, height {position[2]:.2f} m")
    verification = gloam.replay(arguments.out / "run.mcap").verify()
    print(f"{verification.differing_steps} of {verification.steps} steps differ when the log is stepped again")


if __name__ == "__main__":
    main()
