# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""``tehl solve``: what it writes, prints and returns, with a solver that returns at once."""

import errno
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import h5netcdf
import pytest

from tehl.api.results import load
from tehl.io import store
from tehl.result.solution import Hint, Status
from tests.cli.ball import CASE, names
from tests.cli.fixtures_solver import solver

__all__ = ["solver"]

THERMAL = (
    CASE.replace('"22 1/GPa" }', '"22 1/GPa", gamma = "0.042 1/K" }')
    + 'conductivity = "0.14 W/m/K"\nheat_capacity = "2000 J/kg/K"\n'
    + '[thermal]\ntemperature = "60 degC"\n'
)


ROUGH = CASE.replace(
    "[lubricant]",
    'roughness = { type = "wave", amplitude = "20 nm", wavelength = "80 um" }\n[lubricant]',
)
BOTH = THERMAL.replace(
    "[lubricant]",
    'roughness = { type = "wave", amplitude = "20 nm", wavelength = "80 um" }\n[lubricant]',
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ball.toml").write_text(CASE)
    return tmp_path


@pytest.fixture
def warm(folder):
    (folder / "warm.toml").write_text(THERMAL)
    return folder


@pytest.fixture
def wavy(warm):
    (warm / "wavy.toml").write_text(ROUGH)
    (warm / "both.toml").write_text(BOTH)
    return warm


def test_the_option_for_stress_states_its_table_and_keeps_one_that_is_stated(folder, run, solver):
    assert run("solve", "ball.toml").code == 0
    assert run("solve", "ball.toml", "--stress").code == 0
    assert run("solve", "ball.toml", "--stress", "--set", "stress.body=2").code == 0
    tables = [call.problem.stress for call in solver.calls]
    assert [table and table.body for table in tables] == [None, "both", 2]


def test_the_result_is_stored_under_the_name_of_the_case(folder, solver, run):
    done = run("solve", "ball.toml")
    assert done.code == 0
    assert names(folder) == ["ball.nc", "ball.toml"]
    assert load("ball.nc").status.converged
    assert "minimum film" in done.out
    assert "Ball - converged" in done.out


def test_progress_goes_to_stderr_in_plain_lines(folder, solver, run):
    done = run("solve", "ball.toml")
    assert "hello" in done.err
    assert "33 x 33" in done.err
    assert "\x1b" not in done.err
    assert "33 x 33 on" in done.out


def test_quiet_shows_no_progress(folder, solver, run):
    assert "residual" not in run("solve", "ball.toml", "--quiet").err


def test_values_that_are_not_plausible_are_asked_about_after_the_numbers(folder, solver, run):
    """A film under a pressure of 18 GPa has numbers that look like any others."""
    heavy = ("solve", "ball.toml", "--set", "contact.load=1 MN")
    asked = run(*heavy).err
    assert "Please check\n  - " in asked
    assert "GPa" in asked.split("Please check")[1]
    for quiet in ("--quiet", "--json"):
        assert "Please check" in run(*heavy, quiet).err
    assert "Please check" not in run("solve", "ball.toml").err


def test_json_prints_one_object_and_nothing_else(folder, solver, run):
    done = run("solve", "ball.toml", "--json")
    assert json.loads(done.out)["status"] == "converged"
    assert done.out.count("\n") == 1


def test_overrides_reach_the_solver(folder, solver, run):
    run("solve", "ball.toml", "--set", "numerics.points=129", "--set", "contact.load=40 N")
    assert solver.calls[0].options.points == 129
    assert solver.calls[0].problem.load == 40.0


def test_certify_calls_the_certified_solve(folder, solver, run):
    run("solve", "ball.toml", "--certify")
    assert [call.kind for call in solver.calls] == ["certify"]


def test_a_failure_is_stored_marked_and_explained(folder, solver, run):
    solver.outcome = Status(
        kind="stalled",
        cause="grid_too_coarse",
        message="the grid is too coarse",
        hint=Hint("take 513"),
    )
    done = run("solve", "ball.toml", "-o", "bad.nc")
    assert done.code == 1
    assert load("bad.nc").status == solver.outcome
    assert "the grid is too coarse" in done.err
    assert "hint: take 513" in done.err


def test_a_failure_as_json_names_cause_and_hint(folder, solver, run):
    solver.outcome = Status(kind="diverged", cause="diverged", message="m", hint=Hint("h"))
    done = run("solve", "ball.toml", "--json")
    content = json.loads(done.out)
    assert done.code == 1
    assert (content["status"], content["hint"]) == ("diverged", "h")


def test_a_thermal_run_shows_how_the_temperature_changes(warm, solver, run):
    assert "dT [K]" in run("solve", "warm.toml").err
    assert "dT [K]" not in run("solve", "ball.toml").err


def test_the_isothermal_reference_enters_at_the_same_temperature(warm, solver, run):
    done = run("solve", "warm.toml", "--with-isothermal", "--json")
    first, second = (call.problem for call in solver.calls)
    assert first.thermal is not None
    assert second.thermal is None
    assert first.inlet_temperature == second.inlet_temperature == 333.15
    assert first.ambient_viscosity == second.ambient_viscosity
    effect = json.loads(done.out)["thermal_effect"]
    assert effect["central"] == effect["minimum"] == 1.0
    factors = {factor["formula"]: factor["factor"] for factor in effect["inlet_factors"]}
    assert 0 < factors["Wilson-Sheu"] < 1
    with h5netcdf.File("warm.nc") as file:
        assert json.loads(file.attrs["summary"]) == json.loads(done.out)


def test_the_effect_of_heat_is_printed(warm, solver, run):
    done = run("solve", "warm.toml", "--with-isothermal")
    assert "over isothermal  1.0000 of the central" in done.out
    assert "without heat" in done.err


def test_a_reference_run_that_fails_spoils_nothing(warm, solver, run):
    solver.cold = Status(
        kind="stalled", cause="grid_too_coarse", message="too coarse", hint=Hint("h")
    )
    done = run("solve", "warm.toml", "--with-isothermal", "--json")
    assert done.code == 0
    assert "reference run without heat did not converge" in done.err
    assert json.loads(done.out)["thermal_effect"] is None
    assert load("warm.nc").status.converged


def test_without_the_flag_there_is_no_reference_run(warm, solver, run):
    assert "thermal_effect" not in json.loads(run("solve", "warm.toml", "--json").out)
    assert len(solver.calls) == 1


def test_the_smooth_reference_is_solved_stored_and_compared(wavy, solver, run):
    done = run("solve", "wavy.toml", "--with-smooth")
    first, second = (call.problem for call in solver.calls)
    assert first.is_rough
    assert not second.is_rough
    rough, stated = (call.options for call in solver.calls)
    # the same nodes, domain by the error, and order of the wedge
    assert stated == rough.on_points(33, 33).model_copy(update={"wedge_order": 3})
    assert solver.calls[0].options.accuracy == "tight"
    assert "over smooth      1.0000 of the central" in done.out
    assert "with smooth surfaces" in done.err
    assert not load("wavy.smooth.nc").problem.is_rough
    assert "written: wavy.smooth.nc" in done.err


def test_heat_and_roughness_may_be_left_out_in_one_command(wavy, solver, run):
    done = run("solve", "both.toml", "--with-smooth", "--with-isothermal", "--json")
    rough, cold, smooth = (call.problem for call in solver.calls)
    assert (rough.is_rough, cold.is_rough, smooth.is_rough) == (True, True, False)
    assert (rough.thermal is None, cold.thermal is None, smooth.thermal is None) == (
        False, True, False
    )  # fmt: skip
    content = json.loads(done.out)
    assert content["thermal_effect"]["central"] == content["roughness_effect"]["central"] == 1.0
    with h5netcdf.File("both.nc") as file:
        assert json.loads(file.attrs["summary"]) == content


def test_a_smooth_reference_that_fails_spoils_nothing(wavy, solver, run):
    solver.cold = Status(
        kind="stalled", cause="grid_too_coarse", message="too coarse", hint=Hint("h")
    )
    done = run("solve", "wavy.toml", "--with-smooth", "--json")
    assert done.code == 0
    assert "reference run with smooth surfaces did not converge" in done.err
    assert json.loads(done.out)["roughness_effect"] is None
    assert not Path("wavy.smooth.nc").exists()


def test_a_failure_makes_no_reference_runs(wavy, solver, run):
    solver.outcome = Status(kind="stalled", cause="grid_too_coarse", message="m", hint=Hint("h"))
    assert run("solve", "wavy.toml", "--with-smooth").code == 1
    assert len(solver.calls) == 1


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["ball.toml", "--with-smooth"], "both surfaces are smooth"),
        (["ball.toml", "--with-isothermal"], "no [thermal] table"),
        (["none.toml"], "case file does not exist"),
        (["ball.toml", "-o", "none/out.nc"], "does not exist"),
        (["ball.toml", "-o", "."], "is a folder"),
        (["ball.toml", "-o", "ball.toml"], "same file as the input ball.toml"),
        (["ball.toml", "-o", "link.toml"], "same file as the input"),
        (["ball.toml", "-o", "hard_link.toml"], "same file as the input"),
        (["ball.toml", "-o", "pipe"], "is a pipe, not a file"),
        (["ball.toml", "-o", "to_pipe"], "is a pipe, not a file"),
        (["ball.toml", "-o", "loop"], "cannot be written"),
        (["ball.toml", "-o", "film.csv"], "NetCDF files, such as film.nc; tehl export"),
        (["ball.toml", "-o", "ball.toml/out.nc"], "cannot be written: not a directory"),
        (["ball.toml", "-o", "n" * 300], "name too long"),
        (["ball.toml", "-o", "new", "--plot", "new"], "conflict"),
        (["ball.toml", "--plot", "ball.toml/x"], "is a file"),
        (["ball.toml", "--plot", "dangling/x"], "broken link"),
        (["ball.toml", "--set", "contact.load=-1 N"], "contact.load"),
        (["ball.toml", "--set", "numerics.points=100"], "coarsened"),
    ],
)
def test_bad_input_writes_nothing_and_solves_nothing(folder, solver, run, words, reason):
    (folder / "link.toml").symlink_to("ball.toml")
    (folder / "hard_link.toml").hardlink_to(folder / "ball.toml")
    os.mkfifo(folder / "pipe")
    (folder / "to_pipe").symlink_to("pipe")
    (folder / "loop").symlink_to("loop")
    (folder / "dangling").symlink_to("nowhere")
    before = names(folder)
    done = run("solve", *words)
    assert done.code == 2
    assert reason in done.err
    assert done.err.count("\n") == 1
    assert solver.calls == []
    assert names(folder) == before


def test_a_grid_beyond_the_memory_is_rejected(folder, solver, run, monkeypatch):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: 1e9)
    done = run("solve", "ball.toml", "--set", "numerics.points=16385")
    assert done.code == 2
    assert "16385 x 16385: needs about 59 GB" in done.err
    assert "take 2049 or fewer" in done.err
    assert solver.calls == []


def test_a_longest_name_is_written(folder, solver, run):
    assert run("solve", "ball.toml", "-o", "n" * 255).code == 0
    assert names(folder) == ["ball.toml", "n" * 255]


def test_a_link_stays_a_link_to_the_result(folder, solver, run):
    (folder / "old.nc").write_text("old")
    (folder / "link.nc").symlink_to("old.nc")
    assert run("solve", "ball.toml", "-o", "link.nc").code == 0
    assert (folder / "link.nc").is_symlink()
    assert load("old.nc").status.converged


def test_a_full_disk_names_the_file_and_leaves_nothing(folder, solver, run, monkeypatch):
    def full(*_args):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    done = run("solve", "ball.toml", "-o", "out.nc")
    assert done.code == 3
    assert "tehl: out.nc: No space left on device\n" in done.err
    assert names(folder) == ["ball.toml"]


def test_bad_input_as_json(folder, solver, run):
    done = run("solve", "none.toml", "--json")
    assert done.code == 2
    assert json.loads(done.out)["status"] == "bad_input"


def test_an_interrupt_leaves_nothing(folder, solver, run):
    solver.outcome = KeyboardInterrupt()
    done = run("solve", "ball.toml")
    assert done.code == 130
    assert names(folder) == ["ball.toml"]


def test_a_kill_that_a_destructor_receives_is_not_lost(tmp_path):
    """Python ignores exceptions in destructors, that of the signal handler too."""
    code = """
import os, signal, sys, time
from tehl.cli.ending import ending
class Dying:
    def __del__(self):
        signal.raise_signal(signal.SIGTERM)
with ending():
    del (dying := [Dying()])[:]
    time.sleep(20.0)
    print("went on")
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 143
    assert "went on" not in done.stdout
    assert "Exception ignored" not in done.stderr


def test_a_kill_while_writing_leaves_nothing(folder, solver, run, monkeypatch):
    def killed(*_args):
        signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(store, "_write", killed)
    done = run("solve", "ball.toml")
    assert done.code == 143
    assert "tehl: ended by SIGTERM, no file is left half-written\n" in done.err
    assert names(folder) == ["ball.toml"]


def test_pictures_are_drawn_on_demand(folder, solver, run, monkeypatch):
    monkeypatch.setattr("tehl.plots.PICTURES", {})
    assert run("solve", "ball.toml", "--plot", "pictures").code == 0
    assert (folder / "pictures").is_dir()


def test_cold_kernels_are_announced(folder, solver, run, monkeypatch):
    monkeypatch.setitem(
        sys.modules, "tehl.kernels.cache", SimpleNamespace(is_cold=lambda **_: True)
    )
    compiled = []
    module = SimpleNamespace(warm_up=lambda **settings: compiled.append(settings))
    monkeypatch.setitem(sys.modules, "tehl.kernels.warmup", module)
    assert "compiling the kernels once" in run("solve", "ball.toml").err
    assert compiled == [{"coupled": False}]
