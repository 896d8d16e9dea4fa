"""A program of tests/python/test_navigation_torch.py: converts networks of random numbers and compares planners with an
evaluation in PyTorch that uses the parameters by their published names and none of our modules."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path
from typing import Any

sys.setdlopenflags(os.RTLD_LAZY | os.RTLD_GLOBAL)
try:
    import torch
    import torch.onnx
except ImportError as error:
    print(f"skip: {error}")
    sys.exit(0)
sys.setdlopenflags(os.RTLD_NOW)

import convert_checkpoint  # noqa: E402
import models  # noqa: E402
import numpy as np  # noqa: E402
from gloam.navigation import Node, Observation, Task, TopologicalMap, Waypoints, make_planner  # noqa: E402
from gloam.navigation.networks.preprocessing import ContextStack, prepare  # noqa: E402
from test_navigation_networks import reference_ddpm  # noqa: E402
from torch import Tensor  # noqa: E402
from torch.nn import functional as f  # noqa: E402

State = dict[str, Tensor]
RANDOM = np.random.default_rng(11)
TOLERANCE = 1e-4


def spread(model: Any) -> Any:
    """Gives all parameters random numbers: a new network hides errors, since its output hardly depends on the images."""
    for name, value in model.state_dict().items():
        if "running_var" in name:
            value.uniform_(0.5, 1.5)
        elif value.is_floating_point() and "pos_enc" not in name and value.ndim == 1:
            value.add_(torch.randn_like(value) * 0.05)
        elif value.is_floating_point() and "pos_enc" not in name:
            value.normal_(0, (2 / value[0].numel()) ** 0.5)
    return model.eval()


def norm(s: State, name: str, x: Tensor, eps: float) -> Tensor:
    if name + ".running_mean" not in s:
        return f.group_norm(x, x.shape[1] // 16, s[name + ".weight"], s[name + ".bias"])
    mean, variance = s[name + ".running_mean"], s[name + ".running_var"]
    return f.batch_norm(x, mean, variance, s[name + ".weight"], s[name + ".bias"], eps=eps)


def linear(s: State, name: str, x: Tensor) -> Tensor:
    return f.linear(x, s[name + ".weight"], s[name + ".bias"])


def mobile(s: State, name: str, x: Tensor) -> Tensor:
    """MobileNetV2 of torchvision."""

    def unit(x: Tensor, conv: str, bn: str, stride: int = 1, acts: bool = True) -> Tensor:
        weight = s[f"{name}.{conv}.weight"]
        groups = x.shape[1] if weight.shape[1] == 1 else 1
        x = norm(s, f"{name}.{bn}", f.conv2d(x, weight, None, stride, weight.shape[2] // 2, 1, groups), 1e-5)
        return f.relu6(x) if acts else x

    x = unit(x, "0.0", "0.1", 2)
    for i in range(1, 18):
        before, stride = x, 2 if i in (2, 4, 7, 14) else 1
        if i == 1:
            x = unit(unit(x, "1.conv.0.0", "1.conv.0.1"), "1.conv.1", "1.conv.2", 1, False)
            continue
        x = unit(unit(x, f"{i}.conv.0.0", f"{i}.conv.0.1"), f"{i}.conv.1.0", f"{i}.conv.1.1", stride)
        x = unit(x, f"{i}.conv.2", f"{i}.conv.3", 1, False)
        x = x + before if x.shape == before.shape and stride == 1 else x
    return unit(x, "18.0", "18.1").mean((2, 3))


def efficient(s: State, name: str, x: Tensor) -> Tensor:
    """EfficientNet-B0 of efficientnet_pytorch, whose padding is that of images of 224 x 224."""
    side = 224

    def conv(x: Tensor, part: str, stride: int) -> Tensor:
        nonlocal side
        weight = s[f"{name}.{part}.weight"]
        out = math.ceil(side / stride)
        missing = max((out - 1) * stride + weight.shape[2] - side, 0)
        side = out
        x = f.pad(x, [missing // 2, missing - missing // 2] * 2)
        return f.conv2d(x, weight, None, stride, groups=x.shape[1] if weight.shape[1] == 1 else 1)

    def swish(x: Tensor) -> Tensor:
        return x * torch.sigmoid(x)

    x = swish(norm(s, f"{name}._bn0", conv(x, "_conv_stem", 2), 1e-3))
    for i in range(16):
        before, part = x, f"_blocks.{i}"
        if f"{name}.{part}._expand_conv.weight" in s:
            x = swish(norm(s, f"{name}.{part}._bn0", conv(x, f"{part}._expand_conv", 1), 1e-3))
        stride = 2 if i in (1, 3, 5, 11) else 1
        x = swish(norm(s, f"{name}.{part}._bn1", conv(x, f"{part}._depthwise_conv", stride), 1e-3))
        reduce, expand = f"{name}.{part}._se_reduce", f"{name}.{part}._se_expand"
        weight = swish(f.conv2d(f.adaptive_avg_pool2d(x, 1), s[reduce + ".weight"], s[reduce + ".bias"]))
        x = torch.sigmoid(f.conv2d(weight, s[expand + ".weight"], s[expand + ".bias"])) * x
        x = norm(s, f"{name}.{part}._bn2", conv(x, f"{part}._project_conv", 1), 1e-3)
        x = x + before if x.shape == before.shape else x
    return swish(norm(s, f"{name}._bn1", conv(x, "_conv_head", 1), 1e-3)).mean((2, 3))


def transformer(s: State, name: str, x: Tensor, mask: Tensor | None = None) -> Tensor:
    """Sines, and 4 of PyTorch's own layers."""
    width = x.shape[2]
    for place in range(x.shape[1]):
        for i in range(width):
            angle = place / 10000 ** ((i - i % 2) / width)
            x[:, place, i] += math.cos(angle) if i % 2 else math.sin(angle)
    for i in range(4):
        layer = torch.nn.TransformerEncoderLayer(width, 4, 4 * width, activation="gelu", batch_first=True, norm_first=True)
        start = f"{name}.layers.{i}."
        layer.load_state_dict({n.removeprefix(start): v for n, v in s.items() if n.startswith(start)})
        x = layer.eval()(x, src_key_padding_mask=mask)
    return x


def tokens(s: State, start: str, obs: Tensor, goal: Tensor) -> Tensor:
    seen = [efficient(s, start + "obs_encoder", image) for image in obs.split(3, 1)]
    both = efficient(s, start + "goal_encoder", torch.cat([obs[:, -3:], goal], 1))
    out = [linear(s, start + "compress_obs_enc", x) for x in seen] + [linear(s, start + "compress_goal_enc", both)]
    return torch.stack(out, 1)


def heads(s: State, x: Tensor) -> tuple[float, Any]:
    steps = linear(s, "action_predictor.0", x).reshape(5, 4).double().numpy()
    length = np.hypot(steps[:, 2], steps[:, 3])[:, None]
    return float(linear(s, "dist_predictor.0", x)), np.hstack([np.cumsum(steps[:, :2], 0), steps[:, 2:] / length])


def gnm(s: State, obs: Tensor, goal: Tensor) -> tuple[float, Any]:
    x = f.relu(linear(s, "compress_observation.0", mobile(s, "obs_mobilenet", obs)))
    y = f.relu(linear(s, "compress_goal.0", mobile(s, "goal_mobilenet", torch.cat([obs, goal], 1))))
    z = torch.cat([x, f.relu(linear(s, "compress_goal.2", y))], 1)
    return heads(s, f.relu(linear(s, "linear_layers.2", f.relu(linear(s, "linear_layers.0", z)))))


def vint(s: State, obs: Tensor, goal: Tensor) -> tuple[float, Any]:
    x = transformer(s, "decoder.sa_decoder", tokens(s, "", obs, goal)).flatten(1)
    for i in range(5):
        x = f.relu(linear(s, f"decoder.output_layers.{i}", x))
    return heads(s, x)


def embedding(s: State, obs: Tensor, goal: Tensor, masked: bool) -> Tensor:
    mask = torch.tensor([[False] * 4 + [masked]])
    x = transformer(s, "vision_encoder.sa_encoder", tokens(s, "vision_encoder.", obs, goal), mask)
    return x[:, : 4 if masked else 5].mean(1)


def noise(s: State, x: Tensor, step: int, condition: Tensor) -> Tensor:
    """The conditional U-Net of Diffusion Policy. x: (n, 8, 2)."""
    base = "noise_pred_net."
    rates = [math.exp(-i * math.log(10000) / 127) for i in range(128)]
    code = torch.tensor([[math.sin(step * r) for r in rates] + [math.cos(step * r) for r in rates]])
    code = linear(s, base + "diffusion_step_encoder.3", f.mish(linear(s, base + "diffusion_step_encoder.1", code)))
    condition = f.mish(torch.cat([code.repeat(len(x), 1), condition], 1))

    def conv(x: Tensor, name: str) -> Tensor:
        x = f.conv1d(x, s[name + ".0.weight"], s[name + ".0.bias"], padding=1)
        return f.mish(f.group_norm(x, 8, s[name + ".1.weight"], s[name + ".1.bias"]))

    def block(x: Tensor, name: str) -> Tensor:
        out = conv(x, name + ".blocks.0.block") + linear(s, name + ".cond_encoder.1", condition)[:, :, None]
        weight = s.get(name + ".residual_conv.weight")
        side = x if weight is None else f.conv1d(x, weight, s[name + ".residual_conv.bias"])
        return conv(out, name + ".blocks.1.block") + side

    x, kept = x.transpose(1, 2), []
    for i in range(3):
        x = block(block(x, f"{base}down_modules.{i}.0"), f"{base}down_modules.{i}.1")
        kept.append(x)
        if i < 2:
            x = f.conv1d(x, s[f"{base}down_modules.{i}.2.conv.weight"], s[f"{base}down_modules.{i}.2.conv.bias"], 2, 1)
    x = block(block(x, base + "mid_modules.0"), base + "mid_modules.1")
    for i in range(2):
        x = block(torch.cat([x, kept.pop()], 1), f"{base}up_modules.{i}.0")
        name = f"{base}up_modules.{i}.2.conv"
        x = f.conv_transpose1d(block(x, f"{base}up_modules.{i}.1"), s[name + ".weight"], s[name + ".bias"], 2, 1)
    x = conv(x, base + "final_conv.0.block")
    return f.conv1d(x, s[base + "final_conv.1.weight"], s[base + "final_conv.1.bias"]).transpose(1, 2)


def images(count: int) -> list[Any]:
    return [np.asarray(RANDOM.integers(0, 256, (96, 128, 3)), np.uint8) for _ in range(count)]


def check_direct(name: str, model: Any, evaluate: Any, folder: Path) -> None:
    """GNM and ViNT through their planners, over three plans."""
    state = spread(model).state_dict()
    torch.save({"model": {"module." + n: v for n, v in state.items()}, "epoch": torch.tensor(3)}, folder / "published.pth")
    weights = convert_checkpoint.convert(name, folder / "published.pth", folder)[0]
    planner: Any = make_planner(name, weights=weights, radius=1, close_threshold=0.0)
    nodes, stack, closest = images(9), ContextStack(5, (85, 64)), 0
    planner.reset(Task("r", map=TopologicalMap(Node(n, (0, 0, 0), i) for i, n in enumerate(nodes)), top_speed=0.8))
    for image in images(3):
        obs = torch.from_numpy(stack.push(image))
        window = range(max(closest - 1, 0), closest + 3)
        results = [evaluate(state, obs, torch.from_numpy(prepare(nodes[i], (85, 64))[None])) for i in window]
        best = int(np.argmin([distance for distance, _ in results]))
        far = results[best][0] > 0.0
        closest = window[best] if far else window[best] + 1
        expected = results[best if far else min(best + 1, len(results) - 1)][1].copy()
        expected[:, :2] *= 0.8 / 4
        answer = planner.plan(Observation(0, (0, 0, 0), (0, 0, 0), image))
        assert isinstance(answer, Waypoints) and planner.closest == closest
        error = float(np.abs(answer.points - expected).max())
        assert error < TOLERANCE, error
        print(f"{name}: {error:.1e}")


def check_nomad(folder: Path) -> None:
    """NoMaD through its planner, with a goal and without."""
    state = spread(models.Nomad()).state_dict()
    torch.save(state, folder / "nomad.pth")
    convert_checkpoint.convert("nomad", folder / "nomad.pth", folder)
    nodes, (image,) = images(6), images(1)
    obs = torch.from_numpy(ContextStack(3, (96, 96)).push(image))
    goals = [torch.from_numpy(prepare(node, (96, 96))[None]) for node in nodes[:3]]
    codes = [embedding(state, obs, goal, False) for goal in goals]
    layers = [f"dist_pred_net.network.{i}" for i in (0, 2, 4)]
    distances = [float(linear(state, layers[2], f.relu(linear(state, layers[1], f.relu(linear(state, layers[0], c)))))) for c in codes]
    best = int(np.argmin(distances))
    chosen = min(best + int(distances[best] < 3), 2)
    for explore in (False, True):
        code = embedding(state, obs, goals[chosen], True) if explore else codes[chosen]

        def predict(x: Any, t: int, code: Tensor = code) -> Any:
            return noise(state, torch.from_numpy(x).float(), t, code.repeat(len(x), 1)).numpy()

        key = np.array([21, 0], np.uint64)
        expected = reference_ddpm(predict, np.random.Generator(np.random.Philox(key=key)), 4, 10)[0] * 0.4 / 4
        planner: Any = make_planner("nomad", weights=folder, samples=4, radius=1, explore=explore)
        task = Task("r", seed=21, map=TopologicalMap(Node(n, (0, 0, 0), i) for i, n in enumerate(nodes)))
        planner.reset(task)
        answer = planner.plan(Observation(0, (0, 0, 0), (0, 0, 0), image))
        assert isinstance(answer, Waypoints) and planner.closest == best
        error = float(np.abs(answer.points - expected).max())
        assert error < TOLERANCE, error
        print(f"nomad, explore {explore}: {error:.1e}")


def check_refusals(folder: Path) -> None:
    """Checkpoints that must not load."""

    def refused(contents: Any, *parts: str) -> None:
        if not isinstance(contents, bytes):
            torch.save(contents, folder / "bad.pth")
        else:
            (folder / "bad.pth").write_bytes(contents)
        try:
            convert_checkpoint.convert("gnm", folder / "bad.pth", folder / "none")
        except convert_checkpoint.CheckpointError as error:
            assert all(part in str(error) for part in parts), error
        else:
            raise AssertionError(f"accepted a checkpoint that lacks {parts}")

    state = models.Gnm().state_dict()
    refused({"model": torch.nn.Linear(2, 2)}, "pickled module", "torch.save(")
    refused(b"junk", "not a checkpoint")
    refused([state], "dict of tensors")
    refused({}, "dict of tensors")
    refused(state | {"extra.weight": torch.zeros(2)}, "unexpected (1): extra.weight")
    refused({n: v for n, v in state.items() if n != "dist_predictor.0.bias"}, "missing (1): dist_predictor.0.bias")
    refused(state | {"dist_predictor.0.bias": torch.zeros(3)}, "other shapes (1)", "(1,) expected, (3,) found")
    refused(state | {"dist_predictor.0.bias": torch.tensor([math.nan])}, "not finite (1): dist_predictor.0.bias")
    refused(models.Vint().state_dict(), "missing", "unexpected", "more")


def main() -> None:
    torch.manual_seed(4)
    torch.set_grad_enabled(False)
    folder = Path.cwd()
    check_direct("gnm", models.Gnm(), gnm, folder)
    check_direct("vint", models.Vint(), vint, folder)
    check_nomad(folder)
    check_refusals(folder)
    print("equal to PyTorch")


if __name__ == "__main__":
    main()
