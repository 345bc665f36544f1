"""Time: what the ``[transient]`` table of a case says."""

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from tehl.units import Instant, PositiveNumber, Time

LARGEST_FACTOR = 10.0
"""Largest load over the stated one."""


class Transient(BaseModel):
    """A transient run: the surfaces carry their roughness along, and the film is squeezed.

    Attributes
    ----------
    duration : float or None
        Until when [s]; None is until all that moves has passed the contact, of waves 2.5.
    stride : int
        Mesh widths that the mean of both surfaces moves on in one step of time: what changes is
        resolved as on a grid so many times coarser.
    start : {"smooth", "standing"}
        From which film: the smooth one, waves and random surfaces coming in from the inlet; or the
        steady one of the surfaces as they stand at time zero.
    entrance : float
        How far upstream of the contact waves and random surfaces begin at time zero, when they
        come in [a_x].
    load : tuple of (float, float)
        Times [s] and loads over that of the contact, linear between and constant before and
        after.
    frames : int or tuple of float
        How many fields are kept, at even distances in time, or the instants of which they are [s].
    tolerance : float
        Largest change of pressure in the last cycle of a step [p_h].
    max_cycles : int
        Cycles per step before another setting is tried.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    duration: Time | None = None
    stride: Annotated[int, Field(ge=1, le=8)] = 1
    start: Literal["smooth", "standing"] = "smooth"
    entrance: PositiveNumber = 2.5
    load: tuple[tuple[Instant, PositiveNumber], ...] = ()
    frames: (
        Annotated[int, Field(ge=0, le=10000)]
        | Annotated[tuple[Instant, ...], Field(max_length=10000)]
    ) = 25
    tolerance: Annotated[float, Field(gt=0, lt=0.1)] = 1e-3
    max_cycles: Annotated[int, Field(ge=1, le=1000)] = 20

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
        before = (-math.inf, self.load[0][1] if self.load else 1.0)
        for now in self.load:
            if time <= now[0]:
                if math.isinf(before[0]):
                    return now[1]
                part = (time - before[0]) / (now[0] - before[0])
                return before[1] + part * (now[1] - before[1])
            before = now
        return before[1]
