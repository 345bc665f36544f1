"""Nodes across the film, and the matrices that differentiate and integrate on them."""

from functools import cache

import numpy as np

from tehl.base.typing import Array
from tehl.kernels.energy.records import Across


@cache
def chebyshev(nodes: int) -> Across:
    """Return collocation at Chebyshev-Gauss-Lobatto nodes: exact for polynomials.

    Parameters
    ----------
    nodes : int
        Nodes from surface to surface, both included.
    """
    zeta = 0.5 - 0.5 * np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    first = _differences(zeta)
    step = _interval_weights(zeta)
    return Across(
        zeta=zeta,
        d1=first,
        d2=first @ first,
        step=step,
        turn=_turned(step, zeta),
        weights=step.sum(axis=0),
        band=nodes - 1,
    )


@cache
def uniform(nodes: int) -> Across:
    """Return central differences and the trapezoidal rule on uniform layers: second order.

    Parameters
    ----------
    nodes : int
        Nodes from surface to surface, both included.
    """
    zeta = np.linspace(0.0, 1.0, nodes)
    width = 1.0 / (nodes - 1)
    first, second, step = (np.zeros((nodes, nodes)) for _ in range(3))
    for k in range(1, nodes - 1):
        first[k, k - 1], first[k, k + 1] = -0.5 / width, 0.5 / width
        second[k, k - 1 : k + 2] = np.array([1.0, -2.0, 1.0]) / width**2
    first[0, :3] = np.array([-1.5, 2.0, -0.5]) / width
    first[-1, -3:] = np.array([0.5, -2.0, 1.5]) / width
    for k in range(1, nodes):
        step[k, k - 1 : k + 1] = 0.5 * width
    return Across(
        zeta=zeta,
        d1=first,
        d2=second,
        step=step,
        turn=_turned(step, zeta),
        weights=step.sum(axis=0),
        band=2,
    )


SCHEMES = {"chebyshev": chebyshev, "uniform": uniform}


def _differences(zeta: Array) -> Array:
    """Return the matrix that differentiates the polynomial through values at ``zeta``."""
    apart = zeta[:, None] - zeta[None, :] + np.eye(len(zeta))
    scale = apart.prod(axis=1)
    matrix = scale[:, None] / (scale[None, :] * apart)
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return matrix


def _turned(step: Array, zeta: Array) -> Array:
    """Return the weights of the integral of a function times its distance from mid-film."""
    return np.ascontiguousarray(step * (zeta - 0.5))


def _interval_weights(zeta: Array) -> Array:
    """Return weights of the integral over each interval of the polynomial through the nodes."""
    nodes = len(zeta)
    power = np.polynomial.chebyshev.chebvander(2.0 * zeta - 1.0, nodes - 1)
    moments = np.zeros((nodes, nodes))
    for m in range(nodes):
        unit = np.zeros(nodes)
        unit[m] = 1.0
        antiderivative = np.polynomial.chebyshev.chebint(unit)
        values = 0.5 * np.polynomial.chebyshev.chebval(2.0 * zeta - 1.0, antiderivative)
        moments[1:, m] = np.diff(values)
    return np.ascontiguousarray(moments @ np.linalg.inv(power))
