r"""Thermal stress of a half-space that moves under a heat flux, depth by depth.

The steady temperature of the moving body obeys :math:`u T_x = \kappa \nabla^2 T`. A displacement
that is the gradient of Goodier's potential, :math:`\nabla^2\phi = m T` with :math:`m = \alpha_T
(1+\nu)/(1-\nu)`, is in equilibrium with it, and for a moving body this potential is the heat that
has passed, :math:`\phi_x = m \kappa T/u` (Boley and Weiner 1960, docs/theory/stress.md): it ends
where the temperature does. What it leaves on the surface is taken off by the half-space under
opposite loads, with those of the film.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.fft import fftfreq, irfft2, next_fast_len, rfft2, rfftfreq

from tehl.base.typing import Array
from tehl.contact.heat import rubbing_parts
from tehl.contact.materials import Solid
from tehl.contact.stress import LEAST_THERMAL_PECLET
from tehl.post.stress.loads import SurfaceLoads, parts_of_cells, rubbing
from tehl.post.stress.window import Window
from tehl.result.solution import Solution

PERIOD_DECAY, SPREAD = 14.0, 7.5
"""Natural logarithm of what is left of the wake of the period before (1e-6), and the distance
across the wake, in its widths sqrt(kappa x/u), at which its temperature has fallen as far."""
RESTING_PECLET = 1e-3
"""Solid Peclet number below which a body is at rest: its temperature differs by about this part."""
_ODD_ALONG_X = np.array([1.0, 1.0, 1.0, -1.0, 1.0, -1.0])[:, None, None]


class Heated(NamedTuple):
    """A body under heat: what the flux is on nodes, and how the body takes it."""

    flux: Array
    """Into the body, (ny, nx) [W/m^2]; zero beyond."""
    spacing: tuple[float, float]
    """Mesh widths along y and x [m]."""
    speed: float
    """Of the body along x [m/s], of either sign; zero at rest."""
    solid: Solid
    """With all thermal properties."""
    part: tuple[slice, slice] = (slice(None), slice(None))
    """Nodes whose stresses are wanted."""

    def coarser(self, weighted: Callable[[Array], Array]) -> "Heated":
        """Return the same on every second node, by ``weighted``."""
        rows, columns = (slice(one.start // 2, (one.stop + 1) // 2) for one in self.part)
        dy, dx = self.spacing
        flux, spacing = weighted(self.flux), (2.0 * dy, 2.0 * dx)
        return self._replace(flux=flux, spacing=spacing, part=(rows, columns))

    @property
    def surface_stress(self) -> float:
        """Return the largest compression along the surface [Pa].

        E alpha dT/(1 - nu) of the largest rise; at rest that of `RestingStress`, about half of it.
        """
        if not self.speed:
            return float(-RestingStress(self).stresses(0.0)[:2].min())
        expansion = self.solid.expansion or 0.0
        rise = float(ThermalStress(self).temperature(0.0).max())
        return self.solid.young_modulus * expansion * rise / (1.0 - self.solid.poisson_ratio)


def heated_body(
    result: Solution, body: int, window: Window, sides: tuple[int, int]
) -> Heated | None:
    """Return a body with its heat, that of rubbing included; None if it moves, but too slowly.

    Parameters
    ----------
    result : Solution
        Heated.
    body : {1, 2}
        Number of the body.
    window : Window
        Nodes whose stresses are wanted.
    sides : (int, int)
        Nodes before and behind it with a wake, even.
    """
    problem, heat = result.problem, result.heat
    speed, peclet = problem.motion.speed_of(body), problem.solid_peclet[body - 1]
    if heat is None or peclet is None:
        return None
    if abs(peclet) < RESTING_PECLET:
        speed = 0.0
    elif abs(peclet) < LEAST_THERMAL_PECLET:
        return None
    if not problem.motion.is_plain:  # its wake does not lie along x
        return None
    solids = [problem.surface_1.material, problem.surface_2.material]
    parts = rubbing_parts([one.conductivity or 0.0 for one in solids], problem.solid_peclet)
    sliding = problem.motion.sliding_field(result.x, result.y[:, None])
    rubbed = rubbing(result) * np.hypot(*sliding)
    flux = (heat.flux_1, heat.flux_2)[body - 1] + parts[body - 1] * rubbed
    flux = flux * parts_of_cells(result)
    columns, last = window.columns, window.columns.stop + sides[1]
    before = max(sides[0] - columns.start, 0)
    before += before % 2
    flux = np.pad(flux, ((0, 0), (before, max(last - flux.shape[1], 0))))
    # the first node of the window stays one of every second node
    first = (window.rows.start % 2, columns.start % 2)
    rows = slice(window.rows.start - first[0], window.rows.stop - first[0])
    shift = before - first[1]
    wide = slice(columns.start - sides[0] + shift, last + shift)
    flux = flux[first[0] :, first[1] :]
    return Heated(flux, window.spacing, speed, solids[body - 1], (rows, wide))


class ThermalStress:
    """Temperature and potential of one body, as spectra; a depth takes six inverse transforms.

    The flux has a factor e^(-rate x), so that the wake of the period before arrives smaller by
    e^-PERIOD_DECAY.

    Parameters
    ----------
    heated : Heated
        The body.
    """

    def __init__(self, heated: Heated) -> None:
        flux, (dy, dx), speed, solid, self.part = heated
        assert solid.diffusivity is not None
        assert solid.conductivity is not None
        assert solid.expansion is not None
        self.shape, self.backwards = flux.shape, speed < 0.0
        length, reach = flux.shape[1] * dx, solid.diffusivity / abs(speed)
        ahead = 2.0 * PERIOD_DECAY * reach
        beside = 0.0 if flux.shape[0] == 1 else SPREAD * math.sqrt(reach * length)
        rows, columns = (
            size if size == 1 else next_fast_len(size + math.ceil(more / step), real=True)
            for size, more, step in zip(flux.shape, (beside, ahead), (dy, dx), strict=True)
        )
        rate = PERIOD_DECAY / (columns * dx)
        self.period, self.fall = (rows, columns), np.exp(-rate * dx * np.arange(flux.shape[1]))
        along = flux[:, ::-1] if self.backwards else flux
        self.a = 2.0 * np.pi * rfftfreq(columns, dx)[None, :] - 1j * rate
        self.b = 2.0 * np.pi * fftfreq(rows, dy)[:, None]
        wave = 1j * self.a / reach  # gamma^2 - zeta^2
        self.zeta = self.a**2 + self.b**2
        self.gamma = np.sqrt(self.zeta + wave)
        self.heat = rfft2(along * self.fall, self.period) / (solid.conductivity * self.gamma)
        nu, young, expansion = solid.poisson_ratio, solid.young_modulus, solid.expansion
        self.potential = young * expansion / (1.0 - nu) * self.heat / wave

    def temperature(self, depth: float) -> Array:
        """Return the temperature rise at a depth [m], on the wanted nodes [K]."""
        return self._on_nodes((self.heat * np.exp(-self.gamma * depth))[None])[0]

    def stresses(self, depth: float) -> Array:
        """Return the components of the potential's stress at a depth [m], (6, ...) [Pa].

        Those of the body are its sum with the half-space under `loads`.
        """
        a, b, gamma = self.a, self.b, self.gamma
        decayed = self.potential * np.exp(-gamma * depth)
        found = self._on_nodes(
            np.stack(
                [
                    (b**2 - gamma**2) * decayed,
                    (a**2 - gamma**2) * decayed,
                    self.zeta * decayed,
                    -a * b * decayed,
                    -1j * b * gamma * decayed,
                    -1j * a * gamma * decayed,
                ]
            )
        )
        return found * _ODD_ALONG_X if self.backwards else found

    def loads(self) -> SurfaceLoads:
        """Return the loads that free the surface of what the potential leaves on it [Pa]."""
        _, _, normal, _, along_y, along_x = self.stresses(0.0)
        return SurfaceLoads(normal, along_x, along_y)

    def _on_nodes(self, spectra: Array) -> Array:
        ny, nx = self.shape
        found = np.asarray(irfft2(spectra, self.period)[:, :ny, :nx]) / self.fall
        return (found[:, :, ::-1] if self.backwards else found)[:, *self.part]


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
        flux, spacing, _, solid, self.part = heated
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

    def stresses(self, depth: float) -> Array:
        """Return the components of the stress at a depth [m], (6, ...) [Pa]."""
        x, y = self.corners
        r = np.sqrt(x**2 + y**2 + depth**2)
        log_term = depth * np.log(r + depth) if depth else 0.0
        parts = (_bent(y, x, r, depth), _bent(x, y, r, depth), r - log_term)
        kernels = [np.diff(np.diff(part, axis=0), axis=1) for part in parts]
        rows, columns = self.offsets
        place = np.ix_(np.abs(rows), np.abs(columns))
        odd = np.sign(rows)[:, None] * np.sign(columns)
        wrapped = np.stack([kernels[0][place], kernels[1][place], odd * kernels[2][place]])
        ny, nx = self.shape
        found = irfft2(rfft2(wrapped) * self.heat, self.period)[:, :ny, :nx][:, *self.part]
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


def thermal_stress_of(heated: Heated) -> ThermalStress | RestingStress:
    """Return the thermal stress of a body that moves, or of one at rest."""
    return ThermalStress(heated) if heated.speed else RestingStress(heated)
