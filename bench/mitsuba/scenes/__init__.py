"""The scenes. To add one: a function with @scene in a module of this folder; a module of its own goes into the list below."""
from scenes.registry import ALL  # noqa: F401
from scenes import materials, glass, textures, lights, lamps, media, skies, analytic  # noqa: F401  isort: skip
