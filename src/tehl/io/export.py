"""Stored results in the formats of other programs: CSV, npz, MATLAB and VTK files."""

import csv
import json
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tehl.base.atomic import check_writable, replacing
from tehl.base.errors import InputError
from tehl.io.content import Variable, variables
from tehl.io.summary import summary
from tehl.io.tables import COORDINATES
from tehl.io.vtk import collection, rectilinear_grid, structured_grid
from tehl.post.heat import temperature
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

_ENDINGS = {".csv": "csv", ".npz": "npz", ".mat": "mat"}
_FORMATS = {
    Solution: _ENDINGS | {".vtr": "vtk", ".vts": "vtk"},
    TransientSolution: _ENDINGS | {".pvd": "vtk"},
}
"""Format by the ending of a file; programs choose a reader by the ending."""
_MEANINGS = {".vtr": " (plane)", ".vts": " (volume)", ".pvd": " (collection of frames)"}
_ROWS = {
    Solution: {
        "lines": ("y", "x"),
        "fields": ("y", "x"),
        "history": ("cycle",),
        "depths": ("body", "depth"),
        "section": ("body", "depth", "stress_x"),
        "dynamics": ("frequency",),
    },
    TransientSolution: {
        "history": ("time",),
        "lines": ("time", "x"),
        "fields": ("frame", "y", "x"),
    },
}
"""Dimensions over which a CSV table has its rows; the first of each kind is the default."""
_SUFFIXES = {
    **{"m": "_m", "s": "_s", "Pa": "_pa", "K": "_k", "W/m^2": "_w_m2", "1": "", "Hz": "_hz"},
    **{"N m": "_n_m", "N/m": "_n_per_m", "N s/m": "_n_s_per_m", "N s^2/m": "_n_s2_per_m"},
}
"""Endings of column names by unit."""


def export(
    result: Solution | TransientSolution, path: str | Path, to: str | None = None, what: str = ""
) -> list[Path]:
    """Write a result in the format of another program.

    CSV is a table as any spreadsheet reads it; numbers read back bit by bit. Columns are named as
    the variables of the NetCDF file, with their unit as ending. ``"lines"`` of a steady result are
    the grid lines nearest to the axes: first those with ``line = x`` (along entrainment, Y = 0),
    then ``line = y`` (across, X = 0); ``"fields"`` are all nodes, x running fastest, and
    ``"history"`` the multigrid cycles; ``"depths"`` has the largest stresses at each depth below
    the surfaces, ``"section"`` their components on y = 0, and ``"dynamics"`` stiffness, damping and
    cross terms over frequency. Of a transient result ``"history"`` has a
    row per step, ``"lines"`` the nodes of the line y = 0 at each step, and ``"fields"`` all nodes
    of each frame.

    npz (numpy) and mat (MATLAB) have all arrays of the NetCDF file under the same names, and its
    ``summary`` as JSON text.

    VTK (ParaView): of a steady result the ending ``.vtr`` gives a rectilinear grid, the plane z = 0
    with x and y in metres and all maps as point arrays in SI ("warp by scalar" raises a film to a
    surface); ``.vts`` gives a structured grid that fills the film, with nodes at (x, y, zeta h) in
    metres and ``temperature`` [K] at each, without temperatures the two surfaces only (raise the
    scale of z to see it). Of a transient result ``NAME.pvd`` opens as one animation; its frames are
    the files ``NAME_0000.vtr`` ... beside it, with pressure [Pa], film thickness [m] and the
    heights of both surfaces [m].

    Parameters
    ----------
    result : Solution or TransientSolution
        What to write.
    path : str or Path
        The file; existing files are replaced.
    to : {"csv", "npz", "vtk", "mat"}, optional
        Format; by default that of the ending of ``path``.
    what : {"lines", "fields", "history", "depths", "section", "dynamics"}, optional
        Rows of a CSV table; lines of a steady result and the history of a transient one by default.

    Returns
    -------
    list of Path
        The files written, a collection before its frames.

    Raises
    ------
    InputError
        If format and ending do not match, if the result does not have what is to be written, or if
        a file cannot be written.
    """
    kind, path = _format_of(result, path, to), Path(path)
    if kind == "csv":
        _write_csv(result, path, what)
    elif kind == "npz":
        with replacing(path) as temporary, temporary.open("wb") as file:
            np.savez_compressed(file, allow_pickle=False, **_arrays(result))
    elif kind == "mat":
        from scipy.io import savemat  # noqa: PLC0415 (0.3 s, for this format only)

        with replacing(path) as temporary, temporary.open("wb") as file:
            savemat(file, _arrays(result), do_compression=True, oned_as="column")
    elif isinstance(result, TransientSolution):
        return _write_frames(result, path)
    else:
        _write_maps(result, path)
    return [path]


def _arrays(result: Solution | TransientSolution) -> dict[str, NDArray[Any]]:
    arrays = {variable.name: variable.data for variable in variables(result)}
    return {**arrays, "summary": np.array(json.dumps(summary(result)))}


def ending_of(result: Solution | TransientSolution, to: str | None) -> str:
    """Return the usual ending of a file of an export format.

    Parameters
    ----------
    result : Solution or TransientSolution
        Its kind decides which formats are known.
    to : str or None
        Name of the format, such as "csv"; None is reported as missing.

    Raises
    ------
    InputError
        If the format is unknown or missing; the message lists the known ones.
    """
    known = _FORMATS[_kind(result)]
    for ending, kind in known.items():
        if kind == to:
            return ending
    listed = ", ".join(dict.fromkeys(known.values()))
    stated = "no format stated" if to is None else f"unknown export format {to!r}"
    raise InputError(f"{stated}; expected --to {listed}, or -o with the ending {', '.join(known)}")


def _format_of(result: Solution | TransientSolution, path: str | Path, to: str | None) -> str:
    """Return the format ``to`` or that of the ending; raise if they do not match."""
    known = _FORMATS[_kind(result)]
    kind = known.get(Path(path).suffix.lower())
    if to is not None:
        ending_of(result, to)
    if kind is not None and to in (None, kind):
        return kind
    fitting = [
        ending + _MEANINGS.get(ending, "") for ending in known if to in (None, known[ending])
    ]
    of_format = "" if to is None else f" of format {to}"
    raise InputError(f"output {path}: a file{of_format} ends in {' or '.join(fitting)}")


def _kind(result: Solution | TransientSolution) -> type:
    return TransientSolution if isinstance(result, TransientSolution) else Solution


# ---- CSV


def _write_csv(result: Solution | TransientSolution, path: Path, what: str) -> None:
    known = _ROWS[_kind(result)]
    what = what or next(iter(known))
    columns = {v.name + _SUFFIXES[v.units]: v.data for v in _over(known.get(what, ()), result)}
    if not columns:
        there = [one for one, dims in known.items() if any(_over(dims, result))]
        raise InputError(f"the result has no {what} to export; expected {' or '.join(there)}")
    names: Iterable[str] = columns
    if isinstance(result, Solution) and what == "lines":
        names, rows = ("line", *columns), _line_rows(result, list(columns.values()))
    else:
        rows = _rows(list(columns.values()))
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(rows)


def _over(dims: tuple[str, ...], result: Solution | TransientSolution) -> Iterator[Variable]:
    """Yield the arrays over ``dims`` and their coordinates, broadcast to the same shape."""
    found = list(variables(result))
    sizes = {dim: size for v in found for dim, size in zip(v.dims, v.data.shape, strict=True)}
    if not set(dims) <= sizes.keys():
        return
    shape = tuple(sizes[dim] for dim in dims)
    for v in found:
        if v.dims == dims or (v.name in COORDINATES and set(v.dims) < set(dims)):
            axes = [sizes[dim] if dim in v.dims else 1 for dim in dims]
            yield replace(v, dims=dims, data=np.broadcast_to(v.data.reshape(axes), shape))
        elif v.name == "temperature" and dims == ("y", "x") and isinstance(result, Solution):
            yield from _layers(result, v)


def _layers(result: Solution, all_layers: Variable) -> Iterator[Variable]:
    """Yield the temperatures on surface 1, at mid-film, on surface 2, and their mean."""
    found = temperature(result)
    if found is not None:
        maps = (all_layers.data[0], found.mid_film, all_layers.data[-1], found.mean)
        for name, data in zip(("1", "mid", "2", "mean"), maps, strict=True):
            yield replace(all_layers, name=f"temperature_{name}", dims=("y", "x"), data=data)


def _line_rows(result: Solution, columns: list[NDArray[Any]]) -> Iterator[tuple[Any, ...]]:
    row, column = result.scaled.centre
    for name, line in (("x", np.s_[row, :]), ("y", np.s_[:, column])):
        yield from ((name, *numbers) for numbers in _rows([field[line] for field in columns]))


def _rows(columns: list[NDArray[Any]]) -> Iterator[tuple[Any, ...]]:
    return zip(*(column.ravel().tolist() for column in columns), strict=True)


# ---- VTK


def _write_maps(result: Solution, path: Path) -> None:
    """Write the maps of a steady result over the plane of the film, or over its volume."""
    maps = {v.name: v.data for v in _over(("y", "x"), result) if v.name not in COORDINATES}
    if path.suffix.lower() == ".vts":
        text = _volume(result, maps)
    else:
        axes = (result.x, result.y, np.zeros(1))
        text = rectilinear_grid(axes, maps, converged=result.status.converged)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="ascii")


def _volume(result: Solution, maps: dict[str, NDArray[Any]]) -> str:
    """Return the film as a structured grid; maps are the same on each layer."""
    heat, film = result.heat, result.film_thickness
    zeta = np.array([0.0, 1.0]) if heat is None else heat.zeta
    shape = (zeta.size, *film.shape)
    height = zeta[:, None, None] * film
    points = np.stack(np.broadcast_arrays(result.x, result.y[:, None], height), axis=-1)
    fields = {} if heat is None else {"temperature": heat.temperature}
    fields |= {name: np.broadcast_to(field, shape) for name, field in maps.items()}
    return structured_grid(points, fields, converged=result.status.converged)


def _write_frames(run: TransientSolution, target: Path) -> list[Path]:
    """Write each frame of a transient result as a plane, and a collection that lists them."""
    frames = run.frames
    if not frames.step.size:
        raise InputError("the result has no frames to export (transient.frames = 0)")
    check_writable(target)
    axes = (run.x, run.y, np.zeros(1))
    times: dict[Path, float] = {}
    for number, step in enumerate(frames.step):
        maps = {
            "pressure": frames.pressure[number],
            "film_thickness": frames.film[number],
            "height": frames.height[number],
        }
        plane = target.with_name(f"{target.stem}_{number:04d}.vtr")
        times[plane] = float(run.history.time[step])
        text = rectilinear_grid(axes, maps, converged=run.status.converged)
        with replacing(plane) as temporary:
            temporary.write_text(text, encoding="ascii")
    with replacing(target) as temporary:
        named = {plane.name: time for plane, time in times.items()}
        temporary.write_text(collection(named), encoding="utf-8")
    return [target, *times]
