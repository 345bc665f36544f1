"""The errors that ``tehl`` raises.

::

    TehlError
    ├── InputError         what was asked cannot be: wrong name, unit or value
    ├── ConvergenceError   the solver did not reach the answer; carries the result so far
    └── FileFormatError    a file is not what it should be
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.result import Result


class TehlError(Exception):
    """Base of every error raised on purpose by ``tehl``."""


class InputError(TehlError):
    """An input is impossible; the message names it, its value, its unit and what would be right."""


class FileFormatError(TehlError):
    """A file is truncated, foreign or of an unknown version."""


class ConvergenceError(TehlError):
    """The solver stopped before the answer.

    Attributes
    ----------
    result : Result
        The last finite state, marked as not converged, with its history.
    """

    def __init__(self, message: str, result: "Result") -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type["ConvergenceError"], tuple[str, "Result"]]:
        """Travel between processes whole."""
        return type(self), (str(self), self.result)
