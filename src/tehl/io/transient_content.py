"""What a file of a transient run holds: steady beginning, history, profiles and fields."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from tehl.io import content
from tehl.io.content import Reader, Variable, json_text
from tehl.io.transient_summary import transient_summary
from tehl.result import Cost, Estimate, Provenance, Status
from tehl.transient_result import Frames, History, HistoryBars, Profiles, TransientResult

KIND = "transient"
"""Kind of a file that holds a transient film."""
COORDINATES = ("x", "y", "X", "Y", "zeta", "cycle", "time", "frame_time", "bar_time")

_HISTORY = (
    ("time", "time", "s", "time; the mean of both surfaces has moved on by u_m time"),
    ("load", "load_factor", "1", "load over that of the contact"),
    ("film_central", "h_central", "m", "film at x = y = 0"),
    ("film_minimum", "h_min", "m", "smallest film between the nodes"),
    ("pressure_max", "p_max", "Pa", "largest pressure"),
    ("traction", "traction", "1", "mid-film traction coefficient, over the load at that time"),
    ("rigid_approach", "H00", "1", "rigid approach"),
    ("temperature_rise", "temperature_rise", "K", "largest rise of the film over the oil entering"),
    ("temperature_rise", "film_rise_max", "K", "largest rise over the oil at the inlet"),
    ("cycles", "step_cycles", "1", "multigrid cycles of the step"),
    ("change", "step_change", "1", "largest change of P in the last cycle of the step"),
)
_PROFILES = (
    ("pressure", "pressure_centre_line", "Pa", "pressure along y = 0"),
    ("film", "film_centre_line", "m", "film thickness along y = 0"),
    ("height_1", "height_1_centre_line", "m", "height of surface 1 along y = 0, outwards"),
    ("height_2", "height_2_centre_line", "m", "height of surface 2 along y = 0, outwards"),
)
_FRAMES = (
    ("pressure", "pressure_frames", "Pa", "pressure at chosen instants"),
    ("film", "film_frames", "m", "film thickness at chosen instants"),
    ("height", "height_frames", "m", "heights of both surfaces at chosen instants, outwards"),
)
_BARS = (
    ("time", "bar_time", "s", "times of the error bars"),
    ("film_central", "h_central_bar", "m", "half width of the error bar of h_central"),
    ("film_minimum", "h_min_bar", "m", "half width of the error bar of h_min"),
    ("pressure_max", "p_max_bar", "Pa", "half width of the error bar of p_max"),
)
"""Fields of `TransientResult`, names in the file, units and what they are."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RunState:
    """The scalars of a transient run besides those of its beginning."""

    time_step: float
    status: Status
    cost: Cost
    provenance: Provenance
    uncertainty: dict[str, Estimate] = field(default_factory=dict)


_SCALARS = tuple(one.name for one in fields(RunState))


def variables(run: TransientResult) -> Iterator[Variable]:
    """Yield the arrays of ``run``; those of the steady beginning have their usual names."""
    for one in content.variables(run.start):
        text = one.long_name
        if one.dims[-2:] == ("y", "x"):
            text += ", of the steady film at the beginning"
        yield Variable(name=one.name, dims=one.dims, data=one.data, units=one.units, long_name=text)
    for column, name, units, text in _HISTORY:
        data = getattr(run.history, column)
        yield Variable(name=name, dims=("time",), data=data, units=units, long_name=text)
    for column, name, units, text in _PROFILES:
        data = getattr(run.profiles, column)
        yield Variable(name=name, dims=("time", "x"), data=data, units=units, long_name=text)
    yield from _frame_variables(run)
    yield from _bar_variables(run)


def _frame_variables(run: TransientResult) -> Iterator[Variable]:
    """Yield the fields at chosen instants, nothing where none were kept."""
    steps = run.frames.step
    if not steps.size:
        return
    times = run.history.time[steps]
    for name, data, units, text in (
        ("frame_step", steps, "1", "step of the frame"),
        ("frame_time", times, "s", "time of the frame"),
    ):
        yield Variable(name=name, dims=("frame",), data=data, units=units, long_name=text)
    for column, name, units, text in _FRAMES:
        data = getattr(run.frames, column)
        yield Variable(name=name, dims=("frame", "y", "x"), data=data, units=units, long_name=text)


def _bar_variables(run: TransientResult) -> Iterator[Variable]:
    """Yield the error bars along the history, nothing where the run has none."""
    if run.bars is None:
        return
    for column, name, units, text in _BARS:
        data = getattr(run.bars, column)
        yield Variable(name=name, dims=("bar",), data=data, units=units, long_name=text)


def attributes(run: TransientResult) -> dict[str, str | int]:
    """Return the attributes of ``run``: those of its beginning, but its own end and summary."""
    state = RunState(**{name: getattr(run, name) for name in _SCALARS})
    return content.attributes(run.start) | {
        "tehl_kind": KIND,
        "status": run.status.kind,
        "converged": int(run.status.converged),
        "summary": json_text(transient_summary(run)),
        "transient": json_text(TypeAdapter(RunState).dump_python(state)),
    }


def rebuild(arrays: dict[str, NDArray[Any]], attrs: dict[str, Any]) -> TransientResult:
    """Return the run that ``arrays`` and ``attrs`` describe.

    Parameters
    ----------
    arrays : dict of str to array
        By name, as :func:`variables` gives them.
    attrs : dict
        As :func:`attributes` gives them.

    Raises
    ------
    KeyError, ValueError
        If something is missing or does not fit; the message names it.
    """
    state = TypeAdapter(RunState).validate_python(json.loads(attrs["transient"]))
    start = content.rebuild(arrays, attrs)
    reader = Reader(arrays=arrays, finite=state.status.converged)
    ny, nx = start.scaled.pressure.shape
    count = reader.axis("time").size
    return TransientResult(
        start=start,
        history=_history(reader, count),
        profiles=Profiles(**{f: reader.field(name, (count, nx)) for f, name, *_ in _PROFILES}),
        frames=_frames(reader, (ny, nx), count),
        bars=_bars(reader),
        **{name: getattr(state, name) for name in _SCALARS},
    )


def _history(reader: Reader, count: int) -> History:
    columns = {field: reader.field(name, (count,)) for field, name, *_ in _HISTORY}
    cycles = columns.pop("cycles").astype(np.int64)
    return History(**columns, cycles=cycles)


def _frames(reader: Reader, shape: tuple[int, int], count: int) -> Frames:
    if "frame_step" not in reader.arrays:
        empty = np.zeros((0, *shape), np.float32)
        return Frames(step=np.zeros(0, np.int64), pressure=empty, film=empty, height=empty)
    steps = np.asarray(reader.arrays["frame_step"], np.int64)
    if not ((steps >= 0) & (steps < count)).all():
        raise ValueError("frame_step names steps that the history does not have")
    found = {
        field: reader.field(name, (steps.size, *shape)).astype(np.float32)
        for field, name, *_ in _FRAMES
    }
    return Frames(step=steps, **found)


def _bars(reader: Reader) -> HistoryBars | None:
    if _BARS[0][1] not in reader.arrays:
        return None
    shape = (reader.axis("bar_time").size,)
    return HistoryBars(**{column: reader.field(name, shape) for column, name, *_ in _BARS})
