"""Studies: many contacts, in parallel, resumable, one table.

::

    cases = [Case(f"SRR {s}", problem_at(s), options, {"SRR": s}) for s in (0.01, 0.1, 1.0)]
    store = Store("out/traction")
    run(cases, store, jobs=2)
    table(cases, store)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tehl import SOLVER_VERSION

if TYPE_CHECKING:
    from tehl.studies.axes import Axis, Sample
    from tehl.studies.case import Case, Row
    from tehl.studies.file import read_study
    from tehl.studies.plan import Study, study_of
    from tehl.studies.quick import cases_of, study
    from tehl.studies.runner import Outcome, StudyMonitor, run
    from tehl.studies.store import Store
    from tehl.studies.tables import table

_HOMES = {
    "Axis": "axes",
    "Case": "case",
    "Outcome": "runner",
    "Row": "case",
    "Sample": "axes",
    "Store": "store",
    "Study": "plan",
    "StudyMonitor": "runner",
    "cases_of": "quick",
    "read_study": "file",
    "run": "runner",
    "study": "quick",
    "study_of": "plan",
    "table": "tables",
}

__all__ = [
    "SOLVER_VERSION",
    "Axis",
    "Case",
    "Outcome",
    "Row",
    "Sample",
    "Store",
    "Study",
    "StudyMonitor",
    "cases_of",
    "read_study",
    "run",
    "study",
    "study_of",
    "table",
]


def __getattr__(name: str) -> Any:
    """Load an export from where it lives."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """List the exports, loaded or not."""
    return sorted(__all__)
