"""A study whose cases are solved at once, and the command that runs it."""

import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest

from tehl import cli
from tehl.result.solution import Cost, Hint
from tehl.studies import Row, runner

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
