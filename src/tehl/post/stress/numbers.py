"""Numbers of the stress below the surfaces: largest values, their depths, ratios to dry contact."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from tehl.base.typing import Array
from tehl.contact.stress import Stress
from tehl.post.stress.loads import whole_pressure
from tehl.post.stress.window import window_of
from tehl.post.traction import cell_widths
from tehl.result.fields import BodyStress
from tehl.result.solution import Solution

NEIGHBOUR_DEPTHS = 2
"""Depths on each side of a maximum whose values are interpolated: further away other principal
stresses may be the largest."""


SPIKE_CELLS = 2.0
"""Half-width of a spike that the mesh does not resolve, in mesh widths along x."""


DEPTH_BAR = 1e-3
"""Bar of a maximum between the depths: the shear stress of six lines (M = 10 to 100, on 513 to 8193
nodes) is within 0.94e-3 of direct integrals over their pressure."""


class PressureBar(NamedTuple):
    """Error bar of the largest pressure of a film."""

    part: float
    """Over that pressure [-]."""
    half_width: float
    """Of what it is the error, a strip across the flow [m]; infinite where it is not known."""

    def at(self, depth: float) -> float:
        """Return the bar of a stress at a depth [m] under the middle of the strip [-].

        A strip of uniform pressure p makes (2/pi) p arctan(half-width/depth) there.
        """
        return self.part * 2.0 / math.pi * math.atan(self.half_width / depth)


class Peak(NamedTuple):
    """A maximum over depth."""

    value: float
    """[Pa]."""
    depth: float
    """[m]."""
    place: int
    """Of the nearest depth that was computed."""


def peak(depth: Array, values: Array) -> Peak:
    """Return the maximum of a profile, by a polynomial in the logarithm of the depth.

    Parameters
    ----------
    depth, values : (nz,) array
        Increasing depths [m], and stresses [Pa].
    """
    index = int(np.argmax(values))
    if index in (0, depth.size - 1):
        return Peak(float(values[index]), float(depth[index]), index)
    near = slice(max(index - NEIGHBOUR_DEPTHS, 0), index + NEIGHBOUR_DEPTHS + 1)
    logarithms = np.log(depth[near])
    curve = Polynomial.fit(logarithms, values[near], logarithms.size - 1)
    first, last = np.log(depth[[index - 1, index + 1]]).tolist()
    fine = np.linspace(first, last, 513)
    found = curve(fine)
    best = int(np.argmax(found))
    return Peak(float(found[best]), float(np.exp(fine[best])), index)


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyNumbers:
    """Largest stresses below one surface."""

    body: int
    """Its number."""
    shear: float
    shear_depth: float
    shear_x: float
    shear_y: float
    """Largest shear stress [Pa], its depth and place [m]."""
    shear_error: float | None
    """Its relative error bar: `DEPTH_BAR`, the part of the load that is left out, the change by
    loads on every second node, and the bar of the largest pressure of the film; of a spike that the
    mesh does not resolve what reaches that depth [-]. None where the pressure has no limit, at a
    sharp end of a roller."""
    shear_ratio: float
    """Largest shear stress over that of the dry smooth contact [-]."""
    von_mises: float
    von_mises_depth: float
    """Largest stress of von Mises [Pa], and its depth [m]."""
    orthogonal: float
    orthogonal_depth: float
    """Largest amplitude of tau_zx along the direction of rolling [Pa], and its depth [m]."""
    dang_van: float
    dang_van_ratio: float | None
    """Largest stress of Dang Van [Pa], and over that of the dry smooth contact [-]; None if that is
    not positive."""
    life_ratio: float | None
    """Life over that of the dry smooth contact under the same load [-]; None without stress above
    the fatigue limit."""
    life_ratio_error: float | None
    """Its relative error bar, from the same; it has the power of the stress in the life [-]."""
    at_shallowest: bool
    """Whether the shear stress is largest at the shallowest depth, so that it may grow above it."""
    traction: float
    """Force of the film on the body along x over the load [-]."""
    thermal: float | None
    """Largest compression along its surface by heat [Pa], E alpha dT/(1 - nu) if it moves; None if
    heat does not count."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StressNumbers:
    """Largest stresses below the surfaces."""

    bodies: tuple[BodyNumbers, ...]
    """Of each body that was computed."""
    shallowest: float
    """The shallowest depth [m]."""
    traction_left_out: bool
    """Whether the shear stress of the film is left out, as no oil can carry it."""
    heat_left_out: bool
    """Whether thermal stress is left out, as surfaces that move at an angle or spin have curved
    wakes of heat."""
    thermal_most: float
    """E alpha dT/(1 - nu) of the largest rise along the surfaces then [Pa]."""
    counts_roughness: bool
    """Whether the pressure is that of rough surfaces: a factor of lambda or kappa on the relative
    life would count the roughness twice."""

    @property
    def worse(self) -> BodyNumbers:
        """Return the numbers of the body with the larger shear stress."""
        return max(self.bodies, key=lambda one: one.shear)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What limits the use of these numbers, in words."""
        known = (
            (
                self.counts_roughness,
                "the pressure is that of rough surfaces, which the relative life includes: a "
                "factor of lambda or kappa on it would count the roughness twice",
            ),
            (
                self.traction_left_out,
                "the shear stress of the film is more than any oil can carry, and is left out",
            ),
            (
                self.heat_left_out,
                "thermal stress at an angle or with spin is left out: at most "
                f"{1e-6 * self.thermal_most:.3g} MPa, E alpha dT/(1 - nu)",
            ),
        )
        return tuple(words for applies, words in known if applies)

    def of(self, body: int) -> BodyNumbers | None:
        """Return the numbers of a body, None if it was not computed."""
        return next((one for one in self.bodies if one.body == body), None)


def stress_numbers(result: Solution) -> StressNumbers | None:
    """Return the largest stresses below the surfaces; None if the result does not have any."""
    found = result.stress
    if found is None:
        return None
    errors, bar = result.errors, PressureBar(0.0, math.inf)
    if errors is not None and not errors.pressure_has_limit:
        bar = PressureBar(math.nan, math.inf)
    elif errors is not None:
        spike = math.inf if errors.spike_resolved else SPIKE_CELLS * (result.x[1] - result.x[0])
        bar = PressureBar(errors.of("pressure_max") or 0.0, spike)
    settings = result.problem.stress or Stress()
    power = settings.stress_exponent / settings.weibull_slope
    outside = _outside(result)
    return StressNumbers(
        bodies=tuple(
            _numbers(found, row, bar, (power, outside), settings) for row in range(found.body.size)
        ),
        shallowest=float(found.depth[0]),
        traction_left_out=bool(found.left_out),
        heat_left_out=settings.thermal and not found.thermal.all(),
        thermal_most=_missing_heat(result, found.body[found.thermal == 0.0].astype(int).tolist()),
        counts_roughness=any(
            part is not None for part in (result.heights, result.contact, result.asperities)
        ),
    )


def _outside(result: Solution) -> float:
    """Return the part of the load on nodes that are left out of the stresses [-]."""
    pressure = whole_pressure(result)
    window = window_of(result, pressure)
    pressure = cell_widths(result.y)[:, None] * pressure
    return 1.0 - float(pressure[window.rows, window.columns].sum() / pressure.sum())


def _missing_heat(result: Solution, bodies: list[int]) -> float:
    """Return the largest E alpha dT/(1 - nu) of some bodies [Pa]; at rest half of it."""
    most, problem, heat = 0.0, result.problem, result.problem.heat
    for body in bodies:
        solid = problem.surfaces[body - 1].material
        if result.heat is None or heat is None or solid.expansion is None:
            continue
        surface, bulk = result.heat.temperature[1 - body], (heat.bulk_1, heat.bulk_2)[body - 1]
        rise = float(surface.max()) - bulk
        most = max(most, solid.young_modulus * solid.expansion * rise / (1.0 - solid.poisson_ratio))
    return most


def _known(bar: float) -> float | None:
    """Return an error bar, None where it is not known."""
    return None if math.isnan(bar) else bar


def _numbers(
    found: BodyStress, row: int, bar: PressureBar, parts: tuple[float, float], settings: Stress
) -> BodyNumbers:
    """Return the numbers of a body.

    ``parts`` are the power of the stress in the life, and the part of the load that is left out.
    """
    power, outside = parts
    shear, dry = (peak(found.depth, one[row]) for one in (found.shear, found.shear_dry))
    coarse = peak(found.depth, found.shear_coarse[row])
    mises, orthogonal, dang_van, dang_van_dry = (
        peak(found.depth, one[row])
        for one in (found.von_mises, found.orthogonal, found.dang_van, found.dang_van_dry)
    )
    life, life_coarse = float(found.life[row]), float(found.life_coarse[row])
    return BodyNumbers(
        body=int(found.body[row]),
        shear=shear.value,
        shear_depth=shear.depth,
        shear_x=float(found.shear_x[row, shear.place]),
        shear_y=float(found.shear_y[row, shear.place]),
        shear_error=_known(
            DEPTH_BAR + outside + abs(coarse.value / shear.value - 1.0) + bar.at(shear.depth)
        ),
        shear_ratio=shear.value / dry.value,
        von_mises=mises.value,
        von_mises_depth=mises.depth,
        orthogonal=orthogonal.value,
        orthogonal_depth=orthogonal.depth,
        dang_van=dang_van.value,
        dang_van_ratio=dang_van.value / dang_van_dry.value if dang_van_dry.value > 0 else None,
        life_ratio=life or None,
        life_ratio_error=_known(abs(life_coarse / life - 1.0) + power * (bar.part + outside))
        if life and life_coarse
        else None,
        at_shallowest=shear.place == 0,
        traction=float(found.traction[row]),
        thermal=float(found.thermal[row]) if settings.thermal else None,
    )
