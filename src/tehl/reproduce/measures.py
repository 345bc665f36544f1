"""What is measured in a result: film, pressure, temperatures, and how well they are known."""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tehl.reproduce.peaks import peaks
from tehl.result import Result
from tehl.typing import Array

OUTLET = 0.3
"""X beyond which a maximum of the pressure on the centre line is the spike, in half-widths."""
LEAST_PEAK = 0.01
"""Prominence of a pressure maximum that counts, in Hertz pressures."""
LEAST_RIDGE = 0.05
"""The same between ridges of a wavy surface."""
INSIDE = 0.7
"""Part of the line across the waves on which the film is looked at."""
LEAST_FINGER = 0.05
"""Prominence of a temperature maximum that counts, over the largest rise."""
PLATEAU = 0.7
"""X up to which the film of the middle of the contact is looked at, in half-widths."""
ACROSS = 0.95
"""Reach of the line across the waves, in half-widths."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Quality:
    """How well a result is known.

    Attributes
    ----------
    outcome : str
        How the solve ended, in words.
    converged, certified : bool
        Whether it passed the verdict with a minimum film that is known, and whether it has
        error bars.
    message : str or None
        Why it is no answer, or why its minimum film is not known.
    points : (int, int)
        Nodes of the grid.
    domain : (float, float, float, float)
        Edges in X and in Y [-].
    cycles : int
        Cycles on the finest grid.
    residual, change, load_error : float
        Of the last cycle [-].
    seconds : float
        Of the solve.
    made : str
        When.
    """

    outcome: str
    converged: bool
    certified: bool
    message: str | None
    points: tuple[int, int]
    domain: tuple[float, float, float, float]
    cycles: int
    residual: float
    change: float
    load_error: float
    seconds: float
    made: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Film:
    """Film numbers, H [-].

    Attributes
    ----------
    minimum, central : float
        On the finest grid.
    minimum_at : (float, float)
        X and Y of the minimum.
    best_minimum, best_central : float
        Extrapolated values of a certified run, else those of the grid.
    minimum_error, central_error : float
        Half widths of their error bars; NaN when nothing is known.
    outlet : float
        Smallest film on the centre line behind the centre.
    hump : float
        How far the film of the middle rises above the film upstream of it, over the central film.
    ripple : float
        Largest less smallest film on the line across the waves, over the central film.
    """

    minimum: float
    central: float
    minimum_at: tuple[float, float]
    best_minimum: float
    best_central: float
    minimum_error: float
    central_error: float
    outlet: float
    hump: float
    ripple: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Pressure:
    """Pressure numbers, P [-].

    Attributes
    ----------
    largest, central : float
        Largest, and at X = Y = 0.
    largest_at : (float, float)
        X and Y of the largest.
    spike, spike_at : float
        Height and X of the last maximum on the centre line; NaN where there is none.
    crest : float
        Highest spike of all rows that have one beside the hump of the contact; NaN where none has.
    on_grids : tuple of float
        Largest pressure on the grids of a certified run, coarse to fine.
    peaks : int
        Maxima on the centre line.
    ridges : int
        Maxima on the line across the waves.
    """

    largest: float
    largest_at: tuple[float, float]
    central: float
    spike: float
    spike_at: float
    crest: float
    on_grids: tuple[float, ...]
    peaks: int
    ridges: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Warmth:
    """Rises over the inlet [K].

    Attributes
    ----------
    film, mid_film, surface_1, surface_2 : float
        Largest rises.
    central : float
        At mid-film, X = Y = 0.
    fingers : int
        Maxima of the mid-film temperature across the waves.
    balance : float
        Heat that is missing, over that turned over [-].
    """

    film: float
    mid_film: float
    surface_1: float
    surface_2: float
    central: float
    fingers: int
    balance: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Measures:
    """All of it; ``warmth`` is None for an isothermal run.

    Attributes
    ----------
    quality : Quality
        How well it is known.
    film : Film
        Film.
    pressure : Pressure
        Pressure.
    warmth : Warmth or None
        Temperatures.
    versions : dict
        Of the packages at work.
    groups : dict
        M and L.
    """

    quality: Quality
    film: Film
    pressure: Pressure
    warmth: Warmth | None
    versions: dict[str, str]
    groups: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        """Return what JSON can hold."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> "Measures":
        """Return what `as_dict` has written."""
        warmth = data["warmth"]
        return cls(
            quality=Quality(**_tuples(data["quality"])),
            film=Film(**_tuples(data["film"])),
            pressure=Pressure(**_tuples(data["pressure"])),
            warmth=None if warmth is None else Warmth(**warmth),
            versions=data["versions"],
            groups=data["groups"],
        )


def _tuples(data: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(v) if isinstance(v, list) else v for key, v in data.items()}


def measure(result: Result) -> Measures:
    """Return what is measured in a result."""
    return Measures(
        quality=_quality(result),
        film=_film(result),
        pressure=_pressure(result),
        warmth=_warmth(result),
        versions=dict(result.provenance.versions),
        groups={"M": result.groups.M, "L": result.groups.L},
    )


def _quality(result: Result) -> Quality:
    scaled, status = result.scaled, result.status
    last = result.history[-1]
    edges = (scaled.x[0], scaled.x[-1], scaled.y[0], scaled.y[-1])
    return Quality(
        outcome=status.outcome,
        converged=status.converged and not status.is_vague,
        certified=bool(result.uncertainty),
        message=status.message,
        points=(scaled.x.size, scaled.y.size),
        domain=tuple(float(edge) for edge in edges),  # type: ignore[arg-type]
        cycles=last.cycle,
        residual=last.residual,
        change=last.change,
        load_error=last.load_error,
        seconds=result.cost.wall_seconds,
        made=result.provenance.created,
    )


def _film(result: Result) -> Film:
    film, bars, errors = result.film_scaled, result.uncertainty, result.errors
    line = centre_line(result, result.scaled.film)
    x = result.scaled.x
    minimum, central = film.minimum, film.central
    minimum_error = central_error = math.nan
    if errors is not None:
        minimum_error = errors.discretisation_minimum * abs(minimum)
        central_error = errors.discretisation_central * abs(central)
    if bars:
        low, middle = bars["film_minimum"], bars["film_central"]
        minimum, minimum_error = low.value, low.uncertainty
        central, central_error = middle.value, middle.uncertainty
    return Film(
        minimum=film.minimum,
        central=film.central,
        minimum_at=film.minimum_at,
        best_minimum=minimum,
        best_central=central,
        minimum_error=minimum_error,
        central_error=central_error,
        outlet=float(line[x > OUTLET].min()),
        hump=_hump(x, line, film.central),
        ripple=_ripple(result),
    )


def _ripple(result: Result) -> float:
    """Return how much the film varies across the waves, over the central film."""
    places, film = across_waves(result, result.scaled.film)
    inside = film[np.abs(places) < INSIDE]
    return float(np.ptp(inside)) / max(abs(result.film_scaled.central), 1e-9)


def centre_line(result: Result, field: Array) -> Array:
    """Return ``field`` along Y = 0."""
    return np.asarray(field[int(np.argmin(np.abs(result.scaled.y)))])


def _hump(x: Array, line: Array, central: float) -> float:
    """Return how far the film rises above what it was upstream in the contact, over ``central``."""
    inside = (x > -PLATEAU) & (x < PLATEAU)
    film = line[inside]
    rise = float((film - np.minimum.accumulate(film)).max())
    return rise / central if central > 0 else math.nan


def _pressure(result: Result) -> Pressure:
    p, x = result.scaled.pressure, result.scaled.x
    line = centre_line(result, p)
    row, column = np.unravel_index(int(p.argmax()), p.shape)
    last = [k for k in peaks(line, LEAST_PEAK / 10) if x[k] > OUTLET]
    return Pressure(
        largest=float(p[row, column]),
        largest_at=(float(x[column]), float(result.scaled.y[row])),
        central=result.scaled.at_origin(p),
        spike=float(line[last[-1]]) if last else math.nan,
        spike_at=float(x[last[-1]]) if last else math.nan,
        crest=_crest(x, p),
        on_grids=result.uncertainty["pressure_max"].values if result.uncertainty else (),
        peaks=len(peaks(line, LEAST_PEAK)),
        ridges=len(peaks(across_waves(result, p)[1], LEAST_RIDGE)),
    )


def _crest(x: Array, p: Array) -> float:
    """Return the highest second maximum of all rows, behind the hump."""
    heights = []
    for row in p:
        tops = peaks(row, LEAST_PEAK)
        if len(tops) > 1 and x[tops[-1]] > 0.0:
            heights.append(float(row[tops[-1]]))
    return max(heights, default=math.nan)


def across_waves(result: Result, field: Array) -> tuple[Array, Array]:
    """Return places and values of ``field`` on the line X = -Y through the centre."""
    scaled = result.scaled
    along = np.linspace(-ACROSS, ACROSS, 2 * scaled.x.size)
    x, y = along / math.sqrt(2.0), -along / math.sqrt(2.0)
    columns = np.interp(x, scaled.x, np.arange(scaled.x.size))
    rows = np.interp(y, scaled.y, np.arange(scaled.y.size))
    return along, bilinear(field, rows, columns)


def bilinear(field: Array, rows: Array, columns: Array) -> Array:
    """Return ``field`` between its nodes, at fractional rows and columns."""
    j = np.minimum(rows.astype(int), field.shape[0] - 2)
    i = np.minimum(columns.astype(int), field.shape[1] - 2)
    v, u = rows - j, columns - i
    low = (1 - u) * field[j, i] + u * field[j, i + 1]
    high = (1 - u) * field[j + 1, i] + u * field[j + 1, i + 1]
    return np.asarray((1 - v) * low + v * high)


def _warmth(result: Result) -> Warmth | None:
    found, heat = result.temperature, result.heat
    if found is None or heat is None:
        return None
    middle = found.mid_film - found.inlet
    _, line = across_waves(result, middle)
    largest = float(middle.max())
    return Warmth(
        film=found.film_rise_max,
        mid_film=largest,
        surface_1=found.surface_1_rise_max,
        surface_2=found.surface_2_rise_max,
        central=found.mid_film_rise_central,
        fingers=len(peaks(line, LEAST_FINGER * max(largest, 1e-9))),
        balance=heat.balance.error,
    )
