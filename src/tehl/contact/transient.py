"""Settings of a transient run: the ``[transient]`` table of a case."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from tehl.base.table import Table
from tehl.base.units import Instant, PositiveNumber, Time
from tehl.contact.course import LoadCourse, RadiusCourse, RatioCourse, SpeedCourse

MOTION = ("entrainment_speed", "slide_roll_ratio", "sliding_speed")
COURSES = ("load", *MOTION, "radius")
"""Keys of what changes in time: motion, and all."""


class Transient(Table):
    """A transient run: surfaces carry their roughness, load, motion and radius may vary."""

    other_words: ClassVar = {
        "radius_y": "only the radius along x varies in time; state radius_y under [contact]"
    }
    synonyms: ClassVar = {
        "duration": "time end_time t_end end",
        "stride": "dt step time_step",
        "radius": "radius_x",
    }

    duration: Time | None = None
    """Duration of the run [s]; None is until all moving roughness has passed the contact, of waves
    2.5 wavelengths."""
    stride: Annotated[int, Field(ge=1, le=8)] = 1
    """Mesh widths that the mean motion passes per time step: changes are resolved as on a grid
    coarser by this factor. Left out, it is 1, and on fine grids more between smooth surfaces."""
    start: Literal["smooth", "standing"] = "smooth"
    """Film at time zero: of smooth surfaces, with waves and random surfaces that enter from the
    inlet; or the steady film of the rough surfaces at rest."""
    entrance: PositiveNumber = 2.5
    """Distance upstream of the contact at which waves and random surfaces that enter begin at time
    zero [a_x]."""
    load: LoadCourse = ()
    """Times [s] and loads over that of the contact, or with their unit, linear between and constant
    before and after; a formula of t, ``"1 + 0.3*sin(t/(2 ms))"``; or the name of a CSV file."""
    entrainment_speed: SpeedCourse = ()
    """The same of the mean speed of both surfaces; negative where they move against x."""
    slide_roll_ratio: RatioCourse = ()
    """The same of sliding over entrainment speed; left out, that of the contact at all speeds."""
    sliding_speed: SpeedCourse = ()
    """The same of u_1 - u_2 in place of the ratio; a plain number is over the entrainment speed of
    the contact."""
    radius: RadiusCourse = ()
    """The same of the reduced radius along x."""
    frames: (
        Annotated[int, Field(ge=0, le=10000)]
        | Annotated[tuple[Instant, ...], Field(max_length=10000)]
    ) = 25
    """Number of stored fields, evenly spaced in time, or their times [s]."""
    tolerance: Annotated[float, Field(gt=0, lt=0.1)] = 1e-3
    """Largest change of pressure in the last cycle of a step [p_h]."""
    max_cycles: Annotated[int, Field(ge=1, le=1000)] = 20
    """Cycles per step before the next relaxation is tried."""

    @property
    def slides_in_time(self) -> bool:
        """Whether the sliding has a course of its own."""
        return bool(self.slide_roll_ratio or self.sliding_speed)

    @model_validator(mode="after")
    def _slides_once(self) -> Self:
        if self.slide_roll_ratio and self.sliding_speed:
            raise ValueError("slide_roll_ratio and sliding_speed state the same: leave out one")
        return self
