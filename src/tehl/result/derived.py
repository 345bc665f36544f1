"""Quantities that follow from the numbers of a summary: of a result, or of a stored row."""

import math
from collections.abc import Callable

from tehl.result.quantity import UNITS, Numbers

KAPPA = 1.3
"""kappa over lambda: ISO 281:2007, 9.3.3.1, takes kappa = lambda^1.3."""


def lambda_error(power: float) -> Callable[[Numbers], float | None]:
    """Return the bar of a power of lambda: that of the central film."""

    def error(numbers: Numbers) -> float | None:
        known = numbers.get("errors.central")
        return None if known is None else power * known

    return error


def kappa(numbers: Numbers) -> float | None:
    """Return the viscosity ratio of ISO 281 [-]; None without roughness."""
    ratio = numbers.get("roughness.lambda_central")
    return None if ratio is None or ratio <= 0 else float(ratio**KAPPA)


_SOLIDS = ("load_sharing", "touching")
"""Blocks of what carries load beside the film: asperities below the grid, and contact on it."""


def _has(numbers: Numbers, block: str) -> bool:
    return any(numbers.get(f"{block}.{key}") is not None for key in ("area_m2", "share"))


def _of_solids(numbers: Numbers, key: str) -> float | None:
    """Return a number summed over asperities and touching surfaces; None where it is not known."""
    known = [numbers.get(f"{one}.{key}") for one in _SOLIDS if _has(numbers, one)]
    return None if not known or None in known else float(sum(known))


def has_solids(numbers: Numbers) -> bool:
    """Return whether asperities or a boundary film are computed."""
    return any(_has(numbers, one) for one in _SOLIDS)


def share(numbers: Numbers) -> float | None:
    """Return the load on solids over the load [-]; None without them, or if it is not known."""
    return _of_solids(numbers, "share")


def share_error(numbers: Numbers) -> float | None:
    """Return the relative error bar of `share`; None where it is zero or not known."""
    carried, error = share(numbers), _of_solids(numbers, "share_error")
    return error / carried if carried and error is not None else None


def friction(numbers: Numbers) -> float | None:
    """Return the friction of film and solids; None if unknown, or more than an oil transmits."""
    if numbers.get("traction.credible") is False:
        return None
    sliding = numbers.get("traction.mid_film")
    sliding = (
        None if sliding is None else math.hypot(sliding, numbers.get("traction.across") or 0.0)
    )
    if not has_solids(numbers):
        return sliding
    rubbed = _of_solids(numbers, "friction_boundary")
    return None if rubbed is None else (sliding or 0.0) + rubbed


def friction_error(numbers: Numbers) -> float | None:
    """Return the bar of friction: that of the traction if only the film has friction.

    Each direction counts by its part of the square.
    """
    parts = [
        (numbers.get(f"traction.{part}") or 0.0, numbers.get(f"errors.traction_{part}"))
        for part in ("mid_film", "across")
    ]
    whole = sum(part**2 for part, bar in parts if bar is not None)
    if has_solids(numbers) or not whole:
        return None
    return float(sum(part**2 * bar for part, bar in parts if bar is not None) / whole)


def is_unphysical(path: str, numbers: Numbers) -> bool:
    """Return whether a number is the heat of a friction that no oil transmits."""
    is_heat = path.split(".", maxsplit=1)[0] in ("temperature", "heat", "bodies", "temperature_max")
    return is_heat and numbers.get("traction.credible") is False


def largest_temperature(numbers: Numbers) -> float | None:
    """Return the largest temperature of the film [K]; None for an isothermal run."""
    inlet, rise = (numbers.get(f"temperature.{key}") for key in ("inlet_k", "film_rise_max_k"))
    return None if inlet is None or rise is None else float(inlet + rise)


def largest_temperature_error(numbers: Numbers) -> float | None:
    """Return the bar of the largest temperature, that of the rise, over its degrees Celsius."""
    known, hottest = numbers.get("errors.film_rise_max"), largest_temperature(numbers)
    if known is None or hottest is None:
        return None
    celsius = hottest + UNITS["°C"][1]
    return abs(known * numbers.get("temperature.film_rise_max_k") / (celsius or 1.0))


def body_error(number: int) -> Callable[[Numbers], float | None]:
    """Return the bar of the temperature of a body, that of its heat, over its degrees Celsius.

    None where the temperature is stated.
    """

    def error(numbers: Numbers) -> float | None:
        heat, resistance = (
            numbers.get(f"bodies.{key}") for key in (f"heat_{number}_w", f"resistance_{number}")
        )
        known = numbers.get(f"errors.heat_surface_{number}")
        if known is None or resistance is None:
            return None
        celsius = numbers.get(f"bodies.temperature_{number}_k") + UNITS["°C"][1]
        return abs(known * resistance * heat / (celsius or 1.0))

    return error


def film_loss(numbers: Numbers) -> float | None:
    """Return the loss in the film [W]; None where it is not known.

    By rolling that of a line or roller has the oil upstream of the grid. A thick film of a point
    contact makes its pressure outside of the loaded zone, whose power then is not that of rolling.
    """
    whole = numbers.get("traction.friction_power_w")
    if whole is None:
        return None
    slid, rolled = numbers.get("traction.sliding_power_w") or 0.0, numbers.get("rolling.power_w")
    if rolled is None:
        rolled = whole - slid if whole > slid else None
    return None if rolled is None else float(slid + rolled)


def power_loss(numbers: Numbers) -> float | None:
    """Return the loss in film and solids [W]; None where `friction` is, or that of the film."""
    film = film_loss(numbers)
    if film is None or numbers.get("traction.credible") is False:
        return None
    if not has_solids(numbers):
        return film
    rubbed = _of_solids(numbers, "power_boundary_w")
    return None if rubbed is None else film + rubbed


def power_error(numbers: Numbers) -> float | None:
    """Return the bar of the loss: the larger of those of friction and of rolling.

    None also where that of friction is not known, and more than a hundredth of the loss is by it.
    """
    slides, slid = friction_error(numbers), numbers.get("traction.sliding_power_w") or 0.0
    if has_solids(numbers) or (slides is None and abs(slid) > 0.01 * (film_loss(numbers) or 0.0)):
        return None
    known = slides, numbers.get("errors.rolling")
    return max((bar for bar in known if bar), default=None)
