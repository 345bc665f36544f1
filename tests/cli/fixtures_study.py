"""A study whose cases are solved at once, and the command that runs it."""

from dataclasses import replace
from functools import partial

import pytest

from tehl.result.solution import Cost, Hint
from tehl.studies import Row, runner
from tests.cli.ball import CASE

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


def solved(case, fields=None, guess=None):
    """Return a row whose film grows with the load; a ball that slides fails at 80 N."""
    del fields, guess
    load, slides = case.labels["contact.load"], case.labels.get("contact.slide_roll_ratio", 0) > 0
    cost = Cost(cpu_seconds=0.5, wall_seconds=0.5)
    if load == 80 and slides:
        hint = Hint(settings={"numerics.points": 513})
        words = {"cause": "grid_too_coarse", "message": "It is too coarse.", "hint": hint}
        if not case.retry_settings:
            return Row(key=case.key, status="not_converged", **words)
    film = {"film.h_min_m": 1e-9 * load, "uncertainty.film.h_min_m.value": 1e-9 * load}
    bars = {"uncertainty.film.h_min_m.uncertainty": 1e-10 * load}
    row = Row(key=case.key, status="converged", summary=film | bars, cost=cost)
    return replace(row, retry_settings=case.retry_settings)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(runner, "work", solved)
    (tmp_path / "ball.toml").write_text(CASE)
    (tmp_path / "loads.toml").write_text(STUDY)
    return tmp_path


@pytest.fixture
def run(run):
    return partial(run, "study")
