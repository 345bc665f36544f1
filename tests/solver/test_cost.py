"""Cost of a result in units of one FFT deformation."""

import pytest

from tehl.options import Options
from tehl.solver import solve, with_work
from tehl.solver.cost import fft_seconds
from tests.cases import moes_problem


def test_the_unit_of_work_grows_with_the_grid():
    assert 0.0 < fft_seconds(65, 65) < fft_seconds(513, 513)


def test_work_is_the_cost_in_units_of_the_same_grid():
    result = with_work(solve(moes_problem(20.0, 10.0), Options(points=129)))
    assert result.cost.work is not None
    # the unit is measured twice: equal up to the noise of a shared machine
    again = result.cost.cpu_seconds / fft_seconds(129, 129)
    assert result.cost.work == pytest.approx(again, rel=0.9)
