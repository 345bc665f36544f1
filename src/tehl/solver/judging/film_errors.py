"""Error bars of the film of a run so far, by its grids and by what is known of its contact."""

import math
from dataclasses import replace

import numpy as np

from tehl.estimate.domain import domain_error, far_field_error
from tehl.estimate.entering import entry_error
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.grid import distances
from tehl.estimate.in_time import at_start
from tehl.estimate.line import crowded, line_bar
from tehl.estimate.nodes import LIMITED_RATIO, SCARCE, expected_bar, side_bar
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import ends_within, left_by_spin, spin_error
from tehl.estimate.starvation import FORMULA_ERROR, supplied_film, supply_error, supply_ratio
from tehl.estimate.third_order import LEAST_SLENDER, third_order_bar
from tehl.operators.dry import at_loaded_ends
from tehl.result.bars import ErrorEstimate
from tehl.solver.cycle.continuation import Roughness
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.level import Level
from tehl.solver.judging.convergence import GridTrace
from tehl.solver.judging.film_summary import central_value
from tehl.solver.judging.grid_errors import (
    FilmTraits,
    Thinnest,
    error_estimate,
    single_grid_estimate,
)
from tehl.solver.judging.measures import (
    is_pressed_at_end,
    is_thinnest_at_end,
    is_thinnest_at_side,
    side_reach,
)

MOST_EXPECTED = 0.85
"""Largest over usual bar of a flooded film with a wedge of third order: of 96 films of machines on
grids with a usual bar below 2 % as many lie outside (3) as with 1.25, judged on grids two to four
times as fine. With scarce oil the edge of the film decides."""
HOT_SPEED = 30.0
"""Moes speed L up to which that holds where oil heats: of 3 rings with L = 31 to 53 two lie
outside, of 21 others with L > 18 none."""
FEW_LINES, LOAD_AT_EXIT, PART_AT_EXIT = 3.0, 3e3, 0.9
"""Nodes along x over lines, and load M, from which the bar of a minimum at the exit is at least
this part of the bar to expect: it varies along y there. Four of 60 bearings with M = 100 to 50,000
lie outside by up to a third, as judged by films within 0.1 %; without it six by up to three."""
LOAD_AT_SIDES, EXTRAPOLATED_AT_SIDE = 1e3, 0.5
"""Load M from which two grids of a wide contact are enough to extrapolate a minimum at the sides,
and its least bar over that of one that is not: of 14 rigs (M = 1,700 to 14,000) it errs by a third
as much."""
MISSED_LOBE = 1.9
"""Factor on the least bar of a minimum at the sides where oil is scarce and none was found: lines
may miss it. That of an outer ring (M = 4,850) is 1.6 % thinner than at the exit. With less oil than
`SCARCE` none was missed on planned lines: the film of another (M = 9,270) is even to 1e-4."""

MINIMUM_OF_LINE = 12.0
"""Least bar of the minimum film of a line over `line_bar`: grids agree by chance where they do not
resolve the dip at the exit. Of 185 lines (M = 3 to 300, L = 0.5 to 20) the minima of 93.5 % lie in
their bars without, the worst 6.6 bars off (4.5 % on 257 nodes, M = 213), and of 98.9 % with it, the
worst 1.01; of 162 others 97.5 % do, the worst 1.8."""
BAR_AT_ENDS = 0.2
"""Least bar of the minimum of a roller whose lines crowd, over the square of the mesh width over
that film: the valley of a loaded end is as wide as its root, and coarse grids may agree by chance,
as those of a thinning film of 0.0002 do (M = 104: 1.7 % from 129 x 65 to 257 x 129 nodes, where it
errs by 13 %). Of 35 rollers four err by more than their last change alone shows, by 0.07 to 0.14 of
the square over the film, as judged on 1025 x 513; beside them errors below 0.2 % may exceed it."""
MISSING = 1.5
"""Distance of lines at the ends of a roller over that which the film there needs, from which they
miss it. Five rollers (M = 5 to 80) are then within 5 % and their bars; three times as far apart
minima of M = 5 are 2 and 4 % too thick, six times up to 40 %, beside bars of 2 to 11 %."""
RIPPLE_OF_WAVE = 14.0
"""Least bar of the ripples of the film over n^-2, n nodes on the shortest wave: the heights fade on
the coarser grid, which may hide its error. With a wedge of third order six waves (M = 20 to 200,
n = 21 to 58) err by 3 to 10 of n^-2."""


def estimated_errors(
    level: Level, traces: list[GridTrace], roughness: Roughness, hierarchy: Hierarchy
) -> ErrorEstimate | None:
    """Return estimated errors of the film on the last grid; None before its first cycle.

    Parameters
    ----------
    level : Level
        The last level that was solved.
    traces : list of GridTrace
        Film over the cycles of its grid and of the coarser ones, coarsest first.
    roughness : Roughness
        Heights on the levels.
    hierarchy : Hierarchy
        The contact, and the order of the wedge.
    """
    found = _by_grids(level, traces, roughness, hierarchy)
    if found is None:
        return None
    at_end, misses = is_pressed_at_end(level), misses_ends(level, hierarchy)
    bars = dict(found.bars)
    if at_end or misses:
        bars = {name: bar for name, bar in bars.items() if name != "pressure_max"}
    # a boundary film in the middle does not depend on the oil that enters
    meets = central_value(level.grid, level.share.meets(level).astype(float))
    scaled, least = hierarchy.scaled, _least_of_minimum(level, hierarchy, found)
    problem = scaled.problem
    starved = problem.supply is not None
    # after the last cycle; grids that show an order show it with what lines miss
    if traces[-1].measured and not (roughness.is_rough or found.extrapolated):
        least = max(least, side_reach(level, scarce=starved))
    if level.grid.crowding:
        valley = BAR_AT_ENDS * level.grid.dx**2
        least = max(least, valley / max(float(level.film.h.min()), valley))
    if roughness.is_rough and "ripple_film" in bars:
        bars["ripple_film"] = max(bars["ripple_film"], RIPPLE_OF_WAVE / roughness.points**2)
    supply = max(1.0 - meets, 0.0) * supply_error(scaled)
    is_rough = roughness.is_rough
    hidden = _changed_share(level, traces) if is_rough else _hidden_by_contact(scaled, level)
    hidden *= meets
    if is_rough:
        hidden = max(hidden, _lost_between_lines(level, roughness))
    return replace(
        found,
        bars={name: bar + supply for name, bar in bars.items()},
        # as much oil passes everywhere: the film of a starved line is as thin in the middle
        discretisation_central=max(
            found.discretisation_central, hidden, least * (starved and problem.contact.is_line)
        ),
        discretisation_minimum=max(found.discretisation_minimum, least, hidden),
        supply=supply,
        # uniform lines do not have the thin film of an end that presses
        minimum_has_limit=not (
            misses or is_thinnest_at_end(level) or (at_end and not level.grid.crowding)
        ),
        pressure_has_limit=not (at_end or misses),
    )


def misses_ends(level: Level, hierarchy: Hierarchy) -> bool:
    """Return whether lines are farther apart at the ends of a roller than the film there needs.

    They miss it and the pressure, where they are uniform or waves limit how far others are apart.

    Parameters
    ----------
    level, hierarchy : Level, Hierarchy
        The grid of the film, and its contact.
    """
    grid, scaled = level.grid, hierarchy.scaled
    is_limited = grid.crowding == 0.0 or math.isfinite(grid.most_apart)
    if not (is_limited and grid.is_closed) or scaled.problem.contact.profile is None:
        return False
    free = replace(grid, crowding=0.0, edges=(1.0, 1.0))
    wanted = at_loaded_ends(crowded(scaled.entering, free), scaled.groups)
    if not (grid.crowding and wanted.crowding):
        return wanted.crowding > 0.0
    closest, needed = (distances(one.crowding, one.edges)[0] for one in (grid, wanted))
    return closest > MISSING * needed


def _least_of_minimum(level: Level, hierarchy: Hierarchy, found: ErrorEstimate) -> float:
    """Return the least error bar of the minimum film by the mesh that is known before a solve."""
    scaled, grid = hierarchy.scaled, level.grid
    if scaled.problem.contact.is_line:
        is_held = scaled.problem.asperities is not None
        own, domain = at_start(scaled, grid.domain)
        expected = line_bar(own.entering, domain, grid.nx)
        return 0.0 if is_held else MINIMUM_OF_LINE * expected
    at_side, expected, least = is_thinnest_at_side(level), _expected_bar(hierarchy, level), 0.0
    if expected and (at_side or scaled.problem.supply is not None):
        missed = MISSED_LOBE if supply_ratio(scaled) >= SCARCE else 0.0
        least = side_bar(scaled, grid.domain, grid.ny) * (1.0 if at_side else missed)
        least *= EXTRAPOLATED_AT_SIDE if found.extrapolated else 1.0
    has_few_lines = grid.nx > FEW_LINES * grid.ny
    if has_few_lines and not (expected and at_side) and scaled.groups.M > LOAD_AT_EXIT:
        least = max(least, PART_AT_EXIT * expected)
    return least


def _changed_share(level: Level, traces: list[GridTrace]) -> float:
    """Return the relative change of the load on solids by the last grid [-].

    Where rough surfaces touch the film is the boundary film, and may be thicker where less touches:
    a film of 20 nm on 161 nodes (M = 517), where the share changes from 0.79 to 0.69, is one of
    22.8 nm on 449.
    """
    last, before = traces[-1].measured, traces[-2].measured
    changes = (
        abs(1.0 - before[name] / last[name])
        for name in level.share.parts(level)
        if last.get(name) and name in before
    )
    return max(changes, default=0.0)


def _lost_between_lines(level: Level, roughness: Roughness) -> float:
    """Return the part of the film by which waves fade where lines that crowd are rarest [-].

    A/(H n^2) with n lines on the shortest wave: a roller (M = 125, n = 5.9) errs by half of it, and
    three times as much as its bar by grids.
    """
    if not level.grid.crowding:
        return 0.0
    waves = roughness.amplitude / roughness.points**2
    return waves / max(abs(central_value(level.grid, level.film.h)), waves)


def _hidden_by_contact(scaled: ScaledProblem, level: Level) -> float:
    """Return the relative error of a film that smooth surfaces which touch hide [-].

    Where they touch the film is the boundary film on any grid, and grids to which too little oil
    comes agree. It may be as thick as that of a formula (M = 1731, L = 9, boundary film over that
    0.76: 65 and 97 nodes have the boundary film everywhere, 385 a film thicker by a tenth).
    """
    least, alone = level.equations.solids.contact_film, expected_central_film(scaled.entering)
    if least is None:
        return 0.0
    if scaled.problem.supply is not None:
        alone = min(alone, supplied_film(scaled))
    error = expected_bar(scaled.entering, level.grid.domain, level.grid.nx, film=max(alone, least))
    return min(error, max((1.0 + FORMULA_ERROR) * alone / least - 1.0, 0.0))


def _by_grids(
    level: Level, traces: list[GridTrace], roughness: Roughness, hierarchy: Hierarchy
) -> ErrorEstimate | None:
    """Return the errors of `estimated_errors` without that of the supply."""
    scaled, order = hierarchy.scaled, hierarchy.options.order
    if len(traces) < 2 or not traces[-1].reports or traces[-1].diverged:
        return None
    edges, domain = level.grid.domain, 0.0
    if level.equations.outside.far_field is not None:
        domain = entry_error(scaled, edges)
        if not ends_within(scaled, edges):
            domain += far_field_error(left_by_spin(scaled), edges) + spin_error(scaled, edges)
            domain += _thinner_outside(scaled, level)
    expected = _expected_bar(hierarchy, level)
    traits = FilmTraits(
        order=order,
        kind=scaled.problem.contact.type,
        crowded=bool(level.grid.crowding),
        rough=roughness.is_rough,
        newtonian=not scaled.problem.is_coupled,
        sliding=math.hypot(scaled.moment.sliding, scaled.moment.across),
        least=expected,
    )
    # grids that resolve the same heights
    first = roughness.first_comparable if roughness.is_rough else 0
    compared = comparable(traces[first:], goes_on=scaled.groups.shape.goes_on)
    if len(compared) < 2 and roughness.is_rough:
        points, amplitude = roughness.points, roughness.amplitude
        return single_grid_estimate(traces[-1], level.grid.dx, points, amplitude, domain)
    if len(compared) < 2:
        return None
    if roughness.is_rough:
        return error_estimate(compared, traits, domain)
    is_scarce = scaled.problem.supply is not None
    is_limited = not is_scarce or scaled.groups.ellipticity >= LIMITED_RATIO
    is_limited &= scaled.problem.thermal is None or scaled.groups.L <= HOT_SPEED
    # where surfaces touch the wedge is of first order
    is_limited &= scaled.problem.contact_film is None
    most = MOST_EXPECTED * expected if expected and is_limited else math.inf
    traits = replace(traits, most=most, thinnest=_thinnest(level), scarce=is_scarce)
    combined = bool(hierarchy.options.extrapolate) and traces[-2:] == compared[-2:]
    return error_estimate(compared, traits, domain, extrapolate=combined)


def _thinner_outside(scaled: ScaledProblem, level: Level) -> float:
    """Return the relative error of the film by oil that shear thins outside of the domain [-].

    That of `thinner_error`, by the viscosity that the oil has at the inlet edge. With a limiting
    stress in proportion to the pressure, six lines (M = 4 to 20, L = 8 to 18) change by 0.1 to 0.9
    of that.
    """
    if scaled.problem.lubricant.shear.is_newtonian:
        return 0.0
    groups, film = scaled.entering, level.film
    newtonian = np.exp(-groups.alpha_bar * film.p[:, 0]) / groups.lambda_bar
    flows = film.eps_x[:, 0] > 0.0  # a film that diverges may not
    thin = (newtonian * film.h[:, 0] ** 3)[flows] / film.eps_x[flows, 0]
    kept = float(thin.min(initial=1.0))
    return max(1.0 - kept, 0.0) * domain_error(groups, level.grid.domain)


def _thinnest(level: Level) -> Thinnest:
    """Return where a heavily loaded film is thinnest, as `FilmTraits` has it."""
    groups, at_side = level.equations.groups, is_thinnest_at_side(level)
    is_wide = groups.ellipticity < LEAST_SLENDER
    if is_wide and at_side and groups.M > LOAD_AT_SIDES:
        return "sides"
    return "anywhere" if is_wide or at_side or groups.M < LOAD_AT_EXIT else "exit"


def comparable(traces: list[GridTrace], *, goes_on: bool = False) -> list[GridTrace]:
    """Return the grids that did not diverge, whose films make error bars, coarsest first.

    They are the last two where the third last is isothermal and the last one is not.

    Parameters
    ----------
    traces : list of GridTrace
        Coarsest first.
    goes_on : bool
        Whether the contact is a piece of a roller. Its first grids differ in their lines alone, so
        that their films agree however long their cells are along x: of those the last one counts.
    """
    found = [trace for trace in traces if not trace.diverged]
    if goes_on:
        alike = (k for k in range(1, len(found)) if found[k].columns == found[k - 1].columns)
        found = found[max(alike, default=0) :]
    if len(found) > 2 and found[-3].coupled != found[-1].coupled:
        return found[-2:]
    return found


def _expected_bar(hierarchy: Hierarchy, level: Level) -> float:
    """Return the error bar to expect with a wedge of third order; zero where there is no fit."""
    if hierarchy.options.order < 3 or hierarchy.scaled.groups.shape.as_line:
        return 0.0
    return third_order_bar(hierarchy.scaled, level.grid.domain, *level.grid.points)
