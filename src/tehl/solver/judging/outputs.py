"""Shear stress, temperature and heat balance of a finished run, in SI and on the stored domain.

Equations in docs/theory/thermal.md; the isothermal Newtonian stress is eta du/dz of Couette and
Poiseuille flow.
"""

import numpy as np

from tehl.base.typing import Array
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import sliding_field
from tehl.operators.energy import FilmState, pressure_slopes
from tehl.operators.heated_film import stress_unit
from tehl.operators.loaded_zone import wet_part, zone_of
from tehl.operators.reynolds import conductance
from tehl.result.fields import (
    FilmAsperities,
    FilmContact,
    FilmHeat,
    FilmOil,
    FilmShear,
    HeatBalance,
)
from tehl.solver.cycle.level import Level
from tehl.solver.physics.cavity import oil_flow, secant


def newtonian_shear(level: Level, scaled: ScaledProblem) -> FilmShear:
    """Return the shear stress of an isothermal Newtonian film, from pressure and film.

    Parameters
    ----------
    level : Level
        Finest level with its pressure and film up to date.
    scaled : ScaledProblem
        With the slide-roll ratio and the stress unit.
    """
    grid, groups = level.grid, scaled.groups
    slope_x, _ = pressure_slopes(grid, groups, level.film.p)
    sliding, across = newtonian_sliding(level, scaled)
    rolling = 6.0 / groups.lambda_bar * level.film.h * slope_x
    unit = stress_unit(scaled.scales)
    return FilmShear(
        surface_1=unit * (sliding - rolling),
        mid_film=unit * sliding,
        surface_2=unit * (sliding + rolling),
        across=unit * across,
        thinning=np.ones(grid.shape),
    )


def newtonian_sliding(level: Level, scaled: ScaledProblem) -> tuple[Array, Array]:
    """Return the mid-film stress of an isothermal Newtonian film, along x and y [-].

    It is -SRR eta/h along the sliding, both of ``grid.shape``.

    Parameters
    ----------
    level : Level
        The film counts from the floor of the conductance on.
    scaled : ScaledProblem
        With the motion and the viscosity at the inlet temperature.
    """
    scales, slides = scaled.scales, sliding_field(scaled, level.grid.x, level.grid.y)
    if not any(part.any() for part in slides):
        return np.zeros(level.grid.shape), np.zeros(level.grid.shape)
    film = np.maximum(level.film.h, level.equations.floor)
    lubricant = scaled.problem.lubricant
    eta = lubricant.viscosity.viscosity(scales.hertz_pressure * level.film.p, scales.temperature)
    along, across = (-part * eta / scales.viscosity / film for part in slides)
    return along, across


def film_shear(state: FilmState) -> FilmShear:
    """Return the shear stress of a heated or shear-thinning film."""
    sliding = state.view("tau_x")
    unit = stress_unit(state.film.scaled.scales)
    # the force on the gap, whatever asperities leave of its flow
    slope_x, _ = pressure_slopes(state.grid, state.film.scaled.groups, state.view("p").T)
    rolling = 0.5 * state.model.terms.poiseuille * state.view("h") * slope_x.T
    return FilmShear(
        surface_1=_rows(unit * (sliding - rolling)),
        mid_film=_rows(unit * sliding),
        surface_2=_rows(unit * (sliding + rolling)),
        across=_rows(unit * state.view("tau_y")),
        thinning=_rows(state.view("effective")),
    )


def film_heat(state: FilmState) -> FilmHeat | None:
    """Return the temperatures of a heated film, None for an isothermal one."""
    if not state.model.terms.heat:
        return None
    temperature = state.temperature
    unit = state.film.flux_unit
    flux_1, flux_2 = (unit * flux for flux in state.fluxes)
    return FilmHeat(
        zeta=state.film.across.zeta.copy(),
        weights=state.film.across.weights.copy(),
        temperature=np.array(np.moveaxis(temperature, (1, 2), (0, 1)), order="C"),
        flux_1=_rows(flux_1),
        flux_2=_rows(flux_2),
        balance=heat_balance(state),
        solid_peclet=state.film.solid_peclet,
        sources=state.solids.forms,
    )


def heat_balance(state: FilmState) -> HeatBalance:
    """Return the heat balance of the film under pressure in the loaded zone [W].

    The enthalpy carried out is the divergence of its flux by central differences, which the solver
    does not use: the error of the balance measures the discretisation error.
    """
    grid, view, terms = state.grid, state.view, state.model.terms
    pressure, along, sideways = view("p"), view("enthalpy_x"), view("enthalpy_y")
    carried = np.zeros_like(pressure)
    carried[1:-1] += 0.5 * terms.over_x * (along[2:] - along[:-2])
    over_y = terms.over_y * state.fields.closer[: grid.shape[0]]
    way = 1.0 if grid.wraps else -1.0  # behind a mirror oil flows the other way
    before, behind = (way * rows.T for rows in grid.beyond(sideways.T, 1))
    wider = np.concatenate([before, sideways, behind], axis=1)
    across = slice(1 - before.shape[1], pressure.shape[1] - 1 + behind.shape[1])
    carried[:, across] += 0.5 * over_y[across] * (wider[:, 2:] - wider[:, :-2])
    area = np.zeros_like(pressure)
    area[1:-1] = grid.widths / grid.dy
    area[:, list(grid.edge_rows)] = 0.0
    scales, skew = state.film.scaled.scales, state.film.scaled.groups.skew
    area *= (wet_part(pressure.T) * zone_of(grid, skew)).T  # of the film under pressure in the zone
    area *= grid.dx * grid.dy * scales.half_width_x * scales.half_width_y * state.film.flux_unit
    powers = (view("shear"), view("work"), *state.fluxes, carried)
    shear, compression, first, second, out = (float((area * power).sum()) for power in powers)
    return HeatBalance(
        shear=shear, compression=compression, surface_1=first, surface_2=second, carried_out=out
    )


def film_asperities(level: Level, scaled: ScaledProblem) -> FilmAsperities | None:
    """Return pressure, area, spots and separation of asperities; None without.

    Parameters
    ----------
    level : Level
        Finest level with its separations up to date.
    scaled : ScaledProblem
        With the law of asperities and the rms height of both surfaces [m].
    """
    problem, scales = scaled.problem, scaled.scales
    if problem.asperities is None:
        return None
    separation, sigma = level.separation * scales.film_thickness, problem.asperity_rms
    area, spots = problem.asperities.spots(separation / sigma, sigma)
    apart = ~level.share.meets(level)  # where surfaces touch the contact carries all
    return FilmAsperities(
        pressure=apart * level.film.asperity * scales.hertz_pressure,
        area=apart * area,
        spots=apart * spots,
        separation=separation,
        rms=np.array(sigma),
        balance=np.array(asperity_balance(level)),
    )


def film_contact(level: Level, scaled: ScaledProblem) -> FilmContact | None:
    """Return the pressure of contact through a boundary film; None without.

    Parameters
    ----------
    level : Level
        Finest level.
    scaled : ScaledProblem
        With the Hertz pressure [Pa].
    """
    if level.equations.solids.contact_film is None:
        return None
    solids = level.film.asperity
    if level.equations.solids.asperities is not None:
        solids = np.where(level.share.meets(level), solids, 0.0)
    pressure = solids * scaled.scales.hertz_pressure
    return FilmContact(pressure=pressure, balance=np.array(contact_balance(level)))


def contact_balance(level: Level) -> float:
    """Return the largest mass-balance error upstream of any section, of film and contact [-].

    Relative to the oil that passes through |Y| < 1 at X = 0. Cavities do not count unless they
    conserve oil.
    """
    if level.stencil.conserves:
        return oil_balance(level)
    grid, film = level.grid, level.film
    middle, inside = int(np.argmin(np.abs(grid.x))), np.abs(grid.y) < 1.0
    through = float(_line_weights(grid)[inside] @ (film.rho * film.h)[inside, middle])
    return _largest_mass_error(level) / through


def asperity_balance(level: Level) -> float:
    """Return the largest mass-balance error upstream of any section, with asperities [-].

    Relative to the oil that the surfaces bring; what leaves through the side edges counts as
    passed. Cavities do not count unless they conserve oil.
    """
    if level.stencil.conserves:
        return oil_balance(level)
    entering = _line_weights(level.grid) @ (level.film.rho * level.film.h)[:, 0]
    return _largest_mass_error(level) / float(entering)


def _largest_mass_error(level: Level) -> float:
    """Return the largest mass-balance error upstream of any section, as rho H [-]."""
    return float(np.abs(_made_upstream(level)).max())


def _made_upstream(level: Level) -> Array:
    """Return the oil that is made upstream of each section, as rho H, (nx,) [-]."""
    level.evaluate_residual()
    return np.cumsum(_line_weights(level.grid) @ level.sources.residual) * level.grid.dx


def _line_weights(grid: Grid) -> Array:
    """Return of how many lines of the full domain each line is an image, (ny,)."""
    if grid.is_closed:
        return grid.widths / grid.dy
    weights = np.ones(grid.shape[0])
    if grid.mirror:
        weights[1:] = 2.0
    return weights


def film_oil(level: Level, scaled: ScaledProblem) -> FilmOil | None:
    """Return where the oil is; None if cavities do not conserve it.

    Parameters
    ----------
    level : Level
        Finest level with the marks of partly filled nodes.
    scaled : ScaledProblem
        With the film scale [m].
    """
    if not level.stencil.conserves:
        return None
    (held, passed), grid, unit = oil_flow(level), level.grid, scaled.scales.film_thickness
    film = level.film
    full = film.rho * np.maximum(film.h, level.equations.floor)
    fill = np.where(film.partial > 0, np.minimum(held / full, 1.0), 1.0)
    if film.speed.size:  # nothing is solved where oil leaves, nor on the sides
        forth = film.speed > 0.0
        fill[forth, -1], fill[~forth, 0] = fill[forth, -2], fill[~forth, 1]
    for edge in grid.edge_rows:
        fill[edge] = fill[1 if edge == 0 else -2]
    return FilmOil(
        fill=fill,
        entering=_unfold_line(grid, passed[:, 0] * unit),
        leaving=_unfold_line(grid, passed[:, -2] * unit),
    )


def _unfold_line(grid: Grid, values: Array) -> Array:
    return np.concatenate([values[:0:-1], values]) if grid.mirror else values.copy()


def oil_balance(level: Level, *, until: float = np.inf) -> float:
    """Return the largest change of the oil flux between sections across the flow, relative [-].

    The flux through the side edges counts.

    Parameters
    ----------
    level : Level
        Conserving oil in cavities.
    until : float
        X up to which all sections count; further downstream only the last one does.
    """
    _, passed = oil_flow(level)
    if level.film.speed.size:  # oil enters and leaves through all sides
        entering = float(np.maximum(passed[:, 0], 0.0).sum())
        made = _made_upstream(level)[level.grid.x <= until]
        return float(np.abs(made).max()) / entering
    film, stencil, mirror = secant(level.film), level.stencil, level.grid.mirror
    weights = np.ones(passed.shape[0])
    if level.grid.ny > 1:
        weights[0] = 0.5 if mirror else 0.0
        weights[-1] = 0.0
    if level.grid.is_closed:
        weights = level.grid.widths / level.grid.dy
    through = weights @ passed[:, :-1]
    sides = np.zeros(passed.shape[1])
    edges = ((-1, -2), (0, 1))[: 1 if mirror else 2] if level.grid.edge_rows else ()
    for edge, inner in edges:
        eps = conductance(stencil, film.eps_y[edge], film.eps_y[inner])
        sides += stencil.cy * eps * (film.p[edge] - film.p[inner])
    gained = np.cumsum(sides[1:-1]) / (stencil.w0 - stencil.w2)
    change = np.abs(through[1:] - through[0] - gained) / through[0]
    counts = level.grid.x[1 : change.size + 1] <= until
    counts[-1] = True
    return float(change[counts].max())


def _rows(field: Array) -> Array:
    """Return a field stored with y last with its rows first, (ny, nx)."""
    return np.array(field.T, order="C")
