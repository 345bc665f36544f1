"""State from which a transient run resumes, and its arrays in a checkpoint."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.result import Cost
from tehl.solver.transient.record import COLUMNS, Record
from tehl.typing import Array

Arrays = Mapping[str, NDArray[Any]]

ANEW = "; remove it, and the run starts anew"
"""End of the message on an invalid checkpoint."""
_FIELD = "field_"
_LINES, _FRAMES = 4, 3
"""Arrays per step in a profile (pressure, film and both heights), and in a frame."""
_LAYOUT = {
    "setting": (0, np.int64),
    "rigid_approach": (0, np.float64),
    "cost": (1, np.float64),
    "rows": (2, np.float64),
    "profiles": (3, np.float64),
    "frame_steps": (1, np.int64),
    "frames": (4, np.float32),
}
"""Dimensions and number type of all arrays but the fields."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Snapshot:
    """State from which a run resumes bit by bit.

    Attributes
    ----------
    setting : int
        Number of the relaxation in use.
    rigid_approach : float
        H00 [-].
    fields : dict of str to array
        Pressure; mass of the last two films, and its excess in the flux; differences of the last
        four pressures to the steady one; and the state of the coupling.
    record : Record
        The steps so far.
    cost : Cost
        Cost so far, including the steady film.
    """

    setting: int
    rigid_approach: float
    fields: dict[str, Array]
    record: Record
    cost: Cost

    def copy(self) -> "Snapshot":
        """Return a copy that the run does not change."""
        fields = {name: field.copy() for name, field in self.fields.items()}
        return replace(self, fields=fields, record=self.record.copy())


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
    """Return the snapshot of arrays that :func:`pack` returned.

    Raises
    ------
    InputError
        If an array is missing, inconsistent with the others, or not finite.
    """
    wrong = next(_faults(arrays), None)
    if wrong is not None:
        raise InputError(f"the checkpoint is damaged: {wrong}{ANEW}")
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


def _faults(arrays: Arrays) -> Iterator[str]:
    """Yield what is wrong; each check relies on those before it."""
    for name, (dimensions, kind) in _LAYOUT.items():
        if name not in arrays:
            yield f"{name!r} is missing"
        elif arrays[name].ndim != dimensions or arrays[name].dtype != kind:
            yield f"{name!r} does not have {dimensions} dimensions of {np.dtype(kind)}"
    for name, values in arrays.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values).all():
            yield f"{name.removeprefix(_FIELD)!r} has values that are not finite"
    yield from _misfits(arrays)


def _misfits(arrays: Arrays) -> Iterator[str]:
    """Yield inconsistencies of the record."""
    rows, profiles, frames = arrays["rows"], arrays["profiles"], arrays["frames"]
    steps, kept = len(rows), arrays["frame_steps"]
    if not steps or rows.shape[1] != len(COLUMNS):
        yield f"'rows' has the shape {rows.shape}; expected {len(COLUMNS)} numbers per step"
    if profiles.shape[:2] != (steps, _LINES):
        yield f"'profiles' has the shape {profiles.shape}; expected {_LINES} lines in {steps} steps"
    if len(frames) != len(kept) or (len(kept) and frames.shape[1] != _FRAMES):
        wanted = f"{_FRAMES} fields in {len(kept)} frames"
        yield f"'frames' has the shape {frames.shape}; expected {wanted}"
    if (np.diff(kept) <= 0).any() or ((kept < 0) | (kept >= steps)).any():
        yield f"'frame_steps' are not increasing steps below {steps}"
    if arrays["cost"].shape != (2,) or (arrays["cost"] < 0.0).any():
        yield "'cost' is not two non-negative numbers of seconds"
    last = dict(zip(COLUMNS, rows[-1], strict=True))
    pressure = arrays.get(f"{_FIELD}pressure", np.zeros(1)).max()
    if (last["rigid_approach"], last["pressure_max"]) != (arrays["rigid_approach"], pressure):
        yield "its pressure is not that of its last step"
