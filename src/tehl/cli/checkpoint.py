"""Checkpoints of ``tehl solve``: written during a transient run, read by ``--resume``."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from tehl.errors import InputError
from tehl.io.atomic import check_writable
from tehl.io.checkpoint import Fingerprint, read_checkpoint, write_checkpoint
from tehl.solver.transient.snapshot import Snapshot, pack, unpack

CHECKPOINT_SECONDS = 30.0
"""CPU time between two checkpoints [s]."""


class Keeper:
    """Takes the snapshot of each step of a run, and writes its checkpoint from time to time."""

    def __init__(self, path: Path, owner: Fingerprint) -> None:
        self.path, self.owner = path, owner
        self.last: Snapshot | None = None
        self._written, self._reported = time.process_time(), False

    def __call__(self, snapshot: Snapshot) -> None:
        """Keep the state after a step."""
        self.last = snapshot.copy()
        if time.process_time() - self._written >= CHECKPOINT_SECONDS:
            self.write()
            self._written = time.process_time()

    def write(self) -> bool:
        """Write the last state; a full disk is reported once and does not end the run."""
        if self.last is None:
            return False
        try:
            write_checkpoint(self.path, self.owner, pack(self.last))
        except (OSError, InputError) as error:
            if not self._reported:
                typer.echo(f"tehl: checkpoint not written: {error}", err=True)
            self._reported = True
            return False
        return True

    @contextmanager
    def on_interrupt(self) -> Iterator[None]:
        """Write the last state when a signal or a lack of memory ends the run."""
        try:
            yield
        except (KeyboardInterrupt, SystemExit, MemoryError):
            if self.write() and self.last is not None:
                typer.echo(
                    f"tehl: step {_step(self.last)} is saved in {self.path}; tehl solve --resume "
                    "continues from it",
                    err=True,
                )
            raise

    def begin(self, *, resume: bool) -> Snapshot | None:
        """Return the state to continue from, None at time zero.

        Raises an InputError for a checkpoint without ``resume``, or one of another run.
        """
        check_writable(self.path)
        if not self.path.exists():
            if resume:
                typer.echo(
                    f"checkpoint {self.path} does not exist: starting at time zero", err=True
                )
            return None
        if not resume:
            raise InputError(
                f"{self.path} holds an unfinished run: continue it with --resume, or remove it to "
                "start again"
            )
        snapshot = unpack(read_checkpoint(self.path, self.owner))
        typer.echo(f"continuing after step {_step(snapshot)} of {self.path}", err=True)
        return snapshot


def _step(snapshot: Snapshot) -> int:
    return len(snapshot.record.rows) - 1
