"""The tables of random contacts."""

import pytest
from benchmarks.coverage import coverage, hints, robustness, row, times
from benchmarks.random_contacts import contact


@pytest.mark.parametrize("number", range(40))
def test_every_random_contact_is_a_valid_case_and_the_same_each_time(number):
    first, kind = contact(7, number)
    second, again = contact(7, number)
    assert (first, kind) == (second, again)
    assert (kind == "rough") == first.is_rough


def test_a_contact_that_fails_counts_by_its_cause_and_others_by_their_bars():
    good = {"class": "isothermal", "M": 5.0, "cause": None, "seconds": 1.0}
    good |= {"off": {"film_central": 0.5}}
    bad = {"class": "isothermal", "M": 600.0, "cause": "stalled", "seconds": 2.0}
    table = robustness([good, bad])
    assert table.rows[0][:4] == ("isothermal", "1 of 1", "0 of 0", "0 of 1")
    assert table.notes == ["1 converged, 1 stalled"]
    assert coverage([good, bad]).rows == [("film_central", 1, 100.0, 100.0, 0.5, 0.5)]


def test_times_count_by_class_if_they_are_within_a_factor_of_two():
    ratios = {"isothermal": (0.6, 1.9), "heated": (1.0, 2.1)}
    rows = [{"class": kind, "time": time} for kind, both in ratios.items() for time in both]
    within = {kind: (count, part) for kind, count, part, *_ in times([*rows, {}]).rows}
    assert within == {"all": (4, 75.0), "isothermal": (2, 100.0), "heated": (2, 50.0)}


def test_a_light_contact_is_solved_and_judged():
    number = next(k for k in range(100) if contact(7, k)[1] == "isothermal")
    found = row((7, number, 30.0, True, True))
    assert found["cause"] is None
    assert found["time"] > 0.0
    assert 0.0 < found["off"]["film_central"] < 1.0
    assert "followed" not in found


@pytest.mark.slow
def test_the_hint_of_a_contact_that_fails_is_followed():
    # the grid planned for it is followed by a finer one, for which there is no time
    found = row((7, 3, 1e-3, False, True))
    assert (found["cause"], found["followed"]) == ("error_not_reached", "converged")
    stuck = found | {"cause": "stalled", "followed": "stalled"}
    table = hints([found, stuck])
    assert table.rows == [("error_not_reached", 1, 1), ("stalled", 1, 0)]
    assert "1 of 2" in table.title
    assert len(table.notes) == 1
