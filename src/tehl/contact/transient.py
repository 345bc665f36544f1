"""Settings of a transient run: the ``[transient]`` table of a case."""

from bisect import bisect_right
from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from tehl.base.table import Table
from tehl.base.units import Instant, PositiveNumber, Time

STEADY = "only load and the roughness of the surfaces vary in time; state it under [contact]"
LARGEST_FACTOR = 10.0
"""Largest load over the stated one."""


class Transient(Table):
    """A transient run: surfaces carry their roughness, the load may vary, the film is squeezed."""

    other_words: ClassVar = dict.fromkeys(
        ("entrainment_speed", "slide_roll_ratio", "radius", "radius_x", "radius_y"), STEADY
    )
    synonyms: ClassVar = {
        "duration": "time end_time t_end end",
        "stride": "dt step time_step",
    }

    duration: Time | None = None
    """Duration of the run [s]; None is until all moving roughness has passed the contact, of waves
    2.5 wavelengths."""
    stride: Annotated[int, Field(ge=1, le=8)] = 1
    """Mesh widths that the mean motion passes per time step: changes are resolved as on a grid
    coarser by this factor."""
    start: Literal["smooth", "standing"] = "smooth"
    """Film at time zero: of smooth surfaces, with waves and random surfaces that enter from the
    inlet; or the steady film of the rough surfaces at rest."""
    entrance: PositiveNumber = 2.5
    """Distance upstream of the contact at which waves and random surfaces that enter begin at time
    zero [a_x]."""
    load: tuple[tuple[Instant, PositiveNumber], ...] = ()
    """Times [s] and loads over that of the contact, linear between and constant before and
    after."""
    frames: (
        Annotated[int, Field(ge=0, le=10000)]
        | Annotated[tuple[Instant, ...], Field(max_length=10000)]
    ) = 25
    """Number of stored fields, evenly spaced in time, or their times [s]."""
    tolerance: Annotated[float, Field(gt=0, lt=0.1)] = 1e-3
    """Largest change of pressure in the last cycle of a step [p_h]."""
    max_cycles: Annotated[int, Field(ge=1, le=1000)] = 20
    """Cycles per step before the next relaxation is tried."""

    @model_validator(mode="after")
    def _must_go_on(self) -> Self:
        times = [time for time, _ in self.load]
        if any(later <= earlier for earlier, later in pairwise(times)):
            raise ValueError("load must have times that increase")
        if any(factor > LARGEST_FACTOR for _, factor in self.load):
            raise ValueError(
                f"load is over that of the contact and must stay below {LARGEST_FACTOR:g} times it"
            )
        return self

    def load_at(self, time: float) -> float:
        """Return the load at ``time`` [s] over that of the contact [-]."""
        if not self.load:
            return 1.0
        after = bisect_right([moment for moment, _ in self.load], time)
        if after in (0, len(self.load)):
            return self.load[min(after, len(self.load) - 1)][1]
        (start, load), (end, next_load) = self.load[after - 1 : after + 1]
        return load + (time - start) / (end - start) * (next_load - load)
