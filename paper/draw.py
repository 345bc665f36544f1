"""The pictures: each figure as one sheet of panels."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator, NullFormatter
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from paper.figures import Figure
from paper.numbers import centre_line
from paper.runs import Runs
from paper.tables import printed_films
from tehl import Result

Array = np.ndarray[Any, np.dtype[np.float64]]

BLUE, ORANGE, GREEN, RED = "#1f4e9c", "#c2410c", "#2a9d8f", "#b3001b"
MAP = ((-1.8, 1.5), (-1.5, 1.5))
SURFACE = ((-1.6, 1.3), (-1.25, 1.25))
"""X and Y that maps and surfaces show, in half-widths."""
STEPS = (1, 2, 2.5, 5, 10)
DPI = 110
_ROWS_DRAWN = 61
_LAYERS = (
    ("layer 1: surface 1", BLUE),
    ("layer 2: surface 2", GREEN),
    ("layer 3: mid-film", ORANGE),
)
_LEGEND: tuple[dict[str, Any], ...] = (
    {"label": "P", "color": BLUE},
    {"label": "H", "color": ORANGE},
    {"label": "P, H on the paper's grid", "color": "0.25", "ls": "none", "marker": "o", "ms": 2.5},
    {"label": "dry contact", "color": "0.6", "ls": ":"},
)


def draw(figure: Figure, runs: Runs, folder: Path) -> None:
    """Draw a figure into ``folder`` as PNG and PDF.

    Parameters
    ----------
    figure : Figure
        Which.
    runs : Runs
        Where its results are.
    folder : Path
        Where to write.
    """
    lines = [runs.line(figure.series, "converged", h, tuple(figure.values)) for h in figure.heat]
    panels = pd.concat(lines, keys=figure.heat)
    picture = (_layers if figure.kind == "layers" else _sheet)(figure, runs, panels)
    grids = " and ".join(dict.fromkeys(panels.grid))
    fixed = f"{runs.series[figure.series].fixed}, {grids} nodes"
    picture.suptitle(f"{figure.label}.  {figure.title}\n{fixed}")
    picture.set_dpi(DPI)
    FigureCanvasAgg(picture).print_png(folder / f"{figure.name}.png")
    picture.set_layout_engine("none")  # which stays as it is
    picture.savefig(folder / f"{figure.name}.pdf", dpi=DPI)


def _sheet(figure: Figure, runs: Runs, panels: pd.DataFrame) -> Any:
    """Return a sheet of panels, with the curves along the series where there is a place left."""
    rows, columns = {4: (2, 2), 5: (2, 3), 8: (2, 4)}.get(len(panels), (1, len(panels)))
    draw_panel, projection = _PANELS[figure.kind]
    picture = matplotlib.figure.Figure((3.9 * columns, 3.5 * rows + 0.7), layout="constrained")
    for place, (name, run) in enumerate(panels.iterrows()):
        axes = picture.add_subplot(rows, columns, place + 1, projection=projection)
        _title(axes, place, name, run, runs.series[figure.series].symbol)
        draw_panel(axes, run, runs)
    if figure.kind == "centre-lines":
        handles = [Line2D([], [], **style) for style in _LEGEND]
        picture.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
    elif len(panels) < rows * columns:
        _trend(picture.add_subplot(rows, columns, rows * columns), figure, runs)
    return picture


def _title(axes: Any, place: int, name: Any, run: pd.Series, symbol: str) -> None:
    """Write letter and contact above a panel, and across its foot that it did not converge."""
    heat, value = name
    nodes = f", {run.nodes}² nodes" if run.treatment == "coarser" else ""
    axes.set_title(f"({chr(97 + place)})  {symbol} = {_number(value)}, {heat}{nodes}", fontsize=9)
    if not run.ok:
        style = {"ha": "center", "color": "white", "fontsize": 8, "zorder": 20}
        box = {"facecolor": RED, "edgecolor": "none", "pad": 2}
        axes.annotate(run.outcome, (0.5, 0.02), xycoords="axes fraction", bbox=box, **style)


def _note(axes: Any, text: str) -> None:
    axes.set_title(f"{axes.get_title()}\n{text}", fontsize=9)


def _number(value: float) -> str:
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")


def _films(run: pd.Series) -> str:
    low, central = (with_error(run[f], run[f"{f}_error"]) for f in ("H_min", "H_c"))
    return f"$H_{{min}}$ = {low},  $H_c$ = {central}"


def with_error(value: float, error: float) -> str:
    """Return a value with the error of its last digits in brackets: 0.1853(7)."""
    if not error > 0:
        return f"{value:.4f}"
    digits = min(max(-math.floor(math.log10(error)), 0), 6)
    last = round(error * 10**digits)
    if last == 10:
        digits, last = digits - 1, 1
    return f"{value:.{digits}f}({last})"


# ---- surfaces


def _film_surface(axes: Any, run: pd.Series, runs: Runs) -> None:
    """Draw the film upside down, cut off at 1.5 H_c: thin film is high."""
    top = 1.5 * max(run.H_c_on_grid, 1e-3)
    fields = runs.result(run.case).scaled
    _curtains(axes, fields, fields.film.clip(None, top), "viridis", top)
    axes.set_zlim(top, min(0.0, run.H_min_on_grid))
    axes.set_zlabel("H, downwards", labelpad=-2)
    _note(axes, _films(run))


def _pressure_surface(axes: Any, run: pd.Series, runs: Runs) -> None:
    fields = runs.result(run.case).scaled
    _curtains(axes, fields, fields.pressure, "cividis")
    axes.set_zlabel("P", labelpad=-4)
    note = f"$P_{{max}}$ = {run.P_max:.3f}"
    if run.spike_Y0 > 0 and not run.case.problem.is_rough:
        note += f",  at Y = 0 spike {run.spike_Y0:.3f} at X = {run.X_of_spike_Y0:.2f}"
    _note(axes, note)


def _temperature_surface(axes: Any, run: pd.Series, runs: Runs) -> None:
    result = runs.result(run.case)
    _curtains(axes, result.scaled, _rises(result)[2], "inferno")
    axes.set_zlabel("rise [K]", labelpad=-2)
    _note(axes, f"at most {run.rise_mid:.3g} K, at the centre {run.rise_c:.3g} K")


def _curtains(axes: Any, fields: Any, values: Array, colours: str, ground: float = 0.0) -> None:
    """Draw rows of a field one behind another, with all their nodes, down to ``ground``."""
    x, y, z = _part(fields, values, SURFACE)
    kept = np.unique(np.linspace(0, y.size - 1, _ROWS_DRAWN).round().astype(int))
    y, z = y[kept], z[kept]
    ends = np.concatenate([x[:1], x, x[-1:]])
    curtains = [
        np.column_stack([ends, np.full(ends.size, at), np.pad(row, 1, constant_values=ground)])
        for at, row in zip(y, z, strict=True)
    ]
    highest = z.min(axis=1) if ground else z.max(axis=1)
    faces = 0.8 * colormaps[colours](Normalize(z.min(), z.max())(highest))[:, :3] + 0.2
    style = {"facecolors": faces, "edgecolors": "0.15", "linewidths": 0.45}
    axes.add_collection3d(Poly3DCollection(curtains, **style))
    axes.set(xlim=SURFACE[0], ylim=SURFACE[1], zlim=(min(z.min(), 0.0), 1.02 * z.max()))
    axes.set_xlabel("X", labelpad=-4)
    axes.set_ylabel("Y", labelpad=-4)
    axes.set_box_aspect((*map(np.ptp, SURFACE), 1.55), zoom=1.08)
    axes.view_init(elev=30, azim=-55)
    axes.tick_params(labelsize=7, pad=-1)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, steps=STEPS))


def _part(fields: Any, values: Array, window: Any) -> tuple[Array, Array, Array]:
    """Return X, Y and values of the nodes in a window."""
    (west, east), (south, north) = window
    columns = (fields.x >= west) & (fields.x <= east)
    rows = (fields.y >= south) & (fields.y <= north)
    return fields.x[columns], fields.y[rows], values[np.ix_(rows, columns)]


# ---- maps and lines


def _film_contours(axes: Any, run: pd.Series, runs: Runs) -> None:
    """Draw the film in logarithmic colours, with close contours up to 1.1 H_c."""
    fields = runs.result(run.case).scaled
    x, y, film = _part(fields, fields.film, MAP)
    central = max(run.H_c_on_grid, 1e-3)
    low, top = max(float(film.min()), 0.02 * central), 1.6 * central
    norm = LogNorm(0.95 * low, top)
    image = _map(axes, fields, fields.film.clip(norm.vmin, top), norm=norm)
    close, wide = _levels(low, 1.1 * central), _levels(1.1 * central, 3.0 * central)
    axes.contour(x, y, film, close, colors="white", linewidths=0.6)
    axes.contour(x, y, film, wide, colors="black", linewidths=0.4, alpha=0.6)
    sides = (1, -1) if np.allclose(fields.film, fields.film[::-1]) else (1,)
    for side in sides:
        axes.plot(run.X_of_H_min, side * run.Y_of_H_min, "r+", ms=7, mew=1.4, zorder=7)
    bar = axes.figure.colorbar(image, ax=axes, shrink=0.8, label="H", format="%.3g")
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    bar.set_ticks(_levels(0.95 * low, top))
    bar.ax.tick_params(labelsize=7)
    _note(axes, _films(run))


def _levels(low: float, high: float) -> Array:
    """Return about six round values from above ``low`` to ``high``."""
    values = np.asarray(MaxNLocator(6, steps=STEPS).tick_values(low, high))
    return values[(values > low) & (values <= high)]


def _map(axes: Any, fields: Any, values: Array, **options: Any) -> Any:
    """Draw a field as an image with the Hertz circle; return it."""
    dx, dy = (0.5 * (axis[1] - axis[0]) for axis in (fields.x, fields.y))
    edges = (fields.x[0] - dx, fields.x[-1] + dx, fields.y[0] - dy, fields.y[-1] + dy)
    image = axes.imshow(values, extent=edges, origin="lower", interpolation="bilinear", **options)
    axes.set(aspect="equal", xlim=MAP[0], ylim=MAP[1], xlabel="X", ylabel="Y")
    axes.tick_params(labelsize=8)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=STEPS))
    rim = Circle((0, 0), 1, fill=False, color="white", ls="--", lw=0.9, zorder=5)
    rim.set_path_effects([withStroke(linewidth=1.6, foreground="0.25")])
    axes.add_patch(rim)
    return image


def _centre_lines(axes: Any, run: pd.Series, runs: Runs) -> None:
    """Draw P and H along Y = 0: lines converged, dots on the paper's grid."""
    right = axes.twinx()
    result = runs.result(run.case)
    x = result.scaled.x
    axes.plot(x, np.sqrt(np.maximum(1.0 - x**2, 0.0)), color="0.6", ls=":", lw=1.2)
    labels = run.case.labels
    coarse = runs.line(labels["series"], "paper", labels["heat"], (run.name[1],))
    shown: list[tuple[Result, dict[str, Any]]] = [(result, {"lw": 1.6})]
    shown += [(runs.result(case), {"ls": "none", "marker": "o", "ms": 2.4}) for case in coarse.case]
    for one, style in shown:
        fields = one.scaled
        axes.plot(fields.x, centre_line(one, fields.pressure), color=BLUE, **style)
        right.plot(fields.x, centre_line(one, fields.film), color=ORANGE, **style)
    if coarse.empty:
        right.axhline(run.H_c_on_grid, color=ORANGE, lw=0.6, ls="--")
    axes.set(xlim=(-2.0, 1.5), ylim=(0.0, max(1.65, 1.04 * run.P_max)), xlabel="X")
    axes.set_ylabel("P", color=BLUE, labelpad=1)
    right.set_ylim(0.0, 2.4 * max(run.H_c_on_grid, 1e-3))
    right.set_ylabel("H", color=ORANGE, labelpad=2)
    for one in (axes, right):
        one.tick_params(labelsize=8)
    _note(axes, _films(run))


def _rises(result: Result) -> list[Array]:
    """Return the rises of surface 1, surface 2 and mid-film [K]."""
    found, heat = result.temperature, result.heat
    assert found is not None
    assert heat is not None
    fields = (heat.temperature[0], heat.temperature[-1], found.mid_film)
    return [np.asarray(field - found.inlet) for field in fields]


def _layers(figure: Figure, runs: Runs, panels: pd.DataFrame) -> Any:
    """Return layer temperatures: a column per contact, a row per layer, and centre lines."""
    count = len(panels)
    picture = matplotlib.figure.Figure((3.3 * count, 11.5), layout="constrained")
    grid = picture.subplots(len(_LAYERS) + 1, count, squeeze=False)
    for column, (name, run) in enumerate(panels.iterrows()):
        result = runs.result(run.case)
        *maps, lines = grid[:, column]
        _title(maps[0], column, name, run, runs.series[figure.series].symbol)
        _note(maps[0], f"at most {run.rise_1:.0f}, {run.rise_2:.0f} and {run.rise_mid:.0f} K")
        for axes, rise, (label, colour) in zip(maps, _rises(result), _LAYERS, strict=True):
            shown = _part(result.scaled, rise, MAP)[2]
            top = max(float(np.percentile(shown, 99.8)), 1e-3)
            image = _map(axes, result.scaled, rise, cmap="inferno", vmin=0.0, vmax=top)
            picture.colorbar(image, ax=axes, shrink=0.8).ax.tick_params(labelsize=7)
            if column == 0:
                axes.set_ylabel(f"{label}, rise [K]\nY")
            lines.plot(result.scaled.x, centre_line(result, rise), color=colour, label=label)
        lines.set(xlim=MAP[0], xlabel="X  (Y = 0)")
        lines.tick_params(labelsize=8)
    grid[-1, 0].set_ylabel("rise [K]")
    grid[-1, 0].legend(fontsize=7, frameon=False, loc="upper left")
    return picture


# ---- along the series


def _trend(axes: Any, figure: Figure, runs: Runs) -> None:
    """Draw what a figure is about against what varies: converged, and on the paper's grid."""
    series, heat = runs.series[figure.series], figure.heat[-1]
    fine = runs.line(figure.series, "converged", heat)
    coarse = runs.line(figure.series, "paper", heat)
    wavy = f"wavy {figure.kind}" if series.problem.is_rough else ""
    for column, label, colour in _CURVES.get(wavy, _CURVES[figure.kind]):
        axes.plot(fine.index, fine[column], "o-", color=colour, ms=4, lw=1.5, label=label)
        axes.plot(coarse.index, coarse[column], "o--", color=colour, mfc="none", ms=4, lw=0.9)
    grey = {"color": "0.4", "lw": 0.9}
    known = printed_films(figure.series, heat)
    if len(known) and figure.kind.startswith("film"):
        for film, colour in (("H_min", ORANGE), ("H_c", BLUE)):
            axes.plot(known.index, known[film], "x", color=colour, ms=7, mew=1.6)
        axes.plot([], [], "x", ms=7, mew=1.6, label="printed in the paper", **grey)
    if len(coarse):
        axes.plot([], [], "o--", mfc="none", ms=4, label="on the paper's grid", **grey)
    crowded = min(np.diff(series.values)) < 0.08 * np.ptp(series.values)
    axes.set_xticks(series.values, [_number(v) for v in series.values], rotation=60 * crowded)
    low, high = axes.get_ylim()
    axes.set_ylim(min(0.0, low), high + 0.12 * (high - min(0.0, low)))
    axes.set_xlabel(series.symbol)
    axes.legend(fontsize=7.5, framealpha=0.7, edgecolor="none")
    axes.tick_params(labelsize=8)
    axes.grid(lw=0.3)
    axes.set_title("Along the series", fontsize=9.5)


_FILM_CURVES = (("H_min", "$H_{min}$", ORANGE), ("H_c", "$H_c$", BLUE))
_CURVES = {
    "film-surface": _FILM_CURVES,
    "film-contours": _FILM_CURVES,
    "pressure-surface": (("spike_Y0", "spike at Y = 0", BLUE), ("P_c", "$P$ at the centre", "0.5")),
    "wavy pressure-surface": (("P_max", "$P_{max}$", BLUE),),
    "temperature-surface": (
        ("rise_mid", "mid-film, at most [K]", ORANGE),
        ("rise_1", "surface 1 [K]", BLUE),
        ("rise_2", "surface 2 [K]", GREEN),
    ),
}
"""Columns drawn along a series, by kind of figure."""

_PANELS: dict[str, tuple[Callable[[Any, pd.Series, Runs], None], str | None]] = {
    "film-surface": (_film_surface, "3d"),
    "pressure-surface": (_pressure_surface, "3d"),
    "temperature-surface": (_temperature_surface, "3d"),
    "film-contours": (_film_contours, None),
    "centre-lines": (_centre_lines, None),
}
