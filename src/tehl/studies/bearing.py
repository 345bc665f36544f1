"""Stiffness and damping of a rolling bearing from those of its films, for rotor programs.

Each element of the load zone is between two films, those of both rings, in series. Their sum in the
plane of the rings is a table over shaft speed and frequency.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.base.typing import Array
from tehl.contact.dynamics import Dynamics
from tehl.contact.options import Options

if TYPE_CHECKING:
    from tehl.api import solvers
else:
    solvers = lazy("tehl.api.solvers")


def in_series(first: Array, second: Array, inertia: Array | float = 0.0) -> Array:
    """Return the impedance k + i omega c of two films with a rolling element between them.

    Parameters
    ----------
    first, second : Array
        Impedance of both films [N/m], complex.
    inertia : Array or float
        Mass of the element times omega squared [N/m].
    """
    return np.asarray(first - first**2 / (first + second - inertia))


def radial_loads(force: float, elements: int, exponent: float = 1.5) -> tuple[Array, Array]:
    """Return the angles from the direction of a radial force [rad], and the loads there [N].

    Of rigid rings without clearance or preload, one element on the line of the force.

    Parameters
    ----------
    force : float
        On the bearing [N].
    elements : int
        Balls or rollers.
    exponent : float
        Of the load over the approach: 3/2 of balls (Hertz).
    """
    angle = 2.0 * np.pi * np.arange(elements) / elements
    angle = np.where(angle > np.pi, angle - 2.0 * np.pi, angle)
    approach = np.maximum(np.cos(angle), 0.0)
    load = force * approach**exponent / (approach ** (exponent + 1.0)).sum()
    # of the most loaded element
    loaded = load > 1e-3 * load.max()
    return angle[loaded], load[loaded]


@dataclass(frozen=True, kw_only=True, slots=True)
class BearingTable:
    """Impedance of a bearing in the plane of its rings, x along the radial force, y across it."""

    speed: Array
    """Of the shaft, (n,) [rad/s]."""
    frequency: Array
    """(m,) [rad/s]."""
    impedance: Array
    """Complex, (n, m, 2, 2) [N/m]."""

    def coefficients(self, speed: float | None = None) -> dict[str, Array]:
        """Return the arguments of a ``BearingElement`` of ROSS: kxx, cxy, ... and their axes.

        Parameters
        ----------
        speed : float or None
            Of the shaft [rad/s], linear between those of the table: tables over the frequency.
            None, the table over speed and frequency, needs ROSS 3 or later.

        Raises
        ------
        InputError
            If the speed is beyond the table.
        """
        found = {"frequency": self.frequency}
        if speed is None:
            found["speed"] = self.speed
        else:
            low, high = self.speed[[0, -1]]
            if not low <= speed <= high:
                raise InputError(
                    f"speed = {speed:g} rad/s is beyond the table: it has {low:g} to {high:g} rad/s"
                )
        for row, first in enumerate("xy"):
            for column, second in enumerate("xy"):
                at = self.impedance[..., row, column]
                if speed is not None:
                    at = np.array([np.interp(speed, self.speed, one) for one in at.T])
                found[f"k{first}{second}"] = at.real
                found[f"c{first}{second}"] = at.imag / self.frequency
        return found


def bearing_table(  # noqa: PLR0913 (a bearing)
    rings: tuple[ContactProblem, ContactProblem],
    loads: tuple[Array, Array],
    speeds: Sequence[float],
    frequencies: Sequence[float],
    *,
    entrainment_radius: float,
    mass: float = 0.0,
    options: Options | None = None,
) -> BearingTable:
    """Solve the films of a bearing and return its stiffness and damping.

    Parameters
    ----------
    rings : (ContactProblem, ContactProblem)
        Contacts with the inner and the outer ring; their load and speed are replaced.
    loads : (Array, Array)
        Angles [rad] and loads [N] of the elements, such as those of `radial_loads`.
    speeds, frequencies : sequence of float
        Of the shaft and of the vibration [rad/s]; increasing, and frequencies above zero.
    entrainment_radius : float
        Entrainment speed of both contacts over the speed of the shaft [m].
    mass : float
        Of a rolling element [kg].
    options : Options or None
        Numerical options of each film.

    Raises
    ------
    ConvergenceError
        If a film does not converge.
    """
    if any(one.contact.is_line for one in rings):
        raise InputError('rings: a contact of type "line" has no length: state "roller" with it')
    omega = np.array(frequencies, float)
    settings = Dynamics(frequencies=tuple((omega / (2.0 * np.pi)).tolist()))
    angles, forces = loads
    normal = np.stack([np.cos(angles), np.sin(angles)])
    found = np.zeros((len(speeds), omega.size, 2, 2), complex)
    for number, speed in enumerate(speeds):
        motion = speed * entrainment_radius
        by_load = {}  # elements on both sides of the force carry the same
        for load in np.unique(forces.round(9)).tolist():
            first, second = (_impedance(one, load, motion, settings, options) for one in rings)
            by_load[load] = in_series(first, second, mass * omega**2)
        for place, load in enumerate(forces.round(9).tolist()):
            direction = np.outer(normal[:, place], normal[:, place])
            found[number] += by_load[load][:, None, None] * direction
    return BearingTable(speed=np.array(speeds, float), frequency=omega, impedance=found)


def _impedance(
    problem: ContactProblem,
    load: float,
    speed: float,
    settings: Dynamics,
    options: Options | None,
) -> Array:
    """Return the impedance of one contact over the frequencies of ``settings`` [N/m]."""
    others = dict.fromkeys(("hertz_pressure", "moes_load", "moes_speed", "load_per_length"))
    contact = problem.contact.model_copy(update={"load": load, "entrainment_speed": speed} | others)
    one = problem.model_copy(update={"contact": contact, "dynamics": settings})
    film = solvers.solve(one, options).dynamics
    assert film is not None
    return film.impedance[1:]
