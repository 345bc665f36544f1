"""Version of the package, and of its solver."""

__version__ = "0.1.0"
SOLVER_VERSION = 38
"""To be raised with each change of the solver that makes stored results of studies invalid."""
