"""Estimated errors of a film from the grids of full multigrid, without further solves.

Full multigrid has solved the coarser grids anyway: the discretisation error follows from the
difference of two grids (docs/theory/numerics.md on stopping and errors).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

from tehl.result.bars import ErrorEstimate
from tehl.solver.judging.convergence import GridTrace
from tehl.solver.judging.richardson import (
    SECOND_BEFORE,
    discretisation_bar,
    first_order_bar,
)
from tehl.solver.judging.value_errors import FILM, further_errors, limit_bars

ROUGH_PART = 0.7
"""Error over the last change of the film between grids that resolve the heights: a third if of
second order; measured up to 0.65 for the minimum film between waves (87 of them, 257 and 513
nodes)."""
LINE_MINIMUM = 2.0
"""Factor on the bar of the minimum of a line contact with a wedge of third order: without it 95 %
of 120 random films lie inside, as judged on 8193 and 16385 nodes, with it 97 %. On that of a roller
where the last change is small, as all of a larger one is enough: with uniform lines up to
`LARGEST_THIRD_CHANGE`, with crowded ones up to `SMALL_AT_ENDS`."""
SMALL_AT_ENDS, PART_AT_ENDS = 0.01, 0.7
"""Relative change of the minimum of a roller whose lines crowd, up to which all of it and more is
its bar, and its bar over a larger one if three grids are compared: on 257 x 129 and 513 x 257 nodes
films of 35 rollers err by up to 0.56 of it, as judged on 1025 x 513, and one at a sharp end, which
has no limit, by 0.77."""
COARSE_ENDS = 0.2
"""Relative change of the minimum of a roller below which its bar is at least that change: of 21
rollers with profiles (M = 5 to 100) on 513 x 257 and coarser nodes it errs by up to 0.7 of that,
as judged on 1025 x 513. Grids that are coarse for its ends converge faster: by 0.06 of the change
of 66 % on 129 x 65."""
THIRD_PART, THIRD_BEFORE = 0.6, 8.0
"""The same of a wedge of third order, and change before over the last one beyond which two grids
agree by chance: coarse grids converge faster than by second order."""
THIRD_CHANGE, LARGEST_THIRD_CHANGE = 0.25, 0.05
"""Part of the last change with a wedge of third order, which leaves a seventh, that a bar exceeds
only up to the largest to expect, and largest change for that: all films of 63 contacts with M = 4
to 23,000 lie inside on the first grid that reaches 1 %, as judged on grids twice or four times as
fine, with 0.8 of their bar at most; with 0.6 of the change alone 25 of 66 needed a finer grid."""
LEAST_CENTRAL, LEAST_MINIMUM, LEAST_COMBINED = 0.3, 0.6, 0.1
"""Least bars of central, minimum and combined films over those to expect: of 29 contacts on the
first grid that reaches 1 %, judged on grids two to four times as fine, 1 minimum lies outside its
bar, by a seventh; without them 4, by up to 13 bars."""
AGREED, AGREED_ON_TWO, LEAST_OF_SCARCE = (0.15, 1.6), 3.0, 0.003
"""Parts of the last two changes, or of that of two grids, and least bar, beyond which a film of
scarce oil needs no bar to expect: errors of second and of third order leave a third of them, and
the oil that enters fixes most of the film. Of 106 such films of 53 contacts two lie outside, both
with lobes between the lines, which have bars of their own."""
SMOOTH_PART, WAVE_PART = 1.7, 20.0
"""Factors of the two terms of `single_grid_estimate`."""
Thinnest = Literal["anywhere", "sides", "exit"]
COMBINED = ("discretisation_central", "discretisation_minimum")
"""Bars of the measured values `FILM`."""
PART_CENTRAL, PART_MINIMUM = 0.7, 1.0
"""Error of an extrapolated film over its last change: with them and `LEAST_EXTRAPOLATED_BAR` 84 of
85 central and 69 of 70 minimum films of random contacts lie inside their bars, as judged on finer
grids."""
LEAST_EXTRAPOLATED_BAR, LARGEST_EXTRAPOLATED_BAR = 4.0, 0.4
"""Least bar of an extrapolated film over its error without extrapolation: over the relative change
of the film by the last grid, and largest value."""
LEAST_RATIO, MOST_RATIO, SMALL_CHANGE = 2.8, 6.0, 1e-3
"""Ratio of two changes of the film that shows second order (1.5 to 2.6), and relative change that
is negligible."""
MOST_UNSETTLED = 0.5
"""Iteration error of the first of three grids over its change to the next one, below which they may
show an order: few cycles are spent on a coarse grid."""
LARGEST_FIRST_BAR = 0.14
"""Bar to expect of the first of three grids, with a wedge of third order, above which it does not
resolve the film and the three show an order by chance: the extrapolated minimum film of an inner
ring (M = 35,000, heated; 0.26 on 65 x 33 nodes) errs by 1.2 %, three of its bars; that of another
(M = 16,300; 0.16 on 81 x 81 nodes) by 0.9 %."""
PART_AT_SIDES, GROWTH_AT_SIDES = 0.22, 0.13
"""Error over the last change of a film that a wedge of third order makes thinnest at the sides of a
wide contact, extrapolated from two grids, and largest growth for that. With a_y/a_x = 1 the minimum
errs by up to 0.21 of it (14 rigs, M = 1,700 to 10,000), the central film by 0.06."""
LARGEST_CHANGE_OF_FILM = 0.3
"""Relative change of the film by the last grid up to which it is extrapolated."""
SHARED = 0.25
"""Part of the change of the central film below which the error of the minimum is not estimated: two
coarse grids may agree on a thin minimum by chance."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmTraits:
    """What of a film, beside the grids it is solved on, its error bars depend on."""

    order: int = 2
    """Order of the wedge, 1 to 3."""
    kind: str = "point"
    """Type of the contact: the minimum of a line follows the spike, that of a roller its ends."""
    thinnest: Thinnest = "anywhere"
    """Where a heavily loaded film is: at sides of wide contacts, at the exit of slender ones."""
    rough: bool = False
    """Whether the grids carry heights of rough surfaces."""
    crowded: bool = False
    """Whether the lines of a roller crowd at its ends."""
    scarce: bool = False
    """Whether oil is scarce, so that three grids that agree need no bar to expect."""
    newtonian: bool = False
    """Whether the film is isothermal and Newtonian: then its traction has no bar where the spike is
    not resolved."""
    sliding: float = 0.0
    """Slide-to-roll ratio, not negative [-]."""
    least: float = 0.0
    """Bar that the contact and the mesh width lead to expect: less than a part of it is chance."""
    most: float = math.inf
    """The largest bar to expect, unless a part of the last change is larger."""


def error_estimate(
    traces: list[GridTrace],
    traits: FilmTraits,
    domain: float = 0.0,
    *,
    extrapolate: bool = False,
) -> ErrorEstimate:
    """Estimate the relative errors of the film on the last of two or more grids.

    Parameters
    ----------
    traces : list of GridTrace
        Grids halved each time, coarsest first.
    traits : FilmTraits
        What is known of the film.
    domain : float
        Relative error from the edges of the domain [-].
    extrapolate : bool
        Whether the last two grids are combined if they show the order.
    """
    order, kind, least, scarce = traits.order, traits.kind, traits.least, traits.scarce
    rough, thinnest = traits.rough, traits.thinnest
    bars: list[float] = []
    changes: list[float] = []
    otherwise = ROUGH_PART if rough else THIRD_PART if order > 2 else 1.0
    for name in ("central", "minimum"):
        values = _films(traces[-3:], name)
        film = abs(values[-1]) or 1.0
        before = THIRD_BEFORE if order > 2 and kind != "line" else SECOND_BEFORE
        bar = (
            discretisation_bar(values, otherwise, before) if order > 1 else first_order_bar(values)
        )
        changes.append(abs(values[-1] - values[-2]))
        if rough and changes[-1] > film:  # far from the limit
            bar = changes[-1]
        if name == "minimum":
            bar = _of_minimum(bar, values, traits, between=_between(traces))
        floor = least * (LEAST_MINIMUM if name == "minimum" else LEAST_CENTRAL)
        shared = 0.0 if traits.crowded else SHARED  # the ends do not follow the middle
        bar = max(bar, shared * changes[0]) / film
        bar = min(bar, _largest_bar(changes[-1] / film, traits.most))
        bars.append(max(bar, min(floor, _agreed(values)) if scarce else floor))
    estimate = _estimate(traces[-1], domain, *bars)
    named = dict(zip(COMBINED, bars, strict=True))
    doubtful = thinnest == "exit"
    combined: Any = extrapolated_bars(traces, order, least, doubtful) if extrapolate else None
    if extrapolate and thinnest == "sides" and order > 2:
        combined = _of_two_grids(traces, {**named, **(combined or {})}, scarce) or combined
    if combined and (order < 3 or max({**named, **combined}.values()) < max(bars)):
        combined = {key: max(bar, LEAST_COMBINED * least) for key, bar in combined.items()}
        estimate = replace(estimate, extrapolated=True, **combined)
    if not traces[-1].measured:  # its cycles have not ended
        return estimate
    part = ROUGH_PART if rough else 1.0
    found = further_errors(traces, part, domain, estimate.central, traits.sliding)
    resolved = limit_bars(
        found, traces, estimate.central, newtonian=traits.newtonian, sliding=traits.sliding
    )
    return replace(estimate, bars=found, spike_resolved=resolved)


def _agreed(values: list[float]) -> float:
    """Return the relative bar of a film of scarce oil by the agreement of its grids."""
    parts = AGREED if len(values) > 2 else (AGREED_ON_TWO,)
    changes = (after - before for before, after in pairwise(values))
    left = sum(part * abs(change) for part, change in zip(parts, changes, strict=True))
    return max(left / abs(values[-1]), LEAST_OF_SCARCE)


def _largest_bar(change: float, most: float) -> float:
    """Return the largest bar of a film by its relative change and the largest bar to expect."""
    return max(most, THIRD_CHANGE * change) if change < LARGEST_THIRD_CHANGE else math.inf


def _of_minimum(bar: float, values: list[float], traits: FilmTraits, *, between: bool) -> float:
    """Return the bar of the minimum of a line or a roller by its last change; else ``bar``.

    ``values`` are the minima of the grids, ``between``: between their nodes.
    """
    change, film = abs(values[-1] - values[-2]), abs(values[-1]) or 1.0
    doubles, part = traits.kind == "line" and traits.order > 2, 1.0
    if traits.crowded:
        doubles = change < SMALL_AT_ENDS * film
        part = PART_AT_ENDS if len(values) > 2 else 1.0
    elif traits.kind == "roller":
        doubles = traits.order > 2 and not between and change < LARGEST_THIRD_CHANGE * film
    if doubles or traits.kind != "roller":
        return LINE_MINIMUM * bar if doubles else bar
    return max(bar, part * change) if change < COARSE_ENDS * film else bar


def _films(traces: list[GridTrace], name: str) -> list[float]:
    """Return the central or minimum film of some grids, between the nodes where that is known."""
    if _between(traces):
        return [trace.measured[f"film_{name}"] for trace in traces]
    return [getattr(trace, name).values[-1] for trace in traces]


def _between(traces: list[GridTrace]) -> bool:
    """Return whether the films of the last three grids are known between the nodes."""
    return all(FILM[1] in trace.measured for trace in traces[-3:])


def extrapolated_bars(
    traces: list[GridTrace], order: int = 2, least: float = 0.0, doubtful: bool = False
) -> dict[str, float] | None:
    """Return the relative error bars of a film extrapolated from the last two grids.

    A part of the change of the extrapolated value from the pair of grids before, at least a part of
    the error without extrapolation: the smaller that is, the smaller is what is left of it. None if
    fewer than three grids are known, or they are far from their limit.

    Parameters
    ----------
    traces : list of GridTrace
        Grids halved each time, coarsest first.
    order : {2, 3}
        Order of the wedge. Where it is three, what is left is of second order where other parts of
        the equations err more: the changes must show it, or be negligible. Where they are, the bar
        stays that without extrapolation.
    least : float
        As of `FilmTraits`; it is of second order.
    doubtful : bool
        Whether all that is added to the minimum may be its error: thin films of third order at the
        exit show another by chance; two (M = 14,100 and 17,100) are off by 0.9 %, 0.2 % without.
    """
    known = [trace.measured for trace in traces[-3:] if trace.measured]
    if len(known) < 3 or traces[-2].outputs is None or 16.0 * least > LARGEST_FIRST_BAR:
        return None
    found = {}
    for key, name, part in zip(COMBINED, FILM, (PART_CENTRAL, PART_MINIMUM), strict=True):
        first, middle, last = (one[name] for one in known)
        change, film = abs(last - middle), last + (last - middle) / 3.0
        if not (last > 0.0 and change < LARGEST_CHANGE_OF_FILM * last):
            return None
        before = (middle - first) * math.copysign(1.0, last - middle)
        shown = LEAST_RATIO * change < before < MOST_RATIO * change
        shown = shown and _iteration_error(traces[-3], name) < MOST_UNSETTLED * before
        if order > 2 and not shown:
            if change < SMALL_CHANGE * last:  # two grids may agree by chance
                continue
            return None
        further = abs(film - (middle + (middle - first) / 3.0))
        left = min(LARGEST_EXTRAPOLATED_BAR, LEAST_EXTRAPOLATED_BAR * change / film)
        left = (1.0 if doubtful and order > 2 and name == FILM[1] else left) * change / 3.0
        found[key] = max(part * further, left) / film
    return found


def _of_two_grids(
    traces: list[GridTrace], known: Mapping[str, float], scarce: bool
) -> dict[str, float] | None:
    """Return bars of a film at the sides by two grids, at most ``known``; None if films shrink.

    The central film of scarce oil may, as most of it is the oil that enters.
    """
    measured = [one.measured for one in traces[-2:]]
    if traces[-2].outputs is None or not all(measured):
        return None
    found = dict(known)
    for key, name in zip(COMBINED, FILM, strict=True):
        middle, last = (one[name] for one in measured)
        change = (last - middle) / last if last > 0.0 else math.inf
        if scarce and name == FILM[0] and abs(change) < GROWTH_AT_SIDES * SHARED:
            found[key] = known[key] + abs(change) / 3.0
        elif 0.0 < change < GROWTH_AT_SIDES:
            found[key] = min(known[key], PART_AT_SIDES * change)
        else:
            return None
    return found


def _iteration_error(trace: GridTrace, name: str) -> float:
    """Return the iteration error of ``film_central`` or ``film_minimum`` [-]."""
    numbers = trace.central if name == FILM[0] else trace.minimum
    return numbers.iteration_error() if trace.reports else 0.0


def single_grid_estimate(
    trace: GridTrace, mesh_width: float, points: float, amplitude: float, domain: float = 0.0
) -> ErrorEstimate:
    """Estimate the relative errors of the film if no coarser grid resolves the heights.

    By a rule, 1.7 h^2 / H^1.2 of the smooth film plus 20 A / (H n^2) of the waves. For ten waves
    (lengths 0.25 and 0.5, M = 57 to 500) the change of the minimum film from 257 to 513 nodes was a
    third to one and a half times the second term, mostly less than it.

    Parameters
    ----------
    trace : GridTrace
        Cycles on the grid, with its central film.
    mesh_width : float
        h, in Hertz half-widths.
    points : float
        n, nodes per shortest wavelength.
    amplitude : float
        A, half the range of the heights [-].
    domain : float
        Relative error from the edges of the domain [-].
    """
    bars = []
    for numbers in (trace.central, trace.minimum):
        film = abs(numbers.values[-1]) or 1.0
        smooth = SMOOTH_PART * mesh_width**2 / film**1.2
        bars.append(float(smooth + WAVE_PART * amplitude / film / points**2))
    return _estimate(trace, domain, *bars)


def _estimate(trace: GridTrace, domain: float, central: float, minimum: float) -> ErrorEstimate:
    """Return relative errors by domain and mesh together with the iteration errors of a trace."""
    iteration = [
        numbers.iteration_error() / (abs(numbers.values[-1]) or 1.0)
        for numbers in (trace.central, trace.minimum)
    ]
    return ErrorEstimate(
        discretisation_central=central,
        discretisation_minimum=minimum,
        iteration_central=iteration[0],
        iteration_minimum=iteration[1],
        domain=domain,
    )
