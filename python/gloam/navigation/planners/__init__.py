"""Planners. Importing this package registers them."""

from . import geometric, simple

__all__ = ["geometric", "simple"]
