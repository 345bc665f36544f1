"""The tables of contacts as machines have them."""

import pytest
from benchmarks.machines import KINDS, contact, judged, reached, row

import tehl
from benchmarks import any_contacts, rollers
from tehl.contact.options import Options
from tehl.estimate.duration import duration_of, misplaced
from tehl.estimate.scaling import ScaledProblem


def test_every_contact_is_a_valid_case_and_the_same_each_time():
    kinds = set()
    for number in range(60):
        kind, features, problem = contact(3, number)
        assert contact(3, number) == (kind, features, problem)
        assert (problem.thermal is not None) == ("thermal" in features)
        kinds.add(kind)
    assert kinds == set(KINDS)


def test_rollers_of_machines_are_valid_and_the_same_each_time():
    seen, marks = set(), set()
    for number in range(60):
        kind, features, problem = rollers.contact(3, number)
        assert rollers.contact(3, number) == (kind, features, problem)
        assert problem.contact.type == "roller"
        assert (problem.contact.tilt != 0.0) == ("tilt" in features)
        assert (problem.supply is not None) == ("starved" in features)
        seen.add(kind)
        marks |= features
    assert seen == set(rollers.KINDS)
    assert marks == {"tilt", "heated", "asperities", "starved"}


def test_contacts_count_by_kind_and_feature_and_failures_are_named():
    options = Options(max_time=20.0)
    rows = [row(contact(3, number), number, options, judge=number == 7) for number in (5, 7)]
    bad = {"number": 9, "kind": "cam", "features": ["plain"], "M": 1e4, "L": 9.0}
    bad |= {"ellipticity": 4.0, "cause": "stalled", "seconds": 3.0, "error": 0.2}
    table = reached([*rows, bad])
    good = sum(one["cause"] is None for one in rows)
    assert table.rows[0][:2] == ("all", f"{good} of 3")
    assert good > 0
    assert any("contact 9 (cam, plain; M = 10000" in note for note in table.notes)
    known = [{"off": {"film_central": 0.4}}, {"off": {"film_central": 1.5}}, {}]
    assert judged(known).rows == [("film_central", 2, 50.0, 100.0, 0.95, 1.5)]


def test_contacts_of_any_shape_and_motion_are_valid_and_the_same_each_time():
    seen = set()
    for number in range(40):
        kind, features, problem = any_contacts.contact(3, number)
        assert any_contacts.contact(3, number) == (kind, features, problem)
        assert (problem.contact.type == kind) == problem.contact.has_lines
        assert (problem.transient is not None) == ("transient" in features)
        assert ("spin" in features) == (problem.contact.spin_1 != 0.0)
        seen |= {kind, *features}
    assert seen == {*any_contacts.SHAPES, *any_contacts.FEATURES, "across", "spin"}


def test_point_contacts_with_all_tables_at_once_have_each_beside_each_other():
    drawn = [any_contacts.contact(1, number, tables_at_once=True)[::2] for number in range(12)]
    again = [any_contacts.contact(1, number, tables_at_once=True)[::2] for number in range(12)]
    assert drawn == again
    assert {kind for kind, _ in drawn} <= set(any_contacts.POINT_SHAPES)
    both = [one for _, one in drawn if one.contact_film is not None and one.thermal is not None]
    assert both
    assert any(one.conserves_oil for _, one in drawn)


def test_roughness_of_random_transient_contacts_may_start_where_it_is_drawn():
    starts = []
    for number in (0, 4, 24, 26):  # bumps that were in the contact at time zero, or beside it
        scaled = ScaledProblem.of(any_contacts.contact(57, number, tables_at_once=True)[2])
        assert misplaced(scaled, duration_of(scaled)) is None
        starts.append(scaled.problem.transient and scaled.problem.transient.start)
    assert starts[:2] == ["standing"] * 2


def test_a_starved_cam_whose_flux_errs_at_the_spike_reaches_its_error():
    _, features, problem = contact(1, 89)
    assert features == {"supply"}
    found = tehl.solve(problem)
    assert found.film_scaled.central == pytest.approx(0.17886, rel=0.002)  # from 513 and 1025 nodes
    assert max(found.errors.central, found.errors.minimum) < 0.01
