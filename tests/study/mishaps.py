"""Work that goes wrong on purpose, in the place of that of the solver; and a program that runs it.

``python tests/study/mishaps.py DIR JOBS COUNT [forked]`` is a study of quick rows; PYTHONPATH has
to hold this project.
"""

import os
import signal
import sys
import time
from pathlib import Path

from tehl.studies import Case, Row, Store, run, runner
from tests.study.contacts import cases


def quick(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Return a row of many numbers at once; a file for its fields holds the name of the case."""
    del guess
    time.sleep(0.01)
    if fields is not None:
        fields.write_text(case.name)
    load = float(case.labels["M"])
    return Row(key=case.key, status="converged", summary={f"n.{k}": load * k for k in range(40)})


def deadly(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Kill the worker at M = 5.5."""
    if case.labels["M"] == 5.5:
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(case, fields, guess)


def once(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Kill the worker at M = 5.5, the first time."""
    assert fields is not None
    mark = fields.with_name("killed")
    if case.labels["M"] == 5.5 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(case, fields, guess)


def orphaned(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Kill the server of the workers at M = 5.5, the first time."""
    assert fields is not None
    mark = fields.with_name("killed")
    if case.labels["M"] == 5.5 and not mark.exists():
        mark.touch()
        assert "forkserver" in Path(f"/proc/{os.getppid()}/cmdline").read_text()
        os.kill(os.getppid(), signal.SIGKILL)
    return quick(case, fields, guess)


def has_solver() -> bool:
    """Return whether this process has loaded the solver."""
    return "tehl.solver" in sys.modules


def threads_of_server() -> int:
    """Return the threads of the process that this one comes from."""
    status = Path(f"/proc/{os.getppid()}/status").read_text()
    (threads,) = (line.split()[1] for line in status.splitlines() if line.startswith("Threads"))
    return int(threads)


def lazy(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Leave the number of the process behind, and take a while."""
    assert fields is not None
    fields.with_name(f"{os.getpid()}.pid").touch()
    time.sleep(0.1)
    return quick(case, fields, guess)


def full(case: Case, fields: Path | None, guess: Path | None = None) -> Row:
    """Find no room for the fields of M = 5.5."""
    if case.labels["M"] == 5.5:
        raise OSError(28, "No space left on device", str(fields))
    return quick(case, fields, guess)


def main(folder: str, jobs: str, count: str, forked: str = "") -> None:
    keep = "fields" if jobs != "1" else "summary"
    runner.work = lazy if keep == "fields" else quick
    run(cases(int(count)), Store(folder, keep=keep), jobs=int(jobs), forked=bool(forked))


if __name__ == "__main__":
    main(*sys.argv[1:])
