"""Surface temperature behind a moving line source, by a sum of exponentials.

The rise of a surface that moves with u_s > 0 under the heat flux q is (Jaeger 1942; Carslaw and
Jaeger 1959, sec. 10.7)

    T(x) - T_b = 1/sqrt(pi rho c k u_s) int_{-inf}^{x} q(s) / sqrt(x - s) ds.

The flux is linear between nodes. The last mesh width is integrated exactly; of what lies farther
upstream 1/sqrt is a sum of exponentials, each of which is carried on by one multiplication, so that
the whole history costs the same at each node.
"""

from typing import NamedTuple

import numpy as np

from tehl.base.typing import Array

LOG_QUADRATURE_STEP = 0.4
"""Step d of the trapezoidal rule in ln s; its relative error is 2 exp(-pi^2/(2 d)) = 1e-5."""


class History(NamedTuple):
    """Weights of the integral over one mesh width.

    ``near`` and ``next_`` of the flux at the node and at the one before it; each exponential of
    what came before is multiplied by ``decay`` per node and gains ``older`` times the flux two
    nodes back and ``newer`` times that of the last node.
    """

    near: float
    next_: float
    decay: Array
    older: Array
    newer: Array


def line_rise(flux: Array, spacing: float) -> Array:
    """Return int q(s) / sqrt(x - s) ds of a given flux, linear between nodes, (nx, ny).

    Exact weights, node by node: for fluxes that do not change in a sweep.

    Parameters
    ----------
    flux : (nx, ny) array
        Heat flux q at the nodes; zero upstream of them.
    spacing : float
        Mesh width.
    """
    nodes = flux.shape[0]
    power = np.arange(nodes + 1.0) ** 1.5
    weights = 4.0 / 3.0 * np.sqrt(spacing) * np.ones(nodes)
    weights[1:] *= power[2:] - 2.0 * power[1:-1] + power[:-2]
    distance = np.subtract.outer(np.arange(nodes), np.arange(nodes))
    found: Array = np.where(distance >= 0, weights[np.abs(distance)], 0.0) @ flux
    return found


def history(nodes: int, spacing: float) -> History:
    """Return the weights for ``nodes`` nodes along x, ``spacing`` apart.

    Parameters
    ----------
    nodes : int
        Nodes along x, the longest distance that the exponentials cover.
    spacing : float
        Mesh width [a_x].
    """
    weight, rate = exponentials(nodes)
    decay, (total, first) = np.exp(-rate), averages(rate)
    root = np.sqrt(spacing)
    return History(
        near=4.0 / 3.0 * root,
        next_=2.0 / 3.0 * root,
        decay=decay,
        older=root * weight * decay * (total - first),
        newer=root * weight * decay * first,
    )


def exponentials(nodes: int, shortest: float = 1.0) -> tuple[Array, Array]:
    """Return weights and rates of a sum of exponentials that is 1/sqrt(t).

    ``1/sqrt(t) = 2/sqrt(pi) int exp(y - t exp(2y)) dy`` for t of ``shortest`` to ``nodes`` mesh
    widths; the slowest exponentials, which have hardly decayed, are lumped into one of the same
    first moment.

    Parameters
    ----------
    nodes : int
        Longest distance [mesh widths].
    shortest : float
        Shortest one.
    """
    low, high = -0.5 * np.log(nodes) - 3.0, 1.3 - 0.5 * np.log(shortest)
    y = np.arange(low, high + LOG_QUADRATURE_STEP, LOG_QUADRATURE_STEP)
    weight, rate = 2.0 / np.sqrt(np.pi) * LOG_QUADRATURE_STEP * np.exp(y), np.exp(2.0 * y)
    ratio = np.exp(-LOG_QUADRATURE_STEP)
    lump = weight[0] * ratio / (1.0 - ratio)
    lump_rate = weight[0] * rate[0] * ratio**3 / (1.0 - ratio**3) / lump
    return np.concatenate([[lump], weight]), np.concatenate([[lump_rate], rate])


def averages(rate: Array) -> tuple[Array, Array]:
    """Return int_0^1 exp(-rate t) dt and int_0^1 (1 - t) exp(-rate t) dt, of any shape."""
    decay, small = np.exp(-rate), rate < 1e-2  # series where the closed form cancels
    safe = np.where(small, 1.0, rate)
    first = np.where(
        small, 0.5 - rate / 6 + rate**2 / 24 - rate**3 / 120, (safe - 1 + decay) / safe**2
    )
    total = np.where(small, 1 - rate / 2 + rate**2 / 6 - rate**3 / 24, (1 - decay) / safe)
    return total, first
