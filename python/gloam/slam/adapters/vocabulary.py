"""Makes a vocabulary of ORB features for ORB-SLAM3 and ORB-SLAM2 from images: vocabulary.py OUT.txt FOLDER …

A tree of visual words (Nistér and Stewénius 2006) in the text form of DBoW2 (Gálvez-López and Tardós 2012): branches are
medians of binary descriptors, weights are inverse document frequencies. Requires OpenCV.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Bits = NDArray[np.uint8]
BRANCHES, LEVELS = 10, 4
MOST_IMAGES, MOST_FEATURES = 1500, 400_000  # of the training
_ROUNDS = 8  # of the clustering
_HEAD = "0 0"  # scoring by the L1 norm, weights by term and inverse document frequency


@dataclass
class Node:
    """A word or a branch. descriptor: (32,) bytes; weight: of words; children: of branches."""

    descriptor: Bits
    weight: float = 0.0
    children: list[Node] = field(default_factory=list)


def features(files: list[Path]) -> tuple[Bits, NDArray[np.int64]]:
    """ORB descriptors (n, 32) of images, and the number of the image of each."""
    orb = cv2.ORB_create(800)
    descriptors, images = [], []
    for number, file in enumerate(files):
        gray = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        found = None if gray is None else orb.detectAndCompute(gray, None)[1]
        if found is not None:
            descriptors.append(found)
            images.append(np.full(len(found), number))
        if number % 100 == 99:
            print(f"{number + 1} of {len(files)} images", file=sys.stderr)
    if not descriptors:
        raise SystemExit("the images have no features")
    return np.concatenate(descriptors), np.concatenate(images).astype(np.int64)


def tree(descriptors: Bits, images: NDArray[np.int64], random: np.random.Generator) -> Node:
    """The vocabulary of descriptors."""
    root = Node(np.zeros(32, np.uint8))
    _grow(root, np.unpackbits(descriptors, axis=1), images, int(images.max()) + 1, LEVELS, random)
    return root


def _grow(node: Node, bits: Bits, images: NDArray[np.int64], total: int, levels: int, random: np.random.Generator) -> None:
    if levels == 0 or len(bits) <= 1:
        node.weight = float(np.log(total / max(len(np.unique(images)), 1)))
        return
    label, centers = _clusters(bits, min(BRANCHES, len(bits)), random)
    for number, center in enumerate(centers):
        mine = label == number
        if mine.any():
            child = Node(np.packbits(center))
            _grow(child, bits[mine], images[mine], total, levels - 1, random)
            node.children.append(child)


def _clusters(bits: Bits, count: int, random: np.random.Generator) -> tuple[NDArray[np.int64], Bits]:
    """Labels of the rows, and medians (count, 256): k-means in the Hamming distance, begun as by k-means++."""
    signs = bits.astype(np.float32) * 2 - 1  # a product of two is 256 - 2 * distance
    chosen = [int(random.integers(len(bits)))]
    nearest = np.full(len(bits), np.inf, np.float32)
    while len(chosen) < count:
        nearest = np.minimum(nearest, 128 - signs @ signs[chosen[-1]] / 2)
        square = np.square(nearest.astype(np.float64))
        if square.sum() <= 0:
            break
        chosen.append(int(random.choice(len(bits), p=square / square.sum())))
    centers = signs[chosen]
    label = np.argmax(signs @ centers.T, axis=1)
    for _ in range(_ROUNDS):
        sums = np.stack([signs[label == k].sum(0) if (label == k).any() else centers[k] for k in range(len(centers))])
        centers = np.where(sums >= 0, 1, -1).astype(np.float32)
        again = np.argmax(signs @ centers.T, axis=1)
        if np.array_equal(again, label):
            break
        label = again
    return label.astype(np.int64), (centers > 0).astype(np.uint8)


def write(root: Node, file: Path) -> int:
    """Writes the text form: "k L scoring weighting", then a line per node, parents first: parent, is a word, 32 bytes, weight.
    Returns the number of words."""
    lines = [f"{BRANCHES} {LEVELS} {_HEAD}"]
    waiting = [(child, 0) for child in root.children]
    words = 0
    for node, parent in waiting:  # grows while it is read: breadth first
        words += not node.children
        numbers = " ".join(str(value) for value in node.descriptor)
        lines.append(f"{parent} {int(not node.children)} {numbers} {node.weight:.6g}")
        waiting += [(child, len(lines) - 1) for child in node.children]
    file.write_text("\n".join(lines) + "\n", encoding="ascii")
    return words


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("folders", type=Path, nargs="+", help="folders of PNG or JPEG images, searched with their subfolders")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    random = np.random.default_rng(given.seed)
    found = (file for folder in given.folders for kind in ("*.png", "*.jpg") for file in folder.rglob(kind))
    files = sorted(file for file in found if "depth" not in file.parts)
    if not files:
        parser.error("there are no images in the folders")
    chosen = [files[k] for k in sorted(random.permutation(len(files))[:MOST_IMAGES])]
    descriptors, images = features(chosen)
    kept = np.sort(random.permutation(len(descriptors))[:MOST_FEATURES])
    print(f"{write(tree(descriptors[kept], images[kept], random), given.out)} words of {len(kept)} features in {len(chosen)} images")


if __name__ == "__main__":
    main()
