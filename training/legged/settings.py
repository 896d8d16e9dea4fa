"""Settings of a training. The defaults are those that all robots share; each task replaces the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from .robot import Robot


@dataclass(frozen=True)
class Commands:
    """Ranges at full difficulty, heading frame. Stairs and curbs limit vx to `stairs_vx`."""

    vx: tuple[float, float]  # [m/s]
    vy: tuple[float, float]  # [m/s]
    yaw_rate: tuple[float, float]  # [rad/s]
    stairs_vx: tuple[float, float] = (-0.6, 1.0)  # [m/s]
    standing: float = 0.1  # share of commands that are zero
    straight: float = 0.3  # share of commands without vy and yaw rate
    interval: tuple[float, float] = (4.0, 8.0)  # between new commands [s]


@dataclass(frozen=True)
class Gaits:
    """Ranges of gait parameters; units as in gait.Gait."""

    shares: tuple[float, float, float]  # of trot, pace and bound; two legs always alternate: trot
    frequency: tuple[float, float]
    duration: tuple[float, float]
    swing_height: tuple[float, float]
    body_height: tuple[float, float]


@dataclass(frozen=True)
class Randomisation:
    """Drawn once per world, unless noted."""

    payload: tuple[float, float]  # added to the trunk [kg]
    push: float  # largest change of the trunk's velocity [m/s]; drawn for each push
    maps: int = 13  # the first so many of terrain.MAP_KINDS
    level: float = 1.2  # largest scale of the ground's heights
    friction: tuple[float, float] = (0.3, 1.3)
    centre_of_mass: float = 0.03  # shift along each axis, ± [m]
    gains: float = 0.1  # kp, kd, ± relative
    strength: float = 0.1  # of each motor, ± relative
    delay: int = 3  # most physics steps between an observation and its targets
    soft_share: float = 0.25  # of worlds with soil
    compliance: tuple[float, float] = (1e-4, 4e-3)  # print depth per force on soil, log-uniform [m/N]
    soil_drag: tuple[float, float] = (20.0, 300.0)  # of a foot, per depth and speed [N s/m²]
    contact_time: tuple[float, float] = (0.01, 0.02)  # time constant of contacts [s]
    push_spin: float = 0.5  # largest change of its angular velocity [rad/s]
    push_interval: tuple[float, float] = (2.0, 6.0)  # [s]
    start: float = 0.15  # of the joints around their default positions at the start of an episode, ± [rad]
    velocity_noise: float = 0.1  # ±, drawn for each observation [m/s]
    gyro_noise: float = 0.1  # [rad/s]
    gravity_noise: float = 0.02
    joint_noise: float = 0.01  # [rad]
    joint_speed_noise: float = 0.5  # [rad/s]


@dataclass(frozen=True)
class Ppo:
    """Proximal policy optimisation (Schulman et al. 2017) with the adaptive step size of rsl_rl."""

    worlds: int = 8192
    horizon: int = 24  # control steps per iteration
    epochs: int = 5
    minibatches: int = 4
    discount: float = 0.99
    lam: float = 0.95
    clip: float = 0.2
    entropy: float = 0.003
    value_weight: float = 1.0
    target_kl: float = 0.01
    learning_rate: float = 1e-3
    least_learning_rate: float = 5e-5
    most_learning_rate: float = 2e-3
    gradient_norm: float = 1.0
    hidden: tuple[int, ...] = (512, 256, 128)
    initial_deviation: float = 0.8


@dataclass(frozen=True)
class Stage:
    """A part of the training, until an iteration."""

    until: int
    power: float  # weight of the reward
    push: float  # [m/s]
    entropy: float
    maps: int


@dataclass(frozen=True)
class Settings:
    robot: Robot
    commands: Commands
    gaits: Gaits
    randomisation: Randomisation
    rewards: Mapping[str, float]  # weights of rewards.py; rewards without a weight are not computed
    stages: tuple[Stage, ...]
    fall_height: float  # of the free body's origin above the ground: a fall [m]
    fall_penalty: float = 1.0
    velocity_feedback: float = 0.0  # of the published policy (docs/policies.md), not of the training [1/s]
    seed: int = 1
    timestep: float = 0.004  # [s]
    episode: float = 20.0  # [s]
    ramp: int = 200  # iterations until commands and penalties reach full size
    ppo: Ppo = field(default_factory=Ppo)

    def of(self, stage: Stage) -> Settings:
        return replace(
            self,
            rewards={**self.rewards, "power": stage.power},
            randomisation=replace(self.randomisation, push=stage.push, maps=stage.maps),
            ppo=replace(self.ppo, entropy=stage.entropy),
        )
