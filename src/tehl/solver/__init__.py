"""From a problem to a result: full multigrid with the full approximation scheme."""

from tehl.solver.certify import certify
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import solve
from tehl.solver.transient import march
from tehl.solver.work import with_work

__all__ = ["SILENT", "Monitor", "certify", "march", "solve", "with_work"]
