"""A solve with error bars: three grids and one larger domain."""

import math
from dataclasses import dataclass, replace

from tehl.errors import ConvergenceError
from tehl.operators.heights import UnresolvedError
from tehl.options import Domain, Options, check_certifiable
from tehl.problem import ContactProblem
from tehl.result import Cost, Estimate, Result
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import solve
from tehl.solver.verdict import LARGEST_BAR, not_certified, too_coarse

WIDER = 2
"""Factor between the domain and the larger one that shows its part of the error."""
ORDERS = (1.4, 2.8)
"""Observed orders that are taken for the second order of the scheme."""
OUTLET_HALF = 0.5
"""X beyond which the pressure spike is looked for, in Hertz half-widths."""
JUDGED = ("film_central", "film_minimum", "pressure_max")
"""What must be known well enough, else the grid is too coarse; small temperatures need not be."""
RESIDUE = 0.25
"""Part of the extrapolated step that stays in the error bar, at least."""


def certify(
    problem: ContactProblem, options: Options | None = None, *, monitor: Monitor = SILENT
) -> Result:
    """Solve on three grids and on a larger domain; return the finest result with error bars.

    Parameters
    ----------
    problem : ContactProblem
        The contact in SI.
    options : Options
        Of the finest grid; the two others have a half and a quarter of its intervals. All are
        iterated to ``options.tolerance``, so that only the grids differ.
    monitor : Monitor
        Told of each cycle.

    Returns
    -------
    Result
        That of the finest grid, with ``uncertainty`` filled.

    Raises
    ------
    ConvergenceError
        When the finest grid did not converge, or no error bar follows from the others: the
        result is that of the finest grid.
    InputError
        When the grid cannot be halved twice.
    """
    options = (options or Options()).model_copy(update={"accuracy": "tight"})
    check_certifiable(options)
    grids: list[_Grid] = []
    for number, times in enumerate((2, 1), start=1):
        monitor.message(f"certify: grid {number} of 3")
        grids.append(_coarser(problem, halved(options, times), monitor))
    monitor.message("certify: grid 3 of 3")
    finest = solve(problem, options, monitor=monitor)
    monitor.message("certify: larger domain")
    wide = _coarser(problem, widened(options, finest), monitor)
    return _certified(grids, finest, wide)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Grid:
    """A run of the certification; ``used`` is false when nothing follows from it.

    There is no result on a grid that does not carry the waves of the surfaces.
    """

    name: str
    result: Result | None
    used: bool = True

    @property
    def ending(self) -> str:
        """Return its nodes and how it ended."""
        if self.result is None:
            return f"{self.name} too coarse for the surfaces"
        status = self.result.status
        coarse = status.is_vague or status.cause in ("grid_too_coarse", "film_not_positive")
        return f"{self.name} {'too coarse for the film' if coarse else status.outcome}"


def nodes_of(options: Options) -> str:
    """Return the nodes of the finest grid in words."""
    ny, nx = options.shape
    return f"{nx} x {ny}"


def _coarser(problem: ContactProblem, options: Options, monitor: Monitor) -> _Grid:
    """Solve; a coarser grid need not resolve the film, it only has to be iterated to the end."""
    name = nodes_of(options)
    try:
        return _Grid(name=name, result=solve(problem, options, monitor=monitor))
    except UnresolvedError as error:
        monitor.message(f"certify: {error}")
        return _Grid(name=name, result=None, used=False)
    except ConvergenceError as error:
        monitor.message(f"certify: {error.result.status.message}")
        film = error.result.film_scaled.minimum
        return _Grid(name=name, result=error.result, used=film > 0 and _iterated(error.result))


def _certified(coarser: list[_Grid], finest: Result, wide: _Grid) -> Result:
    """Return the result of the last grid with error bars; raise when there are none of use."""
    finest = replace(finest, cost=_cost(finest, [*coarser, wide]))
    first, middle = coarser
    before, larger = _check_used(finest, middle, wide)
    last = _Grid(name=nodes_of(finest.options), result=finest)
    used = [grid.result for grid in (first, middle, last) if grid.used and grid.result is not None]
    runs, wider = [_quantities(run) for run in used], _quantities(larger)
    uncertainty = {
        name: estimate(tuple(run[name] for run in runs), domain=abs(wider[name] - runs[-2][name]))
        for name in wider
    }
    highest = uncertainty["pressure_max"]
    uncertainty["pressure_max"] = with_growing_spike(highest, spike(before), spike(finest))
    status = replace(finest.status, message=_endings([first, middle, last], wide), hint=None)
    result = replace(finest, uncertainty=uncertainty, status=status)
    worst = max(abs(uncertainty[name].uncertainty / uncertainty[name].value) for name in JUDGED)
    if worst > LARGEST_BAR:
        status = too_coarse(result, worst)
        raise ConvergenceError(str(status.message), replace(result, status=status))
    return result


def _cost(finest: Result, others: list[_Grid]) -> Cost:
    """Return what all runs have cost together."""
    costs = [finest.cost, *(grid.result.cost for grid in others if grid.result is not None)]
    return Cost(
        cpu_seconds=sum(cost.cpu_seconds for cost in costs),
        wall_seconds=sum(cost.wall_seconds for cost in costs),
    )


def _check_used(finest: Result, middle: _Grid, wide: _Grid) -> tuple[Result, Result]:
    """Refuse to certify from runs that failed: the finest grid stays, without error bars."""
    found = []
    for grid, what in ((middle, "the grid before the finest"), (wide, "the larger domain")):
        if grid.result is None or not grid.used:
            status = not_certified(finest, f"{what} failed ({grid.ending}).")
            raise ConvergenceError(str(status.message), replace(finest, status=status))
        found.append(grid.result)
    return found[0], found[1]


def _endings(grids: list[_Grid], wide: _Grid) -> str:
    """Return how each grid ended, and what that does to the bars."""
    endings = ", ".join(grid.ending for grid in grids)
    told = f"Grids of the error bars: {endings}; larger domain: {wide.ending}."
    if not grids[0].used:
        return f"{told} The first is left out: each bar is the whole change between the other two."
    first = grids[0].result
    if first is not None and (first.status.is_vague or not first.status.converged):
        return (
            f"{told} Where the first hides the order of the scheme, a bar is the whole change "
            "between the other two."
        )
    return told


def _iterated(result: Result) -> bool:
    """Whether only the grid stands between this result and an answer."""
    if result.status.cause != "grid_too_coarse" or result.status.kind == "diverged":
        return False
    last = result.history[-1]
    worst = max(last.residual, last.change, abs(last.load_error))
    return worst <= result.options.tolerance


def halved(options: Options, times: int) -> Options:
    """Return options of a grid whose intervals are halved so many times."""
    ny, nx = ((n - 1) // 2**times + 1 for n in options.shape)
    return options.model_copy(update={"points": (nx, ny)})


def widened(options: Options, finest: Result) -> Options:
    """Return options of the finest grid on the larger domain: the mesh of the grid before it.

    Parameters
    ----------
    options : Options
        Of the finest grid.
    finest : Result
        On it, which says how large its domain is.
    """
    x, y = finest.scaled.x, finest.scaled.y
    domain = Domain(
        x=(WIDER * float(x[0]), WIDER * float(x[-1])), y=(WIDER * float(y[0]), WIDER * float(y[-1]))
    )
    return options.model_copy(update={"domain": domain})


def _quantities(result: Result) -> dict[str, float]:
    return {
        "film_central": result.film_scaled.central,
        "film_minimum": result.film_scaled.minimum,
        "pressure_max": float(result.scaled.pressure.max()),
        **_heat_quantities(result),
    }


def _heat_quantities(result: Result) -> dict[str, float]:
    """Return what a heated film is asked for besides; the traction of any that slides."""
    quantities = {}
    if (temperature := result.temperature) is not None:
        quantities["mid_film_rise_central"] = temperature.mid_film_rise_central
    coupled = result.problem.is_coupled and result.problem.slide_roll_ratio != 0.0
    if coupled and (traction := result.traction) is not None:
        quantities["traction_mid_film"] = traction.mid_film
    return quantities


def spike(result: Result) -> float:
    """Return the largest pressure of the outlet half, beyond X = 0.5 [-]."""
    return float(result.scaled.pressure[:, result.scaled.x > OUTLET_HALF].max())


def with_growing_spike(highest: Estimate, middle: float, finest: float) -> Estimate:
    """Widen the bar of the largest pressure to where a spike may still grow.

    The spike gets higher on each finer grid and may overtake the centre only there; once it has,
    its first-order growth goes on for as much again.

    Parameters
    ----------
    highest : Estimate
        Of the largest pressure [-].
    middle, finest : float
        Largest pressure of the outlet half on the last two grids [-].
    """
    reach = finest + 2.0 * max(finest - middle, 0.0) - highest.value
    bar = max(highest.discretisation, reach)
    return replace(highest, discretisation=bar, uncertainty=math.hypot(bar, highest.domain))


def estimate(values: tuple[float, ...], domain: float) -> Estimate:
    """Return the Richardson value of two or three grids halved each time, with its error bar.

    Second order is used where the grids show it; the bar is what the observed order would change,
    and at least a quarter of the extrapolated step. Where they do not show it, the finest value
    is given with the whole last change as its bar.

    Parameters
    ----------
    values : tuple of float
        Coarse to fine.
    domain : float
        What the larger domain changed.
    """
    last = values[-1] - values[-2]
    first = values[1] - values[0] if len(values) == 3 else 0.0
    order = math.log2(first / last) if first * last > 0 else None
    if last == 0.0:
        value, bar = values[-1], 0.0
    elif order is not None and ORDERS[0] <= order <= ORDERS[1]:
        value = values[-1] + last / 3.0
        observed = values[-1] + last / (2.0**order - 1.0)
        bar = max(abs(observed - value), RESIDUE * abs(last) / 3.0)
    else:
        value, bar = values[-1], abs(last)
    return Estimate(
        value=value,
        uncertainty=math.hypot(bar, domain),
        discretisation=bar,
        domain=domain,
        observed_order=order,
        values=values,
    )
