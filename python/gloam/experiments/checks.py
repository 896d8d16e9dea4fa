"""Checked values of JSON files: each error has the file and the name of the value."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from gloam.errors import InputError, IoError


def read_object(path: Path) -> dict[str, Any]:
    """The JSON object in a file. Errors: gloam.IoError, gloam.InputError."""

    def reject(text: str) -> float:
        raise InputError(f"the file contains {text}; all numbers must be finite", str(path))

    try:
        value = json.loads(path.read_text(encoding="utf-8"), parse_constant=reject)
    except OSError as error:
        raise IoError(f"cannot read the file: {error.strerror}", str(path)) from error
    except json.JSONDecodeError as error:
        raise InputError(f"the file is not JSON: {error.msg}", str(path), error.lineno, error.colno) from error
    except (UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"the file is not JSON: {type(error).__name__}", str(path)) from error
    if not isinstance(value, dict):
        raise InputError("the file must contain a JSON object", str(path))
    return value


class Fields:
    """Values of one JSON object by name. All methods raise gloam.InputError with the file and the name."""

    def __init__(self, values: dict[str, Any], path: Path) -> None:
        self._values = values
        self._path = path

    def error(self, name: str, cause: str) -> InputError:
        """An error about a value, to be raised by the caller."""
        return InputError(f"'{name}' {cause}", str(self._path))

    def value(self, name: str) -> Any:
        """The value as JSON has it."""
        if name not in self._values:
            raise self.error(name, "is missing")
        return self._values[name]

    def has(self, name: str) -> bool:
        """Whether the object has the value."""
        return name in self._values

    def text(self, name: str) -> str:
        """Text without NUL, which no file of the report can contain."""
        value = self.value(name)
        if not isinstance(value, str) or "\0" in value:
            raise self.error(name, "must be text")
        return value

    def boolean(self, name: str) -> bool:
        """true or false."""
        value = self.value(name)
        if not isinstance(value, bool):
            raise self.error(name, "must be true or false")
        return value

    def integer(self, name: str, least: int | None = None) -> int:
        """An integer of at least `least`."""
        value = self.value(name)
        if not isinstance(value, int) or isinstance(value, bool) or (least is not None and value < least):
            raise self.error(name, "must be an integer" + ("" if least is None else f" of at least {least}"))
        return value

    def length(self, name: str) -> float:
        """A finite number of at least 0."""
        value = self._number(name, self.value(name))
        if value < 0:
            raise self.error(name, f"is {value:g}; it must be at least 0")
        return value

    def optional_length(self, name: str) -> float | None:
        """A finite number of at least 0, or None for null."""
        return None if self.value(name) is None else self.length(name)

    def numbers(self, name: str, count: int) -> tuple[float, ...]:
        """An array of `count` finite numbers."""
        value = self.value(name)
        if not isinstance(value, list) or len(value) != count:
            raise self.error(name, f"must be an array of {count} numbers")
        return tuple(self._number(name, part) for part in value)

    def rows(self, name: str, numbers: int, texts: int = 0) -> tuple[tuple[Any, ...], ...]:
        """An array of arrays, each of so many finite numbers, followed by so many texts."""
        value = self.value(name)
        wrong = self.error(name, f"must be an array of arrays of {numbers} numbers" + (f" and {texts} text" if texts else ""))
        if not isinstance(value, list):
            raise wrong
        for row in value:
            if not isinstance(row, list) or len(row) != numbers + texts or not all(isinstance(part, str) for part in row[numbers:]):
                raise wrong
        return tuple((*(self._number(name, part) for part in row[:numbers]), *row[numbers:]) for row in value)

    def names(self, name: str) -> tuple[str, ...]:
        """An array of different names, each of which can be the name of a folder."""
        value = self.value(name)
        if not isinstance(value, list) or not value:
            raise self.error(name, "must be an array of names")
        for part in value:
            if not isinstance(part, str) or part.strip() in ("", ".", "..") or "/" in part or not part.isprintable():
                raise self.error(name, f"contains {part!r}, which cannot be the name of a folder")
        if len(set(value)) != len(value):
            raise self.error(name, "contains a name twice")
        return tuple(value)

    def counts(self, name: str) -> dict[str, int]:
        """An object with integers of at least 0."""
        value = self.value(name)
        if not isinstance(value, dict):
            raise self.error(name, "must be an object of counts")
        counts = Fields(value, self._path)
        return {part: counts.integer(part, least=0) for part in value}

    def description(self, name: str) -> str:
        """Text, or an object as text "key: value, …"."""
        value = self.value(name)
        if isinstance(value, dict):
            return ", ".join(f"{key}: {part}" for key, part in value.items())
        return self.text(name)

    def relative_file(self, name: str) -> str | None:
        """A file inside the episode's folder, or None for null. Links of the page lead to it."""
        if self.value(name) is None:
            return None
        text = self.text(name)
        # ":" would turn the link into an address such as "javascript:".
        if not text or ":" in text or "\\" in text or Path(text).is_absolute() or ".." in Path(text).parts:
            raise self.error(name, f"is {text!r}; it must be a file in the folder of the episode")
        return text

    def _number(self, name: str, value: Any) -> float:
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise self.error(name, "must be a number")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise self.error(name, f"is {number}; it must be finite")
        return number
