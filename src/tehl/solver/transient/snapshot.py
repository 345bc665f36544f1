"""The state from which a transient run can be resumed, and its arrays in a checkpoint."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.result import Cost
from tehl.solver.transient.record import Record
from tehl.transient_result import History
from tehl.typing import Array

NOTHING = Cost(cpu_seconds=0.0, wall_seconds=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Snapshot:
    """All that a run needs to go on as if it had not been interrupted.

    Attributes
    ----------
    setting : int
        Number of the setting of the relaxation.
    rigid_approach : float
        H00 [-].
    fields : dict of str to array
        Pressure, mass of the last two films and what of it moves without being there, what the
        pressure of the last four steps differed by from that of the beginning, and what the
        coupling remembers.
    record : Record
        What has been noted so far.
    cost : Cost
        Expense so far, that of the start included.
    """

    setting: int
    rigid_approach: float
    fields: dict[str, Array]
    record: Record
    cost: Cost = NOTHING

    def copy(self) -> "Snapshot":
        """Return a snapshot that the run does not change any more."""
        fields = {name: field.copy() for name, field in self.fields.items()}
        return replace(self, fields=fields, record=self.record.copy())


class Clock:
    """Measures what a run costs from now on, on top of what its earlier parts have cost."""

    def __init__(self) -> None:
        self.before = NOTHING
        self._wall, self._cpu = time.perf_counter(), time.process_time()

    def cost(self) -> Cost:
        """Return the expense so far."""
        return Cost(
            cpu_seconds=self.before.cpu_seconds + time.process_time() - self._cpu,
            wall_seconds=self.before.wall_seconds + time.perf_counter() - self._wall,
        )


Arrays = Mapping[str, NDArray[Any]]

ANEW = "; remove it, and the run begins anew"
"""How the sentence on a checkpoint ends that cannot be used."""
_FIELD = "field_"
_COLUMNS = tuple(one.name for one in fields(History))
_LINES, _FRAMES = 4, 3
"""What a step has in the history, along y = 0, and in a frame: pressure, film and heights."""
_LAYOUT = {
    "setting": (0, np.int64),
    "rigid_approach": (0, np.float64),
    "cost": (1, np.float64),
    "rows": (2, np.float64),
    "profiles": (3, np.float64),
    "frame_steps": (1, np.int64),
    "frames": (4, np.float32),
}
"""Dimensions and kind of number of all but the fields."""


def pack(snapshot: Snapshot) -> dict[str, NDArray[Any]]:
    """Return a snapshot as arrays by name."""
    record = snapshot.record
    return {
        "setting": np.array(snapshot.setting, np.int64),
        "rigid_approach": np.array(snapshot.rigid_approach),
        "cost": np.array([snapshot.cost.cpu_seconds, snapshot.cost.wall_seconds]),
        "rows": np.array(record.rows),
        "profiles": np.stack(record.profiles),
        "frame_steps": np.array(record.frame_steps, np.int64),
        "frames": np.stack(record.frames) if record.frames else np.zeros((0,) * 4, np.float32),
        **{f"{_FIELD}{name}": field for name, field in snapshot.fields.items()},
    }


def unpack(arrays: Arrays) -> Snapshot:
    """Return the snapshot that :func:`pack` made arrays of, bit by bit.

    Raises
    ------
    InputError
        If something is missing, does not fit the rest, or is no finite number.
    """
    check_whole(arrays)
    cpu, wall = arrays["cost"].tolist()
    return Snapshot(
        setting=int(arrays["setting"]),
        rigid_approach=float(arrays["rigid_approach"]),
        fields={
            name.removeprefix(_FIELD): field
            for name, field in arrays.items()
            if name.startswith(_FIELD)
        },
        record=Record(
            rows=[tuple(row) for row in arrays["rows"].tolist()],
            profiles=list(arrays["profiles"]),
            frame_steps=arrays["frame_steps"].tolist(),
            frames=list(arrays["frames"]),
        ),
        cost=Cost(cpu_seconds=cpu, wall_seconds=wall),
    )


def check_whole(arrays: Arrays) -> None:
    """Refuse the arrays of a snapshot that do not belong together, whatever the case.

    Raises
    ------
    InputError
        If something is missing, does not fit the rest, or is no finite number.
    """
    wrong = next(_faults(arrays), None)
    if wrong is not None:
        raise InputError(f"the checkpoint is not whole: {wrong}{ANEW}")


def _faults(arrays: Arrays) -> Iterator[str]:
    """Yield what is wrong; what comes later takes for granted that nothing was before."""
    for name, (dimensions, kind) in _LAYOUT.items():
        if name not in arrays:
            yield f"{name!r} is missing"
        elif arrays[name].ndim != dimensions or arrays[name].dtype != kind:
            yield f"{name!r} is not of {dimensions} dimensions and {np.dtype(kind)}"
    for name, values in arrays.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values).all():
            yield f"{name.removeprefix(_FIELD)!r} has values that are not finite numbers"
    yield from _misfits(arrays)


def _misfits(arrays: Arrays) -> Iterator[str]:
    """Yield what of the record does not fit the rest of it."""
    rows, profiles, frames = arrays["rows"], arrays["profiles"], arrays["frames"]
    steps, kept = len(rows), arrays["frame_steps"]
    if not steps or rows.shape[1] != len(_COLUMNS):
        yield f"'rows' has the shape {rows.shape}, not {len(_COLUMNS)} numbers per step"
    if profiles.shape[:2] != (steps, _LINES):
        yield f"'profiles' has the shape {profiles.shape}, not {_LINES} lines in {steps} steps"
    if len(frames) != len(kept) or (len(kept) and frames.shape[1] != _FRAMES):
        yield f"'frames' has the shape {frames.shape}, not {_FRAMES} fields in {len(kept)} frames"
    if (np.diff(kept) <= 0).any() or ((kept < 0) | (kept >= steps)).any():
        yield f"'frame_steps' are no steps of {steps}, one after the other"
    if arrays["cost"].shape != (2,) or (arrays["cost"] < 0.0).any():
        yield "'cost' is not the seconds of processor and clock"
    last = dict(zip(_COLUMNS, rows[-1], strict=True))
    pressure = arrays.get(f"{_FIELD}pressure", np.zeros(1)).max()
    if (last["rigid_approach"], last["pressure_max"]) != (arrays["rigid_approach"], pressure):
        yield "its pressure is not that of its last step"
