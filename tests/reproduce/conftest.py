"""Fixtures of these tests."""

from tests.reproduce.fixtures_small import sliding, small

__all__ = ["sliding", "small"]
