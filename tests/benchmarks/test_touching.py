"""The benchmark of contact through a boundary film has a row for each contact."""

from benchmarks import touching


def test_a_quick_run_has_one_contact() -> None:
    (row,) = next(touching.tables(65, quick=True)).rows
    assert row[:4] == (1000, 4, 0.3, "grid_too_coarse")  # four cells per length
    assert row[5] > 1
    assert row[-1] > row[-2] > 0.0
