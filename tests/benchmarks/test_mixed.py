"""The benchmark of asperities finer than the grid has a row for each contact."""

from benchmarks import mixed


def test_a_quick_run_has_one_contact_and_the_median() -> None:
    table = mixed.table(33, quick=True)
    (*contact, ratio), median = table.rows
    assert contact[:3] == [20, 10, 0.2]
    assert 0.0 < contact[3] < 1.0
    assert median[-1] == ratio > 0.0
