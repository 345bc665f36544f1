r"""Stress of a half-space under uniform pressure and traction on rectangular cells, exactly.

Coordinates x and y lie in the surface and z points into the body; tension is positive. All
components under a unit load at the origin are sums of derivatives of the potentials
:math:`\psi = \ln(R + z)` and :math:`\Omega = z \ln(R + z) - R` of Boussinesq and Cerruti (Johnson,
Contact Mechanics, eqs. 3.7 to 3.10). Each derivative has an antiderivative over x and y, a cell
needs it at its four corners (Love 1929), and a grid of cells is a convolution by padded FFT:
nothing wraps around, and no depth is too shallow (docs/theory/stress.md).
"""

import math
from collections.abc import Sequence
from functools import reduce
from operator import iadd
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct, dst, ifft, irfft, next_fast_len, rfft2
from scipy.interpolate import CubicSpline

from tehl.base.typing import Array

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "zx")
"""Components of the stress in the order of all arrays here."""
EVEN, ODD_X, ODD_Y, ODD_XY = range(4)
_PARITIES = (
    (EVEN, EVEN, EVEN, ODD_XY, ODD_Y, ODD_X),
    (ODD_X, ODD_X, ODD_X, ODD_Y, ODD_XY, EVEN),
    (ODD_Y, ODD_Y, ODD_Y, ODD_X, EVEN, ODD_XY),
)
"""Symmetry of the components under a load at the origin: pressure, traction along x and along y."""
_MIRRORED = np.array([1.0, 1.0, 1.0, -1.0, -1.0, 1.0])
"""Signs of the components on the other side of a plane y = const of symmetry."""

Spectra = list[NDArray[Any] | None]
Influence = tuple[Array, Array, Array, Array]
Steps = tuple[int, int]
"""Nodes along y and x to the next one that a depth needs."""
WIDEST_STEP = 4
"""Most nodes to the next, a power of two."""
LINE_CELL_LENGTH = 1e7
"""Length of the cells of a line over all of them along x: plane strain to 5e-8."""


class Space(Protocol):
    """Finds stresses depth by depth; the influence of a depth is its own."""

    mirror: bool

    def steps(self, depth: float) -> Steps: ...  # noqa: D102
    def steps_of(self, influence: Any) -> Steps: ...  # noqa: D102
    def rows(self, steps: Steps) -> slice: ...  # noqa: D102
    def weights(self, steps: Steps) -> Array: ...  # noqa: D102
    def on_all_rows(self, values: Array, steps: Steps) -> Array: ...  # noqa: D102
    def spectra_of(self, pressure: Array, *tractions: Array) -> Spectra: ...  # noqa: D102
    def thinned(self, spectra: Spectra, steps: Steps) -> Spectra: ...  # noqa: D102
    def influence(self, depth: float, steps: Steps = (1, 1)) -> Any: ...  # noqa: D102
    def stresses(self, spectra: Spectra, influence: Any, poisson_ratio: float) -> Array: ...  # noqa: D102


class HalfSpace:
    """A half-space under loads on a grid, whose stresses are found depth by depth.

    A grid of one row is a line contact, with cells of `LINE_CELL_LENGTH`. Short waves decay with
    the depth: deep down every second or fourth wave number, node and row are enough (`steps`). Of
    loads that are symmetric about a row (``mirror``) only the rows from it on are computed.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        spacing: tuple[float, float],
        *,
        single: bool = False,
        row: int = 0,
        mirror: bool = False,
    ) -> None:
        """Take a grid of (ny, nx) nodes and its mesh widths (dy, dx), in any unit of length.

        In ``single`` precision stresses take half the time, with errors of 1e-6 of the load. The
        ``row`` is one of those at all depths.
        """
        self.shape, self.spacing = shape, spacing
        if shape[0] == 1:
            self.spacing = LINE_CELL_LENGTH * shape[1] * spacing[1], spacing[1]
        self.row, self.mirror = row, mirror
        self._kind: Any = np.float32 if single else np.float64
        # odd kernels jump where the period begins, and a jump of few waves oscillates
        self._half = tuple(2 if n == 1 else fast_size(n + 2 * WIDEST_STEP) for n in shape)

    def steps(self, depth: float) -> Steps:
        """Return the nodes along y and x to the next one that a depth needs."""
        along_y, along_x = (
            1 if n == 1 else _step(depth / d) for n, d in zip(self.shape, self.spacing, strict=True)
        )
        return along_y, along_x

    def steps_of(self, influence: Influence) -> Steps:
        """Return the steps for which an influence is."""
        sizes = influence[0].shape[1:]
        along_y, along_x = (n // (size - 1) for n, size in zip(self._half, sizes, strict=True))
        return along_y, along_x

    def rows(self, steps: Steps) -> slice:
        """Return the rows that are left."""
        return slice(self.row if self.mirror else self.row % steps[0], None, steps[0])

    def weights(self, steps: Steps) -> Array:
        """Return the rows that each of those that are left stands for."""
        rows = self.rows(steps)
        each = (2.0 if self.mirror else 1.0) * rows.step
        found = np.full(len(range(*rows.indices(self.shape[0]))), each)
        found[0] = rows.step
        return found

    def on_all_rows(self, values: Array, steps: Steps) -> Array:
        """Return components along a column on all rows, (6, ny), by cubic splines.

        Parameters
        ----------
        values : (6, rows) array
            On the rows that are left.
        steps : Steps
            Of the depth, by `steps`.
        """
        rows, every = self.rows(steps), np.arange(self.shape[0])
        places = every[rows]
        if self.mirror:
            places = np.concatenate([2 * self.row - places[:0:-1], places])
            values = np.concatenate([_MIRRORED[:, None] * values[:, :0:-1], values], axis=1)
        if rows.step == 1:
            return values
        return np.asarray(CubicSpline(places, values, axis=1)(every))

    def spectra_of(self, pressure: Array, *tractions: Array) -> Spectra:
        """Return the transforms of loads, for `stresses`; None for a load that is zero.

        Parameters
        ----------
        pressure : (ny, nx) array
            Positive in compression, uniform over the cell of each node.
        tractions : (ny, nx) arrays
            Force on the body over area along x, and along y.
        """
        return [self._spectrum(load) if load.any() else None for load in (pressure, *tractions)]

    def _spectrum(self, load: Array) -> NDArray[Any]:
        """Return the transform times the factor of each parity, for k_y >= 0 and for -k_y."""
        ny, nx = self._half
        found: Any = rfft2(load.astype(self._kind), (2 * ny, 2 * nx))
        both: Any = np.stack([found[: ny + 1], found[-np.arange(ny + 1)]])
        sign = np.array([1.0, -1.0], self._kind)[:, None, None]
        return np.stack([both, -1j * both, -1j * sign * both, -sign * both])

    def thinned(self, spectra: Spectra, steps: Steps) -> Spectra:
        """Return the wave numbers of loads that some depths need.

        Parameters
        ----------
        spectra : Spectra
            By `spectra_of`.
        steps : Steps
            Of the depths, by `steps`.
        """
        first = self.rows(steps).start
        if steps == (1, 1) and not self.mirror:
            return spectra
        parts = []
        for half, step in zip(self._half, steps, strict=True):
            angle = np.arange(half // step + 1) / (2.0 * half)
            # the cells of the kernels are wider
            parts.append(np.sinc(angle) / np.sinc(step * angle))
        rows, columns = (part.size for part in parts)
        shift = np.exp(1j * np.pi * first / self._half[0] * np.arange(rows))
        both = np.stack([shift, shift.conj()])[: 1 if self.mirror else 2, :, None]
        weight = both * parts[0][:, None] * parts[1] / steps[0]
        weight = weight.astype(np.result_type(self._kind, np.complex64))
        return [
            None if one is None else one[:, : len(both), :rows, :columns] * weight
            for one in spectra
        ]

    def influence(self, depth: float, steps: Steps = (1, 1)) -> Influence:
        """Return the transforms of the derivatives of the potentials at a depth, real.

        Those of kernels that are even in x and y, odd in x, in y, and in both; a sine transform
        takes the place of -i times that of Fourier.

        Parameters
        ----------
        depth : float
            Below the surface, positive, in the unit of the mesh widths.
        steps : Steps
            Of the depth, by `steps`.
        """
        y, x = (
            (np.arange(half // step + 2) - 0.5) * step * d
            for half, step, d in zip(self._half, steps, self.spacing, strict=True)
        )
        corners = _corners(np.asarray(x)[None, :], np.asarray(y)[:, None], depth)
        even, odd_x, odd_y, odd_xy = (
            np.diff(np.diff(one, axis=-2), axis=-1).astype(self._kind) / self._kind(2.0 * math.pi)
            for one in corners
        )
        return (
            _cosine(_cosine(even, -1), -2),
            _cosine(_sine(odd_x, -1), -2),
            _sine(_cosine(odd_y, -1), -2),
            _sine(_sine(odd_xy, -1), -2),
        )

    def stresses(self, spectra: Spectra, influence: Influence, poisson_ratio: float) -> Array:
        """Return the components of the stress, (6, rows, nx), in the unit of the loads.

        Parameters
        ----------
        spectra : Spectra
            Of the loads, by `spectra_of` and `thinned`.
        influence : Influence
            Of the depth, by `influence`.
        poisson_ratio : float
            Of the body.
        """
        parts = (_of_pressure, _of_traction_x, _of_traction_y)
        acting = [
            (spectrum, part(influence, poisson_ratio), parities)
            for spectrum, part, parities in zip(spectra, parts, _PARITIES, strict=False)
            if spectrum is not None
        ]
        number = len(range(*self.rows(self.steps_of(influence)).indices(self.shape[0])))
        found = np.empty((len(COMPONENTS), number, self.shape[1]), self._kind)
        for k in range(len(COMPONENTS)):
            total = reduce(iadd, (one[parity[k]] * kernels[k] for one, kernels, parity in acting))
            if self.mirror:
                found[k] = self._one_side(total[0], number, odd=_MIRRORED[k] < 0.0)
            else:
                found[k] = self._rows(total, number)
        return found

    def _rows(self, both: NDArray[Any], number: int) -> Array:
        """Return the first rows of a component, of its transform for k_y >= 0 and for -k_y."""
        lines = np.concatenate([both[0], both[1, -2:0:-1]])
        return self._along_x(ifft(lines, axis=0, overwrite_x=True)[:number])

    def _one_side(self, total: NDArray[Any], number: int, *, odd: bool) -> Array:
        """Return the first rows of a component that is even or odd about the first of them."""
        lines = self._along_x(1j * total if odd else total)
        rows = _sine(lines, -2) if odd else _cosine(lines, -2)
        return rows[:number] / (2.0 * (len(rows) - 1.0))

    def _along_x(self, rows: NDArray[Any]) -> Array:
        return np.asarray(irfft(rows, 2 * self._half[1], axis=1)[:, : self.shape[1]])


def fast_size(number: float) -> int:
    """Return the least size of a fast transform that holds all steps and ``number`` nodes."""
    return int(WIDEST_STEP * next_fast_len(math.ceil(number / WIDEST_STEP), real=True))


def _step(depth: float) -> int:
    """Return the nodes to the next that a depth in mesh widths needs.

    A wave of two such distances has decayed by e^(-4 pi), 3.5e-6, at four of them.
    """
    step = 1
    while step < WIDEST_STEP and depth >= 8 * step:
        step *= 2
    return step


def _corners(x: Array, y: Array, z: float) -> tuple[Array, Array, Array, Array]:
    """Return antiderivatives over x and y of derivatives of the potentials, by their symmetry."""
    r = np.sqrt(x * x + y * y + z * z)
    below, beside_x, beside_y = r + z, x * x + z * z, y * y + z * z
    xy, over_r = x * y, 1.0 / r
    fall = xy * (x * x + y * y) / below  # xy (r - z), without cancellation
    even = np.stack(
        [
            np.arctan(fall / (x * x * r + y * y * z)),  # psi_xx
            np.arctan(fall / (y * y * r + x * x * z)),  # psi_yy
            -z * xy * over_r / beside_x,  # z psi_xxz
            -z * xy * over_r / beside_y,  # z psi_yyz
        ]
    )
    odd_xy = np.stack([np.log(below), z * over_r])  # psi_xy, z psi_xyz
    steep = z * over_r / below
    odd_x = np.stack(_odd(y, z, over_r, beside_x, below, steep))
    odd_y = np.stack(_odd(x, z, over_r, beside_y, below, steep))
    return even, odd_x, odd_y, odd_xy


def _odd(
    other: Array, z: float, over_r: Array, beside: Array, below: Array, steep: Array
) -> Sequence[Array]:
    """Return those whose derivatives are odd along one axis, say x; ``other`` is then y."""
    pulled = z * z * other * over_r / beside
    return (
        -pulled,  # z psi_xzz
        np.arcsinh(other / np.sqrt(beside)),  # psi_xz
        other / below,  # -Omega_xyy
        other * steep,  # z psi_xyy
        pulled - other * steep,  # z psi_xxx
    )


def _cosine(values: Array, axis: int) -> Array:
    return np.asarray(dct(values, type=1, axis=axis, overwrite_x=True))


def _sine(values: Array, axis: int) -> Array:
    found = np.zeros_like(values)
    inside = np.s_[..., 1:-1] if axis == -1 else np.s_[..., 1:-1, :]
    found[inside] = dst(values[inside], type=1, axis=axis)
    return found


def _of_pressure(influence: Influence, nu: float) -> Sequence[Array]:
    (a_x, a_y, b_x, b_y), (c_x, *_), (c_y, *_), (l_z, r_z) = influence
    return (
        -(a_x + 2.0 * nu * a_y + b_x),
        -(a_y + 2.0 * nu * a_x + b_y),
        b_x + b_y - a_x - a_y,
        (2.0 * nu - 1.0) * l_z - r_z,
        -c_y,
        -c_x,
    )


def _of_traction_x(influence: Influence, nu: float) -> Sequence[Array]:
    (a_x, a_y, b_x, _), (c_x, l_y, m_x, f_x, g_x), (_, l_x, m_y, f_y, _), (_, r_z) = influence
    return (
        2.0 * (l_y + nu * m_x) - g_x,
        2.0 * nu * (l_y - m_x) - f_x,
        -c_x,
        l_x - 2.0 * nu * m_y - f_y,
        -r_z,
        -(a_x + a_y + b_x),
    )


def _of_traction_y(influence: Influence, nu: float) -> Sequence[Array]:
    (a_x, a_y, _, b_y), (_, l_y, m_x, f_x, _), (c_y, l_x, m_y, f_y, g_y), (_, r_z) = influence
    return (
        2.0 * nu * (l_x - m_y) - f_y,
        2.0 * (l_x + nu * m_y) - g_y,
        -c_y,
        l_y - 2.0 * nu * m_x - f_x,
        -(a_x + a_y + b_y),
        -r_z,
    )
