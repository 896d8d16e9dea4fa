"""Where a scene's function registers itself."""
from dataclasses import dataclass
from typing import Callable

ALL = {}


@dataclass
class Entry:
    title: str
    describe: Callable          # of Scales, to a Scene
    exact: Callable = None      # of a Scene, to the radiance of each block by a closed form, row by row
    peer: bool = True           # Mitsuba can render it; else the closed form takes its place


def scene(title, exact=None, peer=True):
    def register(function):
        ALL[function.__name__] = Entry(title, function, exact, peer)
        return function
    return register
