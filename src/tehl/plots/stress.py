"""Stress below the surfaces: the section y = 0, profiles over depth, and the same over time."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.ticker import MaxNLocator
from scipy.interpolate import make_interp_spline

from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.plots.arrows import MICRO
from tehl.plots.frame import (
    BLUE,
    GIGA,
    GREEN,
    MAP,
    ORANGE,
    PLAIN,
    colour_bar,
    dress_contact,
    figure,
    inner_levels,
    mark_levels,
    shape,
    stretched_label,
)
from tehl.post.stress.measures import largest_shear
from tehl.post.stress.moving import MovingStress, moving_stress
from tehl.post.stress.numbers import BodyNumbers, stress_numbers
from tehl.result.fields import BodyStress
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

DEEPEST_SHOWN = 1.5
"""Depth that sections show [smaller half-widths of the Hertz contact]."""
PLANES = {"x": "y = 0", "y": "x = 0"}
"""Plane of a section along x or y."""


def stress_section(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw the largest shear stress below the more stressed surface [GPa], and depth profiles.

    Parameters
    ----------
    result : Solution
        With stresses: its case has a table ``[stress]``.
    title : bool or None
        Whether the figure has a title.

    Raises
    ------
    InputError
        If the result has no stresses.
    """
    found, numbers = result.stress, stress_numbers(result)
    if found is None or numbers is None:
        raise InputError("the result has no stresses to draw: state [stress], or solve --stress")
    body = numbers.worse
    note = (
        f"below surface {body.body}: largest shear stress {body.shear * GIGA:.4g} GPa at a depth "
        f"of {body.shear_depth * MICRO:.4g} µm, {body.shear_ratio:.3g} times that of dry contact"
    )
    if body.life_ratio is not None:
        note += f"; life {body.life_ratio:.3g} times"
    picture = figure(result, (9.6, 4.6), note, title=title)
    picture.set_layout_engine("compressed")
    section, profile = picture.subplots(1, 2, width_ratios=(2.2, 1.0))
    row = int(np.argmax(found.body == body.body))
    stress = np.array([getattr(found, name)[row] for name in ("xx", "yy", "zz", "xy", "yz", "zx")])
    _draw_section(section, result, found, largest_shear(stress))
    if abs(body.shear_y) <= np.diff(result.y[:2]).sum():  # of a line contact 0 <= 0
        section.plot(body.shear_x * MICRO, body.shear_depth * MICRO, "w+", ms=9, mew=1.6)
    _draw_profiles(profile, result, found, row, body)
    return picture


def stress_planes(result: Solution, *, title: bool | None = True) -> Figure:
    """Draw the largest shear stress on the plane x = 0, and at the depth where it is largest [GPa].

    Parameters
    ----------
    result : Solution
        With stresses, not of a line contact.
    title : bool or None
        Whether the figure has a title.

    Raises
    ------
    InputError
        If the result has no stresses, or is a line contact.
    """
    found, numbers = result.stress, stress_numbers(result)
    if found is None or numbers is None or found.y.size == 1:
        raise InputError("the result has no planes of stress: state [stress] of a point contact")
    body = numbers.worse
    row = int(np.argmax(found.body == body.body))
    deep = float(found.floor_depth[row]) * MICRO
    # a high map has a higher figure
    slender = shape(result) > 1.5
    size = (9.6, 5.6) if slender else (9.6, 4.1)
    picture = figure(result, size, f"below surface {body.body}", title=title)
    picture.set_layout_engine("compressed")
    section, floor = picture.subplots(1, 2)
    _draw_section(section, result, found, found.across[row], "y")
    x, y = found.x * MICRO, found.y * MICRO
    mesh = floor.pcolormesh(x, y, found.floor[row] * GIGA, cmap="viridis", **MAP)
    dress_contact(floor, result)
    floor.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), title=f"{deep:.4g} µm deep")
    floor.xaxis.set_major_locator(MaxNLocator(2 if slender else 4))
    colour_bar(floor, mesh, "largest shear stress [GPa]")
    return picture


def _draw_section(
    axes: Axes, result: Solution, found: BodyStress, shear: Array, along: str = "x"
) -> None:
    """Draw a map over x or y and depth, which points down."""
    depth, shown = finer(found.depth, shear * GIGA, _reach(result))
    places = getattr(found, along) * MICRO, depth * MICRO
    dress(axes, result, (float(places[0][0]), float(places[0][-1])), along)
    mesh = axes.pcolormesh(*places, shown, cmap="viridis", clim=(0.0, shown.max()), **MAP)
    style: dict[str, Any] = {"colors": "white", "linewidths": 0.5}
    lines = axes.contour(*places, shown, levels=inner_levels((0.0, float(shown.max()))), **style)
    mark_levels(colour_bar(axes, mesh, f"largest shear stress on {PLANES[along]} [GPa]"), lines)


def dress(axes: Axes, result: Solution, x: tuple[float, float], along: str = "x") -> None:
    """Give the axes of a section its window and the edges of the Hertz contact.

    Parameters
    ----------
    axes, result : Axes, Solution
        Of a section, and what gives its depth.
    x : (float, float)
        Ends of the section [µm].
    along : {"x", "y"}
        Where it runs; one longer than three depths is stretched, so that it can be read.
    """
    reach, scales = _reach(result) * MICRO, result.scales
    width = MICRO * (scales.half_width_x if along == "x" else scales.half_width_y)
    label = f"{along} {'along' if along == 'x' else 'across'} entrainment [µm]"
    length = (x[1] - x[0]) / reach
    stretch = length / 2.0 if length > 3.0 else 1.0
    depth = stretched_label("depth z [µm]", stretch)
    axes.set(xlabel=label, ylabel=depth, xlim=x, ylim=(reach, 0.0))
    axes.set_aspect(stretch)
    for edge in (-width, width):
        axes.plot([edge, edge], [0.0, 0.12 * reach], color="0.25", lw=1.2, clip_on=False)


def _reach(result: Solution) -> float:
    return DEEPEST_SHOWN * min(result.scales.half_width_x, result.scales.half_width_y)


def finer(depth: Array, planes: Array, reach: float) -> tuple[Array, Array]:
    """Return even depths and stresses there, by cubic splines over the logarithm of the depth.

    Parameters
    ----------
    depth : (nz,) array
        Depths computed [m].
    planes : (..., nz, nx) array
        Stresses.
    reach : float
        The deepest depth of the picture [m].
    """
    # as drawn: stresses at the depths computed are interpolated
    even = np.linspace(depth[0], max(reach, 2.0 * depth[0]), 200)
    spline = make_interp_spline(np.log(depth), planes, axis=-2)
    return even, np.asarray(spline(np.log(np.minimum(even, depth[-1]))))


def _draw_profiles(
    axes: Axes, result: Solution, found: BodyStress, row: int, body: BodyNumbers
) -> None:
    """Draw the largest stresses at each depth, and those of the dry contact."""

    def curve(name: str) -> tuple[Array, Array]:
        values = getattr(found, name)[row][:, None]
        even, shown = finer(found.depth, values * GIGA, _reach(result))
        return shown[:, 0], even * MICRO

    for name, label, colour in (
        ("von_mises", "von Mises", GREEN),
        ("shear", "shear", BLUE),
        ("orthogonal", "amplitude of $τ_{zx}$", ORANGE),
    ):
        axes.plot(*curve(name), color=colour, label=label)
        if name != "von_mises":
            axes.plot(*curve(f"{name}_dry"), color=colour, ls="--", lw=1.0)
    axes.plot([], [], color="0.4", ls="--", lw=1.0, label="dry smooth")
    axes.plot(body.shear * GIGA, body.shear_depth * MICRO, "o", color=BLUE, ms=4)
    axes.set(xlabel="largest at that depth [GPa]", xlim=(0.0, None))
    axes.set_ylim(_reach(result) * MICRO, 0.0)
    axes.grid(lw=0.3)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, **PLAIN)


def moving_section(run: TransientSolution, *, title: bool | None = True) -> Figure:
    """Draw the section y = 0 at the stored field with the largest shear stress, and its history.

    Parameters
    ----------
    run : TransientSolution
        With stored fields; its body is that of ``stress.body``, or 1.
    title : bool or None
        Whether the figure has a title.
    """
    settings = run.start.problem.stress
    body = 1 if settings is None else settings.bodies[0]
    found = moving_stress(run, body)
    number = int(np.argmax(found.shear.max(axis=1)))
    note = f"below surface {body} at t = {found.time[number] * 1e3:.4g} ms, of the stored fields"
    picture = figure(run, (9.6, 4.6), note, title=title)
    picture.set_layout_engine("compressed")
    section, history = picture.subplots(1, 2, width_ratios=(2.0, 1.2))
    image = section_image(section, run, found, number)
    colour_bar(section, image, "largest shear stress on y = 0 [GPa]")
    history.plot(found.time * 1e3, found.shear.max(axis=1) * GIGA, color=BLUE, label="anywhere")
    on_plane = found.plane.max(axis=(1, 2)) * GIGA
    history.plot(found.time * 1e3, on_plane, color=BLUE, ls="--", label="on y = 0")
    history.set(xlabel="time [ms]", ylabel="largest shear stress [GPa]")
    history.grid(lw=0.3)
    history.legend(**PLAIN)
    return picture


def section_image(
    axes: Axes, run: TransientSolution, found: MovingStress, number: int
) -> AxesImage:
    """Draw the section of one stored field as an image, in colours that fit all of them.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    run : TransientSolution
        Gives the window.
    found : MovingStress
        Its stresses.
    number : int
        Which field.
    """
    depth, x = found.depth, found.x * MICRO
    shown, deepest = section_rows(run, found, number), max(_reach(run.start), 2.0 * depth[0])
    extent = (float(x[0]), float(x[-1]), float(deepest * MICRO), float(depth[0] * MICRO))
    dress(axes, run.start, extent[:2])
    style: dict[str, Any] = {"interpolation": "bilinear", "aspect": "equal", "extent": extent}
    return axes.imshow(shown, vmin=0.0, vmax=float(found.plane.max()) * GIGA, **style)


def section_rows(run: TransientSolution, found: MovingStress, number: int) -> Array:
    """Return the stresses of one stored field at even depths, (rows, nx) [GPa].

    Parameters
    ----------
    run : TransientSolution
        Gives the depth of the picture.
    found : MovingStress
        Its stresses.
    number : int
        Which field.
    """
    return finer(found.depth, found.plane[number] * GIGA, _reach(run.start))[1]
