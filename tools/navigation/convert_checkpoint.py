"""Converts published checkpoints of GNM, ViNT and NoMaD to ONNX files for Gloam's planners.

    python3 tools/navigation/convert_checkpoint.py vint vint_state.pth weights/         # writes weights/vint.onnx
    python3 tools/navigation/convert_checkpoint.py nomad nomad.pth weights/             # three files

Requires `pip install torch onnx`, and onnxscript for releases of PyTorch without the older exporter
(docs/navigation_networks.md). It never executes code from a checkpoint.
"""

from __future__ import annotations

import argparse
import pickle
import sys
from pathlib import Path
from typing import Any

import torch
from models import Gnm, Nomad, Vint
from torch import Tensor, nn

OPSET = 17
MOST_SHOWN = 8  # names in a report
REMEDY = """the checkpoint contains a pickled module, which can execute code when it is loaded, and is therefore refused.
Rewrite it once in an environment in which you trust the file and which has the authors' package vint_train:

    import torch
    model = torch.load("vint.pth", map_location="cpu", weights_only=False)["model"]
    torch.save(getattr(model, "module", model).state_dict(), "vint_state.pth")
"""


class CheckpointError(Exception):
    """A checkpoint that cannot be converted."""


def read_state(path: Path) -> dict[str, Tensor]:
    """Tensors by name, from a state dict or a dict whose "model" is one. Errors: CheckpointError."""
    try:
        contents: Any = torch.load(path, map_location="cpu", weights_only=True)
    except pickle.UnpicklingError as error:
        if "GLOBAL" in str(error) or "weights_only" in str(error).lower():
            raise CheckpointError(f"{path}: {REMEDY}") from error
        raise CheckpointError(f"{path}: this is not a checkpoint of PyTorch") from error
    except OSError as error:
        raise CheckpointError(f"{path}: cannot read the checkpoint: {error.strerror}") from error
    except Exception as error:  # damaged files end in exceptions of many kinds
        raise CheckpointError(f"{path}: this is not a checkpoint of PyTorch") from error
    if isinstance(contents, dict) and isinstance(contents.get("model"), dict):
        contents = contents["model"]
    if not isinstance(contents, dict) or not contents:
        raise CheckpointError(f"{path}: a checkpoint must be a dict of tensors, got {type(contents).__name__}")
    for name, value in contents.items():
        if not isinstance(name, str) or not isinstance(value, Tensor):
            raise CheckpointError(f"{path}: '{name}' must be a tensor, got {type(value).__name__}")
    if all(name.startswith("module.") for name in contents):  # of torch.nn.DataParallel
        contents = {name.removeprefix("module."): value for name, value in contents.items()}
    return contents


def load_strictly(model: nn.Module, state: dict[str, Tensor]) -> None:
    """Fills a model. Errors: CheckpointError with all differences of names and shapes, and for numbers not finite."""
    wanted = model.state_dict()
    # BatchNorm counts its batches in training; evaluation does not read the count, and old checkpoints lack it.
    missing = [n for n in wanted if n not in state and not n.endswith("num_batches_tracked")]
    unexpected = [name for name in state if name not in wanted]
    shapes = [
        f"{name}: {tuple(wanted[name].shape)} expected, {tuple(value.shape)} found"
        for name, value in state.items()
        if name in wanted and wanted[name].shape != value.shape
    ]
    spoilt = [n for n, value in state.items() if value.is_floating_point() and not bool(torch.isfinite(value).all())]
    lines = []
    for title, names in (("missing", missing), ("unexpected", unexpected), ("other shapes", shapes), ("not finite", spoilt)):
        if names:
            more = f" … and {len(names) - MOST_SHOWN} more" if len(names) > MOST_SHOWN else ""
            lines.append(f"  {title} ({len(names)}): " + ", ".join(names[:MOST_SHOWN]) + more)
    if lines:
        raise CheckpointError("the checkpoint does not fit the network:\n" + "\n".join(lines))
    model.load_state_dict(wanted | state, strict=True)


def export(model: nn.Module, path: Path, inputs: dict[str, Tensor], outputs: list[str], free: tuple[str, ...] = ()) -> None:
    """Writes an ONNX file. free: names of inputs and outputs whose first size stays open. Errors: CheckpointError."""
    import onnx

    arguments: dict[str, Any] = {"input_names": list(inputs), "output_names": outputs, "opset_version": OPSET}
    if free:
        arguments["dynamic_axes"] = {name: {0: "n"} for name in free}
    with torch.no_grad():
        torch.onnx.export(model.eval(), tuple(inputs.values()), str(path), dynamo=False, **arguments)
    onnx.checker.check_model(str(path), full_check=True)


def image_inputs(context_size: int, size: tuple[int, int]) -> dict[str, Tensor]:
    """Inputs of zeros for an export; size: (width, height)."""
    width, height = size
    return {
        "obs_img": torch.zeros(1, 3 * (context_size + 1), height, width),
        "goal_img": torch.zeros(1, 3, height, width),
    }


def export_direct(model: Gnm | Vint, path: Path, context_size: int = 5) -> None:
    """Writes gnm.onnx or vint.onnx with the signature of gloam/navigation/networks/preprocessing.py."""
    export(model, path, image_inputs(context_size, (85, 64)), ["dist", "action"])


def export_nomad(model: Nomad, folder: Path, context_size: int = 3) -> list[Path]:
    """Writes the three files of planner `nomad`; only the count of samples stays open. Returns their paths."""
    paths = [folder / f"nomad_{name}.onnx" for name in ("encoder", "distance", "noise")]
    images = image_inputs(context_size, (96, 96)) | {"goal_mask": torch.zeros(1, dtype=torch.int64)}
    width = model.vision_encoder.compress_obs_enc.out_features
    export(model.vision_encoder, paths[0], images, ["embedding"])
    export(model.dist_pred_net, paths[1], {"embedding": torch.zeros(1, width)}, ["dist"])
    sample = {"sample": torch.zeros(2, 8, 2), "timestep": torch.zeros(1, dtype=torch.int64)}
    free = ("sample", "embedding", "noise")
    export(model.noise_pred_net, paths[2], sample | {"embedding": torch.zeros(2, width)}, ["noise"], free)
    return paths


def convert(kind: str, checkpoint: Path, folder: Path) -> list[Path]:
    """Converts a checkpoint of "gnm", "vint" or "nomad" into a folder. Returns the files. Errors: CheckpointError."""
    state = read_state(checkpoint)
    folder.mkdir(parents=True, exist_ok=True)
    if kind == "nomad":
        nomad = Nomad()
        load_strictly(nomad, state)
        return export_nomad(nomad, folder)
    model = Gnm() if kind == "gnm" else Vint()
    load_strictly(model, state)
    path = folder / f"{kind}.onnx"
    export_direct(model, path)
    return [path]


def main() -> int:
    """The program. Returns its exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("kind", choices=("gnm", "vint", "nomad"))
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("folder", type=Path, help="for the ONNX files")
    options = parser.parse_args()
    try:
        for path in convert(options.kind, options.checkpoint, options.folder):
            print(path)
    except CheckpointError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
