"""Quantities that only rough surfaces have."""

from typing import Annotated

from tehl.units import Quantity

SIGNED_HEIGHT = Quantity(name="a height", unit="m", example='"-0.3 um"', sign="any")
POSITION = Quantity(name="a position", unit="m", example='"0.1 mm"', sign="any")
WAVELENGTH = Quantity(name="a length", unit="m", example='"50 um"')

SignedHeight = Annotated[float, SIGNED_HEIGHT]
Position = Annotated[float, POSITION]
Wavelength = Annotated[float, WAVELENGTH]
