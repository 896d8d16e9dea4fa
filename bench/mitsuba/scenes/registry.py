"""Where a scene's function registers itself."""
from dataclasses import dataclass
from typing import Callable

ALL = {}


@dataclass
class Entry:
    title: str
    describe: Callable          # of Scales, to a Scene
    exact: Callable = None      # of a Scene, to the radiance of each block by a closed form, row by row


def scene(title, exact=None):
    def register(function):
        ALL[function.__name__] = Entry(title, function, exact)
        return function
    return register
