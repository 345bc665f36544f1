"""Lines that are longer than a terminal is wide."""

import sys

import pytest

from tehl.cli.lines import show, wrapped
from tehl.cli.text import as_text, failure_text
from tehl.report.explain import explain

MESSAGE = "tehl: case.toml: contact.lod = 5 is not a known key; did you mean load? It has a unit"


@pytest.mark.parametrize("is_terminal", [True, False])
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_only_a_terminal_gets_wrapped_lines(monkeypatch, capsys, stream, is_terminal):
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setattr(getattr(sys, stream), "isatty", lambda: is_terminal)
    show(MESSAGE, err=stream == "stderr")
    captured = capsys.readouterr()
    lines = (captured.err if stream == "stderr" else captured.out).splitlines()
    assert " ".join(line.strip() for line in lines) == MESSAGE
    assert len(lines) == (3 if is_terminal else 1)
    assert all(len(line) <= 40 for line in lines) is is_terminal
    assert all(line.startswith("  ") for line in lines[1:])


def test_a_value_goes_on_below_its_beginning():
    text = (
        "  film             5 nm   (H = 0.1)   error about 1 %\n  largest pressure 0.8032 GPa and"
    )
    assert wrapped(text, 43).split("\n") == [
        "  film             5 nm   (H = 0.1)   error",
        "                   about 1 %",
        "  largest pressure 0.8032 GPa and",
    ]


def test_a_question_goes_on_behind_its_dash():
    assert wrapped("  - is the load plausible", 16).split("\n") == [
        "  - is the load",
        "    plausible",
    ]


def test_a_word_that_is_longer_than_the_terminal_stays_whole():
    assert wrapped("written: " + 60 * "x", 40).split("\n") == ["written:", "  " + 60 * "x"]


def test_texts_of_cases_and_results_fit_80_columns(result, rough, thermal, stalled):
    texts = [repr(explain(one.problem)) for one in (result, rough, thermal)]
    texts += [as_text(one) for one in (result, rough, thermal)]
    texts.append(failure_text(stalled.status, None))
    for text in texts:
        lines = wrapped(text, 80).split("\n")
        assert max(map(len, lines)) <= 80
        assert " ".join(text.split()) == " ".join(" ".join(lines).split())
