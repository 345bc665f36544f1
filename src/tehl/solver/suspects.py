"""What most likely keeps an iteration from its end: bodies, stress or grid; told in words."""

from collections.abc import Iterator
from dataclasses import dataclass

from tehl.domain import needed_points
from tehl.film_formulas import expected_central_film, expected_film
from tehl.grid import Grid
from tehl.heat import FAR_BODY, FilmEnergy
from tehl.problem import ContactProblem
from tehl.result import Status
from tehl.scaling import Groups, ScaledProblem

LARGEST_TRACTION = 0.1
"""Shear stress over pressure that no oil bears."""
MEAN_PRESSURE = 2.0 / 3.0
"""Mean over largest pressure of a Hertz contact."""

_SHEAR_HINT = (
    'State lubricant.shear, such as { law = "eyring", stress = "5 MPa" }, or slide less '
    "(contact.slide_roll_ratio)."
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Suspect:
    """A likely cause: its name for programs, what is known of it, and what to try."""

    cause: str
    message: str
    hint: str


def suspect(grid: Grid, scaled: ScaledProblem) -> Suspect | None:
    """Return the likely causes of an iteration that fails, named by the first; None without any.

    Parameters
    ----------
    grid : Grid
        The finest grid.
    scaled : ScaledProblem
        The contact. Neither temperatures nor sliding matter to an isothermal Newtonian film.
    """
    found = list(_suspects(grid, scaled))
    if not found:
        return None
    return Suspect(
        cause=found[0].cause,
        message=" ".join(one.message for one in found),
        hint=" ".join(one.hint for one in found),
    )


def _suspects(grid: Grid, scaled: ScaledProblem) -> Iterator[Suspect]:
    if scaled.problem.is_coupled:
        yield from _warm_or_cold_body(scaled.problem)
        yield from _stress(scaled)
    yield from _thin_film(grid, scaled.groups)


def _warm_or_cold_body(problem: ContactProblem) -> Iterator[Suspect]:
    """Blame the body that is furthest off the oil, if it is far."""
    heat = problem.heat
    if not isinstance(heat, FilmEnergy):
        return
    bodies = (("surface_1", heat.bulk_1), ("surface_2", heat.bulk_2))
    name, bulk = max(bodies, key=lambda body: abs(body[1] - heat.temperature))
    offset = bulk - heat.temperature
    if not abs(offset) > FAR_BODY:
        return
    ratio = problem.lubricant.viscosity.ambient(bulk) / problem.ambient_viscosity
    change = f"{_round(ratio)} times" if ratio > 1 else f"1/{_round(1.0 / ratio)} of"
    yield Suspect(
        cause="body_temperature",
        message=(
            f"{name}.temperature = {bulk - 273.15:.4g} degC is {abs(offset):.3g} K "
            f"{'above' if offset > 0 else 'below'} the oil at the inlet, which has {change} its "
            "viscosity there."
        ),
        hint=(
            f"Take a temperature of {name} within {FAR_BODY:g} K of the oil, or let the oil "
            "enter nearer to it (thermal.temperature): oil that wets a body takes its temperature."
        ),
    )


def _stress(scaled: ScaledProblem) -> Iterator[Suspect]:
    """Blame a shear stress beyond what any oil bears, estimated at the temperature of the inlet."""
    problem, scales = scaled.problem, scaled.scales
    pressure = MEAN_PRESSURE * scales.hertz_pressure
    rate = abs(problem.motion.sliding_speed) / expected_film(scaled)
    oil = problem.lubricant
    viscosity = oil.viscosity.viscosity_at(pressure, scales.temperature)
    stress = oil.shear.thinned(viscosity * rate, pressure)
    if not stress > LARGEST_TRACTION * pressure:
        return
    yield Suspect(
        cause="shear_stress",
        message=(
            f"With lubricant.shear.law = {oil.shear.law} and slide_roll_ratio = "
            f"{problem.slide_roll_ratio:g} the shear stress is {_round(stress / pressure)} times "
            f"the mean pressure of {pressure / 1e9:.2g} GPa before the film is warm; no oil bears "
            f"more than {LARGEST_TRACTION:g} times."
        ),
        hint=_SHEAR_HINT if oil.shear.law == "newtonian" else "Check lubricant.shear and sliding.",
    )


def _thin_film(grid: Grid, groups: Groups) -> Iterator[Suspect]:
    """Blame the grid where the film is thinner than it can show."""
    needed, here = needed_points(groups), min(grid.nx, grid.ny)
    if not needed > here:
        return
    yield Suspect(
        cause="film_below_grid",
        message=(
            f"The film will be near H = {expected_central_film(groups):.2g}, which takes {needed} "
            f"nodes per direction or more to show; the grid has {here}."
        ),
        hint=f"Take {grid_hint(grid, groups)}.",
    )


def _round(value: float) -> str:
    """Return two digits of a number, without an exponent where it reads well."""
    return f"{float(f'{value:.2g}'):g}"


def grid_hint(grid: Grid, groups: Groups) -> str:
    """Name the grid that is needed: the proposed one, at least twice as fine as this one."""
    nodes = max(needed_points(groups), 2 * max(grid.nx, grid.ny) - 1)
    return f"numerics.points = {nodes}"


def coarse_status(grid: Grid, groups: Groups, error: float) -> Status:
    """Return the status of a film whose relative ``error`` is too large on ``grid``."""
    return Status(
        kind="not_converged",
        cause="grid_too_coarse",
        message=(
            f"The grid of {grid.nx} x {grid.ny} nodes is too coarse for the film, which "
            f"may be wrong by {_share(error)}."
        ),
        hint=f"Take {grid_hint(grid, groups)}.",
    )


def _share(error: float) -> str:
    """Return a relative error in words: beyond all of it no number means anything."""
    return "more than all of it" if error > 1.0 else f"{100 * error:.0f} %"
