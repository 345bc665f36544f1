"""The errors that ``tehl`` raises.

::

    TehlError
    ├── InputError         an input is invalid: wrong name, unit or value
    ├── ConvergenceError   the solver did not converge; carries the result so far
    └── FileFormatError    a file has the wrong format
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.result import Result


class TehlError(Exception):
    """Base of all errors that ``tehl`` raises on purpose."""


class InputError(TehlError):
    """An input is invalid; the message has its name, value and unit, and what is expected."""


class FileFormatError(TehlError):
    """A file is truncated, of another program or of an unknown version."""


class ConvergenceError(TehlError):
    """The solver did not converge; ``result`` is the last finite state, with its history."""

    def __init__(self, message: str, result: "Result") -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type["ConvergenceError"], tuple[str, "Result"]]:
        """Pickle with the result, so that worker processes can raise it."""
        return type(self), (str(self), self.result)
