"""Load and friction shared by film and asperities that are finer than the grid."""

from dataclasses import dataclass

import numpy as np

from tehl.post.solids import SolidContact, carried_by_solids
from tehl.post.summit_spots import Spots, real_area, spots
from tehl.post.traction import cell_widths, traction
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True)
class LoadSharing(SolidContact):
    """How film and asperities share load and friction."""

    asperity_pressure_max: float
    """Largest pressure of the asperities, nominal: averaged over many [Pa]."""
    separation_central: float
    """Distance of the mean planes in the middle [m]; below zero they cross."""
    separation_ratio: float
    """The same over sigma of the asperities [-]."""
    spots: Spots | None
    """Spots on which summits touch; None where none touches."""


def load_sharing(result: Solution) -> LoadSharing | None:
    """Return how film and asperities share load and friction; None without asperities.

    The load of the asperities is the sum of their pressure over the nodes; their friction is the
    stated coefficient times it.
    """
    found, law = result.asperities, result.problem.asperities
    if found is None or law is None or result.status.kind == "diverged":
        return None
    cells = np.outer(cell_widths(result.y), cell_widths(result.x))
    area = float((cells * real_area(result, found)).sum())
    carried = carried_by_solids(result, cells * found.pressure, law.friction, area, found.pressure)
    bar = None if result.errors is None else result.errors.at("load_sharing.share")
    forces, middle = traction(result), result.scaled.at_origin(found.separation)
    return LoadSharing(
        **carried,
        share_error=None if bar is None else carried["share"] * bar,
        asperity_pressure_max=float(found.pressure.max()),
        separation_central=middle,
        separation_ratio=middle / float(found.rms),
        spots=spots(result, found),
        balance=float(found.balance),
        friction_film=0.0 if forces is None else forces.size,
    )
