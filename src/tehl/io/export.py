"""Results in the formats of other programs: CSV, npz, VTK and MATLAB files."""

import csv
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tehl.errors import InputError
from tehl.io.atomic import replacing
from tehl.io.content import variables
from tehl.io.summary import summary
from tehl.io.vtk import rectilinear_grid, structured_grid
from tehl.result import Result
from tehl.typing import Array

What = Literal["lines", "fields"]

_SHEAR = (
    ("shear_stress_1", "pa"),
    ("shear_stress_mid", "pa"),
    ("shear_stress_2", "pa"),
    ("shear_stress_across", "pa"),
    ("shear_thinning", ""),
)
_HEIGHTS = (("height_1", "m"), ("height_2", "m"))
_HEAT = (
    ("temperature_1", "k"),
    ("temperature_mid", "k"),
    ("temperature_2", "k"),
    ("temperature_mean", "k"),
    ("heat_flux_1", "w_m2"),
    ("heat_flux_2", "w_m2"),
)
"""Maps that go with a film if it has them, and their units as endings of columns."""


def write(result: Result, path: str | Path, kind: str) -> None:
    """Write ``result`` as ``kind``, with the defaults of that format.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    kind : {"csv", "npz", "vtk", "mat"}
        The format.

    Raises
    ------
    InputError
        If ``kind`` is unknown or the file cannot be written.
    """
    if kind not in WRITERS:
        raise InputError(f"unknown export format {kind!r}; known: {', '.join(WRITERS)}")
    WRITERS[kind](result, path)


def kind_of(path: str | Path | None, stated: str | None) -> str:
    """Return the format of an export, from what is stated and from the ending of its file.

    Parameters
    ----------
    path : str, Path or None
        The file; None when it gets the ending of its format.
    stated : {"csv", "npz", "vtk", "mat"} or None
        The format; None where the ending of the file tells it.

    Raises
    ------
    InputError
        If neither tells a format, or if they do not fit: programs choose a reader by the ending.
    """
    endings = ", ".join(SUFFIXES.values())
    if path is None:
        if stated is None:
            raise InputError(f"state a format (--to) or a file (-o) with the ending {endings}")
        return stated
    suffix = Path(path).suffix
    ends = {end: kind for kind, end in SUFFIXES.items()} | {_VOLUME: "vtk"}
    deduced = ends.get(suffix.lower())
    if stated is None and deduced is not None:
        return deduced
    if stated is None and suffix.lower() in _OTHER_VTK:
        stated = "vtk"
    if stated is None:
        raise InputError(f"output {path}: its ending tells no format; state --to or use {endings}")
    if stated != deduced:
        volume = f" (the plane) or {_VOLUME} (the film as a volume)" if stated == "vtk" else ""
        raise InputError(
            f"output {path}: a file of format {stated} ends in {SUFFIXES[stated]}{volume}"
        )
    return stated


def write_csv(result: Result, path: str | Path, *, what: What = "lines") -> None:
    """Write a table with one row per node, as any spreadsheet reads it.

    ``"lines"`` gives the two grid lines nearest to the axes, told apart by a column more: first
    ``line = x`` (along entrainment, Y = 0), then ``line = y`` (across, X = 0). ``"fields"`` gives
    all nodes in long form, x running fastest. Columns carry their unit in their name; X, Y, P, H
    and shear_thinning are dimensionless. Heights of rough surfaces, shear stresses and temperatures
    follow if there are any: on surface 1, at mid-film, on surface 2. Numbers are written so that
    reading them gives back the same bits.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    what : {"lines", "fields"}
        Which nodes.
    """
    lines = what == "lines"
    columns = _columns(result)
    rows = _line_rows(result, columns) if lines else _rows(columns, (slice(None), slice(None)))
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("line", *columns) if lines else columns)
        writer.writerows(rows)


def _columns(result: Result) -> dict[str, Array]:
    """Return the maps of a table, (ny, nx) each, by the name of their column."""
    x, y = np.meshgrid(result.x, result.y)
    scaled_x, scaled_y = np.meshgrid(result.scaled.x, result.scaled.y)
    return {
        "x_m": x,
        "y_m": y,
        "pressure_pa": result.pressure,
        "film_thickness_m": result.film_thickness,
        "X": scaled_x,
        "Y": scaled_y,
        "P": result.scaled.pressure,
        "H": result.scaled.film,
        **{f"{name}_{unit}".rstrip("_"): field for name, unit, field in _more_maps(result)},
    }


def _more_maps(result: Result) -> Iterator[tuple[str, str, Array]]:
    """Yield name, unit and map of what the film has of roughness, shear and heat."""
    heights = result.heights
    if heights is not None:
        fields = (heights.surface_1, heights.surface_2)
        yield from ((*named, field) for named, field in zip(_HEIGHTS, fields, strict=True))
    shear, heat, temperature = result.shear, result.heat, result.temperature
    if shear is not None:
        stresses = (shear.surface_1, shear.mid_film, shear.surface_2, shear.across, shear.thinning)
        yield from ((*named, field) for named, field in zip(_SHEAR, stresses, strict=True))
    if heat is not None and temperature is not None:
        first, second = heat.temperature[0], heat.temperature[-1]
        layers = (first, temperature.mid_film, second, temperature.mean)
        maps = (*layers, heat.flux_1, heat.flux_2)
        yield from ((*named, field) for named, field in zip(_HEAT, maps, strict=True))


def _line_rows(result: Result, columns: dict[str, Array]) -> Iterator[tuple[Any, ...]]:
    row = int(np.argmin(np.abs(result.scaled.y)))
    column = int(np.argmin(np.abs(result.scaled.x)))
    for name, part in (
        ("x", (slice(row, row + 1), slice(None))),
        ("y", (slice(None), slice(column, column + 1))),
    ):
        yield from ((name, *numbers) for numbers in _rows(columns, part))


def _rows(columns: dict[str, Array], part: tuple[slice, slice]) -> Iterator[tuple[Any, ...]]:
    return zip(*(field[part].ravel().tolist() for field in columns.values()), strict=True)


def write_npz(result: Result, path: str | Path) -> None:
    """Write all arrays, and the summary as JSON text, for ``numpy.load``.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    """
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **_arrays(result))


def write_mat(result: Result, path: str | Path) -> None:
    """Write all arrays, and the summary as JSON text (``jsondecode``), for MATLAB and Octave.

    Names differ by case, as MATLAB allows: ``x`` is in metres, ``X`` in Hertz half-widths. Fields
    have rows along y.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    """
    from scipy.io import savemat  # noqa: PLC0415 (0.3 s, for this format only)

    with replacing(path) as temporary, temporary.open("wb") as file:
        savemat(file, _arrays(result), do_compression=True, oned_as="column")


def _arrays(result: Result) -> dict[str, NDArray[Any]]:
    arrays = {variable.name: variable.data for variable in variables(result)}
    return {**arrays, "summary": np.array(json.dumps(summary(result)))}


def write_vtk(result: Result, path: str | Path) -> None:
    """Write the fields as a VTK grid, which ParaView opens: of the film or of its plane.

    The ending ``.vtr`` gives a rectilinear grid, the plane z = 0 with x and y in metres and point
    arrays ``pressure`` [Pa], ``film_thickness`` [m], ``P`` and ``H`` [-], and heights [m], shear
    stresses [Pa], temperatures [K] and heat fluxes [W/m^2] if there are any: the maps of
    :func:`write_csv`.
    "Warp by scalar" raises a film to a surface.

    The ending ``.vts`` gives a structured grid that fills the film, with nodes at
    (x, y, zeta h) in metres and ``temperature`` [K] at each; without temperatures it has the two
    surfaces only. Raise the scale of z to see it.

    Parameters
    ----------
    result : Result
        What to write.
    path : str or Path
        The file; an older one is replaced.
    """
    maps = {
        "pressure": result.pressure,
        "film_thickness": result.film_thickness,
        "P": result.scaled.pressure,
        "H": result.scaled.film,
        **{name: field for name, _, field in _more_maps(result)},
    }
    numbers = {"converged": float(result.status.converged)}
    if Path(path).suffix.lower() == _VOLUME:
        text = _volume(result, maps, numbers)
    else:
        axes = (result.x, result.y, np.zeros(1))
        text = rectilinear_grid(axes, maps, field_data=numbers)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="ascii")


def _volume(result: Result, maps: dict[str, Array], numbers: dict[str, float]) -> str:
    """Return the film as a structured grid; maps are the same on each layer."""
    heat, film = result.heat, result.film_thickness
    zeta = np.array([0.0, 1.0]) if heat is None else heat.zeta
    shape = (zeta.size, *film.shape)
    points = np.empty((*shape, 3))
    points[..., 0] = result.x
    points[..., 1] = result.y[:, None]
    points[..., 2] = zeta[:, None, None] * film
    fields = {} if heat is None else {"temperature": heat.temperature}
    fields |= {name: np.broadcast_to(field, shape) for name, field in maps.items()}
    return structured_grid(points, fields, field_data=numbers)


WRITERS: dict[str, Callable[[Result, str | Path], None]] = {
    "csv": write_csv,
    "npz": write_npz,
    "vtk": write_vtk,
    "mat": write_mat,
}

SUFFIXES = {"csv": ".csv", "npz": ".npz", "vtk": ".vtr", "mat": ".mat"}
_VOLUME = ".vts"
_OTHER_VTK = (".vtk", ".vti", ".vtu")
