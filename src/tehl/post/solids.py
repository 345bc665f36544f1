"""Load and friction of solids beside a film: of asperities, and where surfaces touch."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tehl.base.typing import Array
from tehl.post.traction import rubbing_moment, rubbing_motion
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class SolidContact:
    """How a film and solids that touch share load and friction."""

    share: float
    """Load on asperities, or where surfaces touch as this grid has it, over the load [-]."""
    share_error: float | None
    """Its error bar [-]; None if too few grids have it."""
    area: float
    """Real area of contact of asperities, or area on which surfaces touch [m^2]."""
    area_part: float
    """The same over the area of the Hertz contact [-]."""
    pressure_max: float
    """Largest pressure of film and solids together [Pa]."""
    friction_boundary: float
    """Friction of the solids over the load, positive; zero in pure rolling [-]."""
    friction_film: float | None
    """Friction of the film, elsewhere if surfaces touch, at mid-film over the load, positive [-];
    None where a Newtonian film would transmit more than an oil can between surfaces that touch."""
    power_boundary: float
    """Heat of the solids that rub [W]."""
    drilling_boundary: float | None
    """Moment of their friction about the normal through the centre, on surface 1; None without spin
    [N m]."""
    balance: float
    """Mass-balance error of the film, over the oil that enters [-]."""

    @property
    def friction(self) -> float | None:
        """Friction coefficient of film and solids together [-]."""
        film = self.friction_film
        return None if film is None else film + self.friction_boundary


def carried_by_solids(
    result: Solution, load: Array, friction: float, area: float, pressure: Array
) -> dict[str, Any]:
    """Return what solids carry and rub, as a `SolidContact` has it.

    Parameters
    ----------
    result : Solution
        The film beside them.
    load : Array
        Their load at each node [N], of a line [N/m].
    friction : float
        Their coefficient of friction [-].
    area : float
        On which they touch [m^2].
    pressure : Array
        Of the solids [Pa].
    """
    share, scales = float(load.sum()) / result.load, result.scales
    share = share if share > 1e-9 else 0.0  # they touch in a tail of the statistics only
    part, speed = rubbing_motion(result, load)
    hertz = result.groups.shape.area * scales.half_width_x * scales.half_width_y
    return {
        "share": share,
        "area": area,
        "area_part": area / hertz,
        "pressure_max": float(np.max(pressure + result.pressure)),
        "friction_boundary": part * friction * share,
        "power_boundary": friction * share * result.load * speed,
        "drilling_boundary": rubbing_moment(result, friction * load) if share else None,
    }
