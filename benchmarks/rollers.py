"""Rollers of bearings, gears and cams by a seed and a number, as data sheets have them.

Cylindrical, tapered, spherical and needle rollers on their rings, teeth of spur gears and rollers
of cams; some are tilted, heated, between asperities or short of oil.
"""

import math
from typing import Any

import numpy as np

from tehl.api.problem import ContactProblem, case_from_tables

KINDS = (
    "cylindrical inner",
    "cylindrical outer",
    "tapered",
    "spherical",
    "spur gear",
    "cam roller",
    "needle",
)
GRADES = (10, 32, 68, 100, 220, 460)
"""ISO grades: kinematic viscosity at 40 degC [mm^2/s]."""
TILTS = {"tapered": 6e-4, "spur gear": 3e-4}
"""Largest tilts of rollers of bearings and of teeth [rad]."""
TILTED, HEATED, LEAST_HEATED_SLIDE, ROUGH, STARVED = 0.4, 0.5, 0.02, 0.35, 0.12
"""How often rollers of bearings and teeth are tilted, those that slide by more than the third are
heated, and any are rough or starved."""


class _Draw:
    """Random numbers of one contact."""

    def __init__(self, seed: int, number: int) -> None:
        self.rng = np.random.default_rng([seed, number])

    def between(self, low: float, high: float) -> float:
        """Return a number whose logarithm is even between two limits."""
        return float(np.exp(self.rng.uniform(math.log(low), math.log(high))))

    def even(self, low: float, high: float) -> float:
        """Return a number even between two limits."""
        return float(self.rng.uniform(low, high))

    def happens(self, part: float) -> bool:
        """Return true in a part of all draws."""
        return bool(self.rng.random() < part)


def contact(seed: int, number: int) -> tuple[str, set[str], ContactProblem]:
    """Return kind, features and problem of a contact.

    Parameters
    ----------
    seed, number : int
        The draw.
    """
    draw, features = _Draw(seed, number), set()
    kind = str(draw.rng.choice(KINDS))
    stated = _in_gears_and_cams(draw, kind) or _in_bearing(draw, kind)
    if "tilt" in stated:
        features.add("tilt")
    tables: dict[str, Any] = {
        "contact": {"type": "roller"} | stated,
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": _oil(draw),
    }
    if abs(stated["slide_roll_ratio"]) > LEAST_HEATED_SLIDE and draw.happens(HEATED):
        tables["thermal"] = {}
        features.add("heated")
    if draw.happens(ROUGH):
        rms = draw.between(0.05e-6, 0.6e-6)
        tables["asperities"] = {
            "model": "greenwood-tripp",
            "rms": rms,
            "summit_radius": rms * draw.between(20, 200),
            "summit_density": 0.05 / (rms**2 * draw.between(20, 200)),
        }
        features.add("asperities")
    if draw.happens(STARVED):
        tables["supply"] = {"ratio": draw.even(0.3, 2.0)}
        features.add("starved")
    return kind, features, case_from_tables(tables)[0]


def _in_bearing(draw: _Draw, kind: str) -> dict[str, Any]:
    """Return a roller of logarithmic profile on a ring; needles are long."""
    is_needle, is_outer = kind == "needle", kind == "cylindrical outer"
    diameter = draw.between(*((1.5e-3, 4e-3) if is_needle else (6e-3, 40e-3)))
    length = diameter * draw.between(*((3, 8) if is_needle else (0.9, 1.8)))
    ring = 0.5 * diameter * draw.between(3.5, 8) + (diameter if is_outer else 0.0)
    stated: dict[str, Any] = {
        "radius": 1.0 / (2.0 / diameter + (-1.0 if is_outer else 1.0) / ring),
        "length": length,
        "hertz_pressure": draw.between(0.5e9, 2.2e9),
        "entrainment_speed": draw.between(0.3, 15.0),
    }
    shape = str(draw.rng.choice(["lundberg", "logarithmic", "iso-16281"]))
    stated["profile"] = {"shape": shape}
    if shape == "iso-16281":
        stated["profile"]["diameter"] = diameter
    if draw.happens(TILTED):
        stated["tilt"] = draw.even(0.0, TILTS["tapered"])
    return stated | {"slide_roll_ratio": draw.even(0.0, 0.05)}


def _in_gears_and_cams(draw: _Draw, kind: str) -> dict[str, Any] | None:
    """Return a crowned roller or tooth, or the roller of a cam; None of other kinds."""
    stated: dict[str, Any]
    if kind == "spherical":
        diameter = draw.between(10e-3, 40e-3)
        length = diameter * draw.between(0.9, 1.3)
        stated = {
            "radius": 0.4 * diameter,
            "length": length,
            "hertz_pressure": draw.between(0.5e9, 1.8e9),
            "entrainment_speed": draw.between(0.3, 8.0),
        }
        stated["profile"] = {"shape": "crown", "radius": draw.between(30, 300) * length}
        return stated | {"slide_roll_ratio": draw.even(0.0, 0.05)}
    if kind == "spur gear":
        stated = {
            "radius": draw.between(4e-3, 40e-3),
            "length": draw.between(8e-3, 60e-3),
            "hertz_pressure": draw.between(0.4e9, 1.6e9),
            "entrainment_speed": draw.between(0.5, 25.0),
        }
        crown = draw.between(0.8, 20) * stated["length"] / 0.01
        stated["profile"] = {"shape": "crown", "radius": crown}
        stated["slide_roll_ratio"] = draw.even(-1.2, 1.2)
        return stated | ({"tilt": draw.even(0.0, TILTS[kind])} if draw.happens(TILTED) else {})
    if kind != "cam roller":
        return None
    stated = {
        "radius": draw.between(5e-3, 20e-3),
        "length": draw.between(6e-3, 16e-3),
        "hertz_pressure": draw.between(0.4e9, 1.4e9),
        "entrainment_speed": draw.between(0.5, 10.0),
        "profile": {"shape": "logarithmic"},
    }
    return stated | {"slide_roll_ratio": draw.even(0.0, 0.1)}


def _oil(draw: _Draw) -> dict[str, Any]:
    """Return a mineral oil of a grade, between 40 and 110 degC."""
    grade = float(draw.rng.choice(GRADES))
    celsius = draw.even(40.0, 110.0)
    return {
        "viscosity": {
            "law": "walther",
            "nu_40": grade * 1e-6,
            "nu_100": (grade / 32.0) ** 0.62 * 5.4e-6,
            "alpha": draw.between(1.4e-8, 2.4e-8),
        },
        "density": {"law": "dowson-higginson", "rho_0": 870.0},
        "temperature": celsius + 273.15,
        "shear": {"law": "eyring", "stress": draw.between(3e6, 9e6)},
        "conductivity": 0.14,
        "heat_capacity": 2000.0,
    }
