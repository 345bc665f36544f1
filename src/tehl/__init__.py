"""Elastohydrodynamic lubrication of point and line contacts by full multigrid.

::

    problem, options = tehl.read_case_and_options("case.toml")
    result = tehl.solve(problem, options)

Exports are loaded on first use, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tehl.base.version import SOLVER_VERSION, __version__

if TYPE_CHECKING:
    from tehl import plots, post, studies
    from tehl.api.problem import ContactProblem, read_case, read_case_and_options
    from tehl.api.results import ConvergenceError, Result, TransientResult, load
    from tehl.api.solvers import certify, certify_transient, solve, solve_passes, solve_transient
    from tehl.base.errors import FileFormatError, InputError, TehlError
    from tehl.contact.materials import Solid, material
    from tehl.contact.options import Domain, Options
    from tehl.contact.tables import Contact, Surface
    from tehl.estimate.stiffness import film_stiffness
    from tehl.lubricant import Lubricant, oil
    from tehl.studies import solve_contacts, study
    from tehl.studies.fitting.oil import OilFit, fit

__all__ = [
    "SOLVER_VERSION",
    "Contact",
    "ContactProblem",
    "ConvergenceError",
    "Domain",
    "FileFormatError",
    "InputError",
    "Lubricant",
    "OilFit",
    "Options",
    "Result",
    "Solid",
    "Surface",
    "TehlError",
    "TransientResult",
    "__version__",
    "certify",
    "certify_transient",
    "film_stiffness",
    "fit",
    "load",
    "material",
    "oil",
    "plots",
    "post",
    "read_case",
    "read_case_and_options",
    "solve",
    "solve_contacts",
    "solve_passes",
    "solve_transient",
    "studies",
    "study",
]

_HOMES = {
    name: module
    for module, names in {
        "tehl.api.problem": ("ContactProblem", "read_case", "read_case_and_options"),
        "tehl.api.results": ("ConvergenceError", "Result", "TransientResult", "load"),
        "tehl.api.solvers": (
            *("certify", "certify_transient", "solve", "solve_passes", "solve_transient"),
        ),
        "tehl.base.errors": ("FileFormatError", "InputError", "TehlError"),
        "tehl.contact.materials": ("Solid", "material"),
        "tehl.contact.options": ("Domain", "Options"),
        "tehl.contact.point_contact": ("Contact", "Surface"),
        "tehl.estimate.stiffness": ("film_stiffness",),
        "tehl.lubricant": ("Lubricant", "oil"),
        "tehl.studies": ("solve_contacts", "study"),
        "tehl.studies.fitting.oil": ("OilFit", "fit"),
    }.items()
    for name in names
}


def __getattr__(name: str) -> Any:
    """Load an export from its module."""
    if name in ("plots", "post", "studies"):
        return import_module(f"tehl.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'tehl' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """List the exports, loaded or not, and nothing else."""
    return sorted(__all__)
