"""Compiled loops: arrays, floats and named tuples in, arrays out; no laws, no errors."""
