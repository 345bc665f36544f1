"""Supply of oil and cavitation: the ``[supply]`` and ``[cavitation]`` tables of a case."""

from itertools import pairwise
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, StrictBool, ValidationInfo, field_validator, model_validator

from tehl.base.table import Table
from tehl.base.units import Height, Length, Place, Quantity, Ratio
from tehl.contact.columns import lengths_over_y

THINNEST_LAYER, THICKEST_LAYER = 1e-9, 1e-2
"""Limits of the thickest layer of a supply [m]."""
OilRatio = Annotated[float, Quantity("a plain number", "-", "0.5")]


class Supply(Table):
    """The oil that reaches the inlet: a layer on both surfaces, thinner than the gap far upstream.

    Exactly one of ``layer``, ``profile`` and ``ratio`` is stated.
    """

    synonyms: ClassVar = {"layer": "film oil_film inlet_film film_thickness height"}

    layer: Height | None = None
    """Thickness of the oil on both surfaces together [m]."""
    each: StrictBool = False
    """Whether ``layer`` and ``profile`` are on each surface, instead of both together."""
    profile: Annotated[
        Annotated[tuple[tuple[Place, Height], ...], Field(min_length=2)] | None,
        Field(json_schema_extra=lambda schema: schema["anyOf"].append({"type": "string"})),
    ] = None
    """Places y [m] and layers there [m], linear between; or the name of a CSV file with both in two
    columns, in metres or with their units in its header: ``y [mm], layer [um]``."""
    ratio: Annotated[OilRatio, Field(ge=1e-3, le=1e3)] | None = None
    """Oil that enters, over what the fully flooded contact passes on at its centre [-]."""
    passes: Annotated[int, Field(ge=2, le=100_000)] | None = None
    """Times that the same surfaces pass the contact: the oil that leaves it comes back."""
    track: Length | None = None
    """Length of the running tracks of both surfaces together [m]: a pass takes half of it over the
    entrainment speed."""
    loss: Annotated[Ratio, Field(lt=1.0)] = 0.0
    """Part of the oil that is lost between two passes [-]."""
    replenishment: Annotated[float, Quantity("a speed", "m/s", '"0.1 nm/s"', "non-negative")] = 0.0
    """Oil that comes back to both surfaces together, as thickness over time [m/s]."""

    @field_validator("profile", mode="before")
    @classmethod
    def _read_file(cls, value: object, info: ValidationInfo) -> object:
        return lengths_over_y(value, info, "layer")

    @model_validator(mode="after")
    def _once(self) -> Self:
        stated = [one for one in ("layer", "profile", "ratio") if getattr(self, one) is not None]
        if not stated:
            raise ValueError('lacks the oil: give layer = "0.2 um", a profile over y, or a ratio')
        if len(stated) > 1:
            raise ValueError(f"states the oil twice: {' and '.join(stated)}; give one")
        if self.layer is not None:
            _check_layer("layer", self.layer)
        if self.each and self.ratio is not None:
            raise ValueError("each belongs to layer or profile: ratio is of all the oil")
        self._check_profile(self.profile or ())
        if self.passes is not None and self.track is None:
            raise ValueError(
                'track is missing: passes need the length of both running tracks, such as "250 mm"'
            )
        if self.passes is None and (self.loss or self.replenishment):
            raise ValueError("loss and replenishment act between passes: state passes too")
        return self

    def pass_seconds(self, speed: float) -> float:
        """Return the time between two passes at an entrainment speed [s]."""
        assert self.track is not None
        return 0.5 * self.track / speed

    def _check_profile(self, profile: tuple[tuple[float, float], ...]) -> None:
        if any(later <= earlier for (earlier, _), (later, _) in pairwise(profile)):
            raise ValueError("profile must have places y that increase")
        if profile:
            _check_layer("profile", max(layer for _, layer in profile))

    @property
    def is_even_in_y(self) -> bool:
        """Whether the oil is symmetric about y = 0."""
        points = self.profile or ()
        mirrored = tuple((-y, layer) for y, layer in reversed(points))
        return all(
            abs(y - other_y) <= 1e-9 * abs(y) and abs(layer - other) <= 1e-9 * abs(layer)
            for (y, layer), (other_y, other) in zip(points, mirrored, strict=True)
        )


def _check_layer(key: str, layer: float) -> None:
    """Raise ValueError if the thickness of a layer is not that of oil between surfaces."""
    if not THINNEST_LAYER <= layer <= THICKEST_LAYER:
        raise ValueError(
            f"{key} = {layer:g} m must be between {1e9 * THINNEST_LAYER:g} nm, the size "
            f"of a molecule, and {1e3 * THICKEST_LAYER:g} mm"
        )


class Cavitation(Table):
    """What happens to the oil where the pressure is zero."""

    model: Literal["reynolds", "conserving"] = "reynolds"
    """``"reynolds"`` does not ask where the oil of a cavity comes from or goes to; ``"conserving"``
    computes how far the gap is filled. A ``[supply]`` needs the latter, and chooses it."""
