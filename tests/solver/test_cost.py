"""Cost of a result in units of one FFT deformation."""

import time

import pytest
from numba.core import event

from tehl.api.solvers import solve, with_work
from tehl.contact.options import Options
from tehl.solver import cost
from tehl.solver.cost import fft_seconds, working_time
from tests.cases import moes_problem


def test_the_unit_of_work_grows_with_the_grid():
    assert 0.0 < fft_seconds(65, 65) < fft_seconds(513, 513)


def test_work_is_the_cost_in_units_of_the_same_grid(monkeypatch):
    asked = []

    def quarter(*nodes):
        asked.append(nodes)
        return 0.25

    monkeypatch.setattr(cost, "fft_seconds", quarter)
    result = with_work(solve(moes_problem(20.0, 10.0), Options(points=(129, 65))))
    assert asked == [(129, 65)]
    assert result.cost.work == pytest.approx(4.0 * result.cost.cpu_seconds)


@pytest.mark.parametrize("tick", [0.0156, 1e9])
def test_a_coarse_clock_loses_no_result(monkeypatch, tick):
    """Windows counts CPU time in ticks of 1/64 s; a clock that stands still gives no work."""
    clock = time.process_time
    monkeypatch.setattr(cost.time, "process_time", lambda: clock() // tick * tick)
    result = with_work(solve(moes_problem(20.0, 10.0), Options(points=65)))
    assert (result.cost.work is None) == (tick > 1.0)


def test_timing_large_grids_takes_no_longer():
    started = time.process_time()
    seconds = fft_seconds(4097, 4097)
    assert time.process_time() - started < seconds


def test_compilation_does_not_count_for_a_limit_of_the_time():
    """Kernels that few contacts need took the time of a short solve."""
    begun, started = working_time(), time.perf_counter()
    with event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):  # nested
        time.sleep(0.3)
    assert time.perf_counter() - started >= 0.3
    assert working_time() - begun < 0.2
