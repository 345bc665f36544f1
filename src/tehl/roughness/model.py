"""What the solver requires of a rough surface, and what the models of it share.

Heights are positive outwards: a peak of either surface makes the film thinner. Coordinates are
those of the contact, x along entrainment; a surface carries its heights along x at its speed.
"""

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator

from tehl.base.table import Table
from tehl.base.typing import Array, np
from tehl.base.units import Height, Length, Quantity, quantity

_PER_MEAN = math.sqrt(0.5 * math.pi)
"""Root mean square over mean absolute height of Gaussian heights."""
_LARGEST_STEEPNESS = 0.25

Extent = tuple[tuple[float, float], tuple[float, float]]
"""From where to where a surface is rough along x and along y [m], perhaps without end."""
ENDLESS: Extent = ((-math.inf, math.inf), (-math.inf, math.inf))
Edge = Literal["periodic", "mirror", "flat"]
"""What lies beyond the edges of a map: the map again, its mirror image, or nothing."""
BEYOND: dict[Edge, str] = {
    "flat": "beyond its edges the surface is flat",
    "periodic": "beyond its edges it repeats",
    "mirror": "beyond its edges it is mirrored",
}


class Roughness:
    """Heights of one surface; a formula is exact on every mesh."""

    if TYPE_CHECKING:  # a field of some surfaces

        @property
        def rms(self) -> float:
            """Return the root mean square height Sq [m]; zero for single features."""

    @property
    def summands(self) -> tuple[Any, ...]:
        """Return the surfaces whose heights are added, this one alone if it is not a sum."""
        return (self,)

    @property
    def is_smooth(self) -> bool:
        """Return whether the height is zero everywhere."""
        return False

    @property
    def is_even_in_y(self) -> bool:
        """Return whether the heights mirror at y = 0, so that half of the domain may be solved."""
        return self.is_smooth

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest wavelengths along x and along y [m]; infinite where there is none."""
        return self.shortest_wavelength, self.shortest_wavelength

    @property
    def shortest_wavelength(self) -> float:
        """Return the shortest wavelength in any direction [m]; infinite when smooth."""
        return math.inf

    def height(self, x: Array, y: Array, time: float = 0.0, speed: float = 0.0) -> Array:
        """Return the heights at a time.

        Parameters
        ----------
        x, y : arrays that broadcast
            Coordinates of the contact [m], x along entrainment.
        time : float
            [s]; at zero the surface lies as stated.
        speed : float
            Speed of the surface along x [m/s].

        Returns
        -------
        Array
            Heights in the broadcast shape [m], positive outwards.
        """
        along = np.asarray(x, dtype=np.float64) - speed * time
        return self._at_rest(along, np.asarray(y, dtype=np.float64))

    def _at_rest(self, x: Array, y: Array) -> Array:
        """Return the heights [m] in the coordinates of the body [m]."""
        raise NotImplementedError

    def resolved_on(self, dx: float, dy: float) -> "Roughness":
        """Return the surface without the waves that a mesh cannot carry.

        Parameters
        ----------
        dx, dy : float
            Mesh widths along x and y [m]; no formula is filtered.
        """
        del dx, dy
        return self


class RoughnessModel(Roughness, Table):
    """Base of the surfaces of a case file."""

    def extent(self, length: float) -> Extent:
        """Return where the surface is rough at time zero, between y = -``length`` and ``length``.

        For features, where more than two per cent of their height are left.
        """
        del length
        return ENDLESS

    def fits(self, width: float, length: float) -> tuple[str, ...]:
        """Return sentences on what is unusual about the surface for a contact.

        Parameters
        ----------
        width, length : float
            Axes of the Hertz ellipse along x and y [m].
        """
        del width, length
        return ()


class Smooth(RoughnessModel):
    """A surface without roughness."""

    type: Literal["smooth"] = "smooth"
    rms: ClassVar[float] = 0.0

    @property
    def is_smooth(self) -> bool:
        """Return True."""
        return True

    def _at_rest(self, x: Array, y: Array) -> Array:
        return 0.0 * (x + y)


def direction(angle: float) -> tuple[float, float]:
    """Return cosine and sine of ``angle`` [rad], exact at multiples of a right angle."""
    cosine, sine = (
        round(value) if abs(value - round(value)) < 1e-12 else value  # rounding of pi
        for value in (math.cos(angle), math.sin(angle))
    )
    return float(cosine), float(sine)


class TileModel(RoughnessModel):
    """Base of the surfaces that are heights on a lattice."""

    @property
    def _tile(self) -> Roughness:
        raise NotImplementedError

    def _at_rest(self, x: Array, y: Array) -> Array:
        return self._tile.height(x, y)

    def resolved_on(self, dx: float, dy: float) -> Roughness:
        """Return the surface without the waves that a mesh cannot carry."""
        return self._tile.resolved_on(dx, dy)


def wavelength_of(number: float) -> float:
    """Return the wavelength [m] at a wave ``number`` [rad/m]."""
    return 2.0 * math.pi / number if number > 0 else math.inf


def with_rms(stated: Any, mean: str, rms: str) -> Any:
    """Return a table with the root mean square height in place of the mean absolute height.

    Gaussian heights are assumed, Sq = sqrt(pi/2) Sa.

    Parameters
    ----------
    stated : object
        Table of a surface; anything else is returned as it is.
    mean, rms : str
        Keys of both heights.

    Raises
    ------
    ValueError
        If both are stated and differ.
    """
    if not isinstance(stated, Mapping) or stated.get(mean) is None:
        return stated
    try:
        of_mean = _PER_MEAN * quantity(Height).parse(stated[mean])
    except ValueError:
        return {rms: 0.0, **stated}  # the field itself reports its mistake
    given = stated.get(rms)
    if given and given != of_mean:
        raise ValueError(f"states {mean} and {rms}: only one of them may be given")
    return {**stated, rms: of_mean}


def check_slope(amplitude: float, **lengths: float) -> None:
    """Raise ValueError if an amplitude [m] is large beside a length of its slopes [m].

    Reynolds' equation requires small slopes, and most often a unit is wrong.
    """
    for name, length in lengths.items():
        if not abs(amplitude) <= _LARGEST_STEEPNESS * length:
            raise ValueError(
                f"amplitude = {amplitude:g} m is not small beside {name} = {length:g} m, at most "
                f"{_LARGEST_STEEPNESS:g} of it: check their units"
            )


# ---- quantities

SignedHeight = Annotated[
    float, Quantity(name="a height", unit="m", example='"-0.3 um"', sign="any")
]
Position = Annotated[float, Quantity(name="a position", unit="m", example='"0.1 mm"', sign="any")]
Wavelength = Annotated[float, Quantity(name="a length", unit="m", example='"50 um"')]

_WORDS = {"micron": "um"} | {
    f"{prefix}{metre}": f"{letter}m"
    for prefix, letter in (("", ""), ("milli", "m"), ("micro", "u"), ("nano", "n"))
    for metre in ("meter", "metre")
}
_MULTIPLE = re.compile(r"([\d.]+(?:[eE][+-]?\d+)?)?\s*(.+)")
_ANGSTROMS = ("Å", "\N{ANGSTROM SIGN}", "angstrom", "A")


def metres(unit: str) -> float | None:
    """Return the factor from a unit of length, or a multiple such as "50 nm", to metres.

    None if it is not one.
    """
    text = unit.strip().removeprefix("Â")  # a micro sign of two bytes, read as two letters
    if text in _ANGSTROMS or text.lower() in _ANGSTROMS:
        return 1e-10
    match = _MULTIPLE.fullmatch(text)
    number, name = (match[1] or "1", match[2]) if match else ("1", text)
    word = _WORDS.get(name.lower()) or _WORDS.get(name.lower().removesuffix("s"), name)
    try:
        return quantity(Length).parse(f"{number} {word}")
    except ValueError:
        return None


def _is_length(unit: str) -> str:
    if metres(unit) is None:
        raise ValueError(
            'is not a unit of length: give one such as "um", or a multiple such as "50 nm"'
        )
    return unit


LengthUnit = Annotated[str, AfterValidator(_is_length)]


def _pair(value: Any) -> Any:
    """Double a single value."""
    return value if isinstance(value, list | tuple) else (value, value)


_Pair = tuple[Wavelength, Wavelength]
Lengths = Annotated[_Pair, BeforeValidator(_pair, json_schema_input_type=_Pair | Wavelength)]
Span = tuple[Position, Position]
