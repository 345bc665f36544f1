"""A solve with error bars: three grids and one larger domain."""

import math
from dataclasses import replace

from tehl.errors import ConvergenceError, InputError
from tehl.options import Domain, Options, coarsenings
from tehl.problem import ContactProblem
from tehl.result import Cost, Estimate, Result
from tehl.solver.monitor import SILENT, Monitor
from tehl.solver.steady import solve
from tehl.solver.verdict import LARGEST_BAR, too_coarse

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
        When one of the runs did not converge.
    InputError
        When the grid cannot be halved twice.
    """
    options = (options or Options()).model_copy(update={"accuracy": "tight"})
    if min(coarsenings(n) for n in options.shape) < 3:
        raise InputError(
            f"points = {options.points} is too few to certify: the grid is halved twice, "
            "which takes 129 nodes or more per direction"
        )
    coarse, middle = (_halved(options, times) for times in (2, 1))
    runs = []
    for number, wanted in enumerate((coarse, middle, options), start=1):
        monitor.message(f"certify: grid {number} of 3")
        runs.append(_solve(problem, wanted, monitor, finest=wanted is options))
    monitor.message("certify: larger domain")
    wide = _solve(problem, _widened(options, runs[1]), monitor, finest=False)
    everything = (*runs, wide)
    cost = Cost(
        cpu_seconds=sum(run.cost.cpu_seconds for run in everything),
        wall_seconds=sum(run.cost.wall_seconds for run in everything),
    )
    rows = zip(*(_quantities(run).items() for run in everything), strict=True)
    uncertainty = {
        row[0][0]: estimate((row[0][1], row[1][1], row[2][1]), domain=abs(row[3][1] - row[1][1]))
        for row in rows
    }
    highest = uncertainty["pressure_max"]
    uncertainty["pressure_max"] = with_growing_spike(highest, _spike(runs[1]), _spike(runs[2]))
    result = replace(runs[-1], uncertainty=uncertainty, cost=cost)
    worst = max(abs(uncertainty[name].uncertainty / uncertainty[name].value) for name in JUDGED)
    if worst > LARGEST_BAR:
        status = too_coarse(result, worst)
        raise ConvergenceError(str(status.message), replace(result, status=status))
    return result


def _solve(problem: ContactProblem, options: Options, monitor: Monitor, *, finest: bool) -> Result:
    """Solve; a coarser grid need not resolve the film, it only has to be iterated to the end."""
    try:
        return solve(problem, options, monitor=monitor)
    except ConvergenceError as error:
        if finest or not _iterated(error.result):
            raise
        return error.result


def _iterated(result: Result) -> bool:
    """Whether only the grid stands between this result and an answer."""
    if result.status.cause != "grid_too_coarse":
        return False
    last = result.history[-1]
    worst = max(last.residual, last.change, abs(last.load_error))
    return worst <= result.options.tolerance


def _halved(options: Options, times: int) -> Options:
    ny, nx = ((n - 1) // 2**times + 1 for n in options.shape)
    return options.model_copy(update={"points": (nx, ny)})


def _widened(options: Options, middle: Result) -> Options:
    """Put the mesh width of ``middle`` on the larger domain, with the nodes of the finest grid."""
    x, y = middle.scaled.x, middle.scaled.y
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


def _spike(result: Result) -> float:
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


def estimate(values: tuple[float, float, float], domain: float) -> Estimate:
    """Return the Richardson value of three grids halved each time, with its error bar.

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
    first, last = values[1] - values[0], values[2] - values[1]
    order = math.log2(first / last) if first * last > 0 else None
    if last == 0.0:
        value, bar = values[2], 0.0
    elif order is not None and ORDERS[0] <= order <= ORDERS[1]:
        value = values[2] + last / 3.0
        observed = values[2] + last / (2.0**order - 1.0)
        bar = max(abs(observed - value), RESIDUE * abs(last) / 3.0)
    else:
        value, bar = values[2], abs(last)
    return Estimate(
        value=value,
        uncertainty=math.hypot(bar, domain),
        discretisation=bar,
        domain=domain,
        observed_order=order,
        values=values,
    )
