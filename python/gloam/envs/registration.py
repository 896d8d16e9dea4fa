"""The environments under their names in gymnasium's registry."""

from __future__ import annotations

import gymnasium as gym

_MODULE = "gloam.envs.registered"
_TASKS = {"PointGoal": 300, "QuadrupedVelocity": 1000, "Reach": 100}  # and control steps of an episode


def register_envs() -> None:
    """Registers gloam/PointGoal-v0, gloam/QuadrupedVelocity-v0 and gloam/Reach-v0; once is enough, more do no harm."""
    for name, steps in _TASKS.items():
        full = f"gloam/{name}-v0"
        if full not in gym.registry:
            gym.register(
                full,
                entry_point=f"{_MODULE}:{name}Env",
                vector_entry_point=f"{_MODULE}:{name}VectorEnv",
                max_episode_steps=steps,
            )
