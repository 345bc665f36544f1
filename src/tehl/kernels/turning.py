"""Fluxes of oil that is conserved between surfaces that spin: it comes from two sides.

Partly filled cells hold what `tehl.kernels.cavities.fill` brings them (docs/theory/directions.md).
"""

from tehl.base.typing import Array
from tehl.kernels.compiled import helper
from tehl.kernels.faces import MARK_THIRD_ORDER, STEADILY, Stencil, both_x, third_beyond
from tehl.kernels.properties import Film


@helper
def subtract_curved_flux(
    film: Film, stencil: Stencil, j: int, out: Array, place: tuple[int, int]
) -> None:
    """Subtract the wedge of surfaces that spin: partly filled nodes pass on the oil that they hold.

    It comes from both sides upstream (`tehl.kernels.cavities.fill`). Of the pressure flow that
    leaves a film upstream along x, the part u/(u + v) comes back at once.
    """
    (row, end), u = place, film.speed[j]
    back = -1 if u > 0.0 else 1
    for i in range(1, end):
        v = film.drift[j, i]
        wedge = abs(u) * _flux_difference(film, stencil, (j, i), (0, back))
        wedge += abs(v) * _flux_difference(film, stencil, (j, i), (-1 if v > 0.0 else 1, 0))
        out[row, i] -= wedge
        if film.partial[j, i + back] and not film.partial[j, i]:
            part = part_back(film, j, i + back)
            out[row, i] += part * flow_from(film, stencil, j, i + back, -back)


@helper
def part_back(film: Film, j: int, i: int) -> float:
    """Return the part of the pressure flow from a film ahead along x that goes back to it.

    A partly filled node passes on along x and y what comes, by its speeds.
    """
    return abs(film.speed[j]) / (abs(film.speed[j]) + abs(film.drift[j, i]))


@helper
def flow_from(film: Film, stencil: Stencil, j: int, i: int, way: int) -> float:
    """Return the pressure flow into a node from the next one along x, east (1) or west (-1)."""
    eps = both_x(stencil, film.eps_x[j, min(i, i + way)], film.eps_x[j, max(i, i + way)])
    return 0.5 * stencil.cx * eps * (film.p[j, i + way] - film.p[j, i])


@helper
def _flux_difference(
    film: Film, stencil: Stencil, node: tuple[int, int], way: tuple[int, int]
) -> float:
    """Return the difference of the fluxes through two faces of a node as if it were full."""
    before = node[0] + way[0], node[1] + way[1]
    return passed_on(film, stencil, node, way, True) - passed_on(film, stencil, before, way, False)


@helper
def passed_on(
    film: Film, stencil: Stencil, node: tuple[int, int], way: tuple[int, int], full: bool
) -> float:
    """Return the flux of oil through the face downstream of a node, over the speed and dx.

    ``way``: rows and columns upstream; a partly filled node counts as full if ``full``. Beyond a
    closed end lies the layer of the end line: no more of it comes in than that line would pass on
    if it were full (docs/theory/rollers.md, spin).
    """
    (j, i), (dj, _), rate = node, way, stencil.w0 - stencil.w2
    if 0 <= j < film.p.shape[0]:
        return _passed_within(film, stencil, node, way, full)
    found = _passed_within(film, stencil, (j - dj, i), way, True)
    return min(rate * film.layer[j - dj], found) if film.layer.shape[0] > 0 else found


@helper
def crossing(film: Film, stencil: Stencil, j: int, i: int) -> float:
    """Return the size of the drift where more film of a node carries more oil away along y.

    Zero where oil comes in through a closed end: as much more then comes as is passed on, unless
    the layer is less.
    """
    v, way = film.drift[j, i], (-1 if film.drift[j, i] > 0.0 else 1, 0)
    if 0 <= j + way[0] < film.p.shape[0]:
        return abs(v)
    if stencil.conserves != STEADILY or film.layer.shape[0] == 0:
        return 0.0
    rate, found = stencil.w0 - stencil.w2, _passed_within(film, stencil, (j, i), way, True)
    return abs(v) if rate * film.layer[j] < found else 0.0


@helper
def _passed_within(
    film: Film, stencil: Stencil, node: tuple[int, int], way: tuple[int, int], full: bool
) -> float:
    """Return the flux of `passed_on` from a node of the grid."""
    (j, i), (dj, di), (ny, nx), rate = node, way, film.p.shape, stencil.w0 - stencil.w2
    if film.partial[j, i] and not full:
        found = rate * film.held[j, i]
        ahead = 1 if film.speed[j] > 0.0 else -1
        if di == 0 and 0 < i < nx - 1 and not film.partial[j, i + ahead]:
            # of what the film behind along x brings, the rest comes back to that film
            size = abs(film.speed[j]) + abs(film.drift[j, i])
            found += flow_from(film, stencil, j, i, ahead) / size
        return found
    mass, after = film.rho[j, i] * film.h[j, i], (j - dj, i - di)
    if not (0 <= j + dj < ny and 0 <= i + di < nx):  # on the edge
        if stencil.w2 > 0.0 and film.second[after] and not film.partial[after]:
            return rate * 0.5 * (mass + film.rho[after] * film.h[after])
        return rate * mass
    if not is_second(film, node, way):
        return rate * mass
    west = film.rho[j + dj, i + di] * film.h[j + dj, i + di]
    found = rate * (1.5 * mass - 0.5 * west)
    is_third = film.second[j, i] == MARK_THIRD_ORDER and 0 <= after[0] < ny  # none beyond ends
    if is_third and not (film.partial[after] or film.partial[j, i]):
        east = film.rho[after] * film.h[after]
        found += third_beyond(stencil, i, di) * (east - 2.0 * mass + west)
    return found


@helper
def is_second(film: Film, node: tuple[int, int], way: tuple[int, int]) -> bool:
    """Return whether a node passes on oil with second order where the surfaces spin."""
    (j, i), (dj, di), (ny, nx) = node, way, film.p.shape
    if not film.second[j, i] or film.partial[j + dj, i + di]:
        return False
    inside = 0 <= j + 2 * dj < ny and 0 <= i + 2 * di < nx
    return not (inside and film.partial[j + 2 * dj, i + 2 * di])
