"""Exceptions of Gloam: the problem, its location in a file, and a remedy."""
from __future__ import annotations


class Error(Exception):
    """Base of all exceptions of Gloam.

    message: one sentence; file, line, column: place in the user's files ("" and 0 where there is none); hint: remedy, may be "".
    """

    def __init__(self, message: str, file: str = "", line: int = 0, column: int = 0, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.line = line
        self.column = column
        self.hint = hint

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        return (f"{place}: " if place else "") + self.message + (f" ({self.hint})" if self.hint else "")

    def __reduce__(self) -> tuple[type[Error], tuple[str, str, int, int, str]]:
        return type(self), (self.message, self.file, self.line, self.column, self.hint)


class InputError(Error, ValueError):
    """A file or value from the user is wrong."""


class NotFoundError(InputError, KeyError):
    """Nothing of that name exists; the hint suggests the nearest name."""

    __str__ = Error.__str__


class IoError(Error, OSError):
    """Reading or writing failed: permission, a full disk, a port in use."""

    __str__ = Error.__str__


class UsageError(Error, ValueError):
    """The call is wrong."""


class PartialError(Error):
    """The run stopped early; the recording so far is complete and readable."""


class DivergedError(Error, ArithmeticError):
    """Physics produced a value that is not finite; the last valid state is kept, reset() continues."""


class UnsupportedError(Error, NotImplementedError):
    """Valid input that this build does not support."""


class StoppedError(Error):
    """Stopped by request."""


class ClosedError(Error, RuntimeError):
    """The simulation or stream was closed."""


class StuckError(Error, RuntimeError):
    """A callback or hook has not returned: the object is closed, but its thread is abandoned."""


class ForkedError(Error, RuntimeError):
    """The object belongs to another process."""
