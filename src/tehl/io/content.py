"""What a result file holds, the same in memory and on disk: variables and attributes."""

import json
import math
from collections.abc import Iterator
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
    FilmHeat,
    FilmShear,
    FilmSummary,
    HeatBalance,
    Provenance,
    Result,
    Status,
    SurfaceHeights,
)
from tehl.scaling import Groups, Scales
from tehl.typing import Array

FORMAT_VERSION = 2
READABLE = (1, 2)
"""Formats that are read: 1 knows neither shear stresses nor temperatures."""

DEFINITIONS = """\
reduced modulus E': 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (twice the contact modulus E*)
entrainment speed: u_m = (u1 + u2)/2; slide-to-roll ratio: SRR = (u1 - u2)/u_m
surfaces: 1 is z = 0, 2 is z = h; x along entrainment, the inlet is at negative x
Hertz: p_h = 3 w/(2 pi a_x a_y); for a circle a^3 = 3 w R/(2 E')
dimensionless: X = x/a_x, Y = y/a_y, P = p/p_h, H = h R_x/a_x^2
Moes: M = W (2U)^(-3/4), L = G (2U)^(1/4); U = eta_0 u_m/(E' R_x), W = w/(E' R_x^2), G = alpha E'
pressure is gauge, positive in compression; cavitation by complementarity (p >= 0)
h_central is the film at x = y = 0; h_min is the sub-grid minimum
shear stress: tau = eta du/dz, negative for SRR > 0; traction is its integral over p > 0 by the load
temperature in kelvin over (zeta, y, x), zeta = z/h; rises are over the oil at the inlet
heat flux and powers into the solids are positive where the film heats them"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Variable:
    """One array of a result file.

    Attributes
    ----------
    name : str
        Its name in the file.
    dims : tuple of str
        Names of its dimensions: ``"zeta"``, ``"y"``, ``"x"``, ``"cycle"``.
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
class HeatState:
    """The scalars of :class:`tehl.result.FilmHeat`."""

    balance: HeatBalance
    solid_peclet: tuple[float, float]
    sources: tuple[str, str]


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
    heat: HeatState | None = None


_SCALARS = tuple(f.name for f in fields(State) if f.name != "heat")
"""Fields of the state that are those of the result."""

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
    ("temperature_change", "K", "largest change of the film temperature in the cycle", np.float64),
)

_SHEAR = (
    ("surface_1", "shear_stress_1", "Pa", "tau_zx at z = 0, on surface 1"),
    ("mid_film", "shear_stress_mid", "Pa", "tau_zx at z = h/2"),
    ("surface_2", "shear_stress_2", "Pa", "tau_zx at z = h, on surface 2"),
    ("across", "shear_stress_across", "Pa", "tau_zy at z = h/2"),
    ("thinning", "shear_thinning", "1", "effective over Newtonian viscosity at z = h/2"),
)
_HEIGHTS = (
    ("surface_1", "height_1", "height of surface 1, positive outwards"),
    ("surface_2", "height_2", "height of surface 2, positive outwards"),
)
_HEAT = (
    ("zeta", "zeta", ("zeta",), "1", "z / h, 0 on surface 1"),
    ("weights", "zeta_weights", ("zeta",), "1", "weights of the mean across the film"),
    ("temperature", "temperature", ("zeta", "y", "x"), "K", "temperature of the film"),
    ("flux_1", "heat_flux_1", ("y", "x"), "W/m^2", "heat conducted into surface 1"),
    ("flux_2", "heat_flux_2", ("y", "x"), "W/m^2", "heat conducted into surface 2"),
)
"""Fields of the result, names in the file, dimensions, units and what they are."""


def variables(result: Result) -> tuple[Variable, ...]:
    """Return the arrays of ``result``: coordinates, fields, shear and heat if any, the history."""
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
    return (
        *named,
        *_shear_variables(result.shear),
        *_heat_variables(result.heat),
        *_height_variables(result.heights),
        *_history_variables(result.history),
    )


def _shear_variables(shear: FilmShear | None) -> Iterator[Variable]:
    if shear is None:
        return
    for field, name, units, text in _SHEAR:
        data = getattr(shear, field)
        yield Variable(name=name, dims=("y", "x"), data=data, units=units, long_name=text)


def _heat_variables(heat: FilmHeat | None) -> Iterator[Variable]:
    if heat is None:
        return
    for field, name, dims, units, text in _HEAT:
        data = getattr(heat, field)
        yield Variable(name=name, dims=dims, data=data, units=units, long_name=text)


def _height_variables(heights: SurfaceHeights | None) -> Iterator[Variable]:
    if heights is None:
        return
    for field, name, text in _HEIGHTS:
        data = getattr(heights, field)
        yield Variable(name=name, dims=("y", "x"), data=data, units="m", long_name=text)


def attributes(result: Result) -> dict[str, str | int]:
    """Return the attributes of ``result``: what was asked, the scalars, definitions, versions."""
    state = State(
        **{name: getattr(result, name) for name in _SCALARS}, heat=_heat_state(result.heat)
    )
    return {
        "tehl_format": FORMAT_VERSION,
        "title": result.problem.title,
        "status": result.status.kind,
        "converged": int(result.status.converged),
        "source": f"tehl {result.provenance.versions.get('tehl', 'of unknown version')}",
        "created": result.provenance.created,
        "versions": json_text(result.provenance.versions),
        "definitions": DEFINITIONS,
        "problem": json_text(result.problem.model_dump(mode="json")),
        "options": json_text(result.options.model_dump(mode="json")),
        "summary": json_text(summary(result)),
        "state": json_text(TypeAdapter(State).dump_python(state)),
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
    reader = Reader(arrays=arrays, finite=state.status.converged)
    scaled = _fields(reader)
    return Result(
        problem=ContactProblem.model_validate(json.loads(attrs["problem"])),
        options=Options.model_validate(json.loads(attrs["options"])),
        scaled=scaled,
        history=_history(arrays),
        shear=_shear(reader, scaled.pressure.shape),
        heat=_heat(reader, scaled.pressure.shape, state.heat),
        heights=_heights(reader, scaled.pressure.shape),
        **{name: getattr(state, name) for name in _SCALARS},
    )


def _heat_state(heat: FilmHeat | None) -> HeatState | None:
    if heat is None:
        return None
    return HeatState(balance=heat.balance, solid_peclet=heat.solid_peclet, sources=heat.sources)


def _fields(reader: "Reader") -> Fields:
    x, y = reader.axis("X"), reader.axis("Y")
    shape = (y.size, x.size)
    return Fields(x=x, y=y, pressure=reader.field("P", shape), film=reader.field("H", shape))


def _shear(reader: "Reader", shape: tuple[int, ...]) -> FilmShear | None:
    if _SHEAR[0][1] not in reader.arrays:
        return None
    return FilmShear(**{field: reader.field(name, shape) for field, name, *_ in _SHEAR})


def _heat(reader: "Reader", shape: tuple[int, ...], state: HeatState | None) -> FilmHeat | None:
    if state is None:
        return None
    zeta = reader.axis("zeta")
    sizes = {"zeta": zeta.size, "y": shape[0], "x": shape[1]}
    found = {
        field: reader.field(name, tuple(sizes[dim] for dim in dims))
        for field, name, dims, *_ in _HEAT
    }
    return FilmHeat(
        **found, balance=state.balance, solid_peclet=state.solid_peclet, sources=state.sources
    )


def _heights(reader: "Reader", shape: tuple[int, ...]) -> SurfaceHeights | None:
    if _HEIGHTS[0][1] not in reader.arrays:
        return None
    return SurfaceHeights(**{field: reader.field(name, shape) for field, name, _ in _HEIGHTS})


@dataclass(frozen=True, kw_only=True, slots=True)
class Reader:
    """Takes arrays out of a file and looks whether they can be what they claim to be.

    Attributes
    ----------
    arrays : dict of str to array
        All of the file, by name.
    finite : bool
        Whether numbers have to be finite: those of a converged result.
    """

    arrays: dict[str, NDArray[Any]]
    finite: bool

    def axis(self, name: str) -> Array:
        """Return a coordinate; it must increase."""
        values = np.asarray(self.arrays[name], np.float64)
        if not (values.ndim == 1 and (np.diff(values) > 0).all()):
            raise ValueError(f"the coordinate {name} does not increase")
        return values

    def field(self, name: str, shape: tuple[int, ...]) -> Array:
        """Return a field; it must fit to the coordinates, and be finite in a converged result."""
        values = np.asarray(self.arrays[name], np.float64)
        if values.shape != shape:
            raise ValueError(f"{name} has shape {values.shape}, not {shape}")
        if self.finite and not np.isfinite(values).all():
            raise ValueError(f"{name} holds values that are not finite, though it says converged")
        return values


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
        "temperature_change",
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
    known = {"history_temperature_change": np.zeros(arrays["cycle"].size)} | arrays  # format 1
    columns = [known[f"history_{name}"].tolist() for name, *_ in _CYCLE]
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
            temperature_change=row[9],
        )
        for row in zip(*columns, strict=True)
    )


def json_text(value: Any) -> str:
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
