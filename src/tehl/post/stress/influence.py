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
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct, dst, ifft, irfft, next_fast_len, rfft2

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

Spectra = list[NDArray[Any] | None]
Influence = tuple[Array, Array, Array, Array]


class HalfSpace:
    """A half-space under loads on a grid, whose stresses are found depth by depth.

    A grid of one row with a very wide cell is a line contact.
    """

    def __init__(
        self, shape: tuple[int, int], spacing: tuple[float, float], *, single: bool = False
    ) -> None:
        """Take a grid of (ny, nx) nodes and its mesh widths (dy, dx), in any unit of length.

        In ``single`` precision stresses take half the time, with errors of 1e-6 of the load.
        """
        self.shape = shape
        self._kind: Any = np.float32 if single else np.float64
        self._half = tuple(next_fast_len(max(n, 2), real=True) for n in shape)
        y, x = ((np.arange(n + 2) - 0.5) * d for n, d in zip(self._half, spacing, strict=True))
        self._y, self._x = y[:, None], x[None, :]

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

    def influence(self, depth: float) -> Influence:
        """Return the transforms of the derivatives of the potentials at a depth, real.

        Those of kernels that are even in x and y, odd in x, in y, and in both; a sine transform
        takes the place of -i times that of Fourier.

        Parameters
        ----------
        depth : float
            Below the surface, positive, in the unit of the mesh widths.
        """
        corners = _corners(self._x, self._y, depth)
        even, odd_x, odd_y, odd_xy = (
            np.asarray(np.diff(np.diff(one, axis=-1), axis=-2) / (2.0 * math.pi), self._kind)
            for one in corners
        )
        return (
            _cosine(_cosine(even, -1), -2),
            _cosine(_sine(odd_x, -1), -2),
            _sine(_cosine(odd_y, -1), -2),
            _sine(_sine(odd_xy, -1), -2),
        )

    def stresses(self, spectra: Spectra, influence: Influence, poisson_ratio: float) -> Array:
        """Return the components of the stress, (6, ny, nx), in the unit of the loads.

        Parameters
        ----------
        spectra : Spectra
            Of the loads, by `spectra_of`.
        influence : Influence
            Of the depth, by `influence`.
        poisson_ratio : float
            Of the body.
        """
        parts = (_of_pressure, _of_traction_x, _of_traction_y)
        kind = np.result_type(self._kind, np.complex64)
        total = np.zeros((6, 2, self._half[0] + 1, self._half[1] + 1), kind)
        for spectrum, part, parities in zip(spectra, parts, _PARITIES, strict=False):
            if spectrum is not None:
                kernels = part(influence, poisson_ratio)
                for k, (kernel, parity) in enumerate(zip(kernels, parities, strict=True)):
                    total[k] += spectrum[parity] * kernel
        (ny, nx), lines = self.shape, np.concatenate([total[:, 0], total[:, 1, -2:0:-1]], axis=1)
        rows = ifft(lines, axis=1, overwrite_x=True)[:, :ny]
        return np.asarray(irfft(rows, 2 * self._half[1], axis=2)[..., :nx])


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
