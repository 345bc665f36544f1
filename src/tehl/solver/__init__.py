"""Solvers of steady and transient contacts: full multigrid with the full approximation scheme."""

from tehl.solver.cost import with_work
from tehl.solver.judging.certify import certify
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.physics.bodies import solve
from tehl.solver.physics.passes import solve_passes
from tehl.solver.transient.certify import certify_transient
from tehl.solver.transient.run import solve_transient

__all__ = [
    "SILENT",
    "Monitor",
    "certify",
    "certify_transient",
    "solve",
    "solve_passes",
    "solve_transient",
    "with_work",
]
