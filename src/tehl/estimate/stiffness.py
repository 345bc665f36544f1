"""Stiffness and damping of films without a solve: a table over M, L and frequency, interpolated.

The contacts of ``film_stiffness.csv`` are circular, isothermal, Newtonian and fully flooded, solved
on 257 x 257 nodes (``python -m benchmarks.stiffness_table``, docs/theory/dynamics.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.problem import ContactProblem
from tehl.estimate.scaling import CIRCULAR, ScaledProblem

OMEGA_BEND = 0.3
"""Frequency [-] below which the table is interpolated over it, and above over its logarithm."""
BANDS = (1.0, 3.0)
STIFFNESS_ERRORS, DAMPING_ERRORS = (7e-4, 1.5e-3, 1.5e-2), (2.5e-4, 1e-3, 1.5e-2)
"""Bounds of the differences to 21 contacts between those of the table, up to Omega = 1, 3 and 30:
of k, and of Omega c, over k. Damping itself is then within 0.3 %, 4 % and 20 % in 95 % of them."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmStiffness:
    """Stiffness and damping of the load by the approach, over frequency; SI or dimensionless."""

    frequency: Array
    """[Hz], or Omega = omega a/u_m [-]."""
    stiffness: Array
    damping: Array
    """[N/m] and [N s/m], or in p_h R and p_h R a/u_m [-]."""
    stiffness_error: Array
    damping_error: Array
    """Error bars of both, of the table and of the interpolation."""


@cache
def _table() -> tuple[tuple[Array, Array, Array], Array]:
    """Return M, L and Omega of the table, and k, c and their error bars there, (4, ...)."""
    with files(__package__).joinpath("film_stiffness.csv").open(encoding="utf-8") as file:
        columns = np.loadtxt(file, delimiter=",", skiprows=1).T
    load, speed, omega = (np.unique(column) for column in columns[:3])
    shape = (4, load.size, speed.size, omega.size)
    return (load, speed, omega), columns[3:].reshape(shape)


def film_stiffness(problem: ContactProblem, frequency: Array | Sequence[float]) -> FilmStiffness:
    """Return stiffness and damping of the film of a circular contact without solving it.

    Parameters
    ----------
    problem : ContactProblem
        Circular and fully flooded; heat and thinning have no effect here.
    frequency : array
        [Hz].

    Raises
    ------
    InputError
        If the contact is another one, or beyond the table.
    """
    scaled = ScaledProblem.of(problem)
    radii = problem.radii_of_axes
    circular = abs(radii.y / radii.x - 1.0) <= CIRCULAR
    others = (problem.supply, problem.asperities, problem.contact_film)
    plain = problem.motion.spin_1 == 0.0 == problem.motion.spin_2
    if problem.contact.has_lines or not (circular and plain) or others != (None, None, None):
        raise InputError(
            "film_stiffness has circular contacts, fully flooded, of oil alone and without spin: "
            "solve others with [dynamics]"
        )
    one, groups = scaled.scales, scaled.groups
    time = one.half_width_x / one.speed
    unit = one.hertz_pressure * one.half_width_x * one.half_width_y / one.film_thickness
    hertz = np.atleast_1d(np.asarray(frequency, float))
    found = stiffness_by_table(groups.M, groups.L, 2.0 * np.pi * time * hertz)
    return FilmStiffness(
        frequency=hertz,
        stiffness=unit * found.stiffness,
        damping=unit * time * found.damping,
        stiffness_error=unit * found.stiffness_error,
        damping_error=unit * time * found.damping_error,
    )


def stiffness_by_table(load: float, speed: float, omega: Array) -> FilmStiffness:
    """Return stiffness and damping of a circular film, dimensionless.

    Parameters
    ----------
    load, speed : float
        Moes numbers M and L [-].
    omega : (n,) array
        Omega = omega a/u_m [-].

    Raises
    ------
    InputError
        If the contact is beyond the table.
    """
    axes, values = _table()
    stated = (np.array([load]), np.array([speed]), omega)
    for name, value, axis in zip(("M", "L", "Omega = omega a/u_m"), stated, axes, strict=True):
        low, high = float(axis[0]), float(axis[-1])
        inside = (value >= low) & (value <= high * (1.0 + 1e-9))
        if not inside.all():
            raise InputError(
                f"{name} = {float(value[~inside][0]):.4g} is beyond the table of stiffnesses, "
                f"{low:g} to {high:g}: solve the contact with [dynamics]"
            )
    places = np.log(axes[0]), np.log(axes[1]), np.arcsinh(axes[2] / OMEGA_BEND)
    along = np.clip(np.arcsinh(omega / OMEGA_BEND), 0.0, places[2][-1])
    point = np.stack([np.full(omega.size, np.log(load)), np.full(omega.size, np.log(speed)), along])
    k, c, k_error, c_error = (
        RegularGridInterpolator(places, one, method=method)(point.T)
        for one, method in zip(values, ("cubic", "cubic", "linear", "linear"), strict=True)
    )
    band = np.searchsorted(BANDS, omega)
    return FilmStiffness(
        frequency=omega,
        stiffness=k,
        damping=c,
        stiffness_error=k_error + np.array(STIFFNESS_ERRORS)[band] * k,
        damping_error=c_error + np.array(DAMPING_ERRORS)[band] * k / np.maximum(omega, 1.0),
    )
