r"""Stress of a half-space under loads that repeat along y, below pieces of rollers and teeth.

Along y the loads are a Fourier series. Its mean is a line of loads in plane strain
(`tehl.post.stress.influence`); each other wave :math:`\beta` decays as :math:`e^{-\zeta z}` with
:math:`\zeta^2 = \alpha^2 + \beta^2`, and along x as :math:`e^{-|\beta x|}`, so that a period along
x of some lengths :math:`1/\beta` more than the loads take is enough (docs/theory/stress.md).
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fftfreq, irfft2, next_fast_len, rfft2, rfftfreq

from tehl.base.typing import Array
from tehl.contact.roller import Ends
from tehl.post.stress.influence import HalfSpace, Influence, Spectra, Steps


def over_period(field: Array, ends: Ends, *, odd: bool = False) -> Array:
    """Return a field over a period, without the row that is the first one again.

    Parameters
    ----------
    field : (ny, nx) array
        Both ends included.
    ends : {"open", "mirrored", "periodic"}
        What lies beyond; open ones leave the field as it is.
    odd : bool
        Whether images behind mirrors have the opposite sign.
    """
    if ends == "mirrored":
        return np.concatenate([field, (-1.0 if odd else 1.0) * field[-2:0:-1]])
    return field[:-1] if ends == "periodic" else field


class Decay(NamedTuple):
    """What a depth does: the wave numbers times it, and the influence of the line."""

    depth: float
    line: Influence


class RepeatingHalfSpace:
    """A half-space under loads that repeat along y; it takes the place of a `HalfSpace`.

    Parameters
    ----------
    shape, spacing : (int, int), (float, float)
        Stored rows and columns of the loads, both ends included, and mesh widths (dy, dx).
    ends : {"mirrored", "periodic"}
        What lies beyond.
    """

    mirror = False
    """Half of the rows is never left out."""

    def __init__(self, shape: tuple[int, int], spacing: tuple[float, float], ends: Ends) -> None:
        self.shape, self.ends = shape, ends
        (ny, nx), (dy, dx) = shape, spacing
        period = (ny - 1) * (2 if ends == "mirrored" else 1)
        # e^-16 of the longest wave is left at the next period along x
        beyond = 16.0 * period * dy / (2.0 * math.pi * dx)
        self.period = period, int(next_fast_len(math.ceil(nx + beyond), real=True))
        self.beta = 2.0 * np.pi * fftfreq(period, dy)[:, None]
        self.alpha = 2.0 * np.pi * rfftfreq(self.period[1], dx)[None, :]
        self.zeta = np.hypot(self.alpha, self.beta)
        self.zeta[0] = 1.0  # the line
        self.line = HalfSpace((1, nx), (dy, dx))

    def steps(self, depth: float) -> Steps:
        """Return the nodes along y and x to the next one that a depth needs: all count."""
        del depth
        return 1, 1

    def steps_of(self, influence: Decay) -> Steps:
        """Return the steps for which an influence is."""
        return self.steps(influence.depth)

    def rows(self, steps: Steps) -> slice:
        """Return the rows that are left."""
        return slice(0, None, steps[0])

    def weights(self, steps: Steps) -> Array:
        """Return the rows that each one stands for, half of one at both ends."""
        found = np.full(self.shape[0], float(steps[0]))
        found[[0, -1]] *= 0.5
        return found

    def on_all_rows(self, values: Array, steps: Steps) -> Array:
        """Return components along a column on all rows, (6, ny)."""
        del steps
        return values

    def spectra_of(self, pressure: Array, *tractions: Array) -> Spectra:
        """Return the transforms of loads, for `stresses`, and those of their means along y.

        Parameters
        ----------
        pressure : (ny, nx) array
            Positive in compression.
        tractions : (ny, nx) arrays
            Force on the body over area along x, and along y.
        """
        acting = enumerate((pressure, *tractions))
        whole = [over_period(load, self.ends, odd=k == 2) for k, load in acting]
        waves: Spectra = [rfft2(load, self.period) for load in whole]
        return waves + self.line.spectra_of(*(load.mean(axis=0)[None] for load in whole))

    def thinned(self, spectra: Spectra, steps: Steps) -> Spectra:
        """Return the wave numbers of loads that some depths need."""
        del steps
        return spectra

    def influence(self, depth: float, steps: Steps = (1, 1)) -> Decay:
        """Return what a depth does to waves and line."""
        del steps
        return Decay(depth, self.line.influence(depth))

    def stresses(self, spectra: Spectra, influence: Decay, poisson_ratio: float) -> Array:
        """Return the components of the stress, (6, ny, nx), in the unit of the loads.

        Parameters
        ----------
        spectra : Spectra
            Of the loads, by `spectra_of`.
        influence : Decay
            Of the depth, by `influence`.
        poisson_ratio : float
            Of the body.
        """
        acting = [np.zeros_like(self.zeta) if one is None else one for one in spectra[:3]]
        (ny, nx), waves = self.shape, self._waves(acting, influence.depth, poisson_ratio)
        waves[:, 0] = 0.0
        found = irfft2(waves, self.period)[:, np.arange(ny) % self.period[0], :nx]
        found += self.line.stresses(spectra[3:], influence.line, poisson_ratio)
        return np.asarray(found)

    def _waves(self, loads: list[NDArray[Any]], depth: float, nu: float) -> NDArray[Any]:
        """Return the components of the stress of each wave (Tripp et al. 2003)."""
        p, qx, qy = loads
        a, b, zd = self.alpha / self.zeta, self.beta / self.zeta, self.zeta * depth
        along = 1j * (a * qx + b * qy)  # divergence of the traction over zeta
        turn, bend = 2.0 * nu * (p - along), zd * (p - along)
        stress = np.stack(
            [
                (bend - p) * a * a - turn * b * b + 2.0j * a * qx,
                (bend - p) * b * b - turn * a * a + 2.0j * b * qy,
                -p - bend,
                a * b * (bend - p + turn) + 1j * (qy * a + qx * b),
                1j * b * bend - qy,
                1j * a * bend - qx,
            ]
        )
        return np.asarray(stress * np.exp(-zd))
