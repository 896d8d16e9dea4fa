"""Checks the benchmark itself: the true poses with noise of a known size, in a world and with a scale of its own.

    noisy_truth.py SEQUENCE OUT --truth truth.tum [--sigma 0.05] [--scale 1] [--lost 0.0] [--seed 1]

Expected: ATE of about sigma √3 in three dimensions, the scale, and the given share of lost frames.
"""

from __future__ import annotations

import argparse

import numpy as np
from contract import INITIALIZING, LOST, TRACKED, Output, Sequence, rotation


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence")
    parser.add_argument("out")
    parser.add_argument("--truth", required=True)
    parser.add_argument("--sigma", type=float, default=0.05, help="standard deviation of each coordinate [m]; default: %(default)s")
    parser.add_argument("--scale", type=float, default=1.0, help="of the estimate; default: %(default)s")
    parser.add_argument("--lost", type=float, default=0.0, help="share of the frames, in the middle of the run; default: %(default)s")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    random = np.random.default_rng(given.seed)
    turn = random.uniform(-np.pi, np.pi)
    world = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    truth = {round(row[0], 6): row for row in np.loadtxt(given.truth, ndmin=2)}
    frames = Sequence(given.sequence).files("rgb") or Sequence(given.sequence).files("scans")
    with Output(given.out) as output:
        for number, (stamp, _) in enumerate(frames):
            output.begin()
            row = truth[round(stamp, 6)]
            pose = np.eye(4)
            pose[:3, :3] = world @ rotation(row[[7, 4, 5, 6]])
            pose[:3, 3] = world @ (row[1:4] * given.scale + random.normal(0, given.sigma * given.scale, 3))
            share = (number + 0.5) / len(frames)
            is_lost = abs(share - 0.5) < given.lost / 2
            output.frame(stamp, INITIALIZING if number == 0 else LOST if is_lost else TRACKED, pose)


if __name__ == "__main__":
    main()
