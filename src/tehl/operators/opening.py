"""The oil beyond the edges in a time step: what a gap that opens or closes squeezes there too."""

from dataclasses import replace

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import Moment
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.far_field import Edges, FarField
from tehl.operators.far_spin import oil_outside
from tehl.operators.upstream import UpstreamField

LEAST_FILM = 1e-3
"""Film of the rigid gap where it would be less [-]: in the contact, of which nothing depends."""


class Opening:
    """Pressure on the edges, and load beyond them, while the gap opens or closes as a whole.

    What is squeezed is linear in the rate, in a rigid gap with the approach of the last film.

    Parameters
    ----------
    oil : Edges
        Of the wedge alone, at this moment.
    squeezed : FarField or UpstreamField
        Its change by the rate.
    gap : array of the shape of the grid
        Undeformed gap of the moment [-].
    past : (float, float, float)
        `approach` of the last two films [-], and the time step [a_x / u_m].
    """

    def __init__(
        self,
        oil: Edges,
        squeezed: FarField | UpstreamField,
        gap: Array,
        past: tuple[float, float, float],
    ) -> None:
        slopes = squeezed.slopes(np.maximum(gap + past[0], LEAST_FILM), gap)
        self.oil, self.gap, self.past = oil, gap, past
        self.places = np.nonzero(slopes.by_rate)
        self.by_rate, self.load_by_rate = slopes.by_rate[self.places], slopes.load_by_rate

    def rate(self, film: Array, gap: Array) -> float:
        """Return the rate at which a film opens, by the backward difference of second order."""
        last, before, step = self.past
        return (1.5 * approach(film, gap) - 2.0 * last + 0.5 * before) / step

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the edges for a film, (ny, nx)."""
        self.oil.set_edges(pressure, film)
        changed = pressure[self.places] + self.rate(film, self.gap) * self.by_rate
        pressure[self.places] = np.maximum(changed, 0.0)

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P outside the grid [-], for film and undeformed gap."""
        return self.oil.load(film, gap) + self.rate(film, gap) * self.load_by_rate


def approach(film: Array, gap: Array) -> float:
    """Return the mean difference of a film and the undeformed gap at the inlet edge [-]."""
    return float(np.mean(film[:, 0] - gap[:, 0]))


def squeezed_by(
    grid: Grid, scaled: ScaledProblem, moment: Moment
) -> FarField | UpstreamField | None:
    """Return what the rate of a film changes beyond the edges; None where it is not known.

    Its pressure does not depend on the speed: oil that moves against x, or spins, is left out.
    """
    if moment.speed < 0.0:
        return None
    found = oil_outside(grid, scaled, replace(moment, speed=1.0))
    return found if isinstance(found, FarField | UpstreamField) else None
