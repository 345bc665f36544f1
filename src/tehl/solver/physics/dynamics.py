"""Stiffness and damping of a steady film over frequency, in SI, with their error bars.

The linear equations are those of `tehl.solver.physics.response`.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt

from tehl.base.typing import Array
from tehl.contact.dynamics import Dynamics
from tehl.kernels import reynolds
from tehl.operators.transfer import injected
from tehl.result.fields import FilmDynamics
from tehl.result.solution import Hint, Solution, Status
from tehl.solver.cycle.coarsest import CoarsestSolver
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.newton import one_thread
from tehl.solver.cycle.start import pose_problem
from tehl.solver.physics.frequencies import (
    STATIC_RESIDUAL,
    CloseInverses,
    Directions,
    NoResponseError,
    Solutions,
)
from tehl.solver.physics.response import FilmResponse

FRONT_DISTANCE = 0.1
"""Distance from the cavity, in half-widths, at which the pressure limits the amplitude."""
RESPONSE_BAR, ROLLER_BAR, FRONT_BAR = 0.5, 1.5, 4.0
"""Error bar over the change between two grids: of a value of second order a third, measured up to
0.41 (M 50 and 100, L 5 and 10); of first order at the ends of a roller (its stiffness changes by
0.74, 0.36, 0.17 % from 33 lines to 257), and where a film begins behind a meniscus."""
LEAST_FRONT_BARS = 0.5, 20.0
"""Least bars behind a meniscus of stiffness and damping, over themselves and the mesh width: two
grids may agree by chance. Stiffnesses of two contacts (r = 0.4 and 0.6) differ from those of steady
films by up to 0.4, dampings of one grid and the next by up to 12 mesh widths."""
LARGEST_STEP = 0.5 * np.pi
"""Frequency times the mesh width [-] beyond which a wave of oil has less than four mesh widths: the
bars are then the values themselves."""
BAR_CYCLES = 12
"""Cycles on the coarser grid of the error bars, from the film of the finer one."""


class Changes(NamedTuple):
    """Changes of load and rolling force by approach and speed, over frequency [-].

    (2, n) each: that in phase, and that ahead by a quarter period, over Omega; ``pressure`` is
    |P_1| over the approach, (n, ny nx).
    """

    load_by_approach: Array
    rolling_by_approach: Array
    load_by_speed: Array
    rolling_by_speed: Array
    pressure: Array


def with_dynamics(result: Solution, run: FilmSolver) -> Solution:
    """Return a converged result with the stiffness and damping of its film, or with why not.

    Parameters
    ----------
    result : Solution
        Of a case with ``[dynamics]``.
    run : FilmSolver
        As for `film_dynamics`.
    """
    assert result.problem.dynamics is not None
    try:
        return result.but(dynamics=film_dynamics(run, result.problem.dynamics))
    except NoResponseError as error:
        scales = result.scales
        hertz = error.omega * scales.speed / (2.0 * np.pi * scales.half_width_x)
        message = f"The response of the film at {hertz:.3g} Hz does not converge."
        if result.status.is_vague:
            status = replace(result.status, message=f"{result.status.message} {message}")
        else:
            hint = Hint("State other dynamics.frequencies, or fewer nodes.")
            status = Status(kind="converged", cause="stiffness_open", message=message, hint=hint)
        return result.but(status=status)


def film_dynamics(run: FilmSolver, settings: Dynamics) -> FilmDynamics:
    """Return stiffness and damping of the film of a finished run.

    The temperatures, and the thinning by shear, stay those of the steady film. The coarser levels
    of the run are overwritten.

    Parameters
    ----------
    run : FilmSolver
        With a converged film on its finest level.
    settings : Dynamics
        Frequencies.
    """
    scales, groups = run.hierarchy.scaled.scales, run.hierarchy.scaled.groups
    time = scales.half_width_x / scales.speed
    frequency = np.array(settings.over(time))
    omegas, excess = 2.0 * np.pi * frequency * time, run.coupling.excess()
    found = changes(run.levels, omegas, excess)
    near = run.finest.equations.grid
    is_line = near.shape[0] == 1
    lengths = (1.0 if is_line else groups.ellipticity * near.dy, near.dx)
    wet = run.finest.film.p > 0.0
    inside = (distance_transform_edt(wet, sampling=lengths) > FRONT_DISTANCE) & wet
    pressure = run.finest.film.p[inside]
    amplitude = np.array([1.0 / (one[inside.ravel()] / pressure).max() for one in found.pressure])
    force = scales.hertz_pressure * scales.half_width_x * scales.half_width_y
    film, tangent = scales.film_thickness, force * scales.film_thickness / scales.half_width_x

    def in_si(pair: Array, unit: float) -> tuple[Array, Array]:
        return pair[0] * unit, pair[1] * unit * time

    stiffness, damping = in_si(found.load_by_approach, force / film)
    coarse = _coarse_changes(run, omegas, excess)
    bars = (np.abs(stiffness), np.abs(damping))  # 100 % where the coarser grid has no film
    if coarse is not None:
        part = ROLLER_BAR if near.is_closed else RESPONSE_BAR
        part = FRONT_BAR if run.finest.stencil.conserves else part
        other = in_si(coarse.load_by_approach, force / film)
        bars = (part * np.abs(stiffness - other[0]), part * np.abs(damping - other[1]))
    if run.finest.stencil.conserves:
        least = [part * near.dx for part in LEAST_FRONT_BARS]
        bars = (
            np.maximum(bars[0], least[0] * np.abs(stiffness)),
            np.maximum(bars[1], least[1] * np.abs(damping)),
        )
    unresolved = omegas * near.dx > LARGEST_STEP
    bars = (
        np.where(unresolved, np.maximum(bars[0], np.abs(stiffness)), bars[0]),
        np.where(unresolved, np.maximum(bars[1], np.abs(damping)), bars[1]),
    )
    by_speed = in_si(found.load_by_speed, force / scales.speed)
    rolling = in_si(found.rolling_by_approach, tangent / film)
    rolling_by_speed = in_si(found.rolling_by_speed, tangent / scales.speed)
    near_contact = FilmDynamics(
        frequency=frequency,
        stiffness=stiffness,
        damping=damping,
        stiffness_error=bars[0],
        damping_error=bars[1],
        amplitude=amplitude * film,
        load_by_speed=by_speed[0],
        load_by_acceleration=by_speed[1],
        rolling_stiffness=rolling[0],
        rolling_damping=rolling[1],
        rolling_by_speed=rolling_by_speed[0],
        rolling_by_acceleration=rolling_by_speed[1],
    )
    if not is_line:
        return near_contact
    problem = run.hierarchy.scaled.problem
    held = settings.held_at or problem.radius_x
    solids = 4.0 / (np.pi * problem.reduced_modulus) * np.log(held / scales.half_width_x)
    return held_away(near_contact, float(solids))


Pair = tuple[Array, Array]
"""A complex function of omega: its real part, and its imaginary part over omega."""


def held_away(film: FilmDynamics, compliance: float) -> FilmDynamics:
    """Return the dynamics with an elastic compliance in series, the solids of a line contact.

    Parameters
    ----------
    film : FilmDynamics
        By the approach at the contact.
    compliance : float
        [m/N].
    """
    squared = (2.0 * np.pi * film.frequency) ** 2

    def product(one: Pair, other: Pair) -> Pair:
        (a, b), (c, d) = one, other
        return a * c - squared * b * d, a * d + b * c

    load, by_speed = (film.stiffness, film.damping), (film.load_by_speed, film.load_by_acceleration)
    rolling = film.rolling_stiffness, film.rolling_damping
    softer = 1.0 + compliance * load[0], compliance * load[1]
    size = softer[0] ** 2 + squared * softer[1] ** 2
    part = softer[0] / size, -softer[1] / size  # of the approach, at the contact
    stiffness, damping = product(load, part)
    by_speed = product(by_speed, part)
    pressed = product(rolling, by_speed)
    rolling = product(rolling, part)
    return replace(
        film,
        stiffness=stiffness,
        damping=damping,
        stiffness_error=film.stiffness_error / size,
        damping_error=film.damping_error / size,
        amplitude=film.amplitude * np.sqrt(size),
        load_by_speed=by_speed[0],
        load_by_acceleration=by_speed[1],
        rolling_stiffness=rolling[0],
        rolling_damping=rolling[1],
        rolling_by_speed=film.rolling_by_speed - compliance * pressed[0],
        rolling_by_acceleration=film.rolling_by_acceleration - compliance * pressed[1],
    )


def changes(
    levels: Sequence[Level], omegas: Array, excess: Array | None = None, inputs: int = 2
) -> Changes:
    """Return the response of the film on the last of ``levels``, dimensionless.

    Parameters
    ----------
    levels : sequence of Level
        Coarsest first; the last one has the steady film.
    omegas : (n,) array
        Frequencies omega a_x / u_m.
    excess : (ny, nx) array or None
        1 - rho_e/rho* of a heated film (`tehl.solver.physics.thermal.Coupling.excess`).
    inputs : {1, 2}
        The approach alone, or the speed too: without it its changes are zero.
    """
    level = levels[-1]
    level.update()
    stored = None if excess is None else 1.0 - excess
    system = FilmResponse(level, stored)
    every, slopes = np.ones(system.unknown.size), system.outside
    # sources a and b of the approach, which lessens the film, and of the speed
    sources = ((system.by_film @ every, -system.density), (system.wedge, 0.0 * every))[:inputs]
    # what is not in the pressure: H_1 without deflection, and the load outside
    moved = (-1.0, 0.0)
    outside = ((0.0, 0.0 if slopes is None else -slopes.load_by_rate), (level.outside, 0.0))
    found = np.zeros((2, 2, 2, omegas.size))
    pressure = np.zeros((omegas.size, every.size))
    with one_thread():
        inverses = CloseInverses(system)
        still = Directions(system, 0.0, inverses.at(0.0))
        static = [still.solve(sources[0][0], 0.0 * every, STATIC_RESIDUAL)]
        known = still.for_others()  # of the approach: those of the speed cost what they save
        static += [still.solve(steady, 0.0 * every, STATIC_RESIDUAL) for steady, _ in sources[1:]]
        space = Solutions(
            system,
            [source[1] + system.parts(one)[1] for source, one in zip(sources, static, strict=True)],
        )
        for place in _ends_first(omegas.size):
            omega, directions = omegas[place], still if omegas[place] == 0.0 else None
            for number, one in enumerate(static):
                late, is_close = space.start(number, omega)
                if not is_close:
                    directions = directions or Directions(system, omega, inverses.at(omega), known)
                    late = space.at(number, directions, late)
                now, ahead = _forces(system, one, moved[number]), _forces(system, late, 0.0)
                now[0] += outside[number][0]
                ahead[0] += outside[number][1]
                found[number, :, 0, place] = now - omega * ahead.imag
                found[number, :, 1, place] = ahead.real
                if number == 0:
                    pressure[place] = np.abs(one + 1j * omega * late)
    (load, rolling), (load_by_speed, rolling_by_speed) = found
    return Changes(load, rolling, load_by_speed, rolling_by_speed, pressure)


def _forces(system: FilmResponse, change: Array, moved: float) -> Array:
    """Return load and rolling force of a change, whose film is its deflection plus ``moved``."""
    level, weights = system.level, _load_weights(system.level)
    pressure = np.where(system.carries, change, 0.0)
    film = moved + system.deflection(change)
    # int H P_x = -int P H_x as P vanishes on the edges
    by_film, by_pressure = (
        np.gradient(field, level.grid.dx, axis=1).ravel() for field in (level.film.p, level.film.h)
    )
    rolling = 0.5 * (weights @ (by_film * film) - weights @ (by_pressure * pressure))
    load = weights @ pressure
    if system.outside is not None:
        load += system.outside.load_by_film @ film.reshape(level.grid.shape)[:, 0]
    if system.face is not None and system.outside is not None:
        flux = system.face.by_pressure @ pressure + system.face.by_film @ film
        load += system.outside.load_by_flux @ flux
    return np.array([load, rolling])


def _load_weights(level: Level) -> Array:
    """Return the weights of the nodes in the load, by the trapezoidal rule, (n,)."""
    grid = level.grid
    along, across = np.ones(grid.shape[1]), np.full(grid.shape[0], 2.0 if grid.mirror else 1.0)
    along[[0, -1]] = 0.5
    across[[0, -1]] *= 0.5
    return np.asarray(level.equations.balances.load.area * np.outer(across, along).ravel())


def _ends_first(number: int) -> list[int]:
    """Return the places of a list, ends first and then middles: the space serves more of them."""
    order, intervals = [0, number - 1], [(0, number - 1)]
    for low, high in intervals:  # grows
        if high - low > 1:
            middle = (low + high) // 2
            order.append(middle)
            intervals += [(low, middle), (middle, high)]
    return list(dict.fromkeys(order))


def _coarse_changes(run: FilmSolver, omegas: Array, excess: Array | None) -> Changes | None:
    """Return the same on the grid of twice the mesh width, at its own film; None if it has none.

    A heated film has the temperatures of the finest grid there.
    """
    hierarchy, levels = _coarser(run)
    if not levels:
        return None
    fine = run.finest
    level = levels[-1]
    level.set_state(injected(fine.film.p, level.film.p), fine.rigid)
    pose_problem(level)
    if excess is not None:
        level.update()
        level.write_source()
    try:
        for _ in range(BAR_CYCLES):
            if len(levels) == 1:
                _newton_step(hierarchy.coarsest, level)
            else:
                hierarchy.cycle(levels)
        level.update()
        if not (level.evaluate_residual() < 1e-4 and abs(level.load_error()) < 1e-4):
            return None
        return changes(
            levels, omegas, None if excess is None else injected(excess, level.film.p), inputs=1
        )
    except ArithmeticError:
        return None


def _coarser(run: FilmSolver) -> tuple[Hierarchy, list[Level]]:
    """Return levels up to that of twice the mesh width along both axes; none if there is none."""
    fine, hierarchy, levels = run.finest, run.hierarchy, list(run.levels[:-1])
    if not fine.grid.can_coarsen():
        return hierarchy, []
    half = fine.grid.coarser()
    if levels and levels[-1].grid == half:
        return hierarchy, levels
    if fine.factors is not None:
        return hierarchy, []
    # of few lines columns alone are halved
    relaxation = fine.smoother.relaxation
    hierarchy = Hierarchy.on(half, hierarchy.scaled, hierarchy.options, relaxation)
    return hierarchy, hierarchy.levels


def _newton_step(coarsest: CoarsestSolver, level: Level) -> None:
    """Perform a Newton step on the coarsest grid alone.

    Its wedge is of second order: what those of the result have more is a source of the last state.
    """
    source = level.sources.reynolds
    posed, robust, own = source.copy(), np.empty_like(source), np.empty_like(source)
    level.update()
    reynolds.operator(level.film, level.equations.robust, robust)
    reynolds.operator(level.film, level.stencil, own)
    source += robust - own
    coarsest.step()
    source[:] = posed
