"""History of heated surfaces in transient runs: exponentials that move with the surface.

Equation and weights in `tehl.operators.trail`.
"""

from typing import NamedTuple

from tehl.base.typing import Array
from tehl.kernels.compiled import kernel
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
