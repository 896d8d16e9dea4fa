"""Files of others: what holosoma's networks tell, and that the metadata of our tests is what mjlab writes."""

from __future__ import annotations

import ast
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402
from gloam.policy import Policy, read_policy_metadata  # noqa: E402

import policy_data  # noqa: E402
from policy_fixtures import MJLAB  # noqa: E402

pytestmark = pytest.mark.slow


def _data() -> policy_data.Fetched:
    try:
        return policy_data.fetch()
    except RuntimeError as error:
        pytest.skip(str(error))


def test_metadata_of_mjlab_is_in_its_own_words() -> None:
    """The text that mjlab's own function makes of such lists is what the tests above read."""
    tree = ast.parse((_data().folder / "mjlab" / "rl" / "exporter_utils.py").read_text())
    wanted = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "list_to_csv_str"]
    names: dict[str, Any] = {}
    exec(compile(ast.Module(wanted, []), "exporter_utils.py", "exec"), names)
    write = names["list_to_csv_str"]
    infinite = [-math.inf, math.inf]
    assert write(["hip", "knee"]) == MJLAB["joint_names"] and write([20.0, 10.0]) == MJLAB["joint_stiffness"]
    assert write([[0.25, 0.5, 1.0], 1.0, 1.0, 1.0, 2.0]) == MJLAB["observation_terms_scale"]
    assert write([True] * 5) == MJLAB["observation_terms_flatten_history_dim"]
    assert write([0, 0, 3, 0, 0]) == MJLAB["observation_terms_history_length"]
    assert write([infinite, [-1.0, 1.0], infinite, infinite, infinite]) == MJLAB["observation_terms_clip"]


def test_metadata_of_holosoma() -> None:
    told = read_policy_metadata(_data().holosoma / "loco" / "g1_29dof" / "ppo_g1_29dof.onnx")["policy"]
    assert len(told["joints"]) == 29 and told["joints"][3] == "left_knee_joint"
    assert told["kp"][1] == 99.098427777 and told["kd"][28] == 1.068141502
    assert told["command_ranges"] == {"vx": [-1.0, 1.0], "vy": [-1.0, 1.0], "yaw_rate": [-1.0, 1.0]}
    assert told["history_start"] == "zeros"


def test_holosoma_with_its_toml() -> None:
    settings = Path(__file__).resolve().parents[2] / "examples" / "python" / "g1_policy.toml"
    policy = Policy(_data().holosoma / "loco" / "g1_29dof" / "ppo_g1_29dof.onnx", settings)
    assert policy.spec.observation_size == 100 and policy.infer(np.zeros(100)).shape == (29,)
    assert policy.spec.default_positions[16] == 0.2 and policy.spec.default_positions[23] == -0.2  # shoulder rolls


def test_holosoma_alone_tells_what_is_missing() -> None:
    with pytest.raises(
        gloam.InputError, match=r"\[policy\] action_scale, default_positions and \[\[observation\]\] terms"
    ):
        Policy(_data().holosoma / "loco" / "g1_29dof" / "ppo_g1_29dof.onnx")


def test_motion_tracking_of_holosoma_needs_its_toml() -> None:
    network = _data().holosoma / "wbt" / "ppo_g1_29dof_dancing.onnx"
    with pytest.raises(gloam.InputError, match=r"\[\[observation\]\] terms"):
        Policy(network)
    policy = Policy(network, Path(__file__).resolve().parents[2] / "examples" / "python" / "g1_dance.toml")
    assert set(policy.spec.networks[0].inputs) == {"obs", "time_step"}
    with pytest.raises(gloam.UsageError, match="several networks or inputs"):
        policy.infer(np.zeros(policy.spec.observation_size))
