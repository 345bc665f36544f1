"""Studies: many contacts, in parallel, resumable, one table.

::

    cases = [Case(f"SRR {s}", problem_at(s), options, {"SRR": s}) for s in (0.01, 0.1, 1.0)]
    store = Store("out/traction")
    run(cases, store, jobs=2)
    table(cases, store)
"""

from tehl.base.version import SOLVER_VERSION
from tehl.studies.answers import solve_contacts
from tehl.studies.axes import Axis, Sample
from tehl.studies.case import Case, Row
from tehl.studies.contacts import read_contacts
from tehl.studies.file import cases_of, read_study, study
from tehl.studies.plan import Study, study_of
from tehl.studies.runner import Outcome, StudyMonitor, run
from tehl.studies.store import Store
from tehl.studies.tables import table

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
    "read_contacts",
    "read_study",
    "run",
    "solve_contacts",
    "study",
    "study_of",
    "table",
]
