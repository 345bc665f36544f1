"""Draw the pictures of the front page and of the README into ``docs/_static/front``.

``python docs/front.py [NAME ...]`` solves the contacts, all of them in about a minute, and draws
all pictures, or those named. They are shown 300 pixels wide: one thing each, words of 9 points.
"""

import io
import runpy
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.text import Text
from matplotlib.ticker import MaxNLocator
from PIL import Image
from scipy.interpolate import RectBivariateSpline
from scipy.ndimage import gaussian_filter

import tehl
from tehl import plots
from tehl.api.problem import case_from_tables
from tehl.base.typing import Array
from tehl.io.templates import template_text
from tehl.plots.frame import BLUE, FILM, GREEN, MAP, PRESSURE
from tehl.post.transient import moving_profiles

HERE = Path(__file__).parent
FOLDER = HERE / "_static" / "front"
SIZE, DPI, COLOURS = (3.3, 2.6), 200, 192
LEAST = 8.5
"""Smallest letters [points]."""
GROUND = "#e8e8e4"
"""Colour outside the contact."""
SOLID = "#c9ccd1"
WARM = LinearSegmentedColormap.from_list("warm", [GROUND, "#f3a04c", "#c2410c", "#5c1a0b"])
"""Colours of pressure and temperature."""


def example(name: str) -> dict[str, Any]:
    """Return the functions of a script in ``examples``."""
    return runpy.run_path(str(HERE.parent / "examples" / f"{name}.py"))


def axes_of(**settings: Any) -> Axes:
    """Return the axes of a new picture."""
    return Figure(figsize=SIZE, layout="constrained").add_subplot(**settings)


def film() -> Figure:
    """Draw film and pressure of a ball on a disc, each in one half of the contact."""
    result = tehl.solve(*case_from_tables(tables("ball-on-disc")))
    radius = result.scales.half_width_x * 1e6
    x, y, thickness = fine(result, result.film_thickness * 1e9)
    pressure = fine(result, result.pressure * 1e-9)[2]
    upper, lower = y >= -1e-9, y <= 1e-9
    central, low = result.film.central * 1e9, result.film.minimum * 1e9
    colours = colormaps["viridis"].with_extremes(over=GROUND)
    axes = axes_of(aspect="equal")
    norm = LogNorm(0.95 * low, 1.6 * central)
    axes.pcolormesh(x, y[upper], thickness[upper], norm=norm, cmap=colours, **MAP)
    levels = np.linspace(low, 1.05 * central, 7)[1:]
    axes.contour(x, y[upper], thickness[upper], levels=levels, colors="white", linewidths=0.6)
    axes.pcolormesh(x, y[lower], pressure[lower], cmap=WARM, vmin=0.0, **MAP)
    levels = np.arange(0.1, pressure.max(), 0.2)
    smooth = gaussian_filter(pressure, 4)[lower]  # the ridge of the spike is a node wide
    axes.contour(x, y[lower], smooth, levels=levels, colors="white", linewidths=0.6)
    axes.add_patch(Circle((0, 0), radius, fill=False, ls="--", color="0.2", lw=0.8))
    axes.axhline(0, color="white", lw=2)
    span = 1.5 * radius
    axes.set(xlim=(-1.3 * span, span), ylim=(-span, span), xticks=[], yticks=[])
    axes.text(0.03, 0.94, "film", va="top", transform=axes.transAxes)
    axes.text(0.03, 0.06, "pressure", transform=axes.transAxes)
    middle: dict[str, Any] = {"ha": "center", "color": "white"}
    axes.text(0, 0.15 * radius, f"{central:.0f} nm", **middle)
    axes.text(0, -0.45 * radius, f"{pressure.max():.2f} GPa", **middle)
    return of(axes)


def heat() -> Figure:
    """Draw the temperature of the film between sliding surfaces, in the plane of symmetry."""
    result = tehl.solve(*case_from_tables(tables("thermal")))
    assert result.heat is not None
    row = int(np.argmin(np.abs(result.y)))
    inside = np.abs(result.scaled.x) < 1.5
    x, h = result.x[inside] * 1e6, result.film_thickness[row, inside] * 1e9
    rise = result.heat.temperature[:, row, inside] - result.problem.inlet_temperature
    height = result.heat.zeta[:, None] * h[None, :]
    axes = axes_of(xlabel="x [µm]", ylabel="height [nm]")
    places = np.broadcast_to(x, height.shape)
    mesh = axes.pcolormesh(places, height, rise, cmap=WARM, vmin=0.0, **MAP)
    axes.contour(places, height, rise, levels=range(5, 40, 5), colors="white", linewidths=0.6)
    solid: dict[str, Any] = {"color": SOLID, "edgecolor": "none"}
    axes.fill_between(x, h, 2e3, **solid)
    axes.fill_between(x, 0, -200, **solid)
    axes.plot(x, h, color="0.3", lw=0.8)
    axes.axhline(0, color="0.3", lw=0.8)
    axes.set(xlim=(x[0], x[-1]), ylim=(-150, 900))
    axes.text(0, 660, "slow surface", ha="center")
    axes.text(0, -110, "fast surface", ha="center")
    figure = of(axes)
    figure.colorbar(mesh, ax=axes, label="temperature rise [K]")
    return figure


def rough() -> Figure:
    """Draw the film over a dent that stands still, and over one that moves with its surface."""
    case = tables("passing-dent")
    del case["transient"]
    case["surface_1"]["roughness"]["x"] = 0.0
    stands = tehl.solve(case_from_tables(case)[0])
    run = example("passing_dent")["followed"](0.0)
    figure = Figure(figsize=SIZE, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    row = int(np.argmin(np.abs(stands.y)))
    above.plot(stands.scaled.x, stands.film_thickness[row] * 1e9, color=FILM)
    above.set_title("a dent of 0.3 µm stands still", loc="left", pad=3)
    places = moving_profiles(run, 1).place / run.start.scales.half_width_x
    for number, place in enumerate((-0.75, -0.1, 0.55)):
        step = int(np.argmin(np.abs(places - place)))
        colour = colormaps["Oranges"](0.45 + 0.25 * number)
        below.plot(run.start.scaled.x, run.profiles.film[step] * 1e9, color=colour)
    below.set_title("it moves with its surface", loc="left", pad=3)
    for axes in (above, below):
        axes.set(xlim=(-1.4, 1.3), ylim=(0, 900), ylabel="h [nm]")
    below.set_xlabel("x / Hertz half-width")
    return figure


def measured() -> Figure:
    """Draw the film under a measured map of a honed surface."""
    result = example("measured_map")["solved"](rough=True)
    return map_of(plots.film_map, result, "film [µm]")


def starved() -> Figure:
    """Draw where the oil is around a starved contact."""
    result = example("starvation")["solved"](0.3)
    return map_of(plots.oil_map, result, "part of the gap with oil")


def asperities() -> Figure:
    """Draw the pressure where grooved surfaces touch."""
    result = example("touching_grooves")["solved"](0.2, points=257)
    return map_of(plots.contact_map, result, "pressure [GPa]")


def study() -> Figure:
    """Draw a Stribeck curve: friction and the load on asperities over the speed."""
    solved = example("mixed")["solved"]
    speeds = np.geomspace(1e-3, 5, 15)
    shared = [solved(float(speed)).load_sharing for speed in speeds]
    axes = axes_of(xlabel="speed [m/s]", ylabel="friction coefficient", xscale="log")
    axes.plot(speeds, [one.friction for one in shared], "o-", ms=3.5, color=BLUE)
    axes.set(ylim=(0, 0.08), xlim=(8e-4, 6))
    axes.tick_params(axis="y", labelcolor=BLUE)
    other = axes.twinx()
    other.plot(speeds, [100 * one.share for one in shared], "s--", ms=3, color=FILM)
    other.set(ylim=(0, 100), ylabel="load on asperities [%]")
    other.tick_params(axis="y", labelcolor=FILM)
    return of(axes)


def contacts() -> Figure:
    """Draw the films of a list of the contacts of a bearing."""
    script = example("bearing_list")
    rows = script["rows"]([250.0, 500.0, 1e3], [3000.0, 6000.0, 9000.0])
    films = tehl.solve_contacts(rows, tehl.ContactProblem.model_validate(script["TEMPLATE"]))
    axes = axes_of(xlabel="mean speed [m/s]", ylabel="minimum film [nm]")
    for ring, mark in (("outer", "s-"), ("inner", "o--")):
        for load, colour in zip(films["radial load"].unique(), (BLUE, GREEN, FILM), strict=True):
            mine = films[(films["ring"] == ring) & (films["radial load"] == load)]
            place, film = mine["u_m [m/s]"], mine["minimum film [nm]"]
            axes.plot(
                place, film, mark, ms=4, lw=1, color=colour, label=load if ring == "outer" else None
            )
        axes.text(5.4, film.iloc[-1], ring)
    axes.set(ylim=(0, 520), xlim=(1.4, 6.5))
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right", frameon=False, title="radial load", handlelength=1.4)
    return of(axes)


def accuracy() -> Figure:
    """Draw the central film on finer and finer grids with its error bars."""
    problem, options = case_from_tables(tables("ball-on-disc"))
    nodes = (65, 129, 257, 513)
    found = []
    for points in nodes:
        update = {"points": points, "extrapolate": False}
        result = tehl.solve(problem, options.model_copy(update=update))
        assert result.errors is not None
        found.append((result.film.central * 1e9, result.errors.discretisation_central))
    values = np.array([value for value, _ in found])
    bars = values * np.array([error for _, error in found])
    axes = axes_of(xlabel="nodes along x and y", ylabel="central film [nm]", xscale="log")
    axes.axhline(values[-1] + (values[-1] - values[-2]) / 3, color=GREEN, ls="--", lw=1)
    axes.errorbar(nodes, values, bars, fmt="o", ms=5, capsize=4, color=PRESSURE)
    axes.set(xticks=nodes, xlim=(50, 680))
    axes.set_xticklabels([str(one) for one in nodes])
    axes.minorticks_off()
    axes.text(600, values[-1] + 2.5 * bars[-1] + 4, "extrapolated", color=GREEN, ha="right")
    return of(axes)


def tables(name: str) -> dict[str, Any]:
    """Return the case of a template."""
    return tomllib.loads(template_text(name))


def map_of(draw: Callable[..., Figure], result: tehl.Result, label: str) -> Figure:
    """Return a map of the contact without lines and small print."""
    axes = Figure(figsize=SIZE).add_axes((0.03, 0.17, 0.71, 0.8))
    figure = draw(result, ax=axes)
    for one in [*axes.collections[1:], axes.legend_, *axes.patches[1:]]:
        one.remove()
    for text in list(axes.texts):
        text.remove()
    axes.set_facecolor(GROUND)
    axes.set(xlabel="x [µm]", ylabel="", yticks=[])
    axes.xaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    axes.child_axes[0].set_ylabel(label)
    return figure


def fine(result: tehl.Result, field: Array) -> tuple[Array, Array, Array]:
    """Return x and y [µm] and a field on three times the nodes."""
    spline = RectBivariateSpline(result.y, result.x, field, kx=1, ky=1)
    x, y = (np.linspace(axis[0], axis[-1], 3 * axis.size - 2) for axis in (result.x, result.y))
    return x * 1e6, y * 1e6, spline(y, x)


def of(axes: Axes) -> Figure:
    """Return the figure of axes."""
    found = axes.get_figure(root=True)
    assert isinstance(found, Figure)
    return found


PICTURES = (film, heat, rough, measured, starved, asperities, study, contacts, accuracy)


def save(figure: Figure, path: Path) -> None:
    """Save a picture with letters of at least `LEAST` points, in a palette of few colours."""
    for text in figure.findobj(Text):
        text.set_fontsize(max(text.get_fontsize(), LEAST))
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=DPI)
    image = Image.open(buffer).convert("RGB")
    image.quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)


def main(names: list[str]) -> None:
    """Draw the pictures of the given names, or all."""
    mpl.rcParams.update({"font.size": 9.0, "axes.linewidth": 0.7, "axes.titlesize": 9.0})
    FOLDER.mkdir(parents=True, exist_ok=True)
    for draw in PICTURES:
        if not names or draw.__name__ in names:
            save(draw(), FOLDER / f"{draw.__name__}.png")


if __name__ == "__main__":
    main(sys.argv[1:])
