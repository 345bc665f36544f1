"""Profiles of rollers: how far their surface drops towards the ends.

A logarithmic profile presses the roller evenly over its length: Lundberg's [1]_

    z = A ln 1/(1 - s^2),   A = 2 w/(pi E'),   s = 2 y/length,

with w the load per length for which it is made. Its ends are infinitely deep; Johns and Gohar [2]_
have 1 - (1 - 0.3033 b/a) s^2 in its place, with b the half-width of the contact and a half the
length. ISO 16281 has A = 0.00035 D with D the diameter of the roller, up to a length of 2.5 D, and
beyond it 0.0005 D over the outer 1.25 D of each side.

References
----------
.. [1] G. Lundberg, Forschung auf dem Gebiete des Ingenieurwesens 10 (1939), 201-211.
.. [2] P. M. Johns and R. Gohar, Tribology International 14 (1981), 131-136.
"""

import math
from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Protocol, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from tehl.base.table import Table
from tehl.base.typing import Array, np
from tehl.base.units import Force, Length, Place
from tehl.contact.columns import lengths_over_y

LEAST_REST = 1e-3
"""Least 1 - s^2: the outermost 0.05 % of half the length have the drop of the place before."""


class Loaded(Protocol):
    """What a profile asks about its roller."""

    @property
    def length(self) -> float:
        """Return the length of the contact [m]."""

    @property
    def half_width(self) -> float:
        """Return b of the mean load [m]."""

    @property
    def amplitude(self) -> float:
        """Return 2 w/(pi E') of the mean load [m]."""

    @property
    def force(self) -> float:
        """Return the load [N]."""


class Crown(Table):
    """An arc along the axis, over the whole length or beyond a straight middle."""

    shape: Literal["crown"]
    radius: Length
    """Radius of the arc [m]."""
    straight: Annotated[Place, Field(ge=0)] = 0.0
    """Length in the middle that does not drop [m]."""

    def drop(self, s: Array, roller: Loaded) -> Array:
        """Return the drop [m].

        Parameters
        ----------
        s, roller : Array, Loaded
            2 y over the length [-], and its roller.
        """
        beyond = np.maximum(np.abs(0.5 * roller.length * s) - 0.5 * self.straight, 0.0)
        return 0.5 * beyond**2 / self.radius


class Logarithmic(Table):
    """Even pressure over the length under one load."""

    synonyms: ClassVar = {"design_load": "load force", "diameter": "d"}

    shape: Literal["logarithmic", "lundberg", "iso-16281"]
    """That of Johns and Gohar, whose ends have a finite drop; Lundberg's; that of the standard."""
    design_load: Force | None = None
    """Load for which the profile is made [N]; None is that of the contact."""
    diameter: Length | None = None
    """Diameter of the roller [m], of ISO 16281."""

    @model_validator(mode="after")
    def _must_have_its_constants(self) -> Self:
        if (self.shape == "iso-16281") != (self.diameter is not None):
            raise ValueError(
                'shape = "iso-16281" needs diameter, such as "12 mm", and no other shape does'
            )
        if self.diameter is not None and self.design_load is not None:
            raise ValueError(
                'shape = "iso-16281" has no design_load: its drop follows from diameter'
            )
        return self

    def drop(self, s: Array, roller: Loaded) -> Array:
        """Return the drop [m] at s = 2 y over the length of a roller."""
        if self.diameter is not None:
            return self._of_standard(s, roller.length, self.diameter)
        part = 1.0 if self.design_load is None else self.design_load / roller.force
        end = 0.3033 * math.sqrt(part) * roller.half_width / (0.5 * roller.length)
        rest = 1.0 - (1.0 - (end if self.shape == "logarithmic" else 0.0)) * s**2
        return -part * roller.amplitude * np.log(np.maximum(rest, LEAST_REST))

    @staticmethod
    def _of_standard(s: Array, length: float, diameter: float) -> Array:
        """Return the drop of ISO 16281 [m]."""
        longest = 2.5 * diameter
        factor = 0.00035 if length <= longest else 0.0005
        outside = np.maximum(np.abs(s) * length - max(length - longest, 0.0), 0.0)
        rest = 1.0 - (outside / min(length, longest)) ** 2
        return -factor * diameter * np.log(np.maximum(rest, LEAST_REST))


class Tabulated(Table):
    """Drops at places along the axis."""

    shape: Literal["table"]
    drops: Annotated[
        Annotated[tuple[tuple[Place, Place], ...], Field(min_length=2)],
        Field(json_schema_extra=lambda schema: schema.update(_or_file(schema))),
    ]
    """Places y [m] and drops there [m], linear between; or the name of a CSV file with both in two
    columns, in metres or with units in its header: ``y [mm], drop [um]``. Places from zero on are
    those of both sides."""

    @field_validator("drops", mode="before")
    @classmethod
    def _read_file(cls, value: object, info: ValidationInfo) -> object:
        return lengths_over_y(value, info, "drop")

    @model_validator(mode="after")
    def _places_must_increase(self) -> Self:
        if any(later <= earlier for (earlier, _), (later, _) in pairwise(self.drops)):
            raise ValueError("drops must have places y that increase")
        return self

    def fault(self, length: float) -> str:
        """Return what is wrong on a roller of a length [m], nothing if all is well."""
        first, last = self.drops[0][0], self.drops[-1][0]
        reach = min(last, -first if first < 0.0 else last)
        if reach >= 0.5 * length * (1.0 - 1e-9) and first <= 0.0:
            return ""
        return (
            f"drops: goes from y = {1e3 * first:.4g} to {1e3 * last:.4g} mm and does not cover the "
            f"length, {-500 * length:.4g} to {500 * length:.4g} mm, or its half from 0 on"
        )

    def drop(self, s: Array, roller: Loaded) -> Array:
        """Return the drop [m] at s = 2 y over the length of a roller."""
        places, drops = np.array(self.drops).T
        y = 0.5 * roller.length * s
        return np.interp(np.abs(y) if places[0] >= 0.0 else y, places, drops)

    @property
    def is_even(self) -> bool:
        """Whether both sides are alike."""
        if self.drops[0][0] >= 0.0:
            return True
        pairs = zip(self.drops, self.drops[::-1], strict=True)
        return all(
            math.isclose(y, -other_y, abs_tol=1e-12) and math.isclose(z, other, abs_tol=1e-12)
            for (y, z), (other_y, other) in pairs
        )


def _or_file(schema: dict[str, object]) -> dict[str, object]:
    array = {key: schema.pop(key) for key in list(schema) if key in ("type", "items", "minItems")}
    return {"anyOf": [array, {"type": "string"}]}


Profile = Annotated[Crown | Logarithmic | Tabulated, Field(discriminator="shape")]
"""The ``profile`` table of a roller."""
