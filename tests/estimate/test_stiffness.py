"""Stiffness and damping by the table: contacts between, limits, SI."""

import numpy as np
import pytest

import tehl
from tehl.base.errors import InputError
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.stiffness import stiffness_by_table
from tehl.report.explain import as_text, explain
from tests.cases import ball_tables

BETWEEN = {
    0.0: (3.07227, 0.127140), 0.145252: (3.07408, 0.125938), 0.816810: (3.11791, 0.0945723),
    1.93696: (3.16066, 0.0326398), 3.44446: (3.13122, 0.0394504), 25.8296: (3.38858, 0.0207766),
}  # fmt: skip
"""k and c at M = 102.117, L = 5.24948 over Omega, solved on 257 nodes: not in the table."""
BALL = tehl.ContactProblem(**ball_tables())


def test_a_contact_between_those_of_the_table_is_within_its_bars():
    found = stiffness_by_table(102.1166, 5.249484, np.array(list(BETWEEN)))
    for number, (k, c) in enumerate(BETWEEN.values()):
        assert found.stiffness[number] == pytest.approx(k, abs=found.stiffness_error[number])
        assert found.damping[number] == pytest.approx(c, abs=found.damping_error[number])
    np.testing.assert_allclose(found.stiffness[:3], [k for k, _ in BETWEEN.values()][:3], rtol=1e-3)
    np.testing.assert_allclose(found.damping[:3], [c for _, c in BETWEEN.values()][:3], rtol=1e-2)
    assert (found.stiffness_error[:4] < 5e-3 * found.stiffness[:4]).all()


def test_frequencies_and_results_of_a_problem_are_in_si():
    scaled = ScaledProblem.of(BALL)
    one, groups = scaled.scales, scaled.groups
    time, unit = one.half_width_x / one.speed, one.hertz_pressure * BALL.radius_x
    found = tehl.film_stiffness(BALL, [0.0, 1.0 / (2.0 * np.pi * time)])
    plain = stiffness_by_table(groups.M, groups.L, np.array([0.0, 1.0]))
    np.testing.assert_allclose(found.stiffness, unit * plain.stiffness)
    np.testing.assert_allclose(found.damping, unit * time * plain.damping)
    np.testing.assert_allclose(found.damping_error, unit * time * plain.damping_error)
    # of the dry contact: d load / d approach = 3/2 load / approach
    dry = 1.5 * BALL.load / BALL.hertz.approach
    assert 0.9 * dry < found.stiffness[0] < dry
    assert "at rest, by a table" in as_text(
        explain(tehl.ContactProblem(**ball_tables(), dynamics={}))
    )
    assert "by a table" not in as_text(explain(BALL))


@pytest.mark.parametrize(
    ("change", "frequencies", "words"),
    [
        ({}, [1e6], r"Omega = omega a/u_m = .* beyond the table .* 0 to 30"),
        ({}, [float("nan")], "Omega"),
        ({"load": "0.02 N"}, [0.0], r"M = .* 10 to 562"),
        ({"radius": None, "radius_x": "20 mm", "radius_y": "60 mm"}, [0.0], "circular"),
        ({"type": "roller", "length": "8 mm"}, [0.0], "circular"),
        ({"spin_1": "500 rad/s", "spin_2": "500 rad/s"}, [0.0], "without spin"),
    ],
)
def test_what_the_table_does_not_have_is_refused_with_its_range(change, frequencies, words):
    contact = {key: one for key, one in (ball_tables()["contact"] | change).items() if one}
    with pytest.raises(InputError, match=words):
        tehl.film_stiffness(tehl.ContactProblem(**ball_tables(contact=contact)), frequencies)


def test_a_film_beside_solids_is_not_that_of_the_table():
    touching = tehl.ContactProblem(**ball_tables(contact_film={"thickness": "20 nm"}))
    with pytest.raises(InputError, match="of oil alone"):
        tehl.film_stiffness(touching, [0.0])
