"""Films at the ends of rollers whose smallest value or largest pressure has no error bar."""

from tehl.result.solution import Hint, Status
from tehl.solver.cycle.level import Level
from tehl.solver.judging.diagnosis import thinnest
from tehl.solver.judging.measures import ends_of

RELIEVE = Hint(
    "Relieve the ends: a profile with a larger drop, such as that of contact.profile.shape = "
    '"lundberg" or "crown", less tilt, or less load.'
)
"""What to try where a sharp end of a roller is loaded."""


def missed_at_ends(level: Level) -> Status:
    """Return ``converged`` with a warning: lines miss what happens at the ends.

    They are uniform, or waves of the surfaces hold them apart.
    """
    smallest, largest, grid = level.film.h.min(), level.film.p.max(), level.grid
    more = Hint(f"Take more lines, such as numerics.points = [{grid.nx}, {4 * grid.ny - 3}].")
    return Status(
        kind="converged",
        cause="minimum_film_and_largest_pressure_open",
        message=(
            f"The cycles converged on {'too few' if grid.crowding else 'uniform'} lines only, "
            "which do not have the thin film and the high pressure at the ends of this roller: the "
            f"minimum film (here H = {smallest:.3g}) and the largest pressure (here {largest:.3g} "
            "p_h) have no error bar."
        ),
        hint=more if grid.crowding else RELIEVE,
    )


def thinnest_at_end(level: Level, *, is_pressed: bool) -> Status:
    """Return ``converged`` with a warning: the minimum lies at a sharp end under pressure.

    Parameters
    ----------
    level : Level
        Its film is up to date.
    is_pressed : bool
        Whether the largest pressure lies at an end too.
    """
    smallest, _, y = thinnest(level)
    pressed = f" Nor has the largest pressure, {level.film.p.max():.3g} p_h." if is_pressed else ""
    return Status(
        kind="converged",
        cause="minimum_film_and_largest_pressure_open" if is_pressed else None,
        message=(
            f"The film is thinnest (H = {smallest:.3g}) at the sharp end Y = {y:.3g} of the roller "
            "under a pressure that grows with each finer grid: the minimum film has no limit, and "
            f"no error bar.{pressed}"
        ),
        hint=RELIEVE,
    )


def pressed_at_end(level: Level, *, thins: bool = False) -> Status:
    """Return ``converged`` with a warning: the largest pressure is that of a sharp end.

    Parameters
    ----------
    level : Level
        Its film is up to date.
    thins : bool
        Whether the film there becomes the thinnest on finer grids.
    """
    pressures = level.film.p.max(axis=1)
    row = max(ends_of(level), key=lambda end: float(pressures[end]))
    opens = ", and the film gets thinner: neither has a limit, or an" if thins else ""
    return Status(
        kind="converged",
        cause=f"{'minimum_film_and_' if thins else ''}largest_pressure_open",
        message=(
            f"The pressure is largest ({pressures[row]:.3g} p_h) at the sharp end "
            f"Y = {level.grid.y[row]:.3g} of the roller, where it grows with each finer "
            f"grid{opens or ': it has no limit, and no'} error bar."
        ),
        hint=RELIEVE,
    )
