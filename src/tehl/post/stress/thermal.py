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
from tehl.post.stress.loads import SurfaceLoads, rubbing
from tehl.post.stress.window import Window
from tehl.result.solution import Solution

PERIOD_DECAY, SPREAD = 14.0, 7.5
"""Natural logarithm of what is left of the wake of the period before (1e-6), and the distance
across the wake, in its widths sqrt(kappa x/u), at which its temperature has fallen as far."""
_ODD_ALONG_X = np.array([1.0, 1.0, 1.0, -1.0, 1.0, -1.0])[:, None, None]


class Heated(NamedTuple):
    """A body under heat: what the flux is on nodes, and how the body takes it."""

    flux: Array
    """Into the body, (ny, nx) [W/m^2]; zero beyond."""
    spacing: tuple[float, float]
    """Mesh widths along y and x [m]."""
    speed: float
    """Of the body along x [m/s], of either sign, not zero."""
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
        """Return E alpha dT/(1 - nu) of the largest rise of the surface [Pa]."""
        expansion = self.solid.expansion or 0.0
        rise = float(ThermalStress(self).temperature(0.0).max())
        return self.solid.young_modulus * expansion * rise / (1.0 - self.solid.poisson_ratio)


def heated_body(
    result: Solution, body: int, window: Window, sides: tuple[int, int]
) -> Heated | None:
    """Return a body with its heat, that of rubbing included; None if it moves too slowly.

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
    if heat is None or peclet is None or not abs(peclet) >= LEAST_THERMAL_PECLET:
        return None
    if not problem.motion.is_plain:  # its wake does not lie along x
        return None
    solids = [problem.surface_1.material, problem.surface_2.material]
    parts = rubbing_parts([one.conductivity or 0.0 for one in solids], problem.solid_peclet)
    sliding = problem.motion.sliding_field(result.x, result.y[:, None])
    rubbed = rubbing(result) * np.hypot(*sliding)
    flux = (heat.flux_1, heat.flux_2)[body - 1] + parts[body - 1] * rubbed
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
