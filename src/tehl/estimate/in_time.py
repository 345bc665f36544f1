"""What a transient run asks of its grid: to follow what changes, and its film at each moment."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tehl.contact.moment import SAMPLES, Moment, courses_of, frozen, moments_of
from tehl.contact.options import Domain
from tehl.estimate.duration import duration_of, steps_of_courses
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.summits import shared_load

PART_IN_STEP = 0.25
"""Part of the error to reach by which a load, a speed or a radius may be off a straight line within
a time step."""
EVERY, FAST = SAMPLES // 8, 0.5
"""Of the sampled moments those for whose film nodes are planned; and of points, whose bars are all
that is known, the least speed of such a moment over the largest."""

Posed = tuple[ScaledProblem, Domain]
"""A steady contact, and the domain of its run in its own half-widths."""


def nodes_of_courses(scaled: ScaledProblem, domain: Domain, error: float) -> float:
    """Return the nodes along x with which time steps follow what changes in a run; 0 if nothing.

    A step is that in which the mean motion moves by ``stride`` mesh widths.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        The contact, and its edges [a_x].
    error : float
        To reach, of which a step may miss `PART_IN_STEP` of a load, a speed or a radius [-].
    """
    transient, scales = scaled.problem.transient, scaled.scales
    steps = steps_of_courses(scaled, PART_IN_STEP * error)
    if transient is None or steps == 0:
        return 0.0
    way = duration_of(scaled) * scales.speed / scales.half_width_x
    return steps * transient.stride * (domain.x[1] - domain.x[0]) / way


def films_of_run(scaled: ScaledProblem, domain: Domain) -> list[Posed]:
    """Return the steady contacts whose films the grid of a run resolves, that of its start first.

    A smaller contact has fewer nodes, and the film of a slower one is thinner: that which came in
    at the largest speed within a half-width of way, so that a motion that turns does not stop. A
    line has the slowest of these too.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        The contact, and the edges of its run. Without anything that changes they are all.
    """
    if not courses_of(scaled.problem):
        return [(scaled, domain)]
    moments = moments_of(scaled.problem, duration_of(scaled))
    if scaled.problem.contact.is_line:
        entered = _entered(scaled, moments)
        slowest = min(range(len(moments)), key=lambda n: entered[n].speed)
        chosen = [moments[0], *entered[EVERY::EVERY], entered[slowest]]
    else:
        fast = FAST * max(one.speed for one in moments[::EVERY])
        chosen = [moments[0], *(one for one in moments[EVERY::EVERY] if one.speed > fast)]
    if not all(one.is_possible and one.speed > 0.0 for one in chosen):  # schedules refuse it
        return [(scaled, domain)]
    return [one for one in films_of(scaled, domain, chosen) if one is not None]


def _entered(scaled: ScaledProblem, moments: Sequence[Moment]) -> list[Moment]:
    """Return sampled moments with the largest speed at which oil came in within a half-width."""
    speeds = np.abs([one.speed for one in moments])
    pace = duration_of(scaled) / (len(moments) - 1) * scaled.scales.speed
    way = np.cumsum(speeds) * pace / scaled.scales.half_width_x
    since = np.searchsorted(way, way - 1.0)
    return [
        replace(one, speed=float(speeds[first : n + 1].max()))
        for n, (one, first) in enumerate(zip(moments, since.tolist(), strict=True))
    ]


def films_of(
    scaled: ScaledProblem, domain: Domain, moments: Sequence[Moment]
) -> list[Posed | None]:
    """Return the steady contacts of some moments; None where there is none.

    Parameters
    ----------
    scaled, domain, moments : ScaledProblem, Domain, sequence of Moment
        The contact, the edges of its run, and the moments.
    """
    return [
        _posed(scaled, ScaledProblem.of(frozen(scaled.problem, one)), domain)
        if one.is_possible and one.speed > 0.0
        else None
        for one in moments
    ]


def first_gap(scaled: ScaledProblem) -> float:
    """Return the gap to expect in the middle at the start of a run, or of a steady contact [-].

    Parameters
    ----------
    scaled : ScaledProblem
        Its moment is that of the start. A cam whose contact is stated at the nose has ten times its
        film on the flank.
    """
    own = _own(scaled)
    return shared_load(own).gap * own.scales.film_thickness / scaled.scales.film_thickness


def at_start(scaled: ScaledProblem, domain: Domain) -> Posed:
    """Return the steady contact of the start of a run, and the domain in its half-widths.

    Parameters
    ----------
    scaled, domain : ScaledProblem, Domain
        A contact, steady or not, and edges in its half-widths.
    """
    own = _own(scaled)
    return (scaled, domain) if own is scaled else _posed(scaled, own, domain)


def _own(scaled: ScaledProblem) -> ScaledProblem:
    """Return the steady contact of the moment of a contact; itself where nothing changes."""
    moment = scaled.moment
    if not (courses_of(scaled.problem) and moment.is_possible and moment.speed > 0.0):
        return scaled
    return ScaledProblem.of(frozen(scaled.problem, moment))


def _posed(stated: ScaledProblem, own: ScaledProblem, domain: Domain) -> Posed:
    """Return a steady contact with a domain that is stated in other half-widths."""
    across, along = (
        getattr(stated.scales, key) / getattr(own.scales, key)
        for key in ("half_width_y", "half_width_x")
    )
    x, y = (
        (factor * edges[0], factor * edges[1])
        for factor, edges in ((along, domain.x), (across, domain.y))
    )
    return own, Domain.model_construct(x=x, y=y)
