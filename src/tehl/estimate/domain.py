"""Size of the domain and number of nodes, proposed from the dimensionless groups."""

import math
from dataclasses import replace

from tehl.base.errors import InputError
from tehl.contact.moment import courses_of, moments_of
from tehl.contact.options import LINE_WIDTH, ROLLER_ENDS, USUAL_PLAIN_ERROR, Domain, Options
from tehl.contact.problem import ContactProblem
from tehl.contact.shape import LINE
from tehl.estimate.duration import duration_of
from tehl.estimate.entering import entry_error
from tehl.estimate.film_formulas import expected_central_film, moes_film_unit
from tehl.estimate.line import (
    HEATED_LINE_ERROR,
    LINE_ERROR,
    LINE_ROUGH_NODES,
    OUTLET,
    line_bar,
    line_domain,
    line_edge_error,
    line_field_error,
    line_points,
)
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.starvation import is_starved, starved_domain, supplied_film
from tehl.estimate.summits import shared_load
from tehl.estimate.third_order import third_order_bar

CAUTION = 2.0
"""Factor on the slope of the film formula by load, which is half of what wider domains show between
M = 2 and 5."""
NEAREST, NEAR_EDGE_ERROR = (2.0, 1.6), 0.15
"""Distances of a stated inlet edge and of side edges below which the far field is not that of the
gap, and error of the film per half-width less: 4 % measured at 1.2 from the sides (M = 76)."""
LARGEST_DOMAIN_FACTOR = 2.5
"""Largest factor on the domain because of the temperature of the bodies."""
DOMAIN_STEP, ENTRY_PART = 1.05, 0.3
"""Steps of that factor, and part of the error of the domain that it leaves to the oil entering."""
ELASTIC = 0.1
"""Error by zero pressure on the edges over the square of the width of the gap over the distance of
the sides (0.05 to 0.08 measured for M = 10 to 100)."""
INLET, SIDES = (3.4, 5.0), (2.3, 3.75)
"""Least distance of the inlet edge and of the side edges, in Hertz half-widths, and in widths of
the parabolic gap that is as thick as twice the film."""
WIDE_INLET = (2.6, 0.25)
"""Least distance of the inlet edge of a wide contact, over this power of the ellipticity: it draws
from further upstream."""
SLENDER, SLENDER_SIDES = 4.0, (1.8, 3.0)
"""Ellipticity from which the side edges are nearer, and their distances as in `SIDES`: at 1.7, and
2.4 widths, they change the film of seven bearings and gears by less than 0.03 %, that of circles by
0.3 %."""
FAR_FIELD, FAR_SIDES, WIDE_FIELD = 0.1, 0.03, 1.25
"""Error by the far field over the cubed widths of the gap over the distances of the edges, of the
sides of slender contacts, and over H kappa / X_in^5 (0.2 to 1.25 measured for M = 20 to 3400 and
kappa = 1 to 10)."""
SEPARATION_WITHOUT_CONTACT, EDGE_GAP_MARGIN = 4.5, 1.3
"""Separation over sigma from which asperities carry less than 1e-4 of what they do in touch, and
margin on the gap at the edges."""
LEAST_LAMBDA = 0.3
"""Film over sigma below which asperities make bars no smaller."""
FAMILIES = tuple(2**k * n + 1 for k in range(2, 9) for n in (16, 20, 24, 28))
ROLLER_NODES, LEAST_ROWS = tuple(one for one in FAMILIES if one > 128), 128
"""Numbers of nodes along a roller's entrainment, and least intervals along it: its ends."""
ROLLER_ERROR = 0.05
"""Relative error of the film of a roller that is reached by default: at its ends the smallest film
changes by some percent with each finer grid."""
FAVOURED = tuple(nodes for nodes in FAMILIES if nodes > 80 and (nodes - 1) % 7)
"""Those of a wedge of third order: their coarsest grids cost least."""
"""Nodes from which `expected_points` chooses; at least three grids."""
BAR, BAR_COUPLED, EXPECTED_BAR_MARGIN = 0.24, 1.16, 1.25
"""Factors of `expected_bar`: of all contacts, of heated and thinning ones, and the margin with
which four of five contacts reach the error on the expected grid."""
EXTRAPOLATED, HIGHER = 0.35, (2.5, 1.5)
"""Error bar of an extrapolated film over that of the film without, where that is large; factor and
power of that where it is small."""
EXTRAPOLATED_DOMAIN = 2.0
"""Error for which the domain is chosen over the one to reach, of extrapolated films: the edges
leave a seventh of it (0.3 % of 2 %), and the mesh less than without extrapolation."""
SLENDER_RATIO_OF_NODES = 1.5
"""a_y/a_x from which half as many nodes along y leave the same error."""
WAVE_NODES, ROUGH_NODES = 20.0, 1024
"""Nodes on the shortest wave of the surfaces, and most nodes for that reason."""


def gap_widths(groups: Groups) -> tuple[float, float]:
    """Return the distances along x and y where the undeformed gap is the central film [-].

    In half-widths a_x and a_y: the pressure of a thick film extends over a few of them. Those of an
    ellipse at an angle are the largest X and Y of the rim of that gap.
    """
    along, across = math.sqrt(2.0 * expected_central_film(groups)), groups.shape.across
    if not across:
        return along, 0.0
    wider = math.sqrt(across / (across - groups.twist**2))
    return wider * along, wider * along / math.sqrt(across)


def recommended_domain(groups: Groups, error: float = USUAL_PLAIN_ERROR) -> Domain:
    """Return the domain, in Hertz half-widths, for a film with a relative ``error``.

    The far field on its edges leaves an error of the order of the distance to the power -3:
    0.3 % of the central film on the domain of the usual error, and less above M = 10
    (``python -m benchmarks domain``).

    Parameters
    ----------
    groups : Groups
        Film, ellipticity and radius ratio.
    error : float
        Relative error of the film that is acceptable [-].
    """
    along, across = gap_widths(groups)
    if groups.shape.as_line:
        return line_domain(along, error, groups.shape.sides)
    larger = max(USUAL_PLAIN_ERROR / error, 1.0) ** (1.0 / 3.0)
    wide = WIDE_INLET[0] * max(groups.ellipticity, 1.0) ** WIDE_INLET[1]
    inlet = larger * max(INLET[0], wide, INLET[1] * along)
    sides = SLENDER_SIDES if groups.ellipticity >= SLENDER else SIDES
    width = larger * max(sides[0], sides[1] * across)
    inlet, width = (math.ceil(10.0 * edge) / 10.0 for edge in (inlet, width))
    # not validated: a nearly rigid contact may need more than a stated domain may have
    return Domain.model_construct(x=(-inlet, OUTLET * inlet), y=(-width, width))


def far_field_error(groups: Groups, domain: Domain) -> float:
    """Estimate the relative error of the film on a domain with the far field on its edges.

    Measured for M = 1 to 500 and R_y/R_x = 0.5 to 5, rounded up.

    Parameters
    ----------
    groups : Groups
        Moes numbers and ellipticity of the contact.
    domain : Domain
        Edges in Hertz half-widths.
    """
    along, across = gap_widths(groups)
    if groups.shape.as_line:
        return line_field_error(along, domain)
    inlet, side = -domain.x[0], min(-domain.y[0], domain.y[1])
    part = FAR_SIDES if groups.ellipticity >= SLENDER else FAR_FIELD
    thick = FAR_FIELD * (along / inlet) ** 3 + part * (across / side) ** 3
    wide = WIDE_FIELD * 0.5 * along**2 * max(groups.ellipticity, 1.0) / inlet**5
    near = NEAR_EDGE_ERROR * (max(NEAREST[0] - inlet, 0.0) + max(NEAREST[1] - side, 0.0))
    return thick + wide + near


def domain_error(groups: Groups, domain: Domain) -> float:
    """Estimate the relative error of a thick film with zero pressure on the edges of the domain.

    Far from the contact the pressure upstream is that of a rigid parabolic gap,
    ``P = 4 lambda |X| / ((3 + 2 D) (X^2 + D kappa^2 Y^2)^2)`` (docs/theory/numerics.md). Its load
    outside the domain is missing, and the film changes with the slope of its formula by load. Wider
    domains show 3 to 4 % at M = 5, 22 to 34 % at M = 3 and more below; this estimate is 1 to 10 and
    11 to 33 %. Elastic contacts (M > 10) lose less, by the square of the distance of the sides.

    Parameters
    ----------
    groups : Groups
        Moes numbers and radius ratio of the contact.
    domain : Domain
        Edges in Hertz half-widths.
    """
    if groups.shape.as_line:
        return line_edge_error(gap_widths(groups)[0], domain)
    stretch = math.sqrt(groups.shape.across)
    side = stretch * min(-domain.y[0], domain.y[1])
    inlet = -domain.x[0]
    # integral of |X| / (X^2 + Y^2)^2 upstream of the contact and outside the rectangle
    beyond = 1.0 / side + math.atan(side / inlet) / inlet
    amplitude = 4.0 * groups.lambda_bar / ((3.0 + 2.0 * groups.radius_ratio) * stretch)
    missing = amplitude * beyond / groups.shape.load
    heavier = replace(groups, M=1.02 * groups.M)
    films = [expected_central_film(one) / moes_film_unit(one) for one in (groups, heavier)]
    slope = math.log(films[0] / films[1]) / math.log(1.02)
    elastic = ELASTIC * (gap_widths(groups)[1] / min(-domain.y[0], domain.y[1])) ** 2
    return max(CAUTION * slope * missing, elastic)


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
    if groups.shape.as_line:
        bars = ((nodes, line_bar(groups, domain, nodes)) for nodes in ROLLER_NODES)
        return next((n for n, bar in bars if n > least and bar <= error), ROLLER_NODES[-1])
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


def _nodes_of_waves(scaled: ScaledProblem, domain: Domain) -> float:
    """Return the nodes that put `WAVE_NODES` on the shortest wave, `ROUGH_NODES` at most."""
    problem, scales = scaled.problem, scaled.scales
    waves = [one.roughness.shortest_wavelengths for one in (problem.surface_1, problem.surface_2)]
    along = (domain.x[1] - domain.x[0]) * scales.half_width_x / min(wave[0] for wave in waves)
    across = (domain.y[1] - domain.y[0]) * scales.half_width_y / min(wave[1] for wave in waves)
    if problem.contact.is_line:
        return min(WAVE_NODES * along, LINE_ROUGH_NODES)
    return min(WAVE_NODES * max(along, across), ROUGH_NODES)


def settled(problem: ContactProblem, options: Options) -> Options:
    """Return ``options`` that say whether the film of a contact is extrapolated.

    Waves of rough surfaces, nodes that touch and time steps do not show one order.

    Parameters
    ----------
    problem : ContactProblem
        Smooth steady films without boundary contact are extrapolated if the grid is chosen too.
    options : Options
        Returned as they are if they state ``extrapolate``.
    """
    if problem.contact.is_line:
        return _of_one_row(problem, options)
    if problem.contact.has_lines:
        options = _between_ends(problem, options)
    if options.domain != "auto" and options.domain.y == LINE_WIDTH:
        raise InputError("numerics.domain.y is missing: give the side edges, such as [-3.0, 3.0]")
    if isinstance(options.points, tuple) and options.points[1] == 1:
        raise InputError('numerics.points: one row of nodes is for contact.type = "line" alone')
    if options.extrapolate is not None:
        return options
    found = options.points == "auto" and _is_smooth(problem)
    return options.model_copy(update={"extrapolate": found})


def _between_ends(problem: ContactProblem, options: Options) -> Options:
    """Return the options of a roller, whose domain ends where it does.

    At its ends the pressure is steep, and the film does not show one order. The wedge is of third
    order as in line contacts.
    """
    domain = options.domain
    changes: dict[str, object] = {"extrapolate": bool(options.extrapolate)}
    if options.wedge_order is None and options.extrapolate is None and _is_smooth(problem):
        changes["wedge_order"] = 3
    if options.error is None and options.points == "auto":
        changes["error"] = ROLLER_ERROR
    options = options.model_copy(update=changes)
    if domain == "auto" or domain.y == ROLLER_ENDS:
        return options
    if domain.y != LINE_WIDTH:
        raise InputError(
            "numerics.domain.y: the nodes of a roller end where it does; state domain.x alone"
        )
    return options.model_copy(update={"domain": domain.model_copy(update={"y": ROLLER_ENDS})})


def _of_one_row(problem: ContactProblem, options: Options) -> Options:
    """Return the options of a line contact, whose nodes lie on one row.

    They are cheap, so no film is extrapolated; the wedge is of third order where that of an
    extrapolated film would be.
    """
    points, domain = options.points, options.domain
    if isinstance(points, tuple) and points[1] != 1:
        raise InputError(
            f"numerics.points = {list(points)}: a line contact has nodes along x alone; take "
            f"{points[0]}"
        )
    changes: dict[str, object] = {"extrapolate": bool(options.extrapolate)}
    if options.wedge_order is None and options.extrapolate is None and _is_smooth(problem):
        changes["wedge_order"] = 3
    if options.error is None and points == "auto" and _is_smooth(problem):
        changes["error"] = HEATED_LINE_ERROR if problem.is_coupled else LINE_ERROR
    if isinstance(points, int):
        changes["points"] = (points, 1)
    if domain != "auto" and domain.y != LINE_WIDTH:
        changes["domain"] = domain.model_copy(update={"y": LINE_WIDTH})
    return options.model_copy(update=changes)


def _is_smooth(problem: ContactProblem) -> bool:
    """Whether a steady film is smooth on the mesh."""
    rough = problem.is_rough or problem.contact_film is not None
    return not rough and problem.transient is None


def planned(scaled: ScaledProblem, options: Options) -> Options:
    """Return ``options`` with the nodes on which the error to reach is expected.

    Options that state ``points`` are returned as they are.

    Parameters
    ----------
    scaled : ScaledProblem
        Its expected film, waves and inlet temperature decide the nodes.
    options : Options
        With the error to reach; stated ``points`` are kept.
    """
    options = settled(scaled.problem, options)
    if options.points != "auto":
        return options
    domain, is_line = domain_of(scaled, options), scaled.problem.contact.is_line
    least = _nodes_of_waves(scaled, domain)
    if options.order > 2 and not is_line:
        left = _left_to_the_mesh(scaled.entering, domain, options.target)
        more = (nodes for nodes in FAVOURED if nodes > least)
        enough = (one for one in more if third_order_bar(scaled, domain, one) <= left)
        nodes = next(enough, FAVOURED[-1])
        is_slender = scaled.groups.ellipticity >= SLENDER_RATIO_OF_NODES
        return options.on_points(nodes, (nodes - 1) // 2 + 1 if is_slender else nodes)
    nodes = expected_points(
        scaled.entering,
        domain,
        options.target,
        is_coupled=scaled.problem.is_coupled,
        least=least,
        film=film_to_resolve(scaled),
        extrapolate=bool(options.extrapolate),
    )
    if scaled.problem.contact.length is not None:
        return options.on_points(nodes, max((nodes - 1) // 2, LEAST_ROWS) + 1)
    return options.on_points(nodes, 1 if is_line else nodes)


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


def domain_of(scaled: ScaledProblem, options: Options) -> Domain:
    """Return the domain of a solve: the stated or the chosen one.

    Parameters
    ----------
    scaled : ScaledProblem
        Contact for which a domain is chosen.
    options : Options
        ``options.domain`` is a `Domain`, or "auto" to choose one for the error to reach.
    """
    if isinstance(options.domain, Domain):
        return options.domain
    return _in_time(scaled, chosen_domain(scaled, error_of_domain(scaled, options)))


def _in_time(scaled: ScaledProblem, domain: Domain) -> Domain:
    """Return a domain of all moments of a run whose radius changes, or whose entrainment turns."""
    if not {"radius", "entrainment_speed"} & set(courses_of(scaled.problem)):
        return domain
    moments = moments_of(scaled.problem, duration_of(scaled))
    power = 0.5 if scaled.groups.shape is LINE else 1.0 / 3.0
    wider = max(1.0, *((one.load / one.curvature) ** power for one in moments))
    inlet, outlet = (wider * edge for edge in domain.x)
    if min(one.speed for one in moments) < 0.0:
        outlet = max(-inlet, outlet)
    y = domain.y if scaled.groups.shape is LINE else tuple(wider * edge for edge in domain.y)
    return Domain.model_construct(x=(-outlet if outlet > -inlet else inlet, outlet), y=y)


def error_of_domain(scaled: ScaledProblem, options: Options) -> float:
    """Return the relative error of the film for which the domain is chosen [-].

    Parameters
    ----------
    scaled : ScaledProblem
        Decides whether the film is extrapolated, see :func:`settled`.
    options : Options
        With the error to reach; an extrapolated film leaves only a part of it to the domain.
    """
    options = settled(scaled.problem, options)
    return options.target * (EXTRAPOLATED_DOMAIN if options.extrapolate else 1.0)


def chosen_domain(scaled: ScaledProblem, error: float) -> Domain:
    """Return the recommended domain, wider where bodies still warm or cool the oil that enters.

    That of a starved contact contains all of its film: the pressure on its edges is zero.
    Asperities that touch lie within it.

    Parameters
    ----------
    scaled : ScaledProblem
        Contact with its supply, asperities and temperatures.
    error : float
        Relative error of the film due to the edges [-].
    """
    if scaled.problem.asperities is not None:
        return _around_asperities(scaled, _of_film(scaled, error))
    return _of_film(scaled, error)


def _around_asperities(scaled: ScaledProblem, domain: Domain) -> Domain:
    """Return a domain on whose edges the asperities are `SEPARATION_WITHOUT_CONTACT`."""
    groups, sigma = scaled.groups, scaled.problem.asperity_rms / scaled.scales.film_thickness
    along = math.sqrt(1.0 + 2.0 * EDGE_GAP_MARGIN * SEPARATION_WITHOUT_CONTACT * sigma)
    across = along / math.sqrt(groups.shape.across) if groups.shape.across else 0.0
    inlet = max(-domain.x[0], along)
    outlet, side = max(domain.x[1], OUTLET * inlet, along), max(domain.y[1], across)
    x, side = math.ceil(10.0 * max(inlet, outlet / OUTLET)) / 10.0, math.ceil(10.0 * side) / 10.0
    return Domain.model_construct(x=(-x, OUTLET * x), y=(-side, side))


def _of_film(scaled: ScaledProblem, error: float) -> Domain:
    """Return the domain of `chosen_domain` without asperities."""
    if is_starved(scaled):
        return starved_domain(scaled)
    least = domain = recommended_domain(scaled.entering, error)
    factor = 1.0
    while factor < LARGEST_DOMAIN_FACTOR and entry_error(scaled, domain) > ENTRY_PART * error:
        factor = min(DOMAIN_STEP * factor, LARGEST_DOMAIN_FACTOR)
        x, y = ((factor * low, factor * high) for low, high in (least.x, least.y))
        is_line = scaled.problem.contact.is_line
        domain = Domain.model_construct(x=x, y=LINE_WIDTH if is_line else y)
    return domain
