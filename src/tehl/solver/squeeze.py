"""The mass that moves and the mass that is there: what the first says too much of the squeeze."""

import numpy as np

from tehl.operators.reynolds import steady_wedge, upstream
from tehl.typing import Array


class Squeeze:
    """Takes dq/dt off the derivative of rho* H along the mean motion, q = (rho* - rho_e) H.

    With it the steps solve

        d(rho* H)/dx + d(rho_e H)/dt = Poiseuille flow,

    though wedge and squeeze are discretised together, as one derivative of rho* H. Where layers of
    the film are stiffer than others, what it lets in moves at rho*/rho_e of the mean speed.

    The derivative is backward of order two. In time, at its place, it is stable where the film is
    slower than the mean motion (q < 0): for what overtakes it, dq/dt is the derivative along the
    motion less that along x, upstream.

    Parameters
    ----------
    mass : (ny, nx) array
        rho* H of the steady film [-].
    excess : (ny, nx) array or None
        (rho* - rho_e)/rho*; None where there is none ever.
    step : (float, float, int)
        Step of time [a_x / u_m], mesh width along x [a_x], and mesh widths per step.
    wedge_order : int
        Order of the upstream difference along x.
    """

    def __init__(
        self, mass: Array, excess: Array | None, step: tuple[float, float, int], wedge_order: int
    ) -> None:
        (self.time_step, self.spacing, self.stride), self.wedge_order = step, wedge_order
        self.steady = mass[:0] if excess is None else excess * mass
        self.past = np.stack([self.steady, self.steady])
        self.now, self.rate = self.steady, np.zeros_like(self.steady)

    def onward(self) -> Array | float:
        """Return the rate to begin a step with: q goes on along a straight line in time."""
        if not len(self.steady):
            return 0.0
        self.now = 2.0 * self.past[0] - self.past[1]
        self.rate = self._rate(self.now)
        return self.rate

    def follow(self, excess: Array) -> Array:
        """Take q of the present film, (ny, nx); return by how much the rate changes."""
        rate = self._rate(excess)
        more = rate - self.rate
        self.now, self.rate = excess, rate
        return more

    def advance(self) -> None:
        """Let the present be the past of the next step."""
        self.past[1] = self.past[0]
        self.past[0] = self.now

    def _rate(self, now: Array) -> Array:
        """Return dq/dt with the present q."""
        last, before = self.past
        slow = 1.5 * _part(now, -1) - 2.0 * _part(last, -1) + 0.5 * _part(before, -1)
        start = _part(self.steady, 1)  # whose wedge is that of the steady film
        now, last, before = (_part(q, 1) - start for q in (now, last, before))
        fast = 1.5 * now - 2.0 * upstream(last, self.stride)
        fast += 0.5 * upstream(before, 2 * self.stride)
        along = steady_wedge(now, self.spacing, self.wedge_order)
        return (slow + fast) / self.time_step - along


def _part(excess: Array, sign: int) -> Array:
    """Return what has a sign of it."""
    return np.maximum(excess, 0.0) if sign > 0 else np.minimum(excess, 0.0)
