"""Number of nodes, planned for the error to reach."""

import math
from collections.abc import Callable

from tehl.contact.options import Domain, Options
from tehl.contact.shape import LINE
from tehl.estimate.domain import domain_of, far_field_error
from tehl.estimate.entering import entry_error
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.grid import Grid, can_mirror
from tehl.estimate.in_time import films_of_run, nodes_of_courses
from tehl.estimate.line import (
    FEWEST_OF_STEADY,
    LINE_ROUGH_NODES,
    crowded,
    line_bar,
    line_points,
    roller_points,
)
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.settled import crowds_at_ends, raises_order, settled
from tehl.estimate.starvation import is_starved, supplied_film, supply_ratio
from tehl.estimate.summits import shared_load
from tehl.estimate.third_order import third_order_bar

LEAST_LAMBDA = 0.3
"""Film over sigma below which asperities make bars no smaller."""
FAMILIES = tuple(2**k * n + 1 for k in range(2, 9) for n in (16, 20, 24, 28))
"""Nodes from which `expected_points` chooses; at least three grids."""
FAVOURED = tuple(nodes for nodes in FAMILIES if nodes > 80 and (nodes - 1) % 7)
"""Those of a wedge of third order: their coarsest grids cost least."""
BAR, BAR_COUPLED, EXPECTED_BAR_MARGIN, MARGIN_OF_MIDDLE = 0.24, 1.16, 1.25, 1.1
"""Factors of `expected_bar`: of all contacts, of heated and thinning ones, the margin with which
four of five contacts reach the error on the expected grid, and that of the middle of smooth films
of third order, which nine of ten reach: with 1 those that miss it take what others save."""
LEAST_MESH_PART = 0.25
"""Least part of the error that entering oil leaves; bodies 60 K warmer: 1,537 nodes, not 12,289."""
EXTRAPOLATED, HIGHER, SLENDER_RATIO_OF_NODES = 0.35, (2.5, 1.5), 1.5
"""Bar of an extrapolated film over that without, where large; factor and power where small; and
a_y/a_x from which half as many nodes along y are the fewest that are planned."""
LIMITED_RATIO, LIMITED_SPEED = 3.0, 20.0
"""a_y/a_x from which, and Moes speed L up to which, flooded films with a wedge of third order are
planned without a margin, as their bars hardly exceed the expected ones: 13 of 16 such contacts
reach 1 % on the next coarser grid, of 5 others one."""
EXIT_RATIO, EXIT_LOAD, LEAST_QUARTER = 4.0, 0.56, 32
"""a_y/a_x, and its part of M^(1/4), from which the film is thinnest at the exit, and a quarter of
the lines is enough: of 32 such contacts (M = 41 to 20,000, L up to `LIMITED_SPEED`) it changes the
minimum by less than 0.3 %; of 12 others by up to 8 %, as the film is thinnest at the sides. Least
intervals of that quarter."""
EXIT_STARVED, EXIT_SCARCE, SCARCE = 1.25, 2.25, 0.4
"""Factors on that ratio where oil is scarce, up to that supply over the flooded one and beyond: up
to it the minimum of an outer ring (M = 8,058, a_y/a_x = 5.4) errs by 5 % with a quarter of the
lines just beyond the ratio, three contacts with 1.7 to 2.8 times it by less than 0.1 %; beyond that
supply five of eleven with 1.3 to 2.2 times the ratio err by 0.9 to 2.4 %, the others by less than
0.3 %."""
LINES_BAR, ENOUGH_LINES = 0.2, 1.4
"""Factor of `lines_bar`, within a factor of two for 20 contacts with M = 500 to 31,000; and that
bar over the error to leave from which more lines are planned: on square grids 29 of 32 flooded
contacts with more of it need another one, and 4 of 18 with less."""
ENOUGH_DOUBLE = 0.9
"""`side_bar` of twice as many lines as columns over the error to leave from which more columns are
planned: of 13 circles with more of it 10 need them, and none of 36 with less."""
MORE_COLUMNS = 1.5
"""Most intervals along x over the fewest by `third_order_bar` that are planned for more lines. For
small L `lines_bar` asks for far more than are needed (M = 1e5, L = 0.5: 18 times the nodes)."""
LINES_OF_SCARCE, SCARCE_AT_SIDE = 0.65, 0.8
"""`ENOUGH_LINES` and `LEAST_AT_SIDE` of slender contacts with scarce oil: on square grids 7 of 11
with more of the first need another one, none of 6 with less; minima err by 0.1 to 2 bars."""
LEAST_AT_SIDE = 0.4
"""Least bar of a flooded minimum film at the sides over `lines_bar`: of 5 circles (M = 404 to 673,
L = 2 to 4) it errs by 0.2 to 0.4 of it, and by up to 4 bars without."""
WIDE_LINES_BAR, WIDE_MINIMUM = 0.02, (0.07, 0.5, 1.4)
"""Error of a minimum film of wide contacts by the mesh along y over width^1.5 / H_min: 0.008 to
0.025 for a_y/a_x = 0.2 and 0.5, M = 20 to 500. Factor and powers of M and a_x/a_y of what is added
to one in H_central / H_min, within 15 % for them."""
LINE_PARTS, FEWEST_LINES = (0.0625, 0.125, 0.25, 0.5, 1.0, 2.0), 0.7
"""Lines over columns from which those of wide and turned contacts are chosen, and their least part
of a_y/a_x."""
MOST_LINES, LONGEST_CELL = 2.0, 2.6
"""Most lines over columns, and most over a_y/a_x: the lines of cells longer than that along x
couple more across than along, and the cycles diverge (a_y/a_x = 0.2, M = 500, as many lines)."""
WAVE_NODES, ROUGH_NODES, ROUGH_PARTS = 20.0, 1024, (1, 2, 4)
"""Nodes on the shortest wave of the surfaces; most nodes for that reason, along a roller and as the
root of all others; and lines over columns for that reason, in cells that are not shorter than wide:
a dent on a slender ellipse (a_y/a_x = 10) has 16 nodes along x where it has 3 along y."""


def expected_bar(
    groups: Groups,
    domain: Domain,
    nodes: float,
    *,
    is_coupled: bool = False,
    film: float | None = None,
) -> float:
    """Return the error bar of the film by the mesh to expect, the larger of central and minimum.

    A fit to 215 random smooth contacts with M = 2 to 2000, L = 0.5 to 20 and R_y/R_x = 0.5 to 5
    (``python -m benchmarks.coverage``), within a factor of 1.5 for nine of ten.

    Parameters
    ----------
    groups, domain : Groups, Domain
        The contact, and the domain of the solve.
    nodes : float
        Nodes per direction.
    is_coupled : bool
        Whether the film is heated or thins by shear.
    film : float or None
        Central film, if another than that of smooth flooded contacts [-]: `film_to_resolve`.
    """
    if groups.shape.as_line:
        return line_bar(groups, domain, nodes)
    width = (domain.x[1] - domain.x[0]) / (nodes - 1)
    film = expected_central_film(groups) if film is None else film
    factor = BAR * (BAR_COUPLED if is_coupled else 1.0)
    loads = groups.M**0.77 * max(groups.L, 0.1) ** 0.2
    return float(factor * width**2 * loads / (film**0.59 * groups.ellipticity**1.05))


def expected_points(  # noqa: PLR0913 (one formula)
    groups: Groups,
    domain: Domain,
    error: float,
    *,
    is_coupled: bool = False,
    least: float = 0.0,
    film: float | None = None,
    extrapolate: bool = False,
) -> int:
    """Return the nodes per direction on which the error bars of the film will be below an error.

    Parameters
    ----------
    groups, domain : Groups, Domain
        The contact, and the domain of the solve.
    error : float
        Relative error of central and minimum film [-].
    is_coupled : bool
        Whether the film is heated or thins by shear.
    least : float
        Nodes that must be exceeded, for waves of the surfaces.
    film : float or None
        Central film, if another than that of smooth flooded contacts [-]: `film_to_resolve`.
    extrapolate : bool
        Whether the two finest grids are combined.
    """
    if groups.shape is LINE:
        return line_points(groups, domain, error, least)
    left = _left_to_the_mesh(groups, domain, error)
    bars = (
        (nodes, expected_bar(groups, domain, nodes, is_coupled=is_coupled, film=film))
        for nodes in FAMILIES
    )
    if extrapolate:
        factor, power = HIGHER
        bars = ((nodes, min(EXTRAPOLATED * bar, factor * bar**power)) for nodes, bar in bars)
    return next((nodes for nodes, bar in bars if nodes > least and bar <= left), FAMILIES[-1])


def _left_to_the_mesh(groups: Groups, domain: Domain, error: float) -> float:
    """Return the error bar of the film that the edges of the domain leave to the mesh."""
    return max(error - far_field_error(groups, domain), 0.5 * error) / EXPECTED_BAR_MARGIN


def _nodes_of_waves(scaled: ScaledProblem, domain: Domain) -> tuple[float, float]:
    """Return the nodes along x and y that put `WAVE_NODES` on the shortest wave."""
    problem, scales = scaled.problem, scaled.scales
    along, across = problem.shortest_wavelengths
    along = (domain.x[1] - domain.x[0]) * scales.half_width_x / along
    across = (domain.y[1] - domain.y[0]) * scales.half_width_y / across
    return WAVE_NODES * along, WAVE_NODES * across


def _points_of_waves(
    scaled: ScaledProblem, domain: Domain, least: float, enough: Callable[[float], tuple[int, int]]
) -> tuple[int, int]:
    """Return the fewest nodes (nx, ny) that film and waves of a point contact need.

    Where waves need more than `ROUGH_NODES` allow, those that come nearest. ``enough`` returns the
    nodes (nx, ny) for the film, more along x than those for the waves or the ``least``.
    """
    along, across = _nodes_of_waves(scaled, domain)
    along = max(along, least)
    slender, found = max(scaled.groups.ellipticity, 1.0), []
    for part in (one for one in ROUGH_PARTS if one <= slender):
        wanted, most = max(along, across / part), ROUGH_NODES / math.sqrt(part)
        nodes, lines = enough(min(wanted, most))
        while lines <= across and lines < part * (nodes - 1):
            lines = 2 * lines - 1
        found.append((max(wanted / most, 1.0), nodes * lines, nodes, lines))
    return min(found)[2:]


def planned(scaled: ScaledProblem, options: Options, *, of_central: bool = False) -> Options:
    """Return ``options`` with the nodes on which the error to reach is expected.

    Options that state ``points`` are returned as they are. Others of a rough point contact get a
    wedge of third order (`raises_order`).

    Parameters
    ----------
    scaled : ScaledProblem
        Its expected film, waves and inlet temperature decide the nodes.
    options : Options
        With the error to reach; stated ``points`` are kept.
    of_central : bool
        Whether the error is that of the central film alone, for which fewer lines are enough.
    """
    options = settled(scaled.problem, options)
    if options.points != "auto":
        return options
    domain = domain_of(scaled, options)
    if raises_order(scaled.problem, options):
        options = options.model_copy(update={"wedge_order": 3})
    least = nodes_of_courses(scaled, domain, options.target)
    if scaled.problem.contact.is_line and scaled.problem.transient is None:
        least = FEWEST_OF_STEADY
    points = [
        _points_of(one, own, options, least, of_central=of_central, is_start=number == 0)
        for number, (one, own) in enumerate(films_of_run(scaled, domain))
    ]
    return options.on_points(*max(points))


def least_in_time(scaled: ScaledProblem, options: Options) -> float:
    """Return the fewest nodes along x on which a run may go on from its steady film.

    Those for its courses, and for films that need more than the first one, whose error is known.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        As in `planned`; stated ``points`` do not count.
    """
    options, domain = settled(scaled.problem, options), domain_of(scaled, options)
    steps = nodes_of_courses(scaled, domain, options.target)
    start, *later = (
        _points_of(one, own, options, 0.0, is_start=number == 0)[0]
        for number, (one, own) in enumerate(films_of_run(scaled, domain))
    )
    least = 0.0 if scaled.problem.contact.is_line else start
    return max([steps, *(nodes for nodes in later if nodes > least)])


def _points_of(
    scaled: ScaledProblem,
    domain: Domain,
    options: Options,
    least: float,
    *,
    of_central: bool = False,
    is_start: bool = True,  # later moments of a run have no bars: errors of lines count
) -> tuple[int, int]:
    """Return the nodes (nx, ny) of a steady contact, more than ``least`` along x."""
    kind = scaled.problem.contact
    if kind.has_lines and not kind.is_line:
        along, across = (min(one, ROUGH_NODES) for one in _nodes_of_waves(scaled, domain))
        crowds = crowds_at_ends(scaled.problem)
        return roller_points(scaled.entering, domain, options, (along, across), crowds=crowds)

    def enough(least: float) -> tuple[int, int]:
        if options.order > 2 and not kind.is_line:
            allowed = math.inf if of_central else 1.0
            return _third_order_points(scaled, domain, options.target, least, allowed)
        if kind.is_line:
            return line_points(scaled.entering, domain, options.target, least, is_bar=is_start), 1
        nodes = expected_points(
            scaled.entering,
            domain,
            options.target,
            is_coupled=scaled.problem.is_coupled,
            least=least,
            film=film_to_resolve(scaled),
            extrapolate=bool(options.extrapolate),
        )
        return nodes, nodes

    if kind.is_line:
        least = max(_nodes_of_waves(scaled, domain)[0], least)
        return enough(min(least, LINE_ROUGH_NODES))[0], 1
    return _points_of_waves(scaled, domain, least, enough)


def _third_order_points(
    scaled: ScaledProblem, domain: Domain, error: float, least: float, sides: float
) -> tuple[int, int]:
    """Return nodes (nx, ny) with a wedge of third order for an error of the film.

    They are more than ``least`` along x. Films at the sides of slender contacts and circles may err
    by ``sides`` times as much. Without a margin the fewest in all are taken.
    """
    left = max(error - entry_error(scaled, domain), LEAST_MESH_PART * error)
    left = _left_to_the_mesh(scaled.entering, domain, left)
    groups = scaled.groups
    if groups.skew or groups.ellipticity < 1.0:
        return _wide_or_turned_points(scaled, domain, left, least)
    is_limited = groups.ellipticity >= LIMITED_RATIO and groups.L <= LIMITED_SPEED
    has_margin = not is_limited or scaled.problem.supply is not None
    margin = EXPECTED_BAR_MARGIN if scaled.problem.is_rough else MARGIN_OF_MIDDLE
    most = EXPECTED_BAR_MARGIN * left / (margin if has_margin else 1.0)
    enough = [n for n in FAVOURED if n > least and third_order_bar(scaled, domain, n) <= most]
    fewest = enough[0] if enough else FAVOURED[-1]
    near = math.inf if is_thinnest_at_exit(scaled) else MORE_COLUMNS * (fewest - 1)
    lines = ((n, _lines(scaled, domain, n, sides * left)) for n in enough if n - 1 <= near)
    usual = fewest if groups.ellipticity >= SLENDER_RATIO_OF_NODES else 2 * fewest - 1
    grids = [(n, rows) for n, rows in lines if rows] or [(fewest, usual)]
    return grids[0] if has_margin else min(grids, key=math.prod)


def _wide_or_turned_points(
    scaled: ScaledProblem, domain: Domain, left: float, least: float
) -> tuple[int, int]:
    """Return nodes (nx, ny) of the smallest grid for a bar of a wide or turned contact.

    A starved one has at least as many lines as columns, if its cells may be so short: where its
    film ends, fewer are not known to be enough.
    """
    ratio = scaled.groups.ellipticity
    fewest = FEWEST_LINES * ratio if ratio < SLENDER_RATIO_OF_NODES else 0.5
    known = [part for part in LINE_PARTS if part <= most_lines(ratio)] or [LINE_PARTS[0]]
    starved = scaled.problem.supply is not None
    parts = [one for one in known if one >= (min(known[-1], 1.0) if starved else fewest)]
    intervals = [(n - 1, round(part * (n - 1))) for n in FAVOURED if n > least for part in parts]
    grids = [(nx + 1, ny + 1) for nx, ny in intervals if ny >= LEAST_QUARTER]
    enough = (
        (nx, ny)
        for nx, ny in grids
        if max(third_order_bar(scaled, domain, nx, ny), side_bar(scaled, domain, ny)) <= left
    )
    return min(enough, key=math.prod, default=grids[-1])


def most_lines(ratio: float) -> float:
    """Return the most nodes along y over those along x, for a_y/a_x."""
    return min(MOST_LINES, LONGEST_CELL * ratio)


def _lines(scaled: ScaledProblem, domain: Domain, nodes: int, left: float) -> int | None:
    """Return the nodes along y for an error bar of the minimum film: a part of ``nodes``, or twice.

    ``nodes`` are those along x. None if no number of lines is enough.
    """
    quarter, half, double = (nodes - 1) // 4 + 1, (nodes - 1) // 2 + 1, 2 * nodes - 1
    at_exit = is_thinnest_at_exit(scaled)
    if at_exit and quarter > LEAST_QUARTER:
        return quarter
    if scaled.groups.ellipticity < SLENDER_RATIO_OF_NODES:
        fewest = nodes if side_bar(scaled, domain, nodes) <= left else double
        return fewest if side_bar(scaled, domain, double) <= ENOUGH_DOUBLE * left else None
    starved, rough = scaled.problem.supply is not None, scaled.problem.asperities is not None
    most = (LINES_OF_SCARCE if starved else ENOUGH_LINES) * left
    # asperities that scarce oil leaves to carry load hold the sides apart
    is_held = at_exit or (starved and rough)
    lines, last = ((half,), nodes) if is_held else ((half, nodes, double), None)
    return next((one for one in lines if lines_bar(scaled, domain, one) <= most), last)


def is_thinnest_at_exit(scaled: ScaledProblem) -> bool:
    """Return whether the film is expected to be thinnest at the exit, where few lines are enough.

    Not between asperities, whose cycles diverge on long cells.
    """
    groups, problem = scaled.groups, scaled.problem
    least = max(EXIT_RATIO, EXIT_LOAD * groups.M**0.25)
    if problem.supply is not None:
        least *= EXIT_STARVED if supply_ratio(scaled) < SCARCE else EXIT_SCARCE
    is_slender = groups.ellipticity >= least and groups.L <= LIMITED_SPEED
    return is_slender and problem.is_even_in_y and problem.asperities is None


def lines_bar(scaled: ScaledProblem, domain: Domain, rows: float) -> float:
    """Return the error bar of the minimum film by the mesh along y to expect.

    The film is thinnest beside the edge of the contact, where the pressure falls as a square root:
    the deflection errs by the power 1.5 of the mesh width, and the film with it.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        The contact, and the domain of the solve.
    rows : float
        Nodes along y.
    """
    film = film_to_resolve(scaled) or expected_central_film(scaled.entering)
    width = (domain.y[1] - domain.y[0]) / (rows - 1)
    return float(LINES_BAR * width**1.5 / (film * max(scaled.groups.ellipticity, 1.0) ** 0.5))


def side_bar(scaled: ScaledProblem, domain: Domain, rows: float) -> float:
    """Return the least error bar of a minimum film at the sides.

    Zero where none is known: between asperities and for wide contacts with scarce oil, for turned
    ellipses, whose `third_order_bar` contains it, and where films are thinnest at the exit.

    Parameters
    ----------
    scaled, domain, rows
        As in `lines_bar`.
    """
    groups = scaled.entering
    if scaled.groups.skew:
        return 0.0
    if scaled.problem.supply is not None:
        is_known = groups.ellipticity >= SLENDER_RATIO_OF_NODES and not is_thinnest_at_exit(scaled)
        is_known = is_known and scaled.problem.asperities is None
        return SCARCE_AT_SIDE * lines_bar(scaled, domain, rows) if is_known else 0.0
    if groups.ellipticity >= 1.0:
        return LEAST_AT_SIDE * lines_bar(scaled, domain, rows)
    factor, by_load, by_shape = WIDE_MINIMUM
    thinner = 1.0 + factor * groups.M**by_load / groups.ellipticity**by_shape
    return WIDE_LINES_BAR / LINES_BAR * thinner * lines_bar(scaled, domain, rows)


def film_to_resolve(scaled: ScaledProblem) -> float | None:
    """Return the film that `expected_bar` takes for another than a smooth flooded one [-].

    None for smooth flooded contacts. Asperities hold the surfaces apart, leave less load to the
    film and limit its slopes: a fit to 80 random contacts (lambda 0.05 to 3), with bars 0.7 to 3
    times too large for eight of ten.
    """
    if scaled.problem.asperities is None:
        return supplied_film(scaled) if is_starved(scaled) else None
    film, shared = expected_central_film(scaled.entering), shared_load(scaled)
    ratio = film * scaled.scales.film_thickness / scaled.problem.asperity_rms
    left = (1.0 - shared.share) ** 1.23 * min(max(ratio, LEAST_LAMBDA), 1.0) ** 1.7
    return film * max(shared.gap / film, 1.0) ** 2 / left


def finest_grid(scaled: ScaledProblem, options: Options) -> Grid:
    """Return the grid of the result, half of it if the contact is symmetric.

    Parameters
    ----------
    scaled : ScaledProblem
        Its domain is recommended unless one is stated.
    options : Options
        With the nodes stated.
    """
    domain, (ny, nx) = domain_of(scaled, options), options.shape
    halves = options.half_domain == "auto" and scaled.problem.is_even_in_y
    mirror = halves and can_mirror(options.shape, domain)
    wraps = scaled.groups.shape.wraps and not mirror
    grid = Grid(nx=nx, ny=ny, domain=domain, mirror=mirror, wraps=wraps)
    if not (grid.is_closed and crowds_at_ends(scaled.problem)):
        return grid
    return crowded(scaled.entering, grid, _nodes_of_waves(scaled, domain)[1])
