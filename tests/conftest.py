"""Fixtures for all tests."""

from tests.fixtures_result import certified, result, stalled
from tests.fixtures_rough import rough, smooth
from tests.fixtures_thermal import sheared, thermal

__all__ = ["certified", "result", "rough", "sheared", "smooth", "stalled", "thermal"]
