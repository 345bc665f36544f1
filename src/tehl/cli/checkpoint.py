"""Checkpoints of ``tehl solve``: written during a transient run, read by ``--resume``."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from tehl.base.atomic import check_writable
from tehl.base.errors import InputError
from tehl.cli.lines import show
from tehl.io.checkpoint import Fingerprint, read_checkpoint, write_checkpoint
from tehl.result.solution import ConvergenceError
from tehl.result.transient import TIME_OVER
from tehl.solver.physics import passes
from tehl.solver.transient import snapshot

CHECKPOINT_SECONDS = 30.0
"""CPU time between two checkpoints [s]."""


State = TypeVar("State")


@dataclass(frozen=True, kw_only=True, slots=True)
class Kind(Generic[State]):
    """A kind of state: its steps in words and how many are done, and how it becomes arrays."""

    step: str
    count: Callable[[State], int]
    pack: Callable[[State], Mapping[str, Any]]
    unpack: Callable[[Mapping[str, Any]], State]
    copy: Callable[[State], State]


STEPS = Kind(
    step="step",
    count=lambda state: len(state.record.rows) - 1,
    pack=snapshot.pack,
    unpack=snapshot.unpack,
    copy=snapshot.Snapshot.copy,
)
PASSES = Kind(
    step="pass",
    count=lambda state: len(state.rows),
    pack=passes.pack,
    unpack=passes.unpack,
    copy=lambda state: state,
)


class Keeper(Generic[State]):
    """Takes the state after each step of a run, and writes its checkpoint from time to time."""

    def __init__(self, path: Path, owner: Fingerprint, kind: Kind[State]) -> None:
        self.path, self.owner, self.kind = path, owner, kind
        self.last: State | None = None
        self._written, self._reported = time.process_time(), False

    def __call__(self, state: State) -> None:
        """Keep the state after a step."""
        self.last = self.kind.copy(state)
        if time.process_time() - self._written >= CHECKPOINT_SECONDS:
            self.write()
            self._written = time.process_time()

    def write(self) -> bool:
        """Write the last state; a full disk is reported once and does not end the run."""
        if self.last is None:
            return False
        try:
            write_checkpoint(self.path, self.owner, self.kind.pack(self.last))
        except (OSError, InputError) as error:
            if not self._reported:
                show(f"tehl: checkpoint not written: {error}", err=True)
            self._reported = True
            return False
        return True

    @contextmanager
    def on_interrupt(self) -> Iterator[None]:
        """Write the last state when a signal, a lack of memory or of time ends the run."""
        try:
            yield
        except ConvergenceError as error:
            if error.result.status.cause == TIME_OVER:
                self.leave()
            raise
        except (KeyboardInterrupt, SystemExit, MemoryError):
            self.leave()
            raise

    def leave(self) -> None:
        """Write the last state, and show how to continue from it."""
        if self.write() and self.last is not None:
            show(
                f"tehl: {self._where(self.last)} is saved in {self.path}; tehl solve --resume "
                "continues from it",
                err=True,
            )

    def begin(self, *, resume: bool) -> State | None:
        """Return the state to continue from, None at time zero.

        Raises an InputError for a checkpoint without ``resume``, or one of another run.
        """
        check_writable(self.path)
        if not self.path.exists():
            if resume:
                show(f"checkpoint {self.path} does not exist: starting at time zero", err=True)
            return None
        if not resume:
            raise InputError(
                f"{self.path} holds an unfinished run: continue it with --resume, or remove it to "
                "start again"
            )
        state = self.kind.unpack(read_checkpoint(self.path, self.owner))
        show(f"continuing after {self._where(state)} of {self.path}", err=True)
        return state

    def _where(self, state: State) -> str:
        return f"{self.kind.step} {self.kind.count(state)}"
