"""Compilation before a clock starts: of all that a solve needs, in processes side by side."""

import subprocess
import sys

import pytest

from tehl.kernels import cache, compiled, warmup

SOLVED = """
import importlib, pkgutil
import tehl.kernels
from tehl.kernels.warmup import warm_up
from tehl.contact.options import Options
from tehl.estimate.scaling import scales
from tehl.api.solvers import solve, solve_transient
from tehl.contact.transient import Transient
from tests.cases import moes_problem
from tests.reference import DOMAIN, heated_contact

def signatures():
    names = [m.name for m in pkgutil.walk_packages(tehl.kernels.__path__, "tehl.kernels.")]
    parts = [value for name in names for value in vars(importlib.import_module(name)).values()]
    return {one.__name__: one.signatures for one in parts if hasattr(one, "nopython_signatures")}

warm_up(coupled=True)
before = signatures()
for problem, points in ((moes_problem(20.0, 10.0), 257), (heated_contact(0.5), 65)):
    solve(problem, Options(points=points))
    units = scales(problem)
    duration = 0.3 * units.half_width_x / units.speed
    moving = problem.model_copy(update={"transient": Transient(duration=duration, frames=0)})
    solve_transient(moving, Options(points=65, domain=DOMAIN))
for name, now in signatures().items():
    if now != before[name]:
        print(name, now)
"""
COMPILED = """
from tehl.kernels.samples import ISOTHERMAL
from tehl.kernels.warmup import Compilation
reports = []
compilation = Compilation(list(ISOTHERMAL[-4:]), reports.append)
compilation.processes = 2
compilation.run()
assert reports[0].done == 0 and reports[0].names and reports[0].seconds_left > 0.0, reports
assert reports[-1].done == reports[-1].total == 4 and not reports[-1].names, reports
assert abs(reports[-1].seconds_left) < 1e-9
print(sum(len(sample.kernel.signatures) for sample in ISOTHERMAL))
"""


def run_python(program: str) -> str:
    """Return what ``program`` prints in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=500, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_solve_compiles_nothing_more():
    assert not run_python(SOLVED)


def test_two_processes_share_the_kernels(monkeypatch, tmp_path):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    here = int(run_python(COMPILED))
    assert 1 <= here <= 3  # the rest in the other process
    assert len(list(tmp_path.rglob("*.nbi"))) == 4


class Kernel:
    """Stands for a sample; counts how often it is compiled."""

    def __init__(self, seconds: float) -> None:
        self.name, self.seconds, self.compiled = f"takes {seconds}", seconds, 0

    def compile(self) -> None:
        self.compiled += 1


@pytest.mark.parametrize("program", ["", "import sys; sys.exit(1)", "print(input())"])
def test_this_process_compiles_what_others_leave(monkeypatch, program):
    """Others that end at once, or after one kernel; an input would wait."""
    start = warmup._start

    def start_and_let_end() -> subprocess.Popen:
        process = start()
        if "input" not in program:
            process.wait()
        return process

    monkeypatch.setattr(warmup, "SERVE", program)
    monkeypatch.setattr(warmup, "_start", start_and_let_end)
    samples, reports = [Kernel(float(k)) for k in range(1, 6)], []
    compilation = warmup.Compilation(samples, reports.append)
    compilation.processes = 3
    compilation.run()
    assert sum(sample.compiled for sample in samples) >= 3
    assert reports[-1].done == 5
    assert not compilation.running


def test_a_damaged_cache_is_compiled_again(monkeypatch):
    class Damaged(Kernel):
        def compile(self) -> None:
            super().compile()
            if self.compiled == 1:
                raise EOFError

    sample, cleared = Damaged(1.0), []
    monkeypatch.setattr(warmup, "PARTS", {"isothermal": [sample]})
    monkeypatch.setattr(warmup, "_load", warmup._load.__wrapped__)
    monkeypatch.setattr(warmup.cache, "missing", lambda **_: [])
    monkeypatch.setattr(warmup.cache, "clear", lambda: cleared.append(True))
    warmup.warm_up(coupled=False)
    assert (sample.compiled, cleared) == (2, [True])


def test_helpers_are_left_to_their_callers():
    """A failure means: numba's internals changed; kernels compile in 1.5 times the time."""
    assert compiled.can_leave_to_callers()


def test_a_folder_that_a_newer_source_removed_is_no_error(monkeypatch, tmp_path):
    monkeypatch.setattr(cache, "folder", lambda: tmp_path / "removed")
    cache.mark_compiled("isothermal")
    assert cache.is_cold(coupled=False)
