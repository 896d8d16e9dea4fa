"""Every number of the training that is not the robot's or the gait's."""

from __future__ import annotations

from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class Commands:
    """Ranges at full difficulty, heading frame. Stairs and curbs limit vx to `stairs_vx`."""

    vx: tuple[float, float] = (-0.8, 1.6)  # [m/s]
    vy: tuple[float, float] = (-0.5, 0.5)  # [m/s]
    yaw_rate: tuple[float, float] = (-1.3, 1.3)  # [rad/s]
    stairs_vx: tuple[float, float] = (-0.6, 1.0)  # [m/s]
    standing: float = 0.1  # share of commands that are zero
    straight: float = 0.3  # share of commands without vy and yaw rate
    interval: tuple[float, float] = (4.0, 8.0)  # between new commands [s]


@dataclass(frozen=True)
class Randomisation:
    """Drawn once per world, unless noted."""

    maps: int = 13  # the first so many of terrain.MAP_KINDS
    friction: tuple[float, float] = (0.3, 1.3)
    payload: tuple[float, float] = (-1.5, 2.0)  # added to the trunk [kg]
    centre_of_mass: float = 0.03  # shift along each axis, ± [m]
    gains: float = 0.1  # kp, kd, ± relative
    strength: float = 0.1  # of each motor, ± relative
    delay: int = 3  # most physics steps between an observation and its targets
    soft_share: float = 0.25  # of worlds with soil
    compliance: tuple[float, float] = (1e-4, 4e-3)  # print depth per force on soil, log-uniform [m/N]
    soil_drag: tuple[float, float] = (20.0, 300.0)  # of a foot, per depth and speed [N s/m²]
    contact_time: tuple[float, float] = (0.01, 0.02)  # time constant of contacts [s]
    push: float = 1.0  # largest change of the trunk's velocity [m/s]; drawn for each push
    push_spin: float = 0.5  # largest change of its angular velocity [rad/s]
    push_interval: tuple[float, float] = (2.0, 6.0)  # [s]
    gyro_noise: float = 0.1  # ±, drawn for each observation [rad/s]
    gravity_noise: float = 0.02
    joint_noise: float = 0.01  # [rad]
    joint_speed_noise: float = 0.5  # [rad/s]


REWARDS: dict[str, float] = {  # weights
    "velocity": 1.0,
    "velocity_mean": 0.8,
    "yaw_rate": 0.5,
    "yaw_rate_mean": 0.4,
    "vertical_speed": -1.0,
    "tilt_rate": -0.04,
    "tilt": -2.5,
    "height": -25.0,
    "torque": -1e-4,
    "power": -4e-3,
    "joint_acceleration": -1e-7,
    "action_rate": -0.02,
    "action_jerk": -0.01,
    "hip": -0.3,
    "posture": -0.03,
    "standing": -0.3,
    "swing_force": -0.4,
    "stance_slip": -0.4,
    "clearance": -25.0,
    "shank": -0.4,
    "belly": -0.5,
}
FALL_PENALTY = 1.0


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
class Settings:
    seed: int = 1
    timestep: float = 0.004  # [s]
    episode: float = 20.0  # [s]
    ramp: int = 200  # iterations until commands and penalties reach full size
    commands: Commands = field(default_factory=Commands)
    randomisation: Randomisation = field(default_factory=Randomisation)
    ppo: Ppo = field(default_factory=Ppo)
    rewards: dict[str, float] = field(default_factory=lambda: dict(REWARDS))


@dataclass(frozen=True)
class Stage:
    """A part of the training, until an iteration. The published network was trained in these two parts."""

    until: int
    power: float  # weight of the reward
    push: float  # [m/s]
    entropy: float
    maps: int

    def settings(self, base: Settings) -> Settings:
        return replace(
            base,
            rewards=base.rewards | {"power": self.power},
            randomisation=replace(base.randomisation, push=self.push, maps=self.maps),
            ppo=replace(base.ppo, entropy=self.entropy),
        )


STAGES = (Stage(1047, -2e-3, 0.7, 0.005, 12), Stage(3375, -4e-3, 1.0, 0.003, 13))
