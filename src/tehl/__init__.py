"""Elastohydrodynamic lubrication of point contacts by full multigrid.

::

    problem, options = tehl.read_case_and_options("case.toml")
    result = tehl.solve(problem, options)

What this package exports is loaded when it is first asked for, so that importing it costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tehl import plots, studies
    from tehl.errors import ConvergenceError, FileFormatError, InputError, TehlError
    from tehl.io.case import read_case, read_case_and_options
    from tehl.io.store import load
    from tehl.lubricant import Lubricant, oil
    from tehl.materials import Solid, material
    from tehl.options import Domain, Options
    from tehl.problem import Contact, ContactProblem, Surface
    from tehl.result import Result
    from tehl.solver import certify, certify_transient, solve, solve_transient
    from tehl.studies import study
    from tehl.transient_result import TransientResult

__all__ = [
    "Contact",
    "ContactProblem",
    "ConvergenceError",
    "Domain",
    "FileFormatError",
    "InputError",
    "Lubricant",
    "Options",
    "Result",
    "Solid",
    "Surface",
    "TehlError",
    "TransientResult",
    "__version__",
    "certify",
    "certify_transient",
    "load",
    "material",
    "oil",
    "plots",
    "read_case",
    "read_case_and_options",
    "solve",
    "solve_transient",
    "studies",
    "study",
]

__version__ = "0.1.0"
SOLVER_VERSION = 4
"""To be raised with each change of the solver after which answers kept before would mislead."""

_HOMES = {
    "Contact": "tehl.problem",
    "ContactProblem": "tehl.problem",
    "ConvergenceError": "tehl.errors",
    "Domain": "tehl.options",
    "TransientResult": "tehl.transient_result",
    "FileFormatError": "tehl.errors",
    "InputError": "tehl.errors",
    "Lubricant": "tehl.lubricant",
    "Options": "tehl.options",
    "Result": "tehl.result",
    "Solid": "tehl.materials",
    "Surface": "tehl.problem",
    "TehlError": "tehl.errors",
    "certify": "tehl.solver",
    "certify_transient": "tehl.solver",
    "load": "tehl.io.store",
    "solve_transient": "tehl.solver",
    "material": "tehl.materials",
    "oil": "tehl.lubricant",
    "read_case": "tehl.io.case",
    "read_case_and_options": "tehl.io.case",
    "solve": "tehl.solver",
    "study": "tehl.studies",
}


def __getattr__(name: str) -> Any:
    """Load an export from where it lives."""
    if name in ("plots", "studies"):
        return import_module(f"tehl.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'tehl' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Show the exports, loaded or not, and nothing else."""
    return sorted(__all__)
