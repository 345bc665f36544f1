"""Why an iteration failed: the status of a run that diverged or stalled, with its likely cause."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.contact.heat import FAR_BODY, FilmEnergy
from tehl.contact.options import LARGEST_ERROR, LEAST_ERROR, USUAL_PLAIN_ERROR
from tehl.contact.problem import ContactProblem
from tehl.estimate.domain import chosen_domain
from tehl.estimate.film_formulas import expected_film, inlet_stress
from tehl.estimate.grid import Grid
from tehl.estimate.nodes import expected_points, film_to_resolve
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import LESS_SPIN, flooded_reach, outside_by_spin
from tehl.estimate.summits import shared_load
from tehl.lubricant.shear import Eyring, ShearModel
from tehl.post.traction import LARGEST_CREDIBLE
from tehl.result.solution import Hint, Settings, Status
from tehl.result.transient import TIME_OVER
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.level import Level
from tehl.solver.judging.convergence import temperature_scale
from tehl.solver.judging.film_summary import film_summary

LARGEST_RESOLVED_ERROR = 0.1
"""Expected error of the film from which on a grid does not resolve it."""
MOST_WIDENED = 2.0
"""Largest dry pressure of a roller over that of an even load up to which its cycles converge:
with 2.9 by a tilt and 4.5 by a crown (M = 12, L = 15) they diverge."""
MOST_LOAD = 0.5
"""Part of the load on solids from which on the film decides no number of nodes."""
THINNING = {"law": "eyring", "stress": "5 MPa"}
"""The shear law of a usual oil."""
GLASS = 12.0
"""Decimal logarithm of the viscosity at which an oil is a glass [Pa s]."""
LESS_ROUGH = Hint(
    "Take lower or longer asperities, a higher speed, or more nodes (numerics.points)."
)


MOST_OUTSIDE = 0.8
"""Part of the load outside an ellipse that spins from which on its film floats."""
MORE_CYCLES = 4
"""Factor on ``numerics.max_cycles`` in the hint of a run that was still converging."""


class LikelyCause(NamedTuple):
    """A likely cause of failure: its name for programs, message and hint."""

    cause: str
    message: str
    hint: Hint


def diverged(run: FilmSolver) -> Status:
    """Return the status of a run that diverged, with its likely cause."""
    points, groups = run.finest.grid.points, run.groups
    nodes = grid_size(points)
    what = f"The iteration diverged on {nodes} at M = {groups.M:.4g}, L = {groups.L:.4g}."
    found, other = _likely_cause(run), _smoother_hint(run) or _error_hint(run)
    if found is None:
        hint = LESS_ROUGH if run.roughness.is_rough else grid_hint(points, run.hierarchy.scaled)
        return Status(kind="diverged", cause="diverged", message=what, hint=other or hint)
    message = f"{what} Likely cause: {found.message}"
    return Status(kind="diverged", cause=found.cause, message=message, hint=other or found.hint)


def not_reached(run: FilmSolver) -> Status:
    """Return the status of a run whose cycles stalled, or ended before they converged."""
    options, reports = run.options, run.traces[-1].reports
    last = reports[-1]
    numbers = {
        "residual": last.residual,
        "change per cycle": last.change,
        "load error": abs(last.load_error),
    }
    worst = max(numbers, key=lambda name: numbers[name])
    wanted = (
        f"the tolerance is {options.tolerance:.1e}"
        if options.accuracy == "tight"
        else "the film still changes by more than a third of its discretisation error"
    )
    found = f"the {worst} is {numbers[worst]:.1e}; {wanted}"
    heats = run.hierarchy.scaled.problem.thermal is not None
    if heats and last.temperature_change > temperature_scale(last) * numbers[worst]:
        found = f"the temperature still changes by {last.temperature_change:.2g} K per cycle"
    message = (
        f"After {len(reports)} cycle{'s' * (len(reports) > 1)} on {grid_size(last.points)} {found}."
    )
    hint = Hint(
        "it was still converging.", {"numerics.max_cycles": MORE_CYCLES * options.max_cycles}
    )
    if options.accuracy == "change":
        advice = "a small change per cycle is not an error estimate."
        hint = Hint(advice, {"numerics.accuracy": False})
    if options.accuracy == "change" or len(reports) >= options.max_cycles * run.strategy.patience:
        return Status(kind="not_converged", cause="too_few_cycles", message=message, hint=hint)
    cause, hint = _likely_cause(run), grid_hint(run.finest.grid.points, run.hierarchy.scaled)
    if cause is not None:
        message, hint = f"{message} Likely cause: {cause.message}", cause.hint
    return Status(
        kind="stalled",
        cause="stalled",
        message=message,
        hint=_smoother_hint(run) or _error_hint(run) or hint,
    )


def time_over(run: FilmSolver) -> Status:
    """Return the status of a run whose time was over before a grid with error bars converged."""
    points = run.levels[max(len(run.traces) - 1, 0)].grid.points
    message = (
        f"numerics.max_time = {run.options.max_time:g} s is over on {grid_size(points)}, and no "
        "coarser grid converged to a film with error bars."
    )
    less = "a larger numerics.error" if run.goal.is_open else "fewer nodes (numerics.points)"
    hint = Hint(f"Take a longer numerics.max_time, or {less}.")
    cause = _likely_cause(run)
    # a mesh on which no cycle was done says nothing of those before it
    unused = points != run.finest.grid.points
    if cause is not None and not (unused and cause.cause == "film_below_grid"):
        message, hint = f"{message} Likely cause: {cause.message}", cause.hint
    return Status(kind="not_converged", cause=TIME_OVER, message=message, hint=hint)


def _likely_cause(run: FilmSolver) -> LikelyCause | None:
    """Return the likely cause of a failed run: the coarser film, or the contact."""
    if not run.coarser_film_is_negative:
        return likely_cause(run.finest.grid, run.hierarchy.scaled)
    level = run.levels[-2]
    smallest, x, y = thinnest(level)
    return LikelyCause(
        cause="grid_too_coarse",
        message=(
            f"The film of the next coarser grid, of {grid_size(level.grid.points)}, is "
            f"not positive (smallest H = {smallest:.3g} at X = {x:.3g}, Y = {y:.3g} half-widths), "
            "so it is not a start for this one."
        ),
        hint=LESS_ROUGH,
    )


def thinnest(level: Level) -> tuple[float, float, float]:
    """Return the smallest film of a level, between its nodes too, and its X and Y."""
    found = film_summary(level.grid, level.film.h)
    node = float(level.film.h.min())
    return (min(found.minimum, node), *found.minimum_at)


def _error_hint(run: FilmSolver) -> Hint | None:
    """Return the hint to the error that a coarser grid reached, None if there is none."""
    if not run.goal.is_open or run.roughness.is_rough:
        return None
    reached = run.reached_before()
    if reached is None:
        return None
    return reached_hint(*reached)


def reached_hint(nodes: tuple[int, int], error: float, what: str = "") -> Hint:
    """Return the hint to an error that a film on coarser nodes (nx, ny) reached.

    Parameters
    ----------
    nodes, error : (int, int), float
        Of that film, and its relative error [-].
    what : str
        What it has beside, for the end of the sentence.
    """
    advice = f"{grid_size(nodes)} converged to an error of {percentage(error)}{what}."
    return Hint(advice, error_setting(error))


def error_setting(reached: float) -> Settings:
    """Return the setting of an error just above one that was reached; none above the largest."""
    percent = max(110.0 * reached, 100.0 * LEAST_ERROR)
    step = min(10.0 ** math.floor(math.log10(percent)), 1.0)
    error = step * math.ceil(percent / step)
    return {"numerics.error": f"{error:g} %"} if error <= 100.0 * LARGEST_ERROR else {}


def _smoother_hint(run: FilmSolver) -> Hint | None:
    """Return the hint to remove a stated smoother, None if the default was used."""
    if run.options.smoother in ("auto", "robust"):
        return None
    advice = "the default falls back to more robust settings."
    if run.options.smoother == "gauss-seidel":
        advice = "plain Gauss-Seidel diverges on any grid where the elastic deflection dominates."
    return Hint(advice, {"numerics.smoother": False})


def likely_cause(grid: Grid, scaled: ScaledProblem) -> LikelyCause | None:
    """Return all likely causes as one, named by the first; None without any.

    Temperatures and sliding do not affect an isothermal Newtonian film.

    Parameters
    ----------
    grid : Grid
        Finest grid of the failed run.
    scaled : ScaledProblem
        Its expected film, temperatures and stresses are compared with limits.
    """
    found = [*_load_on_an_edge(scaled), *_floating(scaled), *_glass(scaled.problem)]
    found += _film_below_grid(grid, scaled)
    if scaled.problem.is_coupled:
        found = [*_body_temperature(scaled.problem), *_shear_stress(scaled), *found]
    if not found:
        return None
    return LikelyCause(
        cause=found[0].cause,
        message=" ".join(one.message for one in found),
        hint=found[0].hint,
    )


def cause_by_the_oil(scaled: ScaledProblem, *, waves: bool = False) -> LikelyCause | None:
    """Return the law of the oil that is a likely cause of failure, None if they are credible.

    Parameters
    ----------
    scaled : ScaledProblem
        Shear stress and viscosity are compared with those of oils.
    waves : bool
        Whether the film has short waves, which oil that thins leaves lower, heated or not.
    """
    found = [*_shear_stress(scaled)] if scaled.problem.is_coupled or waves else []
    return next(iter((*found, *_glass(scaled.problem))), None)


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
        hint=Hint(
            f"Take a temperature of {name} within {FAR_BODY:g} K of the oil, or an inlet "
            "temperature nearer to it (thermal.temperature): oil takes the temperature of the "
            "body that it wets."
        ),
    )


def _shear_stress(scaled: ScaledProblem) -> Iterator[LikelyCause]:
    """Yield the shear law if the stress at the inlet temperature exceeds that of oils."""
    problem, stress = scaled.problem, inlet_stress(scaled)
    pressure = problem.hertz.mean_pressure
    if not stress > LARGEST_CREDIBLE:
        return
    yield LikelyCause(
        cause="shear_stress",
        message=(
            f"lubricant.shear.law = {problem.lubricant.shear.law} with slide_roll_ratio = "
            f"{problem.slide_roll_ratio:g}: the shear stress at the inlet temperature is "
            f"{_round(stress)} times the mean pressure of {pressure / 1e9:.2g} GPa; "
            f"oils reach at most {LARGEST_CREDIBLE:g} times."
        ),
        hint=_hint_to_shear(problem.lubricant.shear),
    )


def _hint_to_shear(stated: ShearModel) -> Hint:
    """Return the hint to the law of a usual oil; to less sliding of an oil that has it."""
    usual = Eyring.model_validate(THINNING)
    if isinstance(stated, Eyring) and stated.stress <= usual.stress:
        return Hint("Take a slide_roll_ratio nearer to zero: this oil shears as easily as others.")
    return Hint("oils shear at such stresses.", {"lubricant.shear": THINNING})


def _glass(problem: ContactProblem) -> Iterator[LikelyCause]:
    """Yield Barus' law if it makes a glass of the oil long before the largest pressure."""
    if problem.lubricant.viscosity.law != "barus":
        return
    exponent = problem.pressure_coefficient * problem.hertz.pressure
    decades = math.log10(problem.ambient_viscosity) + exponent / math.log(10.0)
    if not decades > GLASS:
        return
    yield LikelyCause(
        cause="viscosity_law",
        message=(
            "lubricant.viscosity.law = barus with a Hertz pressure of "
            f"{problem.hertz.pressure / 1e9:.3g} GPa: the viscosity is 10^{decades:.0f} Pa s; "
            f"oils are glasses from 10^{GLASS:.0f} Pa s on."
        ),
        hint=Hint(
            "its viscosity grows less at such pressures.",
            {"lubricant.viscosity.law": "roelands"},
        ),
    )


def _load_on_an_edge(scaled: ScaledProblem) -> Iterator[LikelyCause]:
    """Yield profile and tilt of a roller that press a small part of its length."""
    roller = scaled.groups.roller
    if roller is None or not roller.widest > MOST_WIDENED:
        return
    pressure = roller.widest * scaled.problem.hertz.pressure
    yield LikelyCause(
        cause="load_on_an_edge",
        message=(
            f"contact.profile and the tilt press the roller to {pressure / 1e9:.2g} GPa, "
            f"{roller.widest:.2g} times the pressure of a load spread evenly over its length."
        ),
        hint=Hint(
            "Take less tilt or tilting moment, or a flatter profile; state a crown that touches "
            "within some half-widths as an ellipse (contact.radius_x and radius_y without a type)."
        ),
    )


def _floating(scaled: ScaledProblem) -> Iterator[LikelyCause]:
    """Yield the spin if the oil that it presses in outside the contact carries most of the load."""
    outside = 0.0 if scaled.problem.supply else outside_by_spin(scaled)
    if outside > MOST_OUTSIDE:
        reach = 1e3 * flooded_reach(scaled) * scaled.scales.half_width_x
        yield LikelyCause(
            cause="spin",
            message=(
                f"contact.spin_1 and spin_2 let oil outside the contact, out to {reach:.3g} mm, "
                f"carry about {percentage(outside)} of the load."
            ),
            hint=Hint(LESS_SPIN),
        )


def _film_below_grid(grid: Grid, scaled: ScaledProblem) -> Iterator[LikelyCause]:
    """Yield the grid if it cannot resolve the film, unless solids carry most of the load."""
    if solids_carry(scaled):
        return
    groups, film = scaled.groups, film_to_resolve(scaled)
    here = min(grid.nx, grid.ny) if grid.ny > 1 else grid.nx
    needed = expected_points(groups, grid.domain, LARGEST_RESOLVED_ERROR, film=film)
    if not needed > here:
        return
    yield LikelyCause(
        cause="film_below_grid",
        message=(
            f"The expected film is H = {shared_load(scaled).gap:.2g}, which takes about "
            f"{needed} nodes per direction for an error of {percentage(LARGEST_RESOLVED_ERROR)}; "
            f"the grid has {here}."
        ),
        hint=grid_hint(grid.points, scaled),
    )


def _round(value: float) -> str:
    """Return two digits of a number, without an exponent where it reads well."""
    return f"{float(f'{value:.2g}'):g}"


def grid_hint(points: tuple[int, int], scaled: ScaledProblem) -> Hint:
    """Return the hint to the recommended grid, at least twice as fine as the present one.

    Where solids carry most of the load no film recommends one.

    Parameters
    ----------
    points : (int, int)
        Nodes (nx, ny) of the present grid.
    scaled : ScaledProblem
        With the film to resolve.
    """
    nodes = 2 * max(points) - 1
    if not solids_carry(scaled):
        domain, film = chosen_domain(scaled, USUAL_PLAIN_ERROR), film_to_resolve(scaled)
        nodes = max(
            nodes, expected_points(scaled.groups, domain, LARGEST_RESOLVED_ERROR, film=film)
        )
    return Hint(settings={"numerics.points": nodes})


def solids_carry(scaled: ScaledProblem) -> bool:
    """Return whether asperities or a boundary film carry most of the load, by formulas."""
    boundary = scaled.problem.contact_film
    if boundary is not None and expected_film(scaled) < boundary.thickness:
        return True
    return scaled.problem.asperities is not None and shared_load(scaled).share > MOST_LOAD
