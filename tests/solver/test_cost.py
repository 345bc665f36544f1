"""Cost of a result in units of one FFT deformation, and the warm-up before it is measured."""

import subprocess
import sys

import pytest

from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.solver import solve, with_work
from tehl.solver.cost import fft_seconds
from tehl.solver.warmup import CASE


def test_the_unit_of_work_grows_with_the_grid():
    assert 0.0 < fft_seconds(65, 65) < fft_seconds(513, 513)


def test_work_is_the_cost_in_units_of_the_same_grid():
    result = with_work(solve(ContactProblem.model_validate(CASE), Options(points=129)))
    assert result.cost.work is not None
    # the unit is measured twice: equal up to the noise of a shared machine
    again = result.cost.cpu_seconds / fft_seconds(129, 129)
    assert result.cost.work == pytest.approx(again, rel=0.9)


WARMED = """
import importlib
from tehl.solver.warmup import warm_up
warm_up(coupled=True)
for name in ("energy", "lines", "newton", "reynolds", "summation", "trail", "transfer"):
    module = importlib.import_module(f"tehl.kernels.{name}")
    if any(getattr(value, "signatures", None) for value in vars(module).values()):
        print(name)
"""


def test_the_warm_up_loads_the_kernels_of_all_grids():
    """Including the multilevel sum, which only finer grids than those of the warm-up use."""
    done = subprocess.run(
        [sys.executable, "-c", WARMED], capture_output=True, text=True, timeout=300, check=True
    )
    assert done.stdout.split() == [
        "energy", "lines", "newton", "reynolds", "summation", "trail", "transfer"
    ]  # fmt: skip
