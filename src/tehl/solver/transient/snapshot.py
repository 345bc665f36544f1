"""Record of a transient run, and the snapshot from which it resumes.

Both are scaled; `Record` converts to SI, `pack` to the arrays of a checkpoint.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.transient import Transient
from tehl.estimate.scaling import Scales
from tehl.operators.heated_film import stress_unit
from tehl.operators.transfer import midpoints
from tehl.result.solution import Cost
from tehl.result.transient import Frames, History, Profiles
from tehl.solver.cycle.level import Level
from tehl.solver.judging.film_summary import film_summary

Heights = tuple[Array, Array]
COLUMNS = tuple(one.name for one in fields(History))
Arrays = Mapping[str, NDArray[Any]]

ANEW = "; remove it, and the run starts anew"
"""End of the message on an invalid checkpoint."""
_FIELD = "field_"
_LAYOUT: dict[str, tuple[type, tuple[str | int, ...]]] = {
    "setting": (np.int64, ()),
    "rigid_approach": (np.float64, ()),
    "cost": (np.float64, (2,)),
    "rows": (np.float64, ("steps", len(COLUMNS))),
    "profiles": (np.float64, ("steps", 4, "nodes")),
    "frame_steps": (np.int64, ("frames",)),
    "frames": (np.float32, ("frames", "fields", "rows", "columns")),
}
"""Number type and shape of all arrays but the fields. A profile has pressure, film and both
heights, a frame pressure, film and height, and the stress at mid-film if the case has [stress]."""


def carried(level: Level) -> Array:
    """Return the pressure of the oil; with that of the contact through a boundary film, if any."""
    return level.film.p if level.equations.solids.contact_film is None else level.pressure


@dataclass(slots=True)
class Record:
    """Numbers, profiles and fields of the steps so far, scaled."""

    rows: list[tuple[float, ...]] = field(default_factory=list)
    """Per step, the columns of `tehl.result.transient.History`."""
    profiles: list[Array] = field(default_factory=list)
    """Per step, pressure, film and both heights along y = 0, (4, nx), at the nodes of the first."""
    frame_steps: list[int] = field(default_factory=list)
    """Steps whose fields are stored."""
    frames: list[Array] = field(default_factory=list)
    """Their pressure, film and height, and stress if it is asked for, (3 or 4, ny, nx)."""

    def note(
        self,
        level: Level,
        heights: Heights,
        numbers: dict[str, float],
        *,
        keep: bool,
        stress: Array | None = None,
    ) -> None:
        """Append a step.

        Parameters
        ----------
        level : Level
            The finest level after the step.
        heights : (array, array)
            Heights of both surfaces, ``grid.shape`` [-].
        numbers : dict of str to float
            Columns of the history besides film, pressure and rigid approach.
        keep : bool
            Store the fields too.
        stress : array or None
            At mid-film, stored with them [-].
        """
        film = film_summary(level.grid, level.film.h, level.equations.solids.contact_film)
        row = numbers | {
            "film_central": film.central,
            "film_minimum": film.minimum,
            "pressure_max": float(carried(level).max()),
            "asperity_load": sum(level.share.parts(level).values()),
            "rigid_approach": level.rigid_approach,
        }
        self.rows.append(tuple(float(row[name]) for name in COLUMNS))
        line = 0 if level.grid.mirror else level.grid.shape[0] // 2
        pressure = np.maximum(carried(level), 0.0)  # between asperities it may be an error below
        lines = (pressure, level.film.h, *heights)
        self.profiles.append(self._at_first_nodes(np.stack([one[line] for one in lines])))
        if keep:
            self.frame_steps.append(len(self.rows) - 1)
            together = heights[0] + heights[1]
            stored = (pressure, level.film.h, together, *(() if stress is None else (stress,)))
            whole = np.stack([level.grid.unfold(one) for one in stored])
            self.frames.append(self._at_first_nodes(whole).astype(np.float32))

    def _at_first_nodes(self, fields: Array) -> Array:
        """Return fields at the nodes of time zero, linear between those of a coarser grid."""
        nodes = self.profiles[0].shape[-1] if self.profiles else fields.shape[-1]
        while fields.shape[-1] < nodes:
            fields = midpoints(fields, (*fields.shape[:-1], 2 * fields.shape[-1] - 1))
        return fields

    def copy(self) -> "Record":
        """Return a copy that later steps do not change."""
        return Record(**{one.name: getattr(self, one.name).copy() for one in fields(self)})

    def history(self, scales: Scales) -> History:
        """Return the numbers of all steps, in SI."""
        units = {
            "film_central": scales.film_thickness,
            "film_minimum": scales.film_thickness,
            "pressure_max": scales.hertz_pressure,
            "drilling_moment": scales.load * scales.half_width_x,
            "rolling_moment": scales.hertz_pressure * scales.half_width_x**2 * scales.half_width_y,
        }
        columns: dict[str, Any] = {
            name: column * units.get(name, 1.0)
            for name, column in zip(COLUMNS, np.array(self.rows).T, strict=True)
        }
        whole = {name: columns[name].astype(np.int64) for name in ("nodes", "cycles")}
        return History(**columns | whole)

    def lines(self, scales: Scales) -> Profiles:
        """Return the profiles of all steps, in SI."""
        pressure, film, first, second = np.moveaxis(np.stack(self.profiles), 1, 0)
        thickness = scales.film_thickness
        return Profiles(
            pressure=pressure * scales.hertz_pressure,
            film=film * thickness,
            height_1=first * thickness,
            height_2=second * thickness,
        )

    def fields(self, scales: Scales, shape: tuple[int, int]) -> Frames:
        """Return the stored fields, in SI.

        Parameters
        ----------
        scales : Scales
            Units of pressure and film.
        shape : (int, int)
            Nodes (ny, nx) of the full domain.
        """
        stack = np.stack(self.frames) if self.frames else np.zeros((0, 3, *shape), np.float32)
        thickness = scales.film_thickness
        units = (scales.hertz_pressure, thickness, thickness, stress_unit(scales))
        pressure, film, height, *stress = (
            np.asarray(field * np.float32(unit), np.float32)
            for field, unit in zip(np.moveaxis(stack, 1, 0), units, strict=False)
        )
        return Frames(
            step=np.array(self.frame_steps, np.int64),
            pressure=pressure,
            film=film,
            height=height,
            stress=stress[0] if stress else None,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class Snapshot:
    """State from which a run resumes bit by bit."""

    setting: int
    """Number of the relaxation in use."""
    rigid_approach: float
    """H00 [-]."""
    fields: dict[str, Array]
    """Pressure; mass of the last two films, and its excess in the flux; differences of the last
    four pressures to the steady one; and the state of the coupling."""
    record: Record
    """The steps so far."""
    cost: Cost
    """Cost so far, including the steady film."""

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
        "frames": np.stack(record.frames) if record.frames else np.zeros((0, 3, 0, 0), np.float32),
        **{f"{_FIELD}{name}": field for name, field in snapshot.fields.items()},
    }


def unpack(arrays: Arrays) -> Snapshot:
    """Return the snapshot of arrays that :func:`pack` returned.

    Raises InputError if an array is missing, inconsistent with the others, or not finite.
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
    yield from _misfits(arrays)
    for name, values in arrays.items():
        if values.dtype.kind not in "biuf" or not np.isfinite(values).all():
            yield f"{name.removeprefix(_FIELD)!r} has values that are not finite"
    steps, kept = len(arrays["rows"]), arrays["frame_steps"]
    if not steps or (np.diff(kept) <= 0).any() or ((kept < 0) | (kept >= steps)).any():
        yield f"'frame_steps' are not increasing steps below {steps}"
    if arrays["frames"].shape[1] not in (3, 4):
        yield f"'frames' have {arrays['frames'].shape[1]} fields in place of 3 or 4"
    if (arrays["cost"] < 0.0).any():
        yield "'cost' is negative"
    last = dict(zip(COLUMNS, arrays["rows"][-1], strict=True))
    oil, asperity = (
        arrays.get(f"{_FIELD}{name}", np.zeros(0)) for name in ("pressure", "asperity")
    )
    both = oil + asperity if oil.shape == asperity.shape else oil
    largest = [field.max(initial=0.0) for field in (oil, both)]
    if last["rigid_approach"] != arrays["rigid_approach"] or last["pressure_max"] not in largest:
        yield "its pressure is not that of its last step"


def _misfits(arrays: Arrays) -> Iterator[str]:
    """Yield arrays that are missing, or of another type or shape than in `_LAYOUT`."""
    lengths: dict[str, int] = {}
    for name, (kind, shape) in _LAYOUT.items():
        if name not in arrays:
            yield f"{name!r} is missing"
        found = arrays[name]
        if found.ndim != len(shape) or found.dtype != kind:
            yield f"{name!r} does not have {len(shape)} dimensions of {np.dtype(kind)}"
        for size, wanted in zip(found.shape, shape, strict=True):
            expected = lengths.setdefault(wanted, size) if isinstance(wanted, str) else wanted
            if size != expected:
                yield f"{name!r} has the shape {found.shape}; {size} must be {expected}"


def kept_steps(transient: Transient, steps: int, seconds: float) -> set[int]:
    """Return the steps whose fields are stored: evenly spaced, or nearest to stated times.

    Parameters
    ----------
    transient : Transient
        ``frames`` is their number, or their times [s].
    steps, seconds : int, float
        Number of steps of the run, and time step [s].
    """
    if isinstance(transient.frames, int):
        every = steps / max(transient.frames - 1, 1)
        return {round(n * every) for n in range(transient.frames)}
    return {min(round(time / seconds), steps) for time in transient.frames}
