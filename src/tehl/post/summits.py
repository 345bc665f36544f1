"""Load and friction shared by film and asperities that are finer than the grid."""

from dataclasses import dataclass

import numpy as np

from tehl.post.summit_spots import Spots, real_area, spots
from tehl.post.traction import cell_widths, rubbing_motion, traction
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class LoadSharing:
    """How film and asperities share load and friction."""

    share: float
    """Load on asperities over the load [-]."""
    share_error: float | None
    """Its error bar [-]; None if too few grids have it."""
    area: float
    """Real area of contact [m^2]."""
    area_part: float
    """The same over the area of the Hertz contact [-]."""
    asperity_pressure_max: float
    """Largest pressure of the asperities, nominal: averaged over many [Pa]."""
    pressure_max: float
    """Largest pressure of film and asperities together [Pa]."""
    separation_central: float
    """Distance of the mean planes in the middle [m]; below zero they cross."""
    separation_ratio: float
    """The same over sigma of the asperities [-]."""
    friction_boundary: float
    """Friction of the asperities over the load, positive; zero in pure rolling [-]."""
    friction_film: float
    """Friction of the film at mid-film over the load, positive [-]."""
    power_boundary: float
    """Heat of the asperities that rub [W]."""
    spots: Spots | None
    """Spots on which summits touch; None where none touches."""
    balance: float
    """Mass-balance error of the film, over the oil that enters [-]."""

    @property
    def friction(self) -> float:
        """Friction coefficient of film and asperities together [-]."""
        return self.friction_film + self.friction_boundary


def load_sharing(result: Solution) -> LoadSharing | None:
    """Return how film and asperities share load and friction; None without asperities.

    The load of the asperities is the sum of their pressure over the nodes; their friction is the
    stated coefficient times it.
    """
    found, law, scales = result.asperities, result.problem.asperities, result.scales
    if found is None or law is None or result.status.kind == "diverged":
        return None
    cells = np.outer(cell_widths(result.y), cell_widths(result.x))
    share = float((cells * found.pressure).sum()) / result.load
    share = share if share > 1e-9 else 0.0  # they touch in a tail of the statistics only
    hertz = result.groups.shape.area * scales.half_width_x * scales.half_width_y
    area = float((cells * real_area(result, found)).sum())
    bar = None if result.errors is None else result.errors.at("load_sharing.share")
    part, speed = rubbing_motion(result, cells * found.pressure)
    forces, middle = traction(result), result.scaled.at_origin(found.separation)
    return LoadSharing(
        share=share,
        share_error=None if bar is None else share * bar,
        area=area,
        area_part=area / hertz,
        asperity_pressure_max=float(found.pressure.max()),
        pressure_max=float((found.pressure + result.pressure).max()),
        separation_central=middle,
        separation_ratio=middle / float(found.rms),
        friction_boundary=part * law.friction * share,
        power_boundary=law.friction * share * result.load * speed,
        spots=spots(result, found),
        balance=float(found.balance),
        friction_film=0.0 if forces is None else forces.size,
    )
