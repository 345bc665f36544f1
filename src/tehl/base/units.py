"""Units at the border: ``"0.5 GPa"`` becomes ``5e8``; behind this module everything is SI.

A quantity is a number with a unit, or a bare number, which is SI. The annotated types at the end
(``Length``, ``Pressure``, ...) make a pydantic field read both, and describe themselves in the
JSON schema.
"""

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, Literal

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tehl.base.unit_table import ANGLE_UNITS, FORCE, MASS, NONE, TEMPERATURES, UNITS, Dimension

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_TURNING = re.compile(r"(?:rpm|RPM|r/min|rev/min|U/min|1?/min|min\^?-1|min⁻¹)(?![\w/^*])")
_FLAT = "|[+]?inf"
"""What the schema of a radius allows beside numbers."""
_GROUP = re.compile(r"\(([^()]*)\)")
_FACTOR = re.compile(
    r"\s*([*/·.]?)\s*(<\d+>|[+-]?\d+|[A-Za-zµμ°%]+|-|)"
    r"(?:\s*(?:\^|\*\*)\s*([+-]?\d*)|(?<=[A-Za-z])([+-]?\d))?"  # m^3, or m3 as data sheets have
)
_SUPERSCRIPTS = str.maketrans({"²": "^2", "³": "^3", "⁻": "-", "¹": "1"})
_LOOKALIKES = str.maketrans({"−": "-", "℃": "°C", "º": "°", "∞": "inf"})
"""Signs that texts and spreadsheets have in place of those on keyboards."""
_WRONG_NUMBERS = (
    (r",\d", "a comma in its number: write a decimal point, and no mark between thousands"),
    (r"\d{3}\b", "a space in its number, leave it out"),
    (r"['’]\d{3}\b", "a mark between its thousands, leave it out"),
    (r"\s*[x×·*]\s*10\s*(\^|\*\*|[-+⁻⁺])", "a power of ten apart: write it as in 2.2e-8"),
)
"""What may stand in place of a unit where a number is spelled wrongly, and what is wrong."""


def plain_signs(text: str) -> str:
    """Return a text with the signs of keyboards in place of those that look alike."""
    return re.sub(r"°\s+([CF])\b", r"°\1", text.translate(_LOOKALIKES))


def is_per_turn(text: str) -> bool:
    """Whether ``text`` is a unit of rotational speed, such as rpm or 1/min."""
    return _TURNING.fullmatch(text) is not None


@lru_cache(maxsize=256)
def is_unit(text: str) -> bool:
    """Whether ``text`` is a unit that quantities may have."""
    if not any(letter.isalpha() or letter == "%" for letter in text):
        return False
    if is_per_turn(text):
        return True
    try:
        _read_unit(text)
    except ValueError:
        return text in ("%", "degC")
    return True


@lru_cache(maxsize=512)  # lists state the same units in each row
def _read_unit(text: str) -> tuple[float, Dimension]:
    """Return factor to SI and dimension of a unit such as ``W/m/K`` or ``1/(Pa s)``.

    Innermost brackets first: each becomes a unit with the name ``<number>``.
    """
    units, plain = dict(UNITS), text.replace("⁻¹", "^-1").translate(_SUPERSCRIPTS)
    while (group := _GROUP.search(plain)) is not None:
        name = f"<{len(units)}>"
        units[name] = _product(group[1].strip(), units, text)
        plain = f"{plain[: group.start()]} {name}{plain[group.end() :]}"
    return _product(plain.strip(), units, text)


def _product(
    plain: str, units: dict[str, tuple[float, Dimension]], text: str
) -> tuple[float, Dimension]:
    """Return factor to SI and dimension of a product of powers without brackets."""
    factor, dimension, place = 1.0, NONE, 0
    while place == 0 or place < len(plain):
        match = _FACTOR.match(plain, place)
        assert match is not None  # each part is optional
        operator, name, power, digit = match.groups()
        power = digit or power
        if not (operator or name):
            fault = "a bracket left open in its" if "(" in plain else "an unreadable"
            raise ValueError(f"has {fault} unit {text!r}")
        if operator and name.isdigit() and name not in units:
            raise ValueError(f"has a calculation {text!r} after its number: work it out")
        if name not in units or (operator and place == 0):
            raise ValueError(f"has an unknown unit {name or text!r}")
        if power is not None and not re.fullmatch(r"[+-]?\d", power):
            raise ValueError(f"has an unreadable exponent in its unit {text!r}")
        exponent, sign = int(power or 1), -1 if operator == "/" else 1
        factor *= float(units[name][0] ** exponent) ** sign
        a, b, c, d = (
            one + sign * exponent * two for one, two in zip(dimension, units[name][1], strict=True)
        )
        dimension, place = (a, b, c, d), match.end()
    return factor, dimension


@dataclass(frozen=True, slots=True)
class Quantity:
    """An expected kind of number: dimension, sign and an example for messages.

    An instance is pydantic metadata: ``Annotated[float, Quantity(...)]``.
    """

    name: str
    """The kind in words, with its article: ``"a force"``."""
    unit: str
    """The SI unit; a bare number is in this unit."""
    example: str
    """A good value with a unit, shown in messages and in the schema."""
    sign: Literal["positive", "non-negative", "any"] = "positive"
    """Which values are possible."""
    flat: bool = False
    """Whether infinity is allowed (radius of a flat)."""
    most: float = math.inf
    """Value that no such quantity exceeds [SI]: a larger bare number is in another unit."""

    @property
    def dimension(self) -> Dimension:
        """Exponents of metre, kilogram, second, kelvin."""
        return _read_unit(self.unit)[1]

    def parse(self, value: object) -> float:
        """Return ``value``, a bare SI number or a number with its unit, in SI.

        Raises ValueError if it cannot be such a quantity; the message continues a sentence that
        begins with the name and the value: ``contact.load = "80 mm" ...``.
        """
        if isinstance(value, str):
            return self._check(self._read(plain_signs(value).strip()))
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"is not a number; {self.expected}")
        if abs(value) > 1e300:  # so that huge integers of a case file do not overflow
            return self._check(math.inf if value > 0 else -math.inf)
        if abs(value) > self.most:
            raise ValueError(f"is in {self.unit} as a bare number; {self.expected}")
        return self._check(float(value))

    def has_unit(self, text: str) -> bool:
        """Whether ``text`` is a unit of this kind of number."""
        try:
            self._factor(text)
        except ValueError:
            return False
        return True

    @property
    def is_share(self) -> bool:
        """Whether messages have it in per cent."""
        return "%" in self.example

    @property
    def expected(self) -> str:
        """How messages say what would be right: ``expected a force such as "80 N"``."""
        return f"expected {self.name} such as {self.example}"

    def _read(self, text: str) -> float:
        first, _, unit = text.partition(" ")
        if first.lstrip("+-").lower() in ("inf", "nan") and (not unit or self.has_unit(unit)):
            return float(first)
        match = _NUMBER.match(text)
        if match is None:
            raise ValueError(f"does not begin with a number; {self.expected}")
        number, unit = float(match.group()), text[match.end() :].strip()
        if not unit and self.unit != "-":
            raise ValueError(f"lacks a unit; {self.expected}, or a number in SI without quotes")
        if not unit:
            return number
        if self.unit == "K" and unit in TEMPERATURES:
            per_degree, zero = TEMPERATURES[unit]
            return number * per_degree + zero
        if turning := _TURNING.match(unit):
            return number * self._per_turn(unit, unit[turning.end() :].strip())
        factor = self._factor(f"1{unit}" if unit.startswith("/") else unit)  # 22/GPa
        return number if factor == 1.0 else float(f"{number * factor:.15g}")  # 22 1/GPa is 2.2e-8

    def _per_turn(self, unit: str, radius: str) -> float:
        """Return the speed [m/s] at a radius, or [rad/s], of one revolution per minute."""
        if self.unit == "rad/s" and not radius:
            return 2.0 * math.pi / 60.0
        if self.unit != "m/s":
            raise ValueError(f"has the unit of a rotational speed ({unit[:20]}); {self.expected}")
        at, _, length = radius.partition(" ")
        if at != "at":
            raise ValueError(
                f"has the unit of a rotational speed ({unit[:20]}): give the radius at which the "
                'surface moves too, such as "500 rpm at 40 mm", or a speed such as "1.5 m/s"'
            )
        return 2.0 * math.pi / 60.0 * quantity(Length).parse(length)

    def _factor(self, unit: str) -> float:
        """Return the factor from ``unit`` to SI."""
        factor, dimension = self._unit(unit)
        if self.unit == "-" and unit in ANGLE_UNITS:
            raise ValueError(f"has the unit of an angle ({unit}); {self.expected}")
        turns = any(one in unit for one in ANGLE_UNITS)
        if self.unit == "rad/s" and not turns:
            raise ValueError(f"has the unit of a frequency ({unit}); {self.expected}")
        if self.unit == "Hz" and turns:
            raise ValueError(f"has the unit of an angular velocity ({unit}); {self.expected}")
        if dimension != self.dimension:
            way = _CONVERSIONS.get((dimension, self.dimension))
            hint = "" if way is None else f" ({way})"
            raise ValueError(f"has the unit of {_kind(dimension, unit)}; {self.expected}{hint}")
        return factor

    def _unit(self, unit: str) -> tuple[float, Dimension]:
        """Return factor to SI and dimension of ``unit``, of this kind where it can be read so."""
        if len(unit) > 40:  # characters of a unit
            raise ValueError(f"has an unreadable unit; {self.expected}")
        if wrong := next((why for what, why in _WRONG_NUMBERS if re.match(what, unit)), None):
            raise ValueError(f"has {wrong}; {self.expected}")
        above, _, below = unit.partition("/")
        try:
            found = _read_unit(unit)
            if found[1] != self.dimension and below and "/" not in below:
                joined = _read_unit(f"{above}/({below})")  # data sheets have J/kg K
                found = joined if joined[1] == self.dimension else found
        except ValueError as error:
            alike = [one for one in UNITS if one.lower() == unit.lower()]
            near = " or ".join(one for one in alike if UNITS[one][1] == self.dimension)
            guess = f", did you mean {near}?" if near else ""
            raise ValueError(f"{error}{guess}; {self.expected}") from None
        return found

    def _check(self, number: float) -> float:
        if math.isnan(number):
            raise ValueError(f"is not a number; {self.expected}")
        if math.isinf(number) and not (self.flat and number > 0):
            raise ValueError(f"is not finite; {self.expected}")
        if self.unit == "K" and not number > 0:
            raise ValueError(f"is not above absolute zero; {self.expected}")
        if self.sign == "positive" and not number > 0:
            raise ValueError(f"must be positive; {self.expected}")
        if self.sign == "non-negative" and not number >= 0:
            raise ValueError(f"must not be negative; {self.expected}")
        if self.flat and number == 0:
            raise ValueError('must not be zero: a flat surface has the radius "inf"')
        return number

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Read by :meth:`parse` before pydantic sees a float."""
        del source, handler
        return core_schema.no_info_before_validator_function(
            self.parse,
            core_schema.float_schema(),
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda value: "inf" if math.isinf(value) else value, when_used="json-unless-none"
            ),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the field as a string with a unit, or an SI number."""
        del schema, handler
        number: JsonSchemaValue = {"type": "number"}
        if self.sign == "positive":
            number["exclusiveMinimum"] = 0
        elif self.sign == "non-negative":
            number["minimum"] = 0
        example = self.example.strip('"')
        sign = "[+-]?" if self.sign == "any" else "[+]?"
        unit = "" if self.unit == "-" else r"(\s+\S.*|[A-Za-zµμ°%].*)"
        pattern = rf"^\s*({sign}(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?{unit}{_FLAT * self.flat})\s*$"
        text: JsonSchemaValue = {"type": "string", "pattern": pattern, "examples": [example]}
        if self.unit == "-":
            return {
                "anyOf": [number | ({} if self.is_share else {"examples": [float(example)]}), text]
            }
        return {
            "anyOf": [text, number],
            "description": f"{self.name}; a bare number is in {self.unit}",
        }


def percentage(part: float) -> str:
    """Return two digits of ``part`` in per cent."""
    return f"{float(f'{100.0 * part:.2g}'):g} %"


def _kind(dimension: Dimension, unit: str) -> str:
    if dimension == NONE:
        return f"an angle ({unit})" if unit in ANGLE_UNITS else f"a plain number ({unit})"
    return f"{_KINDS.get(dimension, 'another quantity')} ({unit})"


Time = Annotated[float, Quantity("a time", "s", '"2 ms"')]
Duration = Annotated[float, Quantity("a time", "s", '"10 min"')]
Instant = Annotated[float, Quantity("a time", "s", '"2 ms"', "non-negative")]
Frequency = Annotated[float, Quantity("a frequency", "Hz", '"500 Hz"', "non-negative")]
Length = Annotated[float, Quantity("a length", "m", '"20 mm"')]
BoundaryFilm = Annotated[float, Quantity("a length", "m", '"5 nm"')]
SummitRadius = Annotated[float, Quantity("a length", "m", '"10 um"')]
Height = Annotated[float, Quantity("a length", "m", '"0.05 um"', "non-negative")]
Place = Annotated[float, Quantity("a length", "m", '"0.2 mm"', "any")]
Radius = Annotated[float, Quantity("a radius", "m", '"20 mm"', "any", flat=True)]
Pressure = Annotated[float, Quantity("a pressure", "Pa", '"0.8 GPa"')]
BulkModulus = Annotated[float, Quantity("a bulk modulus", "Pa", '"1.2 GPa"')]
Stress = Annotated[float, Quantity("a shear stress", "Pa", '"5 MPa"')]
NonNegativeStress = Annotated[float, Quantity("a shear stress", "Pa", '"5 MPa"', "non-negative")]
Force = Annotated[float, Quantity("a force", "N", '"80 N"')]
Moment = Annotated[float, Quantity("a moment", "N m", '"0.5 N m"', "any")]
ForcePerLength = Annotated[float, Quantity("a force per length", "N/m", '"200 N/mm"')]
Speed = Annotated[float, Quantity("a speed", "m/s", '"1.5 m/s"')]
Viscosity = Annotated[float, Quantity("a viscosity", "Pa s", '"0.04 Pa s"')]
KinematicViscosity = Annotated[
    float, Quantity("a kinematic viscosity", "m^2/s", '"68 mm^2/s"', most=1.0)
]
PressureCoefficient = Annotated[
    float, Quantity("an inverse pressure", "1/Pa", '"22 1/GPa"', "non-negative", most=1e-4)
]
Temperature = Annotated[float, Quantity("a temperature", "K", '"40 degC"')]
TemperatureCoefficient = Annotated[
    float, Quantity("an inverse temperature", "1/K", '"6.5e-4 1/K"', "non-negative", most=1.0)
]
SignedTemperatureCoefficient = Annotated[
    float, Quantity("an inverse temperature", "1/K", '"-7e-4 1/K"', "any")
]
SolidExpansion = Annotated[
    float, Quantity("a thermal expansion", "1/K", '"12e-6 1/K"', "non-negative", most=1e-3)
]
Density = Annotated[float, Quantity("a density", "kg/m^3", '"890 kg/m^3"')]
Conductivity = Annotated[float, Quantity("a thermal conductivity", "W/m/K", '"0.14 W/m/K"')]
HeatCapacity = Annotated[float, Quantity("a heat capacity per mass", "J/kg/K", '"2000 J/kg/K"')]
VolumeHeatCapacity = Annotated[
    float, Quantity("a heat capacity per volume", "J/m^3/K", '"1.8 MJ/m^3/K"')
]
SolidDensity = Annotated[float, Quantity("a density", "kg/m^3", '"7850 kg/m^3"')]
SolidConductivity = Annotated[float, Quantity("a thermal conductivity", "W/m/K", '"46 W/m/K"')]
SolidHeatCapacity = Annotated[float, Quantity("a heat capacity per mass", "J/kg/K", '"470 J/kg/K"')]
HeatTransfer = Annotated[float, Quantity("a heat transfer coefficient", "W/m^2/K", '"200 W/m^2/K"')]
ThermalResistance = Annotated[
    float, Quantity("a thermal resistance", "K/W", '"2 K/W"', "non-negative")
]
Angle = Annotated[float, Quantity("an angle", "rad", '"45 deg"', "any")]
Direction = Annotated[float, Quantity("an angle", "rad", '"45 deg"', "any", most=2.0 * math.pi)]
AngularVelocity = Annotated[
    float, Quantity("an angular velocity", "rad/s", '"500 rpm"', "any", most=1e6)
]
Number = Annotated[float, Quantity("a plain number", "-", "0.25", "any")]
PositiveNumber = Annotated[float, Quantity("a plain number", "-", "100")]
Share = Annotated[float, Quantity("a share", "-", '"1 %"')]
Ratio = Annotated[float, Quantity("a plain number", "-", "0.6", "non-negative")]
StressSlope = Annotated[float, Quantity("a plain number", "-", "0.04", "non-negative")]


def quantity(kind: Any) -> Quantity:
    """Return the quantity of an annotated type: ``quantity(Length)``."""
    found: Quantity = kind.__metadata__[0]
    return found


_KINDS = {
    quantity(kind).dimension: quantity(kind).name
    for kind in (
        *(
            Length,
            Pressure,
            Force,
            ForcePerLength,
            Speed,
            Viscosity,
            KinematicViscosity,
            PressureCoefficient,
        ),
        *(Temperature, TemperatureCoefficient, Density, Conductivity),
        *(HeatCapacity, VolumeHeatCapacity),
    )
} | {MASS: "a mass"}
"""What a value with another unit is, by its dimension."""
_CONVERSIONS = {
    (quantity(KinematicViscosity).dimension, quantity(Viscosity).dimension): (
        "multiply it by the density"
    ),
    (quantity(VolumeHeatCapacity).dimension, quantity(HeatCapacity).dimension): (
        'divide it by the density, also with basis = "volume"'
    ),
    (MASS, FORCE): "a force has N, kN or lbf",
}
"""How to convert what was given to what is expected, by their dimensions."""
