"""Size of the domain and number of nodes, proposed from the dimensionless groups."""

import math
from dataclasses import replace

import numpy as np

from tehl.contact.moment import courses_of, moments_of
from tehl.contact.options import USUAL_PLAIN_ERROR, Domain, Options
from tehl.contact.shape import Shape
from tehl.estimate.duration import duration_of
from tehl.estimate.entering import body_contrast, entry_error
from tehl.estimate.film_formulas import expected_central_film, moes_film_unit
from tehl.estimate.line import (
    FIELD_EDGE_ERROR,
    FIELD_EDGE_POWER,
    OUTLET,
    ZERO_EDGE_ERROR,
    line_domain,
)
from tehl.estimate.scaling import Groups, ScaledProblem
from tehl.estimate.settled import settled
from tehl.estimate.spin import left_by_spin, spun_domain
from tehl.estimate.starvation import is_starved, starved_domain

CAUTION = 2.0
"""Factor on the slope of the film formula by load, which is half of what wider domains show between
M = 2 and 5."""
LARGEST_DOMAIN_FACTOR, LONGEST_INLET = 2.5, 4.0
"""Largest factor on the domain because of the temperature of the bodies, and on the inlet alone
because of its heat."""
DOMAIN_STEP, ENTRY_PART = 1.05, 0.3
"""Steps of that factor, and part of the error of the domain that it leaves to the oil entering."""
INLET_HEAT_PART, STATED_HEAT_PART = 0.2, 0.5
"""Part of it that is left to the heat of the inlet of a point contact, which a longer inlet alone
makes smaller: 0.4 % of a film within 1 %; and of a film that is not extrapolated, whose nodes may
be stated and lie further apart for that: with 0.2 the inlet of a dimple (slide-to-roll ratio 2.5)
begins at -7.1 in place of -4.1, and the film falls by 4 % on 129 nodes, by 1 % on 513."""
THINNER_PART = 0.25
"""Part of it that is left to oil that shear thins upstream of the domain: 0.5 % of a film within
1 %. The bar of a ball on a disc (M = 2.3) is 2.6 % on the domain of oil that does not thin, where
it errs by 0.7 %, and 0.5 % on this one, where it errs by 0.02 %."""
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
FAR_FIELD, FAR_SIDES = 0.1, 0.03
"""Error by the far field over the cubed widths of the gap over the distances of the edges, and of
the sides of slender contacts."""
NEAR_INLET, NEAR_SIDES, ROUNDED = 0.026, 0.0055, 0.03
"""Error by the inlet edge over 2 H kappa / (d^4 + 0.03), with its distance d from the contact, and
by the sides over 2 H / kappa^2.5 / (d^4 + 0.03): 0.4 to 1 of it measured for M = 50 to 4000 and
kappa = 1 to 8."""
NEAR_PART, NEAREST_SIDE, NEAREST_OUTLET = 0.05, 1.4, 1.25
"""Part of the error of the domain that such edges leave each, and least distances of the sides and
of the outlet, where nearer ones change films of M = 50 and more by less than 0.001 %."""
OUTFLOW_ERROR, THICK_GAP_WIDTH, OUTLET_PLACES = 2.0, 1.5, 65
"""Error of a film at an angle by the pressure on the outlet edge, over that of the rigid gap there
times the cubed width of the gap; the width in half-widths from which a film is so thick; and the
places where that pressure is evaluated. Measured for M = 2 to 40, R_y/R_x = 2 and 6: 0.1 to 1 of
it, up to 0.7 % with an outlet at 1.2 widths."""
CENTRES = range(9, 14)
"""Intervals of 16 along x that lie upstream of the centre: it is a node of all grids."""
SEPARATION_WITHOUT_CONTACT, EDGE_GAP_MARGIN = 4.5, 1.3
"""Separation over sigma from which asperities carry less than 1e-4 of what they do in touch, and
margin on the gap at the edges."""
EXTRAPOLATED_DOMAIN = 2.0
"""Error for which the domain is chosen over the one to reach, of extrapolated films: the edges
leave a seventh of it (0.3 % of 2 %), and the mesh less than without extrapolation."""


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


def recommended_domain(
    groups: Groups, error: float = USUAL_PLAIN_ERROR, *, near: bool = False
) -> Domain:
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
    near : bool
        Whether the edges are as near as that error allows; else a contact of M = 200 and more has
        the same domain as one of M = 100.
    """
    along, across = gap_widths(groups)
    if groups.shape.as_line:
        return line_domain(along, error, groups.shape)
    larger = max(USUAL_PLAIN_ERROR / error, 1.0) ** (1.0 / 3.0)
    if near:
        inlet, side = (
            1.0 + max(factor / (NEAR_PART * error) - ROUNDED, 0.0) ** 0.25
            for factor in _near_factors(groups)
        )
        width = max(larger * SIDES[1] * across, side, NEAREST_SIDE)
        return _with_outlet(
            groups, _rectangle(max(larger * INLET[1] * along, inlet), NEAREST_OUTLET, width), error
        )
    wide = WIDE_INLET[0] * max(groups.ellipticity, 1.0) ** WIDE_INLET[1]
    inlet = larger * max(INLET[0], wide, INLET[1] * along)
    sides = SLENDER_SIDES if groups.ellipticity >= SLENDER else SIDES
    width = larger * max(sides[0], sides[1] * across)
    inlet, width = (math.ceil(10.0 * edge) / 10.0 for edge in (inlet, width))
    # not validated: a nearly rigid contact may need more than a stated domain may have
    domain = Domain.model_construct(x=(-inlet, OUTLET * inlet), y=(-width, width))
    return _with_outlet(groups, domain, error)


def _with_outlet(groups: Groups, domain: Domain, error: float) -> Domain:
    """Return a domain whose outlet edge leaves a part of the error, `NEAR_PART`."""
    outlet, side = domain.x[1], domain.y[1]
    while _outflow_error(groups, outlet, side) > NEAR_PART * error:
        outlet *= DOMAIN_STEP
    return domain if outlet == domain.x[1] else _rectangle(-domain.x[0], outlet, side)


def _outflow_error(groups: Groups, outlet: float, side: float) -> float:
    """Return the error of a film at an angle by the pressure on the outlet edge [-].

    Far from the contact  P ~ -(a X + b Y)/G^2  in the gap  G = (X, Y) Q (X, Y)',  with
    (a, b)' = (Q + 2 tr Q)^(-1) Q (1, 0)':  positive also downstream of the centre, at one side.

    Parameters
    ----------
    groups : Groups
        Its ``twist`` is zero where the pressure downstream is that of cavities.
    outlet, side : float
        Distances of the outlet and of the sides [half-widths].
    """
    if not groups.twist:
        return 0.0
    along, ratio, mixed = (
        gap_widths(groups)[0],
        groups.radius_ratio,
        groups.twist / groups.ellipticity,
    )
    trace = 2.0 * (1.0 + ratio)
    determinant = (1.0 + trace) * (ratio + trace) - mixed**2
    a, b = (ratio + trace - mixed**2) / determinant, trace * mixed / determinant
    y = groups.ellipticity * side * np.linspace(-1.0, 1.0, OUTLET_PLACES)
    gap = outlet**2 + 2.0 * mixed * outlet * y + ratio * y**2
    pressure = float(np.max(-(a * outlet + b * y) / gap**2))
    return OUTFLOW_ERROR * max(pressure, 0.0) * along**3 / (1.0 + (THICK_GAP_WIDTH / along) ** 4)


def _near_factors(groups: Groups) -> tuple[float, float]:
    """Return the errors by near edges, inlet and sides, times d^4 + `ROUNDED` [-]."""
    along, across = gap_widths(groups)
    slender = max(groups.ellipticity, 1.0)
    return NEAR_INLET * along**2 * slender, NEAR_SIDES * across**2 / slender**2.5


def _rectangle(inlet: float, outlet: float, side: float) -> Domain:
    """Return the smallest domain that reaches so far, whose centre is a node of all grids."""
    inlet, side = (math.ceil(10.0 * edge) / 10.0 for edge in (inlet, side))
    upstream = [(max(inlet, outlet * n / (16 - n)), n) for n in CENTRES]
    inlet, n = min(upstream, key=lambda one: 16.0 * one[0] / one[1])
    return Domain.model_construct(x=(-inlet, inlet * (16 - n) / n), y=(-side, side))


def far_field_error(groups: Groups, domain: Domain) -> float:
    """Estimate the relative error of the film on a domain with the far field on its edges.

    Measured for M = 1 to 4000 and a_y/a_x = 0.7 to 8, rounded up.

    Parameters
    ----------
    groups : Groups
        Moes numbers and ellipticity of the contact.
    domain : Domain
        Edges in Hertz half-widths.
    """
    along, across = gap_widths(groups)
    if groups.shape.as_line:
        return FIELD_EDGE_ERROR * (-along / domain.x[0]) ** FIELD_EDGE_POWER
    inlet, side = -domain.x[0], min(-domain.y[0], domain.y[1])
    part = FAR_SIDES if groups.ellipticity >= SLENDER else FAR_FIELD
    thick = FAR_FIELD * (along / inlet) ** 3 + part * (across / side) ** 3
    near = zip(_near_factors(groups), (inlet, side), strict=True)
    thick += _outflow_error(groups, domain.x[1], side)
    return thick + sum(factor / ((edge - 1.0) ** 4 + ROUNDED) for factor, edge in near)


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
        return ZERO_EDGE_ERROR * (-gap_widths(groups)[0] / domain.x[0]) ** 3
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


def thinner_error(scaled: ScaledProblem, domain: Domain) -> float:
    """Estimate the relative error of the film by oil that shear thins outside of the domain [-].

    The pressure on the edges is that of Newtonian oil. It is less by the part of its viscosity that
    the oil loses as it slides in the gap on the inlet edge, and all of it by `domain_error`.

    Parameters
    ----------
    scaled : ScaledProblem
        Contact with its sliding and shear law.
    domain : Domain
        Edges in Hertz half-widths.
    """
    shear, scales, moment = scaled.problem.lubricant.shear, scaled.scales, scaled.moment
    sliding = scales.speed * math.hypot(moment.sliding, moment.across)
    if shear.is_newtonian or not sliding:
        return 0.0
    gap = 0.5 * scales.film_thickness * (gap_widths(scaled.groups)[0] ** 2 + domain.x[0] ** 2)
    newtonian = scales.viscosity * sliding / gap
    kept = shear.thinned(newtonian, 0.0) / newtonian
    return (1.0 - kept) * domain_error(scaled.entering, domain)


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
    return _in_time(scaled, proposed_domain(scaled, options))


def proposed_domain(scaled: ScaledProblem, options: Options) -> Domain:
    """Return the domain for the error to reach, whatever the options state.

    Parameters
    ----------
    scaled : ScaledProblem
        Decides whether the film is extrapolated, see :func:`settled`.
    options : Options
        With the error to reach; the edges are as near as it allows where the film is extrapolated.
    """
    options = settled(scaled.problem, options)
    error = options.target * (EXTRAPOLATED_DOMAIN if options.extrapolate else 1.0)
    return chosen_domain(scaled, error, near=bool(options.extrapolate))


def _in_time(scaled: ScaledProblem, domain: Domain) -> Domain:
    """Return a domain of all moments of a run: the widest, and on both sides where motion turns."""
    if not {"load", "radius", "entrainment_speed"} & set(courses_of(scaled.problem)):
        return domain
    moments = moments_of(scaled.problem, duration_of(scaled))
    is_line = scaled.groups.shape.as_line
    power = 0.5 if is_line else 1.0 / 3.0
    possible = ((one.load / one.curvature) ** power for one in moments if one.is_possible)
    wider = max((1.0, *possible))
    inlet, outlet = (wider * edge for edge in domain.x)
    if min(one.speed for one in moments) < 0.0:
        outlet = max(-inlet, outlet)
    y = domain.y if is_line else tuple(wider * edge for edge in domain.y)
    return Domain.model_construct(x=(-outlet if outlet > -inlet else inlet, outlet), y=y)


def chosen_domain(scaled: ScaledProblem, error: float, *, near: bool = False) -> Domain:
    """Return the recommended domain, wider where bodies still warm or cool the oil that enters.

    That of a starved contact contains all of its film: the pressure on its edges is zero.
    Asperities that touch lie within it.

    Parameters
    ----------
    scaled : ScaledProblem
        Contact with its supply, asperities and temperatures.
    error : float
        Relative error of the film due to the edges [-].
    near : bool
        As in `recommended_domain`.
    """
    domain = _of_film(scaled, error, near=near)
    if scaled.problem.asperities is None:
        return domain
    return _around_asperities(scaled, domain, near=near)


def _around_asperities(scaled: ScaledProblem, domain: Domain, *, near: bool) -> Domain:
    """Return a domain on whose edges the asperities are `SEPARATION_WITHOUT_CONTACT`."""
    groups, sigma = scaled.groups, scaled.problem.asperity_rms / scaled.scales.film_thickness
    along = math.sqrt(1.0 + 2.0 * EDGE_GAP_MARGIN * SEPARATION_WITHOUT_CONTACT * sigma)
    across = along / math.sqrt(groups.shape.across) if groups.shape.across else 0.0
    if along <= min(-domain.x[0], domain.x[1]) and across <= domain.y[1]:
        return domain
    inlet, outlet = (max(abs(edge), along) for edge in domain.x)
    inlet = inlet if near else max(inlet, outlet / OUTLET)
    return _rectangle(inlet, outlet, max(domain.y[1], across))


def _of_film(scaled: ScaledProblem, error: float, *, near: bool) -> Domain:
    """Return the domain of `chosen_domain` without asperities."""
    if is_starved(scaled):
        return starved_domain(scaled)
    least = recommended_domain(left_by_spin(scaled), error, near=near)
    least = domain = spun_domain(scaled, least, error)
    factor, shape = 1.0, scaled.groups.shape
    while factor < LARGEST_DOMAIN_FACTOR and thinner_error(scaled, domain) > THINNER_PART * error:
        factor = min(DOMAIN_STEP * factor, LARGEST_DOMAIN_FACTOR)
        domain = _widened(least, factor, shape)
    least, factor = domain, 1.0
    is_heated = not shape.as_line and not body_contrast(scaled)
    heat_part = INLET_HEAT_PART if near else STATED_HEAT_PART
    left = (heat_part if is_heated else ENTRY_PART) * error
    most = LONGEST_INLET if is_heated else LARGEST_DOMAIN_FACTOR
    while factor < most and entry_error(scaled, domain) > left:
        factor = min(DOMAIN_STEP * factor, most)
        if is_heated:
            domain = _rectangle(-factor * least.x[0], least.x[1], least.y[1])
            continue
        domain = _widened(least, factor, shape)
    return domain


def _widened(domain: Domain, factor: float, shape: Shape) -> Domain:
    """Return a domain with all edges further away, but for the ends of lines and rollers."""
    x, y = ((factor * low, factor * high) for low, high in (domain.x, domain.y))
    return Domain.model_construct(x=x, y=shape.sides if shape.as_line else y)
