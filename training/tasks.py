"""The robots that are trained. A task is a package whose module `settings` has SETTINGS (legged/settings.py)."""

from __future__ import annotations

import importlib

from .legged.robot import Robot
from .legged.settings import Settings

NAMES = ("quadruped", "mobile_manipulator", "humanoid")


def settings(name: str) -> Settings:
    found: Settings = importlib.import_module(f".{name}.settings", __package__).SETTINGS
    return found


def robot(name: str) -> Robot:
    return settings(name).robot
