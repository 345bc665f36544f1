"""Load balance, sum(P) dx dy = 2 pi / 3 (docs/theory/model.md), which fixes the rigid approach."""

import numpy as np

from tehl.grid import Grid
from tehl.typing import Array

TARGET = 2.0 * np.pi / 3.0
"""Integral of the Hertz pressure over X, Y, for any ellipticity."""


class Load:
    """Integral of a field over the full domain, from the stored rows of ``grid``."""

    def __init__(self, grid: Grid) -> None:
        self.area = grid.dx * grid.dy
        self.mirror = grid.mirror

    def integral(self, pressure: Array) -> float:
        """Return the load carried by ``pressure`` [-]."""
        total = float(pressure.sum())
        if self.mirror:
            total += total - float(pressure[0].sum())
        return total * self.area
