"""The controls of a case, grouped as a person thinks; each one edits one key of its text.

What a number is, and which units it may have, is that of the field of the model at its path. A
`Row` adds what a page needs: label, units to choose from, sane range, and when it is shown.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

from tehl.api.problem import ContactProblem
from tehl.base.units import Number, quantity
from tehl.contact.options import Options
from tehl.explore import choices
from tehl.explore.case_text import CaseText
from tehl.explore.choices import State
from tehl.explore.knobs import Choice, Group, Knob, Span
from tehl.io.case import found_at

_LOW = "₀₁₂"
"""Digits set low."""


class Row(NamedTuple):
    """A number of the case as a row of the table of controls.

    It is shown where ``when`` holds and the case has a finite number. ``#`` in path and label is
    the number of a surface, ``₀`` in the label its number set low.
    """

    path: str
    label: str
    units: str = ""
    """To choose from, separated by semicolons."""
    span: Span | str = (0.0, 1.0)
    """Sane range in SI, or the name of a typical range."""
    when: Callable[[State, str], bool] | None = None
    """Takes the case and the path."""
    value: Callable[[State], float] | None = None
    """The value where the text states none, if it is not that of the checked case."""
    is_log: bool = True
    per_half_width: bool = False
    """Whether the range is in half-widths of the contact."""

    def of_surface(self, number: int) -> "Row":
        """Return the row of a surface."""
        path, label = (text.replace("#", str(number)) for text in (self.path, self.label))
        return self._replace(path=path, label=label.replace("₀", _LOW[number]))

    def knobs(self, state: State) -> Iterator[Knob]:
        """Yield the control, if the case has the number."""
        stated = state.case.get(self.path)
        value, kind = found_at(state.problem, Options(), self.path)
        if isinstance(value, float) and kind is None:
            kind = quantity(Number)
        if kind is None or (self.when is not None and not self.when(state, self.path)):
            return
        names = tuple(self.units.split(";"))
        unit = names[0]
        if isinstance(stated, str):
            words = stated.strip().lstrip("+-0123456789.eE").strip()
            unit = next((name for name in names if name == words.replace("°C", "degC")), unit)
        if stated is not None and not isinstance(value, str):  # alpha = "estimated"
            value = kind.parse(stated)
        elif self.value is not None:
            value = self.value(state)
        if value is not None and math.isfinite(value):
            span = self._span(state)
            yield Knob(self.path, self.label, kind, names, span, value, unit, self.is_log)

    def _span(self, state: State) -> Span:
        if isinstance(self.span, str):
            typical = state.typical[self.span]
            factor = {"GPa": 1e9, "1/GPa": 1e-9}.get(typical.unit, 1.0)
            return typical.low * factor, typical.high * factor
        factor = state.problem.hertz.half_width_x if self.per_half_width else 1.0
        return self.span[0] * factor, self.span[1] * factor


_even = partial(Row, is_log=False)
"""A row whose slider is not logarithmic."""
_wide = partial(Row, per_half_width=True)
"""A row whose range is in half-widths."""
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


# ---- when a number is shown, and its value where the text states none


def _is_stated(state: State, path: str) -> bool:
    return state.has(path)


def _in_own_table(state: State, path: str) -> bool:
    return state.has(path.rpartition(".")[0], Mapping)


def _is_heated(state: State, path: str) -> bool:
    """Return whether there is heat, and the number is not a law of pressure and temperature."""
    return state.problem.thermal is not None and not state.has(path, Mapping)


def _is_at_inlet(state: State, path: str) -> bool:
    """Return whether the oil depends on temperature, and that of the inlet stands at this path."""
    in_heat = state.has("thermal.temperature")
    return state.law.temperature_coefficient > 0 and in_heat == path.startswith("thermal.")


def _has_slope(state: State, path: str) -> bool:
    laws = ("roelands", "roelands-exponential", "barus", "walther")
    return state.law.law in laws and not state.has(path.replace(".alpha", ".z"))


def _is_eyring(state: State, _: str) -> bool:
    return state.oil.shear.law == "eyring"


def _is_smooth(state: State, path: str) -> bool:
    table = path.partition(".")[0]
    return state.roughness_of(table) == "smooth" and not state.has(f"{table}.ra_roughness")


def _is_rough(state: State, path: str, *, kind: str) -> bool:
    return state.roughness_of(path.partition(".")[0]) == kind


def _zero(_: State) -> float:
    return 0.0


def _inlet(state: State) -> float:
    return state.problem.inlet_temperature


def _slope(state: State) -> float:
    return state.problem.pressure_coefficient


# ---- the table


def _both(*items: Any) -> tuple[Item, ...]:
    """Return rows and choices of surface 1, then those of surface 2."""
    return tuple(
        item.of_surface(n) if isinstance(item, Row) else partial(item, number=n)
        for n in (1, 2)
        for item in items
    )


def _rough(kind: str, *rows: Row) -> tuple[Row, ...]:
    """Return the rows of a type of roughness, with paths from the table of the surface on."""
    when = partial(_is_rough, kind=kind)
    return tuple(
        row._replace(path=f"surface_#.roughness.{row.path}", when=when, value=_zero) for row in rows
    )


_LENGTHS, _WARM, _RADII = "mm;m", (253.15, 433.15), (1e-4, 5.0)
_LAW, _SOLID, _SHEAR = "lubricant.viscosity", "surface_#.material", "lubricant.shear"
_OPEN = ("Load and speed", "Bodies and geometry", "Oil")
_GROUPS: dict[str, tuple[Item, ...]] = {
    "Load and speed": (
        choices.load,
        Row("contact.load", "load", "N;kN", (0.1, 1e5)),
        Row("contact.hertz_pressure", "Hertz pressure", "GPa;MPa", "Hertz pressure"),
        Row("contact.moes_load", "Moes M", "", "Moes M"),
        choices.speed,
        Row("contact.moes_speed", "Moes L", "", (0.1, 25.0)),
        Row("contact.entrainment_speed", "entrainment speed", "m/s;mm/s", "entrainment speed"),
        _even("contact.slide_roll_ratio", "slide-to-roll ratio", "", (-2.0, 2.0)),
    ),
    "Bodies and geometry": (
        *_both(
            choices.material,
            Row(f"{_SOLID}.young_modulus", "modulus E₀", "GPa;MPa", (1e9, 1.2e12), _in_own_table),
            _even(f"{_SOLID}.poisson_ratio", "Poisson ratio ν₀", "", (0.0, 0.5), _in_own_table),
        ),
        choices.shape,
        Row("contact.radius", "reduced radius R", _LENGTHS, _RADII),
        Row("contact.radius_x", "reduced radius R_x, along entrainment", _LENGTHS, _RADII),
        Row("contact.radius_y", "reduced radius R_y, across entrainment", _LENGTHS, _RADII),
        *_both(
            Row("surface_#.radius", "radius of body #", _LENGTHS, _RADII),
            Row("surface_#.radius_x", "radius x of body #", _LENGTHS, _RADII),
            Row("surface_#.radius_y", "radius y of body #", _LENGTHS, _RADII),
        ),
    ),
    "Oil": (
        choices.oil,
        Row(f"{_LAW}.nu_40", "viscosity at 40 °C", "mm^2/s", (1e-6, 2e-3)),
        Row(f"{_LAW}.nu_100", "viscosity at 100 °C", "mm^2/s", (1e-6, 2e-3)),
        Row(f"{_LAW}.eta_0", "viscosity η₀", "Pa s;mPa s", "viscosity eta_0"),
        _even(
            f"{_LAW}.alpha", "pressure coefficient α", "1/GPa", (5e-9, 40e-9), _has_slope, _slope
        ),
        _even(f"{_LAW}.gamma", "temperature coefficient γ", "1/K", (0.005, 0.12)),
        _even("lubricant.temperature", "oil at the inlet", "degC;K", _WARM, _is_at_inlet, _inlet),
        _even("thermal.temperature", "oil at the inlet", "degC;K", _WARM, _is_at_inlet, _inlet),
        choices.shear,
        Row(f"{_SHEAR}.stress", "Eyring stress τ₀", "MPa", (1e5, 5e7), _is_eyring),
        Row(f"{_SHEAR}.modulus", "Carreau modulus", "MPa", (1e4, 1e8)),
        _even(f"{_SHEAR}.slope", "limiting stress over pressure", "", (0.02, 0.15)),
    ),
    "Heat": (
        choices.heat,
        *_both(
            _even("surface_#.temperature", "bulk of body #", "degC;K", _WARM, _is_heated, _inlet)
        ),
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
        *_both(
            choices.surface,
            _even(
                "surface_#.rms_roughness",
                "Rq of surface #, for λ",
                "um;nm",
                (0.0, 1e-6),
                _is_smooth,
                _zero,
            ),
            *_rough(
                "wave",
                Row("amplitude", "amplitude", "um;nm", (1e-9, 1e-6)),
                _wide("wavelength", "wavelength", "um;mm", (0.15, 4.0)),
                _even("angle", "angle of the crests", "deg", (0.0, 0.5 * math.pi)),
            ),
            *_rough(
                "bump",
                _even("amplitude", "height, negative is a dent", "um;nm", (-1e-6, 1e-6)),
                _wide("radius", "radius", "um;mm", (0.1, 1.5)),
                _wide("x", "place x", "um;mm", (-4.0, 2.0), is_log=False),
            ),
            *_rough(
                "random",
                Row("rms", "Rq", "nm;um", (1e-9, 2e-7)),
                _wide("correlation_length", "correlation length", "um;mm", (0.08, 1.0)),
            ),
        ),
        choices.moves,
    ),
    "Supply and asperities": (
        choices.supply,
        Row("supply.layer", "layer", "um;nm", (1e-8, 1e-5)),
        _even("supply.ratio", "oil over that of the flooded one", "", (0.05, 2.0)),
        choices.asperities,
        Row("asperities.rms", "Rq of both", "um;nm", (1e-8, 2e-6), _is_stated),
        Row("asperities.summit_radius", "summit radius β", "um", (1e-6, 1e-4)),
        _even("asperities.friction", "friction of asperities", "", (0.0, 0.3)),
    ),
}
