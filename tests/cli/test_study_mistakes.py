# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""Studies and commands that are wrong: one sentence, before any work."""

import pytest

from tehl.result.solution import Hint
from tehl.studies import Row, runner
from tehl.studies.file import read_study
from tests.cli.ball import CASE, names
from tests.cli.fixtures_study import STUDY, folder, run

__all__ = ["folder", "run"]


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
    "a comma": (STUDY.replace("80 N", "80,5 N"), '"80,5 N" with a comma: write a decimal point'),
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
        "transient: nothing changes with time",
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
        words = {"cause": "stalled", "message": "It stalls.", "hint": Hint("Take 513.")}
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
