"""What solves, transient runs and studies show on stderr, on a terminal and on a pipe."""

import io
import re
import sys
import time
from collections.abc import Callable

import pytest

from tehl.cli.progress import (
    StudyProgress,
    busy,
    compile_kernels,
    duration,
    progress,
    study_progress,
)
from tehl.contact.heat import Thermal
from tehl.kernels.warmup import Progress as Compiling
from tehl.result.transient import StepReport
from tehl.studies import Row
from tests.fixtures_result import make_result
from tests.fixtures_transient import make_transient
from tests.study.contacts import cases

HEATED = make_result(33).problem.model_copy(update={"thermal": Thermal()})


@pytest.fixture(autouse=True)
def warm(monkeypatch):
    monkeypatch.setattr("tehl.kernels.cache.is_cold", lambda **_: False)


@pytest.fixture
def terminal(monkeypatch) -> Callable[[], io.StringIO]:
    """Return a function that puts a terminal of 80 columns in the place of stderr."""

    def replace() -> io.StringIO:
        found = io.StringIO()
        found.isatty = lambda: True
        monkeypatch.setattr(sys, "stderr", found)
        return found

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    return replace


def plain(text: str) -> list[str]:
    """Return the lines of a terminal without control sequences."""
    return re.split(r"[\r\n]+", re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text))


def report(step: int) -> StepReport:
    return StepReport(
        step=step,
        steps=200,
        time=1e-6 * step,
        cycles=3,
        change=5e-4,
        load_error=1e-5,
        film_central=0.1,
        film_minimum=0.06,
        pressure_max=1.01,
        smoother="rough",
    )


def test_a_terminal_gets_a_table_of_cycles_without_temperatures(terminal, result):
    shown = terminal()
    with progress(result.problem, quiet=False) as monitor:
        for one in result.history:
            monitor.cycle(one)
    assert "65 x 65" in shown.getvalue()
    assert "dT [K]" not in shown.getvalue()


def test_the_table_of_a_thermal_run_has_one_more_column(terminal, thermal):
    shown = terminal()
    with progress(HEATED, quiet=False) as monitor:
        for one in thermal.history:
            monitor.cycle(one)
    assert "dT [K]" in shown.getvalue()
    assert "1.25e-02" in shown.getvalue()


@pytest.mark.parametrize("place", ["terminal", "pipe"])
def test_rows_fit_80_columns_and_keep_their_numbers(place, request, capsys, thermal):
    shown = request.getfixturevalue("terminal")() if place == "terminal" else None
    with progress(HEATED, quiet=False) as monitor:
        monitor.cycle(thermal.history[-1])
    with progress(make_transient().start.problem, quiet=False) as monitor:
        monitor.step(report(199))
    lines = plain(shown.getvalue() if shown else capsys.readouterr().err)
    assert all(len(line) <= 80 for line in lines)
    words = " ".join(lines)
    for heading in ("residual", "load err", "h cent [nm]", "p max [GPa]", "left [s]"):
        assert heading in words
    assert f"{thermal.history[-1].film_minimum:.6f}" in words
    assert "199/200" in words


def test_steps_are_about_twenty_plain_lines_on_a_pipe(capsys):
    with progress(make_transient().start.problem, quiet=False) as monitor:
        for step in range(1, 201):
            monitor.step(report(step))
    shown = capsys.readouterr().err
    assert 20 <= shown.count("\n") <= 24
    assert "\x1b" not in shown


def test_steps_begin_again_with_each_run_of_a_certification(capsys):
    with progress(make_transient().start.problem, quiet=False) as monitor:
        for _ in range(2):
            monitor.message("certify: a grid")
            for step in range(1, 201):
                monitor.step(report(step))
    assert capsys.readouterr().err.count(" 1/200") == 2


def test_a_terminal_shows_the_last_steps(terminal):
    shown = terminal()
    with progress(make_transient().start.problem, quiet=False) as monitor:
        monitor.cycle(make_result(33).history[0])
        for step in range(1, 31):
            monitor.step(report(step))
    assert "30/200" in shown.getvalue()
    assert "steady film at time zero" in shown.getvalue()


def test_a_terminal_shows_the_counts_of_a_study(terminal):
    shown = terminal()
    with study_progress(quiet=False) as monitor:
        monitor.begin(30, 10)
        monitor.finished(cases(1)[0], Row(key="a", status="stalled"))
    lines = plain(shown.getvalue())
    assert any("failed: M = 5: stalled" in line for line in lines)
    assert any("11 of 30 cases" in line and "1 failed" in line for line in lines)
    assert all(len(line) <= 80 for line in lines)


def test_a_study_on_a_pipe_writes_a_line_now_and_then_and_names_failures(capsys):
    now = [0.0]
    lines = StudyProgress(None, clock=lambda: now[0])
    case = cases(1)[0]
    lines.begin(30, 10)
    for number in range(20):
        now[0] += 1.0
        status = "stalled" if number == 3 else "converged"
        lines.finished(case, Row(key=case.key, status=status))
    shown = capsys.readouterr().err.splitlines()
    assert shown == [
        "30 cases, 10 of them finished before",
        "failed: M = 5: stalled",
        "20 of 30 cases, 1 per second, 10 s left, 1 failed",
        "30 of 30 cases, 1 per second, 0 s left, 1 failed",
    ]


def test_the_time_left_of_a_study_is_that_of_cases_like_those_finished():
    now, every = [0.0], cases(6)
    expected = {case.key: 1.0 if number < 4 else 30.0 for number, case in enumerate(every)}
    lines = StudyProgress(None, expected, clock=lambda: now[0])
    lines.begin(6, 0)
    for number, case in enumerate(every[:4], start=1):
        now[0] += 2.0
        lines.finished(case, Row(key=case.key, status="converged"))
        assert ("left" in lines.counts) == (number >= 3)
    assert "2 min left" in lines.counts  # two cases of 60 s, as all took twice as long


def test_a_time_is_shown_in_a_unit_that_suits():
    assert [duration(s) for s in (5, 600, 7200)] == ["5 s", "10 min", "2.0 h"]


def test_compiling_shows_a_bar_that_fits_80_columns(terminal, monkeypatch):
    def warm_up(*, coupled: bool, report: Callable[[Compiling], None]) -> None:
        assert coupled
        names = ("relaxation of points", "march of the energy equation", "summation of patches")
        report(Compiling(done=3, total=12, names=names, seconds_left=40.0))

    monkeypatch.setattr("tehl.kernels.cache.is_cold", lambda **_: True)
    monkeypatch.setattr("tehl.kernels.warmup.warm_up", warm_up)
    shown = terminal()
    compile_kernels(coupled=True)
    lines = plain(shown.getvalue())
    bar = next(line for line in lines if "compiling once, 3 of 12 done" in line)
    assert len(bar.partition(" 40 s left")[0].strip()) >= 5
    assert "40 s left" in bar
    assert all(len(line) <= 80 for line in lines)


def test_a_live_view_that_does_not_change_shows_the_time(terminal, monkeypatch):
    shown = terminal()
    monkeypatch.setattr("tehl.cli.progress._SILENT", 0.1)
    with progress(HEATED, quiet=False):
        time.sleep(2.5)
        assert "working, 2 s" in plain(shown.getvalue())
    assert "working" not in plain(shown.getvalue())[-1]


def test_writing_is_shown_on_a_terminal_only(terminal, capsys):
    with busy("writing film.nc", quiet=False):
        pass
    assert capsys.readouterr().err == ""
    shown = terminal()
    with busy("writing film.nc", quiet=False):
        pass
    assert "writing film.nc" in shown.getvalue()
