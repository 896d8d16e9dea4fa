"""The quadruped's training and its published network (training/quadruped, assets/policies/quadruped)."""

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
from training.legged.robot import GaitChoice  # noqa: E402
from training.quadruped import evaluate  # noqa: E402
from training.quadruped.robot import ROBOT  # noqa: E402
from training.quadruped.settings import SETTINGS  # noqa: E402

POLICY = ROOT / "assets/policies/quadruped"


@pytest.fixture(scope="module")
def network():
    pytest.importorskip("openvino")
    return load_network(POLICY / "policy.onnx")


@pytest.mark.parametrize("command", [(0.5, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)])
def test_published_network_walks_in_mujoco(network, command):
    """In MuJoCo with the whole model at 2 ms; it was trained at 4 ms with feet as its only colliders."""
    result = evaluate.run(evaluate.build("flat"), Driver(ROBOT, network), command, 5.0)
    assert not result.fell
    assert result.velocity_error < 0.05 and result.yaw_rate_error < 0.05
    assert abs(result.distance - 4 * command[0]) < 0.5  # of the four seconds after the first


def test_published_network_crosses_rough_ground(network):
    result = evaluate.run(evaluate.build("rough", friction=0.6), Driver(ROBOT, network), (0.5, 0.0, 0.0), 5.0)
    assert not result.fell and result.velocity_error < 0.15 and result.distance > 1.5


def test_clock_follows_the_gait(network):
    """At 3 Hz the feet touch down more often than at 2 Hz: the network follows its clock."""
    model = evaluate.build("flat")
    steps = []
    for frequency in (2.0, 3.0):
        data, driver = mujoco.MjData(model), Driver(ROBOT, network, GaitChoice(frequency=frequency))
        mujoco.mj_resetDataKeyframe(model, data, 0)
        driver.command = np.array([0.5, 0.0, 0.0])
        touching, landings = True, 0
        foot = model.geom("FL_foot").id
        for step in range(2500):
            if step % 10 == 0:
                targets = driver.targets(data.qpos, data.qvel)
            data.ctrl[:] = driver.torques(targets, data.qpos[7:], data.qvel[6:])
            mujoco.mj_step(model, data)
            height = data.geom_xpos[foot][2] - 0.022
            if step > 500 and touching != (height < 0.015):
                touching = not touching
                landings += touching
        steps.append(landings / 4.0)
    np.testing.assert_allclose(steps, [2.0, 3.0], atol=0.3)


def test_settings_file_is_of_this_code(network):
    assert (POLICY / "policy.toml").read_text() == publish.policy_toml(SETTINGS)
    assert network(np.zeros(terms.size(terms.actor_terms(ROBOT)))).shape == (12,)
    assert (POLICY / "policy.onnx").stat().st_size < 2 * 2**20


def test_export_computes_the_same_numbers(tmp_path):
    pytest.importorskip("onnx")
    pytest.importorskip("openvino")
    rng = np.random.default_rng(1)
    sizes = (9, 16, 8, 3)
    layers = [(rng.normal(size=pair).astype(np.float32), rng.normal(size=pair[1]).astype(np.float32)) for pair in zip(sizes, sizes[1:])]
    export.write_onnx(layers, tmp_path / "a.onnx")
    run = load_network(tmp_path / "a.onnx")
    for observation in rng.normal(size=(20, 9)):
        np.testing.assert_allclose(run(observation), export.evaluate(layers, observation), rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("table", [make(tasks.robot(name)) for name in tasks.NAMES for make in (terms.actor_terms, terms.critic_terms)])
def test_mirror_image_of_the_mirror_image_is_the_original(table):
    source, sign = terms.mirror_table(table)
    values = np.random.default_rng(2).normal(size=len(source))
    image = values[source] * sign
    np.testing.assert_array_equal(image[source] * sign, values)
    assert (image != values).any()


def test_driver_repeats_its_first_observation():
    seen = []
    driver = Driver(ROBOT, lambda observation: seen.append(observation) or np.zeros(12))
    qpos, qvel = np.zeros(19), np.arange(18.0)
    qpos[3] = 1
    driver.targets(qpos, qvel)
    assert seen[0].shape == (terms.size(terms.actor_terms(ROBOT)),)
    np.testing.assert_allclose(seen[0][:15].reshape(5, 3), np.tile(qvel[3:6] * 0.25, (5, 1)))
    driver.targets(qpos, qvel + 1)
    np.testing.assert_allclose(seen[1][:15].reshape(5, 3)[:4], np.tile(qvel[3:6] * 0.25, (4, 1)))
    np.testing.assert_allclose(seen[1][12:15], (qvel[3:6] + 1) * 0.25)  # oldest first


class TestInJax:
    """Parts of the environment against closed forms."""

    @pytest.fixture(autouse=True)
    def _jax(self):
        pytest.importorskip("jax")
        pytest.importorskip("mujoco.mjx")

    def test_clock_is_that_of_the_driver(self):
        from training.legged import gait

        choice = GaitChoice(2.0, 0.5, 0.1, 0.2, 0.6, 0.08, 0.0)
        values = gait.Gait(*(np.float32(v) for v in (2.0, 0.5, 0.1, 0.2, 0.6, 0.08, 0.0)))
        for index in np.linspace(0, 0.99, 23):
            expected = choice.clock(index)
            got = np.asarray(gait.clock(gait.foot_phases(np.float32(index), values)))
            np.testing.assert_allclose(got, expected, atol=1e-4)

    def test_feet_touch_steps_from_above_and_from_the_side(self):
        import jax.numpy as jnp

        from training.legged import terrain

        heights = np.zeros((1, terrain.CELLS, terrain.CELLS), np.float32)
        heights[0, 10:] = 0.1  # a riser at x = 1 m
        ground = terrain.Ground(jnp.asarray(0), jnp.zeros(2), jnp.asarray(1.0), jnp.array([0.0, 0.0, 0.0, 0.02]))
        feet = jnp.array([[0.55, 0.55, 0.022], [0.97, 0.55, 0.05], [0.99, 0.55, 0.11], [1.55, 0.55, 0.122]])
        distance, points, normal = (np.asarray(a) for a in terrain.sole_contacts(jnp.asarray(heights), ground, feet, 0.022))
        np.testing.assert_allclose(distance[0], 0.0, atol=1e-6)  # stands on the ground
        np.testing.assert_allclose(distance[3], 0.008, atol=1e-6)  # 30 mm before the riser
        np.testing.assert_allclose(normal[3], [-1, 0, 0], atol=1e-4)
        np.testing.assert_allclose(distance[5], np.hypot(0.01, 0.01) - 0.022, atol=1e-5)  # on the edge
        np.testing.assert_allclose(normal[5], [-np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-3)
        np.testing.assert_allclose(distance[6], 0.02, atol=1e-6)  # over a print of 20 mm
