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
"""Nodes across the film when the case does not state them, and its inlet is not hot."""
HOT_LOADING, MOST_LAYERS = 5.0, 21
"""Thermal loading from which an inlet is hot, and most nodes for it: where oil flows back, cold oil
at the walls passes hot oil between them. With nine nodes temperatures of a contact (loading 57)
swing by up to 80 K from sweep to sweep, and the film of a drive (20) on 129 x 129 nodes, converged
to rounding, is 35 % thicker than with 25; below 5 they err by less than 0.1 %."""


class Thermal(Table):
    """The table ``[thermal]`` of a case."""

    temperature: Temperature | None = None
    """Temperature of the oil at the inlet [K]; None takes ``lubricant.temperature``, or the
    reference temperature of the viscosity."""
    reynolds: ReynoldsForm = "generalised"
    """Form of the Reynolds equation, see :class:`FilmEnergy`."""
    layers: Annotated[int, Field(ge=5, le=81, strict=True, examples=[9])] | None = None
    """Nodes across the film, both surfaces included; None takes those of `nodes`."""
    scheme: AcrossScheme = "chebyshev"
    """Collocation at Chebyshev nodes, or differences between uniform layers."""
    sources: SourceForm = "auto"
    """How the solids conduct, see :class:`FilmEnergy`."""

    def nodes(self, loading: float) -> int:
        """Return the nodes across the film: stated, or those of the scheme, more in hot inlets.

        The thermal layers in the inlet are as thick as the root of the flow through them, which
        grows with ``loading``, and Chebyshev nodes at walls as near as the square of their number.

        Parameters
        ----------
        loading : float
            Thermal loading of the inlet, `PointContact.thermal_loading` [-].
        """
        usual = LAYERS[self.scheme]
        if self.layers is not None or self.scheme == "uniform" or loading <= HOT_LOADING:
            return self.layers or usual
        needed = usual * (loading / HOT_LOADING) ** 0.25
        # with 11 and 15 nodes the film of that drive errs by 3 %, with 13 and 17 by 0.3 and 0.1 %
        return min(4 * math.ceil(0.25 * (needed - 1.0)) + 1, MOST_LAYERS)


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
