# ruff: noqa: ARG001 (fixtures that prepare and are not read)
"""``tehl solve`` of a case with time, killed and resumed; pictures and moving pictures of it."""

import itertools
import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

import tehl
from tehl.api.results import ConvergenceError
from tehl.cli.checkpoint import STEPS, Keeper
from tehl.io.checkpoint import Fingerprint
from tehl.plots import animation
from tehl.result.solution import Hint, Status
from tehl.solver.cost import Clock
from tests.cli.ball import names
from tests.fixtures_result import make_result
from tests.fixtures_transient import make_certified, make_transient

CASE = """
title = "A wave passes"
[contact]
radius = "20 mm"
moes_load = 50
moes_speed = 10
slide_roll_ratio = 0.5
[surface_1]
material = "steel"
roughness = { type = "wave", amplitude = "30 nm", wavelength = "250 um" }
[surface_2]
material = "steel"
[lubricant]
viscosity = { law = "roelands", eta_0 = "0.04 Pa s", alpha = "22 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "890 kg/m^3" }
[transient]
frames = 3
duration = "0.8 ms"
[numerics]
points = 65
domain = { x = [-4.5, 1.5], y = [-3.0, 3.0] }
"""
KEEPING = "import sys, tehl.cli.checkpoint as e; e.CHECKPOINT_SECONDS = 0; import tehl.cli as c;"
TEHL = (sys.executable, "-c", f"{KEEPING} sys.argv = ['tehl', *sys.argv[1:]]; c.main()")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wave.toml").write_text(CASE)
    return tmp_path


def equal(one: tehl.TransientResult, other: tehl.TransientResult) -> bool:
    pairs = (
        (one.profiles.pressure, other.profiles.pressure),
        (one.profiles.film, other.profiles.film),
        (one.frames.film, other.frames.film),
        (one.history.rigid_approach, other.history.rigid_approach),
        (one.history.cycles, other.history.cycles),
    )
    return all(np.array_equal(*pair) for pair in pairs)


def steps_in(checkpoint) -> int:
    with np.load(checkpoint) as state:
        return len(state["rows"])


def stopped_by(number: int, folder, step: int) -> subprocess.Popen:
    """Start a run, and end it by a signal once its checkpoint has come so far."""
    job = subprocess.Popen(
        [*TEHL, "solve", "wave.toml"], cwd=folder, stderr=subprocess.PIPE, text=True
    )
    kept, deadline = folder / "wave.nc.checkpoint", time.monotonic() + 120
    while time.monotonic() < deadline and job.poll() is None:
        if kept.exists() and steps_in(kept) > step:
            break
        time.sleep(0.01)
    job.send_signal(number)
    job.err = job.communicate(timeout=60)[1]
    return job


HEAT = """
conductivity = "0.14 W/m/K"
heat_capacity = "2000 J/kg/K"
shear = { law = "eyring", stress = "5 MPa" }
[thermal]
temperature = "40 degC"
[transient]
frames = 3
duration = "0.4 ms"
[numerics]
points = 49
"""


@pytest.mark.parametrize("warm", [pytest.param(False, marks=pytest.mark.slow), True])
def test_a_killed_run_continues_bit_by_bit(folder, run, warm):
    if warm:
        oil = CASE.replace('"22 1/GPa" }', '"22 1/GPa", gamma = "0.042 1/K" }')
        text = oil.partition("[transient]")[0].rstrip() + HEAT
        (folder / "wave.toml").write_text(text)
    assert run("solve", "wave.toml", "-o", "whole.nc", "--quiet").code == 0
    job = stopped_by(signal.SIGKILL, folder, 5)
    assert job.returncode == -signal.SIGKILL
    assert not (folder / "wave.nc").exists()
    (folder / ".wave.nc.checkpoint.0123456789ab.part").write_bytes(b"killed while it was written")
    rejected = run("solve", "wave.toml")
    assert rejected.code == 2
    assert "continue it with --resume" in rejected.err
    other = run("solve", "wave.toml", "--resume", "--set", "contact.moes_load=11")
    assert other.code == 2
    assert "belongs to another case" in other.err
    done = run("solve", "wave.toml", "--resume")
    assert done.code == 0
    assert "continuing after step" in done.err
    assert equal(tehl.load("whole.nc"), tehl.load("wave.nc"))
    assert names(folder) == ["wave.nc", "wave.toml", "whole.nc"]


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(
    "number", [signal.SIGTERM, pytest.param(signal.SIGINT, marks=pytest.mark.slow)]
)
def test_a_terminated_run_keeps_its_last_step(folder, run, monkeypatch, number):
    job = stopped_by(number, folder, 2)
    assert job.returncode == 128 + number
    assert "tehl solve --resume continues from it" in job.err
    assert names(folder) == ["wave.nc.checkpoint", "wave.toml"]
    # which another version does not take
    monkeypatch.setattr("tehl.io.checkpoint.__version__", "9.9.9")
    done = run("solve", "wave.toml", "--resume")
    assert done.code == 2
    assert "and this is 9.9.9" in done.err


def test_a_broken_checkpoint_is_rejected(folder, run):
    (folder / "wave.nc.checkpoint").write_bytes(b"PK\x03\x04 and then nothing")
    done = run("solve", "wave.toml", "--resume")
    assert done.code == 2
    assert "is not a complete checkpoint" in done.err


@pytest.fixture
def solved(monkeypatch):
    """Let transient runs have their outcome at once."""

    def give(outcome):
        def solve_transient(problem, options, *, monitor, resume, keep):
            del options, monitor, resume, keep
            if isinstance(outcome, Exception):
                raise outcome
            assert problem.transient is not None
            return outcome

        monkeypatch.setattr("tehl.api.solvers.solve_transient", solve_transient)

    return give


def test_the_numbers_of_a_run_are_printed(folder, run, solved):
    solved(make_transient())
    done = run("solve", "wave.toml", "--plot", "pictures")
    assert done.code == 0
    assert "60 steps" in done.out
    assert "minimum film" in done.out
    assert names(folder / "pictures") == [
        "history.png",
        "moments.png",
        "passage.png",
        "space_time.png",
    ]


def test_json_prints_one_object(folder, run, solved):
    solved(make_transient())
    done = run("solve", "wave.toml", "--json")
    assert json.loads(done.out)["time"]["steps"] == 60


def test_an_unfinished_run_is_stored_marked_and_exits_with_1(folder, run, solved):
    status = Status(
        kind="not_converged", cause="asperity_contact", message="they touch", hint=Hint("go faster")
    )
    solved(replace(make_transient(), status=status))
    done = run("solve", "wave.toml")
    assert done.code == 1
    assert "they touch" in done.err
    assert "hint: go faster" in done.err
    assert tehl.load("wave.nc").status == status


@pytest.mark.parametrize("limit", [pytest.param(9, marks=pytest.mark.slow), 99])
def test_a_run_that_ends_at_its_time_is_continued_for_as_long_or_longer(
    folder, run, monkeypatch, limit
):
    ticks = itertools.count()
    monkeypatch.setattr(Clock, "is_over", property(lambda _: next(ticks) > 9))
    stated = ("solve", "wave.toml", "--set")
    done = run(*stated, "numerics.max_time=9")
    assert done.code == 1
    assert "numerics.max_time = 9 s is over at " in done.err
    assert re.search(r'et numerics.max_time = "[\d.]+ s": the run takes less', done.err)
    assert "is saved in wave.nc.checkpoint; tehl solve --resume continues from it" in done.err
    first = tehl.load("wave.nc")
    assert first.status.cause == "time_over"
    assert steps_in("wave.nc.checkpoint") == first.history.time.size > 2
    ticks = itertools.count()
    assert run(*stated, f"numerics.max_time={limit}", "--resume").code == 1
    assert tehl.load("wave.nc").history.time.size > first.history.time.size + 2


def test_passes_that_end_at_their_time_leave_a_checkpoint(folder, run):
    (folder / "grease.toml").write_text(run("new", "grease-decay").out)
    limits = ("--set", "numerics.points=33", "--set", "numerics.max_time=0.001")
    done = run("solve", "grease.toml", *limits)
    assert done.code == 1
    assert "is over after 1 of 60 passes" in done.err
    assert "pass 1 is saved in grease.nc.checkpoint; tehl solve --resume" in done.err
    assert "is over after 2 of 60 passes" in run("solve", "grease.toml", *limits, "--resume").err


def test_a_start_that_does_not_converge_is_stored_and_exits_with_1(folder, run, solved):
    solved(ConvergenceError("the steady film at time zero was not reached", make_result(33)))
    done = run("solve", "wave.toml")
    assert done.code == 1
    assert isinstance(tehl.load("wave.nc"), tehl.Result)


def test_a_start_that_diverges_is_reported_as_a_diverged_steady_case(folder, run):
    standing = [
        "--set",
        'transient.start="standing"',
        "--set",
        "surface_1.roughness.amplitude=3e-6",
    ]
    done = run("solve", "wave.toml", *standing, "--json", "--plot", "pictures")
    assert done.code == 1
    assert (
        "not converged (grid_too_coarse): The steady film at time zero did not converge" in done.err
    )
    assert "hint: Take lower or longer asperities" in done.err
    summary = json.loads(done.out)
    assert summary["status"] == "diverged"
    assert summary["cause"] == "grid_too_coarse"
    assert summary["hint"]
    assert summary["message"].startswith("The steady film at time zero")
    assert str(tehl.load("wave.nc").status.hint) == summary["hint"]
    assert "film.png" in names(folder / "pictures")


@pytest.mark.parametrize("option", ["--with-smooth", "--with-isothermal"])
def test_options_of_steady_cases_are_rejected(folder, run, option):
    done = run("solve", "wave.toml", option)
    assert done.code == 2
    assert f"{option} is for steady cases" in done.err


@pytest.fixture
def certified(monkeypatch):
    """Let certified runs have their outcome at once."""

    def give(outcome):
        monkeypatch.setattr("tehl.api.solvers.certify_transient", lambda *_, **__: outcome)

    return give


def test_a_certified_run_prints_its_bars_and_keeps_no_checkpoint(folder, run, certified):
    certified(make_certified())
    done = run("solve", "wave.toml", "--certify")
    assert done.code == 0
    rows = {line[2:19].strip(): line[19:] for line in done.out.splitlines()[1:]}
    assert "certified 0.79148 +- 0.04 GPa (grid 0.032, domain 0.024)" in rows["largest pressure"]
    assert " nm (grid " in rows["minimum film"]
    assert "+- 0.0025 at the extreme" in rows["traction"]
    assert "at 16 times" in rows["over time"]
    assert "33 x 33 converged" in rows["certified"]
    assert sum("least   certified" in line for line in done.out.splitlines()) == 1
    assert names(folder) == ["wave.nc", "wave.toml"]


def test_a_certified_run_has_its_bars_in_json(folder, run, certified):
    certified(make_certified())
    summary = json.loads(run("solve", "wave.toml", "--certify", "--json").out)
    assert summary["uncertainty"]["film"]["h_min_m"]["value"]["uncertainty"] > 0


def test_a_run_that_has_no_error_bar_exits_with_1_and_is_kept(folder, run, certified):
    status = Status(
        kind="not_converged",
        cause="not_certified",
        message="no bar follows",
        hint=Hint("more points"),
    )
    certified(replace(make_transient(), status=status))
    done = run("solve", "wave.toml", "--certify")
    assert done.code == 1
    assert "no bar follows" in done.err
    assert "hint: more points" in done.err
    assert tehl.load("wave.nc").status.cause == "not_certified"


def test_a_certified_run_cannot_be_resumed_nor_passes_over_a_checkpoint(folder, run, certified):
    certified(make_certified())
    done = run("solve", "wave.toml", "--certify", "--resume")
    assert done.code == 2
    assert "--certify makes several runs and keeps no checkpoint" in done.err
    (folder / "wave.nc.checkpoint").write_bytes(b"of another run")
    done = run("solve", "wave.toml", "--certify")
    assert done.code == 2
    assert "holds an unfinished run" in done.err
    assert names(folder) == ["wave.nc.checkpoint", "wave.toml"]


def test_a_certified_run_of_the_solver_shows_each_of_its_runs(folder, run):
    done = run("solve", "wave.toml", "--certify", "--set", "contact.moes_load=10")
    assert done.code == 0
    assert "certify: the finest grid" in done.err
    assert "certify: 33 x 33 nodes, half the intervals" in done.err
    assert "17 x 17 has too few nodes" in done.out
    assert " +- " in done.out


def test_a_steady_case_has_nothing_to_resume(folder, run):
    (folder / "steady.toml").write_text(
        CASE.replace('[transient]\nframes = 3\nduration = "0.8 ms"\n', "")
    )
    done = run("solve", "steady.toml", "--resume")
    assert done.code == 2
    assert "the case has neither [transient] nor supply.passes" in done.err


def test_a_full_disk_does_not_end_a_run(folder, capsys):
    kind = replace(STEPS, pack=lambda _: {})
    keeper = Keeper(folder / "nowhere" / "x", Fingerprint("0.1.0", "abc"), kind)
    keeper.last = object()
    assert not keeper.write()
    assert not keeper.write()
    assert capsys.readouterr().err.count("checkpoint not written") == 1


def test_a_stored_run_is_animated(folder, run):
    make_transient().save("run.nc")
    assert run("animate", "run.nc", "--dpi", "30").code == 0
    assert (folder / "run.gif").read_bytes()[:6] == b"GIF89a"
    assert run("animate", "run.nc", "-o", "run.html", "--dpi", "30").code == 0
    assert "<script" in (folder / "run.html").read_text()
    below = run("animate", "run.nc", "-o", "below.gif", "--stress", "2", "--dpi", "30")
    assert below.code == 0
    assert (folder / "below.gif").read_bytes()[:6] == b"GIF89a"
    assert names(folder) == ["below.gif", "run.gif", "run.html", "run.nc", "wave.toml"]


def test_an_animation_without_ffmpeg_is_rejected_before_any_work(folder, run, monkeypatch):
    monkeypatch.setattr(animation.shutil, "which", lambda _: None)
    done = run("animate", "none.nc", "-o", "run.mp4")
    assert done.code == 2
    assert "ffmpeg, which is not installed" in done.err
    assert "ends in .gif, .mp4, .html" in run("animate", "none.nc", "-o", "run.avi").err


def test_a_steady_result_is_not_animated(folder, run):
    make_result(33).save("film.nc")
    done = run("animate", "film.nc")
    assert done.code == 2
    assert "holds a steady result; expected a transient one" in done.err


def test_plot_draws_what_the_file_holds(folder, run):
    make_transient().save("run.nc")
    done = run("plot", "run.nc")
    assert done.code == 0
    assert "space_time.png" in names(folder / "run_plots")
