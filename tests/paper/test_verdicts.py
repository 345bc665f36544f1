"""Verdicts follow from findings."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from paper.figures import FIGURES
from paper.numbers import peaks
from paper.reproduce import choose, needed_series
from paper.runs import SERIES
from paper.statements import STATEMENTS, changes
from paper.unconverged import nodes_needed, unconverged
from paper.verdict import Finding, Statement, judge

from tehl import InputError

YES, NO = Finding(True, "1"), Finding(False, "0")


@pytest.mark.parametrize(
    ("statements", "word"),
    [
        ([Statement("a", YES, YES), Statement("b", None, YES)], "reproduced"),
        ([Statement("a", YES, YES), Statement("b", YES, NO)], "trend only"),
        ([Statement("a", NO, YES)], "trend only"),
        ([Statement("a", YES, NO)], "cannot be reproduced"),
        ([Statement("a", YES, None)], "cannot be reproduced"),
    ],
)
def test_words(statements, word):
    assert judge(statements).word == word


def test_statements_that_do_not_hold_are_named():
    reason = judge([Statement("it rises", NO, YES), Statement("it falls", YES, NO)]).reason
    assert reason == (
        "Does not hold: “it falls”; holds when converged, but not on the paper's grid: “it rises”."
    )


def test_runs_that_did_not_converge_reproduce_nothing():
    verdict = judge([Statement("a", YES, YES)], "no run at M = 500")
    assert (verdict.word, verdict.reason) == ("trend only", "No run at M = 500.")


def test_runs_that_did_not_converge_are_named_with_cause_grid_and_domain():
    ends = {
        20.0: "not converged: sides too close",
        40.0: "not converged: sides too close",
        60.0: "converged",
        100.0: "diverged",
    }
    line = pd.DataFrame(
        {
            "ok": [end == "converged" for end in ends.values()],
            "outcome": list(ends.values()),
            "treatment": "converged",
            "grid": "513 × 513",
            "domain": "[-4, 1.5] × [-2, 2]",
        },
        index=list(ends),
    )

    def some(*place):
        return line[line.index.isin(place[-1] or line.index)]

    runs = SimpleNamespace(series={"A": SimpleNamespace(symbol="M")}, line=some)
    where = "on 513 × 513 nodes of [-4, 1.5] × [-2, 2]"
    assert unconverged(runs, ["A"], ("thermal",)) == (
        f"the thermal runs at M = 20, 40 (series A) did not converge: sides too close {where}; "
        f"the thermal runs at M = 100 (series A) did not converge: diverged {where}"
    )
    assert unconverged(runs, ["A"], ("thermal",), (40.0, 60.0), "domain") == (
        f"the thermal runs at M = 40 (series A) did not converge: sides too close {where}"
    )
    assert not unconverged(runs, ["A"], ("thermal",), (60.0,))


@pytest.mark.parametrize(("nodes", "error", "needed"), [(129, 0.05, 129), (129, 0.71, 513)])
def test_the_grid_that_a_film_needs_follows_from_second_order(nodes, error, needed):
    assert nodes_needed(nodes, error) == needed


def test_nan_neither_falls_nor_rises():
    assert changes(-1.0, [3.0, 2.0, 1.0])
    assert changes(1.0, [1.0, 2.0])
    assert not changes(-1.0, [3.0, float("nan")])
    assert not changes(1.0, [float("nan"), 1.0])


def test_a_step_within_error_bars_may_go_the_other_way():
    assert not changes(-1.0, [3.0, 3.1, 1.0])
    assert changes(-1.0, [3.0, 3.1, 1.0], [0.1, 0.1, 0.1])


def test_each_figure_has_statements_that_are_known():
    assert [name for name in FIGURES if name[0] == "F"] == [f"F{k}" for k in range(1, 25)]
    for figure in FIGURES.values():
        assert figure.statements
        assert set(figure.statements) <= set(STATEMENTS)


def test_peaks_stand_out_on_both_sides():
    curve = np.array([0.0, 1.0, 0.8, 3.0, 2.9, 2.95, 0.0])
    assert list(peaks(curve, 0.1)) == [1, 3]
    assert list(peaks(curve, 0.04)) == [1, 3, 5]
    assert list(peaks(curve, 0.5)) == [3]


def test_everything_is_made_unless_something_is_named():
    assert len(choose()) == 3 + 28 + 9
    assert needed_series(choose()) == SERIES
    assert needed_series(choose(["t2", " F7"])) == ("A",)
    assert needed_series(choose(["T1"])) == ()
    assert choose(["F7", "F3"]) == ("F3", "F7")


@pytest.mark.parametrize("name", ["T9", "F25", "figure 3", ""])
def test_the_message_about_an_unknown_name_has_the_known_ones(name):
    with pytest.raises(InputError, match=r"is not a table, figure or conclusion.*known are T1 to"):
        choose([name])
