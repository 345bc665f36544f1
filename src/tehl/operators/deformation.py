"""Elastic deflection of two half-spaces: direct sum, FFT and multilevel sum, one interface."""

from typing import Protocol

import numpy as np

from tehl.grid import Grid
from tehl.operators.influence import dense_matrix, influence_of
from tehl.operators.multilevel import MultilevelDeformation
from tehl.scaling import Groups
from tehl.typing import Array

MULTILEVEL_FROM = {True: 128, False: 256}
"""Intervals from which the multilevel sum is the cheaper, on half (True) and on the full domain, at
an error that does not count."""
LARGEST_ASPECT = 4.0
"""Ratio of the cell sides beyond which the patches of the multilevel sum are no longer enough."""


class Deformation(Protocol):
    """What the film equation asks of a deflection."""

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``, both of the grid's shape."""
        ...


class DirectDeformation:
    """Sum by definition, O(n^2): the reference of the tests."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.matrix = dense_matrix(grid.shape, grid.mirror, influence_of(grid, groups))

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        np.einsum("mk,k->m", self.matrix, pressure.ravel(), out=out.reshape(-1))


class FftDeformation:
    """Exact convolution by zero-padded FFT, O(n log n): no periodic image, no truncation.

    A pressure that vanishes on the edges needs a period of twice the intervals only.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.mirror = grid.mirror
        self.period = (2 * (grid.ny - 1), 2 * (grid.nx - 1))
        rows, columns = (np.minimum(np.arange(n), n - np.arange(n)) for n in self.period)
        influence = influence_of(grid, groups)
        table = influence(np.arange(grid.ny)[:, None], np.arange(grid.nx)[None, :])
        self.spectrum = np.fft.rfft2(table[np.ix_(rows, columns)]).real.copy()
        self.padded, self.convolved = np.zeros(self.period), np.zeros(self.period)
        self.transform = np.zeros(self.spectrum.shape, complex)

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        ny, nx = pressure.shape
        self.padded[:ny, :nx] = pressure
        if self.mirror:
            self.padded[:-ny:-1, :nx] = pressure[1:]
        np.fft.rfft2(self.padded, out=self.transform)
        self.transform *= self.spectrum
        np.fft.ifft(self.transform, axis=0, out=self.transform)
        np.fft.irfft(self.transform, self.period[1], axis=1, out=self.convolved)
        out[:] = self.convolved[:ny, :nx]


def choose(name: str, grid: Grid, groups: Groups) -> Deformation:
    """Return the deformation called ``name``; ``"auto"`` is the cheaper at equal accuracy.

    Parameters
    ----------
    name : {"auto", "mlmi", "fft", "direct"}
        As in `tehl.options.Options`.
    grid : Grid
        Where the pressure lives.
    groups : Groups
        Ellipticity and deflection factor.
    """
    if name == "auto":
        aspect = groups.ellipticity * grid.dy / grid.dx
        compact = 1.0 / LARGEST_ASPECT <= aspect <= LARGEST_ASPECT
        large = min(grid.nx, grid.ny) - 1 >= MULTILEVEL_FROM[grid.mirror]
        name = "mlmi" if compact and large else "fft"
    if name == "mlmi":
        return MultilevelDeformation(grid, influence_of(grid, groups))
    if name == "fft":
        return FftDeformation(grid, groups)
    return DirectDeformation(grid, groups)
