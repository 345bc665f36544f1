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
from scipy.fft import fftfreq, ifft, irfft, rfft2, rfftfreq

from tehl.base.typing import Array
from tehl.contact.materials import Solid
from tehl.contact.roller import Ends
from tehl.post.stress.influence import fast_size
from tehl.post.stress.loads import SurfaceLoads
from tehl.post.stress.repeating import over_period

PERIOD_DECAY, SPREAD = 14.0, 7.5
"""Natural logarithm of what is left of the wake of the period before (1e-6), and the distance
across the wake, in its widths sqrt(kappa x/u), at which its temperature has fallen as far."""
WAVE_DECAY = 18.0
"""Natural logarithm of what is left of waves along x that a depth leaves out."""
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
    slow: bool = False
    """Whether its heat runs ahead of the contact."""
    ends: Ends = "open"
    """What lies beyond the first and last row; bodies that are slow or at rest have nothing."""

    def coarser(self, weighted: Callable[[Array], Array]) -> "Heated":
        """Return the same on every second node, by ``weighted``."""
        rows, columns = (slice(one.start // 2, (one.stop + 1) // 2) for one in self.part)
        dy, dx = self.spacing
        flux, spacing = weighted(self.flux), (2.0 * dy, 2.0 * dx)
        return self._replace(flux=flux, spacing=spacing, part=(rows, columns))


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
        flux, (dy, dx), speed, solid, self.part, _, ends = heated
        assert solid.diffusivity is not None
        assert solid.conductivity is not None
        assert solid.expansion is not None
        self.shape, self.backwards = flux.shape, speed < 0.0
        flux = over_period(flux, ends)
        length, reach = flux.shape[1] * dx, solid.diffusivity / abs(speed)
        ahead = 2.0 * PERIOD_DECAY * reach
        beside = 0.0 if flux.shape[0] == 1 else SPREAD * math.sqrt(reach * length)
        rows, columns = (
            size if size == 1 else fast_size(size + more / step)
            for size, more, step in zip(flux.shape, (beside, ahead), (dy, dx), strict=True)
        )
        rows = rows if ends == "open" else flux.shape[0]
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
        rows, waves = self._rows(slice(None)), self._waves(depth, 1)
        decayed = self.heat[waves] * np.exp(-self.gamma[waves] * depth)
        return self._on_nodes(decayed[None], rows)[0]

    def stresses(self, depth: float, rows: slice = slice(None)) -> Array:
        """Return the components of the potential's stress, (6, ...) [Pa].

        Those of the body are its sum with the half-space under `loads`.

        Parameters
        ----------
        depth : float
            [m].
        rows : slice
            Of the wanted nodes, those that are needed: deep down every second or fourth.
        """
        some = self._rows(rows)
        waves = self._waves(depth, some.step)
        a, b, gamma = self.a[:, waves[1]], self.b[waves[0]], self.gamma[waves]
        decayed = self.potential[waves] * np.exp(-gamma * depth)
        found = self._on_nodes(
            np.stack(
                [
                    (b**2 - gamma**2) * decayed,
                    (a**2 - gamma**2) * decayed,
                    self.zeta[waves] * decayed,
                    -a * b * decayed,
                    -1j * b * gamma * decayed,
                    -1j * a * gamma * decayed,
                ]
            ),
            some,
        )
        return found * _ODD_ALONG_X if self.backwards else found

    def loads(self) -> SurfaceLoads:
        """Return the loads that free the surface of what the potential leaves on it [Pa]."""
        _, _, normal, _, along_y, along_x = self.stresses(0.0)
        return SurfaceLoads(normal, along_x, along_y)

    def _rows(self, rows: slice) -> range:
        """Return the numbers of the wanted rows among all."""
        return range(self.shape[0])[self.part[0]][rows]

    def _waves(self, depth: float, step: int) -> tuple[Array, slice]:
        """Return the waves along y of every ``step``-th row, and along x those that are left."""
        number, da = self.period[0] // step, float(np.real(self.a[0, -1])) / (self.a.shape[1] - 1)
        most = self.a.shape[1] if depth == 0.0 else math.ceil(WAVE_DECAY / (depth * da)) + 1
        return fftfreq(number, 1.0 / number).round().astype(int), slice(most)

    def _on_nodes(self, spectra: Array, rows: range) -> Array:
        """Return the wanted nodes of fields whose waves are those of `_waves`."""
        number, nx = spectra.shape[1], self.shape[1]
        waves = fftfreq(number, 1.0 / number)[:, None] / self.period[0]
        shift = np.exp(2j * np.pi * rows.start * waves) / rows.step
        lines = ifft(spectra * shift, axis=1, overwrite_x=True)
        lines = lines[:, np.arange(len(rows)) % number]
        found = np.asarray(irfft(lines, self.period[1], axis=2)[:, :, :nx]) / self.fall
        return (found[:, :, ::-1] if self.backwards else found)[:, :, self.part[1]]
