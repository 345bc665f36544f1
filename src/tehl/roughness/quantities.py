"""Quantities that only rough surfaces have."""

from typing import Annotated, Any

from pydantic import AfterValidator, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tehl.units import Length, Quantity, quantity

SIGNED_HEIGHT = Quantity(name="a height", unit="m", example='"-0.3 um"', sign="any")
POSITION = Quantity(name="a position", unit="m", example='"0.1 mm"', sign="any")
WAVELENGTH = Quantity(name="a length", unit="m", example='"50 um"')

SignedHeight = Annotated[float, SIGNED_HEIGHT]
Position = Annotated[float, POSITION]
Wavelength = Annotated[float, WAVELENGTH]

_WORDS = {
    "micron": "um",
    "micrometer": "um",
    "micrometre": "um",
    "nanometer": "nm",
    "nanometre": "nm",
    "millimeter": "mm",
    "millimetre": "mm",
    "meter": "m",
    "metre": "m",
}
_ANGSTROMS = ("Å", "\N{ANGSTROM SIGN}", "angstrom", "A")


def metres(unit: str) -> float:
    """Return the factor from a unit of length to metres.

    Raises
    ------
    ValueError
        If it is none; the message continues a sentence that begins with the unit.
    """
    text = unit.strip().removeprefix("Â")  # a micro sign of two bytes, read as two letters
    if text in _ANGSTROMS or text.lower() in _ANGSTROMS:
        return 1e-10
    word = text.lower()
    return quantity(Length).parse(
        f"1 {_WORDS.get(word) or _WORDS.get(word.removesuffix('s'), text)}"
    )


def _is_length(unit: str) -> str:
    try:
        metres(unit)
    except ValueError:
        raise ValueError('is no unit of length: give one such as "um"') from None
    return unit


LengthUnit = Annotated[str, AfterValidator(_is_length)]


class _OneForBoth:
    """Metadata of a pair: a single value stands for both."""

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Double a single value before pydantic looks for two."""
        return core_schema.no_info_before_validator_function(_pair, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the field as one value or two."""
        pair = handler(schema)
        return {"anyOf": [pair, *pair.get("prefixItems", [])[:1]]}


def _pair(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else (value, value)


Lengths = Annotated[tuple[Wavelength, Wavelength], _OneForBoth()]
Span = tuple[Position, Position]
