# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""``tehl study``: what it writes, prints and returns, with work that returns at once."""

import json
import os
import subprocess
import sys

import pandas as pd
import pytest

from tehl.base import atomic
from tehl.io.templates import template_text, templates
from tehl.studies import runner
from tehl.studies.file import read_study
from tehl.studies.plan import locked, study_of
from tests.cli.ball import CASE, names
from tests.cli.fixtures_study import STUDY, folder, run, solved

__all__ = ["folder", "run"]


def test_the_table_has_a_row_per_case_and_units_beside_it(folder, run):
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 1  # one case fails
    assert "slide_roll_ratio = 0.5: It is too coarse." in done.out
    assert "hint: Set numerics.points = 513." in done.out
    frame = pd.read_csv("out/table.csv")
    assert list(frame["contact.load"]) == [20, 20, 40, 40, 60, 60, 80, 80]
    assert list(frame["status"]).count("converged") == 7
    assert frame["cause"].iloc[-1] == "grid_too_coarse"
    units = json.loads((folder / "out" / "units.json").read_text())
    assert units["contact.load"] == "N"
    assert units["film.h_min_m"] == "m"


def test_parquet_and_csv_hold_the_same(folder, run):
    pytest.importorskip("pyarrow")
    run("loads.toml", "-o", "out", "--jobs", "1")
    first, second = pd.read_csv("out/table.csv"), pd.read_parquet("out/table.parquet")
    assert list(first) == list(second)
    assert first["film.h_min_m"].equals(second["film.h_min_m"])


def test_the_same_command_again_solves_nothing(folder, run):
    run("loads.toml", "-o", "out", "--jobs", "1")
    again = run("loads.toml", "-o", "out", "--jobs", "1", "--json")
    found = json.loads(again.out)
    assert (found["cases"], found["reused"], found["converged"]) == (8, 8, 7)
    assert [one["cause"] for one in found["failed"]] == ["grid_too_coarse"]
    assert again.out.count("\n") == 1


def test_a_retry_takes_the_settings_of_the_hint_and_the_table_names_them(folder, run):
    assert run("loads.toml", "-o", "out", "--jobs", "1").code == 1
    done = run("out", "--jobs", "1", "--retry-failed")
    assert done.code == 0
    assert "slide_roll_ratio = 0.5: set numerics.points = 513" in done.out
    again = json.loads(run("out", "--jobs", "1", "--json").out)
    assert [one["retry_settings"] for one in again["retried"]] == [{"numerics.points": 513}]
    frame = pd.read_csv("out/table.csv")
    assert list(frame["retry_settings"].dropna()) == ["set numerics.points = 513"]


def test_another_study_finds_the_cases_of_a_shared_store(folder, run):
    shared = 'store = "kept"\n' + STUDY
    (folder / "a.toml").write_text(shared)
    (folder / "b.toml").write_text(shared.replace("80 N", "100 N").replace("4]", "5]"))
    run("a.toml", "--jobs", "1")
    found = json.loads(run("b.toml", "--jobs", "1", "--json").out)
    assert (found["cases"], found["reused"]) == (10, 8)
    assert names(folder / "a") == names(folder / "b")
    assert "rows.sqlite" not in names(folder / "a")


def test_a_dry_run_writes_nothing(folder, run):
    done = run("loads.toml", "-o", "out", "--dry-run")
    assert done.code == 0
    assert "8, from load = 20 N, slide_roll_ratio = 0 to" in done.out
    found = json.loads(run("loads.toml", "--dry-run", "--json", "--jobs", "2").out)
    assert (found["cases"], found["open"], found["jobs"]) == (8, 8, 2)
    assert found["cpu_seconds"] > 0
    assert names(folder) == ["ball.toml", "loads.toml"]


def test_set_changes_the_base_case(folder, run):
    run("loads.toml", "-o", "out", "--jobs", "1", "--set", "numerics.points=129")
    assert json.loads(run("out", "--dry-run", "--json").out)["open"] == 0
    assert json.loads(run("loads.toml", "-o", "other", "--dry-run", "--json").out)["open"] == 8


PICTURES = """
[[pictures]]
x = "load"
y = "h_min_m"
[[pictures]]
x = "load"
y = "film_rise_max_k"
"""


def test_a_picture_that_cannot_be_drawn_is_a_warning_beside_the_table(folder, run):
    (folder / "drawn.toml").write_text(STUDY + PICTURES)  # nothing is warm, so one is not drawn
    done = run("drawn.toml", "-o", "out", "--jobs", "1", "--json")
    again = run("out", "--table", "--json")
    for one in (done, again):
        assert one.code == 1  # as one case fails
        assert "picture film_rise_max_k_over_load: the table has no column" in one.err
        assert one.out.count("\n") == 1
    assert json.loads(again.out)["files"][-1] == "out/h_min_m_over_load.png"


def test_other_values_on_the_same_axes_go_on_in_the_folder(folder, run):
    run("loads.toml", "-o", "out", "--jobs", "1")
    (folder / "more.toml").write_text(STUDY.replace("Loads", "More").replace("0.5]", "0.5, 1.0]"))
    found = json.loads(run("more.toml", "-o", "out", "--jobs", "1", "--json").out)
    assert (found["cases"], found["reused"]) == (12, 8)


OTHERS = {
    "base case": STUDY.replace("ball.toml", "cube.toml"),
    "choice of axes": STUDY.replace("contact.slide_roll_ratio", "numerics.points").replace(
        "[0.0, 0.5]", "[65, 129]"
    ),
}


@pytest.mark.parametrize("what", OTHERS)
def test_the_folder_of_another_study_is_left_alone_unless_it_is_to_be_replaced(folder, run, what):
    (folder / "drawn.toml").write_text(STUDY + PICTURES)
    (folder / "cube.toml").write_text(CASE.replace("20 mm", "30 mm"))
    (folder / "another.toml").write_text(OTHERS[what])
    run("drawn.toml", "-o", "out", "--jobs", "1")
    before = {path: path.read_bytes() for path in (folder / "out").iterdir()}
    for words in ([], ["--dry-run"], ["--table"], ["--table", "--replace"]):
        done = run("another.toml", "-o", "out", "--jobs", "1", *words)
        assert done.code == 2
        assert f"out holds a study with another {what}: take another folder" in done.err
        assert done.err.count("\n") == 1
    assert {path: path.read_bytes() for path in (folder / "out").iterdir()} == before
    assert run("another.toml", "-o", "out", "--jobs", "1", "--replace").code in (0, 1)
    assert "h_min_m_over_load.png" not in names(folder / "out")
    assert run("another.toml", "-o", "out", "--jobs", "1").code in (0, 1)


def test_a_folder_takes_one_run_at_a_time(folder, run):
    (folder / "out").mkdir()
    with locked(folder / "out"):
        done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 3
    assert "another run of tehl writes into out: wait until it ends" in done.err
    assert done.err.count("\n") == 1
    assert names(folder / "out") == ["study.lock"]
    assert run("loads.toml", "-o", "out", "--jobs", "1").code == 1


def test_a_lock_goes_with_the_program_that_held_it(folder, run):
    (folder / "out").mkdir()
    code = (
        "import time, pathlib\nfrom tehl.studies.plan import locked\n"
        "with locked(pathlib.Path('out')):\n    print('held', flush=True)\n    time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        assert run("loads.toml", "-o", "out", "--jobs", "1").code == 3
        process.kill()
    assert run("loads.toml", "-o", "out", "--jobs", "1").code == 1


def test_a_scheduler_that_is_not_there_leaves_no_folder(folder, run):
    pytest.importorskip("distributed")
    done = run("loads.toml", "-o", "a/b", "--scheduler", "nonsense://nowhere")
    assert done.code == 3
    assert "no dask scheduler replies" in done.err
    assert "are kept" not in done.err
    assert names(folder) == ["ball.toml", "loads.toml"]


@pytest.fixture
def protected(folder, run, monkeypatch):
    """The folder of a study that takes no more files, for who may write anywhere too."""
    run("loads.toml", "-o", "out", "--jobs", "1")
    may = os.access

    def refused(**_):
        raise PermissionError(13, "Permission denied")

    def access(path, mode):
        return mode != os.W_OK and may(path, mode)

    monkeypatch.setattr(atomic.tempfile, "TemporaryFile", refused)
    monkeypatch.setattr(os, "access", access)
    return folder / "out"


def test_a_dry_run_reads_where_nothing_can_be_written(protected, run):
    before = {path: path.read_bytes() for path in protected.iterdir()}
    done = run("out", "--dry-run", "--json")
    assert done.code == 0
    assert json.loads(done.out)["open"] == 0
    assert {path: path.read_bytes() for path in protected.iterdir()} == before


@pytest.mark.parametrize("words", [["--table"], ["--plot", "x=load,y=h_min_m"], ["--jobs", "1"]])
def test_what_cannot_be_written_is_a_fault_of_the_environment(protected, run, words):
    before = names(protected)
    done = run("out", *words)
    assert done.code == 3
    assert "cannot write into" in done.err
    assert done.err.count("\n") == 1
    assert names(protected) == before


def test_a_damaged_plan_is_replaced_on_request(folder, run):
    run("loads.toml", "-o", "out", "--jobs", "1")
    (folder / "out" / "study.json").write_text("{")
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 2
    assert "run the study file again with -o and --replace" in done.err
    found = json.loads(run("loads.toml", "-o", "out", "--jobs", "1", "--replace", "--json").out)
    assert found["reused"] == 8


def test_a_folder_draws_its_table(folder, run):
    run("loads.toml", "-o", "out", "--jobs", "1")
    (folder / "lab.csv").write_text("load [N], film [nm], error\n20, 21, 1\n80, 79, 2\n")
    done = run("out", "--plot", "x=load,y=h_min_m,hue=slide_roll_ratio,log=xy,overlay=lab.csv")
    assert done.code == 0
    assert done.out.split() == ["out/h_min_m_over_load.png"]
    assert (folder / "out" / "h_min_m_over_load.png").stat().st_size > 10_000
    assert run("out", "--plot", "x=load,y=h_min_m,format=svg,file=paper").code == 0
    assert (folder / "out" / "paper.svg").read_text().startswith("<?xml")


def test_a_table_of_an_unfinished_study_says_what_is_open(folder, run, monkeypatch):
    def stopped(case, *files):
        if case.labels["contact.load"] == 60:
            raise KeyboardInterrupt
        return solved(case, *files)

    monkeypatch.setattr(runner, "work", stopped)
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 130
    assert "continue with: tehl study out" in done.err
    found = json.loads(run("out", "--table", "--json").out)
    assert found["status"] == {"converged": 4, "open": 4}
    monkeypatch.setattr(runner, "work", solved)
    assert json.loads(run("out", "--jobs", "1", "--json").out)["reused"] == 4


def test_a_full_disk_is_reported_with_the_way_to_continue(folder, run, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device", "out/fields/x.nc")

    monkeypatch.setattr(runner, "work", full)
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 3
    assert "No space left on device" in done.err
    assert "continue with" in done.err


def test_a_list_of_cases_in_a_csv_file(folder, run):
    (folder / "list.csv").write_text(
        "name,contact.load [N],contact.slide_roll_ratio\nfirst,20,0.1\nsecond,30,\n"
    )
    (folder / "listed.toml").write_text('case = "ball.toml"\ncases = "list.csv"\n')
    plan = read_study("listed.toml")
    cases = study_of(plan).cases
    assert [case.name for case in cases] == ["first", "second"]
    assert cases[0].problem.load == 20
    assert cases[1].problem.slide_roll_ratio == 0
    assert run("listed.toml", "--jobs", "1").code == 0


def test_identical_pictures_are_drawn_once(folder, run):
    picture = '[[pictures]]\nx = "load"\ny = "-h_min_m"\nhue = "slide_roll_ratio"\n'
    (folder / "drawn.toml").write_text(STUDY + picture + picture)
    assert len(read_study("drawn.toml").pictures) == 1


@pytest.mark.parametrize("name", list(templates("studies")))
def test_every_template_of_a_study_is_one(name, tmp_path):
    path = tmp_path / f"{name}.toml"
    path.write_text(template_text(name), encoding="utf-8")
    study = study_of(read_study(path))
    assert 20 < len(study.cases) < 100
    assert study.plan.pictures
    assert len(templates("studies")[name]) > 20
