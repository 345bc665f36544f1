# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""``tehl study``: what it writes, prints and returns, with work that returns at once."""

import json
import os
import subprocess
import sys
from types import SimpleNamespace

import pandas as pd
import pytest

from tehl import cli
from tehl.io import atomic
from tehl.io.templates import template_text, templates
from tehl.solution import Cost
from tehl.studies import Row, runner
from tehl.studies.file import read_study
from tehl.studies.folder import locked
from tehl.studies.plan import study_of

STUDY = """
title = "Loads"
case = "ball.toml"
[[axes]]
path = "contact.load"
linspace = ["20 N", "80 N", 4]
[[axes]]
path = "contact.slide_roll_ratio"
values = [0.0, 0.5]
"""
CASE = """
title = "Ball"
[contact]
radius = "20 mm"
load = "80 N"
entrainment_speed = "1.5 m/s"
[surface_1]
material = "steel"
[surface_2]
material = "steel"
[lubricant]
viscosity = { law = "roelands", eta_0 = "0.04 Pa s", alpha = "22 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "890 kg/m^3" }
"""


def solved(case, fields=None, guess=None):
    """Return a row whose film grows with the load; a ball that slides fails at 80 N."""
    del fields, guess
    load, slides = case.labels["contact.load"], case.labels.get("contact.slide_roll_ratio", 0) > 0
    cost = Cost(cpu_seconds=0.5, wall_seconds=0.5)
    if load == 80 and slides:
        words = {"cause": "grid_too_coarse", "message": "It is too coarse.", "hint": "Take 513."}
        return Row(key=case.key, status="not_converged", **words)
    film = {"film.h_min_m": 1e-9 * load, "uncertainty.film.h_min_m.value": 1e-9 * load}
    bars = {"uncertainty.film.h_min_m.uncertainty": 1e-10 * load}
    return Row(key=case.key, status="converged", summary=film | bars, cost=cost)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(runner, "work", solved)
    (tmp_path / "ball.toml").write_text(CASE)
    (tmp_path / "loads.toml").write_text(STUDY)
    return tmp_path


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*words: str) -> SimpleNamespace:
        monkeypatch.setattr(sys, "argv", ["tehl", "study", *words])
        with pytest.raises(SystemExit) as end:
            cli.main()
        captured = capsys.readouterr()
        return SimpleNamespace(code=end.value.code or 0, out=captured.out, err=captured.err)

    return call


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_table_has_a_row_per_case_and_units_beside_it(folder, run):
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.code == 1  # one case fails
    assert "slide_roll_ratio = 0.5: It is too coarse." in done.out
    assert "hint: Take 513." in done.out
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
    assert run("out", "--jobs", "1", "--retry-failed", "--json").code == 1


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
    assert "another tehl study runs in out: wait until it ends" in done.err
    assert done.err.count("\n") == 1
    assert names(folder / "out") == ["study.lock"]
    assert run("loads.toml", "-o", "out", "--jobs", "1").code == 1


def test_a_lock_goes_with_the_program_that_held_it(folder, run):
    (folder / "out").mkdir()
    code = (
        "import time, pathlib\nfrom tehl.studies.folder import locked\n"
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


WRONG = {
    "no such case": (
        STUDY.replace("ball.toml", "bell.toml"),
        "bell.toml: case file does not exist",
    ),
    "no case": (STUDY.replace('case = "ball.toml"', ""), "case is missing; give the base case"),
    "unknown path": (
        STUDY.replace("contact.load", "contact.lod"),
        "contact.lod is not a known key",
    ),
    "wrong unit": (
        STUDY.replace(" N", " mm"),
        'contact.load = "20.0 mm": has the unit of a length',
    ),
    "two units": (STUDY.replace("80 N", "80 kN"), "has the units N and kN"),
    "empty": (STUDY.replace("[0.0, 0.5]", "[]"), "(contact.slide_roll_ratio) has an empty list"),
    "no values": (STUDY.replace("values = [0.0, 0.5]", ""), "has no values: give one of values"),
    "two ways": (STUDY + "linspace = [0, 1, 3]", "states values and linspace"),
    "unknown key": (
        STUDY + "valeus = [1]",
        "axes[2].valeus (contact.slide_roll_ratio) is not a known key",
    ),
    "typo on top": (
        "certfy = true\n" + STUDY,
        "certfy is not a known key; did you mean certify",
    ),
    "twice": (STUDY.replace("slide_roll_ratio", "load"), "two axes with the path contact.load"),
    "no sample": (STUDY.replace("values = [0.0", "uniform = [0.0"), "is sampled, but there is no"),
    "unsampled": (STUDY + "[sample]\nnumber = 3", "no axis is sampled"),
    "lengths": (
        STUDY.replace("values", 'zip = "a"\nvalues').replace("linspace", 'zip = "a"\nlinspace'),
        "joins axes of different lengths: contact.load 4, contact.slide_roll_ratio 2",
    ),
    "a million": (STUDY.replace("4]", "1_000_000]"), "has 2,000,000 cases, more than 10,000"),
    "above its own": ("largest = 7\n" + STUDY, "has 8 cases, more than 7"),
    "in time": (
        STUDY + '[[axes]]\npath = "transient.frames"\nvalues = [3]',
        "axis transient.frames: a study of steady films",
    ),
    "impossible": (STUDY.replace("20 N", "-20 N"), "must be positive"),
    "no toml": ("case = ", "is not valid TOML"),
    "a picture": (STUDY + '[[pictures]]\nx = "load"', "pictures[1] needs x and y, or map"),
    "a case": (CASE, "is a case file: solve it with tehl solve"),
    "a table and its key": (
        STUDY.replace("contact.slide_roll_ratio", "contact").replace("[0.0, 0.5]", "[{}]"),
        "has an axis contact and an axis contact.load, which is a key of it",
    ),
    "a built-in name": (STUDY + 'name = "film.h_min_m"', 'name "film.h_min_m", which is another'),
    "a status": (STUDY + 'name = "status"', 'an axis with the name "status"'),
    "one name": (STUDY + 'name = "contact.load"', "two axes with the name contact.load: give each"),
    "a column": (
        STUDY + '[[pictures]]\nx = "load"\ny = "h_mn_m"',
        'pictures[1].y = "h_mn_m": the table will have no column h_mn_m: did you mean h_min_m?',
    ),
    "one file": (
        STUDY + '[[pictures]]\nx="load"\ny="h_min_m"\n[[pictures]]\nx="load"\ny="h_min_m"\nlog="x"',
        "pictures[1] and pictures[2] would both be h_min_m_over_load.png",
    ),
    "too few to certify": (
        "certify = true\n" + STUDY + '[[axes]]\npath = "numerics.points"\nvalues = [129, 65]',
        "case 2 of 16: numerics.points = 65: too few to certify",
    ),
    "one bracket": ('case = "ball.toml"\n[axes]\npath = "contact.load"', "write [[axes]], with"),
    "one bracket twice": (STUDY.replace("[[axes]]", "[axes]"), "twice: write [[axes]], with two"),
    "a word for true": ('certify = "yes"\n' + STUDY, 'certify = "yes": must be true or false'),
    "a number for true": ("certify = 1\n" + STUDY, "certify = 1: must be true or false"),
    "a value twice": (STUDY.replace("[0.0,", "[0.5,"), "has the value 0.5 twice: give each once"),
    "one value often": (STUDY.replace("80 N", "20 N"), "has the value 20 N 4 times: give two"),
    "a name twice": (STUDY + 'names = ["a", "a"]', 'has the name "a" twice: give each once'),
    "no list": ('cases = "none.csv"\ncase = "ball.toml"', "list of cases none.csv does not exist"),
}


@pytest.mark.parametrize("what", WRONG)
def test_an_invalid_study_is_reported_in_one_sentence_before_any_work(
    folder, run, monkeypatch, what
):
    text, words = WRONG[what]
    monkeypatch.setattr(runner, "work", None)
    (folder / "wrong.toml").write_text(text)
    done = run("wrong.toml")
    assert done.code == 2
    assert words in done.err
    assert done.err.startswith("tehl: wrong.toml: ")
    assert done.err.count("\n") == 1
    assert names(folder) == ["ball.toml", "loads.toml", "wrong.toml"]


def test_the_lines_of_a_list_are_counted_as_an_editor_does(folder, run):
    (folder / "list.csv").write_text("\ncontact.load [N]\n20\n\n\n30,40\n")
    (folder / "listed.toml").write_text('case = "ball.toml"\ncases = "list.csv"\n')
    done = run("listed.toml", "--dry-run")
    assert done.code == 2
    assert "list.csv: line 6 has 2 cells, but the first has 1" in done.err


def test_a_hint_of_many_cases_is_shown_once(folder, run, monkeypatch):
    def hopeless(case, *_):
        words = {"cause": "stalled", "message": "It stalls.", "hint": "Take 513."}
        return Row(key=case.key, status="stalled", **words)

    monkeypatch.setattr(runner, "work", hopeless)
    done = run("loads.toml", "-o", "out", "--jobs", "1")
    assert done.out.count("It stalls.") == 8
    assert done.out.count("hint") == 1
    assert "hint for 8 of them: Take 513." in done.out


def test_a_column_of_a_list_may_not_be_a_key_of_another_axis(folder, run):
    (folder / "list.csv").write_text("contact,contact.moes_load\n1,2\n")
    (folder / "overlap.toml").write_text('case = "ball.toml"\ncases = "list.csv"\n')
    done = run("overlap.toml", "--dry-run")
    assert done.code == 2
    assert "an axis contact and an axis contact.moes_load" in done.err


def test_identical_pictures_are_drawn_once(folder, run):
    picture = '[[pictures]]\nx = "load"\ny = "-h_min_m"\nhue = "slide_roll_ratio"\n'
    (folder / "drawn.toml").write_text(STUDY + picture + picture)
    assert len(read_study("drawn.toml").pictures) == 1


def test_many_cases_can_be_intended(folder, run):
    text = STUDY.replace("4]", "5001]")
    (folder / "many.toml").write_text(text)
    assert run("many.toml", "--dry-run").code == 2
    plan = read_study("many.toml", unlimited=True)
    (folder / "said.toml").write_text("largest = 10_002\n" + text)
    assert read_study("said.toml").count == plan.count == 10_002


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nowhere.toml"], "study file does not exist"),
        (["out", "--set", "a.b=1"], "is planned already"),
        (["loads.toml", "--jobs", "0"], "--jobs 0 must be a whole number of processes, 1 or more"),
        (["loads.toml", "--jobs", "abc"], "--jobs abc must be a whole number"),
        (["out", "--plot", "foo"], '"foo" is not a picture'),
        (["empty"], "is not the folder of a study"),
        (["out", "--plot", "x=load"], "is not a picture"),
        (["out", "--plot", "x=load,y=h_mn_m"], "has no column h_mn_m"),
        (["out", "--plot", "color=load"], "is not part of a picture"),
        (
            ["out", "--plot", "x=load,y=h_min_m,overlay=no.csv"],
            "file of measured points no.csv does not exist",
        ),
        (["loads.toml", "-o", "fresh", "--table"], "no case of the study is finished"),
    ],
)
def test_a_wrong_command_is_reported_in_one_sentence(folder, run, words, message):
    (folder / "empty").mkdir()
    if words[0] == "out":
        run("loads.toml", "-o", "out", "--jobs", "1")
    done = run(*words)
    assert done.code == 2
    assert message in done.err
    assert done.err.count("\n") == 1


@pytest.mark.parametrize("name", list(templates("studies")))
def test_every_template_of_a_study_is_one(name, tmp_path):
    path = tmp_path / f"{name}.toml"
    path.write_text(template_text(name), encoding="utf-8")
    study = study_of(read_study(path))
    assert 20 < len(study.cases) < 100
    assert study.plan.pictures
    assert len(templates("studies")[name]) > 20
