r"""Thermal stress of a half-space at rest, or that moves slowly, under a heat flux.

At rest it is plane (Sternberg and McDowell 1957). For a body that moves, Goodier's potential and
the half-space that frees its surface (`tehl.post.stress.thermal`) make one stress for each wave
:math:`(\alpha, \beta)` of the flux, which at speed zero is that at rest (docs/theory/stress.md).
Nothing repeats: the inverse transform is a quadrature whose nodes lie ever closer towards
:math:`\alpha = \beta = 0`, where the far heat is.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.fft import irfft2, next_fast_len, rfft2
from scipy.interpolate import make_interp_spline

from tehl.base.typing import Array
from tehl.post.stress.loads import SurfaceLoads
from tehl.post.stress.thermal import Heated

_ODD_ALONG_Y = np.array([1.0, 1.0, 1.0, -1.0, -1.0, 1.0])[:, None, None]


class RestingStress:
    r"""Stress of a body at rest under steady heat: plane, and no load is left on its surface.

    With :math:`\Omega = z \ln(R + z) - R` and F = :math:`E\alpha_T/(2\pi k)\,q * \Omega`, whose
    derivatives :math:`F_{xx} + F_{yy}` are :math:`-E\alpha_T T` (Sternberg and McDowell 1957),

    .. math:: \sigma_x = F_{yy},\quad \sigma_y = F_{xx},\quad \tau_{xy} = -F_{xy},

    and all others vanish. The flux is uniform on the cell of each node, nothing wraps around.

    Parameters
    ----------
    heated : Heated
        The body.
    """

    def __init__(self, heated: Heated) -> None:
        flux, spacing, _, solid, self.part, *_ = heated
        assert solid.conductivity is not None
        assert solid.expansion is not None
        self.shape, self.stiffness = flux.shape, solid.young_modulus * solid.expansion
        half = tuple(next_fast_len(max(size, 2), real=True) for size in flux.shape)
        y, x = ((np.arange(n + 2) - 0.5) * step for n, step in zip(half, spacing, strict=True))
        self.corners = x[None, :], y[:, None]
        self.period = (2 * half[0], 2 * half[1])
        self.offsets = [np.fft.fftfreq(n, 1.0 / n).round().astype(int) for n in self.period]
        self.heat = rfft2(flux, self.period) / (2.0 * np.pi * solid.conductivity)

    def temperature(self, depth: float) -> Array:
        """Return the temperature rise at a depth [m], on the wanted nodes [K]."""
        return np.asarray(-self.stresses(depth)[:2].sum(axis=0) / self.stiffness)

    def stresses(self, depth: float, rows: slice = slice(None)) -> Array:
        """Return the components of the stress on the wanted nodes, (6, ...) [Pa].

        Parameters
        ----------
        depth : float
            [m].
        rows : slice
            Of the wanted nodes, those that are needed.
        """
        x, y = self.corners
        r = np.sqrt(x**2 + y**2 + depth**2)
        log_term = depth * np.log(r + depth) if depth else 0.0
        parts = (_bent(y, x, r, depth), _bent(x, y, r, depth), r - log_term)
        kernels = [np.diff(np.diff(part, axis=0), axis=1) for part in parts]
        down, across = self.offsets
        place = np.ix_(np.abs(down), np.abs(across))
        odd = np.sign(down)[:, None] * np.sign(across)
        wrapped = np.stack([kernels[0][place], kernels[1][place], odd * kernels[2][place]])
        ny, nx = self.shape
        found = irfft2(rfft2(wrapped) * self.heat, self.period)[:, :ny, :nx][:, *self.part][:, rows]
        every = np.zeros((6, *found.shape[1:]))
        every[[0, 1, 3]] = self.stiffness * found
        return every

    def loads(self) -> SurfaceLoads:
        """Return loads of zero."""
        nothing = np.zeros(self.shape)[self.part]
        return SurfaceLoads(nothing, nothing, nothing)


def _bent(x: Array, y: Array, r: Array, depth: float) -> Array:
    """Return the antiderivative of Omega_xx over x and y at the corners of cells."""
    turned = np.arctan(y * depth / (x * r)) - np.arctan(y / x)
    return np.asarray(-(x * np.log(y + r) + depth * turned))


class SlowStress:
    """Stress of a body that moves slowly along x: that at rest, and what the motion adds.

    The addition is smooth, so long waves and few nodes are enough. A line of heat has no steady
    temperature at rest: all of its stress is found from its waves.

    Parameters
    ----------
    heated : Heated
        The body.
    """

    def __init__(self, heated: Heated) -> None:
        flux, (dy, dx), speed, solid, part, *_ = heated
        assert solid.diffusivity is not None
        assert solid.conductivity is not None
        assert solid.expansion is not None
        self.poisson_ratio, self.drift = solid.poisson_ratio, speed / solid.diffusivity
        self.shape = flux[part].shape
        is_line = flux.shape[0] == 1
        self.rest = None if is_line else RestingStress(heated)
        warm = np.abs(flux) > 0.01 * np.abs(flux).max()  # nodes that count to the width of the heat
        self.x = _axis(dx, flux.shape[1], part[1], np.inf if is_line else warm.any(axis=0).sum())
        self.y = None if is_line else _axis(dy, flux.shape[0], part[0], warm.any(axis=1).sum())
        waves = flux @ self.x.forward.T
        if self.y is not None:
            along = self.y.forward @ waves
            waves = np.concatenate([along, self.y.forward.conj() @ waves])
        # real fields: waves along x of both signs
        unit = solid.young_modulus * solid.expansion / (1.0 - solid.poisson_ratio)
        self.waves = 2.0 * unit / solid.conductivity * waves

    def stresses(self, depth: float, rows: slice = slice(None)) -> Array:
        """Return the components of the stress on the wanted nodes, (6, ...) [Pa]."""
        along = self.x.waves[None, :]
        if self.y is None:
            nothing = np.zeros((1, 1))
            waves = free_stresses((along, nothing), self.drift, depth, self.poisson_ratio)
            return np.asarray((waves * self.waves @ self.x.back.T).real) @ self.x.finer.T
        both = along, self.y.waves[:, None]
        moving, still = (
            free_stresses(both, drift, depth, self.poisson_ratio) for drift in (self.drift, 0.0)
        )
        added = moving - still
        added = np.concatenate([added, _ODD_ALONG_Y * added], axis=1) * self.waves
        back = np.concatenate([self.y.back, self.y.back.conj()], axis=1)
        few = (back @ (added @ self.x.back.T)).real
        assert self.rest is not None
        return self.rest.stresses(depth, rows) + self.y.finer[rows] @ few @ self.x.finer.T

    def loads(self) -> SurfaceLoads:
        """Return loads of zero."""
        nothing = np.zeros(self.shape)
        return SurfaceLoads(nothing, nothing, nothing)


class _Axis(NamedTuple):
    """Wave numbers along one axis, and transforms there and back."""

    waves: Array
    """(n,), positive [1/m]."""
    forward: Array
    """(n, nodes): From the flux on cells to its waves, weights of the quadrature included."""
    back: Array
    """(few, n): To nodes that are enough."""
    finer: Array
    """(wanted, few): From those to the wanted nodes."""


def _axis(step: float, number: int, part: slice, warm: float) -> _Axis:
    """Return the waves of an axis of ``number`` nodes ``step`` [m] apart.

    Stresses are wanted at those of ``part``; ``warm`` of them are heated, infinite if all waves of
    the grid count.
    """
    short = np.pi / step
    # the motion adds waves of a quarter of the half-width of the heat, and longer ones
    most = short if np.isinf(warm) else min(short, 25.0 / (0.5 * warm * step))
    # errors of 2e-5 of the largest stress, and of 1e-5: a line warms as the root of the wave number
    halvings = 30 if np.isinf(warm) else 10
    waves, weights = _quadrature(most, 8.0 / (number * step), halvings)
    places = step * np.arange(number)
    wanted = places[part]
    # nodes per shortest wave, for cubic splines between them
    few = 4 + int(2.5 * most * np.ptp(wanted) / (2.0 * np.pi))
    nodes = np.linspace(wanted[0], wanted[-1], few) if few < wanted.size else wanted
    spline = make_interp_spline(nodes, np.eye(nodes.size)) if few < wanted.size else None
    cells = weights * step / (2.0 * np.pi) * np.sinc(0.5 * waves * step / np.pi)
    return _Axis(
        waves=waves,
        forward=cells[:, None] * np.exp(-1j * waves[:, None] * places),
        back=np.exp(1j * waves * nodes[:, None]),
        finer=np.eye(nodes.size) if spline is None else np.asarray(spline(wanted)),
    )


def _quadrature(most: float, panel: float, halvings: int) -> tuple[Array, Array]:
    """Return nodes and weights of a quadrature from zero to ``most``, denser towards zero.

    Panels are at most as wide as ``panel``, and the first one is halved ``halvings`` times.
    """
    ends = np.linspace(0.0, most, int(np.ceil(most / panel)) + 1)
    ends = np.concatenate([[0.0], ends[1] * 0.5 ** np.arange(halvings, 0, -1), ends[1:]])
    at, weight = leggauss(6)
    half, middle = 0.5 * np.diff(ends)[:, None], 0.5 * (ends[1:] + ends[:-1])[:, None]
    return (middle + half * at).ravel(), (half * weight).ravel()


def free_stresses(
    waves: tuple[Array, Array], drift: float, depth: float, poisson_ratio: float
) -> Array:
    r"""Return the stress under a wave of flux, over :math:`E\alpha_T\hat q/((1-\nu)k)`, (6, ...).

    Parameters
    ----------
    waves : two arrays
        Wave numbers along x and y, not both zero [1/m].
    drift : float
        Speed along x over the diffusivity [1/m].
    depth : float
        [m].
    poisson_ratio : float
        Of the body.
    """
    a, b = waves
    zeta = np.sqrt(a * a + b * b)
    gamma = np.sqrt(zeta * zeta + 1j * drift * a)
    less = -1j * drift * a / (gamma + zeta)  # zeta - gamma
    # (e^(less z) - 1)/less
    lag = np.divide(np.expm1(less * depth), less, out=depth + 0.0 * less, where=less != 0.0)
    decayed = np.exp(-zeta * depth) / (gamma * (gamma + zeta))
    warm, late = np.exp(-gamma * depth) / gamma, decayed * (lag - depth)
    side, cross = 2.0 * decayed / zeta, 2.0 * (1.0 - poisson_ratio) * decayed / zeta
    pulled = -1j * decayed * (zeta * depth - gamma * lag)
    return np.array(
        [
            a * a * late + (a * a + poisson_ratio * b * b) * side - warm,
            b * b * late + (b * b + poisson_ratio * a * a) * side - warm,
            -zeta * zeta * late,
            a * b * (late + cross),
            b * pulled,
            a * pulled,
        ]
    )
