"""Which heat problem goes with the film; not how it is solved."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Isothermal:
    """The film keeps the temperature of the inlet everywhere.

    Attributes
    ----------
    temperature : float
        Temperature of oil and solids [K].
    """

    temperature: float
