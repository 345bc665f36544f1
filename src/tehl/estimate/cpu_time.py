"""CPU time that a solve needs, from the cycles of full multigrid on each grid."""

import math

from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.duration import components
from tehl.estimate.grid import Grid
from tehl.estimate.levels import levels_of
from tehl.estimate.machine import machine_factor
from tehl.estimate.nodes import finest_grid, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.roughness.model import TileModel

START_TIME, SURFACE_TIME = 0.02, 0.14
"""CPU time of any solve, and of random and measured surfaces, beside the cycles [s]: this and all
others on the machine of `tehl.estimate.machine`."""
EACH_CYCLE, COARSEST_SYSTEM_TIME, COARSEST_SYSTEMS = 1e-3, 2.2e-11, 9
"""CPU time of a cycle beside its nodes, and of a dense coarsest system per cubed node [s], and the
number of these in a solve."""
PER_NODE, THINNING, HEATED = 0.4e-6, 0.8e-6, 1.4e-6
"""CPU time of a cycle per node of its finest grid [s], and what shear thinning and heat add."""
TOUCHING_CYCLE, TOUCHING_CYCLES = 1.1e-6, 15
"""CPU time of a cycle per node where surfaces may touch [s], and the number on each grid: random
surfaces and grooves (shares 0.1 to 0.8, 129 and 257 nodes) take 0.7 to 1.9 times the estimate,
smooth ones 0.1 to 0.5 times. Where cycles fail, Newton's method takes ten times as long."""
FIRST_CYCLES, CYCLES, ROUGH_CYCLES = 4, 3, 8
"""Cycles on the first grid, on each finer one, and on the one where the heights are raised."""
FRONT_FACTOR = 1.4
"""Factor where the edge of the oil must be found; the flooded contact is solved before."""
STARTING = 0.4
"""Cost of the start of a grid in cycles."""
NODES_PER_RESOLVED_WAVE = 8.0
"""Nodes on the shortest wave from which a grid has the heights."""
SURPLUS = 1.1
"""Factor for the contacts that take a finer grid than planned, or a fallback."""
HEAVY_FACTOR, HEAVY_FROM_M, HEAVIER_FROM_M = 2.0, 4000.0, 1e4
"""Factor where thinning or heated films need a fallback whose cycles are slow, the M from which
most do, and that from which the factor grows as its root."""
STEEP_FROM_L, STEEP_POWER, STEEPEST, LEAST_M_OF_SPIKES = 12.0, 1.5, 8.0, 2.0
"""L from which behind a steep spike of the pressure the time of such films grows by this power, as
grids and strategies fail; largest factor; and the M below which there is no spike."""
SLENDER_RATIO_OF_TIME, WIDE_RATIO_OF_TIME = 0.7, 4.0
"""a_y/a_x below and above which a contact takes longer."""
HIGH_TIME_FACTOR, HIGHER_TIME_FACTOR, HEAVY_LOAD = 3.0, 10.0, 2000.0
"""CPU time that eight to nine of ten solves stay below, over the one to expect; that of heated,
thinning, starved, slender and wide contacts and of those with a Moes load above the last number."""


def seconds_range(scaled: ScaledProblem, seconds: float) -> tuple[float, float]:
    """Return the least and the largest time to expect of a solve that takes about ``seconds``.

    Against 33 contacts of bearings, gears and cams the ratio was 0.5 to 7.2 where the error was
    reached.

    Parameters
    ----------
    scaled : ScaledProblem
        Heat, thinning, starvation, high loads and slender or wide ellipses widen the range.
    seconds : float
        Expected CPU time of the solve [s].
    """
    problem, groups = scaled.problem, scaled.entering
    is_hard = (
        problem.is_coupled
        or problem.supply is not None
        or problem.contact_film is not None
        or groups.M > HEAVY_LOAD
        or not SLENDER_RATIO_OF_TIME <= groups.ellipticity <= WIDE_RATIO_OF_TIME
    )
    return 0.5 * seconds, (HIGHER_TIME_FACTOR if is_hard else HIGH_TIME_FACTOR) * seconds


def expected_seconds(scaled: ScaledProblem, options: Options) -> float:
    """Return the CPU time of a solve to expect on one core of this machine [s].

    The constants are a fit to 70 contacts of machines with M = 0.5 to 33,000, most of them heated
    or thinning (``python -m benchmarks.machines``). Of 288 others (M to 220,000) 243 take half to
    twice as long: fallbacks and further grids take longer.

    Parameters
    ----------
    scaled : ScaledProblem
        Its physics decide the cost of a node and a cycle.
    options : Options
        With ``points = "auto"`` further grids are included.
    """
    return machine_factor() * _reference_seconds(scaled, options)


def _reference_seconds(scaled: ScaledProblem, options: Options) -> float:
    """Return the CPU time on the reference machine [s]."""
    (coarsest, _), *finer = expected_cycles(scaled, options)
    newton, each = COARSEST_SYSTEM_TIME * _nodes(coarsest) ** 3, _seconds_per_node(scaled.problem)
    work = COARSEST_SYSTEMS * newton + sum(
        cycles * EACH_CYCLE + (cycles + STARTING) * each * _nodes(grid) for grid, cycles in finer
    )
    work *= _surplus(scaled) if options.points == "auto" else 1.0
    if scaled.problem.supply is not None:
        changes = dict.fromkeys(("supply", "cavitation", "transient", "dynamics"))
        flooded = ScaledProblem.of(scaled.problem.model_copy(update=changes))
        anew = options.model_copy(update={"domain": "auto", "edges": "auto"})
        work = FRONT_FACTOR * work + _reference_seconds(flooded, anew)
    return START_TIME + SURFACE_TIME * _sampled(scaled.problem) + work


def expected_cycles(scaled: ScaledProblem, options: Options) -> list[tuple[Grid, int]]:
    """Return the grids to expect, coarsest first, each with its number of cycles.

    Parameters
    ----------
    scaled : ScaledProblem
        Rough and touching surfaces take more cycles.
    options : Options
        With ``points = "auto"`` the grid is the one on which the error is expected.

    Returns
    -------
    list of (Grid, int)
        The coarsest grid takes Newton steps only, so zero cycles.
    """
    coarsest, *grids = levels_of(finest_grid(scaled, planned(scaled, options)), scaled)[0]
    cycles = [FIRST_CYCLES] + [CYCLES] * (len(grids) - 1)
    if scaled.problem.is_rough:
        first = next((k for k, grid in enumerate(grids[:-1]) if _has_heights(scaled, grid)), -1)
        cycles[first] = ROUGH_CYCLES
    if scaled.problem.contact_film is not None:
        cycles = [TOUCHING_CYCLES] * len(grids)
    return [(coarsest, 0), *zip(grids, cycles, strict=True)]


def _surplus(scaled: ScaledProblem) -> float:
    """Return the factor for grids finer than planned, and for fallbacks."""
    problem, groups = scaled.problem, scaled.entering
    if not problem.is_coupled or problem.is_rough:
        return SURPLUS
    heavy = HEAVY_FACTOR * math.sqrt(max(groups.M / HEAVIER_FROM_M, 1.0))
    heavy = heavy if groups.M > HEAVY_FROM_M else 1.0
    if groups.M < LEAST_M_OF_SPIKES or groups.L < STEEP_FROM_L:
        return SURPLUS * heavy
    return SURPLUS * max(heavy, min((groups.L / STEEP_FROM_L) ** STEEP_POWER, STEEPEST))


def _sampled(problem: ContactProblem) -> int:
    """Return the number of random and measured surfaces."""
    surfaces = (problem.surface_1.roughness, problem.surface_2.roughness)
    return sum(isinstance(part, TileModel) for one in surfaces for part in components(one))


def _nodes(grid: Grid) -> int:
    return grid.shape[0] * grid.shape[1]


def _has_heights(scaled: ScaledProblem, grid: Grid) -> bool:
    """Return whether a grid is fine enough for the heights."""
    (along, across), scales = scaled.problem.shortest_wavelengths, scaled.scales
    nodes = along / (grid.dx * scales.half_width_x), across / (grid.dy * scales.half_width_y)
    return min(nodes) >= NODES_PER_RESOLVED_WAVE


def _seconds_per_node(problem: ContactProblem) -> float:
    if problem.contact_film is not None:
        return TOUCHING_CYCLE
    if not problem.is_coupled:
        return PER_NODE
    return PER_NODE + (THINNING if problem.thermal is None else HEATED)
