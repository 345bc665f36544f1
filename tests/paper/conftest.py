"""Small reproductions, made once: the paper's grid is what it is, the fine grids are coarse."""

from pathlib import Path

import pytest
from matplotlib.layout_engine import ConstrainedLayoutEngine
from paper.reproduce import needed_series, reproduce
from paper.runs import Runs

POINTS = 65
NAMES = ("T1", "T2", "F3")
SLIDING = ("T3", "C4", "C5", "P0", "P2")


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a small reproduction."""
    folder = tmp_path_factory.mktemp("reproduced")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: None)
        reproduce(folder, NAMES, points=POINTS, jobs=1)
    return folder


@pytest.fixture(scope="session")
def small_runs(small: Path) -> Runs:
    """Return the runs of the small reproduction."""
    return Runs(small, needed_series(NAMES), POINTS)


@pytest.fixture(scope="session")
def sliding(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    """Return the runs in which sliding varies, on small grids."""
    folder = tmp_path_factory.mktemp("sliding")
    reproduce(folder, SLIDING, points=POINTS, jobs=2)
    return Runs(folder, needed_series(SLIDING), POINTS)
