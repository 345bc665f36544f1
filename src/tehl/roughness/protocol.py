"""What the solver knows of a rough surface, and the base of the models that say it.

Heights are positive outwards: a peak of either surface makes the film thinner. Coordinates are
those of the contact, x along entrainment; a surface carries its heights along x at its speed.
"""

import math
from typing import TYPE_CHECKING, Protocol

from pydantic import BaseModel, ConfigDict

if TYPE_CHECKING:
    from tehl.typing import Array

_ROUNDING = 1e-12
_STEEPEST = 0.25


Extent = tuple[tuple[float, float], tuple[float, float]]
"""From where to where a surface is rough along x and along y [m], perhaps without end."""
ENDLESS: Extent = ((-math.inf, math.inf), (-math.inf, math.inf))


class Roughness(Protocol):
    """Heights of one surface."""

    @property
    def is_smooth(self) -> bool:
        """Return whether the height is zero everywhere."""
        ...

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the heights mirror at y = 0, so that half of the domain may be solved."""
        ...

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x and along y [m]; infinite where there is none."""
        ...

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength in whatever direction [m]; infinite when smooth."""
        ...

    @property
    def rms(self) -> float:
        """Return the root mean square height Sq [m]; zero for features that stand alone."""
        ...

    def height(self, x: "Array", y: "Array", time: float = 0.0, speed: float = 0.0) -> "Array":
        """Return the heights [m] at ``x`` and ``y`` [m], which broadcast."""
        ...

    def resolved_on(self, dx: float, dy: float) -> "Roughness":
        """Return the surface without the waves that a mesh of ``dx`` by ``dy`` [m] cannot carry."""
        ...


class RoughnessModel(BaseModel):
    """Base of the surfaces that a formula gives: it moves them, and no mesh filters them."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def extent(self, length: float) -> Extent:
        """Return where the surface is rough at time zero, between y = -``length`` and ``length``.

        Of features, where more than two per cent of their height are left.
        """
        del length
        return ENDLESS

    def height(self, x: "Array", y: "Array", time: float = 0.0, speed: float = 0.0) -> "Array":
        """Return the heights at a time.

        Parameters
        ----------
        x, y : arrays that broadcast
            Coordinates of the contact [m], x along entrainment.
        time : float
            [s]; at zero the surface lies as it was stated.
        speed : float
            Speed of the surface along x [m/s].

        Returns
        -------
        Array
            Heights in the broadcast shape [m], positive outwards.
        """
        import numpy as np  # noqa: PLC0415 (the command explains a case without arrays)

        along = np.asarray(x, dtype=np.float64) - speed * time
        return self._at_rest(along, np.asarray(y, dtype=np.float64))

    def _at_rest(self, x: "Array", y: "Array") -> "Array":
        """Return the heights [m] in the coordinates of the body [m]."""
        raise NotImplementedError

    def resolved_on(self, dx: float, dy: float) -> "Roughness":
        """Return the surface itself: a formula is exact on every mesh."""
        del dx, dy
        return self  # type: ignore[return-value]  # the subclasses have the rest of the protocol

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return sentences on what is odd beside a contact of ``width`` by ``length`` [m]: none."""
        del width, length
        return ()


def direction(angle: float) -> tuple[float, float]:
    """Return cosine and sine of ``angle`` [rad], exact at multiples of a right angle."""
    return tuple(_snapped(value) for value in (math.cos(angle), math.sin(angle)))  # type: ignore[return-value]


def _snapped(value: float) -> float:
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < _ROUNDING else value


def along_axes(wavelength: float, angle: float) -> tuple[float, float]:
    """Return what a ``wavelength`` across crests at ``angle`` measures along x and y [m]."""
    cosine, sine = direction(angle)
    return (
        wavelength / abs(cosine) if cosine else math.inf,
        wavelength / abs(sine) if sine else math.inf,
    )


def check_gentle(amplitude: float, **lengths: float) -> None:
    """Refuse an amplitude [m] that is large beside a length on which the height changes [m].

    Raises
    ------
    ValueError
        If it is: Reynolds' equation asks for gentle slopes, and most often a unit is wrong.
    """
    for name, length in lengths.items():
        if not abs(amplitude) <= _STEEPEST * length:
            raise ValueError(
                f"amplitude = {amplitude:g} m is not small beside {name} = {length:g} m, at most "
                f"{_STEEPEST:g} of it: check their units"
            )
