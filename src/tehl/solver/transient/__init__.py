"""Transient films: roughness that moves with its surface, varying loads."""

from tehl.solver.transient.certify import certify_transient
from tehl.solver.transient.run import solve_transient

__all__ = ["certify_transient", "solve_transient"]
