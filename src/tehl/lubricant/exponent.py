"""What viscosity laws share: exponentials that neither overflow nor vanish, Roelands' constants."""

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.typing import Array

ROELANDS_OFFSET = 9.67  # -ln of 6.31e-5 Pa s, the viscosity at Roelands' common point
ROELANDS_PRESSURE = 1.96e8  # [Pa], in the definition of z
PER_ROELANDS_PRESSURE = 5.1e-9  # [1/Pa], in the bracket: the rounded 1/1.96e8
LARGEST_EXPONENT = 600.0
"""``exp`` of more would overflow; so thick a film is a solid for every purpose."""


def exponential(eta_0: "float | Array", exponent: "Array") -> "Array":
    """Return ``eta_0 exp(exponent)``, written over ``exponent``."""
    import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

    exponent = np.asarray(exponent)
    exponent = np.clip(exponent, -LARGEST_EXPONENT, LARGEST_EXPONENT, out=exponent)
    exponent = np.exp(exponent, out=exponent)
    exponent *= eta_0
    return exponent


def exponential_at(eta_0: float, exponent: float) -> float:
    """Return ``eta_0 exp(exponent)`` of numbers."""
    return eta_0 * math.exp(min(max(exponent, -LARGEST_EXPONENT), LARGEST_EXPONENT))


def power_growth(pressure: float, coefficient: float, index: float) -> float:
    """Return Roelands' exponent at ``pressure`` [Pa] from its slope [1/Pa] at p = 0 and its z."""
    if not index > 0:
        return 0.0
    bracket = (1.0 + PER_ROELANDS_PRESSURE * pressure) ** index
    return coefficient * ROELANDS_PRESSURE / index * (bracket - 1.0)


def temperature_law(law: str, how: str, coefficient: float) -> str:
    """Return the name of a law and of its fall with temperature, as outputs show it."""
    return f"{law}, {how if coefficient > 0 else 'no temperature'}"
