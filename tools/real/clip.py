"""CLIP's vision transformers as ONNX from a state dict with the names of OpenAI's CLIP and of open_clip.

With labels, the text transformer of the checkpoint is evaluated once, and the scores are the scaled cosines between the image and
the labels: zero-shot classes, which Grad-CAM needs.
"""

from __future__ import annotations

import gzip
import re
from pathlib import Path
from typing import Any

import numpy as np
from checkpoint import CheckpointError, State
from graph import Graph
from onnx.reference import ReferenceEvaluator

LAYER, FEATURES, SCORES = "layer", "features", "scores"
TEMPLATE = "a photo of a {}."
_HEAD = 64  # channels of an attention head
_CONTEXT = 77


class _Transformer:
    """Blocks of a transformer of CLIP. is_exact: GELU as open_clip's own models have it, instead of OpenAI's x sigmoid(1.702 x)."""

    def __init__(self, graph: Graph, state: State, is_exact: bool) -> None:
        self.graph, self.state, self.is_exact = graph, state, is_exact

    def tensor(self, name: str) -> np.ndarray:
        if name not in self.state:
            hint = "; ResNets of CLIP are not supported" if "visual.layer1.0.conv1.weight" in self.state else ""
            raise CheckpointError(f"the checkpoint has no tensor '{name}'{hint}")
        return self.state[name].astype(np.float32)

    def norm(self, x: str, prefix: str, name: str = "") -> str:
        names = [self.graph.floats(self.tensor(f"{prefix}.{part}")) for part in ("weight", "bias")]
        return self.graph.add("LayerNormalization", x, *names, name=name, axis=-1, epsilon=1e-5)

    def linear(self, x: str, weight: np.ndarray, bias: np.ndarray) -> str:
        return self.graph.add("Add", self.graph.add("MatMul", x, self.graph.floats(weight.T)), self.graph.floats(bias))

    def _named(self, x: str, prefix: str) -> str:
        return self.linear(x, self.tensor(f"{prefix}.weight"), self.tensor(f"{prefix}.bias"))

    def attention(self, x: str, prefix: str, tokens: int, mask: np.ndarray | None) -> str:
        weight, bias = self.tensor(f"{prefix}.in_proj_weight"), self.tensor(f"{prefix}.in_proj_bias")
        width = weight.shape[1]
        shape = self.graph.constant(np.array([1, tokens, width // _HEAD, _HEAD]))
        parts = []
        for k, order in enumerate(([0, 2, 1, 3], [0, 2, 3, 1], [0, 2, 1, 3])):
            rows = slice(k * width, (k + 1) * width)
            y = self.graph.add("Reshape", self.linear(x, weight[rows], bias[rows]), shape)
            parts.append(self.graph.add("Transpose", y, perm=order))
        logits = self.graph.add("Mul", self.graph.add("MatMul", parts[0], parts[1]), self.graph.floats(_HEAD**-0.5))
        if mask is not None:
            logits = self.graph.add("Add", logits, self.graph.floats(mask))
        y = self.graph.add("MatMul", self.graph.add("Softmax", logits, axis=-1), parts[2])
        y = self.graph.add("Reshape", self.graph.add("Transpose", y, perm=[0, 2, 1, 3]), self.graph.constant(np.array([1, tokens, width])))
        return self._named(y, f"{prefix}.out_proj")

    def act(self, x: str) -> str:
        if not self.is_exact:
            return self.graph.add("Mul", x, self.graph.add("Sigmoid", self.graph.add("Mul", x, self.graph.floats(1.702))))
        half = self.graph.add("Erf", self.graph.add("Mul", x, self.graph.floats(2**-0.5)))
        half = self.graph.add("Mul", self.graph.add("Add", half, self.graph.floats(1)), self.graph.floats(0.5))
        return self.graph.add("Mul", x, half)

    def blocks(self, x: str, prefix: str, tokens: int, mask: np.ndarray | None = None, layer: str = "") -> str:
        """All blocks. layer: name for the normalised input of the last one."""
        numbers = {int(match[1]) for name in self.state if (match := re.match(re.escape(prefix) + r"\.(\d+)\.", name))}
        for k in sorted(numbers):
            name = f"{prefix}.{k}"
            y = self.norm(x, f"{name}.ln_1", layer if k == max(numbers) else "")
            x = self.graph.add("Add", x, self.attention(y, f"{name}.attn", tokens, mask))
            y = self.act(self._named(self.norm(x, f"{name}.ln_2"), f"{name}.mlp.c_fc"))
            x = self.graph.add("Add", x, self._named(y, f"{name}.mlp.c_proj"))
        return x


def build(state: State, labels: np.ndarray | None, is_exact: bool) -> tuple[Any, int]:
    """The model with outputs LAYER (tokens, the first is the class token), FEATURES and, with labels, SCORES. Returns it and the
    side of its images [px].

    labels: (classes, d) embeddings of `embed`, None = no scores. Errors: CheckpointError.
    """
    graph = Graph()
    made = _Transformer(graph, state, is_exact)
    patches = made.tensor("visual.conv1.weight")
    width, _, patch, _ = patches.shape
    places = made.tensor("visual.positional_embedding")
    tokens = len(places)
    side = patch * round((tokens - 1) ** 0.5)
    x = graph.add("Conv", "image", graph.floats(patches), strides=[patch, patch])
    x = graph.add("Transpose", graph.add("Reshape", x, graph.constant(np.array([1, width, tokens - 1]))), perm=[0, 2, 1])
    x = graph.add("Concat", graph.floats(made.tensor("visual.class_embedding").reshape(1, 1, width)), x, axis=1)
    x = made.norm(graph.add("Add", x, graph.floats(places)), "visual.ln_pre")
    x = made.blocks(x, "visual.transformer.resblocks", tokens, layer=LAYER)
    x = graph.add("Gather", x, graph.constant(np.array(0)), axis=1)
    projection = made.tensor("visual.proj")
    x = graph.add("MatMul", made.norm(x, "visual.ln_post"), graph.floats(projection), name=FEATURES)
    outputs: dict[str, tuple[int, ...]] = {LAYER: (1, tokens, width), FEATURES: (1, projection.shape[1])}
    if labels is not None:
        scale = float(np.exp(made.tensor("logit_scale")))
        unit = graph.add("Div", x, graph.add("ReduceL2", x, axes=[-1], keepdims=1))
        graph.add("MatMul", unit, graph.floats(scale * labels.T), name=SCORES)
        outputs[SCORES] = (1, len(labels))
    return graph.model({"image": (1, 3, side, side)}, outputs), side


def embed(state: State, texts: list[str], vocabulary: Path, is_exact: bool) -> np.ndarray:
    """Unit vectors, (n, d), of texts by the checkpoint's text transformer."""
    tokenizer = Tokenizer(vocabulary)
    table = state.get("token_embedding.weight")
    if table is None:
        raise CheckpointError("the checkpoint has no text transformer, so labels have no meaning")
    graph = Graph()
    made = _Transformer(graph, state, is_exact)
    width = table.shape[1]
    mask = np.triu(np.full((_CONTEXT, _CONTEXT), -1e9, np.float32), 1)
    x = graph.add("Add", "words", graph.floats(made.tensor("positional_embedding")[None]))
    made.norm(made.blocks(x, "transformer.resblocks", _CONTEXT, mask), "ln_final", "text")
    run = ReferenceEvaluator(graph.model({"words": (1, _CONTEXT, width)}, {"text": (1, _CONTEXT, width)}))
    rows = []
    for text in texts:
        numbers = tokenizer.encode(text)
        padded = numbers + [0] * (_CONTEXT - len(numbers))
        (out,) = run.run(None, {"words": table[padded][None].astype(np.float32)})
        row = out[0, len(numbers) - 1] @ made.tensor("text_projection")
        rows.append(row / np.linalg.norm(row))
    return np.array(rows, np.float32)


class Tokenizer:
    """Byte-pair encoding of CLIP (Sennrich et al. 2016) for plain English labels.

    vocabulary: bpe_simple_vocab_16e6.txt.gz of CLIP's repository, which is also in the wheel open_clip_torch.
    """

    def __init__(self, vocabulary: Path) -> None:
        try:
            with gzip.open(vocabulary, "rt", encoding="utf-8") as file:
                lines = file.read().split("\n")
        except (OSError, EOFError, UnicodeDecodeError) as error:
            raise CheckpointError(f"{vocabulary}: this is not CLIP's vocabulary") from error
        merges = [tuple(line.split()) for line in lines[1 : 49152 - 256 - 2 + 1]]
        symbols = list(_bytes_as_letters().values())
        words = [*symbols, *(s + "</w>" for s in symbols), *("".join(pair) for pair in merges), "<start>", "<end>"]
        self._numbers = {word: k for k, word in enumerate(words)}
        self._ranks = {pair: k for k, pair in enumerate(merges)}

    def encode(self, text: str) -> list[int]:
        """Token numbers of a text, between the start and the end token. Errors: CheckpointError for a text that is too long."""
        letters = _bytes_as_letters()
        tokens = []
        for word in re.findall(r"'s|'t|'re|'ve|'m|'ll|'d|[^\W\d_]+|\d|[^\s\w]+|_+", " ".join(text.lower().split())):
            tokens += self._merged("".join(letters[byte] for byte in word.encode("utf-8")))
        if len(tokens) + 2 > _CONTEXT:
            raise CheckpointError(f"the label '{text}' is too long")
        return [self._numbers[token] for token in ("<start>", *tokens, "<end>")]

    def _merged(self, word: str) -> list[str]:
        parts = [*word[:-1], word[-1] + "</w>"]
        while len(parts) > 1:
            pairs = list(zip(parts, parts[1:], strict=False))
            best = min(pairs, key=lambda pair: self._ranks.get(pair, len(self._ranks)))
            if best not in self._ranks:
                break
            joined, k = [], 0
            while k < len(parts):
                is_pair = k + 1 < len(parts) and (parts[k], parts[k + 1]) == best
                joined.append("".join(best) if is_pair else parts[k])
                k += 2 if is_pair else 1
            parts = joined
        return parts


def _bytes_as_letters() -> dict[int, str]:
    """GPT-2's letters for bytes: printable ones as they are, then the others from U+0100."""
    printable = [*range(33, 127), *range(161, 173), *range(174, 256)]
    others = [byte for byte in range(256) if byte not in printable]
    return {**{byte: chr(byte) for byte in printable}, **{byte: chr(256 + k) for k, byte in enumerate(others)}}
