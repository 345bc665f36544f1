"""Tabulated mobility and density against the lubricant laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tehl.estimate.scaling import ScaledProblem
from tehl.kernels import properties
from tehl.operators.flow import flow_table
from tests.reference import moes_contact

PROBLEM = moes_contact(1000.0, 20.0)
SCALED = ScaledProblem.of(PROBLEM)
SCALES, GROUPS = SCALED.scales, SCALED.groups
FLOW = flow_table(SCALED)


def properties_of(pressure: float, film: float, floor: float = 0.0) -> tuple[float, float, float]:
    p, h = np.full((1, 8), pressure), np.full((1, 8), film)
    out = [np.empty((1, 8)) for _ in range(3)]
    properties.properties(properties.Film(p, h, *out, eps_x=out[0], eps_y=out[0]), FLOW, floor)
    eps, rho, drho = (float(field[0, 0]) for field in out)
    return eps, rho, drho


@settings(deadline=None)  # the first example may compile
@given(st.floats(0.0, 3.0))
def test_conductance_and_density_follow_the_laws(pressure):
    si, laws = pressure * SCALES.hertz_pressure, PROBLEM.lubricant
    rho = float(laws.density.density(np.float64(si), SCALES.temperature)) / SCALES.density
    eta = float(laws.viscosity.viscosity(np.float64(si), SCALES.temperature)) / SCALES.viscosity
    eps, density, _ = properties_of(pressure, 0.1)
    assert density == pytest.approx(rho, rel=1e-9)
    # cubic interpolation of exp(-50 P) over steps of 1/1024 leaves 1e-6
    assert eps == pytest.approx(rho / eta * 1e-3 / GROUPS.lambda_bar, rel=1e-6)


@settings(deadline=None)  # the first example may compile
@given(st.floats(0.01, 3.0))
def test_the_slope_of_density_is_its_derivative(pressure):
    d = 1e-5
    higher, lower = (properties_of(pressure + shift, 0.1)[1] for shift in (d, -d))
    difference = (higher - lower) / (2 * d)
    assert properties_of(pressure, 0.1)[2] == pytest.approx(difference, rel=1e-3)  # linear per step


def test_a_film_below_the_floor_conducts_like_the_floor():
    assert properties_of(1.0, -0.5, floor=0.01)[0] == properties_of(1.0, 0.01)[0]
