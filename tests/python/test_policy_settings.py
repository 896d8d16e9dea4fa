"""What a policy was trained with: metadata of mjlab and holosoma, TOML, and all that may be wrong with it."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("openvino")
pytest.importorskip("onnx")
import gloam  # noqa: E402
from gloam.policy import TERMS, Policy  # noqa: E402

from policy_fixtures import MJLAB, MJLAB_SIZE, OBSERVATION, POLICY, write_network, write_settings  # noqa: E402


def test_metadata_of_mjlab(tmp_path: Path) -> None:
    spec = Policy(write_network(tmp_path / "p.onnx", np.zeros((2, MJLAB_SIZE)), metadata=MJLAB)).spec
    assert spec.joints == ("hip", "knee")
    assert spec.kp.tolist() == [20.0, 10.0] and spec.kd.tolist() == [0.5, 0.25]
    assert spec.default_positions.tolist() == [-0.2, 0.3] and spec.action_scale.tolist() == [0.5, 0.25]
    assert [term.name for term in spec.terms] == [
        "base_ang_vel",
        "projected_gravity",
        "joint_pos",
        "last_action",
        "velocity_commands",
    ]
    assert spec.terms[0].scale == (0.25, 0.5, 1.0) and spec.terms[4].scale == (2.0,)
    assert spec.terms[1].clip == (-1.0, 1.0) and spec.terms[0].clip == (-math.inf, math.inf)
    assert [term.history for term in spec.terms] == [1, 1, 3, 1, 1]
    assert spec.history_start == "repeat" and spec.rate == 50


def test_one_action_scale_of_mjlab_is_everybodys(tmp_path: Path) -> None:
    file = write_network(tmp_path / "p.onnx", np.zeros((2, MJLAB_SIZE)), metadata={**MJLAB, "action_scale": "0.5"})
    assert Policy(file).spec.action_scale.tolist() == [0.5, 0.5]


@pytest.mark.parametrize(
    "key, value, says",
    [
        ("observation_terms_scale", "1.000,1.000", "2 entries for 5 observation terms"),
        ("joint_stiffness", "20.000", None),  # one number is everybody's
        ("joint_stiffness", "20.000,10.000,5.000", "kp has 3 numbers for 2 joints of the policy"),
        ("joint_damping", "0.5,many", "not a list of numbers"),
        (
            "observation_names",
            "base_ang_vel,projected_gravity,height_scam,actions,command",
            "there is no observation term 'height_scam'.*did you mean 'height_scan'",
        ),
        ("observation_terms_flatten_history_dim", "1.000,1.000,0.000,1.000,1.000", "not flattened"),
        (
            "observation_terms_history_length",
            "0.000,0.000,4.000,0.000,0.000",
            "terms have 19 numbers, but the network takes 17",
        ),
        ("observation_terms_history_length", "0.000,0.000,nan,0.000,0.000", "history of nan"),
        ("observation_terms_history_length", "0.000,0.000,inf,0.000,0.000", "history of inf"),
        ("observation_terms_history_length", "0.000,0.000,2.500,0.000,0.000", "history of 2.5"),
        ("default_joint_pos", "nan,0.3", "finite"),
        ("joint_names", "hip,hip", "lists hip twice"),
    ],
)
def test_wrong_metadata_of_mjlab(tmp_path: Path, key: str, value: str, says: str | None) -> None:
    file = write_network(tmp_path / "p.onnx", np.zeros((2, MJLAB_SIZE)), metadata={**MJLAB, key: value})
    if says is None:
        Policy(file)
        return
    with pytest.raises(gloam.InputError, match=says) as caught:
        Policy(file)
    assert caught.value.file == str(file)


def test_toml_overrides_metadata(tmp_path: Path) -> None:
    file = write_network(tmp_path / "p.onnx", np.zeros((2, MJLAB_SIZE)), metadata=MJLAB)
    settings = write_settings(tmp_path, "[policy]\nkp = 7\nrate = 100\ndefault_positions = { knee = 1.0 }\n")
    spec = Policy(file, settings).spec
    assert spec.kp.tolist() == [7.0, 7.0] and spec.rate == 100 and spec.default_positions.tolist() == [0.0, 1.0]
    assert spec.kd.tolist() == [0.5, 0.25] and len(spec.terms) == 5


def test_patterns_exact_names_and_later_lines_win(tmp_path: Path) -> None:
    file = write_network(tmp_path / "p.onnx", np.zeros((2, 7)))
    text = POLICY.replace("kp = [10.0, 20.0]", 'kp = { knee = 1, "k.*" = 2, ".*" = 3 }') + OBSERVATION
    assert Policy(file, write_settings(tmp_path, text)).spec.kp.tolist() == [1.0, 3.0]


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("rate = 50", "rate = 0", "rate is 0; it must be between 0 and"),
        ("rate = 50", "rate = true", "rate must be a number"),
        ("rate = 50", "rates = 50", r"\[policy\] has no 'rates'"),
        ("kp = [10.0, 20.0]", "", r"does not contain \[policy\] kp"),
        ("kp = [10.0, 20.0]", "kp = [10.0]", "kp has 1 numbers for 2 joints of the policy"),
        ("kp = [10.0, 20.0]", "kp = [10.0, -1.0]", "kp of hip is negative"),
        ("kp = [10.0, 20.0]", "kp = { hip = 1.0 }", "kp has no number for knee"),
        ("kp = [10.0, 20.0]", 'kp = { "ankle" = 1.0 }', "'ankle' matches no joint"),
        ("kp = [10.0, 20.0]", 'kp = { "(" = 1.0 }', "not a valid regular expression"),
        ("kp = [10.0, 20.0]", "kp = [10.0, nan]", "finite"),
        ("kp = [10.0, 20.0]", 'kp = "stiff"', "kp must be a number"),
        ('joints = ["knee", "hip"]', 'joints = "knee"', "joints must be a list of names"),
        ('joints = ["knee", "hip"]', 'joints = ["knee"]', "kp has 2 numbers for 1 joints of the policy"),
        (
            'term = "joint_vel"',
            'term = "joint_velo"',
            "there is no observation term 'joint_velo'.*did you mean 'joint_vel'",
        ),
        ('term = "joint_vel"', "scale = 2", "needs a term"),
        ('term = "joint_vel"', 'term = "joint_vel"\nscales = 2', "has no 'scales'"),
        ('term = "joint_vel"', 'term = "joint_vel"\nscale = [1, 2, 3]', "scale has 3 numbers, but the term has 2"),
        ('term = "joint_vel"', 'term = "joint_vel"\nclip = [1, -1]', "low 1 is above high -1"),
        ('term = "joint_vel"', 'term = "joint_vel"\nclip = [1]', r"clip must be \[low, high\]"),
        ('term = "joint_vel"', 'term = "joint_vel"\nhistory = 0', "history must be a whole number from 1"),
        (
            'term = "joint_vel"',
            'term = "joint_vel"\nhistory = 2',
            "have 9 numbers, but the network takes 7.*joint_pos 2, joint_vel 4",
        ),
        ("[policy]", "[polices]\n[policy]", "has no 'polices'.*did you mean 'policy'"),
        ("action_scale = 0.5", 'action_scale = 0.5\nhistory_start = "ones"', "history_start"),
        ("action_scale = 0.5", "action_scale = 0.5\ncommand_ranges = { vz = 1 }", "command_ranges has no 'vz'"),
        ("action_scale = 0.5", "action_scale = 0.5\nvelocity_feedback = -1", "velocity_feedback is -1"),
        ("action_scale = 0.5", 'action_scale = 0.5\nmodel_joints = { ankle = "a" }', "model_joints has no 'ankle'"),
        ("action_scale = 0.5", "action_scale = = 0.5", "is not valid TOML"),
    ],
)
def test_wrong_settings(tmp_path: Path, old: str, new: str, says: str) -> None:
    file = write_network(tmp_path / "p.onnx", np.zeros((2, 7)))
    text = POLICY + OBSERVATION
    assert old in text
    settings = write_settings(tmp_path, text.replace(old, new, 1))
    with pytest.raises(gloam.InputError, match=says) as caught:
        Policy(file, settings)
    assert caught.value.file == str(settings)


def test_too_little_known_says_what_and_where(tmp_path: Path) -> None:
    with pytest.raises(
        gloam.InputError, match=r"joints, kp, kd, action_scale, default_positions and \[\[observation\]\].*to a TOML"
    ):
        Policy(write_network(tmp_path / "p.onnx", np.zeros((2, 7))))


def test_wrong_networks(tmp_path: Path) -> None:
    settings = write_settings(tmp_path)
    with pytest.raises(gloam.IoError, match="no such file"):
        Policy(tmp_path / "none.onnx", settings)
    (tmp_path / "text.onnx").write_text("this is no network")
    with pytest.raises(gloam.InputError, match="damaged or not an ONNX file"):
        Policy(tmp_path / "text.onnx", settings)
    with pytest.raises(gloam.IoError, match="no such file"):
        Policy(write_network(tmp_path / "p.onnx", np.zeros((2, 7))), tmp_path / "none.toml")
    with pytest.raises(gloam.InputError, match="there are 2 joints, but the network outputs 3 numbers"):
        Policy(write_network(tmp_path / "p.onnx", np.zeros((3, 7))), settings)
    inputs = write_network(tmp_path / "p.onnx", np.zeros((2, 7)), inputs=("obs", "time_step"))
    with pytest.raises(gloam.InputError, match="0 numbers, but the network's input 'time_step' takes 1"):
        Policy(inputs, settings)
    with pytest.raises(gloam.UsageError, match="needs a network or settings"):
        Policy(None)


def test_without_openvino_the_error_names_the_remedy(tmp_path: Path) -> None:
    """In a process of its own, since the library is opened once."""
    file = write_network(tmp_path / "p.onnx", np.zeros((2, 7)))
    program = (
        "import gloam, sys\ntry: gloam.Policy(*sys.argv[1:])\nexcept gloam.UnsupportedError as error: print(error.hint)"
    )
    result = subprocess.run(
        [sys.executable, "-c", program, file, write_settings(tmp_path)],
        env={**os.environ, "GLOAM_OPENVINO": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert "pip install openvino" in result.stdout, result.stderr


def test_openvino_of_the_interpreter_is_found() -> None:
    """Without GLOAM_OPENVINO, and without importing the package."""
    environment = {key: value for key, value in os.environ.items() if key != "GLOAM_OPENVINO"}
    program = "import gloam, os, sys\nprint(os.environ['GLOAM_OPENVINO'], 'openvino' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    folder, is_imported = result.stdout.split()
    assert (Path(folder) / "libs").is_dir() and is_imported == "False", result.stderr


def test_inference_of_one_and_many(tmp_path: Path) -> None:
    weights = np.arange(14.0).reshape(2, 7) / 10
    policy = Policy(write_network(tmp_path / "p.onnx", weights, np.array([1.0, -1.0])), write_settings(tmp_path))
    many = np.random.default_rng(1).normal(size=(3, 7))
    np.testing.assert_allclose(policy.infer(many[0]), weights @ many[0] + [1, -1], rtol=1e-5)
    np.testing.assert_array_equal(policy.infer(many)[1], policy.infer(many[1]))
    for wrong in (np.zeros(6), np.zeros((2, 8)), np.zeros((1, 1, 7)), 1.0):
        with pytest.raises(gloam.UsageError, match="7 numbers"):
            policy.infer(wrong)
    with pytest.raises(gloam.DivergedError, match="its observation is not finite either"):
        policy.infer(np.full(7, np.nan))


def test_networks_are_computed_in_f32(tmp_path: Path) -> None:
    policy = Policy(write_network(tmp_path / "p.onnx", np.ones((2, 7))), write_settings(tmp_path))
    observation = np.array([1, 2**-20, 0, 0, 0, 0, 0], np.float32)  # the sum has more digits than a bf16
    assert policy.infer(observation).tolist() == [1 + 2**-20] * 2


def test_terms_are_documented() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "policies.md").read_text()
    for term in TERMS:
        assert f"`{term.name}`" in page and all(f"`{alias}`" in page for alias in term.aliases), term.name


def test_the_toml_of_the_documentation(tmp_path: Path) -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "policies.md").read_text()
    text = page.split("## The TOML\n")[1].split("``` toml\n")[1].split("```")[0]
    spec = Policy(write_network(tmp_path / "p.onnx", np.zeros((2, 3))), write_settings(tmp_path, text)).spec
    assert spec.default_positions.tolist() == [0.0, 0.8] and spec.command_ranges["vy"] == (-0.5, 0.5)
    assert spec.model_joints == {"FR_hip_joint": "fr_hip"} and spec.terms[0].sensor == "imu_gyro"
