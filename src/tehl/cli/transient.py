"""``tehl solve`` of a case with ``[transient]``: checkpoints on the way, and what is told."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from tehl.io.checkpoint import Fingerprint
    from tehl.options import Options
    from tehl.problem import ContactProblem
    from tehl.result import Result
    from tehl.solver.transient.snapshot import Snapshot
    from tehl.transient_result import TransientResult

CHECKPOINT_SECONDS = 30.0
"""CPU time between two checkpoints [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wishes:
    """What is asked of a transient run: where to, what to show, whether to go on or to certify."""

    target: Path
    plot: Path | None
    as_json: bool
    quiet: bool
    resume: bool
    certify: bool = False


def refuse(
    problem: "ContactProblem", *, steady_only: dict[str, bool], in_time_only: dict[str, bool]
) -> None:
    """Refuse options that belong to steady cases only, or to transient runs only.

    Raises
    ------
    InputError
        If one is given that the case has no use for.
    """
    from tehl.errors import InputError

    in_time = problem.transient is not None
    for option, given in (steady_only if in_time else in_time_only).items():
        if given and in_time:
            raise InputError(f"{option} is for steady cases: leave it out, or [transient]")
        if given:
            raise InputError(f"{option} is for transient runs, and the case has no [transient]")


class Keeper:
    """Takes the snapshot of each step, and writes it from time to time.

    Parameters
    ----------
    path : Path
        The checkpoint.
    owner : Fingerprint
        Of the run.
    """

    def __init__(self, path: Path, owner: "Fingerprint") -> None:
        self.path, self.owner = path, owner
        self.last: Snapshot | None = None
        self._written, self._told = time.process_time(), False

    def __call__(self, snapshot: "Snapshot") -> None:
        """Take the state after a step."""
        self.last = snapshot.copy()
        if time.process_time() - self._written >= CHECKPOINT_SECONDS:
            self.write()
            self._written = time.process_time()

    def write(self) -> bool:
        """Write the last state; a full disk is told once and does not end the run."""
        from tehl.errors import InputError
        from tehl.io.checkpoint import write_checkpoint
        from tehl.solver.transient.snapshot import pack

        if self.last is None:
            return False
        try:
            write_checkpoint(self.path, self.owner, pack(self.last))
        except (OSError, InputError) as error:
            if not self._told:
                typer.echo(f"tehl: no checkpoint is kept: {error}", err=True)
            self._told = True
            return False
        return True


def solve_transient_case(problem: "ContactProblem", options: "Options", wishes: Wishes) -> None:
    """Follow a case in time, store the run and tell of it.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        The case; it has a ``transient`` table.
    wishes : Wishes
        What the command line says.

    Raises
    ------
    InputError
        When a certified run is to go on.
    typer.Exit
        With code 1 when the run did not come to its end, or has no error bar that was asked for.
    """
    from tehl.errors import ConvergenceError, InputError
    from tehl.io.atomic import remove_with_parts
    from tehl.io.checkpoint import checkpoint_of, fingerprint

    if wishes.certify and wishes.resume:
        raise InputError(
            "--certify makes several runs and keeps no checkpoint, which belongs to a single one: "
            "leave --resume out, or --certify"
        )
    path, owner = checkpoint_of(wishes.target), fingerprint(problem, options)
    snapshot = _begin(path, owner, resume=wishes.resume)
    try:
        if wishes.certify:
            run = _certify(problem, options, quiet=wishes.quiet)
        else:
            run = _solve(problem, options, Keeper(path, owner), snapshot, quiet=wishes.quiet)
    except ConvergenceError as error:
        _tell_beginning(error.result, str(error), wishes)
        raise typer.Exit(1) from None
    run.save(wishes.target)
    remove_with_parts(path)
    _tell(run, wishes)


def _begin(path: Path, owner: "Fingerprint", *, resume: bool) -> "Snapshot | None":
    """Return where to go on, None at the beginning.

    Raises
    ------
    InputError
        If the checkpoint is of another run, or is of this one and nobody asked to go on.
    FileFormatError
        If it cannot be read.
    """
    from tehl.errors import InputError
    from tehl.io.atomic import check_writable
    from tehl.io.checkpoint import check_owner, read_checkpoint
    from tehl.solver.transient.snapshot import unpack

    check_writable(path)
    if not path.exists():
        if resume:
            typer.echo(f"there is no checkpoint {path}: the run begins at time zero", err=True)
        return None
    if not resume:
        raise InputError(
            f"{path} holds an unfinished run: --resume goes on from it, and removing it begins anew"
        )
    found, arrays = read_checkpoint(path)
    check_owner(path, found, owner)
    snapshot = unpack(arrays)
    typer.echo(f"going on after step {len(snapshot.record.rows) - 1} of {path}", err=True)
    return snapshot


def _solve(
    problem: "ContactProblem",
    options: "Options",
    keeper: Keeper,
    snapshot: "Snapshot | None",
    *,
    quiet: bool,
) -> "TransientResult":
    """Return the run; what ends it from outside leaves a checkpoint."""
    from tehl import solver
    from tehl.cli.step_progress import step_progress
    from tehl.scaling import scales

    with (
        _kept(keeper),
        step_progress(scales(problem), quiet=quiet, coupled=problem.is_coupled) as monitor,
    ):
        return solver.solve_transient(
            problem, options, monitor=monitor, resume=snapshot, keep=keeper
        )


def _certify(problem: "ContactProblem", options: "Options", *, quiet: bool) -> "TransientResult":
    """Return the run with error bars; nothing is kept on the way."""
    from tehl import solver
    from tehl.cli.step_progress import step_progress
    from tehl.scaling import scales

    with step_progress(scales(problem), quiet=quiet, coupled=problem.is_coupled) as monitor:
        return solver.certify_transient(problem, options, monitor=monitor)


@contextmanager
def _kept(keeper: Keeper) -> Iterator[None]:
    """Write the last state when a signal or a lack of memory ends the run."""
    try:
        yield
    except (KeyboardInterrupt, SystemExit, MemoryError):
        if keeper.write() and keeper.last is not None:
            step = len(keeper.last.record.rows) - 1
            typer.echo(
                f"tehl: step {step} is kept in {keeper.path}; tehl solve --resume goes on from it",
                err=True,
            )
        raise


def _tell(run: "TransientResult", wishes: Wishes) -> None:
    """Print the numbers, draw what is wished, and exit with 1 if the run has no end."""
    import json

    from tehl.cli.failure import explain_failure
    from tehl.cli.transient_words import as_text

    if wishes.as_json:
        typer.echo(json.dumps(run.summary(), allow_nan=False))
    else:
        typer.echo(as_text(run))
    typer.echo(f"written: {wishes.target}", err=True)
    if wishes.plot is not None:
        draw(run, wishes.plot, told=lambda path: typer.echo(f"written: {path}", err=True))
    if run.status.converged:
        return
    explain_failure(run.status)
    raise typer.Exit(1)


def _tell_beginning(start: "Result", failure: str, wishes: Wishes) -> None:
    """Store the steady film of a run that got no farther, and tell of it as of a steady case."""
    import json

    from tehl.cli.failure import explain_failure
    from tehl.cli.words import as_text

    start.save(wishes.target)
    typer.echo(json.dumps(start.summary(), allow_nan=False) if wishes.as_json else as_text(start))
    typer.echo(f"written: {wishes.target}", err=True)
    if wishes.plot is not None:
        from tehl.plots.save import save_all

        for path in save_all(start, wishes.plot):
            typer.echo(f"written: {path}", err=True)
    explain_failure(start.status, failure)


def draw(
    run: "TransientResult", folder: Path, *, told: Callable[[Path], None], dpi: int = 150
) -> None:
    """Draw all pictures of a transient run into ``folder``, and tell of each."""
    from tehl.plots.transient import save_transient

    for path in save_transient(run, folder, dpi=dpi):
        told(path)
