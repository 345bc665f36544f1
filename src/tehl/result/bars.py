"""Error bars: of a certified result, from its grids, and those that each result estimates."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from tehl.result import registry

ORDERS = (1.4, 2.8)
"""Observed orders that count as second order."""


def shows_second_order(order: float | None) -> bool:
    """Whether an observed order counts as second order; None is not one."""
    return order is not None and ORDERS[0] <= order <= ORDERS[1]


@dataclass(frozen=True, kw_only=True, slots=True)
class Estimate:
    """A value with its error bar."""

    value: float
    """Richardson value."""
    uncertainty: float
    """Half width of the bar: discretisation and domain parts added in quadrature."""
    discretisation: float
    domain: float
    """The two parts."""
    observed_order: float | None
    """Order observed on three grids; None if they do not show one."""
    values: tuple[float, ...]
    """Values on the grids, coarse to fine."""

    def scaled(self, unit: float) -> "Estimate":
        """Return the same in another unit, of which one of its own is ``unit``."""
        return replace(
            self,
            value=self.value * unit,
            uncertainty=self.uncertainty * unit,
            discretisation=self.discretisation * unit,
            domain=self.domain * unit,
            values=tuple(value * unit for value in self.values),
        )

    @property
    def is_second_order(self) -> bool:
        """Whether the grids show second order, so that the value is extrapolated."""
        return shows_second_order(self.observed_order)


@dataclass(frozen=True, kw_only=True, slots=True)
class ErrorEstimate:
    """Estimated errors of the film on the finest grid, without extra runs."""

    discretisation_central: float
    discretisation_minimum: float
    """From the difference to the next coarser grid of the full multigrid, relative [-]."""
    iteration_central: float
    iteration_minimum: float
    """Change by further cycles, relative [-]."""
    domain: float = 0.0
    """From the edges of a domain with the far field, relative [-]."""
    supply: float = 0.0
    """From the flooded film to which ``supply.ratio`` is stated, relative [-]."""
    bars: Mapping[str, float] = field(default_factory=dict)
    """Error bars of further values by their names in `tehl.result.quantities`, all parts together,
    relative [-]. A name is missing if the contact does not have the value, or too few grids do.
    Each is an attribute too, None if it is missing: ``errors.pressure_max``."""
    extrapolated: bool = False
    """Whether the values are extrapolated from the two finest grids."""
    spike_resolved: bool = True
    """Whether the largest pressure will stay the largest on finer grids: if not, the pressure spike
    is narrower than the mesh and may exceed it."""

    minimum_has_limit: bool = True
    """Whether these grids show a limit of the minimum film, and so an error bar: not where it lies
    at the sharp end of a roller, under a pressure that has none, or where lines miss the ends."""
    pressure_has_limit: bool = True
    """Whether these grids show a limit of the largest pressure, and so an error bar: not where it
    is that of the end of a roller, or where lines miss the ends."""

    @property
    def central(self) -> float:
        """Error bar of the central film, all parts together [-]."""
        return self.discretisation_central + self.iteration_central + self.domain + self.supply

    @property
    def minimum(self) -> float:
        """Error bar of the minimum film, all parts together [-]; NaN without a limit."""
        if not self.minimum_has_limit:
            return math.nan
        return self.discretisation_minimum + self.iteration_minimum + self.domain + self.supply

    def film(self, part: float = 1.0) -> float:
        """Return the larger error bar of both films, that of the minimum times ``part`` [-]."""
        return max(self.central, part * self.minimum) if self.minimum_has_limit else self.central

    def at(self, path: str) -> float | None:
        """Return the error bar of the quantity at a place of the summary, None if it is missing."""
        return self.of(registry.at(path).name)

    def of(self, name: str) -> float | None:
        """Return the error bar called ``name``, that of a film too; None if it is missing."""
        if name == "film_minimum":
            return self.minimum if self.minimum_has_limit else None
        return self.central if name == "film_central" else self.bars.get(name)


def _bar(name: str) -> property:
    """Return the attribute of an error bar."""

    def bar(errors: ErrorEstimate) -> float | None:
        return errors.bars.get(name)

    return property(bar, doc=f"Relative error bar ``{name}``, None if it is missing [-].")


for _name in registry.bar_names():
    setattr(ErrorEstimate, _name, _bar(_name))
