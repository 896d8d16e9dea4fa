"""Planner `nomad`: a diffusion model of waypoints, conditioned on images and a goal image (NoMaD, Sridhar et al. 2023,
arXiv:2310.07896; robodhruv/visualnav-transformer, deployment/src/navigate.py and train/config/nomad.yaml)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import gloam

from ..networks.onnx_network import OnnxNetwork, Port
from ..networks.preprocessing import Floats
from ..planner import Task, register_planner
from .goal_image import MapOptions, MapPlanner, _sizes

# Steps between waypoints of the training data, forward and to the left, in units of top speed / rate
# (train/vint_train/data/data_config.yaml, action_stats).
LEAST = np.array([-2.5, -4.0])
MOST = np.array([5.0, 4.0])
COUNT = 8  # waypoints of a sample
FILES = ("nomad_encoder.onnx", "nomad_distance.onnx", "nomad_noise.onnx")


@dataclass(frozen=True)
class Sampling:
    """samples: of which the first drives the robot, as published (8); steps: of the diffusion, as in training (10);
    explore: without a goal (the goal token is masked), while nodes still count. Errors: gloam.UsageError."""

    samples: int = 8
    steps: int = 10
    explore: bool = False

    def __post_init__(self) -> None:
        for name, most in (("samples", 1024), ("steps", 1000)):
            if not 1 <= getattr(self, name) <= most:
                raise gloam.UsageError(f"{name} must be 1 … {most}, got {getattr(self, name)}")


class Schedule:
    """Variances of a diffusion: the squared cosine of Nichol and Dhariwal 2021 (arXiv:2102.09672, equation 17) with steps
    of at most 0.999, which diffusers calls squaredcos_cap_v2."""

    def __init__(self, steps: int) -> None:
        def level(time: float) -> float:
            return math.cos((time + 0.008) / 1.008 * math.pi / 2) ** 2

        betas = [min(1 - level((i + 1) / steps) / level(i / steps), 0.999) for i in range(steps)]
        self.betas = np.array(betas)
        self.kept = np.cumprod(1 - self.betas)  # share of the signal's variance that is left after each step

    def previous(self, sample: Floats, noise: Floats, step: int, fresh: Floats | None) -> Floats:
        """The sample before a step of the diffusion (Ho et al. 2020, arXiv:2006.11239, equations 7 and 15).

        noise: that the network predicts; the estimate of the clean sample is clipped to ± 1; fresh: standard normal noise,
        None at step 0, where none is added.
        """
        kept, before = self.kept[step], self.kept[step - 1] if step > 0 else 1.0
        clean = np.clip((sample - math.sqrt(1 - kept) * noise) / math.sqrt(kept), -1, 1)
        beta = self.betas[step]
        mean = math.sqrt(before) * beta / (1 - kept) * clean + math.sqrt(1 - beta) * (1 - before) / (1 - kept) * sample
        if fresh is not None:
            mean = mean + math.sqrt(max((1 - before) / (1 - kept) * beta, 1e-20)) * fresh
        return np.asarray(mean, np.float32)


def sample_actions(
    predict: Callable[[Floats, int], Floats], sampling: Sampling, random: np.random.Generator
) -> NDArray[np.float64]:
    """(samples, 8, 2) waypoints in units of top speed / rate.

    predict(sample, step): the network's noise, (samples, 8, 2). The random numbers are drawn in the order: the first
    sample, then one array for each step but the last.
    """
    shape = (sampling.samples, COUNT, 2)
    schedule = Schedule(sampling.steps)
    sample = random.standard_normal(shape, np.float32)
    for step in reversed(range(sampling.steps)):
        noise = predict(sample, step)
        fresh = random.standard_normal(shape, np.float32) if step > 0 else None
        sample = schedule.previous(sample, noise, step, fresh)
    deltas = (sample.astype(np.float64) + 1) / 2 * (MOST - LEAST) + LEAST
    return np.asarray(np.cumsum(deltas, axis=1))


class NomadPlanner(MapPlanner):
    """NoMaD with three networks: encoder of images, distance, and noise of the diffusion.

    Its random numbers depend on the task's seed and the count of calls alone (Philox, Salmon et al. 2011).
    """

    def __init__(self, weights: str | Path, sampling: Sampling, options: MapOptions) -> None:
        """weights: folder of nomad_encoder.onnx, nomad_distance.onnx and nomad_noise.onnx. Errors: as OnnxNetwork."""
        if options.waypoint >= COUNT:
            raise gloam.UsageError(f"waypoint must be 0 … {COUNT - 1}, got {options.waypoint}")
        encoder, distance, noise = (Path(weights) / name for name in FILES)
        images = [Port("obs_img", (1, None, None, None)), Port("goal_img", (1, 3, None, None)), Port("goal_mask", (1,), "int64")]
        self._encoder = OnnxNetwork(encoder, images, [Port("embedding", (1, None))], options.backend)
        width = self._encoder.outputs["embedding"].shape[1]
        self._distance = OnnxNetwork(distance, [Port("embedding", (1, width))], [Port("dist", (1, 1))], options.backend)
        sample = (None, COUNT, 2)
        ports = [Port("sample", sample), Port("timestep", (1,), "int64"), Port("embedding", (None, width))]
        self._noise = OnnxNetwork(noise, ports, [Port("noise", sample)], options.backend)
        context_size, size = _sizes(self._encoder)
        super().__init__(options, context_size, size)
        if options.image_size is None:  # the network's square comes from an image of 4:3
            self.image_size = (math.ceil(size[1] * 4 / 3), size[1])
        self._sampling = sampling
        self._seed = 0
        self._calls = 0

    def reset(self, task: Task) -> None:
        super().reset(task)
        self._seed = task.seed
        self._calls = 0

    def answer_in_window(self, seen: Floats, window: range) -> tuple[int, float, NDArray[Any]]:
        """The closest node of the window; the goal is the one after it if it is below close_threshold."""
        embeddings = [self._embedding(seen, i, masked=False) for i in window]
        distances = [float(self._distance.run(embedding=e)["dist"][0, 0]) for e in embeddings]
        best = int(np.argmin(distances))
        chosen = min(best + int(distances[best] < self.options.close_threshold), len(window) - 1)
        embedding = self._embedding(seen, window[chosen], masked=True) if self._sampling.explore else embeddings[chosen]
        repeated = np.repeat(embedding, self._sampling.samples, axis=0)

        def predict(sample: Floats, step: int) -> Floats:
            noise: Floats = self._noise.run(sample=sample, timestep=np.array([step], np.int64), embedding=repeated)["noise"]
            return noise

        key = np.array([self._seed % (1 << 64), self._calls], np.uint64)
        self._calls += 1
        actions = sample_actions(predict, self._sampling, np.random.Generator(np.random.Philox(key=key)))
        return window[best], distances[best], actions[0]

    def _embedding(self, seen: Floats, index: int, masked: bool) -> Floats:
        mask = np.array([int(masked)], np.int64)
        result: Floats = self._encoder.run(obs_img=seen, goal_img=self.goal(index), goal_mask=mask)["embedding"]
        return result


def _make(
    weights: str | Path | None = None, samples: int = 8, steps: int = 10, explore: bool = False, **options: Any
) -> NomadPlanner:
    if weights is None:
        raise gloam.UsageError(
            "planner 'nomad' needs weights, a folder of ONNX files",
            hint="convert the published weights: docs/navigation_networks.md",
        )
    return NomadPlanner(weights, Sampling(samples, steps, explore), MapOptions(**options))


register_planner("nomad", _make)
