"""Fixtures for all tests."""

from tests.fixtures_result import certified, result, stalled

__all__ = ["certified", "result", "stalled"]
