"""Plan of a transient run before the solve."""

import numpy as np
import pytest

from tehl.api.problem import case_from_tables
from tehl.estimate.scaling import ScaledProblem
from tehl.report.explain import as_summary, as_text, explain
from tehl.report.readable import seconds
from tehl.report.transient_plan import transient_plan
from tests.cases import ball_tables

WAVE = {"type": "wave", "amplitude": "20 nm", "wavelength": "200 um"}


def plan(**changes):
    tables = ball_tables(
        surface_1={"material": "steel", "roughness": changes.pop("roughness", WAVE)},
        transient={"duration": "1 ms"} | changes.pop("transient", {}),
        numerics={"points": 257, "domain": {"x": [-2.5, 1.5], "y": [-2.0, 2.0]}},
    )
    tables["contact"] = tables["contact"] | changes
    problem, options = case_from_tables(tables)
    mesh = 4.0 / 256 * problem.hertz.half_width_x, 4.0 / 256 * problem.hertz.half_width_y
    found = transient_plan(ScaledProblem.of(problem), options, mesh, halves=False)
    return found, problem, options


def test_steps_follow_from_the_mesh_and_the_mean_speed():
    found, problem, _ = plan()
    step = 4.0 / 256 * problem.hertz.half_width_x / 1.5
    assert found.step_s == pytest.approx(step)
    assert found.steps == pytest.approx(1e-3 / step, abs=1)
    assert found.distance == pytest.approx(1e-3 * 1.5 / problem.hertz.half_width_x)
    assert found.points_per_wave[0] == pytest.approx(
        200e-6 / (4.0 / 256 * problem.hertz.half_width_x)
    )
    assert found.questions == ()


def test_speeds_are_those_of_both_surfaces():
    found, *_ = plan(slide_roll_ratio=1.0)
    assert np.array(found.speeds_m_s) == pytest.approx(np.array([[2.25] * 3, [0.75] * 3]))
    assert found.shift_per_step == pytest.approx((1.5, 0.5))
    slides = {"slide_roll_ratio": [["0 s", 1.0], ["1 ms", 0.0]]}
    changing, *_ = plan(transient=slides)
    ranges = np.array([[2.25, 1.5, 2.25], [0.75, 0.75, 1.5]])
    assert np.array(changing.speeds_m_s) == pytest.approx(ranges)


def test_a_wave_of_few_points_is_reported():
    found, *_ = plan(roughness=WAVE | {"wavelength": "30 um"})
    assert any("points on its shortest wave" in one for one in found.questions)


def test_asperities_that_jump_are_reported():
    found, *_ = plan(slide_roll_ratio=1.5, transient={"stride": 2})
    assert any("1.5 mesh widths per step away from" in one for one in found.questions)


def test_an_explanation_has_a_plan_only_of_a_transient_run():
    _, problem, options = plan()
    case = explain(problem, options)
    assert "1 mesh width per step, " in as_text(case)
    assert "points per wave" in as_text(case)
    assert as_summary(case)["time"]["points_per_wave"][1] is None
    steady = problem.model_copy(update={"transient": None})
    assert as_summary(explain(steady, options))["time"] is None


@pytest.mark.parametrize(
    ("time", "words"), [(2.0, "2 s"), (1.5e-3, "1.5 ms"), (2.5e-5, "25 us"), (0.0, "0 us")]
)
def test_times_have_a_fitting_unit(time, words):
    assert seconds(time) == words


def test_surfaces_that_may_touch_take_longer():
    tables = ball_tables(
        surface_1={"material": "steel", "roughness": WAVE},
        transient={"duration": "1 ms"},
        contact_film={"thickness": "5 nm"},
        numerics={"points": 65},
    )
    problem, options = case_from_tables(tables)
    found = transient_plan(ScaledProblem.of(problem), options, (1e-5, 1e-5), halves=False)
    # 0.09 to 0.16 s per step of 12 symmetric cases on 65 nodes
    assert found.seconds == pytest.approx(0.12 * found.steps, rel=0.5)


def test_a_longer_step_takes_more_cycles():
    """Half as many steps of four mesh widths save an eighth of the time."""
    two, four = (plan(transient={"stride": n})[0] for n in (2, 4))
    assert four.steps == pytest.approx(0.5 * two.steps, rel=0.02)
    assert 0.85 * two.seconds < four.seconds < 0.9 * two.seconds
