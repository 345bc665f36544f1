"""Films and meshes for the tests of the Reynolds kernels, and the operator in numpy."""

import numpy as np

from tehl.kernels.faces import Stencil
from tehl.kernels.properties import Film


def isotropic(p, h, eps, rho, drho):
    """A film that conducts alike along x and y."""
    return Film(p, h, eps, rho, drho, eps_x=eps, eps_y=eps)


def random_film(shape, seed=0):
    rng = np.random.default_rng(seed)
    return isotropic(*(0.5 + rng.random(shape) for _ in range(5)))


def stencil_of(mirror, dx=0.25, dy=0.4, third=False, fore=0):
    weights = 1.5 / dx, -2.0 / dx, 0.5 / dx
    sizes, part = (1.0 / dx**2, 1.0 / dy**2), 0.2 if third else 1.0
    third = 1.0 / (3.0 * dx) if third else 0.0
    shape = {"third": third, "fore": fore, "arithmetic": part, "geometric": int(third > 0.0)}
    return Stencil(*sizes, *weights, mirror, **shape)


def means(stencil, first, second, along):
    """Twice the conductance of the faces between two arrays of nodes."""
    if along and not stencil.geometric:
        return first + second
    geometric = 2.0 * np.sqrt(first * second)
    part = np.where(second > first, 1.0 / 3.0, 0.0) if along else stencil.arithmetic
    return geometric + part * (first + second - geometric)


def operator_twin(film, stencil):
    """The operator from slices of fields that are extended over the mirror line."""
    fields = film
    if stencil.mirror:
        fields = [np.vstack([a[1:2], a]) for a in film]
    p, h, eps, rho, *_ = fields
    middle, inner = slice(1, -1), slice(1, -1)
    east = means(stencil, eps[:, :-1], eps[:, 1:], along=True) * np.diff(p, axis=1)
    north = means(stencil, eps[:-1], eps[1:], along=False) * np.diff(p, axis=0)
    flow = rho * h
    wedge = np.zeros_like(p)
    wedge[:, 2:] = stencil.w0 * flow[:, 2:] + stencil.w1 * flow[:, 1:-1] + stencil.w2 * flow[:, :-2]
    wedge[:, 1] = (stencil.w0 - stencil.w2) * (flow[:, 1] - flow[:, 0])
    if stencil.third > 0.0:
        columns = np.arange(1, p.shape[1] - 1)
        weights = np.where(columns < stencil.fore, stencil.third, 0.5 * stencil.third)
        faces = np.zeros_like(p)
        faces[:, 1:-1] = weights * (flow[:, 2:] - 2.0 * flow[:, 1:-1] + flow[:, :-2])
        wedge[:, 1:-1] += np.diff(faces, axis=1)[:, :-1]
    result = 0.5 * stencil.cx * np.diff(east, axis=1)[middle]
    result += 0.5 * stencil.cy * np.diff(north, axis=0)[:, inner] - wedge[middle, inner]
    out = np.zeros_like(film.p)
    out[0 if stencil.mirror else 1 : -1, 1:-1] = result
    return out
