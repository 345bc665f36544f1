"""The benchmark of asperities: its rows, without the runs."""

from dataclasses import replace

import pytest

from benchmarks import asperities
from tests.fixtures_transient import STEPS, make_transient


def test_the_steps_of_a_dent_are_paid_without_the_beginning() -> None:
    run = make_transient()
    begun = replace(run.start, cost=replace(run.start.cost, cpu_seconds=1.5))
    row = asperities.passing_row(0.5, replace(run, start=begun), 0.01)
    assert row[:5] == (0.5, "converged", STEPS, 3.0, 3)
    assert row[5:] == pytest.approx((3.0 / STEPS / 0.01, 400 * 3.0 / STEPS, 1.5))


@pytest.mark.slow
def test_a_quick_sweep_has_one_row_of_each_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asperities, "dent", lambda *_: make_transient())
    monkeypatch.setattr(asperities, "fft_unit", lambda _: 0.01)
    standing, passing = asperities.tables(65, quick=True)
    assert len(standing.rows) == len(passing.rows) == 1
    assert standing.rows[0][0] == 57.21
    assert "work per step" in passing.text()
