"""The controls of a case, grouped as a person thinks; each one edits one key of its text.

What a number is, and which units it may have, is that of the field of the model at its path. A
`Row` adds what a page needs: label, units to choose from, sane range, and when it is shown.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import NamedTuple

from tehl.api.problem import ContactProblem
from tehl.base.units import Number, quantity
from tehl.contact.options import Options
from tehl.explore import choices
from tehl.explore.case_text import CaseText
from tehl.explore.choices import State
from tehl.explore.knobs import Choice, Group, Knob, Span
from tehl.io.case import found_at
from tehl.report.plausibility import typical_ranges


class Row(NamedTuple):
    """A number of the case as a row of the table of controls.

    It is shown where ``when`` holds and the case has a finite number.
    """

    path: str
    label: str
    units: str = ""
    """To choose from, separated by semicolons."""
    span: Span | str = (0.0, 1.0)
    """Sane range in SI, or the name of a typical range."""
    when: Callable[[State, str], bool] | None = None
    """Takes the case and the path."""
    otherwise: str = ""
    """Property of the contact that has the value where the text states none."""
    is_log: bool = True
    per_half_width: bool = False
    """Whether the range is in half-widths of the contact."""

    def knobs(self, state: State) -> Iterator[Knob]:
        """Yield the control, if the case has the number."""
        problem, stated = state.problem, state.case.get(self.path)
        value, kind = found_at(problem, Options(), self.path)
        if isinstance(value, float) and kind is None:
            kind = quantity(Number)
        if kind is None or (self.when is not None and not self.when(state, self.path)):
            return
        names = tuple(self.units.split(";"))
        unit = names[0]
        if isinstance(stated, str):
            words = stated.strip().lstrip("+-0123456789.eE").strip()
            unit = next((name for name in names if name == words.replace("°C", "degC")), unit)
        if self.otherwise and (stated is None or not isinstance(value, float)):
            value = getattr(problem, self.otherwise)
        if isinstance(value, float) and math.isfinite(value):
            span = self._span(state)
            yield Knob(self.path, self.label, kind, names, span, value, unit, self.is_log)

    def _span(self, state: State) -> Span:
        if not isinstance(self.span, str):
            factor = state.problem.hertz.half_width_x if self.per_half_width else 1.0
            return self.span[0] * factor, self.span[1] * factor
        typical = next(one for one in typical_ranges(state.scaled) if one.name == self.span)
        factor = {"GPa": 1e9, "1/GPa": 1e-9}.get(typical.unit, 1.0)
        return typical.low * factor, typical.high * factor


_even = partial(Row, is_log=False)
"""A row whose slider is not logarithmic."""
Item = Row | Callable[[State], Choice | None]


def groups(case: CaseText, problem: ContactProblem) -> tuple[Group, ...]:
    """Return the controls of a case that states ``problem``."""
    state = State(case, problem)
    return tuple(
        Group(name, tuple(_controls(items, state)), name in _OPEN)
        for name, items in _GROUPS.items()
    )


def _controls(items: tuple[Item, ...], state: State) -> Iterator[Knob | Choice]:
    for item in items:
        if isinstance(item, Row):
            yield from item.knobs(state)
        elif (choice := item(state)) is not None:
            yield choice


def swept_knobs(found: tuple[Group, ...]) -> dict[str, Knob]:
    """Return the controls that can be swept, by their paths."""
    return {item.path: item for group in found for item in group.items if isinstance(item, Knob)}


# ---- when a number is shown


def _in_own_table(state: State, path: str) -> bool:
    return isinstance(state.case.get(path.rpartition(".")[0]), Mapping)


def _is_ellipse(state: State, _: str) -> bool:
    radii = state.problem.radii_of_axes
    return not _is_rolled(state) and radii.x != radii.y


def _is_rolled(state: State, _: str = "") -> bool:
    """Return whether it is a line contact or a roller."""
    return state.problem.contact.has_lines


def _is_roller(state: State, _: str) -> bool:
    return state.problem.contact.type == "roller"


def _has_tilt(state: State, path: str) -> bool:
    """Return whether the tilt of a roller is stated as at this path."""
    by_moment = state.problem.contact.tilting_moment is not None
    return choices.is_whole_roller(state) and by_moment == path.endswith("moment")


def _may_spin(state: State, _: str) -> bool:
    """Return whether it is a contact with ends, whose speed changes along y by a spin."""
    return not _is_rolled(state) or choices.is_whole_roller(state)


def _slides(state: State, _: str) -> bool:
    return state.problem.slide_roll_ratio != 0.0


def _is_heated(state: State, _: str) -> bool:
    return state.problem.thermal is not None


def _has_stated_bodies(state: State, path: str) -> bool:
    """Return whether the temperature of the body at this path is not computed."""
    surface = getattr(state.problem, path.partition(".")[0])
    stated = surface.thermal_resistance is None and surface.cooling is None
    return stated and _is_heated(state, path)


def _is_at_inlet(state: State, path: str) -> bool:
    """Return whether the oil depends on temperature, and that of the inlet stands at this path."""
    in_heat = state.case.get("thermal.temperature") is not None
    coefficient = state.problem.lubricant.viscosity.temperature_coefficient
    return coefficient > 0 and in_heat == path.startswith("thermal.")


def _has_slope(state: State, path: str) -> bool:
    return state.case.get(path.replace(".alpha", ".z")) is None


def _is_eyring(state: State, _: str) -> bool:
    return state.problem.lubricant.shear.law == "eyring"


def _is_smooth(state: State, path: str) -> bool:
    table = path.partition(".")[0]
    return state.roughness_of(table) == "smooth" and not state.case.get(f"{table}.ra_roughness")


# ---- the table


def _rough(table: str, kind: str, *rows: Row) -> Iterator[Row]:
    """Yield the rows of a type of roughness, whose paths begin at its table."""
    for row in rows:
        yield row._replace(
            path=f"{table}.roughness.{row.path}",
            when=lambda state, _: state.roughness_of(table) == kind,
        )


def _solid(number: int) -> tuple[Item, ...]:
    table = f"surface_{number}.material"
    modulus, ratio = f"modulus E{'₀₁₂'[number]}", f"Poisson ratio ν{'₀₁₂'[number]}"
    return (
        partial(choices.material, number=number),
        Row(f"{table}.young_modulus", modulus, "GPa;MPa", (1e9, 1.2e12), _in_own_table),
        _even(f"{table}.poisson_ratio", ratio, "", (0.0, 0.5), _in_own_table),
    )


def _surface(number: int) -> tuple[Item, ...]:
    table, label = f"surface_{number}", f"Rq of surface {number}, for λ"
    wide = partial(Row, units="um;mm", per_half_width=True)
    return (
        partial(choices.surface, number=number),
        _even(f"{table}.rms_roughness", label, "um;nm", (0.0, 1e-6), _is_smooth),
        *_rough(
            table,
            "wave",
            Row("amplitude", "amplitude", "um;nm", (1e-9, 1e-6)),
            wide("wavelength", "wavelength", span=(0.15, 4.0)),
            _even("angle", "angle of the crests", "deg", (0.0, 0.5 * math.pi)),
        ),
        *_rough(
            table,
            "bump",
            _even("amplitude", "height, negative is a dent", "um;nm", (-1e-6, 1e-6)),
            wide("radius", "radius", span=(0.1, 1.5)),
            wide("x", "place x", span=(-4.0, 2.0), is_log=False),
        ),
        *_rough(
            table,
            "random",
            Row("rms", "Rq", "nm;um", (1e-9, 2e-7)),
            wide("correlation_length", "correlation length", span=(0.08, 1.0)),
        ),
    )


_LAW, _SHEAR = "lubricant.viscosity", "lubricant.shear"
_radius = partial(Row, units="mm;m", span=(1e-4, 5.0))
_inlet = partial(_even, units="degC;K", span=(253.15, 433.15), otherwise="inlet_temperature")
_ANGLE, _SPINS = ("deg", (-0.5 * math.pi, 0.5 * math.pi)), (-3000.0, 3000.0)
_OPEN = ("Load and speed", "Bodies and geometry", "Oil")
_GROUPS: dict[str, tuple[Item, ...]] = {
    "Load and speed": (
        choices.load,
        Row("contact.load", "load", "N;kN", (0.1, 1e5)),
        Row("contact.load_per_length", "load per length", "N/mm;kN/m", (1e3, 1e6)),
        Row("contact.hertz_pressure", "Hertz pressure", "GPa;MPa", "Hertz pressure"),
        Row("contact.moes_load", "Moes M", "", "Moes M"),
        choices.speed,
        Row("contact.moes_speed", "Moes L", "", (0.1, 25.0)),
        Row("contact.entrainment_speed", "entrainment speed", "m/s;mm/s", "entrainment speed"),
        _even("contact.slide_roll_ratio", "slide-to-roll ratio", "", (-2.0, 2.0)),
    ),
    "Direction and spin": (
        _even("contact.entrainment_angle", "direction of entrainment", *_ANGLE, when=_is_ellipse),
        _even("contact.sliding_angle", "direction of sliding", *_ANGLE, when=_slides),
        *(
            _even(
                f"contact.spin_{number}", f"spin of body {number}", "rpm;rad/s", _SPINS, _may_spin
            )
            for number in (1, 2)
        ),
    ),
    "Bodies and geometry": (
        *_solid(1),
        *_solid(2),
        choices.kind,
        Row("contact.length", "length of the roller", "mm;m", (1e-3, 0.2), _is_roller),
        choices.roller_ends,
        choices.roller_tilt,
        _even("contact.tilt", "tilt of the roller", "mrad;deg", (0.0, 5e-3), _has_tilt),
        _even("contact.tilting_moment", "moment of the load", "N m", (0.0, 10.0), _has_tilt),
        choices.roller_profile,
        choices.shape,
        _radius("contact.radius", "reduced radius R"),
        _radius("contact.radius_x", "reduced radius R_x, along entrainment"),
        _radius("contact.radius_y", "reduced radius R_y, across entrainment"),
        *(
            _radius(
                f"surface_{number}.radius{axis}", f"radius{axis.replace('_', ' ')} of body {number}"
            )
            for number in (1, 2)
            for axis in ("", "_x", "_y")
        ),
    ),
    "Oil": (
        choices.oil,
        Row(f"{_LAW}.nu_40", "viscosity at 40 °C", "mm^2/s", (1e-6, 2e-3)),
        Row(f"{_LAW}.nu_100", "viscosity at 100 °C", "mm^2/s", (1e-6, 2e-3)),
        Row(f"{_LAW}.eta_0", "viscosity η₀", "Pa s;mPa s", "viscosity eta_0"),
        _even(
            f"{_LAW}.alpha",
            "pressure coefficient α",
            "1/GPa",
            (5e-9, 40e-9),
            _has_slope,
            "pressure_coefficient",
        ),
        _even(f"{_LAW}.gamma", "temperature coefficient γ", "1/K", (0.005, 0.12)),
        _inlet("lubricant.temperature", "oil at the inlet", when=_is_at_inlet),
        _inlet("thermal.temperature", "oil at the inlet", when=_is_at_inlet),
        choices.shear,
        Row(f"{_SHEAR}.stress", "Eyring stress τ₀", "MPa", (1e5, 5e7), _is_eyring),
        Row(f"{_SHEAR}.modulus", "Carreau modulus", "MPa", (1e4, 1e8)),
        _even(f"{_SHEAR}.slope", "limiting stress over pressure", "", (0.02, 0.15)),
    ),
    "Heat": (
        choices.heat,
        _inlet("surface_1.temperature", "bulk of body 1", when=_has_stated_bodies),
        _inlet("surface_2.temperature", "bulk of body 2", when=_has_stated_bodies),
        _even(
            "lubricant.conductivity", "conductivity of the oil", "W/m/K", (0.05, 0.7), _is_heated
        ),
        _even(
            "lubricant.heat_capacity",
            "heat capacity of the oil",
            "J/kg/K",
            (800.0, 4300.0),
            _is_heated,
        ),
    ),
    "Surfaces": (
        *_surface(1),
        *_surface(2),
        choices.moves,
    ),
    "Supply and asperities": (
        choices.supply,
        Row("supply.layer", "layer", "um;nm", (1e-8, 1e-5)),
        _even("supply.ratio", "oil over that of the flooded one", "", (0.05, 2.0)),
        choices.asperities,
        Row("asperities.rms", "Rq of both", "um;nm", (1e-8, 2e-6)),
        Row("asperities.summit_radius", "summit radius β", "um", (1e-6, 1e-4)),
        _even("asperities.friction", "friction of asperities", "", (0.0, 0.3)),
    ),
}
