"""Families of quantities that have one form, for the table of `tehl.result.quantities`."""

import math
from collections.abc import Callable, Iterator
from operator import attrgetter
from typing import Any

from tehl.result.derived import body_error
from tehl.result.quantity import Quantity

DYNAMICS = (
    "frequency_hz stiffness_n_per_m damping_n_s_per_m stiffness_error_n_per_m "
    "damping_error_n_s_per_m amplitude_m load_by_speed_n_s_per_m "
    "load_by_acceleration_n_s2_per_m "
    "rolling_stiffness_n_per_m rolling_damping_n_s_per_m rolling_by_speed_n_s_per_m "
    "rolling_by_acceleration_n_s2_per_m"
)
"""Keys of a row over frequency: fields of `tehl.result.fields.FilmDynamics` with their units."""


def words_in(name: str, places: str, **others: str) -> dict[str, str]:
    """Return the words of a quantity that has one name in several places."""
    return dict.fromkeys(places.split(), name) | others


def plain(block: str, keys: str) -> Iterator[Quantity]:
    """Yield quantities that are attributes of the owner of a block, and shown nowhere else."""
    for key in keys.split():
        yield Quantity(f"{block}.{key}")


def of_part(block: str, part: str, keys: str) -> Iterator[Quantity]:
    """Yield quantities that are attributes of a part of the owner of a block."""
    for key in keys.split():
        yield Quantity(f"{block}.{key}", attrgetter(f"{part}.{key}"))


def of_rolling() -> Iterator[Quantity]:
    """Yield the quantities of lines and rollers that roll."""
    for key, attribute, bar, unit, name in (
        ("moment_n_m", "moment", "rolling", "N mm", "rolling moment"),
        ("tilting_moment_n_m", "tilting", "tilting", "N mm", "tilting moment"),
        ("tilt_rad", "tilt", "tilt", "mrad", "tilt"),
    ):
        yield Quantity(
            f"rolling.{key}",
            attrgetter(attribute),
            name=bar,
            certified="following",
            unit=unit,
            words=words_in(name, "axis list report", bar=name),
        )
    yield Quantity("rolling.force_n", attrgetter("force"), name="rolling")
    yield from plain("rolling", "power_w shift_m tail_share closure_error T")


def of_body(number: int) -> Iterator[Quantity]:
    """Yield the quantities of a body that is heated by the contact."""
    name = f"temperature of body {number}"
    yield Quantity(
        f"bodies.temperature_{number}_k",
        error=body_error(number),
        symbol=f"T_{number}",
        unit="°C",
        digits="0.0",
        words=words_in(name, "axis list page", key=f"t_{number}"),
    )
    yield Quantity(
        f"bodies.heat_{number}_w",
        error=lambda numbers: numbers.get(f"errors.heat_surface_{number}"),
        unit="W",
        words=words_in(f"heat into body {number}", "axis list"),
    )
    yield Quantity(f"bodies.resistance_{number}")


def lists(block: str, keys: str) -> Iterator[Quantity]:
    """Yield quantities that are lists of numbers, and shown nowhere else."""
    for key in keys.split():
        yield Quantity(f"{block}.{key}.0")


def finite(value: float) -> float | None:
    """Return a number, None where it is infinite: that of an ellipse which is a line."""
    return value if math.isfinite(value) else None


def positive(value: float) -> float | None:
    """Return a film, None where it is not positive."""
    return value if value > 0 else None


def moes_film_factor(solution: Any) -> float:
    """Return what turns H into the Moes film ``(h/R_x) (2U)^(-1/2)``.

    For a circle this is ``(3M/2)^(2/3)``.
    """
    scales, groups = solution.scales, solution.groups
    # h = H a_x^2/R_x with R_x = a_x^2 / (a_x^2/R_x), so h/R_x = H (film_thickness/a_x)^2.
    return float((scales.film_thickness / scales.half_width_x) ** 2 / math.sqrt(2.0 * groups.U))


def scaled_film(which: str, *, moes: bool = False) -> Callable[[Any], Any]:
    """Return a film over its scale, or as Moes has it."""

    def value(found: Any) -> float | None:
        film = getattr(found.solution.film, which) / found.solution.scales.film_thickness
        return positive(film * moes_film_factor(found.solution) if moes else film)

    return value


def if_known(name: str) -> Callable[[Any], Any]:
    """Return what follows from the share where surfaces touch: nothing if that is not known."""
    return lambda found: getattr(found, name) if found.is_share_known else None


def last(name: str) -> Callable[[Any], Any]:
    """Return a number of the last cycle."""
    return lambda found: getattr(found.solution.history[-1], name) if found.finest else None
