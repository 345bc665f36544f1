"""Oil upstream of the grid in a line contact, against integration along a long inlet."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.estimate.scaling import groups
from tehl.operators.upstream import beyond
from tests.solver.test_line import line

EDGE, FILM, FLUX = -3.4, 5.4, 0.3


@pytest.mark.parametrize("alpha", [0.0, 8.0])
def test_the_sums_are_those_of_a_long_inlet(alpha):
    numbers = replace(groups(line(5.0, 0.0)), alpha_bar=alpha)
    x = -np.geomspace(4000.0, -EDGE, 200001)
    film = FILM + (x**2 - EDGE**2) / 2 - np.log(x / EDGE) / 2 + (x**-2.0 - EDGE**-2.0) / 16
    slope = numbers.lambda_bar * (film - FLUX) / film**3
    plain = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))])
    pressure = -np.log(1.0 - alpha * plain) / alpha if alpha else plain
    found = beyond(EDGE, np.array([FILM]), np.array([FLUX]), numbers, speed=np.ones(1))
    # the viscosity is that of a pressure that falls as the third power
    assert found.pressure == pytest.approx(pressure[-1], rel=2e-3 if alpha else 1e-6)
    assert found.load == pytest.approx(np.trapezoid(pressure, x), rel=5e-3 if alpha else 1e-3)
    integral = float(np.sum(0.5 * (film[1:] + film[:-1]) * np.diff(pressure)))
    assert found.rolling == pytest.approx(integral, rel=2e-3)
