"""Elastic deflection K P of two half-spaces: direct sum, two sums by FFT, multilevel sum.

All evaluate  w_m = sum_k K_(m-k) P_k  with the cell influence K of `tehl.operators.influence`.
"""

from typing import Protocol
from weakref import WeakValueDictionary

import numpy as np
from scipy.fft import dct, dctn, idct, idctn, irfft, rfft

from tehl.base.typing import Array
from tehl.contact.shape import LINE
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups
from tehl.kernels.lanes import LANES
from tehl.kernels.summation import sum_across
from tehl.operators.crowded import CrowdedDeformation
from tehl.operators.influence import influence_of, matrix_of
from tehl.operators.multilevel import MultilevelDeformation

LINES_UP_TO = {True: 200, False: 160}
"""Intervals of the full domain, in the direction with fewer, up to which the sum by lines is the
cheapest: on a half domain (True) and on a full one. Beyond it is the multilevel sum, whose error is
negligible beside that of the discretisation (``python -m benchmarks deformation``)."""
MOST_DIRECT = 192
"""Nodes of a line up to which its direct sum is the fastest: on 33 and 161 it takes 2 and 5 us, by
FFT 20 and 25; on 257 and 513 it takes 22 and 54, by FFT 30."""
ASPECTS = (0.12, 32.0)
"""Ratios of the cell sides, across over along, within which the multilevel sum of a Hertz pressure
with a spike errs by no more than twice that on square cells, at a quarter of the cost of the FFT
(257 x 129 to 1025 x 513 nodes)."""


class Deformation(Protocol):
    """Elastic deflection on one grid, as the film equation needs it."""

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``, both of the grid's shape.

        Parameters
        ----------
        pressure : Array
            P at the nodes [-], (ny, nx), y >= 0 only on mirrored grids; zero on the edges.
        out : Array
            Overwritten by the deflection [-], (ny, nx).
        """
        ...


class DirectDeformation:
    """Direct sum in O(n^2) operations for n nodes: the fastest on few, and the tests' reference."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.matrix = matrix_of(grid, influence_of(grid, groups))

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``, which is contiguous."""
        np.dot(self.matrix, pressure.ravel(), out=out.reshape(-1))


class FftDeformation:
    """Exact convolution by zero-padded FFT in O(n log n) operations, without periodic images.

    As the pressure vanishes on the edges, a period of twice the intervals suffices.
    """

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.mirror = grid.mirror
        self.period = (2 * (grid.ny - 1) or 1, 2 * (grid.nx - 1))
        # the kernel is even: offset n - k equals offset -k
        rows, columns = (np.minimum(np.arange(n), n - np.arange(n)) for n in self.period)
        table = influence_of(grid, groups).table(grid.ny, grid.nx)
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


class Flattening:
    """Pressure that makes a deflection, by division of the cosine transforms.

    The inverse of K where the pressure is mirrored at the edges, an approximate one on a part of
    the plane: it preconditions the equations of a contact. Where the film wraps along y the
    transform along it is that of Fourier.
    """

    LEAST = 1e-6
    """Least part of the spectrum over its largest value."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.axes, self.wraps = (0, 1) if grid.ny > 1 else (1,), grid.wraps
        table = influence_of(grid, groups).table(*grid.shape)
        size = np.abs(self._parts(table))  # of a line that of the mean may be negative
        self.spectrum = np.maximum(size, self.LEAST * size.max())

    def deflect(self, film: Array, out: Array) -> None:
        """Write the pressure that makes ``film`` to ``out``."""
        parts = self._parts(film)
        parts /= self.spectrum
        if not self.wraps:
            out[:] = idctn(parts, 1, axes=self.axes, overwrite_x=True)
            return
        out[:-1] = irfft(idct(parts, 1, axis=1), film.shape[0] - 1, axis=0)
        out[-1] = out[0]

    def _parts(self, field: Array) -> Array:
        """Return the transform of a field, or of an influence over its distances."""
        if self.wraps:
            return np.asarray(rfft(dct(field[:-1], 1, axis=1), axis=0))
        return np.asarray(dctn(field, 1, axes=self.axes))


class LineDeformation:
    """Exact convolution by FFT along x and direct sum across lines: the fastest with few lines."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        ny, nx = grid.shape
        self.period = 2 * (nx - 1)
        columns = np.arange(self.period)
        table = influence_of(grid, groups).table(2 * ny - 1 if grid.mirror else ny, nx)
        spectrum = np.fft.rfft(table[:, np.minimum(columns, self.period - columns)]).real
        # offsets from -(ny - 1) on; on a half domain up to the mirror images
        kernel = np.concatenate([spectrum[ny - 1 : 0 : -1], spectrum]).T
        self.kernel = np.zeros((nx, kernel.shape[1] + LANES))
        self.kernel[:, : kernel.shape[1]] = kernel
        self.transform, self.product = np.zeros((2, ny, nx), complex)
        self.convolved, self.scratch = np.zeros((ny, self.period)), np.zeros((2, ny))
        self.mirror = int(grid.mirror)

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        np.fft.rfft(pressure, self.period, out=self.transform)
        sum_across(self.transform, self.kernel, self.scratch, self.product, self.mirror)
        np.fft.irfft(self.product, self.period, out=self.convolved)
        out[:] = self.convolved[:, : pressure.shape[1]]


class MirroredDeformation:
    """Exact convolution where all goes on, mirrored at both sides: by cosines along y."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.period = 2 * (grid.nx - 1)
        columns = np.arange(self.period)
        table = influence_of(grid, groups).table(*grid.shape)
        table = table[:, np.minimum(columns, self.period - columns)]
        self.spectrum = dct(np.fft.rfft(table).real, 1, axis=0)
        self.spectrum /= 2 * (grid.shape[0] - 1)  # lines after which all is the same

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        parts = np.fft.rfft(dct(pressure, 1, axis=0), self.period)
        parts *= self.spectrum
        lines = np.fft.irfft(parts, self.period)[:, : pressure.shape[1]]
        out[:] = dct(lines, 1, axis=0)


class WrappedDeformation:
    """Exact convolution where all wraps along y: by Fourier series along both axes."""

    def __init__(self, grid: Grid, groups: Groups) -> None:
        self.period = (grid.shape[0] - 1, 2 * (grid.nx - 1))
        rows, columns = (np.minimum(np.arange(n), n - np.arange(n)) for n in self.period)
        table = influence_of(grid, groups).table(int(rows.max()) + 1, grid.nx)
        table = table[np.ix_(rows, columns)]
        self.spectrum = np.fft.rfft2(table).real.copy()

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        parts = np.fft.rfft2(pressure[:-1], self.period)
        parts *= self.spectrum
        out[:-1] = np.fft.irfft2(parts, self.period)[:, : pressure.shape[1]]
        out[-1] = out[0]


CROWDED: "WeakValueDictionary[tuple[Grid, Groups], CrowdedDeformation]" = WeakValueDictionary()
"""Of the levels in use: the dry pressure of a grid shares that of its level."""


class BetweenEnds:
    """Deflection by a roller, whose first and last lines have cells of half the width.

    Half the pressure on a whole cell makes the same, but for the place of its middle.
    """

    def __init__(self, inner: Deformation, grid: Grid) -> None:
        self.inner, self.lines = inner, [-1] if grid.mirror else [0, -1]
        self.halved = np.zeros(grid.shape)

    def deflect(self, pressure: Array, out: Array) -> None:
        """Write the deflection under ``pressure`` to ``out``."""
        self.halved[:] = pressure
        self.halved[self.lines] *= 0.5
        self.inner.deflect(self.halved, out)


def choose(name: str, grid: Grid, groups: Groups, *, exact: bool = False) -> Deformation:
    """Return the deflection operator ``name``; ``"auto"`` is the cheapest at equal accuracy.

    Parameters
    ----------
    name : {"auto", "mlmi", "fft", "lines", "direct"}
        As in `tehl.contact.options.Options`.
    grid : Grid
        Grid of the pressure.
    groups : Groups
        Ellipticity and deflection factor.
    exact : bool
        Whether ``"auto"`` takes a sum that is exact to rounding: the multilevel one errs by 4e-4 of
        a pressure peak of a few mesh widths.
    """
    if grid.crowding:
        known = CROWDED.get((grid, groups))
        if known is None:
            CROWDED[grid, groups] = known = CrowdedDeformation(grid, groups)
        return known
    if name == "direct":
        return DirectDeformation(grid, groups)
    if groups.shape.goes_on:
        return (WrappedDeformation if grid.wraps else MirroredDeformation)(grid, groups)
    found = _choose(name, grid, groups, exact=exact)
    return BetweenEnds(found, grid) if grid.is_closed else found


def _choose(name: str, grid: Grid, groups: Groups, *, exact: bool) -> Deformation:
    if groups.shape is LINE:
        if grid.nx <= MOST_DIRECT:
            return DirectDeformation(grid, groups)
        name = "lines"  # of one row: the sum by FFT
    if name == "auto":
        aspect = groups.ellipticity * grid.dy / grid.dx
        compact = ASPECTS[0] <= aspect <= ASPECTS[1]
        few = min(grid.nx, grid.ny) - 1 <= LINES_UP_TO[grid.mirror]
        name = "lines" if few else "mlmi" if compact and not exact else "fft"
    if name == "mlmi":
        return MultilevelDeformation(grid, influence_of(grid, groups))
    if name == "lines":
        return LineDeformation(grid, groups)
    return FftDeformation(grid, groups)
