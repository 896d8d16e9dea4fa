"""The observation pipeline: order of its stages, and that worlds do not touch each other."""

import numpy as np
import pytest

from gloam.envs import EnvSettings, Gaussian, Pipeline, Term, Uniform
from gloam.envs.actuation import DelayedActions
from gloam.envs.noise import parse_noise


def worlds(*numbers):
    return np.array(numbers, dtype=np.int64)


def begun(terms, n, layout="dict", seeds=None):
    pipeline = Pipeline(terms, n, layout)
    for world in range(n):
        pipeline.seed(world, world if seeds is None else seeds[world])
    pipeline.reset(np.arange(n))
    return pipeline


def push(pipeline, values, *numbers):
    numbers = numbers or range(pipeline.num_worlds)
    return pipeline.push({"x": np.asarray(values, dtype=np.float64)}, worlds(*numbers))["x"]


def test_noise_comes_before_the_clip_and_the_clip_before_the_scale():
    pipeline = begun([Term("x", (1,), noise=Uniform(5, 5), clip=(0, 3), scale=10.0)], 1)
    assert push(pipeline, [[1.0]]).item() == 30.0  # (1 + 5) -> 3 -> 30


def test_scale_may_differ_along_a_term():
    pipeline = begun([Term("x", (3,), scale=(1.0, 2.0, 0.5))], 1)
    np.testing.assert_allclose(push(pipeline, [[1, 1, 1]]), [[1, 2, 0.5]])


def test_delay_gives_what_was_seen_so_many_steps_ago_and_the_first_value_before():
    pipeline = begun([Term("x", (1,), delay=2)], 1)
    assert [push(pipeline, [[k]]).item() for k in range(1, 7)] == [1, 1, 1, 2, 3, 4]


def test_history_is_oldest_first_of_what_the_delay_gives():
    pipeline = begun([Term("x", (1,), delay=1, history=3)], 1)
    seen = [push(pipeline, [[k]])[0, :, 0].tolist() for k in range(1, 6)]
    assert seen == [[1, 1, 1], [1, 1, 1], [1, 1, 2], [1, 2, 3], [2, 3, 4]]


def test_delays_of_a_range_are_drawn_for_each_world_and_episode():
    pipeline = begun([Term("x", (1,), delay=(0, 3))], 64)
    for k in range(10):
        seen = push(pipeline, np.full((64, 1), float(k)))
    lags = 9 - seen[:, 0]
    assert set(lags.tolist()) == {0, 1, 2, 3}
    pipeline.reset(np.arange(64))
    for k in range(10):
        seen = push(pipeline, np.full((64, 1), float(k)))
    assert (9 - seen[:, 0] != lags).any()


def test_noise_has_the_moments_that_it_says():
    pipeline = begun([Term("x", (20000,), noise=Gaussian(std=0.5, bias_std=2.0))], 1)
    first = push(pipeline, np.zeros((1, 20000)))[0]
    second = push(pipeline, np.zeros((1, 20000)))[0]
    assert np.std(first) == pytest.approx(np.hypot(0.5, 2.0), rel=0.03)
    assert np.std(first - second) == pytest.approx(0.5 * np.sqrt(2), rel=0.03)  # the bias stays


def test_relative_noise_grows_with_the_value():
    pipeline = begun([Term("x", (20000,), noise=Gaussian(relative=0.1))], 1)
    assert np.std(push(pipeline, np.full((1, 20000), 4.0))) == pytest.approx(0.4, rel=0.03)
    assert np.std(push(pipeline, np.zeros((1, 20000)))) == 0


def busy_terms():
    return [Term("x", (2,), noise=Gaussian(0.3, bias_std=0.2), delay=(0, 3), history=4)]


def test_a_reset_of_some_worlds_leaves_noise_delay_and_history_of_the_others_alone():
    touched, alone = begun(busy_terms(), 3), begun(busy_terms(), 3)
    values = np.random.default_rng(1).normal(size=(20, 3, 2))
    for k, value in enumerate(values):
        if k in (4, 9, 10):
            touched.reset(worlds(0, 2))
            push(touched, value[[0, 2]], 0, 2)  # the observations of their resets
        a, b = push(touched, value), push(alone, value)
        assert np.array_equal(a[1], b[1])
        assert k < 4 or not np.array_equal(a[0], b[0])


def test_after_a_reset_nothing_is_left_of_the_episode_before():
    pipeline = begun([Term("x", (1,), delay=(2, 2), history=3)], 2)
    for k in range(8):
        push(pipeline, [[k], [k]])
    pipeline.reset(worlds(1))
    assert push(pipeline, [[100.0]], 1)[0, :, 0].tolist() == [100, 100, 100]
    assert push(pipeline, [[8.0], [101.0]])[:, :, 0].tolist() == [[4, 5, 6], [100, 100, 100]]


def test_a_world_sees_the_same_alone_and_among_others():
    many, one = begun(busy_terms(), 5, seeds=[10, 11, 12, 13, 14]), begun(busy_terms(), 1, seeds=[13])
    for value in np.random.default_rng(2).normal(size=(10, 5, 2)):
        assert np.array_equal(push(many, value)[3], push(one, value[3:4])[0])


def test_arrays_that_were_given_do_not_change_later():
    pipeline = begun([Term("x", (2,), history=2), Term("y", (2,), delay=1), Term("z", (2,))], 1)
    given = []
    for k in range(4):
        values = np.full((1, 2), float(k))
        seen = pipeline.push({"x": values, "y": values, "z": values}, worlds(0))
        given.append((seen, {name: array.copy() for name, array in seen.items()}))
        values[:] = -1
    for seen, copy in given:
        for name, array in seen.items():
            assert np.array_equal(array, copy[name]), name


def test_a_vector_holds_all_terms_in_their_order():
    terms = [Term("x", (2,), history=2), Term("y", (1,), scale=2.0)]
    pipeline = begun(terms, 2, layout="vector")
    pipeline.push({"x": np.zeros((2, 2)), "y": np.zeros((2, 1))}, worlds(0, 1))
    seen = pipeline.push({"x": np.ones((2, 2)), "y": np.ones((2, 1))}, worlds(0, 1))
    assert seen.dtype == np.float32
    assert seen.tolist() == [[0, 0, 1, 1, 2]] * 2
    assert pipeline.space().shape == (5,)


def test_what_comes_out_lies_in_the_space():
    terms = [
        Term("picture", (4, 5, 3), 0, 255, noise=Gaussian(40), dtype=np.uint8, history=2),
        Term("depth", (4, 5), 0, noise=Gaussian(1), clip=(0, 5), scale=0.2),
        Term("turned", (2,), -1, 2, scale=-3.0),
        Term("shaken", (1,), 0, 1, noise=Uniform(-0.5, 0.5)),
        Term("free", (1,)),
    ]
    pipeline = begun(terms, 1)
    rng = np.random.default_rng(0)
    raw = {"depth": rng.normal(2, 5, (4, 5)), "turned": [-1, 2], "shaken": [1.0], "free": [1e9]}
    raw["picture"] = rng.integers(0, 255, (4, 5, 3), dtype=np.uint8)
    for _ in range(3):
        seen = pipeline.push({name: np.asarray(value)[None] for name, value in raw.items()}, worlds(0))
        assert pipeline.space().contains({name: value[0] for name, value in seen.items()})
    box = pipeline.space()["turned"]
    assert (box.low[0], box.high[0]) == (-6, 3)


def test_actions_arrive_at_their_physics_step():
    actions = DelayedActions((7, 7))
    actions.reset(np.random.default_rng(0))
    log, now = [], 0

    def step(n):
        nonlocal now
        now += n

    for k in range(4):
        actions.advance(np.array([k]), 10, lambda a: log.append((now, a.item())), step)
    assert log == [(7, 0), (17, 1), (27, 2), (37, 3)]
    assert now == 40
    actions.reset(np.random.default_rng(0))
    log.clear()
    now = 0
    actions.advance(np.array([9]), 10, lambda a: log.append((now, a.item())), step)
    assert log == [(7, 9)]  # the action 3 was not forgotten before, and is gone now


def test_latencies_are_rounded_up_to_control_steps():
    settings = EnvSettings(sensor_latency={"x": (0.0, 0.15)}, history={"x": 2}, noise={"x": 0.1}, action_delay=0.03)
    (term,) = settings.applied_to([Term("x", (1,), delay=1)], 0.1)
    assert term.lags == (1, 3)
    assert term.history == 2
    assert term.noise == Gaussian(0.1)
    assert settings.action_delay_steps(0.005) == (6, 6)


@pytest.mark.parametrize(
    "bad",
    [
        {"name": ""},
        {"shape": (0,)},
        {"history": 0},
        {"delay": -1},
        {"delay": (3, 1)},
        {"clip": (1, 0)},
        {"clip": (float("nan"), 1)},
        {"scale": float("inf")},
        {"scale": (1.0, 2.0)},
    ],
)
def test_terms_that_make_no_sense_are_errors(bad):
    with pytest.raises(ValueError):
        Term(**{"name": "x", "shape": (3,), **bad})


@pytest.mark.parametrize("bad", [-1, float("nan"), "much", {"std": -1}, {"uniform": [2, 1]}, {"mean": 1}, True, {}])
def test_noise_that_makes_no_sense_is_an_error(bad):
    with pytest.raises(ValueError):
        parse_noise(bad)


@pytest.mark.parametrize(
    "bad",
    [
        {"action_delay": -0.1},
        {"action_delay": (0.2, 0.1)},
        {"sensor_latency": {"x": float("inf")}},
        {"randomize": {"light.lux": (5, 1)}},
        {"randomize": {"light.lux": 5}},
        {"randomize": {"light.lux": ([0, 0], [1, 1, 1])}},
        {"threads": 0},
    ],
)
def test_settings_that_make_no_sense_are_errors(bad):
    with pytest.raises(ValueError):
        EnvSettings(**bad)


def test_wrong_values_are_errors():
    pipeline = begun([Term("x", (3,))], 2)
    with pytest.raises(ValueError, match="'x'"):
        push(pipeline, np.zeros((2, 4)))
    with pytest.raises(KeyError):
        pipeline.push({"y": np.zeros((2, 3))}, worlds(0, 1))
    with pytest.raises(ValueError, match="different names"):
        Pipeline([Term("x", (1,)), Term("x", (1,))], 1)
    with pytest.raises(ValueError, match="needs a term"):
        Pipeline([], 1)
    with pytest.raises(ValueError, match="history: there is no term 'z'"):
        EnvSettings(history={"z": 2}).applied_to([Term("x", (1,))], 0.1)
