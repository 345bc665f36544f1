"""Any direction: the work of ellipses at an angle, and rates of cycles where surfaces spin."""

import math
from collections import Counter
from typing import Any

import numpy as np

from benchmarks.measure import attempt, multigrid
from benchmarks.rate import CYCLES, MORE_CYCLES, film_inside, mean_rate, one_cycle
from benchmarks.table import Table
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.options import Options

LOADS, SPEEDS, ANGLES = (20.0, 100.0, 500.0), (2.0, 15.0), (0, 15, 30, 45, 60, 75, 90)
"""M, L and angles of entrainment [deg] of the work."""
ELLIPTICITIES = (1.5, 3.0, 5.0)
"""Axes of the ellipses, the larger over the smaller one."""
SHAPES, SPINS = ((1.0, 0), (2.0, 0), (2.0, 45), (2.0, 90), (4.0, 45)), (0.0, 0.25, 0.5)
"""Axes and angles of the rates, and spin of the mean motion over u_m / a_x."""
NODES, WEDGE = 193, 3


def contact(
    load: float, speed: float, ratio: float, angle: float, spin: float = 0.0
) -> ContactProblem:
    """Return a contact.

    Parameters
    ----------
    load, speed : float
        Moes numbers M and L of the same load and speed at no angle.
    ratio, angle, spin : float
        Axes of the ellipse, one over the other; angle of the entrainment to the smaller one [deg];
        spin of the mean motion [u_m / a_x].
    """
    stated = {"radius_x": 0.01, "radius_y": 0.01 * _radii(ratio)}
    tables: dict[str, Any] = {
        "contact": stated | {"moes_load": load, "moes_speed": speed},
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
            "density": {"law": "dowson-higginson", "rho_0": 880.0},
        },
    }
    on_axes = ContactProblem.model_validate(tables)
    stated |= {"load": on_axes.load, "entrainment_speed": on_axes.entrainment_speed}
    tables["contact"] = stated | {"entrainment_angle": math.radians(angle)}
    found = ContactProblem.model_validate(tables)
    turns = spin * found.entrainment_speed / found.hertz.half_width_x
    tables["contact"] |= {"spin_1": turns, "spin_2": turns}
    return ContactProblem.model_validate(tables) if spin else found


def _radii(ratio: float) -> float:
    """Return R_y / R_x of an ellipse with these axes, by the usual power (within 5 %)."""
    return ratio**1.57


def work(result: Result) -> float:
    """Return the nodes that all cycles visited on the grids that they were for."""
    return float(sum(report.points[0] * report.points[1] for report in result.history))


def angles(*, quick: bool = False) -> Table:
    """Return the work at angles over that at 0, by ellipse and load, and what did not converge."""
    made = Table(
        title=f"Work of the cycles over that at 0 deg, {NODES} x {NODES} nodes, third order",
        columns=("a_2/a_1", "M", "L", *(f"{angle} deg" for angle in ANGLES)),
    )
    ends: Counter[str] = Counter()
    options = Options(points=NODES, wedge_order=WEDGE)
    for ratio in ELLIPTICITIES[:1] if quick else ELLIPTICITIES:
        for load in LOADS[:1] if quick else LOADS:
            for speed in SPEEDS[:1] if quick else SPEEDS:
                found = [attempt(contact(load, speed, ratio, angle), options) for angle in ANGLES]
                ends.update(one.status.cause or one.status.kind for one in found)
                visited = [work(one) / work(found[0]) for one in found]
                made.rows.append((ratio, load, speed, *visited))
    made.notes.append(", ".join(f"{count} {name}" for name, count in ends.most_common()))
    return made


def rate(problem: ContactProblem) -> float:
    """Return the mean part of the error of H that a cycle leaves, after full multigrid."""
    run = multigrid(problem, Options(points=NODES, max_cycles=2, wedge_order=WEDGE))
    run.solve(force=True)
    films = [film_inside(run), *(one_cycle(run) for _ in range(CYCLES))]
    for _ in range(MORE_CYCLES):
        converged = one_cycle(run)
    return mean_rate([float(np.sqrt(np.mean((film - converged) ** 2))) for film in films])


def spins(*, quick: bool = False) -> Table:
    """Return the part of the error that a cycle leaves, by ellipse, angle and spin."""
    made = Table(
        title=f"Rate per V(2,2), M = 100, L = 10, {NODES} x {NODES} nodes, wedge of third order",
        columns=("a_2/a_1", "angle [deg]", *(f"spin {spin:g}" for spin in SPINS)),
    )
    for ratio, angle in SHAPES[:1] if quick else SHAPES:
        rates = (rate(contact(100.0, 10.0, ratio, angle, spin)) for spin in SPINS)
        made.rows.append((ratio, angle, *rates))
    return made


def tables(*, quick: bool = False) -> tuple[Table, Table]:
    """Return the work at angles, and the rates with spin."""
    return angles(quick=quick), spins(quick=quick)
