"""Profiles and mass balance of a film."""

from dataclasses import dataclass

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.operators.loaded_zone import contact_mean
from tehl.post.traction import cell_widths, slope_across
from tehl.result.solution import Solution


def no_film(result: Solution) -> str:
    """Return why ``result`` has no film (h <= 0); an empty text if it has one."""
    if result.status.kind == "diverged":
        return "the iteration diverged"
    return "" if result.film.minimum > 0 else "the last iterate is not positive"


def mean_film(result: Solution) -> float | None:
    """Return the mean film over the Hertz contact [m]; None where there is no film."""
    if no_film(result):
        return None
    x, y, skew = result.scaled.x, result.scaled.y, result.groups.skew
    return contact_mean(x, y, result.film_thickness, skew)


@dataclass(frozen=True, kw_only=True, slots=True)
class Profile:
    """Pressure and film on one grid line, beside the dry contact."""

    coordinate: Array
    """Along the line [m]."""
    scaled_coordinate: Array
    """Along the line, in Hertz half-widths of its direction [-]."""
    pressure: Array
    hertz_pressure: Array
    """Film pressure and dry Hertz pressure [Pa]."""
    film_thickness: Array
    dry_gap: Array
    """Film thickness and gap of the dry contact under the same load [m]."""
    at: float
    """Where the line crosses the other axis [m]: 0 unless no grid line is there."""


def profile_x(result: Solution) -> Profile:
    """Return the profile along entrainment, on the grid line nearest to y = 0."""
    return _profile(result, (result.scaled.centre[0], slice(None)))


def profile_y(result: Solution) -> Profile:
    """Return the profile across entrainment, on the grid line nearest to x = 0."""
    return _profile(result, (slice(None), result.scaled.centre[1]))


def _profile(result: Solution, line: tuple[int, slice] | tuple[slice, int]) -> Profile:
    along_x = isinstance(line[0], int)
    scaled_x, scaled_y = result.scaled.x[line[1]], result.scaled.y[line[0]]
    shape = result.groups.shape
    return Profile(
        coordinate=result.x if along_x else result.y,
        scaled_coordinate=result.scaled.x if along_x else result.scaled.y,
        pressure=result.pressure[line],
        hertz_pressure=shape.dry_pressure(scaled_x, scaled_y) * result.scales.hertz_pressure,
        film_thickness=result.film_thickness[line],
        dry_gap=shape.dry_gap(scaled_x, scaled_y) * result.scales.film_thickness,
        at=float(result.y[line[0]]) if along_x else float(result.x[line[1]]),
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class MassFlow:
    """Mass that flows through each section x = const."""

    forward: Array
    """(nx,): Through the section at each x of the grid, along x [kg/s]."""
    sideways: Array
    """(nx,): Out of both side edges between the inlet and the section [kg/s]."""
    full: BoolArray
    """(nx,): Whether the film is full (not cavitated) on this section and on all upstream."""
    imbalance: float
    """Largest change of ``forward + sideways`` over full sections, relative to the flow [-]; zero
    up to the discretisation error."""


def mass_flow(result: Solution) -> MassFlow:
    r"""Return the mass flow of an isothermal Newtonian film, with the laws of its lubricant.

    .. math:: m_x = \rho u h - \frac{\rho h^3}{12\eta} \frac{\partial p}{\partial x}, \quad
              m_y = \rho v h - \frac{\rho h^3}{12\eta} \frac{\partial p}{\partial y}

    with the mean velocity u, v of the surfaces. Central differences, trapezoidal rule; so second
    order where the pressure is smooth.
    """
    x, y, pressure, film = result.x, result.y, result.pressure, result.film_thickness
    lubricant, temperature = result.problem.lubricant, result.scales.temperature
    density = lubricant.density.density(pressure, temperature)
    conductance = density * film**3 / (12.0 * lubricant.viscosity.viscosity(pressure, temperature))
    slope_x = np.gradient(pressure, x, axis=1, edge_order=2)
    slope_y = slope_across(result, pressure, edge_order=2)
    spin = result.problem.motion.mean_spin
    along = density * (result.scales.speed - spin * y[:, None]) * film - conductance * slope_x
    across = density * (spin * x) * film - conductance * slope_y
    forward = cell_widths(y) @ along
    leaving = across[-1] - across[0]
    steps = 0.5 * (leaving[1:] + leaving[:-1]) * np.diff(x)
    sideways = np.concatenate([[0.0], np.cumsum(steps)])
    inner = result.scaled.pressure[1:-1] if y.size > 1 else result.scaled.pressure
    full = np.logical_and.accumulate((inner[:, 1:] > 0).all(axis=0))
    full = np.concatenate([full[:1], full])
    total = (forward + sideways)[1:][full[1:]]
    change = float(np.ptp(total) / np.abs(total).max()) if total.size else 0.0
    return MassFlow(forward=forward, sideways=sideways, full=full, imbalance=change)
