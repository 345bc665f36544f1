"""Load balance (docs/theory/model.md), which fixes the rigid approach."""

from tehl.base.typing import Array
from tehl.estimate.grid import Grid


class Load:
    """Integral of a field over the full domain, from the stored rows of ``grid``."""

    def __init__(self, grid: Grid) -> None:
        self.area = grid.dx * grid.dy
        self.mirror, self.is_line = grid.mirror, grid.ny == 1
        self.widths = grid.dx * grid.widths if grid.crowding else None

    def integral(self, pressure: Array) -> float:
        """Return the load carried by ``pressure`` [-], by the trapezoidal rule."""
        if self.is_line:
            return _row(pressure[0]) * self.area
        if self.widths is not None:
            ends = 0.5 * (pressure[:, 0] + pressure[:, -1])
            return float(self.widths @ (pressure.sum(axis=1) - ends))
        total = float(pressure.sum()) - 0.5 * float(pressure[:, 0].sum() + pressure[:, -1].sum())
        # each row beside the last one counts twice, where the half domain is stored
        last, first = 0.5 * _row(pressure[-1]), 0.5 * _row(pressure[0])
        total -= last + first
        return (2.0 * total if self.mirror else total) * self.area


def _row(values: Array) -> float:
    """Return the sum over a row by the trapezoidal rule."""
    return float(values.sum()) - 0.5 * float(values[0] + values[-1])
