"""Verdicts follow from findings."""

from types import SimpleNamespace

import numpy as np
import pytest

from tehl.errors import InputError
from tehl.reproduce.claims import CLAIMS, falls, rises
from tehl.reproduce.figures import figures
from tehl.reproduce.judge import Check, Finding, judged
from tehl.reproduce.open_runs import open_runs
from tehl.reproduce.peaks import peaks
from tehl.reproduce.wishes import wishes

YES, NO = Finding(True, "1"), Finding(False, "0")


@pytest.mark.parametrize(
    ("checks", "word"),
    [
        ([Check("a", YES, YES), Check("b", None, YES)], "reproduced"),
        ([Check("a", YES, YES), Check("b", YES, NO)], "trend only"),
        ([Check("a", NO, YES)], "trend only"),
        ([Check("a", YES, NO)], "cannot be"),
        ([Check("a", YES, None)], "cannot be"),
    ],
)
def test_words(checks, word):
    assert judged(checks).word == word


def test_what_is_not_so_is_named():
    why = judged([Check("it rises", NO, YES), Check("it falls", YES, NO)]).why
    assert why == (
        "Not so: “it falls”; so when converged, but not on the paper's grid: “it rises”."
    )


def test_a_run_that_is_no_answer_reproduces_nothing():
    verdict = judged([Check("a", YES, YES)], "no answer at M = 500")
    assert (verdict.word, verdict.why) == ("trend only", "No answer at M = 500.")


def quality(outcome):
    """Return what is measured in a run that ended so."""
    told = SimpleNamespace(
        converged=outcome == "converged",
        outcome=outcome,
        points=(513, 513),
        domain=(-4.0, 1.5, -2.0, 2.0),
    )
    return SimpleNamespace(quality=told)


def test_runs_without_an_answer_are_named_with_cause_grid_and_domain():
    line = {
        20.0: quality("not converged: sides too close"),
        40.0: quality("not converged: sides too close"),
        60.0: quality("converged"),
        100.0: quality("diverged"),
    }
    book = SimpleNamespace(
        series={"A": SimpleNamespace(symbol="M", values=tuple(line))},
        line=lambda *_: line,
        run=lambda *_: None,
    )
    where = "on 513 × 513 nodes of [-4, 1.5] × [-2, 2]"
    assert open_runs(book, ["A"], ("thermal",)) == (
        f"no converged thermal answer at M = 20, 40 (series A): sides too close {where}; "
        f"no converged thermal answer at M = 100 (series A): diverged {where}"
    )
    asked = open_runs(book, ["A"], ("thermal",), (40.0, 60.0), "domain")
    assert asked == f"no converged thermal answer at M = 40 (series A): sides too close {where}"
    assert not open_runs(book, ["A"], ("thermal",), (60.0,))


def test_what_is_no_number_neither_falls_nor_rises():
    assert falls([3.0, 2.0, 1.0])
    assert rises([1.0, 2.0])
    assert not falls([3.0, float("nan")])
    assert not rises([float("nan"), 1.0])


def test_each_figure_says_something_that_can_be_judged():
    known = figures()
    assert [name for name in known if name[0] == "F"] == [f"F{k}" for k in range(1, 25)]
    for spec in known.values():
        assert spec.claims
        assert set(spec.claims) <= set(CLAIMS)


def test_peaks_stand_out_on_both_sides():
    curve = [0.0, 1.0, 0.8, 3.0, 2.9, 2.95, 0.0]
    assert peaks(np.array(curve), 0.1) == [1, 3]
    assert peaks(np.array(curve), 0.04) == [1, 3, 5]
    assert peaks(np.array(curve), 0.5) == [3]


def test_all_is_wanted_unless_something_is_named():
    everything = wishes()
    assert len(everything.tables) == 3
    assert len(everything.figures) >= 24
    assert wishes(["t2", " F7"]).series == ("A",)
    assert wishes(["T1"]).series == ()
    assert [spec.name for spec in wishes(["F7", "F3"]).figures] == ["F3", "F7"]


@pytest.mark.parametrize("name", ["T9", "F25", "figure 3", ""])
def test_unknown_names_are_told_the_known_ones(name):
    with pytest.raises(InputError, match=r"is no table, figure or statement.*known are T1 to T3"):
        wishes([name])
