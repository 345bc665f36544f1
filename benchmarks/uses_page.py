"""The parts of docs/validation.md on stress, stiffness, temperatures of the bodies, and fits."""

from collections.abc import Iterator

import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline
from tests.post.stress.test_influence import NU, REFERENCE, hertz, stress_at
from tests.reference import moes_contact
from tests.solver.test_bodies import warmed
from tests.solver.test_dynamics import (
    INDEPENDENT,
    LINES,
    at,
    dimensionless,
    line_problem,
    marched,
    on,
)

from benchmarks.markdown import head, row
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.post.stress.measures import largest_shear, von_mises
from tehl.post.stress.numbers import peak

STRESS = """
## Stress below Hertz contacts against exact values

Quadrature of the point-load solutions, ν = 0.3, errors 1e-6. Uniform cells, 161 x 161 nodes over
three half-widths (lines 2401), 20 depths. Equilibrium, loads, sinusoids, traction and heat are
compared in `tests/post/stress` (table on the page of the [theory](theory/stress.md#checks)).
"""
POINTS = """
Six components at {} points below circles, ellipses and lines, with traction and without: largest
difference {:.1e} p_h.
"""
STIFFNESS = """
## Stiffness and damping against an independent solver

Dense Newton's method on three grids, the cavity frozen; errors 0.1 %. Circles on 257 x 257 nodes
and the domain of the reference, lines on 1025 nodes and their default domain, held at a half-width.
k and Ωc in p_h R, of lines in p_h R/b.
"""
MARCH = """
The same by a march in time, M = 50, L = 10, a load with an amplitude of 1 %, 129 x 129 nodes:
"""
WARM = """
## Temperatures of the bodies: heat in and out

Template `thermal` with thermal resistances of 5 and 20 K/W. Rotating bodies are compared with exact
series in `tests/contact/test_cooling.py`: ring sources 0.03 %, a fast ball 0.05 to 3 %, a fast disc
0.05 to 5 %.
"""
FIT = """
## Constants from synthetic tests

`python -m pytest -m slow tests/study/test_fit.py`: 20 heated data sets of films (3 % noise) and
tractions (0.0007), made with known constants. The true α and the true Eyring stress are inside
their 95 % intervals in at least 18 of 20 sets each.
"""
MARCHED = (0.3, 1.0, 3.0)
"""Frequencies of the march [u_m/a_x]."""


def section() -> Iterator[str]:
    """Yield the lines of the sections."""
    yield from stress()
    yield from stiffness()
    yield WARM
    yield from head("body", "temperature [degC]", "heat in [W]", "heat out [W]", "difference")
    film = solve(warmed(5.0, 20.0))
    heat, warm = film.heat, film.bodies
    assert heat is not None
    assert warm is not None
    entering = heat.balance.surface_1, heat.balance.surface_2
    for number, (one, into, resistance) in enumerate(
        zip(warm, entering, (5.0, 20.0), strict=True), start=1
    ):
        out = (one - film.scales.temperature) / resistance
        yield row(
            number, f"{one - 273.15:.4f}", f"{into:.7f}", f"{out:.7f}", f"{into / out - 1:.0e}"
        )
    yield "\nTolerance 1e-6; resistances of zero give every bit of the film between stated bodies."
    yield FIT


def stress() -> Iterator[str]:
    """Yield the part on stresses."""
    yield STRESS
    yield from head(
        "a_y/a_x", "largest shear / p_h", "reference", "difference", "depth / a", "reference"
    )
    depths = np.geomspace(0.04, 3.0, 20)
    for one in REFERENCE["maximum"]:
        x, y, space, spectra = hertz(one["ratio"], 0.0)
        middle = y.size // 2, x.size // 2
        axis = np.array(
            [space.stresses(spectra, space.influence(z), NU)[:, *middle] for z in depths]
        )
        yield maximum(one["ratio"] or "line", depths, largest_shear(axis.T), one)
        if one["ratio"] == 1.0:
            mises = {"shear": 0.620041, "depth": one["depth"]}
            yield maximum("1, von Mises", depths, von_mises(axis.T), mises)
    largest = 0.0
    for point in REFERENCE["point"]:
        x, y, z = point["at"]
        nodes, rows, _, _ = hertz(point["ratio"], point["traction"])
        found = stress_at(point["ratio"], point["traction"], z)
        here = [
            float(CubicSpline(nodes, part[0])(x))
            if point["ratio"] == 0.0
            else float(RectBivariateSpline(rows, nodes, part)(y, x)[0, 0])
            for part in found
        ]
        largest = max(largest, float(np.abs(np.array(here) - point["stress"]).max()))
    yield POINTS.format(len(REFERENCE["point"]), largest)


def maximum(name: object, depths: np.ndarray, values: np.ndarray, known: dict[str, float]) -> str:
    """Return a row of a maximum over depth and its reference."""
    found, there = peak(depths, values), known["shear"]
    part = f"{100 * (found.value / there - 1):+.3f} %"
    places = f"{found.depth:.4f}", f"{known['depth']:.4f}"
    return row(name, f"{found.value:.5f}", f"{there:.5f}", part, *places)


def stiffness() -> Iterator[str]:
    """Yield the part on stiffness and damping."""
    yield STIFFNESS
    yield from head(
        "contact", "M", "L", "Ω", "k", "reference", "difference", "Ωc", "reference", "difference"
    )
    for group, known in INDEPENDENT.items():
        numbers = dimensionless(solve(at(moes_contact(*group), *known), on(257)))
        yield from compared("circle", group, known, numbers)
    for group, known in LINES.items():
        problem = line_problem(*group)
        film, one = solve(at(problem, *known), Options(points=1025)).dynamics, scales(problem)
        assert film is not None
        unit = one.hertz_pressure * problem.radius_x / one.half_width_x
        solids = np.log(problem.radius_x / one.half_width_x) * 4.0 / np.pi / problem.reduced_modulus
        near = 1.0 / (1.0 / film.impedance - solids) / unit
        yield from compared("line", group, known, (near.real, near.imag))
    yield MARCH
    yield from head("Ω", "k", "march", "difference", "Ωc", "march", "difference")
    stiff, damped = dimensionless(solve(at(moes_contact(50.0, 10.0), *MARCHED), on(129)))
    for number, omega in enumerate(MARCHED, start=1):
        there = marched(omega, 129)
        k, c = stiff[number], damped[number]
        yield row(
            omega,
            *(f"{k:.4f}", f"{there.real:.4f}", f"{100 * (k / there.real - 1):+.2f} %"),
            *(f"{c:.5f}", f"{there.imag:.5f}", f"{100 * (c / there.imag - 1):+.2f} %"),
        )
    yield "\nTolerances: 0.1 and 3 % (129 nodes), of lines 0.25 and 3.5 %; of the march 1 and 3 %."


def compared(
    shape: str,
    group: tuple[float, float],
    known: dict[float, tuple[float, float | None]],
    numbers: tuple[np.ndarray, np.ndarray],
) -> Iterator[str]:
    """Yield one row per frequency, the first value of both numbers being that at rest."""
    for place, (omega, (k, c)) in enumerate(known.items(), start=1):
        stiff, damped = float(numbers[0][place]), float(numbers[1][place])
        cells = ("-", "-") if c is None else (f"{c:.5f}", f"{100 * (damped / c - 1):+.2f} %")
        yield row(
            *(shape, f"{group[0]:g}", f"{group[1]:g}", f"{omega:g}"),
            *(f"{stiff:.4f}", f"{k:.4f}", f"{100 * (stiff / k - 1):+.3f} %"),
            *(f"{damped:.5f}", *cells),
        )
