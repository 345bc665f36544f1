"""What a result file holds, the same in memory and on disk: arrays and attributes, both ways."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cache
from types import SimpleNamespace
from typing import Annotated, Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, PlainSerializer, create_model

from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.io import tables
from tehl.io.summary import summary
from tehl.io.tables import Column
from tehl.lubricant.registered import is_registered, package_of
from tehl.result.bars import ErrorEstimate
from tehl.result.fields import (
    BodyStress,
    Fields,
    FilmAsperities,
    FilmContact,
    FilmDynamics,
    FilmHeat,
    FilmOil,
    FilmShear,
    PassHistory,
    SurfaceHeights,
)
from tehl.result.registry import bar_names
from tehl.result.solution import Account, CycleReport, Extras, Solution
from tehl.result.transient import Frames, History, HistoryBars, Profiles, TransientSolution

FORMAT_VERSION = 5
STEADY, TRANSIENT = KINDS = ("steady", "transient")
"""Values of the attribute ``tehl_kind``."""

Arrays = dict[str, NDArray[Any]]
Attributes = dict[str, Any]
Table = tuple[Column, ...]
Part = TypeVar("Part")


@dataclass(frozen=True, slots=True)
class Variable:
    """One array of a result file, numbers or words; ``units`` is ``"1"`` if dimensionless."""

    name: str
    dims: tuple[str, ...]
    data: NDArray[Any]
    units: str
    long_name: str


_AXES = {"x": "X", "y": "Y", "zeta": "zeta", "time": "time"}
_AXES |= {"body": "stress_body", "depth": "stress_depth", "stress_x": "stress_x"}
_AXES |= {"stress_y": "stress_y"}
_AXES |= {"frame": "frame_step", "bar": "bar_time", "pass": "pass", "frequency": "frequency"}
"""Array that gives the size of each dimension."""
_PARTS: dict[str, tuple[type, Table]] = {
    "heights": (SurfaceHeights, tables.HEIGHTS),
    "asperities": (FilmAsperities, tables.ASPERITIES),
    "contact": (FilmContact, tables.CONTACT),
    "oil": (FilmOil, tables.OIL),
    "passes": (PassHistory, tables.PASSES),
    "dynamics": (FilmDynamics, tables.DYNAMICS),
    "shear": (FilmShear, tables.SHEAR),
    "stress": (BodyStress, tables.STRESS),
}
"""Parts of a solution that only some contacts have, all of arrays."""
_NOT_SCALAR = {
    Solution: ("problem", "options", "scaled", "history", "heat", *_PARTS),
    FilmHeat: tuple(column.field for column in tables.HEAT),
    TransientSolution: ("start", "history", "profiles", "frames", "bars"),
}
"""Fields of a class that are stored as arrays or attributes of their own; the others as JSON."""


def _flat_errors(errors: ErrorEstimate) -> dict[str, Any]:
    """Return error bars as files have them: each bar beside the other numbers, in its order."""
    found = {one.name: getattr(errors, one.name) for one in fields(ErrorEstimate)}
    names = dict.fromkeys((*bar_names(), *errors.bars))
    bars = {name: errors.bars.get(name) for name in names}
    return {
        key: number
        for name, value in found.items()
        for key, number in (bars if name == "bars" else {name: value}).items()
    }


def _bars_apart(errors: Any) -> Any:
    """Return the error bars of a file as `ErrorEstimate` takes them."""
    if not isinstance(errors, dict):
        return errors
    own = {one.name for one in fields(ErrorEstimate)} - {"bars"}
    bars = {name: bar for name, bar in errors.items() if name not in own and bar is not None}
    return {name: value for name, value in errors.items() if name in own} | {"bars": bars}


_StoredErrors = Annotated[
    ErrorEstimate, PlainSerializer(_flat_errors), BeforeValidator(_bars_apart)
]


def _fields(kind: type) -> Iterator[tuple[str, Any]]:
    """Yield the fields of a class with their types, those of `Account` and `Extras` one by one."""
    for one in fields(kind):
        if one.type in (Account, Extras):
            yield from _fields(one.type)
        elif one.name == "errors":
            yield one.name, _StoredErrors | None
        else:
            yield one.name, one.type


@cache
def _scalars(kind: type) -> type[BaseModel]:
    found: dict[str, Any] = {
        name: (annotation, ...)
        for name, annotation in _fields(kind)
        if name not in _NOT_SCALAR[kind]
    }
    # Infinities and NaN become strings, which pydantic reads back as floats.
    config = ConfigDict(ser_json_inf_nan="strings")
    model: type[BaseModel] = create_model(kind.__name__, __config__=config, **found)
    return model


def _dumped(kind: type, part: Any) -> str:
    model = _scalars(kind)
    return model(**{name: getattr(part, name) for name in model.model_fields}).model_dump_json()


def _loaded(kind: type, text: str) -> dict[str, Any]:
    return dict(_scalars(kind).model_validate_json(text))


def variables(result: Solution | TransientSolution) -> Iterator[Variable]:
    """Yield the arrays of a result; of a transient one those of its start too, by usual names."""
    if isinstance(result, TransientSolution):
        for one in variables(result.start):
            of_start = ", of the steady film at the start" if one.dims[-2:] == ("y", "x") else ""
            yield replace(one, long_name=one.long_name + of_start)
    for table, part in _parts(result):
        for column in table:
            data = np.asarray(getattr(part, column.field))
            yield Variable(column.name, column.dims, data, column.units, column.text)


def _parts(result: Solution | TransientSolution) -> Iterator[tuple[Table, Any]]:
    """Yield each part that ``result`` has, with the table of its arrays."""
    parts: tuple[tuple[Table, Any], ...]
    if isinstance(result, Solution):
        parts = (
            (tables.FIELDS, result),
            (tables.SCALED, result.scaled),
            *((table, getattr(result, name)) for name, (_, table) in _PARTS.items()),
            (tables.HEAT, result.heat),
            ((*tables.GRIDS, *tables.CYCLES), _columns(result.history)),
        )
    else:
        parts = (
            (tables.HISTORY, result.history),
            (tables.PROFILES, result.profiles),
            ((*tables.FRAME_TIMES, *tables.FRAMES), _frame_columns(result)),
            (tables.FRAME_STRESS, None if result.frames.stress is None else result.frames),
            (tables.BARS, result.bars),
        )
    return ((table, part) for table, part in parts if part is not None)


def _columns(history: tuple[CycleReport, ...]) -> SimpleNamespace | None:
    """Return the numbers of all cycles as one array each, None without cycles."""
    if not history:
        return None
    points_x, points_y = np.array([report.points for report in history]).T
    columns = {
        column.field: np.array([getattr(report, column.field) for report in history])
        for column in tables.CYCLES
    }
    index = np.arange(1, len(history) + 1)
    return SimpleNamespace(index=index, points_x=points_x, points_y=points_y, **columns)


def _frame_columns(result: TransientSolution) -> SimpleNamespace | None:
    """Return the fields that were kept with their times, None without any."""
    frames = result.frames
    if not frames.step.size:
        return None
    own = {one.name: getattr(frames, one.name) for one in fields(frames)}
    return SimpleNamespace(time=result.history.time[frames.step], **own)


def attributes(result: Solution | TransientSolution) -> Attributes:
    """Return the attributes of a result: kind, case, scalars, definitions, versions.

    A transient result has those of its start, with its own kind, status and summary.
    """
    own = {
        "tehl_kind": STEADY,
        "status": result.status.kind,
        "converged": int(result.status.converged),
        "summary": json.dumps(summary(result), allow_nan=False),
    }
    if isinstance(result, TransientSolution):
        own |= {"tehl_kind": TRANSIENT, "transient": _dumped(TransientSolution, result)}
        return attributes(result.start) | own
    parts = {} if result.heat is None else {"heat": _dumped(FilmHeat, result.heat)}
    if packages := _packages(result.problem):
        parts["laws"] = json.dumps(packages)
    return own | {
        "tehl_format": FORMAT_VERSION,
        "title": result.problem.title,
        "source": f"tehl {result.provenance.versions.get('tehl', 'of unknown version')}",
        "created": result.provenance.created,
        "versions": json.dumps(result.provenance.versions),
        "definitions": tables.DEFINITIONS,
        "problem": _json(result.problem),
        "options": _json(result.options),
        "state": _dumped(Solution, result),
        **parts,
    }


def _packages(problem: ContactProblem) -> dict[str, tuple[str, str]]:
    """Return the laws that are not of this package by their keys, each with its package."""
    oil = problem.lubricant
    laws: dict[str, Any] = {"viscosity": oil.viscosity, "density": oil.density, "shear": oil.shear}
    owners = {part: (law.law, package_of(law)) for part, law in laws.items()}
    return {part: (law, owner) for part, (law, owner) in owners.items() if owner is not None}


def missing_law(attrs: Attributes) -> str | None:
    """Return which law of a file is not installed, and whose it is; None if all are."""
    for part, (law, owner) in json.loads(attrs.get("laws", "{}")).items():
        if not is_registered(law):
            return f'lubricant.{part}.law = "{law}" of the package {owner}'
    return None


def _json(model: BaseModel) -> str:
    return json.dumps(model.model_dump(mode="json"), allow_nan=False)


def rebuild(arrays: Arrays, attrs: Attributes) -> Solution | TransientSolution:
    """Return the result of arrays as :func:`variables` and attributes as :func:`attributes` gives.

    Parameters
    ----------
    arrays : dict
        In SI, by name.
    attrs : dict
        Case, state and kind of the result as JSON.

    Raises
    ------
    KeyError, ValueError
        If something is missing or does not fit; the message names it.
    """
    steady = _steady(arrays, attrs)
    return _transient(steady, arrays, attrs) if attrs["tehl_kind"] == TRANSIENT else steady


def _steady(arrays: Arrays, attrs: Attributes) -> Solution:
    state = _loaded(Solution, attrs["state"])
    reader = Reader(arrays=arrays, finite=state["status"].converged)
    heat = _loaded(FilmHeat, attrs["heat"]) if "heat" in attrs else None
    return Solution(
        **state,
        problem=ContactProblem.model_validate_json(attrs["problem"]),
        options=Options.model_validate_json(attrs["options"]),
        scaled=_around_contact(Fields(**reader.columns(tables.SCALED)), positive=reader.finite),
        history=_cycles(arrays),
        heat=None if heat is None else FilmHeat(**heat | reader.columns(tables.HEAT)),
        **{name: reader.part(*one) for name, one in _PARTS.items()},
    )


def _around_contact(fields: Fields, *, positive: bool) -> Fields:
    """Return fields; ValueError if they do not surround the contact, or a film is not positive."""
    for name, axis in (("x", fields.x), ("y", fields.y)):
        if axis.size > 1 and not axis[0] < 0.0 < axis[-1]:
            raise ValueError(f"the coordinate {name} leaves out the middle of the contact")
    if positive and not (fields.film > 0.0).all():
        raise ValueError("film is not positive in a converged result")
    return fields


def _transient(start: Solution, arrays: Arrays, attrs: Attributes) -> TransientSolution:
    state = _loaded(TransientSolution, attrs["transient"])
    reader = Reader(arrays=arrays, finite=state["status"].converged)
    history: dict[str, Any] = dict(reader.columns(tables.HISTORY))
    whole = {name: history[name].astype(np.int64) for name in ("nodes", "cycles")}
    return TransientSolution(
        **state,
        start=start,
        history=History(**history | whole),
        profiles=Profiles(**reader.columns(tables.PROFILES)),
        frames=_frames(reader, start.scaled.pressure.shape, whole["cycles"].size),
        bars=replace(reader, finite=False).part(HistoryBars, tables.BARS),
    )


def _frames(reader: "Reader", shape: tuple[int, ...], count: int) -> Frames:
    """Return the fields that were kept; ``count`` is the number of steps in the history."""
    if "frame_step" not in reader.arrays:
        empty = np.zeros((0, *shape), np.float32)
        return Frames(step=np.zeros(0, np.int64), pressure=empty, film=empty, height=empty)
    steps = np.asarray(reader.arrays["frame_step"], np.int64)
    if not ((steps >= 0) & (steps < count)).all():
        raise ValueError("frame_step names steps that are not in the history")
    found = reader.columns(tables.FRAMES)
    if tables.FRAME_STRESS[0].name in reader.arrays:
        found |= reader.columns(tables.FRAME_STRESS)
    return Frames(step=steps, **{name: data.astype(np.float32) for name, data in found.items()})


def _cycles(arrays: Arrays) -> tuple[CycleReport, ...]:
    if "cycle" not in arrays:
        return ()
    table = (*tables.GRIDS[1:], *tables.CYCLES)
    points_x, points_y, *others = (arrays[column.name].tolist() for column in table)
    names = [column.field for column in tables.CYCLES]
    return tuple(
        CycleReport(points=(nx, ny), **dict(zip(names, row, strict=True)))
        for nx, ny, *row in zip(points_x, points_y, *others, strict=True)
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Reader:
    """Takes arrays from a file and checks that they fit; those of a converged result are finite."""

    arrays: Arrays
    finite: bool

    def part(self, kind: type[Part], table: Table) -> Part | None:
        """Return a part of the result, None if the file does not have its first array.

        Parameters
        ----------
        kind : type
            Dataclass of the part, with the fields of ``table``.
        table : Table
            Columns of the part; without its first one the part is absent.
        """
        return kind(**self.columns(table)) if table[0].name in self.arrays else None

    def columns(self, table: Table) -> dict[str, Array]:
        """Return the arrays of a table, by attribute of the part that has them."""
        return {column.field: self._array(column) for column in table}

    def _array(self, column: Column) -> Array:
        """Return an array; a coordinate increases, a field has the shape of its coordinates."""
        values = self.arrays[column.name]
        if values.dtype.kind not in "fiu":
            raise ValueError(f"{column.name} does not hold real numbers")
        values = np.asarray(values, np.float64)
        if column.name in _AXES.values():
            if not (values.ndim == 1 and (np.diff(values) > 0).all()):
                raise ValueError(f"the coordinate {column.name} does not increase")
            return values
        shape = tuple(self.arrays[_AXES[dim]].size for dim in column.dims)
        if values.shape != shape:
            raise ValueError(f"{column.name} has shape {values.shape}, not {shape}")
        if self.finite and not np.isfinite(values).all():
            raise ValueError(f"{column.name} has non-finite values in a converged result")
        return values
