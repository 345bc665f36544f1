"""Exponentials that neither overflow nor vanish: what every viscosity law ends in."""

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tehl.typing import Array

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


def temperature_law(law: str, how: str, coefficient: float) -> str:
    """Return the name of a law and of its fall with temperature, as outputs show it."""
    return f"{law}, {how if coefficient > 0 else 'no temperature'}"
