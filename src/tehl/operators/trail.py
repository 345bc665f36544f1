"""Surface temperature in transient runs: material points carry the heat that they took up.

Heat at x entered upstream, when the material was there (Carslaw and Jaeger 1959, section 10.7),

    T(x, t) - T_b = 1/sqrt(pi rho c k u_s) int q(s, t - (x - s)/u_s) / sqrt(x - s) ds,

so that the exponentials of `tehl.operators.line_source` move from node to node with a lag, the time
in which the surface moves by a mesh width. Between time levels they are interpolated to second
order.
"""

import numpy as np

from tehl.base.typing import Array
from tehl.kernels.energy import trail
from tehl.operators.line_source import history

LONGEST_LAG = 2.0
"""Most time steps in which a surface may move by a mesh width: earlier levels are not stored."""


class Trail:
    """History of one surface on one grid.

    Parameters
    ----------
    flux : (nx, ny) array
        Steady flux at the beginning, dimensionless.
    spacing : float
        Mesh width [a_x].
    lag : float
        Time steps in which the surface moves by a mesh width, at most `LONGEST_LAG`.
    """

    def __init__(self, flux: Array, spacing: float, lag: float) -> None:
        nx, ny = flux.shape
        weights = history(nx, spacing)
        self.weights = trail.Weights(*(weights.next_, weights.decay, weights.older, weights.newer))
        self.lags = (lag_of(lag, 0), lag_of(2.0 * lag, min(int(2.0 * lag), 2)))
        self.fluxes = np.repeat(flux[None], 5, axis=0)
        self.modes = np.zeros((3, nx, len(weights.decay), ny))
        self.past = np.zeros((nx, ny))
        steady = (trail.Lag(0, 1.0, 0.0, 0.0), trail.Lag(0, 1.0, 0.0, 0.0))
        trail.carry(self.modes, self.fluxes, self.weights, steady, self.past)
        self.modes[1:] = self.modes[0]

    def update(self, flux: Array) -> Array:
        """Return the rise of each node by the flux upstream, (nx, ny)."""
        self.fluxes[0] = flux
        trail.carry(self.modes, self.fluxes, self.weights, self.lags, self.past)
        return self.past

    def advance(self) -> None:
        """Accept the present as the last time level of the next step."""
        self.fluxes[1:] = self.fluxes[:-1].copy()
        self.modes[1:] = self.modes[:-1].copy()


def lag_of(steps: float, first: int) -> trail.Lag:
    """Return the weights of an earlier time: a parabola through three time levels.

    Parameters
    ----------
    steps : float
        How long ago, in time steps.
    first : int
        Newest of the three levels, in time steps ago.
    """
    s = steps - first
    return trail.Lag(first, 0.5 * (s - 1.0) * (s - 2.0), s * (2.0 - s), 0.5 * s * (s - 1.0))
