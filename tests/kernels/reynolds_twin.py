"""Films and meshes for the tests of the Reynolds kernels, and the operator in numpy."""

import numpy as np

from tehl.kernels.properties import Film
from tehl.kernels.reynolds import Stencil


def isotropic(p, h, eps, rho, drho):
    """A film that conducts alike along x and y."""
    return Film(p, h, eps, rho, drho, eps_x=eps, eps_y=eps)


def random_film(shape, seed=0):
    rng = np.random.default_rng(seed)
    return isotropic(*(0.5 + rng.random(shape) for _ in range(5)))


def stencil_of(mirror, dx=0.25, dy=0.4):
    return Stencil(1.0 / dx**2, 1.0 / dy**2, 1.5 / dx, -2.0 / dx, 0.5 / dx, mirror)


def operator_twin(film, stencil):
    """The operator from slices of fields that are extended over the mirror line."""
    fields = film
    if stencil.mirror:
        fields = [np.vstack([a[1:2], a]) for a in film]
    p, h, eps, rho, *_ = fields
    middle, inner = slice(1, -1), slice(1, -1)
    east = (eps[:, 1:] + eps[:, :-1]) * np.diff(p, axis=1)
    north = (eps[1:] + eps[:-1]) * np.diff(p, axis=0)
    flow = rho * h
    wedge = np.zeros_like(p)
    wedge[:, 2:] = stencil.w0 * flow[:, 2:] + stencil.w1 * flow[:, 1:-1] + stencil.w2 * flow[:, :-2]
    wedge[:, 1] = (stencil.w0 - stencil.w2) * (flow[:, 1] - flow[:, 0])
    result = 0.5 * stencil.cx * np.diff(east, axis=1)[middle]
    result += 0.5 * stencil.cy * np.diff(north, axis=0)[:, inner] - wedge[middle, inner]
    out = np.zeros_like(film.p)
    out[0 if stencil.mirror else 1 : -1, 1:-1] = result
    return out
