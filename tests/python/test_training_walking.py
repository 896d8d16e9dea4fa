"""The published networks of the mobile manipulator and the humanoid (training/legged, assets/policies)."""

import sys
from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from training import export, tasks  # noqa: E402
from training.legged import publish, terms  # noqa: E402
from training.legged.driver import Driver, load_network  # noqa: E402
from training.legged.robot import training_spec  # noqa: E402

NEW = ("mobile_manipulator", "humanoid")


def policy(name):
    return ROOT / "assets/policies" / name


@pytest.mark.parametrize("name", NEW)
def test_settings_file_is_of_this_code(name):
    assert (policy(name) / "policy.toml").read_text() == publish.policy_toml(tasks.settings(name))


@pytest.mark.parametrize("name", NEW)
def test_network_computes_the_same_as_its_layers_in_numpy(name):
    onnx = pytest.importorskip("onnx")
    pytest.importorskip("openvino")
    arrays = {a.name: onnx.numpy_helper.to_array(a) for a in onnx.load(policy(name) / "policy.onnx").graph.initializer}
    layers = [(arrays[f"weight{number}"], arrays[f"bias{number}"]) for number in range(len(arrays) // 2)]
    size = terms.size(terms.actor_terms(tasks.robot(name)))
    assert layers[0][0].shape[0] == size and layers[-1][0].shape[1] == 12
    network = load_network(policy(name) / "policy.onnx")
    for observation in np.random.default_rng(4).normal(size=(10, size)):
        expected = export.evaluate(layers, observation)
        np.testing.assert_allclose(network(observation), expected, rtol=1e-3, atol=1e-3)
        np.testing.assert_array_equal(network(observation), network(observation))


@pytest.mark.parametrize("name", tasks.NAMES)
def test_robot_of_the_training_stands_on_its_soles(name):
    """At its default positions all soles are level, and their spheres are the only colliders."""
    robot = tasks.robot(name)
    model = training_spec(robot, 0.004).compile()
    data = mujoco.MjData(model)
    data.qpos[:] = 0
    data.qpos[2:4] = robot.nominal_height, 1
    data.qpos[7 : 7 + len(robot.joints)] = robot.default_positions
    mujoco.mj_forward(model, data)
    bottoms = data.geom_xpos[1:, 2] - robot.sole_radius
    assert model.ngeom == 1 + robot.spheres
    np.testing.assert_allclose(bottoms, 0, atol=0.01)
    whole = mujoco.MjModel.from_xml_path(str(robot.file))
    assert model.body_mass.sum() == pytest.approx(whole.body_mass.sum())
    assert robot.weight == pytest.approx(9.81 * whole.body_mass.sum(), rel=0.01)


@pytest.mark.parametrize("name", NEW)
def test_welded_joints_are_where_the_keyframe_has_them(name):
    """Bodies of the training's model are in the places that the whole model has at the welded joints' positions."""
    robot = tasks.robot(name)
    welded, whole = training_spec(robot, 0.004).compile(), mujoco.MjModel.from_xml_path(str(robot.file))
    places = []
    for model in (welded, whole):
        data = mujoco.MjData(model)
        data.qpos[:] = 0
        data.qpos[3] = 1
        for joint, position in robot.welded.items() if model is whole else ():
            data.qpos[model.joint(joint).qposadr[0]] = position
        mujoco.mj_kinematics(model, data)
        places.append({model.body(number).name: data.xpos[number].copy() for number in range(model.nbody)})
    for body, place in places[0].items():
        np.testing.assert_allclose(place, places[1][body], atol=1e-9, err_msg=body)


def test_driver_observes_the_velocity_in_the_base_frame():
    robot, seen = tasks.robot("humanoid"), []
    driver = Driver(robot, lambda observation: seen.append(observation) or np.zeros(12))
    qpos, qvel = np.zeros(36), np.zeros(35)
    qpos[3] = qpos[6] = np.sqrt(0.5)  # turned left by 90 degrees
    qvel[1] = 0.5  # moves along the world's y axis: forwards
    driver.targets(qpos, qvel)
    np.testing.assert_allclose(seen[0][:3], [1.0, 0.0, 0.0], atol=1e-12)  # scale 2


class TestInGloam:
    @pytest.fixture(autouse=True)
    def _gloam(self):
        pytest.importorskip("gloam")
        pytest.importorskip("openvino")

    @pytest.mark.slow
    def test_hand_stays_at_its_goal_while_walking(self):
        from training.mobile_manipulator.compare import reach

        r = reach("policy", (0.5, 0.0, 0.0))
        assert not r.fell and r.velocity_error < 0.03 and r.yaw_rate_error < 0.03
        assert r.hand_error < 0.025 and r.worst_hand_error < 0.06

    @pytest.mark.slow
    @pytest.mark.parametrize("course", ["flat", "rough"])
    def test_humanoid_walks(self, course):
        from training.humanoid.compare import walk

        r = walk((0.5, 0.0, 0.0), course=course)
        assert not r.fell and r.velocity_error < 0.05 and r.yaw_rate_error < 0.05 and r.distance > 4

    @pytest.mark.slow
    def test_humanoid_survives_a_push(self):
        from training.humanoid.compare import walk

        push = '[[push]]\nbody = "hum/pelvis"\ntime = 3.5\nvelocity = [0.0, 0.3, 0.0]\n'
        assert not walk((0.5, 0.0, 0.0), 6.0, push=push).fell
