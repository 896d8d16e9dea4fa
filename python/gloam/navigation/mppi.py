"""Model predictive path integral control (MPPI): random velocities over a horizon, averaged by where they lead.

Williams et al., "Information Theoretic MPC for Model-Based Reinforcement Learning", ICRA 2017, and "Information-Theoretic
Model Predictive Control: Theory and Applications to Autonomous Driving", IEEE T-RO 2018. The distribution of samples is
about the present mean (alpha = 1 in these papers), so that velocities themselves cost nothing.
"""

from __future__ import annotations

import math

import numpy as np

from .local import LocalOptions, Obstacles
from .planner import Array, Velocity

_SAMPLES = 300
_KNOTS = 4  # velocities of a sample, with straight lines between them: fewer dimensions make better averages than white noise
_STEP = 0.125  # of the motion over the horizon [s]
_NOISE = 0.5  # standard deviation of samples, as a share of the top speed and yaw rate
_TEMPERATURE = 0.05  # lambda: a sample that costs so much more than the best one weighs 1/e [m]
_TOUCH = 10.0  # cost of a horizon spent in an obstacle [m]


class Mppi:
    """Chooses velocities of a unicycle. period: between calls [s]; seed: of the samples.

    The mean of the velocities, (knots, 2) as speed [m/s] and yaw rate [rad/s], is kept from call to call.
    """

    def __init__(self, options: LocalOptions, period: float, seed: int) -> None:
        self._options = options
        self._high = np.array([options.top_speed, options.top_yaw_rate])
        self._low = self._high * (-0.3, -1.0)  # backwards to get free
        self._random = np.random.Generator(np.random.Philox(key=seed % (1 << 64)))
        self._mean: Array = np.zeros((_KNOTS, 2))
        knots = np.linspace(0.0, options.horizon, _KNOTS)
        self._later = _interpolation(knots + period, knots)
        self._fine = _interpolation(np.arange(0.5 * _STEP, options.horizon, _STEP), knots)

    def choose(self, target: tuple[float, float], obstacles: Array) -> Velocity:
        """The velocity towards a target (x, y) around obstacles (n, 2), both in the robot's frame [m]."""
        mean = self._later @ self._mean
        noise = _NOISE * self._high * self._random.standard_normal((_SAMPLES, _KNOTS, 2))
        noise[0], noise[1] = 0.0, -mean  # go on as planned; stand
        sampled = np.einsum("sk,nkv->nsv", self._fine, np.clip(mean + noise, self._low, self._high))
        cost = self._cost(sampled, np.array(target), Obstacles(obstacles, self._options))
        weights = np.exp((cost.min() - cost) / _TEMPERATURE)
        weights /= weights.sum()
        # The average is of the samples before they are clipped: else it would never reach the limits.
        mean = mean + (weights[:, None, None] * noise).sum(axis=0)
        self._mean = np.clip(mean, self._low, self._high)
        speed, yaw_rate = self._mean[0]
        return Velocity(vx=float(speed), yaw_rate=float(yaw_rate))

    def _cost(self, velocities: Array, target: Array, obstacles: Obstacles) -> Array:
        """Cost of velocities (n, steps, 2), (n,) [m]: distance to the target, on average and at the end, with a quarter
        of the angle to it there [rad]; nearness of obstacles."""
        turns = _STEP * velocities[..., 1]
        headings = np.cumsum(turns, axis=1)
        middle = headings - 0.5 * turns
        moves = _STEP * velocities[..., :1] * np.stack([np.cos(middle), np.sin(middle)], axis=-1)
        places = np.cumsum(moves, axis=1)
        gaps = target - places
        left = np.hypot(gaps[..., 0], gaps[..., 1])
        bearing = np.arctan2(gaps[:, -1, 1], gaps[:, -1, 0]) - headings[:, -1]
        off = np.abs((bearing + math.pi) % (2 * math.pi) - math.pi)
        distances = obstacles.distances(places)
        near = 0.6 * obstacles.nearness(distances) ** 2 + _TOUCH * obstacles.hits(distances)
        cost: Array = left.mean(axis=1) + left[:, -1] + 0.25 * off + near.mean(axis=1)
        return cost


def _interpolation(times: Array, knots: Array) -> Array:
    """The matrix (times, knots) of linear interpolation; constant beyond the ends."""
    return np.stack([np.interp(times, knots, unit) for unit in np.eye(len(knots))], axis=-1)
