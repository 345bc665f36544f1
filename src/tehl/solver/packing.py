"""A snapshot of a run in time as plain arrays, and back: what a checkpoint holds."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.solver.record import Record
from tehl.solver.transient import Snapshot

_FIELD = "field_"


def pack(snapshot: Snapshot) -> dict[str, NDArray[Any]]:
    """Return a snapshot as arrays by name."""
    record = snapshot.record
    return {
        "setting": np.array(snapshot.setting),
        "rigid_approach": np.array(snapshot.rigid_approach),
        "rows": np.array(record.rows),
        "profiles": np.stack(record.profiles),
        "frame_steps": np.array(record.frame_steps, np.int64),
        "frames": np.stack(record.frames) if record.frames else np.zeros(0, np.float32),
        **{f"{_FIELD}{name}": field for name, field in snapshot.fields.items()},
    }


def unpack(arrays: Mapping[str, NDArray[Any]]) -> Snapshot:
    """Return the snapshot that :func:`pack` made arrays of, bit by bit.

    Raises
    ------
    InputError
        If something is missing.
    """
    try:
        record = Record(
            rows=[tuple(row) for row in arrays["rows"].tolist()],
            profiles=list(arrays["profiles"]),
            frame_steps=arrays["frame_steps"].tolist(),
            frames=list(arrays["frames"]),
        )
        return Snapshot(
            setting=int(arrays["setting"]),
            rigid_approach=float(arrays["rigid_approach"]),
            fields={
                name.removeprefix(_FIELD): field
                for name, field in arrays.items()
                if name.startswith(_FIELD)
            },
            record=record,
        )
    except KeyError as error:
        raise InputError(f"the checkpoint is not whole: {error} is missing") from None
