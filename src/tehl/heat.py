"""Which heat problem goes with the film; not how it is solved."""

from dataclasses import dataclass
from typing import Literal

ReynoldsForm = Literal["generalised", "mean", "mean-all"]
AcrossScheme = Literal["chebyshev", "uniform"]
SourceForm = Literal["auto", "line", "full"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Isothermal:
    """The film keeps the temperature of the inlet everywhere.

    Attributes
    ----------
    temperature : float
        Temperature of oil and solids [K].
    """

    temperature: float


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmEnergy:
    """Energy equation of the film between two solids heated by moving sources.

    Attributes
    ----------
    temperature : float
        Temperature of the oil at the inlet [K].
    bulk_1, bulk_2 : float
        Temperatures of the solids far from the contact [K].
    reynolds : {"generalised", "mean", "mean-all"}
        Form of the Reynolds equation: properties that vary across the film (Yang and Wen);
        properties at the mean film temperature in Reynolds only; or everywhere.
    layers : int
        Nodes across the film, both surfaces included.
    scheme : {"chebyshev", "uniform"}
        Collocation at Chebyshev nodes, or differences between uniform layers.
    sources : {"auto", "line", "full"}
        Surface temperatures by the line source of high Peclet numbers, by the full moving source,
        or by whichever suits each surface.
    """

    temperature: float
    bulk_1: float
    bulk_2: float
    reynolds: ReynoldsForm = "generalised"
    layers: int = 9
    scheme: AcrossScheme = "chebyshev"
    sources: SourceForm = "auto"
