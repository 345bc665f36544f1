"""The errors that ``tehl`` raises.

::

    TehlError
    ├── InputError         an input is invalid: wrong name, unit or value
    ├── FileFormatError    a file has the wrong format
    └── ConvergenceError   the solver did not converge; in `tehl.api`, carries a result
"""


class TehlError(Exception):
    """Base of all errors that ``tehl`` raises on purpose."""


class InputError(TehlError):
    """An input is invalid; the message has its name, value and unit, and what is expected."""


class FileFormatError(TehlError):
    """A file is truncated, of another program or of an unknown version."""
