"""Traction of a film: shear forces on the surfaces and at mid-film over the load.

They are those of the loaded zone, `tehl.operators.loaded_zone`; the drag of the flooded oil around
it stands apart, `tehl.post.surroundings`. The stress is ``tau = eta du/dz``, so all coefficients
are negative where surface 1 is the faster (SRR > 0), which the film brakes. They give the force on
surface 1; that on surface 2 is opposite.
"""

import math
from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array
from tehl.operators.loaded_zone import wet_part, zone_part
from tehl.post.surroundings import Surroundings, surroundings
from tehl.result.solution import Solution

LARGEST_CREDIBLE = 0.1
"""Largest traction coefficient of oils; a Newtonian film has no such limit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Traction:
    r"""Traction coefficients of a film in the loaded zone, negative for SRR > 0.

    Without inertia the stress is linear across the film, whatever the viscosity does:
    ``surface_1 = mid_film - rolling``, ``surface_2 = mid_film + rolling`` with

    .. math:: \mathrm{rolling} = \frac{1}{2w} \iint h \frac{\partial p}{\partial x}
              = \frac{1}{2w} \iint \left( \frac{\partial (p h)}{\partial x}
              - p \frac{\partial h}{\partial x} \right)
    """

    surface_1: float
    mid_film: float
    surface_2: float
    """Integral of tau_zx over the pressurised film of the loaded zone at z = 0, h/2 and h, over the
    load [-]; the one at mid-film is the sliding part."""
    rolling: float
    """Rolling part by the pressure gradient, positive [-]."""
    rolling_by_film: float
    """The same by the slope of the film [-]."""
    load: float
    """Normal load w [N]."""
    friction_power: float
    """Power that the surfaces transfer to the film in the loaded zone [W]."""
    surroundings: Surroundings | None = None
    """Drag of the flooded oil around the loaded zone; None for starved films."""

    @property
    def credible(self) -> bool:
        """Whether the coefficient is physical: at most 0.1 at mid-film."""
        return abs(self.mid_film) <= LARGEST_CREDIBLE

    @property
    def closure_error(self) -> float:
        """Imbalance of the forces on the film, over the largest part [-].

        ``surface_2 - surface_1`` is twice the rolling part, by the pressure gradient and by the
        slope of the film: all three agree up to the discretisation error.
        """
        ends = self.surface_2 - self.surface_1
        parts = (ends, 2.0 * self.rolling, 2.0 * self.rolling_by_film)
        if not all(math.isfinite(part) for part in parts):
            return math.nan
        largest = max(map(abs, (*parts, self.surface_1, self.mid_film, self.surface_2)))
        return (max(parts) - min(parts)) / (largest or 1.0)


def traction(result: Solution) -> Traction | None:
    """Return the traction of ``result``, None where it has no shear stresses.

    Integrals are sums over the nodes under pressure, weighted by the part of their cells in the
    loaded zone; the gradient is a central difference. Where surfaces touch through a boundary film,
    its friction replaces the sliding part. The steady film at the start of a transient run carries
    the load at time zero.

    Parameters
    ----------
    result : Solution
        Steady, computed or loaded.
    """
    shear = result.shear
    if shear is None:
        return None
    motion, load = result.problem.motion, result.load
    wet = under_pressure(result)
    area = wet * zone_part(result.scaled.x, result.scaled.y, skew=result.groups.skew)
    inside = area > 0
    weights = area[inside]
    pressure, film = np.maximum(result.pressure, 0.0), result.film_thickness

    def integral(stress: Array) -> float:  # a dot product would start all threads of the BLAS
        return float(np.sum(weights * stress[inside]))

    boundary, found = result.problem.contact_film, result.contact
    carries = found is not None and bool(found.pressure.any())
    meet = carries and boundary is not None and boundary.meets(result.film_thickness)
    rubbed = np.where(meet, shear.mid_film, 0.0)
    first, middle, second = (
        integral(stress - rubbed) for stress in (shear.surface_1, shear.mid_film, shear.surface_2)
    )
    push = integral(film * _slope(pressure, result.x))
    lift = integral(_slope(pressure * film, result.x) - pressure * _slope(film, result.x))
    return Traction(
        surface_1=first / load,
        mid_film=middle / load,
        surface_2=second / load,
        rolling=0.5 * push / load,
        rolling_by_film=0.5 * lift / load,
        load=load,
        friction_power=second * motion.speed_2 - first * motion.speed_1,
        surroundings=surroundings(result, shear, wet - area, load),
    )


def under_pressure(result: Solution) -> Array:
    """Return the area of the cell of each node that is under pressure [m^2], (ny, nx)."""
    area = np.outer(cell_widths(result.y), cell_widths(result.x))
    return area * wet_part(result.scaled.pressure)


def cell_widths(axis: Array) -> Array:
    """Return the width of the cell around each node of ``axis``, a half cell at the ends.

    A single row stands for one metre of a line contact.
    """
    if axis.size == 1:
        return np.ones(1)
    widths = np.gradient(axis)
    widths[[0, -1]] *= 0.5
    return np.asarray(widths)


def _slope(field: Array, x: Array) -> Array:
    """Return the derivative along x, zero on the edges, where no film is under pressure."""
    slope = np.zeros_like(field)
    np.subtract(field[:, 2:], field[:, :-2], out=slope[:, 1:-1])
    slope *= 0.5 * (x.size - 1) / float(x[-1] - x[0])
    return slope
