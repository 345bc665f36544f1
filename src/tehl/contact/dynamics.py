"""Stiffness and damping of the film: the ``[dynamics]`` table of a case."""

import math
from itertools import pairwise
from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

from tehl.base.table import Table
from tehl.base.units import Frequency, Length

NUMBER_OF_FREQUENCIES, OMEGA_RANGE = 19, (0.03, 30.0)
"""Frequencies where none are stated, and their range as omega a_x / u_m [-]: below it stiffness and
damping have their values at rest, and above it waves are shorter than a fifth of the contact."""


class Dynamics(Table):
    """Frequencies at which stiffness and damping of the film are computed, beside zero."""

    synonyms: ClassVar = {"frequencies": "frequency freq f omega", "held_at": "reference distance"}

    frequencies: Annotated[tuple[Frequency, ...], Field(min_length=1, max_length=500)] | None = None
    """Increasing frequencies [Hz]; left out, 19 of omega a_x/u_m from 0.03 to 30."""

    held_at: Length | None = None
    """Of a line contact, distance along x from the contact at which the surfaces of both bodies do
    not move [m]: without one the approach of half-spaces has no limit. R_x if left out."""

    @model_validator(mode="after")
    def _must_increase(self) -> Self:
        for earlier, later in pairwise(self.frequencies or ()):
            if not later > earlier:
                raise ValueError(
                    f"frequencies = [..., {earlier:g}, {later:g}, ...] Hz: each must exceed the "
                    "one before"
                )
        return self

    def over(self, time: float) -> list[float]:
        """Return zero and the frequencies [Hz] of a contact with a_x/u_m = ``time`` [s]."""
        found = self.frequencies
        if found is None:
            first, last = OMEGA_RANGE
            ratio = (last / first) ** (1.0 / (NUMBER_OF_FREQUENCIES - 1))
            omegas = (first * ratio**number for number in range(NUMBER_OF_FREQUENCIES))
            found = tuple(omega / (2.0 * math.pi * time) for omega in omegas)
        return [0.0, *(one for one in found if one > 0.0)]
