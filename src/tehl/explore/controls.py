"""The controls of a case, grouped as a person thinks; each one edits one key of its text."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.base.named import read_tables
from tehl.base.units import (
    Angle,
    Conductivity,
    Force,
    HeatCapacity,
    Height,
    KinematicViscosity,
    Length,
    Number,
    Place,
    PositiveNumber,
    Pressure,
    PressureCoefficient,
    Quantity,
    Radius,
    Ratio,
    Speed,
    Stress,
    Temperature,
    TemperatureCoefficient,
    Viscosity,
    quantity,
)
from tehl.contact.materials import SOLIDS
from tehl.contact.problem import SURFACES
from tehl.estimate.scaling import ScaledProblem
from tehl.explore.case_text import CaseText, named_table
from tehl.lubricant.fluid import OILS
from tehl.report.plausibility import Typical, typical_ranges

_DECADE = 10.0
"""A logarithmic slider reaches from a tenth of its value to ten times it."""
OWN = "own values"
_LOW = "₀₁₂"
"""Digits set low."""
Change = Callable[[CaseText, str], None]
Span = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Knob:
    """A number with its unit: slider, exact entry, selector of the unit."""

    path: str
    """Dotted key of the case."""
    label: str
    kind: Quantity
    units: tuple[str, ...]
    """Units to choose from; ``""`` alone for plain numbers."""
    span: Span
    """Sane range, SI."""
    value: float
    """SI."""
    unit: str = ""
    """The unit that is shown."""
    is_log: bool = True

    def number(self, value: float, unit: str) -> float:
        """Return an SI value in a unit."""
        return value - 273.15 if unit == "degC" else value / self._factor(unit)

    def si(self, number: float, unit: str) -> float:
        """Return a number in a unit in SI."""
        return number + 273.15 if unit == "degC" else number * self._factor(unit)

    def _factor(self, unit: str) -> float:
        return self.kind.parse(f"1 {unit}") if unit and unit != "degC" else 1.0

    def stated(self, number: float, unit: str) -> str | float:
        """Return what the case states: a number with its unit, or a plain number."""
        if not unit:
            return float(f"{number:.6g}")
        return f"{number:.6g} {unit}"

    def reach(self, value: float) -> Span:
        """Return the range of the slider around a value, SI; a logarithmic one keeps its sign."""
        low, high = self.span
        if self.is_log and value < 0:
            low, high = self.reach(-value)
            return -high, -low
        if self.is_log and value > 0:
            return max(min(low, value), value / _DECADE), min(max(high, value), value * _DECADE)
        return min(low, value), max(high, value)

    def part(self, value: float, reach: Span) -> float:
        """Return where a value lies in a range, from 0 to 1."""
        low, high = reach
        value = min(max(value, low), high)
        if self.spreads(reach):
            return math.log(value / low) / math.log(high / low)
        return (value - low) / (high - low)

    def at(self, part: float, reach: Span) -> float:
        """Return the value at a part of a range, the inverse of `part`."""
        low, high = reach
        return low * (high / low) ** part if self.spreads(reach) else low + part * (high - low)

    def spreads(self, reach: Span) -> bool:
        """Return whether a slider over a range is logarithmic: it has one sign."""
        return self.is_log and reach[0] * reach[1] > 0


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several words."""

    path: str
    label: str
    options: Mapping[str, str]
    """What is shown, by what is chosen."""
    value: str
    change: Change
    """Applies a choice to the text."""


@dataclass(frozen=True, slots=True)
class Group:
    """Controls that belong together."""

    name: str
    items: tuple[Knob | Choice, ...]
    is_open: bool = field(default=False)


def groups(case: CaseText, problem: ContactProblem) -> tuple[Group, ...]:
    """Return the controls of a case that states ``problem``."""
    made = _Maker(case, problem)
    return (
        Group("Load and speed", tuple(made.load_and_speed()), True),
        Group("Bodies and geometry", tuple(made.bodies()), True),
        Group("Oil", tuple(made.oil()), True),
        Group("Heat", tuple(made.heat())),
        Group("Surfaces", tuple(made.surfaces())),
        Group("Supply and asperities", (*made.supply(), *made.asperities())),
    )


def swept_knobs(found: tuple[Group, ...]) -> dict[str, Knob]:
    """Return the controls that can be swept, by their paths."""
    return {item.path: item for group in found for item in group.items if isinstance(item, Knob)}


class _Maker:
    """Makes the controls of one case."""

    def __init__(self, case: CaseText, problem: ContactProblem) -> None:
        self.case, self.problem = case, problem
        scaled = ScaledProblem.of(problem)
        self.typical = {one.name: one for one in typical_ranges(scaled)}

    def knob(  # noqa: PLR0913 (a row of a table)
        self,
        path: str,
        label: str,
        kind: Any,
        units: str,
        span: Span | str,
        value: float | None = None,
        *,
        is_log: bool = True,
    ) -> Knob:
        """Return a knob with the value and the unit of the text, or a value that follows."""
        wanted, names = quantity(kind), tuple(units.split(";")) if units else ("",)
        stated, unit = self.case.get(path), names[0]
        if isinstance(stated, str):
            words = stated.strip().lstrip("+-0123456789.eE").strip()
            unit = next((name for name in names if name == words.replace("°C", "degC")), unit)
        if stated is not None:
            value = wanted.parse(stated)
        if isinstance(span, str):
            span = _range_of(self.typical[span])
        at = span[0] if value is None else value
        return Knob(path, label, wanted, names, span, at, unit, is_log)

    # ---- load and speed

    def load_and_speed(self) -> Iterator[Knob | Choice]:
        problem, contact = self.problem, self.problem.contact
        groups = ScaledProblem.of(problem).groups
        loads = {
            "load": ("load", f"{problem.load:.5g} N"),
            "hertz_pressure": ("Hertz pressure", f"{problem.hertz.pressure * 1e-9:.5g} GPa"),
            "moes_load": ("Moes M", float(f"{groups.M:.5g}")),
        }
        chosen = next(key for key in loads if getattr(contact, key) is not None)
        yield self.one_of("contact", "load given as", loads, chosen)
        if chosen == "load":
            yield self.knob("contact.load", "load", Force, "N;kN", (0.1, 1e5))
        elif chosen == "hertz_pressure":
            label = "Hertz pressure"
            yield self.knob("contact.hertz_pressure", label, Pressure, "GPa;MPa", "Hertz pressure")
        else:
            yield self.knob("contact.moes_load", "Moes M", PositiveNumber, "", "Moes M")
        speeds = {
            "entrainment_speed": ("entrainment speed", f"{problem.entrainment_speed:.5g} m/s"),
            "moes_speed": ("Moes L", float(f"{groups.L:.5g}")),
        }
        chosen = next(key for key in speeds if getattr(contact, key) is not None)
        yield self.one_of("contact", "speed given as", speeds, chosen)
        if chosen == "moes_speed":
            yield self.knob("contact.moes_speed", "Moes L", PositiveNumber, "", (0.1, 25.0))
        else:
            label = "entrainment speed"
            yield self.knob(
                "contact.entrainment_speed", label, Speed, "m/s;mm/s", "entrainment speed"
            )
        label = "slide-to-roll ratio"
        path = "contact.slide_roll_ratio"
        yield self.knob(path, label, Number, "", (-2.0, 2.0), 0.0, is_log=False)

    def one_of(
        self, table: str, label: str, keys: dict[str, tuple[str, Any]], chosen: str
    ) -> Choice:
        """Return the choice of one of several keys of a table; the contact stays the same."""

        def change(case: CaseText, key: str) -> None:
            for other in keys:
                case.set(f"{table}.{other}", None)
            case.set(f"{table}.{key}", keys[key][1])

        names = {key: name for key, (name, _) in keys.items()}
        return Choice(f"{table}.{'|'.join(keys)}", label, names, chosen, change)

    # ---- bodies and geometry

    def bodies(self) -> Iterator[Knob | Choice]:
        for number, key in enumerate(SURFACES, 1):
            yield from self.material(key, number)
        yield self.shape()
        contact = self.problem.contact
        if contact.radius is not None:
            yield self.knob("contact.radius", "reduced radius R", Length, "mm;m", (1e-4, 5.0))
        elif contact.radius_x is not None:
            for axis, along in (("x", "along"), ("y", "across")):
                label = f"reduced radius R_{axis}, {along} entrainment"
                yield self.knob(f"contact.radius_{axis}", label, Length, "mm;m", (1e-4, 5.0))
        else:
            yield from self.radii()

    def radii(self) -> Iterator[Knob]:
        for number, key in enumerate(SURFACES, 1):
            for axis in ("", "_x", "_y"):
                value = getattr(getattr(self.problem, key), f"radius{axis}")
                if value is not None and math.isfinite(value):
                    name = f"radius{axis.replace('_', ' ')} of body {number}"
                    yield self.knob(f"{key}.radius{axis}", name, Radius, "mm;m", (1e-4, 5.0))

    def shape(self) -> Choice:
        radii = self.problem.radii
        names = {
            "bodies": "radii of both",
            "circle": "reduced radius",
            "ellipse": "two reduced radii",
        }
        contact = self.problem.contact
        chosen = (
            "circle" if contact.radius else "ellipse" if contact.radius_x is not None else "bodies"
        )

        def change(case: CaseText, choice: str) -> None:
            for key in ("contact", *SURFACES):
                for name in ("radius", "radius_x", "radius_y"):
                    case.set(f"{key}.{name}", None)
            for path, value in _radii_as(choice, radii.x, radii.y).items():
                case.set(path, value)

        return Choice("contact.radius|", "shape given by", names, chosen, change)

    def material(self, key: str, number: int) -> Iterator[Knob | Choice]:
        path, stated = f"{key}.material", self.case.get(f"{key}.material")
        names = {name: name.replace("-", " ") for name in read_tables(SOLIDS)} | {OWN: OWN}
        chosen = OWN if isinstance(stated, Mapping) else self.solid_name(key)

        def change(case: CaseText, choice: str) -> None:
            if choice != OWN:
                case.set(path, choice)
            elif isinstance(name := case.get(path), str):
                case.set(path, named_table("material", name))

        yield Choice(path, f"body {number}", names, chosen, change)
        if isinstance(stated, Mapping):
            label = f"modulus E{_LOW[number]}"
            yield self.knob(f"{path}.young_modulus", label, Pressure, "GPa;MPa", (1e9, 1.2e12))
            label = f"Poisson ratio ν{_LOW[number]}"
            yield self.knob(f"{path}.poisson_ratio", label, Number, "", (0.0, 0.5), is_log=False)

    def solid_name(self, key: str) -> str:
        return getattr(self.problem, key).material.name or OWN

    # ---- oil

    def oil(self) -> Iterator[Knob | Choice]:
        yield self.oil_choice()
        law = self.problem.lubricant.viscosity
        path = "lubricant.viscosity"
        if law.law == "walther":
            for key, label in (("nu_40", "viscosity at 40 °C"), ("nu_100", "viscosity at 100 °C")):
                value = getattr(law, key)
                span = (1e-6, 2e-3)
                yield self.knob(f"{path}.{key}", label, KinematicViscosity, "mm^2/s", span, value)
        elif hasattr(law, "eta_0"):
            span = _range_of(self.typical["viscosity eta_0"])
            yield self.knob(
                f"{path}.eta_0", "viscosity η₀", Viscosity, "Pa s;mPa s", span, law.eta_0
            )
        if law.law in ("roelands", "roelands-exponential", "barus", "walther"):
            alpha = self.problem.pressure_coefficient
            if self.case.get(f"{path}.z") is None:
                yield self.knob(
                    f"{path}.alpha",
                    "pressure coefficient α",
                    PressureCoefficient,
                    "1/GPa",
                    (5e-9, 40e-9),
                    alpha,
                    is_log=False,
                )
        if getattr(law, "gamma", None) is not None:
            yield self.knob(
                f"{path}.gamma",
                "temperature coefficient γ",
                TemperatureCoefficient,
                "1/K",
                (0.005, 0.12),
                law.gamma,  # type: ignore[union-attr]
                is_log=False,
            )
        yield from self.inlet()
        yield from self.shear()

    def inlet(self) -> Iterator[Knob]:
        in_thermal = self.case.get("thermal.temperature") is not None
        path = "thermal.temperature" if in_thermal else "lubricant.temperature"
        if self.problem.lubricant.viscosity.temperature_coefficient > 0:
            yield self.knob(
                path,
                "oil at the inlet",
                Temperature,
                "degC;K",
                (253.15, 433.15),
                self.problem.inlet_temperature,
                is_log=False,
            )

    def oil_choice(self) -> Choice:
        stated = self.case.get("lubricant")
        names = {name: _oil_label(name) for name in read_tables(OILS)}
        names |= {"sheet": "data sheet", OWN: OWN}
        chosen = OWN
        if isinstance(stated, str) or (isinstance(stated, Mapping) and "viscosity" not in stated):
            chosen = self.problem.lubricant.name or OWN
        elif self.problem.lubricant.viscosity.law == "walther":
            chosen = "sheet"
        shear = self.case.get("lubricant.shear")

        def change(case: CaseText, choice: str) -> None:
            if choice == "sheet":
                name = chosen if chosen.startswith("iso-vg") else "iso-vg-68"
                case.set("lubricant", named_table("lubricant", name))
            elif choice == OWN:
                name = chosen if chosen in read_tables(OILS) else "mineral-oil"
                case.set("lubricant", named_table("lubricant", name))
            else:
                case.set("lubricant", choice)
            if shear is not None:
                case.set("lubricant.shear", shear)

        return Choice("lubricant", "oil", names, chosen, change)

    def shear(self) -> Iterator[Knob | Choice]:
        laws = {
            "newtonian": ({"law": "newtonian"}, "Newtonian"),
            "eyring": ({"law": "eyring", "stress": "5 MPa"}, "Eyring"),
            "carreau": ({"law": "carreau", "modulus": "6 MPa", "exponent": 0.42}, "Carreau"),
            "limiting": ({"law": "limiting", "slope": 0.05}, "limiting stress"),
        }
        law, path = self.problem.lubricant.shear, "lubricant.shear"

        def change(case: CaseText, choice: str) -> None:
            case.set(path, laws[choice][0])

        names = {key: name for key, (_, name) in laws.items()}
        yield Choice(path, "shear law", names, law.law, change)
        if law.law == "eyring":
            yield self.knob(
                f"{path}.stress", "Eyring stress τ₀", Stress, "MPa", (1e5, 5e7), law.stress
            )
        elif law.law == "carreau":
            yield self.knob(
                f"{path}.modulus", "Carreau modulus", Stress, "MPa", (1e4, 1e8), law.modulus
            )
        elif law.law == "limiting":
            label = "limiting stress over pressure"
            yield self.knob(
                f"{path}.slope", label, Ratio, "", (0.02, 0.15), law.slope, is_log=False
            )

    # ---- heat

    def heat(self) -> Iterator[Knob | Choice]:
        heated = self.problem.thermal is not None

        def change(case: CaseText, choice: str) -> None:
            if choice == "off":
                _switch_heat_off(case)
            else:
                _switch_heat_on(case, self.problem)

        names = {"off": "isothermal", "on": "computed"}
        yield Choice("thermal", "heat", names, "on" if heated else "off", change)
        if not heated:
            return
        for number, key in enumerate(SURFACES, 1):
            label, inlet = f"bulk of body {number}", self.problem.inlet_temperature
            value = getattr(self.problem, key).temperature
            yield self.knob(
                f"{key}.temperature",
                label,
                Temperature,
                "degC;K",
                (253.15, 433.15),
                inlet if value is None else value,
                is_log=False,
            )
        oil = self.problem.lubricant
        for key, label, kind, units, span in (
            ("conductivity", "conductivity of the oil", Conductivity, "W/m/K", (0.05, 0.7)),
            ("heat_capacity", "heat capacity of the oil", HeatCapacity, "J/kg/K", (800.0, 4300.0)),
        ):
            value = getattr(oil, f"ambient_{key}")
            if not isinstance(self.case.get(f"lubricant.{key}"), Mapping):
                path = f"lubricant.{key}"
                yield self.knob(path, label, kind, units, span, value, is_log=False)

    # ---- surfaces

    def surfaces(self) -> Iterator[Knob | Choice]:
        for number, key in enumerate(SURFACES, 1):
            yield from self.surface(key, number)
        if not self.problem.is_rough and self.problem.transient is None:
            return

        def change(case: CaseText, choice: str) -> None:
            case.set("transient", {"frames": 41} if choice == "moves" else None)

        names = {"stands": "stands still", "moves": "moves along"}
        chosen = "stands" if self.problem.transient is None else "moves"
        yield Choice("transient", "roughness", names, chosen, change)

    def surface(self, key: str, number: int) -> Iterator[Knob | Choice]:
        path, stated = f"{key}.roughness", self.case.get(f"{key}.roughness")
        half = self.problem.hertz.half_width_x * 1e6
        kinds = {
            "smooth": (None, "smooth"),
            "wave": (
                {"type": "wave", "amplitude": "0.1 um", "wavelength": f"{0.5 * half:.3g} um"},
                "wave",
            ),
            "bump": (
                {"type": "bump", "amplitude": "-0.2 um", "radius": f"{0.25 * half:.3g} um"},
                "dent or bump",
            ),
            "random": (
                {
                    "type": "random",
                    "rms": "20 nm",
                    "correlation_length": f"{0.15 * half:.3g} um",
                    "seed": 1,
                },
                "random",
            ),
        }
        names = {kind: name for kind, (_, name) in kinds.items()}
        chosen = "smooth"
        if stated is not None:
            chosen = stated.get("type", "other") if isinstance(stated, Mapping) else "other"
            others = {"map": "measured surface", "other": "as in the file"}
            names |= {chosen: others.get(chosen, chosen)} if chosen not in names else {}

        def change(case: CaseText, choice: str) -> None:
            if choice in kinds:
                case.set(path, kinds[choice][0])
                if choice != "smooth":
                    case.set(f"{key}.rms_roughness", None)
                    case.set(f"{key}.ra_roughness", None)
                _end_transient(case)

        yield Choice(path, f"surface {number}", names, chosen, change)
        yield from self.heights(key, path, chosen, number)

    def heights(self, key: str, path: str, chosen: str, number: int) -> Iterator[Knob]:
        half = self.problem.hertz.half_width_x
        if chosen == "smooth":
            label, value = (
                f"Rq of surface {number}, for λ",
                getattr(self.problem, key).rms_roughness,
            )
            if self.case.get(f"{key}.ra_roughness") is None:
                yield self.knob(
                    f"{key}.rms_roughness", label, Height, "um;nm", (0.0, 1e-6), value, is_log=False
                )
        table = {
            "wave": (
                ("amplitude", "amplitude", Height, "um;nm", (1e-9, 1e-6)),
                ("wavelength", "wavelength", Length, "um;mm", (0.15 * half, 4.0 * half)),
                ("angle", "angle of the crests", Angle, "deg", (0.0, 0.5 * math.pi)),
            ),
            "bump": (
                ("amplitude", "height, negative is a dent", Place, "um;nm", (-1e-6, 1e-6)),
                ("radius", "radius", Length, "um;mm", (0.1 * half, 1.5 * half)),
                ("x", "place x", Place, "um;mm", (-4.0 * half, 2.0 * half)),
            ),
            "random": (
                ("rms", "Rq", Height, "nm;um", (1e-9, 2e-7)),
                ("correlation_length", "correlation length", Length, "um;mm", (0.08 * half, half)),
            ),
        }
        for name, label, kind, units, span in table.get(chosen, ()):
            value = self.case.get(f"{path}.{name}")
            linear = name in ("angle", "x") or span[0] < 0
            yield self.knob(
                f"{path}.{name}",
                label,
                kind,
                units,
                span,
                None if value is not None else 0.0,
                is_log=not linear,
            )

    # ---- supply and asperities

    def supply(self) -> Iterator[Knob | Choice]:
        stated = self.problem.supply
        kinds: dict[str, tuple[Any, str]] = {
            "flooded": (None, "fully flooded"),
            "layer": ({"layer": "0.3 um"}, "layer"),
            "ratio": ({"ratio": 0.6}, "share of flooded"),
        }
        chosen = "flooded"
        if stated is not None:
            chosen = "layer" if stated.layer is not None else "ratio"
            chosen = "profile" if stated.profile is not None else chosen
        names = {kind: name for kind, (_, name) in kinds.items()}
        names |= {"profile": "profile over y"} if chosen == "profile" else {}

        def change(case: CaseText, choice: str) -> None:
            if choice in kinds:
                case.set("supply", kinds[choice][0])

        yield Choice("supply", "oil supply", names, chosen, change)
        if chosen == "layer":
            yield self.knob("supply.layer", "layer", Height, "um;nm", (1e-8, 1e-5))
        elif chosen == "ratio":
            label = "oil over that of the flooded one"
            yield self.knob("supply.ratio", label, Ratio, "", (0.05, 2.0), is_log=False)

    def asperities(self) -> Iterator[Knob | Choice]:
        stated, problem = self.problem.asperities, self.problem
        model = None if stated is None else stated.model

        def change(case: CaseText, choice: str) -> None:
            if choice == "none":
                case.set("asperities", None)
            elif choice == "greenwood-tripp":
                case.set("asperities", _summits(problem))

        names = {"none": "not computed", "greenwood-tripp": "Greenwood-Tripp"}
        names |= {"surface": "measured patch"} if model == "surface" else {}
        yield Choice("asperities", "asperities", names, model or "none", change)
        if stated is None:
            return
        if model == "greenwood-tripp":
            if self.case.get("asperities.rms") is not None:
                yield self.knob("asperities.rms", "Rq of both", Height, "um;nm", (1e-8, 2e-6))
            yield self.knob(
                "asperities.summit_radius", "summit radius β", Length, "um", (1e-6, 1e-4)
            )
        label = "friction of asperities"
        friction = stated.friction
        yield self.knob("asperities.friction", label, Ratio, "", (0.0, 0.3), friction, is_log=False)


def _range_of(typical: Typical) -> Span:
    """Return a typical range in SI: of positive numbers that begin at zero, from a hundredth."""
    factors = {"GPa": 1e9, "1/GPa": 1e-9}
    factor = factors.get(typical.unit, 1.0)
    return typical.low * factor, typical.high * factor


def _radii_as(choice: str, x: float, y: float) -> dict[str, str]:
    """Return the keys that state reduced radii [m] in one of the ways."""
    along, across = f"{1e3 * x:.6g} mm", f"{1e3 * y:.6g} mm"
    if choice == "circle":
        return {"contact.radius": along}
    if choice == "ellipse":
        return {"contact.radius_x": along, "contact.radius_y": across}
    flat = {"surface_2.radius": "inf"}
    if math.isclose(x, y, rel_tol=1e-6):
        return {"surface_1.radius": along, **flat}
    return {"surface_1.radius_x": along, "surface_1.radius_y": across, **flat}


def _oil_label(name: str) -> str:
    return name.replace("iso-vg-", "ISO VG ").replace("-", " ")


def _end_transient(case: CaseText) -> None:
    """Leave a transient run out in which nothing changes any more."""
    stated = case.get("transient")
    rough = any(case.get(f"{key}.roughness") for key in SURFACES)
    if isinstance(stated, Mapping) and not (rough or {"load", "duration"} & set(stated)):
        case.set("transient", None)


def _switch_heat_off(case: CaseText) -> None:
    """Leave the heat out; the oil keeps the temperature of the inlet."""
    inlet = case.get("thermal.temperature")
    case.set("thermal", None)
    for key in SURFACES:
        case.set(f"{key}.temperature", None)
    if inlet is not None:
        case.set("lubricant.temperature", inlet)


def _switch_heat_on(case: CaseText, problem: ContactProblem) -> None:
    """Add the heat, and the properties of an average mineral oil where they are not stated."""
    case.set("thermal", {})
    oil = problem.lubricant
    if oil.conductivity is None:
        case.set("lubricant.conductivity", "0.14 W/m/K")
    if oil.heat_capacity is None:
        case.set("lubricant.heat_capacity", "2000 J/kg/K")
    if not oil.viscosity.temperature_coefficient > 0 and hasattr(oil.viscosity, "gamma"):
        case.set("lubricant.viscosity.gamma", "0.042 1/K")


def _summits(problem: ContactProblem) -> dict[str, Any]:
    found: dict[str, Any] = {
        "model": "greenwood-tripp",
        "summit_radius": "10 um",
        "summit_density": "2e10 1/m^2",
        "friction": 0.1,
    }
    if not problem.rms_roughness > 0:
        found["rms"] = "0.2 um"
    return found
