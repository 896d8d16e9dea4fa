"""Lists and tables of a scene's options: read-only copies, because changes of them would have no effect."""
from __future__ import annotations

from typing import Any, NoReturn


def _refuse(*_: Any, **__: Any) -> NoReturn:
    raise TypeError('the value of an option is a copy that cannot be changed: assign the whole value, as in '
                    'scene["camera.front.position"] = [2, 0, 1], or change list(value)')


class OptionList(list[Any]):
    """A list of an option, for reading."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = append = extend = insert = pop = remove = clear = sort = reverse = _refuse

    def __reduce__(self) -> tuple[Any, ...]:
        return list, (list(self),)


class OptionTable(dict[str, Any]):
    """A table of an option, for reading."""

    __setitem__ = __delitem__ = __ior__ = pop = popitem = clear = update = setdefault = _refuse

    def __reduce__(self) -> tuple[Any, ...]:
        return dict, (dict(self),)


def frozen(value: Any) -> Any:
    """The value with read-only lists and tables."""
    if isinstance(value, dict):
        return OptionTable({key: frozen(inner) for key, inner in value.items()})
    if isinstance(value, list):
        return OptionList(frozen(inner) for inner in value)
    return value
