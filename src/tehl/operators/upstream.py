r"""Oil upstream of the grid in a line contact: pressure at the inlet edge, load and moment.

There the oil hardly bends the bodies: with q the flux of the oil, the viscosity of Barus, and the
deflection by the pressure of a dry line contact, of which two terms are left,

.. math:: P' = \lambda e^{\bar\alpha P} \frac{H - q}{H^3}, \qquad
          H = H_a + \tfrac12 (X^2 - X_a^2) - \tfrac12 \ln \frac{X}{X_a}
              + \tfrac1{16} (X^{-2} - X_a^{-2}), \quad X < X_a.

The integrals to minus infinity are sums of Gauss over t = X_a/X. The exponential function follows
from the pressure at ambient viscosity, P_0, which falls as t^3: it is 1/(1 - alpha P_0). Downstream
the oil is cavitated.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array
from tehl.contact.moment import STEADY, Moment
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import Groups

GAUSS_NODES = 16
"""Nodes of the sums: with twice as many they change by less than 1e-6."""
MOST_THICKENING = 0.5
"""alpha P_0 at the edge beyond which a domain is too short to have the oil outside by this."""


class Beyond(NamedTuple):
    """Pressure P at the inlet edge; beyond it the integrals of P and of H dP [-], of each line."""

    pressure: Array
    load: Array
    rolling: Array


class Lines(NamedTuple):
    """X of the nodes, (nx,), P and H there, (ny, nx), and what each line stands for, (ny,) [-].

    ``slower`` (ny,): what spin takes from the speed of each line, over that of the contact.
    ``whole`` is P of oil and solids together, None if that of the oil is all.
    """

    x: Array
    pressure: Array
    film: Array
    widths: Array
    slower: Array | float = 0.0
    whole: Array | None = None


class Places(NamedTuple):
    """Places of the sums upstream of an edge at X_a, (n,) each [-]."""

    t: Array
    """X_a/X."""
    away: Array
    """X_a - X."""
    lengths: Array
    """|dX| of each."""
    parabola: Array
    bent: Array
    """H less that at the edge, of the parabola and of the dry deflection."""


class EdgeSlopes(NamedTuple):
    """Change of the pressure on the edges, (ny, nx), and of the load outside.

    By that of the film and by its rate; of lines also by the flux of the oil, (ny,) each.
    """

    by_film: Array
    by_rate: Array
    load_by_film: Array
    """(ny,): By that of the film at the inlet edge of each line."""
    load_by_rate: float
    by_flux: Array
    load_by_flux: Array


def beyond(
    edge: float,
    film: Array,
    flux: Array,
    groups: Groups,
    *,
    speed: Array,
    moment: Moment = STEADY,
) -> Beyond:
    """Return what the oil upstream of an edge does.

    Parameters
    ----------
    edge : float
        X_a < 0 [-].
    film, flux : (n,) array
        Of each line H there, and rho H where the pressure is largest [-].
    groups : Groups
        lambda and alpha p_h of the oil that enters.
    speed : (n,) array
        Of each line towards the contact, over that of ``groups`` [-].
    moment : Moment
        Radius and load, by which the gap opens.
    """
    places = _places(edge)
    h = film[:, None] + (moment.curvature * places.parabola + moment.load * places.bent)
    slope = groups.lambda_bar * speed[:, None] * places.lengths * (h - flux[:, None])  # P' |dX|
    slope /= h * h * h
    thicker = np.minimum(groups.alpha_bar * slope.sum(axis=1), MOST_THICKENING)
    slope /= 1.0 - thicker[:, None] * places.t**3
    return Beyond(slope.sum(axis=1), slope @ places.away, (slope * h).sum(axis=1))


@lru_cache(maxsize=64)
def _places(edge: float) -> Places:
    """Return the places of the sums upstream of an edge."""
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS_NODES)
    t = 0.5 * (nodes + 1.0)
    x = edge / t
    return Places(
        t=t,
        away=edge - x,
        lengths=-0.5 * weights * edge / t**2,
        parabola=0.5 * (x**2 - edge**2),
        bent=0.5 * np.log(t) + (1.0 / x**2 - 1.0 / edge**2) / 16.0,
    )


def rolling(
    lines: Lines, oil: Array | None, groups: Groups, moment: Moment
) -> tuple[float, float, float]:
    r"""Return the rolling integral of a line or roller, the moment over it, and its tail [-].

    The integral is the friction of the flow by the pressure on both surfaces, and the moment of the
    pressure about the middle times the curvature c of the gap,

    .. math:: I = \int\!\!\int H \frac{dP}{dX} dX dY = -c \int\!\!\int X P\, dX dY,

    which are equal as the deflection by P makes no moment. Where asperities carry load too, the
    second P is that of both, and H the separation of the mean planes: their pressure is a function
    of it, and makes no moment over its slope. Sums by the trapezoidal rule. The tail
    is the part of the oil upstream of the grid, that of the steady film of this moment. The
    ratio is that on the grid, one if the oil has no pressure.

    Parameters
    ----------
    lines : Lines
        Pressures and separation on a grid.
    oil : (ny,) array or None
        rho H of each line where its pressure is largest [-]; None where no oil reaches further
        upstream.
    groups, moment : Groups, Moment
        lambda and alpha p_h of the oil that enters; speed and radius.
    """
    way = slice(None, None, -1 if moment.speed < 0.0 else 1)  # the inlet first
    sign, widths = float(way.step), lines.widths
    x, pressure, film = sign * lines.x[way], lines.pressure[:, way], lines.film[:, way]
    tail = 0.0
    if oil is not None and moment.speed != 0.0:
        speed = _incoming(sign * (moment.speed - lines.slower), film.shape[0])
        flux = np.minimum(oil, film[:, 0])
        upstream = beyond(float(x[0]), film[:, 0], flux, groups, speed=speed, moment=moment)
        tail = float(upstream.rolling @ widths)
    flow = np.sum(0.5 * (film[:, 1:] + film[:, :-1]) * np.diff(pressure), axis=1)
    whole = pressure if lines.whole is None else lines.whole[:, way]
    centre = -moment.curvature * np.trapezoid(x * whole, x)
    on_grid = float((flow + film[:, 0] * pressure[:, 0]) @ widths)
    found = float(flow @ widths) + tail
    return sign * found, float(centre @ widths) / on_grid if on_grid else 1.0, sign * tail


def _incoming(speed: Array | float, lines: int) -> Array:
    """Return the speed of each line towards the contact, zero where oil leaves, (n,) [-]."""
    return np.maximum(np.broadcast_to(speed, (lines,)), 0.0)


class UpstreamField:
    """Pressure on the inlet edge of a line contact, and the load beyond it, line by line.

    Parameters
    ----------
    grid : Grid
        Its inlet edge.
    groups : Groups
        Lambda of the oil that enters.
    moment : Moment
        Its speed, radius and load.
    slower : Array or float
        What spin takes from the speed of each line, over that of the contact [-].
    """

    def __init__(
        self, grid: Grid, groups: Groups, moment: Moment, slower: Array | float = 0.0
    ) -> None:
        self.edge, self.groups, self.moment = grid.domain.x[0], groups, moment
        self.speed = _incoming(moment.speed - slower, grid.shape[0])
        self.middle = int(np.argmin(np.abs(grid.x)))
        self.widths = grid.widths

    def set_edges(self, pressure: Array, film: Array) -> None:
        """Set the pressure on the inlet edge for a film; it is zero on the outlet edge.

        Parameters
        ----------
        pressure : Array
            P [-], (ny, nx); its first column is overwritten.
        film : Array
            H [-], (ny, nx), positive on the edge.
        """
        pressure[:, 0] = self._beyond(film).pressure
        pressure[:, -1] = 0.0

    def load(self, film: Array, gap: Array) -> float:
        """Return the integral of P upstream of the grid [-].

        Parameters
        ----------
        film, gap : array of the shape of the grid
            H; the gap follows from its value on the edge.
        """
        del gap
        return float(self._beyond(film).load @ self.widths)

    def slopes(self, film: Array, gap: Array) -> EdgeSlopes:
        r"""Return the changes by those of film and flux at the edge, and by the rate of the film.

        Where the gap opens, the flux at X is :math:`q_a + \dot H (X_a - X)`.

        Parameters
        ----------
        film, gap : array of the shape of the grid
            H; the gap follows from its value on the edge.
        """
        del gap
        inlet = film[:, 0]
        flux, step = np.minimum(film[:, self.middle], inlet), 1e-4 * inlet
        higher, lower = (self._at(inlet + change, flux) for change in (step, -step))
        places = _places(self.edge)
        fastest = self.groups.lambda_bar * self.speed[:, None]
        gap = inlet[:, None] + places.parabola + places.bent  # of a steady film
        per_flux = -fastest * places.lengths / gap**3
        by_flux, load_by_flux, load_by_rate = (per_flux @ places.away**power for power in range(3))
        by_film, by_rate = np.zeros_like(film), np.zeros_like(film)
        by_film[:, 0] = (higher.pressure - lower.pressure) / (2.0 * step)
        by_rate[:, 0] = load_by_flux
        return EdgeSlopes(
            by_film=by_film,
            by_rate=by_rate,
            load_by_film=self.widths * (higher.load - lower.load) / (2.0 * step),
            load_by_rate=float(self.widths @ load_by_rate),
            by_flux=by_flux,
            load_by_flux=self.widths * load_by_flux,
        )

    def _beyond(self, film: Array) -> Beyond:
        inlet = np.maximum(film[:, 0], 0.5 * self.edge**2 * 1e-3)
        flux = np.minimum(np.maximum(film[:, self.middle], 0.0), inlet)
        return self._at(inlet, flux)

    def _at(self, inlet: Array, flux: Array) -> Beyond:
        moment = self.moment
        return beyond(self.edge, inlet, flux, self.groups, speed=self.speed, moment=moment)
