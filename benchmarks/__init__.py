"""Time, work, rate and memory of the solver: ``python -m benchmarks``."""
