"""Dry pressure; of a roller that which makes the gap zero where it is positive.

Conjugate gradients with the load as a constraint (Polonsky and Keer, Wear 231 (1999) 206-219): the
descent is the gap less its mean over the contact, and nodes of negative pressure leave it. A stated
moment is a second constraint, and the descent is free of the tilt too.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.grid import Grid, crowding, distances
from tehl.estimate.scaling import Groups
from tehl.operators.deformation import choose
from tehl.operators.film import gap, rigid_motions
from tehl.operators.load import Load
from tehl.operators.transfer import refine

SEARCHED, SEARCHED_CELLS = (65, 129), (0.05, 0.01)
"""Nodes on which the loaded part of a roller is searched, and lengths of the cells where it was
found to end, on which it is searched again, in half-widths."""
STEEP_END, VALLEY_CELL, THICK_CELL = 0.4, 2.0, 6.5
"""Distance from the end of the loaded part to half of the largest pressure below which cells there
are shorter, in half-widths, and the shortest ones: their length over the width, over H_c^(2/3) and
over H_c for the central film, of which the longer counts. The dry gap opens as the power 3/2 of the
distance, so the valley lies 0.26 H_c^(2/3) before the end of the dry contact. The minimum of
lundberg profiles on 257 x 129 and 513 x 257 nodes then errs by 0.7 and 0.2 % (M = 50), and by 4 and
1 % (M = 64, L = 1.3); cycles converge faster with cells 1.35 times as long, but bars of ten rollers
(M = 5 to 74) are larger, in the median 1.4 times, and three more need a finer grid for 2 %. A thick
film leaves no step: at H_c = 0.19 cycles on 513 x 257 nodes diverge without the second length."""
EDGE = 9.0
"""Dry pressure on the shortest of `SEARCHED_CELLS` at the end of a roller that presses as an edge,
in those of Hertz: on finer cells it grows without limit, and most smallest films have no error
bar."""
START_CELLS = 2.0
"""Half-width of the contact to start from, in cells at the least."""
STEEP_LINES = 65
"""Lines up to which the pressure is steep from line to line where these crowd at the ends. On more
it starts from that of half as many."""


@lru_cache(maxsize=8)
def _dry_roller(grid: Grid, groups: Groups) -> tuple[Array, Array]:
    """Return the dry pressure of a roller, ``grid.shape``, and its tilts, both read-only [-].

    Tilts are those that follow from stated moments, (motions - 1,), beside that of the shape.
    """
    shape, load, deformation = groups.shape, Load(grid), choose("fft", grid, groups)
    undeformed = gap(grid, groups)
    inside = np.zeros(undeformed.shape, bool)
    inside[:, 1:-1] = True
    weight = grid.widths[:, None]
    p = np.where(inside, _first_pressure(grid, groups), 0.0)
    p *= shape.load / load.integral(p)
    film, moved, step = (np.zeros_like(undeformed) for _ in range(3))
    conjugate, before, tilts, known = 0.0, 1.0, np.zeros(0), False
    modes, moments = rigid_motions(grid, groups)
    modes = modes[1:, :, None]
    for _ in range(400):
        touching = p > 0.0
        if not known:
            deformation.deflect(p, film)
        rest, part = film + undeformed, touching * weight
        tilts = -_take_motions(rest, part, modes)
        square = float((part * rest**2).sum())
        step = np.where(touching, rest + conjugate * square / before * step, 0.0)
        deformation.deflect(step, moved)
        bent = moved.copy()
        _take_motions(bent, part, modes)
        work = float((part * bent * step).sum())
        if not work > 0.0:  # one column of nodes touches, whose gap is its own mean
            break
        length = float((part * rest * step).sum()) / work
        descended = p - length * step
        last, p = p, np.maximum(descended, 0.0)
        missed = inside & (p == 0.0) & (rest < 0.0)
        p[missed] -= length * rest[missed]
        scale = shape.load / load.integral(p)
        p *= scale
        # half of the products are saved where the contact stays as it is
        known = not (modes.size or missed.any() or descended.min() < 0.0)
        if known:
            film = scale * (film - length * moved)
        _take_moments(p, load, modes, moments)
        conjugate, before = 0.0 if missed.any() else 1.0, square
        # a thousandth of p is then left, as little as a start and the place of a spike need
        if float(np.abs(p - last).sum()) < 1e-4 * float(p.sum()):
            break
    p.flags.writeable = tilts.flags.writeable = False
    return p, tilts


def _first_pressure(grid: Grid, groups: Groups) -> Array:
    """Return the pressure of slices, on many lines that crowd that of the next coarser grid."""
    if grid.crowding and grid.ny > STEEP_LINES and grid.can_coarsen():
        return refine(_dry_roller(grid.coarser(), groups)[0], grid)
    return groups.shape.dry_pressure(grid.x[None, :], grid.y[:, None])


def _take_moments(p: Array, load: Load, modes: Array, moments: Array) -> None:
    """Change a pressure that carries the load in place so that it has the stated moments."""
    for mode, moment in zip(modes, moments, strict=True):
        carried = load.integral(mode * p)
        arm = mode - carried / load.integral(p)
        more = (moment - carried) / load.integral(arm * mode * p)
        p *= np.maximum(1.0 + more * arm, 0.0)


def _take_motions(film: Array, part: Array, modes: Array) -> Array:
    """Take the mean of a film over a contact from it, and its tilt; return tilts over ``modes``."""
    film -= (part * film).sum() / part.sum()
    found = []
    for mode in modes:
        arm = mode - (part * mode).sum() / part.sum()
        found.append((part * arm * film).sum() / (part * arm**2).sum())
        film -= found[-1] * arm
    return np.array(found)


def dry_pressure(grid: Grid, groups: Groups) -> Array:
    """Return the pressure of the dry contact, shape ``grid.shape`` [-].

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Shape of the contact.
    """
    if groups.roller is not None:
        return _dry_roller(grid, groups)[0].copy()
    return groups.shape.dry_pressure(grid.x[None, :], grid.y[:, None])


def start_pressure(grid: Grid, groups: Groups, load: float, curvature: float) -> Array:
    """Return the dry pressure to start from: that of a wider contact if no node would carry it.

    The domain of a rigid contact (M < 1) is hundreds of half-widths long. Without any pressure a
    film that scarce oil leaves partly filled has no unknowns, and Newton's method no step.

    Parameters
    ----------
    grid : Grid
        Nodes X, Y in Hertz half-widths.
    groups : Groups
        Shape of the contact.
    load : float
        Integral of the pressure at the moment of the start [-].
    curvature : float
        1/R_x at that moment, over that of the contact [-].

    Returns
    -------
    array of ``grid.shape``
        Carries the load, if it is wider, on half-widths of `START_CELLS` cells [-].
    """
    shape = groups.shape
    width, highest = shape.grown(load / shape.load, curvature)
    cell = max(grid.dx, grid.dy if grid.ny > 1 else 0.0)
    if groups.roller is not None:
        return highest * dry_pressure(grid, groups)
    x, y = grid.x[None, :], grid.y[:, None]
    if not START_CELLS * cell > width:
        return highest * shape.dry_pressure(x / width, y / width)
    found = shape.dry_pressure(x / (START_CELLS * cell), y / (START_CELLS * cell))
    return found * (load / Load(grid).integral(found))


@lru_cache(maxsize=8)
def at_loaded_ends(grid: Grid, groups: Groups) -> Grid:
    """Return a grid whose lines crowd where the loaded part of the roller ends, not where it does.

    There the film is thin, within a few hundredths of a half-width: a roller that leaves the
    raceway before its ends has no load at them.

    Parameters
    ----------
    grid, groups : Grid, Groups
        The nodes, and the roller under its load.
    """
    if not grid.crowding:
        return grid
    edges, ramp = _loaded_part(_searched(grid, groups), groups)
    if edges == grid.edges:
        return grid
    longest, film = distances(grid.crowding, grid.edges)[0], expected_central_film(groups)
    steepness = 1.0 if max(edges) == 1.0 else groups.ellipticity * ramp / STEEP_END
    shortest = max(VALLEY_CELL * film ** (2.0 / 3.0), THICK_CELL * film)
    shortest *= grid.dx / (groups.ellipticity * grid.dy)
    part = min(max(longest * steepness, shortest), longest)
    return replace(grid, edges=edges, crowding=crowding(part, edges, grid.most_apart))


def presses_as_edge(grid: Grid, groups: Groups) -> bool:
    """Return whether an end of a roller presses as a sharp edge.

    Parameters
    ----------
    grid, groups : Grid, Groups
        As in `at_loaded_ends`.
    """
    searched = _searched(grid, groups)
    pressure = searched.unfold(_dry_roller(searched, groups)[0])
    return float(max(pressure[0].max(), pressure[-1].max())) > EDGE


@lru_cache(maxsize=8)
def _searched(grid: Grid, groups: Groups) -> Grid:
    """Return the grid on which the loaded part of a roller is found, with short cells at its ends.

    It depends on the domain of ``grid`` alone.
    """
    searched = replace(grid, nx=SEARCHED[0], ny=SEARCHED[1], crowding=0.0)
    edges, _ = _loaded_part(searched, groups)
    for length in SEARCHED_CELLS:
        part = length / (groups.ellipticity * searched.dy)
        crowded = replace(searched, edges=edges, crowding=crowding(part, edges))
        edges, _ = _loaded_part(crowded, groups)
    return crowded


def _loaded_part(grid: Grid, groups: Groups) -> tuple[tuple[float, float], float]:
    """Return e of both places where the dry pressure ends, and the shorter one of both ramps.

    A ramp is the distance in Y from that place to half of the largest pressure.
    """
    highest = grid.unfold(_dry_roller(grid, groups)[0]).max(axis=1)
    whole = replace(grid, mirror=False)
    faces, y = whole.faces, whole.y
    first, last = np.nonzero(highest)[0][[0, -1]]
    low, high = y[np.nonzero(highest > 0.5 * highest.max())[0][[0, -1]]]
    edges = -float(faces[first]), float(faces[last + 1])
    return edges, min(float(low) + edges[0], edges[1] - float(high))


def dry_motions(grid: Grid, groups: Groups, approach: float = 0.0) -> Array:
    """Return the rigid motions of the dry contact: an approach, and tilts by moments, (motions,).

    Parameters
    ----------
    grid, groups : Grid, Groups
        Nodes, and the contact.
    approach : float
        H00 [-].
    """
    tilts = np.zeros(0) if groups.roller is None else _dry_roller(grid, groups)[1]
    return np.append(approach, tilts)
