"""From a problem to a result: full multigrid with the full approximation scheme."""

from tehl.solver.certify import certify
from tehl.solver.certify_in_time import certify_march
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import solve
from tehl.solver.transient import march
from tehl.solver.work import with_work

__all__ = ["SILENT", "Monitor", "certify", "certify_march", "march", "solve", "with_work"]
