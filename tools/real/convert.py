"""Converts checkpoints to ONNX files with the settings that `gloam bench real` reads."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import clip
import efficientnet
import numpy as np
from checkpoint import CheckpointError, read_state
from graph import save

KINDS = ("efficientnet_lite0", "efficientnet_b0", "clip")
_CLIP_MEAN, _CLIP_DEVIATION = [0.48145466, 0.4578275, 0.40821073], [0.26862954, 0.26130258, 0.27577711]
_LITE_MEAN, _LITE_DEVIATION = [127 / 255] * 3, [128 / 255] * 3  # of TensorFlow's efficientnet-lite


@dataclass(frozen=True)
class Options:
    """prefix: of an encoder's names; labels, vocabulary, template, is_exact_gelu: of CLIP; classes: file with a name per line; note:
    for the page; name: of the network."""

    prefix: str = ""
    labels: tuple[str, ...] = ()
    vocabulary: Path | None = None
    template: str = clip.TEMPLATE
    is_exact_gelu: bool = False
    classes: Path | None = None
    note: str = ""
    name: str = ""


def convert(kind: str, checkpoint: Path, folder: Path, options: Options) -> Path:
    """Writes FOLDER/KIND.onnx and FOLDER/KIND.toml, which it returns. Errors: CheckpointError."""
    state = read_state(checkpoint)
    digest = hashlib.sha256(checkpoint.read_bytes()).hexdigest()
    classes: list[str] = []
    if options.classes is not None:
        classes = [line.strip() for line in options.classes.read_text(encoding="utf-8").splitlines()]
    layer: dict[str, Any] = {"layer": "layer", "features": "features"}
    if kind == "clip":
        labels = None
        if options.labels:
            if options.vocabulary is None:
                raise CheckpointError("labels need the vocabulary of CLIP")
            texts = [options.template.replace("{}", label) for label in options.labels]
            labels = clip.embed(state, texts, options.vocabulary, options.is_exact_gelu)
            classes = list(options.labels)
        model, side = clip.build(state, labels, options.is_exact_gelu)
        has_scores, mean, deviation = labels is not None, _CLIP_MEAN, _CLIP_DEVIATION
        layer["tokens"] = 1
    else:
        model, has_scores = efficientnet.build(state, options.prefix)
        side = efficientnet.SIZE
        is_lite = kind == "efficientnet_lite0"
        if is_lite == any("_se_reduce" in name or ".fc1." in name for name in state):
            raise CheckpointError(f"{checkpoint}: this is not a checkpoint of {kind}")
        mean, deviation = (_LITE_MEAN, _LITE_DEVIATION) if is_lite else ([0.485, 0.456, 0.406], [0.229, 0.224, 0.225])
    if has_scores:
        layer["scores"] = "scores"
    folder.mkdir(parents=True, exist_ok=True)
    save(model, folder / f"{kind}.onnx")
    settings: dict[str, Any] = {
        "name": options.name or kind,
        "file": f"{kind}.onnx",
        "note": f"{options.note} " * bool(options.note) + f"Converted from {checkpoint.name}, SHA-256 {digest[:16]}….",
    }
    if classes and has_scores:
        (folder / f"{kind}.txt").write_text("\n".join(classes) + "\n", encoding="utf-8")
        settings["classes"] = f"{kind}.txt"
    image = {"size": [side, side], "fit": "crop", "filter": "bicubic", "mean": mean, "deviation": deviation}
    path = folder / f"{kind}.toml"
    path.write_text(_toml({"": settings, "input": image, "output": layer}), encoding="utf-8")
    return path


def _toml(tables: dict[str, dict[str, Any]]) -> str:
    lines = []
    for name, table in tables.items():
        lines += [f"\n[{name}]"] * bool(name)
        lines += [f"{key} = {json.dumps(_plain(value), ensure_ascii=False)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


def _plain(value: Any) -> Any:
    return [float(v) if isinstance(v, np.floating) else v for v in value] if isinstance(value, list) else value
