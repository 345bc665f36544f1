"""Error bars of a steady result, from three grids and one larger domain.

Values of a second-order scheme on grids halved each time extrapolate to
h = h_3 + (h_3 - h_2)/3 (docs/theory/numerics.md on stopping and errors).
"""

import math
from dataclasses import dataclass, replace

from tehl.errors import ConvergenceError
from tehl.operators.heights import UnresolvedError
from tehl.options import Domain, Options, check_certifiable
from tehl.problem import ContactProblem
from tehl.result import Estimate, Result
from tehl.solver.cost import total
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.statuses import not_certified, too_coarse_to_certify
from tehl.solver.steady import solve
from tehl.solver.verdict import LARGEST_BAR

WIDER = 2
"""Size of the larger domain over that of the result."""
ORDERS = (1.4, 2.8)
"""Observed orders that count as second order."""
OUTLET_HALF = 0.5
"""X downstream of which the pressure spike is searched, in Hertz half-widths."""
JUDGED = ("film_central", "film_minimum", "pressure_max")
"""Values whose error bars decide whether the grid is too coarse; small temperatures do not."""
RESIDUE = 0.25
"""Least error bar over the extrapolated change."""
WITHOUT_FIRST = "The first grid is left out: each bar is the full change between the other two."


def certify(
    problem: ContactProblem, options: Options | None = None, *, monitor: Monitor = SILENT
) -> Result:
    """Solve on three grids and on a larger domain; return the finest result with error bars.

    Parameters
    ----------
    problem : ContactProblem
        The contact in SI.
    options : Options
        Of the finest grid; the two others have a half and a quarter of its intervals. All converge
        to ``options.tolerance``, so that only the discretisation differs.
    monitor : Monitor
        Receives the report of each cycle.

    Returns
    -------
    Result
        Of the finest grid, with ``uncertainty``.

    Raises
    ------
    ConvergenceError
        When the finest grid or one that its error bars need did not converge, or when the bars are
        too wide. Its ``result`` is that of the finest grid.
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
    """A run of the certification; ``used``: whether the error bars use it.

    A grid that does not resolve the roughness has no result.
    """

    name: str
    result: Result | None
    used: bool = True

    @property
    def ending(self) -> str:
        """Its nodes and how it ended."""
        if self.result is None:
            return f"{self.name} too coarse for the roughness"
        status = self.result.status
        coarse = status.is_vague or status.cause in ("grid_too_coarse", "film_not_positive")
        return f"{self.name} {'too coarse for the film' if coarse else status.outcome}"


def nodes_of(options: Options) -> str:
    """Return the nodes of the finest grid as text."""
    ny, nx = options.shape
    return f"{nx} x {ny}"


def _coarser(problem: ContactProblem, options: Options, monitor: Monitor) -> _Grid:
    """Solve on a coarser grid, which need not resolve the film but must converge."""
    name = nodes_of(options)
    try:
        return _Grid(name=name, result=solve(problem, options, monitor=monitor))
    except UnresolvedError as error:
        monitor.message(f"certify: {error}")
        return _Grid(name=name, result=None, used=False)
    except ConvergenceError as error:
        monitor.message(f"certify: {error.result.status.message}")
        film = error.result.film_scaled.minimum
        return _Grid(name=name, result=error.result, used=film > 0 and _has_converged(error.result))


def _certified(coarser: list[_Grid], finest: Result, wide: _Grid) -> Result:
    """Return the result of the finest grid with error bars; raise if a bar is too wide."""
    others = (grid.result for grid in (*coarser, wide) if grid.result is not None)
    finest = replace(finest, cost=total(finest.cost, *(other.cost for other in others)))
    first, middle = coarser
    before, larger = _check_used(finest, middle, wide)
    last = _Grid(name=nodes_of(finest.options), result=finest)
    used = [grid.result for grid in (first, middle, last) if grid.used and grid.result is not None]
    runs, wider = [_quantities(run) for run in used], _quantities(larger)
    # the larger domain has the mesh of the middle grid: their difference is due to the domain
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
        status = too_coarse_to_certify(result, worst)
        raise ConvergenceError(str(status.message), replace(result, status=status))
    return result


def _check_used(finest: Result, middle: _Grid, wide: _Grid) -> tuple[Result, Result]:
    """Return the results that the bars need; raise with the finest result if one is missing."""
    found = []
    for grid, what in ((middle, "the next coarser grid"), (wide, "the larger domain")):
        if grid.result is None or not grid.used:
            status = not_certified(finest, f"{what} failed ({grid.ending}).")
            raise ConvergenceError(str(status.message), replace(finest, status=status))
        found.append(grid.result)
    return found[0], found[1]


def _endings(grids: list[_Grid], wide: _Grid) -> str:
    """Return how each grid ended, and what follows for the bars."""
    endings = ", ".join(grid.ending for grid in grids)
    message = f"Grids of the error bars: {endings}; larger domain: {wide.ending}."
    if not grids[0].used:
        return f"{message} {WITHOUT_FIRST}"
    first = grids[0].result
    if first is not None and (first.status.is_vague or not first.status.converged):
        return (
            f"{message} Where the first grid hides the order of the scheme, a bar is the full "
            "change between the other two."
        )
    return message


def _has_converged(result: Result) -> bool:
    """Whether the cycles converged and only the grid is too coarse."""
    if result.status.cause != "grid_too_coarse" or result.status.kind == "diverged":
        return False
    last = result.history[-1]
    worst = max(last.residual, last.change, abs(last.load_error))
    return worst <= result.options.tolerance


def halved(options: Options, times: int) -> Options:
    """Return options of the grid with its intervals halved ``times`` times."""
    ny, nx = ((n - 1) // 2**times + 1 for n in options.shape)
    return options.model_copy(update={"points": (nx, ny)})


def widened(options: Options, finest: Result) -> Options:
    """Return options of the larger domain: the nodes of ``finest``, twice its mesh width."""
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
    """Return the temperature rise of a heated film, and the traction of a sliding one."""
    quantities = {}
    if (temperature := result.temperature) is not None:
        quantities["mid_film_rise_central"] = temperature.mid_film_rise_central
    coupled = result.problem.is_coupled and result.problem.slide_roll_ratio != 0.0
    if coupled and (traction := result.traction) is not None:
        quantities["traction_mid_film"] = traction.mid_film
    return quantities


def spike(result: Result) -> float:
    """Return the largest pressure downstream of X = 0.5 [-]."""
    return float(result.scaled.pressure[:, result.scaled.x > OUTLET_HALF].max())


def with_growing_spike(highest: Estimate, middle: float, finest: float) -> Estimate:
    """Widen the error bar of the largest pressure by the growth of the spike.

    The spike grows with each finer grid, to first order, and may exceed the central pressure on
    finer grids only: it may still grow by twice its last change.

    Parameters
    ----------
    highest : Estimate
        Estimate of the largest pressure [-].
    middle, finest : float
        Pressure of the spike on the last two grids [-].
    """
    reach = finest + 2.0 * max(finest - middle, 0.0) - highest.value
    bar = max(highest.discretisation, reach)
    return replace(highest, discretisation=bar, uncertainty=math.hypot(bar, highest.domain))


def estimate(values: tuple[float, ...], domain: float) -> Estimate:
    """Return the Richardson extrapolation of two or three grids with its error bar.

    If the grids show second order, the extrapolated value is h_3 + (h_3 - h_2)/3, and the bar its
    difference to that with the observed order, at least a quarter of (h_3 - h_2)/3. If not, the
    value is h_3 and the bar |h_3 - h_2|.

    Parameters
    ----------
    values : tuple of float
        h_1, h_2, h_3 or h_2, h_3 on grids halved each time.
    domain : float
        Change by the larger domain.
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
