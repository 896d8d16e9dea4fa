"""Planners. Importing this package registers them."""

from . import external, geometric, goal_image, library, nomad, simple

__all__ = ["external", "geometric", "goal_image", "library", "nomad", "simple"]
