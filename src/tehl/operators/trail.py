"""Surface temperature in transient runs: material points carry the heat that they took up.

Heat at x entered upstream, when the material was there (Carslaw and Jaeger 1959, section 10.7),

    T(x, t) - T_b = 1/sqrt(pi rho c k u_s) int q(s, t - (x - s)/u_s) / sqrt(x - s) ds,

so that the exponentials of `tehl.operators.line_source` move from node to node with a lag, the time
in which the surface moves by a mesh width. Between time levels they are interpolated to second
order.
"""

import math

import numpy as np
from scipy.sparse import csc_array, eye_array
from scipy.sparse.linalg import splu

from tehl.base.typing import Array
from tehl.estimate.ways import Way
from tehl.kernels.energy import trail
from tehl.operators.carrying import Carrier
from tehl.operators.line_source import history
from tehl.operators.reynolds import CUBIC, cubic_weights


class Trail:
    """History of one surface on one grid.

    Parameters
    ----------
    flux : (nx, ny) array
        Steady flux at the beginning, dimensionless.
    spacing : float
        Mesh width [a_x].
    lag : float
        Time steps in which the surface moves by a mesh width, at most two: earlier levels are not
        stored (`tehl.contact.problem.check_transient` refuses slower surfaces).
    """

    def __init__(self, flux: Array, spacing: float, lag: float) -> None:
        nx, ny = flux.shape
        weights = history(nx, spacing)
        self.near = weights.near
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

    def move(self, way: Way) -> None:
        """Begin a step; the surface moves as at the beginning."""
        del way

    def advance(self) -> None:
        """Accept the present as the last time level of the next step."""
        self.fluxes[1:] = self.fluxes[:-1].copy()
        self.modes[1:] = self.modes[:-1].copy()

    def arrays(self) -> dict[str, Array]:
        """Return what a later step needs."""
        return {"modes": self.modes, "fluxes": self.fluxes}


class VaryingTrail:
    r"""History of one surface whose speed changes in time.

    Each material point takes up heat as a half-space does, at whatever place it is,

        T - T_b = 1/sqrt(pi rho c k) int q(x(t'), t') / sqrt(t - t') dt',

    with the flux linear in time between steps. The exponentials of time move with the surface,
    forwards, backwards or not at all; beyond the edges the surface is as warm as there.

    Parameters
    ----------
    flux : (nx, ny) array
        Steady flux at the beginning, dimensionless.
    time_step : float
        In units of a_x / u_m.
    moved : (float, float)
        Mesh width, and way of the surface per step at the beginning [a_x].
    length : (int, int)
        Steps of the run, and nodes beyond either edge to which surfaces go that come back.
    """

    def __init__(
        self,
        flux: Array,
        time_step: float,
        moved: tuple[float, float],
        length: tuple[int, int],
    ) -> None:
        (steps, beyond), (self.spacing, way) = length, moved
        nodes = way / self.spacing
        self.inside = slice(beyond, beyond + flux.shape[0])
        wide = np.pad(flux.T, ((0, 0), (beyond, beyond)))
        past = math.ceil((wide.shape[1] - 1) / nodes)  # the same on a grid of half the nodes
        weights = history(steps + past, time_step)
        self.near = weights.near
        self.weights = trail.Weights(*(weights.next_, weights.decay, weights.older, weights.newer))
        self.fluxes = np.repeat(wide[None, None], 3, axis=0)  # now, last and the one before it
        self.modes = np.zeros((2, len(weights.decay), *wide.shape))
        self.line, self.wide = np.zeros((1, wide.shape[1])), np.zeros(wide.shape)
        self.past, self.present = np.zeros_like(flux), flux.T
        if flux.any():
            self._begin(wide, nodes)

    def _begin(self, flux: Array, nodes: float) -> None:
        """Begin with the steady state, in which a step changes nothing.

        With S the interpolation of a field where it was a step ago, the exponentials are the
        solution of ``(I - decay S) E = S (older S q + newer q)``, a band along each line. To
        step there takes thirty times as long: 8 s of a half domain of 641 x 641 nodes. The flux is
        that beyond the edges too; the surface moves by ``nodes`` mesh widths per step.
        """
        moved = _interpolation(flux.shape[1], nodes)
        before = (moved @ flux.T).T
        self.fluxes[[0, 2], 0] = before
        self.wide[:] = self.weights.next_ * before
        identity = eye_array(flux.shape[1], format="csc")
        rates = zip(self.weights.decay, self.weights.older, self.weights.newer, strict=True)
        for number, (decay, older, newer) in enumerate(rates):
            taken = moved @ (older * before + newer * flux).T
            solution = splu(csc_array(identity - decay * moved)).solve(taken).T
            self.modes[:, number] = solution
            self.wide += solution
        self.past = self.wide[:, self.inside].T

    def move(self, way: Way) -> None:
        """Begin a step in which the surface moves along x by a way [a_x]."""
        shift = _shift_by(way.along / self.spacing)
        trail.carry_varying(self.modes, self.fluxes, self.weights, shift, self.line, self.wide)
        self.past = self.wide[:, self.inside].T

    def update(self, flux: Array) -> Array:
        """Return the rise of each node by what it took up before this step, (nx, ny)."""
        self.present = flux.T
        return self.past

    def advance(self) -> None:
        """Accept the present as the last time level of the next step."""
        self.fluxes[2] = self.fluxes[0]
        self.fluxes[1, 0, :, self.inside] = self.present
        self.modes[1] = self.modes[0]

    def arrays(self) -> dict[str, Array]:
        """Return what a later step needs."""
        return {"modes": self.modes, "fluxes": self.fluxes}


class TurningTrail:
    """The same of a surface that moves in any direction, or turns.

    Parameters
    ----------
    flux : (nx, ny) array
        Steady flux at the beginning, dimensionless.
    carrier : Carrier
        Of the nodes, perhaps with further rows.
    time_step : float
        In units of a_x / u_m.
    way : Way
        Of the surface per step at the beginning.
    length : (int, int)
        Steps of the run, and steps in which all of the surface has passed the nodes.
    """

    def __init__(
        self, flux: Array, carrier: Carrier, time_step: float, way: Way, length: tuple[int, int]
    ) -> None:
        flux = flux[:, : carrier.y.size]  # of a line one of the rows that fill its block
        self.carrier = Carrier(carrier.x, carrier.y[: flux.shape[1]], carrier.period)
        weights = history(sum(length), time_step)
        self.near, self.next_ = weights.near, weights.next_
        self.decay, self.older, self.newer = weights.decay, weights.older, weights.newer
        wide = flux.T.ravel()
        self.fluxes = np.repeat(wide[None], 3, axis=0)  # moved, last and the one before it moved
        self.modes = np.zeros((2, wide.size, self.decay.size))
        self.past, self.present = np.zeros_like(flux), flux
        if flux.any():
            self._begin(wide, way, length[1])

    def _begin(self, flux: Array, way: Way, passing: int) -> None:
        """Begin with the sum of what the surface took up in twice as many steps each time.

        A surface that turns has left after half a turn; what it brings after a whole one is lost.
        """
        moved = self.carrier.entering(way)
        before = moved @ flux
        self.fluxes[[0, 2]] = before
        total = moved @ (np.outer(before, self.older) + np.outer(flux, self.newer))
        steps = 1
        most = passing if way.turn == 0.0 else min(passing, 0.5 * math.pi / abs(way.turn))
        while steps < most:
            total = total + self.decay**steps * (self.carrier.entering(way) @ total)
            way, steps = way.after(way), 2 * steps
        self.modes[:] = total
        self.past = self._rise()

    def move(self, way: Way) -> None:
        """Begin a step in which the surface moves by a way."""
        moved, (_, last, older) = self.carrier.matrix(way), self.fluxes
        self.fluxes[0] = moved @ last
        taken = np.outer(older, self.older) + np.outer(last, self.newer)
        self.modes[0] = moved @ (self.decay * self.modes[1] + taken)
        self.past = self._rise()

    def update(self, flux: Array) -> Array:
        """Return the rise of each node by what it took up before this step, (nx, ny)."""
        self.present = flux[:, : self.carrier.y.size]
        return self.past

    def advance(self) -> None:
        """Accept the present as the last time level of the next step."""
        self.fluxes[2] = self.fluxes[0]
        self.fluxes[1] = self.present.T.ravel()
        self.modes[1] = self.modes[0]

    def arrays(self) -> dict[str, Array]:
        """Return what a later step needs."""
        return {"modes": self.modes, "fluxes": self.fluxes}

    def _rise(self) -> Array:
        rise = self.next_ * self.fluxes[0] + self.modes[0].sum(axis=1)
        return np.ascontiguousarray(rise.reshape(self.present.shape[::-1]).T)


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


def _interpolation(nx: int, nodes: float) -> csc_array:
    """Return the interpolation along x of a field where it was a step ago, (nx, nx).

    Upstream of the nodes nothing has heated the surface, downstream it is as warm as at the edge.
    """
    shift, rows = _shift_by(nodes), np.repeat(np.arange(nx), 4)
    columns = (np.arange(nx)[:, None] + shift.first + shift.step * np.arange(4)).ravel()
    upstream = columns < 0 if nodes > 0.0 else columns >= nx
    weights = np.where(upstream, 0.0, np.tile(shift.weights, nx))
    return csc_array((weights, (rows, np.clip(columns, 0, nx - 1))), shape=(nx, nx))


def _shift_by(nodes: float) -> trail.Shift:
    """Return the interpolation of a field where it was ``nodes`` mesh widths along x ago."""
    sign, whole = (-1 if nodes < 0.0 else 1), int(abs(nodes))
    one, two, three, four = cubic_weights(abs(nodes) - whole)
    return trail.Shift(-sign * (whole + CUBIC[0]), -sign, (one, two, three, four))
