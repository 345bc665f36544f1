"""Killed workers, a killed program, a full disk: no finished case is lost or damaged."""

import os
import resource
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from multiprocessing import forkserver
from pathlib import Path

import pytest

from tehl.base.errors import FileFormatError
from tehl.studies import Store, run, runner, table
from tehl.studies.engines import WorkerDied, engine_of
from tests.study import mishaps
from tests.study.contacts import Notes, cases

COUNT = 24
ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="each worker loads for itself")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    store = Store(tmp_path_factory.mktemp("undisturbed"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner, "work", mishaps.quick)
        run(cases(60), store)
    return table(cases(60), store)


def is_like(frame, undisturbed) -> bool:
    return frame.equals(undisturbed.head(len(frame)))


def test_a_case_that_kills_its_worker_fails_alone(tmp_path, monkeypatch, undisturbed):
    monkeypatch.setattr(runner, "work", mishaps.deadly)
    store = Store(tmp_path)
    outcome = run(cases(COUNT), store, jobs=2, forked=True)
    assert [(c.labels["M"], r.status, r.cause) for c, r in outcome.failed] == [
        (5.5, "failed", "worker_died")
    ]
    assert "memory" in outcome.failed[0][1].message
    assert outcome.converged == COUNT - 1
    monkeypatch.setattr(runner, "work", mishaps.quick)
    again = run(cases(COUNT), store, retry_failed=True)
    assert (again.reused, again.converged) == (COUNT - 1, COUNT)
    assert is_like(table(cases(COUNT), store), undisturbed)


def test_a_worker_killed_from_outside_loses_no_case(tmp_path, monkeypatch, undisturbed):
    monkeypatch.setattr(runner, "work", mishaps.once)
    store, notes = Store(tmp_path, keep="fields"), Notes()
    outcome = run(cases(COUNT), store, jobs=2, forked=True, monitor=notes)
    assert outcome.failed == ()
    assert len(notes.names) == COUNT
    assert is_like(table(cases(COUNT), store), undisturbed)


@ON_LINUX
def test_a_killed_fork_server_loses_no_case(tmp_path, monkeypatch, undisturbed):
    monkeypatch.setattr(runner, "work", mishaps.orphaned)
    store, notes = Store(tmp_path, keep="fields"), Notes()
    assert run(cases(COUNT), store, jobs=2, forked=True, monitor=notes).failed == ()
    assert len(notes.names) == COUNT
    assert is_like(table(cases(COUNT), store), undisturbed)


@ON_LINUX
@pytest.mark.parametrize(
    "server", ["begins", pytest.param("has loaded the solver", marks=pytest.mark.slow)]
)
def test_a_fork_server_killed_before_it_has_workers_loses_no_case(
    tmp_path, monkeypatch, undisturbed, server
):
    monkeypatch.setattr(runner, "work", mishaps.quick)
    forkserver._forkserver._stop()  # one of the tests before, if any
    forkserver.set_forkserver_preload(["tehl.studies.ready"])
    forkserver.ensure_running()
    pid = forkserver._forkserver._forkserver_pid
    if server != "begins":
        time.sleep(3.0)
    threading.Timer(0.3, os.kill, (pid, signal.SIGKILL)).start()
    store = Store(tmp_path)
    assert run(cases(COUNT), store, jobs=2, forked=True).failed == ()
    assert is_like(table(cases(COUNT), store), undisturbed)


@ON_LINUX
@pytest.mark.parametrize("forked", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_workers_have_one_thread_and_forked_ones_begin_with_the_solver(forked):
    with engine_of(2, 2, forked=forked) as engine:
        engine.submit("has solver", mishaps.has_solver)
        engine.submit("threads", os.getenv, "OMP_NUM_THREADS")
        found = dict(engine.take())
        while len(found) < 2:
            found |= dict(engine.take())
        assert found == {"has solver": forked, "threads": "1"}
        if forked:
            engine.submit("threads of server", mishaps.threads_of_server)
            assert engine.take() == [("threads of server", 1)]


def test_a_dead_worker_takes_no_other_task_along():
    with engine_of(2, 2, forked=True) as engine:
        engine.submit("dies", os._exit, 3)
        engine.submit("stays", time.sleep, 0.3)
        first, second = engine.take(), engine.take()
        assert isinstance(dict(first)["dies"], WorkerDied)
        assert second == [("stays", None)]
        (idle,) = engine._idle
        os.kill(idle.process.pid, signal.SIGKILL)
        idle.process.join()
        engine.submit("given to a dead one", os.getpid)
        ((_, died),) = engine.take()
        assert isinstance(died, WorkerDied)
        engine.submit("given to a fresh one", abs, -1)
        assert engine.take() == [("given to a fresh one", 1)]


def program(*words: str, **options) -> subprocess.Popen:
    command = [sys.executable, mishaps.__file__, *words]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
    return subprocess.Popen(command, env=environment, **options)


def wait_for(condition, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it takes too long"
        time.sleep(0.02)


def is_alive(pid: int) -> bool:
    try:
        status = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] != "Z"


def finished(folder: Path) -> int:
    return len(Store(folder).rows(cases(60)))


@pytest.mark.parametrize(
    ("how", "forked"),
    [
        (signal.SIGKILL, "forked"),
        pytest.param(signal.SIGINT, "forked", marks=pytest.mark.slow),
        pytest.param(signal.SIGTERM, "forked", marks=pytest.mark.slow),
        pytest.param(signal.SIGKILL, "", marks=pytest.mark.slow),
        pytest.param(signal.SIGINT, "", marks=pytest.mark.slow),
    ],
)
def test_a_killed_program_continues_where_it_stopped(tmp_path, undisturbed, how, forked):
    process = program(str(tmp_path), "2", "60", forked, stderr=subprocess.DEVNULL)
    wait_for(lambda: (tmp_path / "rows.sqlite").exists() and finished(tmp_path) >= 4)
    process.send_signal(how)
    process.wait(30)
    workers = [int(path.stem) for path in (tmp_path / "fields").glob("*.pid")]
    assert workers
    wait_for(lambda: not any(map(is_alive, workers)))
    kept = finished(tmp_path)
    assert 4 <= kept < 60
    with sqlite3.connect(tmp_path / "rows.sqlite") as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    store = Store(tmp_path)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner, "work", mishaps.quick)
        assert run(cases(60), store).reused == kept
    assert table(cases(60), store).equals(undisturbed)


STUDY = """
case.contact = { radius = "20 mm", load = "20 N", entrainment_speed = 1.0 }
case.surface_1 = { material = "steel" }
case.surface_2 = { material = "steel" }
case.lubricant.viscosity = { law = "roelands", eta_0 = 0.04, alpha = 2.2e-8 }
case.lubricant.density = { law = "dowson-higginson", rho_0 = 890 }
case.numerics = { points = 65 }
axes = [{ path = "contact.load", linspace = [20, 40, 600] }]
"""


@pytest.mark.parametrize(
    "wait", [0.3, *(pytest.param(one, marks=pytest.mark.slow) for one in (0.0, 1.0))]
)
def test_ctrl_c_while_workers_start_is_one_line(tmp_path, wait):
    (tmp_path / "s.toml").write_text(STUDY)
    command = [sys.executable, "-m", "tehl", "study", "s.toml", "-o", "out", "--jobs", "2"]
    with subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        first = process.stderr.readline()
        time.sleep(wait)
        os.killpg(process.pid, signal.SIGINT)
        shown = process.stderr.read()  # until the last of its processes is gone
    assert "600 cases" in first
    assert process.returncode == 130
    assert shown.splitlines()[-1] == "tehl: interrupted"
    assert "Traceback" not in shown


def test_a_full_disk_under_the_rows_ends_the_study_and_keeps_what_is_finished(
    tmp_path, undisturbed
):
    def cramped():
        resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))

    process = program(str(tmp_path), "1", "60", preexec_fn=cramped, stderr=subprocess.PIPE)
    _, shown = process.communicate(timeout=60)
    assert process.returncode != 0
    assert b"OSError" in shown
    store = Store(tmp_path)
    kept = store.rows(cases(60))
    assert 0 < len(kept) < 60
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner, "work", mishaps.quick)
        assert run(cases(60), store).reused == len(kept)
    assert table(cases(60), store).equals(undisturbed)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_full_disk_under_the_fields_does_not_fail_the_case(
    tmp_path, monkeypatch, undisturbed, jobs
):
    monkeypatch.setattr(runner, "work", mishaps.full)
    store = Store(tmp_path, keep="fields")
    with pytest.raises(OSError, match="No space left"):
        run(cases(COUNT), store, jobs=jobs, forked=True)
    assert store.row(cases(COUNT)[2]) is None
    monkeypatch.setattr(runner, "work", mishaps.quick)
    assert run(cases(COUNT), store).converged == COUNT
    assert is_like(table(cases(COUNT), store), undisturbed)


def test_incomplete_files_of_killed_workers_are_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "work", mishaps.quick)
    store = Store(tmp_path, keep="fields")
    store.prepare()
    mine = store.fields_folder / f".{cases(1)[0].key[:40]}.0123456789ab.part"
    other = store.fields_folder / f".{'f' * 40}.0123456789ab.part"
    for part in (mine, other):
        part.write_text("half")
    run(cases(2), store)
    assert not mine.exists()
    assert other.exists()


@pytest.mark.slow
def test_a_script_without_a_guard_gets_a_hint(tmp_path):
    script = tmp_path / "bare.py"
    script.write_text(
        "from tehl.studies import Store, run\n"
        "from tests.study.contacts import cases\n"
        f"run(cases(3), Store({str(tmp_path / 'store')!r}), jobs=2)\n"
    )
    root = Path(__file__).parents[2]
    path = os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, str(script)],
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert done.returncode == 1
    *_, shown = (line for line in done.stderr.splitlines() if "Error: " in line)  # workers may
    assert 'if __name__ == "__main__":' in shown  # print more after it


@ON_LINUX
def test_a_file_of_the_current_folder_is_not_taken_for_a_library(tmp_path):
    for name in ("secrets", "calendar", "random"):
        (tmp_path / f"{name}.py").write_text("raise RuntimeError('not a library')")
    done = program(str(tmp_path / "store"), "2", "6", "forked", cwd=tmp_path)
    assert done.wait(100) == 0
    assert finished(tmp_path / "store") == 6


@pytest.mark.parametrize("content", [b"", b"no store at all, but more than a hundred bytes " * 5])
def test_a_file_that_is_not_a_store_is_rejected(tmp_path, content):
    (tmp_path / "rows.sqlite").write_bytes(content)
    if not content:
        assert Store(tmp_path).rows(cases(1)) == {}  # as SQLite makes it, before anything is in
        return
    with pytest.raises(FileFormatError, match="is not a store of a study"):
        Store(tmp_path)


def test_a_store_of_another_format_is_rejected(tmp_path):
    with sqlite3.connect(tmp_path / "rows.sqlite") as connection:
        connection.execute("PRAGMA user_version = 99")
    with pytest.raises(FileFormatError, match="format 99"):
        Store(tmp_path)


@pytest.mark.parametrize("summary", ["{", "[1]", "", "\udcff"])
def test_a_row_that_is_damaged_is_solved_again(tmp_path, monkeypatch, summary):
    monkeypatch.setattr(runner, "work", mishaps.quick)
    store = Store(tmp_path)
    run(cases(3), store)
    whole = table(cases(3), store)
    store.close()
    with sqlite3.connect(tmp_path / "rows.sqlite") as connection:
        content = summary.encode("utf-8", "surrogateescape")
        change = "UPDATE rows SET summary = CAST(? AS TEXT) WHERE key = ?"
        connection.execute(change, (content, cases(3)[1].key))
    assert list(table(cases(3), store)["status"]) == ["converged", "open", "converged"]
    assert run(cases(3), store).reused == 2
    assert table(cases(3), store).equals(whole)


def test_a_row_without_a_cost_is_solved_again(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "work", mishaps.quick)
    store = Store(tmp_path)
    run(cases(2), store)
    store.close()
    with sqlite3.connect(tmp_path / "rows.sqlite") as connection:
        connection.execute("UPDATE rows SET cpu_seconds = 'much'")
    assert run(cases(2), store).reused == 0
