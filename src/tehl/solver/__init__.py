"""From a problem to a result: full multigrid with the full approximation scheme."""

from tehl.solver.certify import certify
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import solve
from tehl.solver.transient.certify import certify_transient
from tehl.solver.transient.run import solve_transient
from tehl.solver.work import with_work

__all__ = [
    "SILENT",
    "Monitor",
    "certify",
    "certify_transient",
    "solve",
    "solve_transient",
    "with_work",
]
