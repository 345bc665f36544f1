"""What a result file holds, the same in memory and on disk: variables and attributes."""

import json
import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from tehl.io.summary import summary
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.result import (
    Cost,
    CycleReport,
    ErrorEstimate,
    Estimate,
    Fields,
    FilmSummary,
    Provenance,
    Result,
    Status,
)
from tehl.scaling import Groups, Scales

FORMAT_VERSION = 1

DEFINITIONS = """\
reduced modulus E': 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (twice the contact modulus E*)
entrainment speed: u_m = (u1 + u2)/2; slide-to-roll ratio: SRR = (u1 - u2)/u_m
surfaces: 1 is z = 0, 2 is z = h; x along entrainment, the inlet is at negative x
Hertz: p_h = 3 w/(2 pi a_x a_y); for a circle a^3 = 3 w R/(2 E')
dimensionless: X = x/a_x, Y = y/a_y, P = p/p_h, H = h R_x/a_x^2
Moes: M = W (2U)^(-3/4), L = G (2U)^(1/4); U = eta_0 u_m/(E' R_x), W = w/(E' R_x^2), G = alpha E'
pressure is gauge, positive in compression; cavitation by complementarity (p >= 0)
h_central is the film at x = y = 0; h_min is the sub-grid minimum"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Variable:
    """One array of a result file.

    Attributes
    ----------
    name : str
        Its name in the file.
    dims : tuple of str
        Names of its dimensions: ``"y"``, ``"x"``, ``"cycle"``.
    data : array
        The numbers (or words).
    units, long_name : str
        Unit, ``"1"`` when dimensionless, and what it is.
    """

    name: str
    dims: tuple[str, ...]
    data: NDArray[Any]
    units: str
    long_name: str


@dataclass(frozen=True, kw_only=True, slots=True)
class State:
    """All scalars of a result besides its problem and options."""

    scales: Scales
    groups: Groups
    rigid_approach: float
    film_scaled: FilmSummary
    status: Status
    errors: ErrorEstimate | None
    cost: Cost
    provenance: Provenance
    uncertainty: dict[str, Estimate]


_CYCLE = (
    ("points_x", "1", "nodes of the grid in x", np.int64),
    ("points_y", "1", "nodes of the grid in y", np.int64),
    ("number", "1", "number of the cycle on its grid", np.int64),
    ("residual", "1", "mean residual scaled by the local diagonal", np.float64),
    ("change", "1", "largest change of P in the cycle", np.float64),
    ("load_error", "1", "relative error of the load balance", np.float64),
    ("film_central", "1", "H at X = Y = 0 after the cycle", np.float64),
    ("film_minimum", "1", "smallest nodal H after the cycle", np.float64),
    ("smoother", "1", "setting of the relaxation", np.str_),
)


def variables(result: Result) -> tuple[Variable, ...]:
    """Return the arrays of ``result``: coordinates, fields, then the history."""
    scaled = result.scaled
    rows: tuple[tuple[str, tuple[str, ...], NDArray[Any], str, str], ...] = (
        ("x", ("x",), result.x, "m", "coordinate along entrainment"),
        ("y", ("y",), result.y, "m", "coordinate across entrainment"),
        ("X", ("x",), scaled.x, "1", "x / a_x"),
        ("Y", ("y",), scaled.y, "1", "y / a_y"),
        ("pressure", ("y", "x"), result.pressure, "Pa", "film pressure"),
        ("film_thickness", ("y", "x"), result.film_thickness, "m", "film thickness"),
        ("P", ("y", "x"), scaled.pressure, "1", "p / p_h"),
        ("H", ("y", "x"), scaled.film, "1", "h R_x / a_x^2"),
    )
    named = (Variable(name=n, dims=d, data=a, units=u, long_name=t) for n, d, a, u, t in rows)
    return (*named, *_history_variables(result.history))


def attributes(result: Result) -> dict[str, str | int]:
    """Return the attributes of ``result``: what was asked, the scalars, definitions, versions."""
    state = State(**{f.name: getattr(result, f.name) for f in fields(State)})
    return {
        "tehl_format": FORMAT_VERSION,
        "title": result.problem.title,
        "status": result.status.kind,
        "converged": int(result.status.converged),
        "source": f"tehl {result.provenance.versions.get('tehl', 'of unknown version')}",
        "created": result.provenance.created,
        "versions": _text(result.provenance.versions),
        "definitions": DEFINITIONS,
        "problem": _text(result.problem.model_dump(mode="json")),
        "options": _text(result.options.model_dump(mode="json")),
        "summary": _text(summary(result)),
        "state": _text(TypeAdapter(State).dump_python(state)),
    }


def rebuild(arrays: dict[str, NDArray[Any]], attrs: dict[str, Any]) -> Result:
    """Return the result that ``arrays`` and ``attrs`` describe.

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
    state = TypeAdapter(State).validate_python(json.loads(attrs["state"]))
    return Result(
        problem=ContactProblem.model_validate(json.loads(attrs["problem"])),
        options=Options.model_validate(json.loads(attrs["options"])),
        scaled=_fields(arrays, state.status),
        history=_history(arrays),
        **{f.name: getattr(state, f.name) for f in fields(State)},
    )


def _fields(arrays: dict[str, NDArray[Any]], status: Status) -> Fields:
    x, y, pressure, film = (np.asarray(arrays[name], np.float64) for name in ("X", "Y", "P", "H"))
    for name, field in (("P", pressure), ("H", film)):
        if field.shape != (y.size, x.size):
            raise ValueError(f"{name} has shape {field.shape}, not {(y.size, x.size)}")
        if status.converged and not np.isfinite(field).all():
            raise ValueError(f"{name} holds values that are not finite, though it says converged")
    if not ((np.diff(x) > 0).all() and (np.diff(y) > 0).all()):
        raise ValueError("the coordinates X, Y do not increase")
    return Fields(x=x, y=y, pressure=pressure, film=film)


def _history_variables(history: tuple[CycleReport, ...]) -> tuple[Variable, ...]:
    if not history:
        return ()
    names = (
        "cycle",
        "residual",
        "change",
        "load_error",
        "film_central",
        "film_minimum",
        "smoother",
    )
    rows = [(*r.points, *(getattr(r, name) for name in names)) for r in history]
    index = Variable(
        name="cycle",
        dims=("cycle",),
        data=np.arange(1, len(rows) + 1),
        units="1",
        long_name="cycles in the order they were made, coarse grids first",
    )
    columns = zip(_CYCLE, zip(*rows, strict=True), strict=True)
    return (
        index,
        *(
            Variable(
                name=f"history_{name}",
                dims=("cycle",),
                data=np.array(column, dtype=kind),
                units=units,
                long_name=text,
            )
            for (name, units, text, kind), column in columns
        ),
    )


def _history(arrays: dict[str, NDArray[Any]]) -> tuple[CycleReport, ...]:
    if "cycle" not in arrays:
        return ()
    columns = [arrays[f"history_{name}"].tolist() for name, *_ in _CYCLE]
    return tuple(
        CycleReport(
            points=(row[0], row[1]),
            cycle=row[2],
            residual=row[3],
            change=row[4],
            load_error=row[5],
            film_central=row[6],
            film_minimum=row[7],
            smoother=str(row[8]),
        )
        for row in zip(*columns, strict=True)
    )


def _text(value: Any) -> str:
    """Return strict JSON; infinities and NaN become words that pydantic reads back as floats."""
    return json.dumps(_spelled(value), allow_nan=False)


def _spelled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _spelled(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_spelled(item) for item in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else str(float(value))
    return value
