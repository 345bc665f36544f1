"""Fixtures for all tests; what they share is compiled and collected once."""

import gc
import signal

import pytest
from matplotlib.layout_engine import ConstrainedLayoutEngine

from tests.fixtures_result import certified, result, stalled
from tests.fixtures_rough import rough, smooth
from tests.fixtures_thermal import sheared, thermal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # in the background of a shell: the programs that tests start would inherit it, and never end
    signal.signal(signal.SIGINT, signal.default_int_handler)

__all__ = ["certified", "result", "rough", "sheared", "smooth", "stalled", "thermal"]


@pytest.fixture(autouse=True)
def unarranged(monkeypatch):
    """Draw pictures without searching the places of their parts, which takes most of the time.

    They are searched in tests/plots, which judges pictures.
    """
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: None)


@pytest.fixture
def no_pictures(monkeypatch):
    """Leave out the pictures of a report, whose drawing takes seconds."""
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})


@pytest.fixture
def unrendered(monkeypatch):
    """Leave out the pixels of the pictures of a report, which take most of its time."""

    def write(picture, file, dpi):
        del picture, dpi
        file.write(b"\x89PNG\r\n\x1a\n")

    monkeypatch.setattr("tehl.report.notebook.write_png", write)


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Leave what is imported and collected out of the search for garbage: a tenth of the time."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(10_000)
        gc.enable()
