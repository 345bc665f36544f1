"""Runs of studies in this process and in others, the store, and the table."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from tehl.api import solvers
from tehl.api.problem import case_from_tables
from tehl.base.errors import InputError
from tehl.result.solution import Cost, Hint
from tehl.studies import Case, Row, Store, engines, run, runner, study, table
from tehl.studies.case import flat, retried, row_of, unit_of
from tehl.studies.engines import solve_in_turn
from tehl.studies.tables import is_number
from tests.cases import ball_tables
from tests.study.contacts import Notes, assert_same_numbers, cases, failing


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A study of four cases solved here, with its fields."""
    store = Store(tmp_path_factory.mktemp("study") / "new" / "store", keep="fields")
    outcome = run(cases(), store)
    return store, outcome


def test_each_case_has_a_row_with_the_numbers_of_its_summary(finished):
    store, outcome = finished
    assert (outcome.total, outcome.reused) == (4, 0)
    for case in cases():
        row, result = store.row(case), store.result(case)
        assert row.key == case.key
        assert row.status == result.status.kind
        assert row.summary["film.h_min_m"] == pytest.approx(result.film.minimum, rel=1e-15)
        assert row.summary["film.minimum_at.0"] == result.film_scaled.minimum_at[0]
        assert row.cost == result.cost


def test_films_along_an_axis_are_smooth_though_grids_and_domains_differ():
    speeds = np.geomspace(0.15, 3.0, 7)
    problem, options = case_from_tables(ball_tables())
    found = study(problem, {"contact.entrainment_speed": speeds.tolist()}, options)
    assert found["cost.points.0"].nunique() > 1
    for name in ("film.h_central_m", "film.h_min_m"):
        films, along = np.log(found[name].to_numpy(float)), np.log(speeds)
        assert films == pytest.approx(np.polyval(np.polyfit(along, films, 2), along), abs=5e-3)


def test_the_kept_fields_are_those_of_a_solve(finished):
    store, _ = finished
    case = cases()[1]
    alone = solvers.solve(case.problem, case.options)
    assert store.result(case).scaled.film == pytest.approx(alone.scaled.film, rel=1e-12)


def test_a_study_that_is_finished_solves_nothing(finished):
    store, _ = finished
    notes = Notes()
    again = run(cases(), Store(store.directory, keep="fields"), jobs=2, monitor=notes)
    assert (again.total, again.reused, again.cpu_seconds) == (4, 4, 0.0)
    assert (notes.begun, notes.names) == ([(4, 4)], [])


class Cluster(engines.Engine):
    """Solves here, with the tasks of a cluster of two workers."""

    local, task_seconds, ahead = False, 1.0, 32

    def workers(self):
        return 2


def test_quick_cases_are_bundled_and_the_last_ones_shared_out(tmp_path, monkeypatch):
    sizes = []

    def in_no_time(_, task, seconds):
        sizes.append(len(task))
        assert seconds == 1.0
        cost = Cost(cpu_seconds=0.065, wall_seconds=0.065)
        return [Row(key=case.key, status="converged", cost=cost) for case, _ in task]

    monkeypatch.setattr(runner, "solve_in_turn", in_no_time)
    monkeypatch.setattr(runner, "engine_of", lambda *_, **__: nullcontext(Cluster()))
    assert run(cases(400), Store(tmp_path)).converged == 400
    assert sizes[:64] == [1] * 64  # no time of a case is known yet
    assert sizes[64] == 15
    assert sizes[64:] == sorted(sizes[64:], reverse=True)
    assert sizes[-1] == 1
    assert len(sizes) < 120


def test_cases_added_later_are_the_only_work(tmp_path):
    store = Store(tmp_path)
    run(cases(2), store)
    notes = Notes()
    run(cases(3), store, monitor=notes)
    assert notes.names == [(cases(3)[2].name, "converged")]


def test_processes_find_what_one_process_finds(finished, tmp_path):
    store = Store(tmp_path)
    run(cases(), store, jobs=2)
    assert_same_numbers(table(cases(), store), table(cases(), finished[0]))


def test_a_case_that_does_not_converge_is_a_row_with_its_cause_and_its_last_fields(tmp_path):
    store = Store(tmp_path, keep="fields")
    outcome = run([failing(), *cases(1)], store)
    row = store.row(failing())
    assert (row.status, row.cause) == ("not_converged", "grid_too_coarse")
    assert "coarse" in row.message
    assert row.hint
    assert store.result(failing()).status.cause == "grid_too_coarse"
    assert [case.name for case, _ in outcome.failed] == ["too coarse"]
    assert outcome.converged == 1


def test_a_failure_is_tried_again_on_request_only(tmp_path):
    store, tried, again = Store(tmp_path), Notes(), Notes()
    run([failing(), *cases(1)], store)
    assert run([failing(), *cases(1)], store, monitor=tried).reused == 2
    assert tried.names == []
    settings = store.row(failing()).hint.settings
    outcome = run([failing(), *cases(1)], store, retry_failed=True, monitor=again)
    assert again.names == [("too coarse", "converged")]
    assert [(case.name, row.retry_settings) for case, row in outcome.retried] == [
        ("too coarse", settings)
    ]
    again = run([failing()], store)
    assert [row.retry_settings for _, row in again.retried] == [settings]
    [words] = table([failing()], store)["retry_settings"]
    assert words == f"set numerics.points = {settings['numerics.points']}"


def test_a_retry_never_changes_the_contact():
    other = Hint("oils thin.", {"lubricant.shear": {"law": "eyring", "stress": "5 MPa"}})
    row = Row(key="", status="diverged", hint=other, retry_settings={"numerics.error": "3 %"})
    assert retried(failing(), row).retry_settings == {"numerics.error": "3 %"}
    assert retried(failing(), replace(row, hint=None)).key == failing().key


def test_a_second_retry_adds_the_settings_of_the_second_hint():
    first = {"numerics.error": "3 %", "numerics.max_cycles": 80}
    row = Row(key="", status="stalled", hint=Hint("", {"numerics.error": "5 %"}))
    case = retried(failing(), replace(row, retry_settings=first))
    assert case.retry_settings == {"numerics.error": "5 %", "numerics.max_cycles": 80}
    assert (case.solved_options.error, case.solved_options.max_cycles) == (0.05, 80)
    assert case.solved_options.points == "auto"


def test_a_case_that_the_solver_rejects_is_a_row_too(tmp_path):
    few = replace(cases(1)[0], certify=True)  # 65 nodes cannot be halved twice
    store = Store(tmp_path)
    run([few], store)
    row = store.row(few)
    assert (row.status, row.cause) == ("bad_input", "bad_input")
    assert "too few to certify" in row.message
    assert row.summary == {}


def test_a_fault_of_the_program_is_a_row_too(tmp_path, monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError("by  zero")

    monkeypatch.setattr(solvers, "solve", broken)
    store = Store(tmp_path)
    outcome = run(cases(1), store)
    row = store.row(cases(1)[0])
    assert (row.status, row.cause) == ("failed", "error")
    assert row.message == "ZeroDivisionError: by zero"
    assert outcome.converged == 0


def test_identical_cases_are_solved_once(tmp_path):
    same = [replace(cases(1)[0], name=name, labels={"way": name}) for name in "ab"]
    store, notes = Store(tmp_path), Notes()
    outcome = run(same, store, monitor=notes)
    assert (outcome.total, outcome.equal) == (1, 1)
    frame = table(same, store)
    assert list(frame["way"]) == ["a", "b"]
    assert frame["film.h_min_m"].nunique() == 1
    assert len(notes.names) == 1


def test_lost_fields_are_made_again(tmp_path):
    store = Store(tmp_path, keep="fields")
    case = cases(1)[0]
    run([case], store)
    store.fields_path(case).unlink()
    assert store.result(case) is None
    assert run([case], Store(tmp_path)).reused == 1  # who wants rows has them
    assert run([case], store).reused == 0
    assert store.result(case) is not None


def test_the_table_has_labels_outcome_numbers_and_their_units(finished):
    frame = table(cases(5), finished[0], units={"M": "1"})
    assert list(frame.columns[:5]) == ["name", "M", "status", "cause", "message"]
    assert list(frame["status"]) == ["converged"] * 4 + ["open"]
    assert np.isnan(frame["film.h_min_m"].iloc[4])
    units = frame.attrs["units"]
    assert units["film.h_min_m"] == "m"
    assert units["groups.hertz_pressure_pa"] == "Pa"
    assert units["film.H_min"] == units["M"] == "1"
    assert units["cost.cpu_seconds"] == "s"
    assert "laws.density" not in units


def test_nested_tables_and_lists_become_dotted_names():
    tree = {"a": {"b": [1, {"c": None}]}, "d": "word"}
    assert dict(flat(tree)) == {"a.b.0": 1, "a.b.1.c": None, "d": "word"}


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("uncertainty.film.h_min_m.uncertainty", "m"),
        ("uncertainty.film.H_min.values.0", "1"),
        ("roughness.waves.0.film_phase_rad", "rad"),
        ("temperature.film_rise_max_k", "K"),
        ("heat.shear_w", "W"),
    ],
)
def test_the_name_of_a_number_gives_its_unit(name, unit):
    assert unit_of(name) == unit


def test_an_impossible_worker_count_is_rejected(tmp_path):
    with pytest.raises(InputError, match="jobs = 0"):
        run(cases(1), Store(tmp_path), jobs=0)


def test_each_number_of_a_summary_is_a_column_that_is_known_before(finished):
    names = [name for name in table(cases(), finished[0]) if "." in name]
    assert len(names) > 30
    assert [name for name in names if not is_number(name)] == []


@pytest.mark.parametrize("kind", ["thermal", "rough"])
def test_numbers_of_heat_and_roughness_are_columns_that_are_known_before(kind, request):
    names = row_of(cases(1)[0], request.getfixturevalue(kind)).summary
    assert [name for name in names if not is_number(name)] == []


def test_a_task_keeps_what_is_done_before_its_time_is_over_or_a_file_fails() -> None:
    """The first case is solved, or its error raised; the others come back."""
    task = [(case, (None, None)) for case in cases(3)]
    full = OSError(28, "No space left on device")

    def solve(case: Case, _: object, __: object) -> Row:
        if case is task[1][0]:
            raise full
        return Row(key=case.key, status="converged")

    assert [row.key for row in solve_in_turn(solve, task, 60.0)] == [task[0][0].key]
    assert [row.key for row in solve_in_turn(solve, task[2:] + task[:1], 0.0)] == [task[2][0].key]
    with pytest.raises(OSError, match="No space"):
        solve_in_turn(solve, task[1:], 60.0)
