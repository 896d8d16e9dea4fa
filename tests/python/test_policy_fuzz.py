"""Whatever stands in metadata and TOML files, the answer is a spec or an InputError."""

from __future__ import annotations

import contextlib
from typing import Any

import gloam
import pytest
from gloam._policy.metadata import merge, settings_of
from gloam._policy.spec import POLICY_KEYS, TERM_KEYS, build_spec
from gloam._policy.terms import TERMS

hypothesis = pytest.importorskip("hypothesis")
from hypothesis import strategies as st  # noqa: E402

MJLAB = {
    "joint_names": "a,b",
    "joint_stiffness": "1.000,2.000",
    "joint_damping": "1.000,2.000",
    "default_joint_pos": "1.000,2.000",
    "action_scale": "0.5",
    "observation_names": "base_ang_vel,joint_pos",
    "observation_terms_scale": "1.000,2.000",
    "observation_terms_clip": "-inf;inf,-1.000;1.000",
    "observation_terms_history_length": "0.000,3.000",
    "observation_terms_flatten_history_dim": "1.000,1.000",
}
HOLOSOMA = {"dof_names": '["a", "b"]', "kp": "[1, 2]", "kd": "[1, 2]", "action_scale": "0.5", "command_ranges": "null"}
TEXTS = st.one_of(
    st.text(max_size=20),
    st.sampled_from(
        [
            "",
            "1.000",
            "a,b",
            "1.000,2.000",
            "nan,1.000",
            "inf,nan",
            "nan",
            "inf,-inf",
            "1e999",
            "-1",
            "[]",
            "null",
            '{"lin_vel_x": 3}',
        ]
    ),
    st.sampled_from(
        ["[1, 2]", '["a", "b"]', '{"lin_vel_x": [1, NaN]}', "base_ang_vel,joint_pos", "3.000;1.000", "1e30"]
    ),
)
NUMBERS = st.one_of(st.floats(), st.integers(), st.booleans(), st.none())
VALUES = st.recursive(
    st.one_of(NUMBERS, st.text(max_size=8), st.sampled_from([".*", "a", "b", "zeros"])),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=6), inner, max_size=3)),
    max_leaves=6,
)
TERM_NAMES = st.sampled_from([info.name for info in TERMS])
GOOD: dict[str, Any] = {"joints": ["a", "b"], "kp": 1.0, "kd": 0.1, "default_positions": [0, 0], "action_scale": 0.5}


@hypothesis.settings(max_examples=400, deadline=None)
@hypothesis.given(
    st.sampled_from([{}, MJLAB, HOLOSOMA]),
    st.dictionaries(st.sampled_from([*MJLAB, *HOLOSOMA]), TEXTS, min_size=1, max_size=2),
)
def test_any_metadata(whole: dict[str, str], metadata: dict[str, str]) -> None:
    with contextlib.suppress(gloam.InputError):
        build_spec(settings_of({**whole, **metadata}, "x.onnx"), "x.onnx")


@hypothesis.settings(max_examples=400, deadline=None)
@hypothesis.given(st.dictionaries(st.sampled_from(POLICY_KEYS), VALUES), st.lists(VALUES, max_size=2))
def test_any_policy_table(policy: dict[str, Any], observation: list[Any]) -> None:
    with contextlib.suppress(gloam.InputError):
        build_spec(merge({"policy": GOOD}, {"policy": policy, "observation": observation}, "x.toml"), "x.toml")


@hypothesis.settings(max_examples=400, deadline=None)
@hypothesis.given(TERM_NAMES, st.dictionaries(st.sampled_from(TERM_KEYS[1:]), VALUES))
def test_any_term(name: str, table: dict[str, Any]) -> None:
    with contextlib.suppress(gloam.InputError):
        spec = build_spec({"policy": GOOD, "observation": [{"term": name, **table}]}, "x.toml")
        assert 1 <= spec.observation_size <= 1000 * 4
