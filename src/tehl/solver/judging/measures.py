"""Values beside the film that get error bars: pressure, traction and temperatures on each grid."""

import math
from dataclasses import asdict, replace
from typing import Literal

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.entering import heat_across, warmed_upstream
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import sliding_field, slowing
from tehl.operators.dry import dry_pressure
from tehl.operators.energy import FilmState
from tehl.operators.heated_film import stress_unit
from tehl.operators.loaded_zone import beside, contact_mean, cut_error, is_inside, wet_part, zone_of
from tehl.operators.upstream import Lines, rolling
from tehl.post.heat import Rises, lagrange_weights
from tehl.post.roughness import ripples
from tehl.solver.cycle.level import Level
from tehl.solver.judging.film_summary import central_value, film_summary
from tehl.solver.judging.outputs import heat_balance, newtonian_sliding

TAIL_ERROR, TAIL_OF_ZERO_EDGE = 0.002, 0.03
"""Error of the rolling moment by the oil upstream of the grid, over what that adds: twice that of
14 lines (M = 5 to 200, L = 0 to 15) against boxes from X = -20; where the edge has no pressure, the
film lacks that oil too."""
LOADED_END = 0.1
"""Largest pressure at the end of a roller, in Hertz pressures, beyond which the end is loaded."""
SIDE_FROM = 0.5
"""Distance from the centre line beyond which the film is thinnest at a side, in half-widths."""
SAMPLED, SAMPLED_SCARCE = 0.26, 0.65
"""Error of the minimum at a side lobe between two lines, over the range between it and the least
value of a convex film: 0.24 and 0.25 of 10 % on 385 lines of two outer rings (M = 44,000). Lobes of
scarce oil are shallow and narrow: 0.63 of 1.9 % on 193 lines of an inner ring (M = 2,639). Minima
beside the steep ends of two rollers (M = 11 and 60) err by up to 0.3 of 1.3 to 4 %."""
Part = Literal["x", "y", "z"]
SPIKE_FROM = 0.5
"""X downstream of which the pressure spike is searched, in Hertz half-widths."""
NODES_OF_NARROW = 3
"""Most nodes of a spike at half of its excess, which may then double: two lines (L = 11 and 17, 257
nodes) whose spikes seemed resolved have 3; 0.29 and 0.58 grow to 0.56 and 1.03 on finer grids."""
BEND_OF_NARROW = 0.6
"""Second difference at the top over the excess, that of a smooth spike on as few nodes: above it a
cusp falls between nodes. That of a line (M = 9, L = 15, 513 nodes) has 1.4; 0.46 grows to 0.78."""


def measured(level: Level, scaled: ScaledProblem, state: FilmState | None) -> dict[str, float]:
    """Return the values of a converged grid by name.

    ``pressure_max`` and its ``bend``, ``film_mean`` over the Hertz contact, ``spike`` and its
    ``excess`` over Hertz, also if it is ``narrow`` [-]; the parts of the load on solids
    (`tehl.solver.physics.share`) [-]; of a rough contact ``ripple_film`` and ``ripple_pressure``
    [-]; of a sliding one ``traction_mid_film`` and ``traction_across`` [-], with spin
    ``drilling_moment`` over load times a_x; of a heated film the rises that
    `tehl.post.heat.Temperature` has [K], and ``heat_`` with the names of the powers in
    `tehl.result.fields.HeatBalance` [W].

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact.
    state : FilmState or None
        Temperature and stress on that grid; None for an isothermal Newtonian film, and on coarse
        grids that are not heated: their traction would be that of a Newtonian film.
    """
    pressure = level.film.p
    found = {
        "pressure_max": float(pressure.max()),
        "bend": _bend(pressure),
        "film_mean": contact_mean(level.grid.x, level.grid.y, level.film.h, scaled.groups.skew),
        **_spike(level),
    }
    found |= level.share.parts(level)
    if level.equations.groups.shape.as_line:
        found |= line_rolling(level, scaled)
    if level.sources.heights is not None:
        grid, shape = level.grid, level.equations.groups.shape
        waves = ripples(grid.x, grid.y, level.film.h, pressure, shape)
        found |= {"ripple_film": waves[0], "ripple_pressure": waves[1]}
    if state is None and scaled.problem.is_coupled:  # a coarse grid, still isothermal
        return found
    if state is not None and state.grid != level.grid:
        return found
    found |= _sliding(level, scaled, state)
    if state is not None and state.model.terms.heat:
        powers = asdict(heat_balance(state)).items()
        heated = _rises(state) | {f"heat_{name}": power for name, power in powers}
        found |= heated | _warmed_before(level, scaled, heated)
    return found


def _warmed_before(
    level: Level, scaled: ScaledProblem, values: dict[str, float]
) -> dict[str, float]:
    """Return errors of rises and of the heat of surfaces by what warms these upstream [-].

    What a longer domain adds to the rises of 29 contacts that roll (M = 3 to 1,400) is 0.1 to 1.8
    of it, 23 of them below 1. Of 34 lines it moves more than 1 % of the heat of shear from one
    surface to the other in eight: 0.4 to 1 of `heat_across` in seven, and in one that rises by
    0.8 K, where both are warmed alike, 1.02 %, below what `LEAST_KELVIN` leaves. As heat passes the
    film, neither surface errs by less than the mean of both.
    """
    first, second = warmed_upstream(scaled, -level.grid.domain.x[0])
    mean, moved = 0.5 * (first + second), heat_across(scaled, first - second)
    warmer = Rises(max(first, second), mean, max(first, mean), max(second, mean))._asdict()
    errors = warmer | {f"heat_surface_{side}": moved for side in (1, 2)}
    return {f"{name}_tail": abs(errors[name] / values[name]) for name in errors if values[name]}


def _sliding(level: Level, scaled: ScaledProblem, state: FilmState | None) -> dict[str, float]:
    """Return traction and moment of the sliding of a contact, those that there are [-].

    The ``_tail`` of each is the part of it that the zone may have beyond the sides of the grid, and
    the error of cells that its edge cuts.
    """
    found, skew = {}, scaled.groups.skew
    for name, (part, speed) in _parts(scaled).items():
        if speed:
            found[name] = mid_film_traction(level, scaled, state, part=part)
            wet = mid_film_stress(level, scaled, state, part) * wet_part(level.film.p)
            inside = level.equations.balances.integral(wet * zone_of(level.grid, skew))
            if inside:  # not if all oil is cavitated
                outside = abs(beside(level.grid, wet, skew) / inside)
                found[f"{name}_tail"] = outside + cut_error(level.grid)
    return found


def _parts(scaled: ScaledProblem) -> dict[str, tuple[Part, float]]:
    """Return parts of traction and moment, and the sliding at this moment that makes each."""
    motion, moment = scaled.problem.motion, scaled.moment
    return {
        "traction_mid_film": ("x", moment.sliding),
        "traction_across": ("y", moment.across or motion.spin_1 - motion.spin_2),
        "drilling_moment": ("z", math.hypot(motion.spin_1, motion.spin_2)),
    }


def tractions(level: Level, scaled: ScaledProblem, state: FilmState | None) -> dict[str, float]:
    """Return traction at mid-film along x and y over the load of the moment, and the moment of it.

    Both of a step of a transient run [-]; the moment is over a_x and the load of the contact.

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact with the load and the sliding of the moment.
    state : FilmState or None
        Temperature and stress on that grid; None for an isothermal Newtonian film.
    """
    load, slides = scaled.moment.load, _parts(scaled)
    along, across, drilling = (
        mid_film_traction(level, scaled, state, load, part) if part == "x" or speed else 0.0
        for part, speed in slides.values()
    )
    return {
        "traction": along,
        "traction_across": across,
        "drilling_moment": drilling * load,
    }


def line_rolling(level: Level, scaled: ScaledProblem) -> dict[str, float]:
    """Return the rolling integral of a line or roller [-], and its error by the oil upstream [-].

    Also, where it is not symmetric, the ``tilt`` of a roller that follows from the moment of its
    load [rad], or else ``tilting``, that moment about x [-].

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact.
    """
    grid, (found, tail) = level.grid, rolling_integral(level, scaled)
    error = TAIL_ERROR if level.far_field is not None else TAIL_OF_ZERO_EDGE
    known = {"rolling": found, "rolling_tail": error * abs(tail / found) if found else 0.0}
    if not scaled.problem.has_tilting_moment:
        return known
    tilt = tilt_of(level)
    if tilt is not None:
        return known | {"tilt": tilt}
    moment = level.equations.balances.integral(grid.centres[:, None] * level.pressure)
    return known | {"tilting": moment}


def rolling_integral(level: Level, scaled: ScaledProblem) -> tuple[float, float]:
    """Return the rolling integral of a line or roller, and what of it is upstream of the grid [-].

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact with the speed and the curvature of the moment.
    """
    film, grid = level.film, level.grid
    peaks, oil = film.p.argmax(axis=1)[:, None], None
    if scaled.problem.supply is None or film.partial[0, 0] == 0:  # it reaches further upstream
        oil = np.take_along_axis(film.rho * film.h, peaks, axis=1)[:, 0]
    lines = Lines(grid.x, film.p, level.separation, grid.widths, slowing(scaled, grid.y))
    found, _, tail = rolling(lines, oil, scaled.entering, scaled.moment)
    return found, tail


def rolling_moment(level: Level, scaled: ScaledProblem) -> float:
    """Return the moment of the pressure of a line or roller about the middle [-], zero of others.

    As the deflection by a pressure makes none, it is the integral of H dP/dX over the curvature of
    the gap, in p_h a_x^2 a_y.

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        As of `rolling_integral`.
    """
    if not level.equations.groups.shape.as_line:
        return 0.0
    return rolling_integral(level, scaled)[0] / scaled.moment.curvature


def tilt_of(level: Level) -> float | None:
    """Return the tilt of a roller [rad]; None where it does not follow from its moment."""
    roller = level.equations.groups.roller
    if roller is None or roller.moment is None:
        return None
    return roller.tilt + roller.tilt_unit * float(level.rigid[1:].sum())


def film_numbers(level: Level) -> dict[str, float]:
    """Return ``film_central`` and ``film_minimum`` between the nodes [-]."""
    film = film_summary(level.grid, level.film.h, level.equations.solids.contact_film)
    return {"film_central": film.central, "film_minimum": film.minimum}


def is_thinnest_at_end(level: Level) -> bool:
    """Whether the film is thinnest at the end of a roller, and the oil there under pressure.

    Its pressure has no limit at a sharp end, and the film has none either.
    """
    film = level.film
    row = int(film.h.min(axis=1).argmin())
    return row in ends_of(level) and float(film.p[row].max()) > LOADED_END


def is_thinnest_at_side(level: Level) -> bool:
    """Whether a film is thinnest beside the edge of an ellipse: the mesh along y decides there."""
    grid = level.grid
    row = int(level.film.h.min(axis=1).argmin())
    return grid.ny > 1 and not grid.is_closed and abs(float(grid.y[row])) > SIDE_FROM


def side_reach(level: Level, *, scarce: bool = False) -> float:
    """Return by what part the minimum film may be too thick, as lines miss the lobe at a side [-].

    The lobe beside the edge of an ellipse is narrow across the flow, and that beside a steep end of
    a roller. From line to line its film is convex, so that it lies above the lines through the next
    ones. The minimum that was found may be elsewhere.

    Parameters
    ----------
    level : Level
        Its film is up to date.
    scarce : bool
        Whether oil is scarce.
    """
    grid, film = level.grid, level.film.h.min(axis=1)
    if grid.ny == 1 or film.min() <= 0.0:
        return 0.0
    y, margin = grid.y, 2
    if grid.is_closed:
        y, film = replace(grid, mirror=False).y, grid.unfold(level.film.h).min(axis=1)
        row = int(film.argmin())
        if not margin <= row < film.size - margin:
            return 0.0
    else:
        aside = np.where(np.abs(y) > SIDE_FROM, film, np.inf)
        row = int(aside[margin:-margin].argmin()) + margin
    found = film_summary(grid, level.film.h).minimum
    near = (slice(row - 2, row + 2), slice(row - 1, row + 3))
    least = min(_least_between(film[lines], y[lines]) for lines in near)
    return max((SAMPLED_SCARCE if scarce else SAMPLED) * (1.0 - least / found), 0.0)


def _least_between(values: Array, places: Array) -> float:
    """Return the least value of a convex function between the middle two of four places.

    It lies above the lines through both pairs.
    """
    before, left, right, after = map(float, values)
    south, width, north = map(float, np.diff(places))
    falls, rises = (left - before) * width / south, (after - right) * width / north
    if rises <= falls:
        return min(left, right)
    place = min(max((right - rises - left) / (falls - rises), 0.0), 1.0)
    return max(left + falls * place, right + rises * (place - 1.0))


def is_pressed_at_end(level: Level) -> bool:
    """Whether the pressure is largest at the end of a roller, where it has no limit."""
    return int(level.film.p.max(axis=1).argmax()) in ends_of(level)


def ends_of(level: Level) -> tuple[int, ...]:
    """Return the stored rows at the ends of a roller, none of contacts without them."""
    grid = level.grid
    if not grid.is_closed or level.equations.groups.shape.goes_on:
        return ()
    return (grid.shape[0] - 1,) if grid.mirror else (0, grid.shape[0] - 1)


def solid_friction(level: Level, scaled: ScaledProblem) -> float:
    """Return the friction of the solids along their sliding, over the load [-].

    With spin the sum of friction in all directions; where nothing slides, what would begin to.

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact with the sliding of the moment.
    """
    rubbing, integral = level.share.rubbing(level), level.equations.balances.integral
    if rubbing is None:
        return 0.0
    slides = np.broadcast_arrays(*sliding_field(scaled, level.grid.x, level.grid.y))
    speed = np.hypot(*slides)
    if not speed.any():
        return integral(rubbing[0]) / level.sources.load
    per_speed = rubbing[0] / np.where(speed > 0.0, speed, np.inf)
    return math.hypot(*(integral(per_speed * part) for part in slides)) / level.sources.load


def _spike(level: Level) -> dict[str, float]:
    """Return what `spike_of` does of the film of a level, downstream."""
    behind = np.s_[:, level.grid.x > SPIKE_FROM]
    return spike_of(level.film.p[behind], dry_pressure(level.grid, level.equations.groups)[behind])


def spike_of(pressure: Array, dry: Array) -> dict[str, float]:
    """Return the ``spike``, its ``excess`` over the dry pressure, and by how much it may rise [-].

    By as much again, ``narrow``, where few nodes have half of it, or where it is a cusp; else zero.

    Parameters
    ----------
    pressure, dry : (ny, nx) array
        Of nodes downstream.
    """
    above = pressure - dry
    spike, excess = float(pressure.flat[above.argmax()]), float(above.max())
    is_narrow = _nodes_across(above) <= NODES_OF_NARROW or _bend(above) > BEND_OF_NARROW * excess
    return {"spike": spike, "excess": excess, "narrow": excess * is_narrow}


def _bend(pressure: Array) -> float:
    """Return the larger second difference at the largest pressure, along x or y [-]."""
    inner = np.pad(pressure, 1, mode="edge")
    j, i = (index + 1 for index in divmod(int(pressure.argmax()), pressure.shape[1]))
    beside = min(inner[j, i - 1] + inner[j, i + 1], inner[j - 1, i] + inner[j + 1, i])
    return float(2.0 * inner[j, i] - beside)


def _nodes_across(above: Array) -> int:
    """Return on how many nodes along x a spike has at least half of its largest excess."""
    row, highest = divmod(int(above.argmax()), above.shape[1])
    lower = np.flatnonzero(~np.pad(above[row] >= 0.5 * above[row, highest], 1)) - 1
    after = int(np.searchsorted(lower, highest))
    return int(lower[after] - lower[after - 1] - 1)


def mid_film_stress(
    level: Level, scaled: ScaledProblem, state: FilmState | None, part: Part = "x"
) -> Array:
    """Return the stress tau_zx of the oil at mid-film, zero where surfaces touch, [-].

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact.
    state : FilmState or None
        Stress of a heated or shear-thinning film.
    part : {"x", "y", "z"}
        Also tau_zy, or the moment of both about z per area [a_x].
    """
    if state is None:
        along, across = newtonian_sliding(level, scaled)
    else:
        along, across = (state.view(name).T.copy() for name in ("tau_x", "tau_y"))
    found = along if part == "x" else across
    if part == "z":
        y = scaled.groups.ellipticity * level.grid.y[:, None]
        found = level.grid.x * across - y * along
    found[level.share.meets(level)] = 0.0
    return found


def mid_film_traction(
    level: Level,
    scaled: ScaledProblem,
    state: FilmState | None,
    load: float = 1.0,
    part: Part = "x",
) -> float:
    """Return the mid-film traction coefficient, the integral of the stress over the load [-].

    That of the film in the loaded zone: nodes where surfaces touch through a boundary film are left
    out.

    Parameters
    ----------
    level, scaled : Level, ScaledProblem
        The grid, and the contact.
    state : FilmState or None
        Stress of a heated or shear-thinning film.
    load : float
        Load over that of the contact [-].
    part : {"x", "y", "z"}
        Along x or y, or the moment about z [a_x].
    """
    stress, scales = mid_film_stress(level, scaled, state, part), scaled.scales
    wet = stress * zone_of(level.grid, scaled.groups.skew) * wet_part(level.film.p)
    area = scales.half_width_x * scales.half_width_y
    unit = stress_unit(scales) * area / (scales.load * load)
    return level.equations.balances.integral(wet) * unit


def _rises(state: FilmState) -> dict[str, float]:
    """Return the rises over the oil at the inlet, the largest ones of the loaded zone [K]."""
    temperature, inlet = state.temperature, state.film.scaled.scales.temperature
    inside = is_inside(state.grid.x, state.grid.y, state.film.scaled.groups.skew).T
    first, second = (float(temperature[:, side][inside].max()) - inlet for side in (0, -1))
    weights = lagrange_weights(state.film.across.zeta, 0.5)
    middle = np.ascontiguousarray(np.einsum("k,xky->yx", weights, temperature))
    largest = float(temperature.max(axis=1)[inside].max()) - inlet
    return Rises(largest, central_value(state.grid, middle) - inlet, first, second)._asdict()


def is_resolved(level: Level) -> bool:
    """Return whether the film exceeds the floor of the conductance, or is the boundary film."""
    return level.share.bounds_film or float(level.film.h.min()) > level.equations.floor


def film_extremes(level: Level) -> tuple[float, float]:
    """Return central and smallest film of a level [-], at nodes.

    Where lines crowd it is that between them: nodes sample the valley beside a steep end at random,
    so that their changes from grid to grid say little.
    """
    grid, film = level.grid, level.film.h
    if grid.crowding:
        return central_value(grid, film), film_summary(grid, film).minimum
    return central_value(grid, film), float(film.min())
