"""Positions of episodes in a benchmark, and their folders."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """Position of an episode in the request; `episode` counts from 0 and pairs the same task across cells."""

    planner: str
    scene: str
    level: str
    episode: int

    @property
    def name(self) -> str:
        """Folder of the episode, relative to `episodes` of the benchmark."""
        return f"{self.planner}/{self.scene}/{self.level}/{self.episode:04d}"

    @property
    def folder(self) -> str:
        """Folder of the episode, relative to the folder of the benchmark."""
        return f"episodes/{self.name}"
