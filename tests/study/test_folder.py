"""The folder of a study, and what a study will take."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tehl.base.errors import FileFormatError, InputError
from tehl.contact.options import Options
from tehl.result.solution import Cost, Hint
from tehl.studies import Row, Store
from tehl.studies.axes import Block, Setting
from tehl.studies.case import Case
from tehl.studies.output import picture_of
from tehl.studies.plan import Plan, load_plan, save_plan, study_of
from tehl.studies.runner import Forecast, check_memory_of, forecast
from tests.cases import ball_tables
from tests.study.contacts import QUICK, cases, problem

PLAN = Plan(
    title="Loads",
    base=ball_tables(surface_2={"material": "steel"}),
    folder=Path(),
    blocks=(
        Block(
            paths=("contact.load",),
            names=("w",),
            rows=((Setting("10 N"),), (Setting(20, "much"),), (None,)),
            titles=("a", "b", "c"),
        ),
    ),
    pictures=(picture_of("x=w,y=film.h_min_m,log=xy"),),
)


def test_a_plan_is_read_back_from_its_folder(tmp_path):
    plan = replace(PLAN, folder=tmp_path)
    save_plan(plan, tmp_path / "out")
    again = load_plan(tmp_path / "out")
    assert again == plan
    first, second = study_of(plan), study_of(again)
    assert [case.key for case in first.cases] == [case.key for case in second.cases]
    assert [case.labels for case in second.cases] == [{"w": 10.0}, {"w": "much"}, {}]


@pytest.mark.parametrize("text", ["", "{}", '{"tehl_study": 9}', '{"tehl_study": 1, "plan": {}}'])
def test_a_damaged_plan_is_rejected(tmp_path, text):
    (tmp_path / "study.json").write_text(text)
    with pytest.raises(FileFormatError, match=r"study\.json"):
        load_plan(tmp_path)


SCALARS = st.none() | st.booleans() | st.integers(-(10**9), 10**9) | st.floats(-1e300, 1e300)


@settings(max_examples=25, deadline=None)
@given(
    summary=st.dictionaries(st.text(min_size=1), SCALARS),
    words=st.tuples(*(st.none() | st.text() for _ in range(3))),
    seconds=st.floats(0, 1e6),
)
def test_a_row_comes_back_from_its_store(tmp_path_factory, summary, words, seconds):
    store = Store(tmp_path_factory.mktemp("store"))
    case = cases(1)[0]
    cause, message, hint = words
    cost = Cost(cpu_seconds=seconds, wall_seconds=2 * seconds)
    row = Row(
        key=case.key,
        status="converged",
        cause=cause,
        message=message,
        hint=None if hint is None else Hint(hint, {"numerics.points": 257}),
        retry_settings={"numerics.error": "4 %", "numerics.domain": False},
        summary=summary,
        cost=cost,
    )
    store.put(row)
    store.close()
    assert Store(store.directory).row(case) == row


def test_rows_of_a_task_are_kept_all_or_none(tmp_path):
    store, (first, second) = Store(tmp_path), cases(2)
    good = [Row(key=case.key, status="failed") for case in (first, second)]
    with pytest.raises(FileFormatError):
        store.put(good[0], replace(good[1], status=None))
    assert store.rows([first, second]) == {}
    store.put(*good)
    assert len(store.rows([first, second])) == 2


def test_an_unpaired_surrogate_in_a_message_is_replaced(tmp_path):
    store, case = Store(tmp_path), cases(1)[0]
    store.put(Row(key=case.key, status="failed", message="no file \udcff.csv"))
    assert store.row(case).message == "no file ?.csv"


def test_a_forecast_counts_what_is_open_and_learns_from_what_is_finished():
    study = cases(10)
    fresh = forecast(study, {}, jobs=2, fields=False)
    assert (fresh.cases, fresh.open) == (10, 10)
    assert fresh.cpu_seconds > 0
    slow = {
        case.key: Row(
            key=case.key, status="converged", cost=Cost(cpu_seconds=10.0, wall_seconds=10.0)
        )
        for case in study[:5]
    }
    later = forecast(study, slow, jobs=2, fields=True)
    assert later.open == 5
    assert later.cpu_seconds == pytest.approx(50.0)
    assert later.wall_seconds < later.cpu_seconds
    assert later.disk_bytes > fresh.disk_bytes


def test_certification_and_heat_cost_more():
    plain = forecast([Case("", problem(), QUICK)], {}, jobs=1, fields=False)
    certain = forecast([Case("", problem(), QUICK, {}, True)], {}, jobs=1, fields=False)
    finer = forecast([Case("", problem(), Options(points=257))], {}, jobs=1, fields=False)
    assert certain.cpu_seconds > 2 * plain.cpu_seconds
    assert finer.memory_bytes > plain.memory_bytes


def test_workers_that_do_not_fit_into_the_memory_are_rejected():
    numbers = {"cases": 9, "open": 9, "cpu_seconds": 1.0, "wall_seconds": 1.0, "disk_bytes": 1.0}
    check_memory_of(Forecast(**numbers, memory_bytes=1e6, is_calibrated=False), 8)
    with pytest.raises(InputError, match="8 workers take about 1e"):
        check_memory_of(Forecast(**numbers, memory_bytes=1e16, is_calibrated=True), 8)
