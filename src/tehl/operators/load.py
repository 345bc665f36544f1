"""Load balance: the pressure carries the load, which fixes the rigid approach."""

import numpy as np

from tehl.grid import Grid
from tehl.typing import Array

TARGET = 2.0 * np.pi / 3.0
"""Integral of P over X, Y for a Hertz contact of any ellipticity."""


class Load:
    """Integral of a field over the full domain, from the rows that are held."""

    def __init__(self, grid: Grid) -> None:
        self.area = grid.dx * grid.dy
        self.mirror = grid.mirror

    def integral(self, pressure: Array) -> float:
        """Return the load carried by ``pressure`` [-]."""
        total = float(pressure.sum())
        if self.mirror:
            total += total - float(pressure[0].sum())
        return total * self.area
