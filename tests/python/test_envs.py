"""Environments: gymnasium's checks, and that worlds are what they would be alone."""

import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import gloam
from gloam.envs import Env, EnvSettings, PointGoal, Reach, VectorEnv

SMALL = {"size": (16, 12)}
IDS = [
    ("gloam/PointGoal-v0", {"observation": "depth", **SMALL}),
    ("gloam/PointGoal-v0", {"observation": "image", **SMALL}),
    ("gloam/PointGoal-v0", {"observation": "lidar", "beams": 12}),
    ("gloam/QuadrupedVelocity-v0", {}),
    ("gloam/Reach-v0", {}),
]
NOISY = {
    "sensor_latency": {"goal": (0.0, 0.3)},
    "noise": {"depth": 0.05, "goal": {"std": 0.01, "bias_std": 0.05}},
    "history": {"goal": 3},
    "action_delay": (0.0, 0.12),
}


def vector(name="PointGoal", n=3, **options):
    if name == "PointGoal":
        options = {**SMALL, **options}
    return gym.make_vec(f"gloam/{name}-v0", num_envs=n, **options)


def parts(observation):
    return observation if isinstance(observation, dict) else {"all": observation}


def same(a, b):
    return all(np.array_equal(parts(a)[name], parts(b)[name]) for name in parts(a))


def of(observation, world):
    return {name: value[world] for name, value in parts(observation).items()}


@pytest.mark.parametrize(("name", "options"), IDS)
@pytest.mark.filterwarnings("error")
def test_check_env_passes(name, options):
    check_env(gym.make(name, **options).unwrapped)


@pytest.mark.parametrize(("name", "options"), IDS)
def test_worlds_of_many_are_what_they_are_alone(name, options):
    seed, steps = 20, 6
    many = gym.make_vec(name, num_envs=8, **options)
    actions = np.random.default_rng(1).uniform(-1, 1, (steps, *many.action_space.shape)).astype(np.float32)
    seen = [many.reset(seed=seed)[0]]
    rewards = []
    for action in actions:
        observation, reward, *_ = many.step(action)
        seen.append(observation)
        rewards.append(reward)
    assert len(set(many.unwrapped.hashes)) == 8
    for world in (0, 5):
        alone = gym.make_vec(name, num_envs=1, **options) if world == 0 else gym.make(name, **options)
        is_vector = world == 0
        first = alone.reset(seed=seed + world)[0]
        assert same(of(first, 0) if is_vector else first, of(seen[0], world))
        for k, action in enumerate(actions):
            observation, reward, *_ = alone.step(action[[world]] if is_vector else action[world])
            assert same(of(observation, 0) if is_vector else observation, of(seen[k + 1], world))
            assert np.all(reward == rewards[k][world])
        hashes = alone.unwrapped.hashes if is_vector else [alone.unwrapped.hash]
        assert hashes[0] == many.unwrapped.hashes[world]
        alone.close()
    many.close()


def test_a_seed_gives_the_same_again_whatever_was_before():
    with_past, fresh = gym.make("gloam/Reach-v0"), gym.make("gloam/Reach-v0")
    for k in range(3):
        with_past.reset(seed=k)
        with_past.step(np.full(6, 0.5))
    with_past.reset()
    for env in (with_past, fresh):
        env.reset(seed=7)
        env.step(np.full(6, -0.5))
    assert with_past.unwrapped.hash == fresh.unwrapped.hash
    with_past.reset(seed=7)  # the same seed twice, on the same simulation
    with_past.step(np.full(6, -0.5))
    assert with_past.unwrapped.hash == fresh.unwrapped.hash


def test_a_reset_without_a_seed_goes_on_with_other_numbers():
    env = Env(Reach())
    first, _ = env.reset(seed=1)
    second, _ = env.reset()
    assert not same(first, second)
    again, _ = env.reset(seed=1)
    assert same(first, again)
    assert same(second, env.reset()[0])


def test_the_picture_after_a_reset_is_the_new_worlds():
    env = Env(PointGoal("depth", size=(16, 12)))
    near = {"start": (1.2, 0.0, 0.0), "goal": (-1.5, 0.0)}  # 0.8 m before a wall
    far = {"start": (-1.6, 0.0, 0.0), "goal": (1.5, 0.0)}
    images = {}
    for name, options in (("near", near), ("far", far), ("near again", near)):
        observation, _ = env.reset(options=options)
        images[name] = observation["depth"]
        for _ in range(5):
            env.step(np.array([1.0, 1.0]))
    assert np.array_equal(images["near"], images["near again"])
    assert images["near"][3, 8] * 5 == pytest.approx(2.0 - 1.2 - 0.16, abs=0.03)
    assert images["far"][3, 8] * 5 > 1.5


def test_a_scan_after_a_reset_is_the_new_worlds():
    env = Env(PointGoal("lidar", beams=36))
    for x in (1.2, -1.5, 1.2):
        observation, _ = env.reset(options={"start": (x, -0.2, 0.0), "goal": (0.0, -1.0)})
        lidar = observation["lidar"] * 5
        assert lidar[18] == pytest.approx(2.0 - x, abs=0.05)  # ahead: half a turn after behind
        assert lidar[0] == pytest.approx(2.0 + x, abs=0.05)
        for _ in range(4):
            env.step(np.array([0.5, -1.0]))


def test_partial_resets_leave_the_other_worlds_alone():
    options = {"autoreset_mode": "Disabled", **NOISY}
    touched, alone = vector(**options), vector(**options)
    for env in (touched, alone):
        env.reset(seed=5)
    actions = np.random.default_rng(2).uniform(-1, 1, (10, 3, 2))
    for k, action in enumerate(actions):
        if k in (3, 4, 8):
            before = touched.step(action)[0]
            alone.step(action)
            observation, infos = touched.reset(options={"reset_mask": np.array([True, False, True])})
            assert same(of(observation, 1), of(before, 1))  # what it saw last
            assert infos["_distance"].tolist() == [True, False, True]
        a, b = touched.step(action)[0], alone.step(action)[0]
        assert same(of(a, 1), of(b, 1)), k
        assert k < 3 or not same(of(a, 0), of(b, 0))
    assert touched.unwrapped.hashes[1] == alone.unwrapped.hashes[1]
    assert touched.unwrapped.hashes[0] != alone.unwrapped.hashes[0]


def test_next_step_resets_in_the_step_after_the_last():
    env = vector(n=2, max_episode_steps=3)
    assert env.metadata["autoreset_mode"] is gym.vector.AutoresetMode.NEXT_STEP
    env.reset(seed=0)
    forward = np.tile([1.0, 0.0], (2, 1))
    for k in range(3):
        last, _, terminated, truncated, _ = env.step(forward)
        assert truncated.tolist() == [k == 2] * 2 and not terminated.any()
    first, rewards, terminated, truncated, infos = env.step(forward)
    assert not truncated.any() and not terminated.any()
    assert rewards.tolist() == [0, 0]
    assert not same(of(first, 0), of(last, 0))
    assert "distance" in infos
    assert [sim.step_count for sim in env.unwrapped.sims] == [1, 1]  # new episodes, not stepped on
    assert not env.step(forward)[3].any()


def test_same_step_keeps_the_terminal_observation():
    plain, env = vector(max_episode_steps=4), vector(max_episode_steps=4, autoreset_mode="SameStep")
    actions = np.random.default_rng(3).uniform(-1, 1, (12, 3, 2))
    plain.reset(seed=9)
    first, _ = env.reset(seed=9)
    kept = []
    for k, action in enumerate(actions):
        observation, _, _, truncated, infos = env.step(action)
        if k < 4:
            expected, *_, plain_infos = plain.step(action)
        if k % 4 == 3:
            assert truncated.all() and infos["_final_obs"].all()
            kept.append((infos["final_obs"], [{n: v.copy() for n, v in one.items()} for one in infos["final_obs"]]))
            assert not same(of(observation, 0), infos["final_obs"][0])
        else:
            assert "final_obs" not in infos and not truncated.any()
        if k == 3:
            for world in range(3):
                assert same(infos["final_obs"][world], of(expected, world))
            assert np.array_equal(infos["final_info"]["distance"], plain_infos["distance"])
    for given, copies in kept:  # later steps did not write into them
        for one, copy in zip(given, copies, strict=True):
            assert same(one, copy)


def test_success_terminates_and_a_time_limit_truncates():
    env = gym.make("gloam/PointGoal-v0", max_episode_steps=60, **SMALL)
    env.reset(seed=0, options={"start": (-1.5, 0.0, 0.0), "goal": (-0.5, 0.0)})
    for _ in range(60):
        *_, reward, terminated, truncated, info = env.step(np.array([1.0, 0.0]))
        if terminated:
            break
    assert terminated and not truncated and info["success"]
    assert reward > 4 and 0.9 < info["spl"] <= 1
    env.reset(seed=0)
    for _ in range(60):
        _, _, terminated, truncated, info = env.step(np.zeros(2))
    assert truncated and not terminated and not info["success"]


def test_disabled_refuses_to_step_on_after_an_end():
    env = vector(n=2, max_episode_steps=2, autoreset_mode="Disabled")
    env.reset(seed=0)
    env.step(np.zeros((2, 2)))
    assert env.step(np.zeros((2, 2)))[3].all()
    with pytest.raises(gloam.UsageError, match="reset_mask"):
        env.step(np.zeros((2, 2)))
    env.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(gloam.UsageError, match=r"\[1\]"):
        env.step(np.zeros((2, 2)))
    env.reset(options={"reset_mask": np.array([False, True])})
    env.step(np.zeros((2, 2)))


def test_an_action_delay_is_felt():
    ways = []
    for delay in (0.0, 0.05, 0.1):
        env = Env(PointGoal(size=(4, 3)), EnvSettings(action_delay=delay))
        env.reset(seed=0, options={"start": (-1.6, 0.0, 0.0), "goal": (1.5, 0.0)})
        for _ in range(2):
            env.step(np.array([1.0, 0.0]))
        ways.append(env.sim.robots["cart"].pose.p[0] + 1.6)
    assert ways[0] > ways[1] > ways[2] > 0.01


def test_a_randomised_option_changes_the_picture():
    where = {"start": (-1.5, 0.0, 0.0), "goal": (1.0, -0.5)}
    task = PointGoal("depth", size=(16, 12))
    plain, env = Env(task), Env(task, EnvSettings(randomize={"camera.front.fovy": (30.0, 110.0)}))
    still = [plain.reset(options=where)[0]["depth"] for _ in range(2)]
    assert np.array_equal(*still)
    seen = {}
    for seed in (1, None, None):
        picture = env.reset(seed=seed, options=where)[0]["depth"]
        seen[env.sim.scene["camera.front.fovy"]] = picture
    assert len(seen) == 3
    (_, narrow), *_, (_, wide) = sorted(seen.items())
    assert narrow[-1].mean() > wide[-1].mean() + 0.01  # a wider picture begins on nearer floor
    assert np.array_equal(env.reset(seed=1, options=where)[0]["depth"], next(iter(seen.values())))
    assert plain.sim.scene["camera.front.fovy"] == 75  # the World of others is not changed


def test_a_randomised_colour_of_light_changes_the_picture():
    where = {"start": (-1.5, 0.0, 0.0), "goal": (1.0, -0.5)}
    task = PointGoal("image", size=(16, 12), tier="path", spp=4)
    redness = []
    for randomize in ({}, {"light.lamp.color": ([1, 0.05, 0.05], [1, 0.1, 0.1])}):
        env = Env(task, EnvSettings(randomize=randomize))
        red, _, blue = env.reset(seed=0, options=where)[0]["image"].mean(axis=(0, 1))
        redness.append(red / blue)
    assert redness[1] > 1.5 * redness[0]


def test_render_gives_pictures():
    env = gym.make("gloam/Reach-v0", render_mode="rgb_array", render_size=(32, 24))
    env.reset(seed=0)
    picture = env.render()
    assert picture.shape == (24, 32, 3) and picture.dtype == np.uint8 and picture.std() > 3
    both = vector("Reach", n=2, render_mode="rgb_array", render_size=(32, 24))
    both.reset(seed=0)
    assert len(both.render()) == 2 and np.array_equal(both.render()[0], picture)


def test_bad_input_is_an_error_and_changes_nothing():
    env = vector(n=2)
    with pytest.raises(gloam.UsageError, match="reset"):
        env.step(np.zeros((2, 2)))
    env.reset(seed=0)
    hashes = env.unwrapped.hashes
    for action in (np.zeros((3, 2)), np.zeros(2), np.array([[0, np.nan], [0, 0]]), [["a", "b"], ["c", "d"]], None):
        with pytest.raises(ValueError):
            env.step(action)
    for mask in ([True, False], np.array([1, 0]), np.array([False, False]), np.array([True])):
        with pytest.raises((TypeError, ValueError)):
            env.reset(options={"reset_mask": mask})
    for seed in (-1, [1], [1, -2], 1.5, "s"):
        with pytest.raises((TypeError, ValueError, gym.error.Error)):
            env.reset(seed=seed)
    assert env.unwrapped.hashes == hashes
    env.close()
    with pytest.raises(gloam.ClosedError):
        env.unwrapped.step(np.zeros((2, 2)))
    env.close()


@pytest.mark.parametrize(
    "options",
    [
        {"observation": "smell"},
        {"place": "moon"},
        {"size": (0, 4)},
        {"reach": (0.1, 2)},
        {"beams": 0, "observation": "lidar"},
        {"render_mode": "ansi"},
        {"sensor_latency": {"smell": 0.1}},
        {"num_legs": 4},
    ],
)
def test_options_that_make_no_sense_are_errors(options):
    with pytest.raises((ValueError, TypeError)):
        gym.make("gloam/PointGoal-v0", disable_env_checker=True, **options)


def test_options_of_reset_are_checked():
    env = Env(PointGoal(size=(4, 3)))
    for options in ({"goal": (0, 0, 0)}, {"goal": (float("nan"), 0)}, {"goal": (50, 50)}, {"start": (-1.1, -0.9, 0)}):
        with pytest.raises(ValueError):
            env.reset(seed=0, options=options)
    env.reset(seed=0)


def test_a_vector_of_zero_worlds_is_an_error():
    with pytest.raises(ValueError, match="at least 1"):
        VectorEnv(Reach(), num_envs=0)


def test_episodes_in_a_log_replay_to_the_same_states(tmp_path):
    env = Env(PointGoal(size=(4, 3)))
    env.reset(seed=3)
    with env.sim.record(tmp_path / "run.mcap"):
        env.reset(seed=3)
        for _ in range(3):
            for _ in range(4):
                env.step(np.array([1.0, 0.3]))
            env.reset()  # a goal and a place of its own
    verified = gloam.replay(tmp_path / "run.mcap").verify()
    assert verified.differing_steps == 0 and verified.steps > 150


@pytest.mark.parametrize("mode", ["Disabled", "NextStep", "SameStep"])
def test_physics_that_diverges_ends_its_own_episode_alone(mode):
    def act(sim, action):
        if action[0] > 0.5:
            sim.joints["arm/pan"].set(qvel=[1e200])

    actions = {"function": act, "low": [0], "high": [1]}
    env = gloam.make_vec_env(Reach().scene(), 3, {"q": {"joints": "arm"}}, actions, autoreset_mode=mode)
    env.reset(seed=1)
    _, _, terminated, _, infos = env.step(np.array([[0], [1], [0]]))
    assert terminated.tolist() == [False, True, False]
    diverged = infos["final_info"]["diverged"] if mode == "SameStep" else infos["diverged"]
    assert diverged.tolist() == [False, True, False]
    if mode == "Disabled":
        env.reset(options={"reset_mask": terminated})
    for _ in range(3):
        observation, _, terminated, *_ = env.step(np.zeros((3, 1)))
        assert not terminated.any() and np.isfinite(observation["q"]).all()


def test_a_page_may_be_open_while_worlds_step_and_reset():
    env = vector("Reach", n=2)
    env.reset(seed=0)
    with env.unwrapped.sims[0].view():
        for _ in range(5):
            env.step(np.zeros((2, 6)))
        env.reset()
        env.step(np.zeros((2, 6)))
    env.close()


def test_a_forked_process_is_told_so():
    program = """
import os, gloam, numpy as np
from gloam.envs import Reach, VectorEnv
env = VectorEnv(Reach(), 3)
env.reset(seed=0)
child = os.fork()
if child == 0:
    code = 1
    try:
        env.step(np.zeros((3, 6)))
    except gloam.ForkedError:
        env.close()
        own = VectorEnv(Reach(), 3)
        own.reset(seed=0)
        own.step(np.zeros((3, 6)))
        own.close()
        code = 0
    os._exit(code)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
env.step(np.zeros((3, 6)))
env.close()
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=180)


def test_the_import_registers_the_environments():
    program = "import gloam, gymnasium as gym; gym.make_vec('gloam/Reach-v0', num_envs=2).reset(seed=0)"
    subprocess.run([sys.executable, "-c", program], check=True, timeout=180)


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_gymnasiums_own_vectors_give_the_same(mode):
    own = gym.make_vec("gloam/Reach-v0", num_envs=2, vectorization_mode=mode)
    ours = vector("Reach", n=2)
    assert same(own.reset(seed=3)[0], ours.reset(seed=3)[0])
    for _ in range(3):
        action = np.full((2, 6), 0.3, dtype=np.float32)
        assert same(own.step(action)[0], ours.step(action)[0])
    own.close()


def test_a_house_has_ways_to_its_goals():
    task = PointGoal("lidar", place="house", beams=8, house_seed=3, rooms=3)
    env = Env(task)
    for seed in range(3):
        _, info = env.reset(seed=seed)
        position = env.sim.robots["cart"].pose.p
        space = task.free_space(env.sim.world)
        assert space.is_free(position) and 0.5 < info["distance"] <= 4.0
        before = position.copy()
        for _ in range(3):
            env.step(np.array([0.5, 0.0]))
        after = env.sim.robots["cart"].pose.p
        assert np.linalg.norm(after - before) > 0.02 and abs(after[2]) < 0.03  # it stands on the floor, and is free


def test_the_quadruped_stands_and_sees_its_last_action():
    env = gym.make("gloam/QuadrupedVelocity-v0", noisy=False)
    env.reset(seed=0, options={"goal": (0.0, 0.0, 0.0)})
    for k in range(50):
        action = np.full(12, 0.01 * (k % 3), dtype=np.float32)
        observation, reward, terminated, _, info = env.step(action)
        assert not terminated and not info["fallen"]
        np.testing.assert_array_equal(observation[-12:], action)
    assert reward > 0.8 * 1.5 * 0.02  # of the most that there is
    assert observation[8] == pytest.approx(-1, abs=0.02)  # gravity is down


def test_a_driver_who_knows_the_way_reaches_every_goal():
    task = PointGoal(size=(4, 3))
    env = Env(task, max_episode_steps=150)
    space = task.free_space(env.sim.world)
    ring = 0.3 * np.stack([np.cos(a := np.linspace(-np.pi, np.pi, 36, endpoint=False)), np.sin(a)], axis=1)
    for seed in range(8):
        goal = space.sample(np.random.default_rng(seed))
        field = space.distances(goal)
        env.reset(seed=seed, options={"goal": goal})
        for _ in range(150):
            pose = env.sim.robots["cart"].pose
            ahead = pose.p[:2] + ring
            ways = [space.distance(field, point) + (not space.is_free(point)) for point in ahead]
            east, north = ring[np.argmin(ways)]
            error = (np.arctan2(north, east) - pose.yaw + np.pi) % (2 * np.pi) - np.pi
            *_, terminated, truncated, info = env.step(np.array([max(0.0, np.cos(error)) ** 3, 2 * error]))
            if terminated or truncated:
                break
        assert info["success"], seed
        assert 0.7 < info["spl"] <= 1
