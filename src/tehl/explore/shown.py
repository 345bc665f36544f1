"""What the page shows of a steady result: its fields around the contact, numbers and status."""

from dataclasses import dataclass

import numpy as np

from tehl.api.results import Result
from tehl.base.typing import Array
from tehl.explore.numbers import Number, numbers
from tehl.plots.frame import (
    WINDOW,
    minimum_places,
    pressure_top,
    span_part,
    stretched,
    window,
    window_part,
)
from tehl.plots.interferogram import Optics, colours
from tehl.plots.stress import DEEPEST_SHOWN, finer
from tehl.post.film import Profile, profile_x, profile_y
from tehl.post.stress.influence import COMPONENTS
from tehl.post.stress.measures import largest_shear
from tehl.report.explain import Explanation
from tehl.result.fields import FilmDynamics
from tehl.result.solution import Settings

_INTERFEROGRAM_PIXELS = 480
"""Pixels along x of an interferogram."""

STRIP, FAR_RIM = 1.7, 100.0
"""Half of the width at which a line contact is shown, and of its dry contact, over b."""
Span = tuple[float, float]
Line = tuple[Array, Array, Array, Array]


@dataclass(frozen=True, kw_only=True, slots=True)
class Maps:
    """Fields in the window around the contact, rows along x."""

    x: Array
    y: Array
    """Places of the nodes [um]."""
    window: tuple[Span, Span]
    """What is shown along x and y [um]."""
    half_widths: tuple[float, float]
    """Of the Hertz contact [um]."""
    stretch: float
    """Scale of y over that of x, one unless the contact is slender."""
    film: Array
    """[nm]."""
    pressure: Array
    """[GPa]."""
    central: float
    """Central film [nm]."""
    top: float
    """Pressure at which scales end [GPa]."""
    minimum: tuple[tuple[float, float], ...] = ()
    """Places of the minimum film [um]."""
    skew: float = 0.0
    """s of the rim of the Hertz contact, X^2 - 2 s X Y + Y^2 = 1 - s^2 in half-widths."""

    @property
    def half_width(self) -> float:
        """Half-width of the Hertz contact on y = 0 [um]: that of a turned ellipse is less."""
        return float(self.half_widths[0] * np.sqrt(1.0 - self.skew**2))


@dataclass(frozen=True, kw_only=True, slots=True)
class Lines:
    """Film and pressure on the centre lines."""

    x: Line
    y: Line
    """Place [um], film [nm], pressure and dry Hertz pressure [GPa]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Section:
    """Temperature rise in the plane y = 0."""

    x: Array
    """[um]."""
    rise: Array
    """(n, nx): From surface 1 to surface 2 [K]."""
    inlet: float
    """Temperature of the oil at the inlet [degC]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Deep:
    """Largest shear stress below the more stressed surface, on y = 0."""

    x: Array
    z: Array
    """[um]; z is negative below the surface."""
    shear: Array
    """(nz, nx) [GPa]."""
    words: str
    """Which surface, and its largest values."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """How a solve ended, in words."""

    converged: bool
    words: str
    message: str = ""
    hint: str = ""
    settings: Settings | None = None
    """What the hint sets."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Shown:
    """What the page shows of a steady result."""

    points: tuple[int, int]
    """Nodes along x and y."""
    seconds: float
    outcome: Outcome
    numbers: tuple[Number, ...]
    maps: Maps
    lines: Lines
    section: Section | None
    fringes: Array | None
    """Interferogram in white light, (rows, columns, 3) from the largest y down; None unless it was
    asked for."""
    stress: Deep | None
    """None unless it was asked for."""
    dynamics: FilmDynamics | None
    """None unless it was asked for and the film has it."""
    is_line: bool
    """Whether stiffness and damping are those of one metre of a line contact."""


def shown(result: Result, explanation: Explanation, *, view: str = "") -> Shown:
    """Return what the page shows of a result.

    Parameters
    ----------
    result, explanation : Result, Explanation
        The result, and what formulas say about its case.
    view : str
        Interferogram and stresses are computed for the views ``fringes`` and ``stress``.
    """
    scaled = result.scaled
    return Shown(
        points=(scaled.x.size, scaled.y.size),
        seconds=result.cost.wall_seconds,
        outcome=outcome_of(result),
        numbers=numbers(result, explanation),
        maps=maps_of(result),
        lines=_lines(result),
        section=_section(result),
        fringes=_fringes(result) if view == "fringes" else None,
        stress=_stress(result) if view == "stress" else None,
        dynamics=result.dynamics,
        is_line=result.problem.contact.is_line,
    )


def outcome_of(result: Result) -> Outcome:
    """Return how a solve ended, in words."""
    status = result.status
    hint = status.hint
    return Outcome(
        converged=status.converged,
        words=status.outcome,
        message=status.message or "",
        hint="" if hint is None else str(hint),
        settings=None if hint is None or not hint.settings else dict(hint.settings),
    )


def maps_of(result: Result) -> Maps:
    """Return film and pressure in the window around the contact; a line contact as a strip."""
    if result.problem.contact.is_line:
        return _strip(result)
    rows, columns = window_part(result)
    half = (result.scales.half_width_x * 1e6, result.scales.half_width_y * 1e6)
    x, y = ((low * a, high * a) for (low, high), a in zip(window(result), half, strict=True))
    return Maps(
        x=result.x[columns] * 1e6,
        y=result.y[rows] * 1e6,
        window=(x, y),
        half_widths=(half[0], half[1] * (FAR_RIM if result.problem.contact.has_lines else 1.0)),
        stretch=stretched(result),
        film=_single(result.film_thickness[rows, columns] * 1e9),
        pressure=_single(result.pressure[rows, columns] * 1e-9),
        central=result.film.central * 1e9,
        top=pressure_top(result) * 1e-9,
        minimum=tuple((x * half[0], y * half[1]) for x, y in minimum_places(result)),
        skew=result.groups.skew,
    )


def _strip(result: Result) -> Maps:
    """Return a part of a line contact that is as wide as long."""
    columns, half = span_part(result.scaled.x, WINDOW[0]), result.scales.half_width_x * 1e6
    (low, high), edges = WINDOW[0], STRIP * half * np.array([-1.0, 0.0, 1.0])
    film, pressure = (
        _single(np.repeat(field[:, columns], 3, axis=0))
        for field in (result.film_thickness * 1e9, result.pressure * 1e-9)
    )
    return Maps(
        x=result.x[columns] * 1e6,
        y=edges,
        window=((low * half, high * half), (float(edges[0]), float(edges[-1]))),
        half_widths=(half, FAR_RIM * half),
        stretch=1.0,
        film=film,
        pressure=pressure,
        central=result.film.central * 1e9,
        top=pressure_top(result) * 1e-9,
    )


def _single(field: Array) -> Array:
    return np.nan_to_num(field, nan=0.0, posinf=0.0, neginf=0.0).astype(np.float32)


def _lines(result: Result) -> Lines:
    """Return film and pressure on the grid lines nearest to y = 0 and x = 0."""
    along, across = window(result)
    x = profile_x(result)
    if not result.problem.contact.is_line:
        return Lines(x=_line(x, along), y=_line(profile_y(result), across))
    edges = STRIP * result.scales.half_width_x * 1e6 * np.array([-1.0, 1.0])
    middle = slice(result.scaled.centre[1], result.scaled.centre[1] + 1)
    _, *same = _part(x, middle)  # at all y
    film, pressure, hertz = (np.repeat(one, 2) for one in same)
    return Lines(x=_line(x, along), y=(edges, film, pressure, hertz))


def _line(profile: Profile, span: Span) -> Line:
    return _part(profile, span_part(profile.scaled_coordinate, span))


def _part(profile: Profile, part: slice) -> Line:
    return (
        profile.coordinate[part] * 1e6,
        _single(profile.film_thickness[part] * 1e9),
        _single(profile.pressure[part] * 1e-9),
        profile.hertz_pressure[part] * 1e-9,
    )


def _section(result: Result) -> Section | None:
    heat = result.heat
    if heat is None:
        return None
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (0.3 s, for heated films only)

    row = result.scaled.centre[0]
    columns = span_part(result.scaled.x, window(result)[0])
    inlet = result.scales.temperature
    rise = np.nan_to_num(heat.temperature[:, row, columns] - inlet)
    return Section(
        x=result.x[columns] * 1e6,
        # places across the film of a temperature section
        rise=_single(CubicSpline(heat.zeta, rise, axis=0)(np.linspace(0.0, 1.0, 41))),
        inlet=inlet - 273.15,
    )


def _stress(result: Result) -> Deep | None:
    """Return the section of the stress below the more stressed surface; None without a film."""
    if not result.status.converged:
        return None
    stressed = result if result.stress is not None else result.with_stress()
    found, numbers = stressed.stress, stressed.stress_numbers
    assert found is not None
    assert numbers is not None
    body = numbers.worse
    row = int(np.argmax(found.body == body.body))
    shear = largest_shear(np.array([getattr(found, name)[row] for name in COMPONENTS]))
    smaller = min(result.scales.half_width_x, result.scales.half_width_y)
    depth, shear = finer(found.depth, shear * 1e-9, DEEPEST_SHOWN * smaller)
    return Deep(
        x=found.x * 1e6,
        z=-depth[::-1] * 1e6,
        shear=_single(shear[::-1]),
        words=f"below surface {body.body}: {body.shear * 1e-9:.4g} GPa at most, "
        f"{body.shear_depth * 1e6:.4g} µm deep, {body.shear_ratio:.3g} times that of dry contact",
    )


def _fringes(result: Result) -> Array:
    """Return the film as an optical rig shows it in white light, as RGB bytes."""
    from scipy.interpolate import RectBivariateSpline  # noqa: PLC0415 (0.3 s)

    maps, scales = maps_of(result), result.scales
    law, optics = result.problem.lubricant.density, Optics()
    ratio = law.density(maps.pressure.astype(np.float64) * 1e9, scales.temperature)
    thickness = optics.thickness(maps.film * 1e-9, ratio / scales.density)
    (left, right), (bottom, top) = maps.window
    height = max(2, round(_INTERFEROGRAM_PIXELS * (top - bottom) / (right - left) * maps.stretch))
    order = min(3, maps.y.size - 1)
    fine = RectBivariateSpline(maps.y, maps.x, thickness, kx=order)(
        np.linspace(bottom, top, height), np.linspace(left, right, _INTERFEROGRAM_PIXELS)
    )
    seen = colours(np.maximum(fine, 0.0), optics)
    return (255.0 * seen[::-1]).round().astype(np.uint8)
