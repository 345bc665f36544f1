"""Time, work, rate, memory and robustness of the solver: ``python -m benchmarks``."""
