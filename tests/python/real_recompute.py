"""Recomputes the numbers of a comparison's page from the images and network files: real_recompute.py FOLDER.

It shares no code with gloam.real: networks run in ONNX's reference implementation, maps of global-mean classifiers by their
weights, distances by SciPy and double sums. Prints the differences, and ends with 1 if one exceeds a ten-thousandth.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import scipy.linalg
import scipy.ndimage
from onnx.reference import ReferenceEvaluator
from PIL import Image

Row = dict[str, Any]


class Raw:
    """Images of a results folder and the answers of its networks."""

    def __init__(self, out: Path) -> None:
        self.out, self.request = out, json.loads((out / "request.json").read_text())
        with (out / "images.csv").open(newline="") as file:
            self.rows = list(csv.DictReader(file))
        self.folders = {"real": self.request["real"], **self.request["others"]}

    def files(self, name: str) -> list[str]:
        return [row["file"] for row in self.rows if row["set"] == name]

    def image(self, name: str, file: str) -> np.ndarray:
        return np.asarray(Image.open(Path(self.folders[name]) / file).convert("RGB"))

    def answers(self, network: Row, name: str) -> dict[str, dict[str, np.ndarray]]:
        """Of each image: features, scores and the layer."""
        model = onnx.load(network["file"])
        for extra in {network["layer"], network["features"]} - {port.name for port in model.graph.output}:
            model.graph.output.append(onnx.helper.make_empty_tensor_value_info(extra))
        run = ReferenceEvaluator(model)
        wanted = [network["features"], network["scores"], network["layer"]]
        found = {}
        for file in self.files(name):
            image = Image.fromarray(self.image(name, file)).resize(tuple(network["size"]), Image.Resampling.BICUBIC)
            x = ((np.asarray(image, float) / 255 - network["mean"]) / network["deviation"]).transpose(2, 0, 1)[None].astype(np.float32)
            found[file] = dict(zip(("features", "scores", "layer"), run.run(wanted, {model.graph.input[0].name: x}), strict=True))
        return found


def softmax(x: np.ndarray) -> np.ndarray:
    e = np.exp(np.asarray(x, float).ravel() - np.max(x))
    return e / e.sum()


def divergence(p: np.ndarray, q: np.ndarray, s: float) -> float:
    p, q = (p + s) / (1 + len(p) * s), (q + s) / (1 + len(q) * s)
    return float(np.sum(p * np.log(p / q)))


def cos(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.dot(a, b) / np.sqrt(np.dot(a, a) * np.dot(b, b)))


def of_sets(real: list[Row], sim: list[Row], request: Row) -> dict[str, float | None]:
    x, y = (np.array([one["features"].ravel() for one in every], float) for every in (real, sim))
    p, q = (np.mean([softmax(one["scores"] / request["temperature"]) for one in every], axis=0) for every in (real, sim))
    answer: dict[str, float | None] = {"cosine_of_means": cos(x.mean(0), y.mean(0)), "kl_of_means": divergence(p, q, request["smoothing"])}
    if min(len(x), len(y)) < 2:
        return {**answer, "fid": None, "kid": None}
    tiny = 1e-12 * np.eye(x.shape[1])
    root = scipy.linalg.sqrtm((np.cov(x.T) + tiny) @ (np.cov(y.T) + tiny))
    answer["fid"] = float(((x.mean(0) - y.mean(0)) ** 2).sum() + np.trace(np.cov(x.T) + np.cov(y.T) - 2 * root.real))

    def kernel(a: np.ndarray, b: np.ndarray) -> float:
        return float((a @ b / len(a) + 1) ** 3)

    own = [np.mean([kernel(a, b) for i, a in enumerate(z) for j, b in enumerate(z) if i != j]) for z in (x, y)]
    answer["kid"] = float(own[0] + own[1] - 2 * np.mean([kernel(a, b) for a in x for b in y]))
    return answer


def maps(answer: Row, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Grad-CAM by the weights of a class after a global mean, and EigenCAM."""
    a = answer["layer"][0].astype(float)
    places = a.reshape(len(a), -1)
    grad = np.maximum((weights[:, None, None] * a).sum(0), 0)
    centred = places - places.mean(1, keepdims=True)
    axis = np.linalg.eigh(centred @ centred.T)[1][:, -1]
    line = axis @ centred
    line *= np.sign(line @ places.mean(0)) or 1
    return grad, np.maximum(line, 0).reshape(a.shape[1:])


def shared(a: np.ndarray, b: np.ndarray) -> tuple[float | None, float | None]:
    if a.max() <= 0 or b.max() <= 0:
        return None, None
    hot = [m > m.max() / 2 for m in (a, b)]
    return float(np.minimum(a / a.sum(), b / b.sum()).sum()), float((hot[0] & hot[1]).sum() / (hot[0] | hot[1]).sum())


def structural(a: np.ndarray, b: np.ndarray) -> float:
    def blur(x: np.ndarray) -> np.ndarray:
        return scipy.ndimage.gaussian_filter(x, 1.5, truncate=10 / 3)[5:-5, 5:-5]

    a, b = (image.astype(float) @ [0.299, 0.587, 0.114] for image in (a, b))
    ma, mb = blur(a), blur(b)
    va, vb, c = blur(a * a) - ma**2, blur(b * b) - mb**2, blur(a * b) - ma * mb
    return float(np.mean((2 * ma * mb + 6.5025) * (2 * c + 58.5225) / ((ma**2 + mb**2 + 6.5025) * (va + vb + 58.5225))))


def appearance(image: np.ndarray) -> dict[str, float]:
    grey = image.astype(float) @ [0.299, 0.587, 0.114]
    mask = np.array([[1, -2, 1], [-2, 4, -2], [1, -2, 1]])
    noise = np.median(abs(scipy.ndimage.convolve(grey, mask)[1:-1, 1:-1])) / 0.6744897501960817 / 6
    laplacian = scipy.ndimage.laplace(grey)[1:-1, 1:-1].var()
    gy, gx = np.gradient(grey)
    return {
        "rms_contrast": grey.std() / 255, "noise": noise, "laplacian": laplacian,
        "gradient_mean": np.hypot(gx, gy)[1:-1, 1:-1].mean(), "clipped_bright": np.mean(image.max(2) >= 253),
    }  # fmt: skip


def differences(out: Path) -> list[str]:
    """A line per number of the tables that is not the recomputed one."""
    raw, bad = Raw(out), []

    def check(what: str, printed: str, value: float | None) -> None:
        told = float(printed) if printed else None
        if (told is None) != (value is None) or (told is not None and value is not None and abs(told - value) > 1e-4 * max(1, abs(value))):
            bad.append(f"{what} is {value}, but the table has {told}")

    for row in raw.rows:
        for key, value in appearance(raw.image(row["set"], row["file"])).items():
            check(f"{key} of {row['file']}", row[key], value)
    with (out / "differences.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            a, b = (
                np.array([float(one[row["statistic"]] or "nan") for one in raw.rows if one["set"] == name]) for name in ("real", row["set"])
            )
            a, b = a[np.isfinite(a)], b[np.isfinite(b)]
            check(
                f"δ of {row['statistic']}", row["cliff_delta"], float(np.sign(b[None] - a[:, None]).mean()) if len(a) and len(b) else None
            )
    summary = list(csv.DictReader((out / "summary.csv").open(newline="")))
    pairs = list(csv.DictReader((out / "pairs.csv").open(newline=""))) if (out / "pairs.csv").exists() else []
    for network in raw.request["networks"]:
        answers = {name: raw.answers(network, name) for name in raw.folders}
        for row in summary:
            if row["network"] != network["name"] or row["set"] not in answers:
                continue
            for key, value in of_sets(list(answers["real"].values()), list(answers[row["set"]].values()), raw.request).items():
                check(f"{key} of {row['set']}", row[key], value)
            mine = [pair for pair in pairs if pair["set"] == row["set"] and pair["network"] == network["name"]]
            for key in ("cosine", "kl", "flip", "ssim", "grad_overlap", "grad_iou", "eigen_overlap", "eigen_iou") if mine else ():
                values = [float(pair[key]) for pair in mine if pair[key]]
                check(f"mean {key} of {row['set']}", row[key], float(np.mean(values)) if values else None)
        weights = {one.name: onnx.numpy_helper.to_array(one) for one in onnx.load(network["file"]).graph.initializer}["w2"].astype(float)
        for pair in pairs:
            if pair["network"] == network["name"]:
                check_pair(raw, pair, answers, weights, check)
    return bad if summary else ["there are no results"]


def check_pair(raw: Raw, pair: Row, answers: Row, weights: np.ndarray, check: Any) -> None:
    a, b = answers["real"][pair["real"]], answers[pair["set"]][pair["other"]]
    number = int(np.argmax(a["scores"]))
    check("class", pair["class"], number)
    check("cosine", pair["cosine"], cos(a["features"].ravel().astype(float), b["features"].ravel().astype(float)))
    t, s = raw.request["temperature"], raw.request["smoothing"]
    check("kl", pair["kl"], divergence(softmax(a["scores"] / t), softmax(b["scores"] / t), s))
    images = raw.image("real", pair["real"]), raw.image(pair["set"], pair["other"])
    if images[0].shape == images[1].shape:
        check("ssim", pair["ssim"], structural(*images))
    both = maps(a, weights[number]), maps(b, weights[number])
    for k, kind in enumerate(("grad", "eigen")):
        overlap, union = shared(both[0][k], both[1][k])
        check(f"{kind}_overlap", pair[f"{kind}_overlap"], overlap)
        check(f"{kind}_iou", pair[f"{kind}_iou"], union)


if __name__ == "__main__":
    found = differences(Path(sys.argv[1]))
    print("\n".join(found) or "all numbers agree")
    sys.exit(bool(found))
