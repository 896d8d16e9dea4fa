"""Planners. Importing this package registers them."""

from . import external, geometric, simple

__all__ = ["external", "geometric", "simple"]
