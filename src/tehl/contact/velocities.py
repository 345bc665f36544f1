"""Velocities of both surfaces as vectors, in place of speeds, slide-roll ratio and angles."""

import math
from collections.abc import Mapping
from typing import Annotated, Any

from tehl.base.units import Quantity

SIGNED_SPEED = Quantity("a speed", "m/s", '"1.5 m/s"', "any")
Velocity = tuple[Annotated[float, SIGNED_SPEED], Annotated[float, SIGNED_SPEED]]
"""Components along the axes of radius_x and radius_y [m/s]."""
KEYS = ("velocity_1", "velocity_2")
"""Keys of the velocities of both surfaces."""
PARALLEL_SINE = 1e-12
"""Sine of the angle of sliding to the entrainment below which they are parallel: rounding."""


def with_motion(stated: Any) -> Any:
    """Return a table of a contact with the speeds and angles that velocities in it make.

    Parameters
    ----------
    stated : object
        Table of a contact; anything else is returned as it is.

    Raises
    ------
    ValueError
        If it states other speeds or angles too, only one velocity, or velocities without a mean.
    """
    given = [key for key in KEYS if isinstance(stated, Mapping) and stated.get(key) is not None]
    if not given:
        return stated
    if len(given) < len(KEYS):
        raise ValueError(f"states {given[0]} alone: give velocity_1 and velocity_2")
    try:
        first, second = (_parsed(stated[key]) for key in KEYS)
    except (TypeError, ValueError):
        return {"entrainment_speed": 1.0, **stated}  # the field itself reports its mistake
    made = _motion_of(first, second)
    for key, value in made.items():
        if stated.get(key) not in (None, value):
            raise ValueError(f"states velocity_1, velocity_2 and {key}: leave out {key}")
    if stated.get("moes_speed") is not None:
        raise ValueError("states velocity_1, velocity_2 and moes_speed: leave out moes_speed")
    return {**stated, **made}


def _parsed(stated: Any) -> tuple[float, float]:
    """Return both components [m/s]."""
    along, across = stated
    return SIGNED_SPEED.parse(along), SIGNED_SPEED.parse(across)


def _motion_of(first: tuple[float, float], second: tuple[float, float]) -> dict[str, float]:
    """Return size and direction of the mean of two velocities [m/s], and of their difference."""
    x, y = (0.5 * (one + other) for one, other in zip(first, second, strict=True))
    along, across = (one - other for one, other in zip(first, second, strict=True))
    mean, sliding = math.hypot(x, y), math.hypot(along, across)
    if not mean > PARALLEL_SINE * sliding:
        raise ValueError("states velocity_1 and velocity_2 whose mean is zero: it drags no oil in")
    with_mean, beside = x * along + y * across, x * across - y * along
    is_along = abs(beside) <= PARALLEL_SINE * mean * sliding
    return {
        "entrainment_speed": mean,
        "entrainment_angle": math.atan2(y, x),
        "slide_roll_ratio": (math.copysign(sliding, with_mean) if is_along else sliding) / mean,
        "sliding_angle": 0.0 if is_along else math.atan2(beside, with_mean),
    }
