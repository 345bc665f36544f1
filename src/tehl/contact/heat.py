"""The heat problem of a film: energy equation, solids, and nodes across the film."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from tehl.base.table import Table
from tehl.base.units import Temperature

ReynoldsForm = Literal["generalised", "mean", "mean-all"]
AcrossScheme = Literal["chebyshev", "uniform"]
SourceForm = Literal["auto", "line", "full"]


LEAST_LINE = 2.0
"""Solid Peclet number from which a line source is marched: below, it has little of the full one."""
LEAST_LINE_PECLET = 30.0
"""Solid Peclet number from which on the line source is good to one per cent."""
FAR_BODY = 40.0
"""Difference of a body to the oil at the inlet beyond which runs often fail to converge [K]."""
LAYERS: dict[AcrossScheme, int] = {"chebyshev": 9, "uniform": 21}
"""Nodes across the film when the case does not state them."""


class Thermal(Table):
    """The table ``[thermal]`` of a case."""

    temperature: Temperature | None = None
    """Temperature of the oil at the inlet [K]; None takes ``lubricant.temperature``, or the
    reference temperature of the viscosity."""
    reynolds: ReynoldsForm = "generalised"
    """Form of the Reynolds equation, see :class:`FilmEnergy`."""
    layers: Annotated[int, Field(ge=5, le=81, strict=True, examples=[9])] | None = None
    """Nodes across the film, both surfaces included; None takes `LAYERS` of the scheme."""
    scheme: AcrossScheme = "chebyshev"
    """Collocation at Chebyshev nodes, or differences between uniform layers."""
    sources: SourceForm = "auto"
    """How the solids conduct, see :class:`FilmEnergy`."""

    @property
    def nodes(self) -> int:
        """Return the nodes across the film, stated or those of the scheme."""
        return LAYERS[self.scheme] if self.layers is None else self.layers


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmEnergy:
    """Energy equation of the film between two solids heated by moving sources."""

    temperature: float
    """Temperature of the oil at the inlet [K]."""
    bulk_1: float
    bulk_2: float
    """Temperatures of the solids far from the contact [K]."""
    reynolds: ReynoldsForm = "generalised"
    """Form of the Reynolds equation: properties that vary across the film (Yang and Wen);
    properties at the mean film temperature in Reynolds only; or everywhere."""
    layers: int = 9
    """Nodes across the film, both surfaces included."""
    scheme: AcrossScheme = "chebyshev"
    """Collocation at Chebyshev nodes, or differences between uniform layers."""
    sources: SourceForm = "auto"
    """Surface temperatures by the line source of high Peclet numbers, by the full moving source, or
    by `source_form` for each surface."""


def source_form(stated: SourceForm, peclet: float) -> Literal["line", "full"]:
    """Return the moving source of a surface, as stated or for its Peclet number.

    ``peclet`` is u_s a_x / (2 diffusivity) of the solid [-], negative if it moves against x.

    Parameters
    ----------
    stated : {"auto", "line", "full"}
        ``thermal.sources`` of the case.
    peclet : float
        u_s a_x / (2 diffusivity) of the solid [-], negative if it moves against x.
    """
    if stated != "auto":
        return stated
    return "line" if peclet >= LEAST_LINE_PECLET else "full"


def rubbing_parts(
    conductivities: Sequence[float], peclets: Sequence[float | None]
) -> tuple[float, float]:
    """Return the parts of the heat of rubbing that both solids take, which makes them as warm [-].

    Parameters
    ----------
    conductivities : sequence of float
        Of both solids [W/m/K].
    peclets : sequence of float
        u_s a_x / (2 diffusivity) of both [-], of any sign.
    """
    first, second = (
        conductivity * (1.0 + math.sqrt(abs(peclet or 0.0)))
        for conductivity, peclet in zip(conductivities, peclets, strict=True)
    )
    return first / (first + second), second / (first + second)
