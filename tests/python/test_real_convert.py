"""Converters of checkpoints; test_real_torch.py compares them with PyTorch."""

from __future__ import annotations

import gzip
import json
import pickle
import struct
import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gloam.real.network import Network, load_settings
from real_fixtures import picture

sys.path.append(str(Path(__file__).resolve().parents[2] / "tools" / "real"))
import checkpoint  # noqa: E402
import clip  # noqa: E402
import convert  # noqa: E402
import efficientnet  # noqa: E402

RANDOM = np.random.default_rng(2)


def b0_state(is_lite: bool) -> dict[str, np.ndarray]:
    """Random parameters with the names of efficientnet_pytorch."""
    state: dict[str, np.ndarray] = {}

    def conv(name: str, norm: str, *shape: int) -> None:
        state[f"{name}.weight"] = RANDOM.standard_normal(shape).astype(np.float32) * (2 / np.prod(shape[1:])) ** 0.5
        for part in ("weight", "bias", "running_mean", "running_var"):
            state[f"{norm}.{part}"] = RANDOM.uniform(0.5, 1.5, shape[0]).astype(np.float32)

    conv("_conv_stem", "_bn0", 32, 3, 3, 3)
    inputs, number = 32, 0
    for expansion, outputs, count, _, kernel in efficientnet._STAGES:
        for _ in range(count):
            name, wide = f"_blocks.{number}", inputs * expansion
            if expansion > 1:
                conv(f"{name}._expand_conv", f"{name}._bn0", wide, inputs, 1, 1)
            conv(f"{name}._depthwise_conv", f"{name}._bn1", wide, 1, kernel, kernel)
            if not is_lite:
                narrow = max(1, inputs // 4)
                for part, rows, columns in (("_se_reduce", narrow, wide), ("_se_expand", wide, narrow)):
                    state[f"{name}.{part}.weight"] = RANDOM.standard_normal((rows, columns, 1, 1)).astype(np.float32) * 0.1
                    state[f"{name}.{part}.bias"] = RANDOM.standard_normal(rows).astype(np.float32) * 0.1
            conv(f"{name}._project_conv", f"{name}._bn2", outputs, wide, 1, 1)
            inputs, number = outputs, number + 1
    conv("_conv_head", "_bn1", 1280, 320, 1, 1)
    state |= {"_fc.weight": RANDOM.standard_normal((7, 1280)).astype(np.float32), "_fc.bias": np.zeros(7, np.float32)}
    return state


def safetensors(path: Path, state: dict[str, np.ndarray]) -> Path:
    header, blobs, at = {}, [], 0
    for name, value in state.items():
        data = np.ascontiguousarray(value, np.float32).tobytes()
        header[name] = {"dtype": "F32", "shape": list(value.shape), "data_offsets": [at, at + len(data)]}
        blobs.append(data)
        at += len(data)
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + b"".join(blobs))
    return path


@pytest.mark.parametrize("kind", ["efficientnet_lite0", "efficientnet_b0"])
def test_efficientnet_converts_and_runs(tmp_path: Path, kind: str) -> None:
    state = b0_state(kind == "efficientnet_lite0")
    file = safetensors(tmp_path / "a.safetensors", state)
    path = convert.convert(kind, file, tmp_path / "out", convert.Options())
    found = Network(load_settings(path))
    answer = found.run(picture(1))
    assert answer.layer.shape == (1280, 7, 7) and len(answer.features) == 1280 and answer.scores is not None and len(answer.scores) == 7
    assert np.allclose(found.gradient(answer, 3).mean((1, 2)), state["_fc.weight"][3] / 49, rtol=1e-5)
    assert "a.safetensors, SHA-256" in found.settings.note
    encoder = safetensors(tmp_path / "b.safetensors", {f"obs_encoder.{name}": value for name, value in state.items()})
    if kind == "efficientnet_b0":
        part = Network(load_settings(convert.convert(kind, encoder, tmp_path / "vint", convert.Options(prefix="obs_encoder."))))
        assert part.tail is None and np.allclose(part.run(picture(1)).features, answer.features, rtol=1e-4)
    other = "efficientnet_b0" if kind == "efficientnet_lite0" else "efficientnet_lite0"
    with pytest.raises(checkpoint.CheckpointError, match=f"not a checkpoint of {other}"):
        convert.convert(other, file, tmp_path / "no", convert.Options())
    for broken, words in (
        ({"extra.weight": np.zeros(3)}, "1 further tensors"),
        ({"_bn1.bias": np.zeros(3)}, r"shape \(1280,\), got \(3,\)"),
    ):
        with pytest.raises(checkpoint.CheckpointError, match=words):
            efficientnet.build(state | broken)


def vocabulary(path: Path) -> Path:
    """A vocabulary of CLIP's layout in which "co" and "cone" are merged."""
    lines = ["#version", "n e</w>", "c o", "co ne</w>"] + [f"x{k} y" for k in range(49152 - 256 - 2 - 3)]
    with gzip.open(path, "wt", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


def test_tokens_of_labels(tmp_path: Path) -> None:
    tokenizer = clip.Tokenizer(vocabulary(tmp_path / "bpe.txt.gz"))
    start, *words, end = tokenizer.encode(" A  Cone!")
    assert (start, end) == (49406, 49407), "CLIP's numbers of its start and end"
    letter = {chr(byte): k for k, byte in enumerate([*range(33, 127)])}
    assert words == [256 + letter["a"], 512 + 2, 256 + letter["!"]]
    with pytest.raises(checkpoint.CheckpointError, match="too long"):
        tokenizer.encode("cone " * 80)
    with pytest.raises(checkpoint.CheckpointError, match="not CLIP's vocabulary"):
        clip.Tokenizer(tmp_path / "none")


def test_checkpoints_execute_nothing(tmp_path: Path) -> None:
    class Evil:
        def __reduce__(self) -> Any:
            return (print, ("executed",))

    with zipfile.ZipFile(tmp_path / "evil.pt", "w") as archive:
        archive.writestr("a/data.pkl", pickle.dumps({"w": Evil()}, 2))
    with pytest.raises(checkpoint.CheckpointError, match="may execute code"):
        checkpoint.read_state(tmp_path / "evil.pt")
    (tmp_path / "old.pth").write_bytes(pickle.dumps(Evil(), 2))
    with pytest.raises(checkpoint.CheckpointError, match="may execute code"):
        checkpoint.read_state(tmp_path / "old.pth")
    for name, data in (("junk.pth", b"junk"), ("empty.pth", b""), ("half.safetensors", struct.pack("<Q", 90) + b'{"a"')):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(checkpoint.CheckpointError, match="not a checkpoint"):
            checkpoint.read_state(tmp_path / name)
    spoilt = safetensors(tmp_path / "nan.safetensors", {"a": np.array([np.nan])})
    with pytest.raises(checkpoint.CheckpointError, match="not finite"):
        checkpoint.read_state(spoilt)
