"""History of heated surfaces in transient runs: exponentials that move with the surface.

Equation and weights in `tehl.operators.trail`.
"""

from typing import NamedTuple

from tehl.base.typing import Array
from tehl.kernels.compiled import helper, kernel
from tehl.kernels.raw import raw


class Lag(NamedTuple):
    """Weights of three time levels, the first of which is ``first`` steps ago."""

    first: int
    now: float
    before: float
    older: float


class Weights(NamedTuple):
    """Weights of `tehl.operators.line_source.History`, all over one mesh width."""

    next_: float
    decay: Array
    older: Array
    newer: Array


class Shift(NamedTuple):
    """Cubic interpolation along x: of node i by the nodes ``i + first + k step``, k = 0 to 3."""

    first: int
    step: int
    weights: tuple[float, float, float, float]


@kernel
def carry(
    modes: Array, fluxes: Array, weights: Weights, lags: tuple[Lag, Lag], past: Array
) -> None:
    """Fill the exponentials of this time level, and ``past``: the rise by the flux upstream.

    ``modes`` (3, nx, m, ny) and ``fluxes`` (5, nx, ny) have the present first; the two ``lags``
    are those of one and two mesh widths upstream. ``past`` (nx, ny).
    """
    modes, fluxes, weights, past = raw((modes, fluxes, weights, past))
    _, nx, count, ny = modes.shape
    one, two = lags
    for j in range(ny):
        past[0, j] = 0.0
        for m in range(count):
            modes[0, 0, m, j] = 0.0
    for i in range(1, nx):
        for j in range(ny):
            q = one.now * fluxes[one.first, i - 1, j]
            q += one.before * fluxes[one.first + 1, i - 1, j]
            q += one.older * fluxes[one.first + 2, i - 1, j]
            past[i, j] = weights.next_ * q
        for m in range(count):
            decay, newer = weights.decay[m], weights.newer[m]
            older = weights.older[m] if i > 1 else 0.0
            back = i - 2 if i > 1 else 0
            for j in range(ny):
                q = one.now * fluxes[one.first, i - 1, j]
                q += one.before * fluxes[one.first + 1, i - 1, j]
                q += one.older * fluxes[one.first + 2, i - 1, j]
                r = two.now * fluxes[two.first, back, j]
                r += two.before * fluxes[two.first + 1, back, j]
                r += two.older * fluxes[two.first + 2, back, j]
                mode = one.now * modes[one.first, i - 1, m, j]
                mode += one.before * modes[one.first + 1, i - 1, m, j]
                mode += one.older * modes[one.first + 2, i - 1, m, j]
                mode = decay * mode + older * r + newer * q
                modes[0, i, m, j] = mode
                past[i, j] += mode


@helper
def _shifted(line: Array, shift: Shift, out: Array, at: tuple[int, int, int]) -> None:
    """Write the first row of ``line`` where it was to a row of ``out``; constant beyond edges."""
    k, m, j = at
    nx, first, step = line.shape[1], shift.first, shift.step
    one, two, three, four = shift.weights
    last = first + 3 * step
    begin, end = max(0, -min(first, last)), nx - max(0, first, last)
    for i in range(begin, end):
        n = i + first
        value = one * line[0, n] + two * line[0, n + step]
        out[k, m, j, i] = value + (three * line[0, n + 2 * step] + four * line[0, n + 3 * step])
    for side in range(2):
        for i in range(0 if side == 0 else max(begin, end), min(begin, nx) if side == 0 else nx):
            value = 0.0
            for c in range(4):
                n = min(max(i + first + c * step, 0), nx - 1)
                value += shift.weights[c] * line[0, n]
            out[k, m, j, i] = value


@kernel
def carry_varying(
    modes: Array, fluxes: Array, weights: Weights, shift: Shift, line: Array, past: Array
) -> None:
    """Move the exponentials of time by a step, and fill ``past``: the rise by what came before.

    ``modes`` (2, m, ny, nx) and ``fluxes`` (3, 1, ny, nx) have the present first; ``line`` (1, nx)
    is scratch, ``past`` (ny, nx).
    """
    modes, fluxes, weights, line, past = raw((modes, fluxes, weights, line, past))
    _, count, ny, nx = modes.shape
    for j in range(ny):
        for i in range(nx):
            line[0, i] = fluxes[1, 0, j, i]
        _shifted(line, shift, fluxes, (0, 0, j))
        for i in range(nx):
            past[j, i] = weights.next_ * fluxes[0, 0, j, i]
        for m in range(count):
            decay, older, newer = weights.decay[m], weights.older[m], weights.newer[m]
            for i in range(nx):
                taken = older * fluxes[2, 0, j, i] + newer * fluxes[1, 0, j, i]
                line[0, i] = decay * modes[1, m, j, i] + taken
            _shifted(line, shift, modes, (0, m, j))
            for i in range(nx):
                past[j, i] += modes[0, m, j, i]
