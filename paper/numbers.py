"""Numbers read off a result: film, pressure, temperatures, and how well they are known.

Lengths X, Y are in Hertz half-widths, films H = h R / a^2, pressures P in Hertz pressures, rises in
kelvin over the inlet.
"""

import math
from typing import Any

import numpy as np
from scipy.ndimage import map_coordinates

from tehl import Result
from tehl.estimate.film_formulas import film_estimates

OUTLET = 0.3
"""X behind which a maximum of the pressure on the centre line is the spike."""
PEAK, RIDGE, FINGER = 0.01, 0.05, 0.05
"""Least prominence of a maximum: of pressure, between waves, of temperature over the largest."""
MIDDLE = 0.7
"""|X| up to which the film of the middle is examined."""
ACROSS = 0.95
"""Reach of the line across the waves."""

Array = np.ndarray[Any, np.dtype[np.float64]]
Numbers = dict[str, Any]


def numbers(result: Result) -> Numbers:
    """Return all numbers of a result; ``ok``: converged, with a known minimum film."""
    scaled, status, last = result.scaled, result.status, result.history[-1]
    x, y = scaled.x, scaled.y
    return {
        "ok": status.converged and not status.is_vague,
        "outcome": "certified" if result.uncertainty and status.converged else status.outcome,
        "message": status.message or "",
        "nodes": x.size,
        "grid": f"{x.size} × {y.size}",
        "domain": f"[{x[0]:g}, {x[-1]:g}] × [{y[0]:g}, {y[-1]:g}]",
        "cycles": last.cycle,
        "residual": last.residual,
        "change": last.change,
        "load_error": last.load_error,
        "seconds": result.cost.wall_seconds,
        **_film(result),
        **_pressure(result),
        **_temperature(result),
    }


def centre_line(result: Result, field: Array) -> Array:
    """Return ``field`` along Y = 0."""
    return np.asarray(field[int(np.argmin(np.abs(result.scaled.y)))])


def _film(result: Result) -> Numbers:
    """Return the film numbers; extrapolated ones and their error bars where the run has them."""
    film, bars, errors = result.film_scaled, result.uncertainty, result.errors
    x, line = result.scaled.x, centre_line(result, result.scaled.film)
    low, central = (film.minimum, math.nan), (film.central, math.nan)
    if errors is not None:
        low = (film.minimum, errors.discretisation_minimum * abs(film.minimum))
        central = (film.central, errors.discretisation_central * abs(film.central))
    if bars:
        low, central = (
            (bars[name].value, bars[name].uncertainty) for name in ("film_minimum", "film_central")
        )
    outlet = float(line[x > OUTLET].min())
    inside = line[np.abs(x) < MIDDLE]
    hump = float((inside - np.minimum.accumulate(inside)).max())
    places, across = _across_waves(result, result.scaled.film)
    formula = next(
        one
        for one in film_estimates(result.groups, result.scales)
        if one.formula == "Hamrock-Dowson"
    )
    return {
        "H_min": low[0],
        "H_min_error": low[1],
        "H_c": central[0],
        "H_c_error": central[1],
        "H_min_on_grid": film.minimum,
        "H_c_on_grid": film.central,
        "X_of_H_min": film.minimum_at[0],
        "Y_of_H_min": film.minimum_at[1],
        "H_outlet": outlet,
        "constriction": outlet / film.central,
        "hump": hump / film.central if film.central > 0 else math.nan,
        "ripple": float(np.ptp(across[np.abs(places) < MIDDLE])) / max(abs(film.central), 1e-9),
        "formula_H_min": formula.minimum,
        "formula_H_c": formula.central,
    }


def _pressure(result: Result) -> Numbers:
    """Return the pressure numbers.

    ``spike`` is the highest second maximum of all rows, ``spike_Y0`` the last maximum on the centre
    line behind the hump, ``P_on_grids`` the largest pressure on the grids of a certified run.
    """
    p, x = result.scaled.pressure, result.scaled.x
    line = centre_line(result, p)
    row, column = np.unravel_index(int(p.argmax()), p.shape)
    last = [k for k in peaks(line, PEAK / 10) if x[k] > OUTLET]
    return {
        "P_max": float(p[row, column]),
        "X_of_P_max": float(x[column]),
        "P_c": result.scaled.at_origin(p),
        "spike_Y0": float(line[last[-1]]) if last else math.nan,
        "X_of_spike_Y0": float(x[last[-1]]) if last else math.nan,
        "spike": _spike(x, p),
        "P_on_grids": result.uncertainty["pressure_max"].values if result.uncertainty else (),
        "peaks": len(peaks(line, PEAK)),
        "ridges": len(peaks(_across_waves(result, p)[1], RIDGE)),
    }


def _spike(x: Array, p: Array) -> float:
    """Return the highest maximum behind X = 0 of all rows that have more than one."""
    tops = ((row, peaks(row, PEAK)) for row in p)
    return max(
        (float(row[at[-1]]) for row, at in tops if len(at) > 1 and x[at[-1]] > 0.0),
        default=math.nan,
    )


def peaks(line: Array, prominence: float) -> Array:
    """Return the places of maxima that rise by ``prominence`` over both their saddles."""
    from scipy.signal import find_peaks  # noqa: PLC0415 (1 s, with scipy.stats)

    found: Array = find_peaks(line, prominence=prominence)[0]
    return found


def _across_waves(result: Result, field: Array) -> tuple[Array, Array]:
    """Return places and values of ``field`` on the line X = -Y through the centre."""
    x, y = result.scaled.x, result.scaled.y
    places = np.linspace(-ACROSS, ACROSS, 2 * x.size)
    along = places / math.sqrt(2.0)
    rows = (-along - y[0]) / (y[1] - y[0])
    columns = (along - x[0]) / (x[1] - x[0])
    return places, map_coordinates(field, (rows, columns), order=1)


def _temperature(result: Result) -> Numbers:
    """Return the largest rises, that of the centre, and the maxima across the waves."""
    found = result.temperature
    names = ("rise_mid", "rise_1", "rise_2", "rise_c", "fingers")
    if found is None:
        return dict(zip(names, (math.nan,) * 4 + (0,), strict=True))
    middle = found.mid_film - found.inlet
    largest = float(middle.max())
    fingers = peaks(_across_waves(result, middle)[1], FINGER * max(largest, 1e-9))
    surfaces = (found.surface_1_rise_max, found.surface_2_rise_max)
    rises = (largest, *surfaces, found.mid_film_rise_central)
    return dict(zip(names, (*rises, len(fingers)), strict=True))
