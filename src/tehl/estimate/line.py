"""Size of the domain and numbers of nodes of lines and rollers, proposed from their groups."""

import math
from dataclasses import replace

from tehl.base.typing import np
from tehl.contact.options import USUAL_PLAIN_ERROR, Domain, Options
from tehl.contact.shape import LINE, Shape
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.grid import END_CELL, SHORTEST_CELL, Grid, crowding
from tehl.estimate.scaling import Groups

LINE_ERROR, HEATED_LINE_ERROR = 0.002, 0.005
"""Relative error of a smooth steady film that is reached by default: some 40 ms; and of a heated or
thinning one, whose minimum is of first order behind the spike, some 100 ms."""
LINE_ROUGH_NODES = 8192
"""Most nodes because of waves of the surfaces."""
RAREST_PART = 0.25
"""Least part of the lines on a wave along a roller, where those that crowd are rarest: five. With
ten the ends of a tilted `lundberg` roller (M = 125) have too few, and its cycles stall; with six
its middle errs by 0.2 %."""
LEAST_LINE_INLET, INLET_ERROR_PART = 3.4, 0.15
"""Least distance of the inlet edge, in half-widths, and error by it over the error to reach."""
WIDEST_INLET = 3.0
"""That of a roller, in half-widths of its widest slice."""
OUTLET = 5.0 / 11.0
"""Outlet over inlet: X = 0 is a node of every grid of 16 intervals or more."""
FIELD_EDGE_ERROR, FIELD_EDGE_POWER = 0.5, 5.0
"""Error of the film by the far field on the inlet edge, at the distance where the undeformed gap is
the film, and its power: twice what wider domains show for M = 1 to 50, L = 2 to 15 at 2 to 12 such
distances."""
MENISCUS_GAP, LARGEST_SUPPLY = 4.0, 0.995
"""Gap that holds the meniscus, over the film and 1 - r, and largest r for which it does."""
ZERO_EDGE_ERROR = 2.0
"""Error by zero pressure there, of power 3: one to two times what wider domains show."""
LINE_BAR, LINE_NODES = 0.06, tuple(2**k * n + 1 for k in range(3, 10) for n in (16, 20, 24, 28))
"""Error of the film over M h^2, and numbers of nodes."""
FEWEST_OF_STEADY = 512
"""What the nodes of a steady line exceed: on fewer a solve is hardly cheaper."""
LINE_MINIMUM_BAR, HEAVY_LINE = 0.028, 80.0
"""Error of the minimum film, behind the spike, over (M h)^1.5: within a factor of 2.5 for nine
lines with M = 18 to 80, L = 10 to 13 on 513 to 4097 nodes, heated, thinning or neither; and M of
heavier ones: with it 0.15 to 1.9 of the errors of 20 lines with M = 90 to 280, with theirs up to 6;
and 7 of that of one between asperities, M = 84."""
COARSE_LINE_BAR, COARSE_LINE_MOST, COARSE_LINE_M = 0.5, 0.05, 30.0
"""The larger error on nodes that do not exceed those of steady lines, over (M h)^2; the most that
it is; and M of heavier ones, which `LINE_MINIMUM_BAR` has. Of lines with M = 1 to 20, L = 2 to 12
on 129 to 257 nodes it is 0.4 to 1.5 times the bar, once 2.3 times."""
ROLLER_NODES, LEAST_ROWS = tuple(2**k * n + 1 for k in range(4, 9) for n in (16, 20, 24, 28)), 128
"""Numbers of nodes along a roller's entrainment, and least intervals along it: its ends."""
SECOND_ORDER_BAR = 40.0
"""Bar of the middle of a roller, second order over third: 11 % on 257 nodes (crowned, M = 60)."""


def line_domain(along: float, error: float, shape: Shape) -> Domain:
    """Return the domain for a film with a relative ``error``.

    Parameters
    ----------
    along : float
        Where the undeformed gap is the central film [half-widths].
    error : float
        Relative error of the film that is acceptable [-].
    shape : Shape
        Of its widest slice the edges keep their distance.
    """
    thick = along * (FIELD_EDGE_ERROR / (INLET_ERROR_PART * min(error, USUAL_PLAIN_ERROR))) ** (
        1.0 / FIELD_EDGE_POWER
    )
    inlet = math.ceil(10.0 * max(LEAST_LINE_INLET, thick, WIDEST_INLET * shape.widest)) / 10.0
    return Domain.model_construct(x=(-inlet, OUTLET * inlet), y=shape.sides)


def line_supplied_domain(ratio: float, film: float, shape: Shape) -> Domain:
    """Return a domain that contains the film of a starved contact.

    In the oil of a rigid cylinder the gap at the meniscus is the film times 1 + 2.3/(1 - r); here
    it is the gap of the dry contact that is wide enough.

    Parameters
    ----------
    ratio : float
        Oil that enters over what the flooded contact passes on, below one [-].
    film : float
        Central film to expect [-].
    shape : Shape
        Of its widest slice the edges keep their distance.
    """
    gap = MENISCUS_GAP * film / max(1.0 - ratio, 1.0 - LARGEST_SUPPLY)
    inlet = LEAST_LINE_INLET
    while float(LINE.dry_gap(np.array(inlet), np.array(0.0))) < gap:
        inlet *= 1.05
    inlet = math.ceil(10.0 * max(inlet, WIDEST_INLET * shape.widest)) / 10.0
    return Domain.model_construct(x=(-inlet, OUTLET * inlet), y=shape.sides)


def line_bar(groups: Groups, domain: Domain, nodes: float) -> float:
    """Return the error bar of the film by the mesh to expect.

    Parameters
    ----------
    groups, domain : Groups, Domain
        The contact, and the domain of the solve.
    nodes : float
        Nodes along x.
    """
    return LINE_BAR * groups.M * ((domain.x[1] - domain.x[0]) / (nodes - 1)) ** 2


def line_error(groups: Groups, domain: Domain, nodes: float, *, is_bar: bool = True) -> float:
    """Return the error bar by the mesh to expect of central and minimum film, the larger one.

    Parameters
    ----------
    groups, domain, nodes
        As of `line_bar`.
    is_bar : bool
        Whether the bar is meant, which exceeds the error on few nodes.
    """
    width = (domain.x[1] - domain.x[0]) / (nodes - 1)
    minimum = LINE_MINIMUM_BAR * (min(groups.M, HEAVY_LINE) * width) ** 1.5
    found = max(minimum, line_bar(groups, domain, nodes))
    if not is_bar or nodes > FEWEST_OF_STEADY or groups.M > COARSE_LINE_M:
        return found
    return max(found, min(COARSE_LINE_BAR * (groups.M * width) ** 2, COARSE_LINE_MOST))


def line_points(
    groups: Groups, domain: Domain, error: float, least: float, *, is_bar: bool = True
) -> int:
    """Return the nodes on which the error bars of the film will be below an error.

    Parameters
    ----------
    groups, domain : Groups, Domain
        The contact, and the domain of the solve.
    error : float
        Relative error of central and minimum film [-].
    least : float
        Nodes that must be exceeded, for waves of the surfaces.
    is_bar : bool
        Whether bars or errors are to be below it, as of `line_error`.
    """
    bars = ((nodes, line_error(groups, domain, nodes, is_bar=is_bar)) for nodes in LINE_NODES)
    return next((nodes for nodes, bar in bars if nodes > least and bar <= error), LINE_NODES[-1])


def roller_points(
    groups: Groups, domain: Domain, options: Options, waves: tuple[float, float], *, crowds: bool
) -> tuple[int, int]:
    """Return the nodes along a roller's entrainment for an error of its middle, and the lines.

    Parameters
    ----------
    groups, domain : Groups, Domain
        The contact, and the domain of the solve.
    options : Options
        Settled, with the error to reach.
    waves : (float, float)
        Nodes and lines that must be exceeded, for waves of the surfaces.
    crowds : bool
        Whether lines crowd at the ends of the roller.
    """
    least, least_lines = waves
    factor = 1.0 if options.order > 2 else SECOND_ORDER_BAR
    bars = ((nodes, factor * line_bar(groups, domain, nodes)) for nodes in ROLLER_NODES)
    enough = (n for n, bar in bars if n > least and bar <= options.target)
    nodes = next(enough, ROLLER_NODES[-1])
    if groups.shape.goes_on:  # the fewest lines beside its nodes
        parts = ((nodes - 1) * part // 4 + 1 for part in (1, 2, 4, 8))
        return nodes, next((lines for lines in parts if lines > least_lines), 4 * nodes - 3)
    fewest = max((nodes - 1) // 2, LEAST_ROWS)
    times = [part * fewest + 1 for part in (1, 2, 4, 8)]
    grids = [Grid(nx=nodes, ny=n, domain=domain, mirror=False) for n in times if n > least_lines]
    if crowds and least_lines:  # as close at the ends as without waves
        both = [(crowded(groups, one), crowded(groups, one, least_lines)) for one in grids]
        grids = [one for free, one in both if one.crowding == free.crowding]
    return nodes, grids[0].ny if grids else times[-1]


def crowded(groups: Groups, grid: Grid, wanted: float = 0.0) -> Grid:
    """Return a grid of a roller with lines at its ends as close as the film there needs.

    Parameters
    ----------
    groups, grid : Groups, Grid
        Of the film that enters, and uniform nodes.
    wanted : float
        Uniform lines for waves of the surfaces, which limit how far those that crowd are apart.
    """
    cell = max(END_CELL * expected_central_film(groups) ** 0.5, SHORTEST_CELL)
    least = cell * grid.dx / (groups.ellipticity * grid.dy)
    apart = (grid.ny - 1) / (RAREST_PART * wanted) if wanted else math.inf
    return replace(grid, crowding=crowding(least, most_apart=apart), most_apart=apart)
