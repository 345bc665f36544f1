# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""``tehl doctor``: facts, checks and the exit code, with a solver that returns at once."""

import json

import pytest
import typer

from tehl.cli import doctor
from tehl.kernels.cache import is_cold
from tests.cli.fixtures_solver import solver

__all__ = ["solver"]


@pytest.fixture
def healthy(solver, monkeypatch):
    monkeypatch.setattr(doctor, "KNOWN_CENTRAL_FILM", 0.1)
    return solver


def test_versions_and_checks_are_shown(healthy, capsys):
    doctor.doctor()
    out = capsys.readouterr().out
    for word in ("python", "numba", "kernel cache", "Hertz contact", "bit by bit"):
        assert word in out
    assert "FAILED" not in out


def test_json_is_one_object(healthy, capsys):
    doctor.doctor(as_json=True)
    content = json.loads(capsys.readouterr().out)
    assert all(check["passed"] for check in content["checks"].values())
    assert content["numpy"]


def test_a_wrong_film_is_an_environment_error(solver, capsys):
    with pytest.raises(typer.Exit) as end:
        doctor.doctor()
    assert end.value.exit_code == 3
    assert "FAILED" in capsys.readouterr().out


def test_warming_compiles_and_then_checks():
    doctor.doctor(warm=True)
    assert not is_cold(coupled=True)


def test_a_solver_that_breaks_is_a_finding(solver, capsys):
    solver.outcome = RuntimeError("no compiler")
    with pytest.raises(typer.Exit):
        doctor.doctor()
    assert "RuntimeError: no compiler" in capsys.readouterr().out
