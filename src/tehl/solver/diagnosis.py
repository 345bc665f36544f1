"""Likely cause of an iteration that fails: temperature of the bodies, shear stress, or grid."""

from collections.abc import Iterator
from dataclasses import dataclass

from tehl.domain import needed_points
from tehl.film_formulas import expected_central_film, expected_film
from tehl.grid import Grid
from tehl.heat import FAR_BODY, FilmEnergy
from tehl.problem import ContactProblem
from tehl.scaling import Groups, ScaledProblem

LARGEST_TRACTION = 0.1
"""Shear stress over pressure beyond what oils bear."""
MEAN_PRESSURE = 2.0 / 3.0
"""Mean over largest pressure of a Hertz contact."""

_SHEAR_HINT = (
    'State lubricant.shear, such as { law = "eyring", stress = "5 MPa" }, or slide less '
    "(contact.slide_roll_ratio)."
)


@dataclass(frozen=True, kw_only=True, slots=True)
class LikelyCause:
    """A likely cause of failure: its name for programs, message and hint."""

    cause: str
    message: str
    hint: str


def likely_cause(grid: Grid, scaled: ScaledProblem) -> LikelyCause | None:
    """Return all likely causes as one, named by the first; None without any.

    Temperatures and sliding do not affect an isothermal Newtonian film.
    """
    found = list(_causes(grid, scaled))
    if not found:
        return None
    return LikelyCause(
        cause=found[0].cause,
        message=" ".join(one.message for one in found),
        hint=" ".join(one.hint for one in found),
    )


def _causes(grid: Grid, scaled: ScaledProblem) -> Iterator[LikelyCause]:
    if scaled.problem.is_coupled:
        yield from _body_temperature(scaled.problem)
        yield from _shear_stress(scaled)
    yield from _film_below_grid(grid, scaled.groups)


def _body_temperature(problem: ContactProblem) -> Iterator[LikelyCause]:
    """Yield the body whose temperature is furthest from that of the oil, if it is far."""
    heat = problem.heat
    if not isinstance(heat, FilmEnergy):
        return
    bodies = (("surface_1", heat.bulk_1), ("surface_2", heat.bulk_2))
    name, bulk = max(bodies, key=lambda body: abs(body[1] - heat.temperature))
    offset = bulk - heat.temperature
    if not abs(offset) > FAR_BODY:
        return
    ratio = problem.lubricant.viscosity.ambient(bulk) / problem.ambient_viscosity
    yield LikelyCause(
        cause="body_temperature",
        message=(
            f"{name}.temperature = {bulk - 273.15:.4g} degC: {abs(offset):.3g} K "
            f"{'above' if offset > 0 else 'below'} the oil at the inlet, whose viscosity changes "
            f"by a factor of {_round(ratio)}."
        ),
        hint=(
            f"Take a temperature of {name} within {FAR_BODY:g} K of the oil, or an inlet "
            "temperature nearer to it (thermal.temperature): oil takes the temperature of the "
            "body that it wets."
        ),
    )


def _shear_stress(scaled: ScaledProblem) -> Iterator[LikelyCause]:
    """Yield the shear law if the stress at the inlet temperature is beyond what oils bear."""
    problem, scales = scaled.problem, scaled.scales
    pressure = MEAN_PRESSURE * scales.hertz_pressure
    rate = abs(problem.motion.sliding_speed) / expected_film(scaled)
    oil = problem.lubricant
    viscosity = oil.viscosity.viscosity(pressure, scales.temperature)
    stress = oil.shear.thinned(viscosity * rate, pressure)
    if not stress > LARGEST_TRACTION * pressure:
        return
    yield LikelyCause(
        cause="shear_stress",
        message=(
            f"lubricant.shear.law = {oil.shear.law} with slide_roll_ratio = "
            f"{problem.slide_roll_ratio:g}: the shear stress at the inlet temperature is "
            f"{_round(stress / pressure)} times the mean pressure of {pressure / 1e9:.2g} GPa; "
            f"oils bear at most {LARGEST_TRACTION:g} times."
        ),
        hint=_SHEAR_HINT if oil.shear.law == "newtonian" else "Check lubricant.shear and sliding.",
    )


def _film_below_grid(grid: Grid, groups: Groups) -> Iterator[LikelyCause]:
    """Yield the grid if it cannot resolve the expected film."""
    needed, here = needed_points(groups), min(grid.nx, grid.ny)
    if not needed > here:
        return
    yield LikelyCause(
        cause="film_below_grid",
        message=(
            f"The expected film is H = {expected_central_film(groups):.2g}, which takes {needed} "
            f"nodes per direction or more to resolve; the grid has {here}."
        ),
        hint=f"Take {grid_hint(grid, groups)}.",
    )


def _round(value: float) -> str:
    """Return two digits of a number, without an exponent where it reads well."""
    return f"{float(f'{value:.2g}'):g}"


def grid_hint(grid: Grid, groups: Groups) -> str:
    """Return the key and value of the recommended grid, at least twice as fine as ``grid``."""
    nodes = max(needed_points(groups), 2 * max(grid.nx, grid.ny) - 1)
    return f"numerics.points = {nodes}"
