"""Standing waves against an independent solver and linear theory, and strong waves."""

import numpy as np
import pytest

from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.operators.flow import flow_table
from tests.reference import moes_contact
from tests.solver.rough import rough_film
from tests.solver.runs import tight

pytestmark = pytest.mark.slow

WAVE = ((57.21, 10.52), (0.03, 0.5, 45.0))
INDEPENDENT = {"central": (0.203230, 2e-4), "minimum": (0.109946, 1e-3)}
"""Richardson values of a semi-smooth Newton solver (up to 385 nodes), and relative tolerances: its
own uncertainty is 3e-4 and 6e-4."""


def test_the_film_of_a_standing_wave_is_that_of_an_independent_solver():
    contact, shape = WAVE
    coarse, fine = (
        rough_film(contact, tight(n, half_domain="never"), shape).film_scaled for n in (257, 513)
    )
    for name, (value, tolerance) in INDEPENDENT.items():
        last, before = getattr(fine, name), getattr(coarse, name)
        assert last + (last - before) / 3.0 == pytest.approx(value, rel=tolerance)


def compression(smooth: Result, length: float) -> np.ndarray:
    """Return C = h E' k/(4 B) at every node, B the bulk modulus at the local pressure."""
    flow = flow_table(smooth.scaled_problem)
    rows = np.minimum((smooth.scaled.pressure / flow.step).astype(int), len(flow.density) - 1)
    per_pressure = flow.density[rows, 1] / flow.step / flow.density[rows, 0]
    return np.pi**2 / 2.0 * smooth.scaled.film / length * per_pressure


def ripple(field: np.ndarray, expected: np.ndarray, basis: list[np.ndarray]) -> float:
    """Return the least-squares part of ``expected`` in ``field``, beside ``basis``."""
    columns = np.stack([expected, *basis], axis=1)
    return float(np.linalg.lstsq(columns, field, rcond=None)[0][0])


@pytest.mark.parametrize(("length", "degrees"), [(0.5, 0.0), (0.25, 0.0), (0.5, 45.0)])
def test_the_ripples_of_a_standing_wave_are_those_of_linear_theory(length, degrees):
    """Hooke 2006; Greenwood and Morales-Espejel 1994: film C/(1+C), pressure 1/(1+C)."""
    amplitude, contact = 0.003, (200.0, 10.0)
    options = tight(513, half_domain="auto" if degrees == 0.0 else "never")
    rough = rough_film(contact, options, (amplitude, length, degrees))
    smooth = solve(moes_contact(*contact), options)
    x, y = np.meshgrid(smooth.scaled.x, smooth.scaled.y)
    inside = (np.abs(x) < 0.4) & (np.abs(y) < 0.4)
    along, across = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    wave = 2.0 * np.pi * (x * along - y * across) / length
    streaks = 2.0 * np.pi * y * across / length  # the film of the inlet, carried along x
    shapes = [np.sin(wave), np.ones_like(x), x, y, x**2, y**2]
    shapes += [np.cos(streaks), np.sin(streaks)] if across > 0.0 else []
    basis = [shape[inside] for shape in shapes]
    c = compression(smooth, length)
    expected_film = amplitude * c / (1.0 + c) * np.cos(wave)
    expected_pressure = -(np.pi**2) / 2.0 * amplitude / length / (1.0 + c) * np.cos(wave)
    film = rough.scaled.film - smooth.scaled.film
    pressure = rough.scaled.pressure - smooth.scaled.pressure
    assert ripple(film[inside], expected_film[inside], basis) == pytest.approx(1.0, abs=0.03)
    assert ripple(pressure[inside], expected_pressure[inside], basis) == pytest.approx(
        1.0, abs=0.01
    )


@pytest.mark.parametrize(
    ("contact", "shape", "central"),
    [
        # the solver of INDEPENDENT, on the same grid
        ((57.21, 10.52), (0.2, 0.5, 0.0), 0.3084),
        ((57.21, 10.52), (0.1, 0.5, 0.0), 0.2483),
        ((200.0, 10.0), (0.03, 0.25, 0.0), 0.0901),
    ],
)
def test_strong_waves_have_the_film_of_a_newton_solver(contact, shape, central):
    result = rough_film(contact, tight(257), shape)
    assert result.film_scaled.central == pytest.approx(central, rel=2e-3)


@pytest.mark.parametrize(
    ("contact", "shape"),
    [
        ((126.0, 12.34), (0.1, 0.25, 0.0)),
        ((126.0, 12.34), (0.1, 0.25, 45.0)),
        ((126.0, 12.34), (0.2, 0.5, 0.0)),
        ((200.0, 10.0), (0.1, 0.25, 0.0)),
        ((57.21, 10.52), (0.2, 0.25, 0.0)),
    ],
)
def test_waves_beyond_the_plain_cycle_converge(contact, shape):
    options = tight(257, half_domain="auto" if shape[2] == 0.0 else "never")
    try:
        result = rough_film(contact, options, shape)
    except ConvergenceError as error:
        result = error.result
    assert result.status.cause in (None, "grid_too_coarse")  # some films are too thin for 257 nodes
    last = result.history[-1]
    assert max(last.residual, last.change, abs(last.load_error)) <= options.tolerance
