"""Networks of the comparison: an ONNX file with a small TOML that names its input, normalisation, layer and outputs."""

from __future__ import annotations

import hashlib
import json
import tempfile
import tomllib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

import gloam
from gloam.navigation.networks.onnx_network import OnnxNetwork

from .images import Fit, Image, fitted
from .tail import Tail

Floats = NDArray[np.float64]
_TABLES: dict[str, dict[str, type | tuple[type, ...]]] = {
    "": {"name": str, "file": str, "note": str, "classes": str, "input": dict, "output": dict},
    "input": {"size": list, "fit": str, "filter": str, "mean": list, "deviation": list, "channels": str, "layout": str},
    "output": {"layer": str, "tokens": int, "features": str, "scores": str},
}
_FITS, _FILTERS = ("crop", "stretch", "pad"), ("bicubic", "bilinear")


@dataclass(frozen=True)
class Settings:
    """Contents of a network's TOML.

    name, note: for the page; size: of the input (width, height) [px], None = the file's; fit, filter: of the resizing; mean,
    deviation: of red, green, blue in 0 … 1; channels: "RGB" or "BGR"; layout: "NCHW" or "NHWC"; layer: tensor for the maps, (1, c,
    h, w) or (1, t, c); tokens: of the latter, the first ones that are no places; features: tensor for distances; scores: tensor of
    class scores before the softmax, "" = the network has no classes; classes: their names, () = numbers.
    """

    name: str
    file: Path
    layer: str
    features: str
    scores: str = ""
    tokens: int = 0
    note: str = ""
    classes: tuple[str, ...] = ()
    size: tuple[int, int] | None = None
    fit: Fit = "crop"
    filter: str = "bicubic"
    mean: tuple[float, ...] = (0.485, 0.456, 0.406)  # of ImageNet's images
    deviation: tuple[float, ...] = (0.229, 0.224, 0.225)
    channels: str = "RGB"
    layout: str = "NCHW"


def load_settings(path: Path) -> Settings:
    """Settings of a TOML file; paths in it are relative to it. Errors: IoError; InputError with the key."""
    try:
        table: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise gloam.IoError(f"cannot read the network's settings: {error.strerror}", str(path)) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise gloam.InputError(f"not valid TOML: {error}", str(path)) from None
    for name in _TABLES:
        part = table if not name else table.get(name, {})
        for key, value in part.items():
            kinds = _TABLES[name].get(key)
            if kinds is None:
                raise gloam.InputError(f"unknown key '{key}'; there are: {', '.join(_TABLES[name])}", str(path))
            if not isinstance(value, kinds) or isinstance(value, bool):
                raise gloam.InputError(f"'{key}' has a value of another type: {value!r}", str(path))
    return _settings(table, path)


def _settings(table: dict[str, Any], path: Path) -> Settings:
    image, output = table.get("input", {}), table.get("output", {})
    for key in ("layer", "features"):
        if key not in output:
            raise gloam.InputError(f"[output] needs '{key}', the name of a tensor", str(path))

    def triple(key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        values = image.get(key, default)
        if len(values) != 3 or not all(isinstance(v, int | float) and np.isfinite(v) for v in values):
            raise gloam.InputError(f"'{key}' needs three numbers, for red, green and blue", str(path))
        return tuple(float(v) for v in values)

    def word(key: str, default: str, known: tuple[str, ...]) -> str:
        value = str(image.get(key, default))
        if value not in known:
            raise gloam.InputError(f"'{key}' must be one of {', '.join(known)}, got '{value}'", str(path))
        return value

    size = image.get("size")
    if size is not None and (len(size) != 2 or not all(isinstance(v, int) and 1 <= v <= 4096 for v in size)):
        raise gloam.InputError("'size' needs a width and a height of 1 … 4096 px", str(path))
    deviation = triple("deviation", Settings.deviation)
    if min(deviation) <= 0:
        raise gloam.InputError("'deviation' must be positive", str(path))
    tokens = output.get("tokens", 0)
    if tokens < 0:
        raise gloam.InputError("'tokens' must not be negative", str(path))
    return Settings(
        table.get("name", path.stem), path.parent / table.get("file", f"{path.stem}.onnx"), output["layer"], output["features"],
        output.get("scores", ""), tokens, table.get("note", ""), _classes(table, path), None if size is None else (size[0], size[1]),
        cast("Fit", word("fit", "crop", _FITS)), word("filter", "bicubic", _FILTERS), triple("mean", Settings.mean), deviation,
        word("channels", "RGB", ("RGB", "BGR")), word("layout", "NCHW", ("NCHW", "NHWC")),
    )  # fmt: skip


def _classes(table: dict[str, Any], path: Path) -> tuple[str, ...]:
    if "classes" not in table:
        return ()
    file = path.parent / table["classes"]
    try:
        return tuple(line.strip() for line in file.read_text(encoding="utf-8").splitlines())
    except (OSError, UnicodeDecodeError) as error:
        raise gloam.IoError(f"cannot read the names of classes: {error}", str(file)) from error


@dataclass(frozen=True)
class Response:
    """Of one image. features: (d,); scores: (classes,) or None; layer: (c, h, w) for the maps; gradient of a class's score by
    that layer by `Network.gradient`."""

    features: Floats
    scores: Floats | None
    layer: Floats
    raw: dict[str, NDArray[Any]]


class Network:
    """A network that is evaluated on the CPU with results that repeat."""

    def __init__(self, settings: Settings) -> None:
        """Errors: IoError, InputError and UnsupportedError: a file that is missing or no network, tensors that it does not have,
        another size of its input, or an operator after the layer that has no derivative."""
        try:
            import onnx
        except ImportError as error:
            raise gloam.UnsupportedError("the comparison needs the package onnx", hint="pip install onnx") from error

        self.settings = settings
        file = str(settings.file)
        try:
            data = settings.file.read_bytes()
            model = onnx.load_model_from_string(data)
            model = onnx.shape_inference.infer_shapes(model)
        except OSError as error:
            raise gloam.IoError(f"cannot read the network: {error.strerror}", file, hint="./gloam real networks") from error
        except Exception as error:  # damaged files end in exceptions of many kinds
            raise gloam.InputError("this is not a network in ONNX", file) from error
        self.hash = _hash(data, settings)
        self.input, self.size = self._input(model)
        known = {name for node in model.graph.node for name in node.output} | {port.name for port in model.graph.output}
        for key in ("layer", "features", "scores"):
            name = getattr(settings, key)
            if name and name not in known:
                likely = [port.name for port in model.graph.output]
                raise gloam.InputError(f"the network has no tensor '{name}' for '{key}'; its outputs are: {', '.join(likely)}", file)
        self.tail = Tail(model, settings.layer, settings.scores) if settings.scores else None
        self._run = self._opened(model)

    def _input(self, model: Any) -> tuple[str, tuple[int, int]]:
        """Name and size of the only input. Errors: InputError."""
        file = str(self.settings.file)
        constants = {one.name for one in model.graph.initializer}
        inputs = [port for port in model.graph.input if port.name not in constants]
        if len(inputs) != 1:
            raise gloam.InputError(f"the network must have one input, an image, but has {len(inputs)}", file)
        shape = [d.dim_value if d.HasField("dim_value") else None for d in inputs[0].type.tensor_type.shape.dim]
        channels, high, wide = (1, 2, 3) if self.settings.layout == "NCHW" else (3, 1, 2)
        if len(shape) != 4 or shape[channels] not in (None, 3) or shape[0] not in (None, 0, 1):
            raise gloam.InputError(f"the input must hold one {self.settings.layout} image of three channels, got {shape}", file)
        own = (shape[wide], shape[high])
        size = self.settings.size or (own if None not in own else None)
        if size is None:
            raise gloam.InputError("the network accepts any size of images: set 'size' of [input]", file)
        if any(mine is not None and mine != wanted for mine, wanted in zip(own, size, strict=True)):
            raise gloam.InputError(f"the network needs images of {own[0]} x {own[1]}, but 'size' is {size[0]} x {size[1]}", file)
        return inputs[0].name, (int(size[0] or 0), int(size[1] or 0))

    def _opened(self, model: Any) -> OnnxNetwork:
        """The network with further outputs: the layer and the tensors that its tail needs."""
        import onnx

        wanted = dict.fromkeys(
            [self.settings.layer, self.settings.features, self.settings.scores, *(self.tail.boundary if self.tail else [])]
        )
        infos = {info.name: info for info in [*model.graph.value_info, *model.graph.output, *model.graph.input]}
        wanted.pop("", None)
        wanted.pop(self.input, None)
        del model.graph.output[:]
        model.graph.output.extend(infos.get(name) or onnx.helper.make_empty_tensor_value_info(name) for name in wanted)
        with tempfile.TemporaryDirectory(prefix="gloam_real_") as folder:
            path = Path(folder) / "network.onnx"
            path.write_bytes(model.SerializeToString())
            return OnnxNetwork(path, None, None)

    def prepare(self, image: Image) -> NDArray[np.float32]:
        """The network's input for an image of any size."""
        chosen = self.settings
        small = fitted(image, self.size, chosen.fit, chosen.filter == "bicubic").astype(np.float64) / 255
        normal = (small - chosen.mean) / chosen.deviation
        if chosen.channels == "BGR":
            normal = normal[..., ::-1]
        return np.ascontiguousarray(normal.transpose(2, 0, 1) if chosen.layout == "NCHW" else normal, np.float32)[None]

    def run(self, image: Image) -> Response:
        """Errors: InputError for numbers that are not finite, and for a layer without places."""
        tensor = self.prepare(image)
        try:
            raw: dict[str, NDArray[Any]] = self._run.run(**{self.input: tensor})
        except ValueError as error:
            raise gloam.InputError(str(error)) from error
        raw[self.input] = tensor
        scores = raw[self.settings.scores].astype(np.float64).ravel() if self.settings.scores else None
        layer = self._places(raw[self.settings.layer].astype(np.float64))
        return Response(raw[self.settings.features].astype(np.float64).ravel(), scores, layer, raw)

    def gradient(self, response: Response, number: int) -> Floats:
        """Derivative of the score of class `number` by the layer, (c, h, w)."""
        if self.tail is None:
            raise ValueError("the network has no classes")
        boundary = {name: response.raw[name] for name in self.tail.boundary}
        _, gradient = self.tail.gradient(response.raw[self.settings.layer], boundary, number)
        return self._places(gradient)

    def _places(self, layer: NDArray[Any]) -> Floats:
        """(c, h, w) of a layer of features or of tokens."""
        if layer.ndim == 4 and layer.shape[0] == 1:
            # Frameworks with NHWC images may keep NCHW inside: a layer has more channels than rows.
            is_first = self.settings.layout == "NCHW" or layer.shape[1] >= layer.shape[3]
            return np.asarray(layer[0] if is_first else layer[0].transpose(2, 0, 1))
        if layer.ndim == 3 and 1 in layer.shape[:2]:
            tokens = layer.reshape(-1, layer.shape[2])[self.settings.tokens :]
            high = round((len(tokens) * self.size[1] / self.size[0]) ** 0.5)
            if high and len(tokens) % high == 0:
                return np.asarray(tokens.T.reshape(layer.shape[2], high, -1))
        raise gloam.InputError(
            f"layer '{self.settings.layer}' has the shape {list(layer.shape)}, which is not (1, c, h, w), nor (1, t, c) with "
            f"{self.settings.tokens} tokens and a grid",
            str(self.settings.file),
        )

    def class_name(self, number: int) -> str:
        """Name of a class, or its number."""
        return self.settings.classes[number] if number < len(self.settings.classes) else f"class {number}"


def _hash(data: bytes, settings: Settings) -> str:
    """Identity of all that determines a response: the file and its settings."""
    plain = {k: v for k, v in asdict(settings).items() if k not in ("name", "file", "note", "classes")}
    return hashlib.sha256(hashlib.sha256(data).digest() + json.dumps(plain, sort_keys=True).encode()).hexdigest()
