"""Random contacts of everything that a case may state, by a seed and a number."""

import math
from typing import Any

import numpy as np

from tehl.api.problem import ContactProblem
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import ScaledProblem

SOLIDS = ("steel", "steel", "steel", "glass", "bronze", "silicon-nitride", "peek")
LOADS, SPEEDS, RATIOS, RADII = (2.0, 2000.0), (0.5, 20.0), (0.5, 5.0), (1e-3, 0.1)
"""Ranges of M, L, R_y / R_x and R_x [m], uniform in the logarithm."""
LARGEST_SLIDE = 1.9
ELLIPTIC, SLIDING, HEATED, ROUGH = 0.5, 0.5, 1 / 3, 0.25
"""Parts of the contacts."""
CREDIBLE = (0.02, 50.0)
"""Entrainment speeds of heated contacts [m/s]."""
GRADES = ((10, 2.6), (32, 5.4), (68, 8.7), (150, 14.7), (320, 24.0))
"""Kinematic viscosities at 40 and 100 degC [mm^2/s]."""


def between(rng: np.random.Generator, limits: tuple[float, float]) -> float:
    """Return a number uniform in the logarithm."""
    return float(math.exp(rng.uniform(*map(math.log, limits))))


def contact(seed: int, number: int) -> tuple[ContactProblem, str]:
    """Return a random contact and its class: isothermal, thinning, heated or rough.

    The combinations that no case may state are drawn again.
    """
    rng = np.random.default_rng([seed, number])
    while True:
        tables = _tables(rng)
        try:
            problem = ContactProblem.model_validate(tables)
        except ValueError:
            continue
        heated = "thermal" in tables
        if heated and not CREDIBLE[0] <= problem.entrainment_speed <= CREDIBLE[1]:
            continue
        if rng.random() < ROUGH:
            tables["surface_2"]["roughness"] = heights(rng, problem)
            return ContactProblem.model_validate(tables), "rough"
        thinning = tables["lubricant"]["shear"]["law"] != "newtonian"
        return problem, "heated" if heated else "thinning" if thinning else "isothermal"


def _tables(rng: np.random.Generator) -> dict[str, Any]:
    radius = between(rng, RADII)
    ratio = between(rng, RATIOS) if rng.random() < ELLIPTIC else 1.0
    first = str(rng.choice(SOLIDS))
    second = first if rng.random() < 0.5 else str(rng.choice(SOLIDS))
    tables: dict[str, Any] = {
        "contact": {
            "radius_x": radius,
            "radius_y": radius * ratio,
            "moes_load": between(rng, LOADS),
            "moes_speed": between(rng, SPEEDS),
            "slide_roll_ratio": float(rng.uniform(-LARGEST_SLIDE, LARGEST_SLIDE))
            if rng.random() < SLIDING
            else 0.0,
        },
        "surface_1": {"material": first},
        "surface_2": {"material": second},
        "lubricant": oil(rng),
    }
    if rng.random() < HEATED:
        tables["thermal"] = {}
    return tables


def oil(rng: np.random.Generator) -> dict[str, Any]:
    """Return a random lubricant as its table."""
    eta, gamma = between(rng, (0.004, 0.5)), float(rng.uniform(0.025, 0.06))
    alpha, shear = float(rng.uniform(12e-9, 25e-9)), float(rng.random())
    at = {"eta_0": eta, "alpha": alpha, "gamma": gamma, "reference_temperature": 313.15}
    grade = GRADES[int(rng.integers(len(GRADES)))]
    laws = (
        {"law": "roelands", **at},
        {"law": "roelands", **at},
        {"law": "barus", **at},
        {"law": "walther", "nu_40": 1e-6 * grade[0], "nu_100": 1e-6 * grade[1], "alpha": alpha},
    )
    shears = (
        (0.46, {"law": "newtonian"}),
        (0.66, {"law": "eyring", "stress": between(rng, (2e6, 2e7))}),
        (0.83, {"law": "carreau", "modulus": between(rng, (1e5, 1e7)), "exponent": 0.6}),
        (1.0, {"law": "limiting", "slope": float(rng.uniform(0.03, 0.1))}),
    )
    return {
        "viscosity": laws[int(rng.integers(len(laws)))],
        "density": {
            "law": "dowson-higginson",
            "rho_0": 880.0,
            "beta": 6.5e-4,
            "reference_temperature": 288.15,
        },
        "shear": next(law for limit, law in shears if shear < limit),
        "temperature": float(rng.uniform(293.0, 373.0)),
        "conductivity": float(rng.uniform(0.12, 0.15)),
        "heat_capacity": float(rng.uniform(1700.0, 2300.0)),
    }


def heights(rng: np.random.Generator, problem: ContactProblem) -> dict[str, Any]:
    """Return random roughness as its table.

    Parameters
    ----------
    rng : Generator
        Source of the random numbers.
    problem : ContactProblem
        Its expected film and half-width limit the heights.
    """
    scaled = ScaledProblem.of(problem)
    width = scaled.scales.half_width_x
    film = expected_central_film(scaled.groups) * scaled.scales.film_thickness
    height, kind = film * between(rng, (0.03, 0.6)), int(rng.integers(4))
    if kind == 0:
        length = width * between(rng, (0.35, 2.5))
        angle = float(rng.uniform(0.0, math.pi))
        return {"type": "wave", "amplitude": height, "wavelength": length, "angle": angle}
    if kind == 1:
        rms, length = film * between(rng, (0.01, 0.1)), width * between(rng, (0.1, 0.4))
        seed = int(rng.integers(1000))
        return {"type": "random", "rms": rms, "correlation_length": length, "seed": seed}
    radius = width * between(rng, (0.12, 0.6))
    place = {"x": width * float(rng.uniform(-0.8, 0.8)), "y": width * float(rng.uniform(-0.7, 0.7))}
    sign = 1.0 if kind == 2 else -2.0
    return {"type": "bump", "amplitude": sign * min(height, radius / 9), "radius": radius} | place
