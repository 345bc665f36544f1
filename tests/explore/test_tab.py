"""A tab takes changes of its case, shows faults beside their controls, and holds its scales."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("tomlkit", reason="needs pip install 'tehl[explore]'")

from tehl.explore.case_text import CaseText
from tehl.explore.files import Files
from tehl.explore.jobs import Ask, End, Failure, Part, TooCoarse
from tehl.explore.numbers import value_of
from tehl.explore.shown import shown
from tehl.explore.tab import Tab
from tehl.io.templates import template_text
from tehl.report.explain import explain


class Recorder:
    """A solver that only records what is submitted."""

    def __init__(self):
        self.jobs, self.receivers = [], []

    def submit(self, owner, job, receive):
        assert owner in ("one", "one pinned")
        self.jobs.append(job)
        self.receivers.append(receive)

    def cancel(self, owner):
        self.jobs.append(owner)


@pytest.fixture
def tab(tmp_path):
    made = Tab("one", CaseText(template_text("ball-on-disc")), Files(tmp_path), Recorder())
    made.open(made.case)
    return made


@pytest.fixture
def part(result):
    return Part(shown(result, explain(result.problem, result.options)), final=True)


def knob(tab, path):
    return next(item for group in tab.groups for item in group.items if item.path == path)


def test_a_moving_slider_solves_on_the_coarse_grid_and_a_released_one_as_the_case_asks(tab):
    load = knob(tab, "contact.load")
    tab.turn(load, 90, "N", moving=True)
    tab.turn(load, 95, "N", moving=False)
    assert [job.quick for job in tab.solver.jobs] == [False, True, False]
    assert tab.case.get("contact.load") == "95 N"
    assert tab.problem.load == 95.0


def test_one_undo_takes_back_a_whole_move(tab):
    load = knob(tab, "contact.load")
    for number in (90, 100, 110):
        tab.turn(load, number, "N", moving=True)
    tab.turn(load, 120, "N", moving=False)
    tab.undo()
    assert tab.case.get("contact.load") == "80 N"


def test_redo_takes_an_undone_change_again_until_another_change(tab):
    load = knob(tab, "contact.load")
    for number in (90, 100):
        tab.turn(load, number, "N", moving=False)
    tab.undo()
    tab.undo()
    assert tab.case.get("contact.load") == "80 N"
    tab.redo()
    tab.redo()
    assert tab.case.get("contact.load") == "100 N"
    tab.undo()
    tab.turn(load, 95, "N", moving=False)
    tab.redo()
    assert tab.case.get("contact.load") == "95 N"


def test_the_history_of_the_browser_undoes_and_redoes(tab):
    load, cases = knob(tab, "contact.load"), [tab.case]
    for number in (90, 100, 110):
        tab.turn(load, number, "N", moving=False)
        cases.append(tab.case)
    tab.visit(cases[1])
    assert tab.case.text == cases[1].text
    tab.visit(cases[3])
    assert tab.case.text == cases[3].text
    tab.undo()
    assert tab.case.text == cases[2].text


def test_a_faulty_entry_is_a_sentence_beside_its_control_and_is_not_solved(tab):
    before = len(tab.solver.jobs)
    assert not tab.type(knob(tab, "contact.load"), "-3", "N")
    assert tab.fault.path == "contact.load"
    assert "contact.load" in tab.fault.text
    assert "must be positive" in tab.fault.text
    assert len(tab.solver.jobs) == before
    assert tab.type(knob(tab, "contact.load"), "0.1 kN", "N")
    assert tab.fault is None
    assert tab.problem.load == 100.0


def test_a_faulty_value_is_shown_at_its_own_control_whichever_is_turned_next(tab):
    tab.type(knob(tab, "contact.load"), "-3", "N")
    assert not tab.type(knob(tab, "contact.entrainment_speed"), "2", "m/s")
    assert tab.fault.path == "contact.load"
    assert tab.type(knob(tab, "contact.load"), "80", "N")
    assert tab.problem.entrainment_speed == 2.0


def test_undo_takes_back_a_typed_quantity_and_skips_faulty_cases(tab):
    load = knob(tab, "contact.load")
    tab.type(load, "0.1 kN", "N")
    tab.type(load, "-3", "N")
    tab.type(load, "-4", "N")
    tab.undo()
    assert tab.fault is None
    assert tab.case.get("contact.load") == "0.1 kN"
    tab.undo()
    assert tab.case.get("contact.load") == "80 N"


def test_a_study_is_named_as_such(tab):
    tab.open(CaseText(template_text("traction-curve")))
    assert "this is a study" in tab.fault.text


def test_a_file_of_the_machine_is_refused(tab):
    text = tab.case.text + '\n[supply]\nprofile = "/etc/passwd"\n'
    tab.open(CaseText(text))
    assert "not a file of this page" in tab.fault.text


def test_a_failure_of_the_worker_is_shown(tab):
    tab.solver.receivers[-1](Failure("The process that solves has ended"))
    tab.solver.receivers[-1](End())
    assert tab.fault.text == "The process that solves has ended"
    assert not tab.is_busy
    assert not tab.fault.again  # the same case would fail again
    tab.solve()
    tab.solver.receivers[-1](Failure("The process that solves has ended", again=True))
    assert tab.fault.again


def test_results_of_an_older_request_are_dropped_unless_a_slider_moves(tab, part):
    old = tab.solver.receivers[-1]
    tab.turn(knob(tab, "contact.load"), 90, "N", moving=False)
    old(part)
    assert tab.shown is None
    tab.turn(knob(tab, "contact.load"), 91, "N", moving=True)
    old(part)
    assert tab.shown is not None


def unconverged(part):
    outcome = replace(part.shown.outcome, converged=False, words="not converged: grid too coarse")
    return Part(replace(part.shown, outcome=outcome), final=True)


def test_while_a_new_contact_is_solved_the_film_before_is_old_and_follows_the_formula(tab, part):
    tab.solver.receivers[-1](part)
    assert not tab.is_old
    before = tab.shown
    tab.turn(knob(tab, "contact.entrainment_speed"), 3.0, "m/s", moving=True)
    assert tab.is_old
    film = value_of(tab.shown.numbers, "h_central")
    assert film.by_formula
    assert film.value == pytest.approx(
        2.0**0.67 * value_of(before.numbers, "h_central").value, rel=0.03
    )
    assert tab.shown.maps.film.max() == pytest.approx(
        before.maps.film.max() * tab.shown.maps.central / before.maps.central
    )
    tab.solver.receivers[-1](part)
    assert not tab.is_old
    assert tab.shown is part.shown


def test_the_result_of_an_older_place_of_the_slider_is_scaled_to_the_present_one(tab, part):
    load = knob(tab, "contact.load")
    tab.solver.receivers[-1](part)
    tab.turn(load, 90, "N", moving=True)
    tab.turn(load, 160, "N", moving=True)
    tab.solver.receivers[-2](part)
    assert tab.is_old
    ratio = tab.shown.maps.pressure.max() / part.shown.maps.pressure.max()
    assert ratio == pytest.approx((160 / 90) ** (1 / 3), rel=1e-5)
    assert tab.shown.maps.half_widths[0] > part.shown.maps.half_widths[0]


def test_another_accuracy_leaves_the_film_of_the_contact_current(tab, part):
    tab.solver.receivers[-1](part)
    tab.apply({"numerics.points": 129})
    assert tab.is_busy
    assert not tab.is_old


def test_a_film_that_did_not_converge_is_never_shown(tab, part):
    tab.solver.receivers[-1](unconverged(part))
    assert tab.shown is None
    tab.solver.receivers[-1](part)
    tab.turn(knob(tab, "contact.load"), 90, "N", moving=False)
    tab.solver.receivers[-1](TooCoarse("129 × 129 is too coarse"))
    assert tab.coarse
    tab.solver.receivers[-1](unconverged(part))
    tab.solver.receivers[-1](End())
    assert tab.is_old
    assert value_of(tab.shown.numbers, "h_central").by_formula
    assert not tab.latest.outcome.converged


def test_a_state_by_formula_cannot_be_pinned(tab, part):
    tab.solver.receivers[-1](part)
    tab.turn(knob(tab, "contact.load"), 90, "N", moving=False)
    tab.pin()
    assert tab.pinned is None


def test_scales_hold_still_while_comparing(tab, part):
    tab.solver.receivers[-1](part)
    limits = tab.scales.limits["film"]
    tab.pin()
    tab.turn(knob(tab, "contact.load"), 90, "N", moving=False)
    tab.scales.limits["film"] = marked = limits.joined(limits.__class__(1.0, 1e4, True))
    tab.solver.receivers[-1](part)
    assert tab.scales.limits["film"] == marked
    tab.unpin()
    assert tab.scales.limits["film"] == limits


def test_the_interferogram_is_computed_when_it_is_shown(tab):
    tab.show("fringes")
    assert isinstance(tab.solver.jobs[-1], Ask)
    assert tab.solver.jobs[-1].view == "fringes"


def test_the_interferogram_of_a_pinned_state_is_computed_too(tab, part):
    tab.solver.receivers[-1](part)
    tab.pin()
    tab.turn(knob(tab, "contact.load"), 90, "N", moving=False)
    tab.show("fringes")
    ask, receive = tab.solver.jobs[-1], tab.solver.receivers[-1]
    assert ask.view == "fringes"
    assert ask.tables["contact"]["load"] == "80 N"
    receive(Part(replace(part.shown, fringes=np.zeros((2, 2, 3), np.uint8)), final=True))
    assert tab.pinned.shown.fringes is not None


def test_centre_lines_stay_in_their_frame_while_scales_are_held(tab, part):
    tab.solver.receivers[-1](part)
    tab.pin()
    before = tab.scales.limits["lines"]
    tab.turn(knob(tab, "contact.load"), 800, "N", moving=False)
    assert tab.scales.limits["lines"][1] >= tab.shown.lines.x[2].max() > before[1]
    tab.undo()
    assert tab.scales.limits["lines"][1] > before[1]


def test_a_film_that_outgrows_held_colours_gets_a_wider_range(tab, part):
    tab.solver.receivers[-1](part)
    tab.pin()
    before = tab.scales.limits["film"]
    tab.turn(knob(tab, "contact.entrainment_speed"), 1.6, "m/s", moving=True)
    assert tab.scales.limits["film"] == before
    tab.turn(knob(tab, "contact.entrainment_speed"), 6.0, "m/s", moving=True)
    assert tab.scales.limits["film"].high > 1.1 * tab.shown.maps.central
    assert tab.scales.limits["film"].low == before.low


def test_a_choice_is_made_for_the_values_that_the_sliders_have_now(tab):
    tab.turn(knob(tab, "contact.load"), 120, "N", moving=False)
    tab.choose("contact.load|hertz_pressure|moes_load", "hertz_pressure")
    assert tab.problem.load == pytest.approx(120.0, rel=1e-3)


def test_a_radius_becomes_that_of_a_flat(tab):
    tab.choose("contact.radius|", "bodies")
    assert not tab.type(knob(tab, "surface_1.radius"), "0", "mm")
    assert '"inf"' in tab.fault.text
    tab.type(knob(tab, "surface_1.radius"), "20", "mm")
    tab.apply({"surface_2.radius": "30 mm"})
    assert tab.type(knob(tab, "surface_1.radius"), "inf", "mm")
    assert tab.problem.radii.x == pytest.approx(0.03)
