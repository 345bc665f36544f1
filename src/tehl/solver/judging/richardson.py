"""Richardson extrapolation and its error bars: of values, of histories and of fields.

Of second-order values on grids halved each time, f = f_h + (f_h - f_2h) / 3
(docs/theory/numerics.md on stopping and errors).
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from tehl.base.typing import Array
from tehl.result.bars import ORDERS, Estimate, shows_second_order

WEIGHT = 1.0 / 3.0
"""Of the difference of two grids of second order: 1 / (2^2 - 1)."""
SAFETY = 2.0
"""Factor on a discretisation error from three grids: the coarser ones are not fully converged."""
RESIDUE, LESS_REGULAR = 0.25, 1.0
"""Least error bar over the extrapolated change, of the film, and of what follows from it less
regularly: three grids may show second order by chance."""
SECOND_BEFORE = 4.0
"""Ratio of two changes of second order."""
GROWING = 2.0
"""Error bar over a change that is not smaller than the one before."""
SPIKE_GROWTH, UNRESOLVED_GROWTH, SLOWING = 2.0, 6.0, 0.7
"""Further growth of the pressure spike over its last change, where that is less than this part of
the one before, and where it is not."""


def observed_order(first: float, last: float) -> float | None:
    """Return the order that two changes on grids halved each time show; None if they do not."""
    return math.log2(first / last) if first * last > 0 else None


def estimate(values: tuple[float, ...], domain: float, residue: float = RESIDUE) -> Estimate:
    """Return the Richardson extrapolation of two or three grids with its error bar.

    If the grids show second order, the extrapolated value is h_3 + (h_3 - h_2)/3, and the bar its
    difference to that with the observed order, at least ``residue`` of (h_3 - h_2)/3. If not, the
    value is h_3, and the bar that of `_without_order`; of two grids |h_3 - h_2|. ``values`` are
    h_1, h_2, h_3 or h_2, h_3 on grids halved each time, and ``domain`` is the change by the larger
    domain.
    """
    last = values[-1] - values[-2]
    first = values[1] - values[0] if len(values) == 3 else 0.0
    order = observed_order(first, last)
    if last == 0.0:
        value, bar = values[-1], 0.0
    elif order is not None and shows_second_order(order):
        value = values[-1] + last / 3.0
        observed = values[-1] + last / (2.0**order - 1.0)
        bar = max(abs(observed - value), residue * abs(last) / 3.0)
    else:
        value, bar = values[-1], _without_order(first, last)
    return Estimate(
        value=value,
        uncertainty=math.hypot(bar, domain),
        discretisation=bar,
        domain=domain,
        observed_order=order,
        values=values,
    )


def _without_order(first: float, last: float) -> float:
    """Return the error bar of a value whose two last changes do not show second order.

    Of lower order, the change before covers all further ones from order 0.7 on; changes that grow
    or alternate may go on so, and a last change much smaller than the one before is chance.
    """
    alternates, first, last = first * last < 0.0, abs(first), abs(last)
    if first == 0.0:  # of two grids
        return last
    if alternates or last >= first:
        return GROWING * max(first, last) if last >= first else max(last, 0.25 * first)
    is_faster = last < first / 2.0 ** ORDERS[1]
    return max(last, 0.25 * first) if is_faster else first


def slows(values: list[float], part: float = SLOWING) -> bool:
    """Return whether the last change of three values is less than a part of the one before."""
    return len(values) == 3 and values[2] - values[1] < part * (values[1] - values[0])


def spike_reach(spike: float, excess: list[float], narrow: float = 0.0) -> float:
    """Return the pressure that the spike may have on finer grids [-].

    Its excess over Hertz may grow by as much on each finer grid (M = 75, L = 11: 0.17, 0.25, 0.34,
    0.45, 0.55 on 65 to 1025 nodes), until it is the largest pressure.

    Parameters
    ----------
    spike : float
        Its pressure on the finest grid [-].
    excess : list of float
        Its excess over Hertz on two or three grids halved each time [-].
    narrow : float
        By how much more it may rise because the mesh is too coarse for it [-].
    """
    further = SPIKE_GROWTH if slows(excess) else UNRESOLVED_GROWTH
    return spike + max(further * (excess[-1] - excess[-2]), narrow)


def with_growing_spike(highest: Estimate, reach: float) -> Estimate:
    """Widen the error bar of the largest pressure, or rise, to what it may become on finer grids.

    Parameters
    ----------
    highest : Estimate
        Estimate of the largest value.
    reach : float
        Value that the spike may have on finer grids.
    """
    bar = max(highest.discretisation, reach - highest.value)
    return replace(highest, discretisation=bar, uncertainty=math.hypot(bar, highest.domain))


def discretisation_bar(
    values: list[float], otherwise: float = 1.0, faster: float = SECOND_BEFORE
) -> float:
    """Return the error bar of the last of two or three values on grids halved each time.

    A third of the last change, times `SAFETY`, if the three values show second order;
    ``otherwise`` times the change if not, as coarse grids may be far from their limit. If that
    change is less than the one before over ``faster``, which second order would leave, two grids
    agree by chance, and this part counts.
    """
    change = abs(values[-1] - values[-2])
    if len(values) == 3 and min(values) > 0.3 * values[-1] > 0:
        before = abs(values[1] - values[0])
        ratio = (values[1] - values[0]) / (values[2] - values[1]) if change > 0 else math.inf
        if change < 0.3 * values[-1] and 3.0 <= ratio <= 5.6:  # 4 is second order
            return SAFETY * change / 3.0
        if before < 0.3 * values[-1]:
            return otherwise * max(change, before / faster)
    return otherwise * change


def first_order_bar(values: list[float]) -> float:
    """Return the error bar of a scheme with a first-order wedge: twice the largest change.

    Its errors of first and of second order have opposite signs and cancel on coarse grids, so that
    the last change alone may be too small.
    """
    return 2.0 * max(abs(b - a) for a, b in pairwise(values))


def grid_bar(series: list[Array]) -> Array:
    """Return the discretisation error bars of a history.

    They are the change between the last two grids, over 2^q - 1 if three grids show an order q near
    two (at most two) in the mean square over time. A quarter of the root mean square over time is
    added in quadrature, because changes pass through zero where errors need not. ``series`` are two
    or three arrays of values at the same times, coarse to fine.
    """
    bar, order = np.abs(series[-1] - series[-2]), order_of_history(series)
    if order is not None and shows_second_order(order):
        bar /= 2.0 ** min(order, 2.0) - 1.0
    return np.hypot(bar, RESIDUE * _mean(bar))


def order_of_history(series: list[Array]) -> float | None:
    """Return the order that three grids show in the mean square over time."""
    if len(series) < 3:
        return None
    return observed_order(_mean(series[1] - series[0]), _mean(series[2] - series[1]))


def _mean(values: Array) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def extrapolated_field(fine: Array, coarse: Array) -> Array:
    """Return an extrapolated field, (..., ny, nx); zeros remain, and what is never negative.

    ``coarse`` has half the columns, and half the lines or as many.
    """
    every = 1 if fine.shape[-2] == coarse.shape[-2] else 2
    shared = fine[..., ::every, ::2] - coarse
    change = np.empty_like(fine)
    change[..., ::every, ::2] = shared
    change[..., ::every, 1::2] = 0.5 * (shared[..., 1:] + shared[..., :-1])
    if every > 1:
        change[..., 1::2, :] = 0.5 * (change[..., 2::2, :] + change[..., :-1:2, :])
    found = fine + WEIGHT * change
    if fine.min() >= 0.0:
        np.maximum(found, 0.0, out=found)
        found[fine == 0.0] = 0.0
    return np.asarray(found)
