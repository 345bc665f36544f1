"""Units at the border: ``"0.5 GPa"`` becomes ``5e8``; behind this module everything is SI.

A quantity is a number with a unit, or a bare number, which is SI. The annotated types at the end
(``Length``, ``Pressure``, ...) make a pydantic field read both, and describe themselves in the
JSON schema.
"""

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Literal

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

Dimension = tuple[int, int, int, int]
"""Exponents of metre, kilogram, second, kelvin."""

_NONE: Dimension = (0, 0, 0, 0)
_FORCE: Dimension = (1, 1, -2, 0)
_PRESSURE: Dimension = (-1, 1, -2, 0)
_ENERGY: Dimension = (2, 1, -2, 0)
_POWER: Dimension = (2, 1, -3, 0)

_PREFIXES = {"n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6}
_PREFIXES["G"] = 1e9
_PREFIXED: dict[str, tuple[float, Dimension]] = {
    "m": (1.0, (1, 0, 0, 0)),
    "g": (1e-3, (0, 1, 0, 0)),
    "s": (1.0, (0, 0, 1, 0)),
    "N": (1.0, _FORCE),
    "Pa": (1.0, _PRESSURE),
    "J": (1.0, _ENERGY),
    "W": (1.0, _POWER),
}
_UNITS: dict[str, tuple[float, Dimension]] = {
    prefix + name: (scale * factor, dimension)
    for name, (factor, dimension) in _PREFIXED.items()
    for prefix, scale in _PREFIXES.items()
} | {
    "1": (1.0, _NONE),
    "-": (1.0, _NONE),
    "%": (0.01, _NONE),
    "rad": (1.0, _NONE),
    "deg": (math.pi / 180.0, _NONE),
    "°": (math.pi / 180.0, _NONE),
    "K": (1.0, (0, 0, 0, 1)),
    "degC": (1.0, (0, 0, 0, 1)),
    "°C": (1.0, (0, 0, 0, 1)),
    "cm": (1e-2, (1, 0, 0, 0)),
    "min": (60.0, (0, 0, 1, 0)),
    "h": (3600.0, (0, 0, 1, 0)),
    "bar": (1e5, _PRESSURE),
    "cP": (1e-3, (-1, 1, -1, 0)),
    "P": (0.1, (-1, 1, -1, 0)),
    "cSt": (1e-6, (2, 0, -1, 0)),
    "St": (1e-4, (2, 0, -1, 0)),
}
_CELSIUS = ("degC", "°C", "C")
_ZERO_CELSIUS = 273.15
_ANGLE_UNITS = ("rad", "deg", "°")

LONGEST_UNIT = 40
"""Characters of a unit."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_TOKEN = re.compile(r"\s*(?:(\*\*|[*/()^·])|([+-]?\d+)|([A-Za-zµμ°%]+|-))")
_SUPERSCRIPTS = str.maketrans({"²": "^2", "³": "^3", "⁻": "-", "¹": "1"})


class _UnitReader:
    """Recursive descent over a unit such as ``W/m/K`` or ``1/(Pa s)``."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.tokens = self._split(text.replace("⁻¹", "^-1").translate(_SUPERSCRIPTS))
        self.position = 0

    def _split(self, text: str) -> list[str]:
        tokens, start = [], 0
        while text[start:].strip():
            match = _TOKEN.match(text, start)
            if match is None:
                raise ValueError(f"has an unreadable unit {self.text!r}")
            tokens.append(match.group().strip())
            start = match.end()
        return tokens

    def _next(self) -> str:
        return self.tokens[self.position] if self.position < len(self.tokens) else ""

    def read(self) -> tuple[float, Dimension]:
        """Return factor to SI and dimension of the whole text."""
        value = self._product()
        if self._next():
            raise ValueError(f"has an unreadable unit {self.text!r}")
        return value

    def _product(self) -> tuple[float, Dimension]:
        factor, dimension = self._power()
        while self._next() not in ("", ")"):
            sign = 1
            if self._next() in ("*", "·", "/"):
                sign = -1 if self._next() == "/" else 1
                self.position += 1
            other, exponents = self._power()
            factor *= other**sign
            dimension = _combine(dimension, exponents, sign)
        return factor, dimension

    def _power(self) -> tuple[float, Dimension]:
        factor, dimension = self._atom()
        if self._next() not in ("^", "**"):
            return factor, dimension
        self.position += 1
        token = self._next()
        if not re.fullmatch(r"[+-]?\d", token):
            raise ValueError(f"has an unreadable exponent in its unit {self.text!r}")
        self.position += 1
        return float(factor ** int(token)), _combine(_NONE, dimension, int(token))

    def _atom(self) -> tuple[float, Dimension]:
        token = self._next()
        self.position += 1
        if token == "(":
            value = self._product()
            if self._next() != ")":
                raise ValueError(f"has a bracket left open in its unit {self.text!r}")
            self.position += 1
            return value
        if token not in _UNITS:
            raise ValueError(f"has an unknown unit {token or self.text!r}")
        return _UNITS[token]


def _combine(first: Dimension, second: Dimension, power: int) -> Dimension:
    a, b, c, d = (one + power * two for one, two in zip(first, second, strict=True))
    return (a, b, c, d)


@lru_cache(maxsize=256)
def _read_unit(text: str) -> tuple[float, Dimension]:
    """Return factor to SI and dimension of a unit; a study reads the same few a thousand times."""
    return _UnitReader(text).read()


@dataclass(frozen=True, kw_only=True, slots=True)
class Quantity:
    """What kind of number is expected: dimension, sign and an example for messages.

    An instance is pydantic metadata: ``Annotated[float, Quantity(...)]``.

    Attributes
    ----------
    name : str
        The kind in words, with its article: ``"a force"``.
    unit : str
        The SI unit; a bare number is in this unit.
    example : str
        A good value with a unit, shown in messages and in the schema.
    sign : {"positive", "non-negative", "any"}
        Which values are possible.
    flat : bool
        Whether infinity is allowed (radius of a flat).
    """

    name: str
    unit: str
    example: str
    sign: Literal["positive", "non-negative", "any"] = "positive"
    flat: bool = False

    @property
    def dimension(self) -> Dimension:
        """Exponents of metre, kilogram, second, kelvin."""
        return _read_unit(self.unit)[1]

    def parse(self, value: object) -> float:
        """Return ``value`` in SI.

        Parameters
        ----------
        value : float or str
            A bare SI number, or a number with its unit.

        Raises
        ------
        ValueError
            If it cannot be such a quantity; the message continues a sentence that begins with
            the name and the value: ``contact.load = "80 mm" ...``.
        """
        if isinstance(value, str):
            return self._check(self._read(value.strip()))
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"is not a number: {self._wanted}")
        if abs(value) > 1e300:  # so that huge integers of a case file do not overflow
            return self._check(math.inf if value > 0 else -math.inf)
        return self._check(float(value))

    @property
    def _wanted(self) -> str:
        return f"give {self.name} such as {self.example}"

    def _read(self, text: str) -> float:
        if text.lstrip("+-").lower() in ("inf", "nan"):
            return float(text)
        match = _NUMBER.match(text)
        if match is None:
            raise ValueError(f"does not begin with a number: {self._wanted}")
        number, unit = float(match.group()), text[match.end() :].strip()
        if not unit:
            return self._unitless(number)
        if self.unit == "K" and unit in _CELSIUS:
            return number + _ZERO_CELSIUS
        factor = self._factor(unit)
        return number if factor == 1.0 else float(f"{number * factor:.15g}")  # 22 1/GPa is 2.2e-8

    def _factor(self, unit: str) -> float:
        """Return the factor from ``unit`` to SI."""
        if len(unit) > LONGEST_UNIT:
            raise ValueError(f"has an unreadable unit: {self._wanted}")
        if re.match(r",\d", unit):
            raise ValueError(f"has a comma in its number, write a point: {self._wanted}")
        try:
            factor, dimension = _read_unit(unit)
        except ValueError as error:
            raise ValueError(f"{error}: {self._wanted}") from None
        if self.unit == "-" and unit in _ANGLE_UNITS:
            raise ValueError(f"has the unit of an angle ({unit}): {self._wanted}")
        if dimension != self.dimension:
            way = _WAYS.get((dimension, self.dimension), "")
            raise ValueError(f"has the unit of {_kind(dimension, unit)}: {way}{self._wanted}")
        return factor

    def _unitless(self, number: float) -> float:
        if self.unit != "-":
            raise ValueError(f"lacks a unit: {self._wanted}, or a number without quotes in SI")
        return number

    def _check(self, number: float) -> float:
        if math.isnan(number):
            raise ValueError(f"is not a number: {self._wanted}")
        if math.isinf(number) and not (self.flat and number > 0):
            raise ValueError(f"is not finite: {self._wanted}")
        if self.sign == "positive" and not number > 0:
            raise ValueError(f"must be positive: {self._wanted}")
        if self.sign == "non-negative" and not number >= 0:
            raise ValueError(f"must not be negative: {self._wanted}")
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
                _finite_or_word, when_used="json-unless-none"
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
        if self.unit == "-":
            return number | {"examples": [float(self.example)]}
        return {
            "anyOf": [{"type": "string", "examples": [self.example]}, number],
            "description": f"{self.name}; a bare number is in {self.unit}",
        }


def _finite_or_word(value: float) -> float | str:
    return "inf" if math.isinf(value) else value


def _kind(dimension: Dimension, unit: str) -> str:
    if dimension == _NONE:
        return f"an angle ({unit})" if unit in _ANGLE_UNITS else f"a plain number ({unit})"
    known = {quantity.dimension: quantity.name for quantity in reversed(_KINDS)}
    return f"{known.get(dimension, 'something else')} ({unit})"


TIME = Quantity(name="a time", unit="s", example='"2 ms"')
INSTANT = Quantity(name="a time", unit="s", example='"2 ms"', sign="non-negative")
LENGTH = Quantity(name="a length", unit="m", example='"20 mm"')
HEIGHT = Quantity(name="a length", unit="m", example='"0.05 um"', sign="non-negative")
RADIUS = Quantity(name="a radius", unit="m", example='"20 mm"', sign="any", flat=True)
PRESSURE = Quantity(name="a pressure", unit="Pa", example='"0.8 GPa"')
BULK_MODULUS = Quantity(name="a bulk modulus", unit="Pa", example='"1.2 GPa"')
STRESS = Quantity(name="a shear stress", unit="Pa", example='"5 MPa"')
NON_NEGATIVE_STRESS = Quantity(
    name="a shear stress", unit="Pa", example='"5 MPa"', sign="non-negative"
)
FORCE = Quantity(name="a force", unit="N", example='"80 N"')
SPEED = Quantity(name="a speed", unit="m/s", example='"1.5 m/s"')
VISCOSITY = Quantity(name="a viscosity", unit="Pa s", example='"0.04 Pa s"')
KINEMATIC_VISCOSITY = Quantity(name="a kinematic viscosity", unit="m^2/s", example='"68 mm^2/s"')
PER_PRESSURE = Quantity(
    name="an inverse pressure", unit="1/Pa", example='"22 1/GPa"', sign="non-negative"
)
TEMPERATURE = Quantity(name="a temperature", unit="K", example='"40 degC"')
PER_TEMPERATURE = Quantity(
    name="an inverse temperature", unit="1/K", example='"6.5e-4 1/K"', sign="non-negative"
)
SIGNED_PER_TEMPERATURE = Quantity(
    name="an inverse temperature", unit="1/K", example='"-7e-4 1/K"', sign="any"
)
DENSITY = Quantity(name="a density", unit="kg/m^3", example='"890 kg/m^3"')
CONDUCTIVITY = Quantity(name="a thermal conductivity", unit="W/m/K", example='"0.14 W/m/K"')
HEAT_CAPACITY = Quantity(name="a heat capacity per mass", unit="J/kg/K", example='"2000 J/kg/K"')
VOLUME_HEAT_CAPACITY = Quantity(
    name="a heat capacity per volume", unit="J/m^3/K", example='"1.8 MJ/m^3/K"'
)
SOLID_DENSITY = Quantity(name="a density", unit="kg/m^3", example='"7850 kg/m^3"')
SOLID_CONDUCTIVITY = Quantity(name="a thermal conductivity", unit="W/m/K", example='"46 W/m/K"')
SOLID_HEAT_CAPACITY = Quantity(
    name="a heat capacity per mass", unit="J/kg/K", example='"470 J/kg/K"'
)
ANGLE = Quantity(name="an angle", unit="rad", example='"45 deg"', sign="any")
NUMBER = Quantity(name="a plain number", unit="-", example="0.25", sign="any")
POSITIVE_NUMBER = Quantity(name="a plain number", unit="-", example="100")
RATIO = Quantity(name="a plain number", unit="-", example="0.6", sign="non-negative")
STRESS_SLOPE = Quantity(name="a plain number", unit="-", example="0.04", sign="non-negative")

_KINDS = (
    LENGTH,
    PRESSURE,
    FORCE,
    SPEED,
    VISCOSITY,
    KINEMATIC_VISCOSITY,
    PER_PRESSURE,
    TEMPERATURE,
    PER_TEMPERATURE,
    DENSITY,
    CONDUCTIVITY,
    HEAT_CAPACITY,
    VOLUME_HEAT_CAPACITY,
)
_WAYS = {
    (KINEMATIC_VISCOSITY.dimension, VISCOSITY.dimension): "multiply it by the density, and ",
    (VOLUME_HEAT_CAPACITY.dimension, HEAT_CAPACITY.dimension): (
        'divide it by the density (also with basis = "volume"), and '
    ),
}
"""How one gets from what was given to what is wanted, by their dimensions."""

Time = Annotated[float, TIME]
Instant = Annotated[float, INSTANT]
Length = Annotated[float, LENGTH]
Height = Annotated[float, HEIGHT]
Radius = Annotated[float, RADIUS]
Pressure = Annotated[float, PRESSURE]
BulkModulus = Annotated[float, BULK_MODULUS]
Stress = Annotated[float, STRESS]
NonNegativeStress = Annotated[float, NON_NEGATIVE_STRESS]
Force = Annotated[float, FORCE]
Speed = Annotated[float, SPEED]
Viscosity = Annotated[float, VISCOSITY]
KinematicViscosity = Annotated[float, KINEMATIC_VISCOSITY]
PressureCoefficient = Annotated[float, PER_PRESSURE]
Temperature = Annotated[float, TEMPERATURE]
TemperatureCoefficient = Annotated[float, PER_TEMPERATURE]
SignedTemperatureCoefficient = Annotated[float, SIGNED_PER_TEMPERATURE]
Density = Annotated[float, DENSITY]
Conductivity = Annotated[float, CONDUCTIVITY]
HeatCapacity = Annotated[float, HEAT_CAPACITY]
SolidDensity = Annotated[float, SOLID_DENSITY]
SolidConductivity = Annotated[float, SOLID_CONDUCTIVITY]
SolidHeatCapacity = Annotated[float, SOLID_HEAT_CAPACITY]
Angle = Annotated[float, ANGLE]
Number = Annotated[float, NUMBER]
PositiveNumber = Annotated[float, POSITIVE_NUMBER]
Ratio = Annotated[float, RATIO]
StressSlope = Annotated[float, STRESS_SLOPE]
