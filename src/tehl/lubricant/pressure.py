"""The pressure coefficient of an oil: stated, or estimated from its viscosity."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from tehl.base.units import Quantity

ESTIMATED: Literal["estimated"] = "estimated"
UNCERTAINTY = "within 20 % for mineral oils, often 30 to 50 % too high for others"
"""Of an estimated coefficient."""
NEEDED = (
    "needs exactly one of alpha and z: alpha is 18 to 25 1/GPa for mineral oils, 12 to 17 for "
    'PAO, 10 to 17 for esters and 9 to 14 for polyglycols at 40 degC, alpha = "estimated" '
    "estimates it from the viscosity"
)
"""Message on a law without a pressure coefficient."""
_LEAST_VISCOSITY, _LARGEST_VISCOSITY = 1e-3, 10.0
"""Viscosities [Pa s] between which mineral oils were measured, roughly."""


@dataclass(frozen=True, slots=True)
class _Estimable(Quantity):
    """A quantity, or the word "estimated"."""

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Pass the word, and read all else as the quantity."""
        number = Quantity.__get_pydantic_core_schema__(self, float, handler)
        del source
        return core_schema.tagged_union_schema(
            {"word": core_schema.literal_schema([ESTIMATED]), "number": number},
            discriminator=lambda value: "word" if value == ESTIMATED else "number",
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the field as the quantity or the word."""
        found = Quantity.__get_pydantic_json_schema__(self, schema, handler)
        return found | {"anyOf": [*found["anyOf"], {"const": ESTIMATED}]}


Alpha = Annotated[
    float | Literal["estimated"],
    _Estimable("an inverse pressure", "1/Pa", '"22 1/GPa"', "non-negative", most=1e-4),
]
"""A pressure coefficient [1/Pa], or "estimated"."""


def pressure_coefficient_of(alpha: float | str | None, viscosity: float) -> float:
    """Return a stated pressure coefficient [1/Pa], or Wooster's of a ``viscosity`` [Pa s].

    Parameters
    ----------
    alpha : float, str or None
        Stated coefficient [1/Pa]; a text selects Wooster's formula, None is zero.
    viscosity : float
        At ambient pressure and the inlet temperature [Pa s].
    """
    return wooster(viscosity) if isinstance(alpha, str) else alpha or 0.0


def wooster(viscosity: float) -> float:
    r"""Return the pressure coefficient of an average mineral oil by Wooster's relation [1/Pa].

    .. math:: \alpha = (0.6 + 0.965 \log_{10} \eta_0) \cdot 10^{-8}

    with the ambient viscosity in mPa s, at the temperature of the coefficient.

    Raises ValueError outside 1 mPa s to 10 Pa s.

    References
    ----------
    .. [1] G. W. Stachowiak and A. W. Batchelor, Engineering Tribology, Butterworth-Heinemann,
       chapter 2: viscosity-pressure relationship, after Wooster.
    """
    if not _LEAST_VISCOSITY <= viscosity <= _LARGEST_VISCOSITY:
        raise ValueError(
            f'has alpha = "{ESTIMATED}" at a viscosity of {viscosity:.3g} Pa s, but mineral oils '
            f"have {_LEAST_VISCOSITY:g} to {_LARGEST_VISCOSITY:g} Pa s: state alpha"
        )
    return (0.6 + 0.965 * math.log10(1e3 * viscosity)) * 1e-8
