"""Random contacts of any direction and shape, by a seed and a number.

Lines, rollers, circles, ellipses and ellipses at an angle; sliding along and across, spin, motion
that changes in time; heat, thinning, scarce oil, cavities, asperities, boundary films, roughness.
"""

import math
from typing import Any

import numpy as np

from benchmarks.random_contacts import CREDIBLE, LARGEST_SLIDE, between, heights, oil
from tehl.api.problem import ContactProblem
from tehl.estimate.duration import duration_of, misplaced
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.scaling import ScaledProblem

SOLIDS = ("steel", "steel", "steel", "glass", "bronze", "silicon-nitride", "peek")
SHAPES = {"line": 0.2, "roller": 0.15, "circle": 0.2, "ellipse": 0.25, "angle": 0.2}
"""Shapes, and how often they are drawn."""
LOADS, SPEEDS = {"line": (3.0, 300.0), "roller": (5.0, 150.0)}, (0.5, 20.0)
POINT_LOADS, RADII = (3.0, 2000.0), (2e-3, 0.1)
"""Ranges of M by shape, L, M of all other shapes, and R_x [m]."""
RATIOS = {"circle": (1.0, 1.0), "ellipse": (0.3, 50.0), "angle": (1.2, 9.0)}
"""R_y / R_x: up to a_y/a_x of about 12, and 4 at an angle."""
LENGTHS = (5.0, 40.0)
"""Lengths of rollers over the width of their contacts."""
CROWNS = (2.0, 10.0)
"""Drop of a crowned roller at its ends, over b^2/R: with less an end presses as a sharp edge."""
SLIDING, ACROSS, SPINNING, LARGEST_SPIN = 0.6, 0.2, 0.2, 0.5
"""How often surfaces slide, also across, or spin; and the largest spin of both over u_m / a, a the
larger half-width: half the length of a roller."""
ROLLER_SPIN = 1
"""Number of the random numbers for spins of rollers, apart from those of all else."""
FEATURES = {
    "thermal": 0.33,
    "thinning": 0.3,
    "transient": 0.12,
    "supply": 0.12,
    "cavitation": 0.06,
    "asperities": 0.15,
    "contact_film": 0.05,
    "rough": 0.12,
}
"""What is added, and how often it is drawn."""
POINT_SHAPES = {"circle": 0.4, "ellipse": 0.4, "angle": 0.2}
ALL_FEATURES = {
    "thermal": 0.35,
    "thinning": 0.35,
    "transient": 0.2,
    "supply": 0.25,
    "cavitation": 0.25,
    "asperities": 0.3,
    "contact_film": 0.4,
    "rough": 0.4,
}
"""The same of point contacts with all tables at once: 2.5 of them in the mean."""
LAMBDAS, FILMS = (0.3, 3.0), (0.1, 0.8)
"""Expected film over the height of asperities, and boundary film over the expected film."""
TRANSITS = (2.0, 6.0)
"""Durations of transient runs over a_x / u_m."""


def contact(
    seed: int, number: int, *, tables_at_once: bool = False
) -> tuple[str, set[str], ContactProblem]:
    """Return shape, features and problem of a contact; what no case may state is drawn again.

    Parameters
    ----------
    seed, number : int
        Of the random numbers.
    tables_at_once : bool
        Whether to draw point contacts with many features.
    """
    rng = np.random.default_rng([seed, number])
    shapes, parts = (POINT_SHAPES, ALL_FEATURES) if tables_at_once else (SHAPES, FEATURES)
    kind = str(rng.choice(list(shapes), p=list(shapes.values())))
    features, problem = _drawn(rng, kind, parts)
    if kind == "roller":
        turned = _turned(np.random.default_rng([seed, number, ROLLER_SPIN]), problem)
        if turned is not None:
            return kind, features | {"spin"}, turned
    return kind, features, problem


def _drawn(
    rng: np.random.Generator, kind: str, parts: dict[str, float]
) -> tuple[set[str], ContactProblem]:
    """Return features and problem of a contact of one shape; rollers do not spin.

    ``parts``: how often each feature is drawn.
    """
    while True:
        try:
            tables = _plain(rng, kind)
        except ValueError:
            continue
        features = {name for name, part in parts.items() if rng.random() < part}
        if "thinning" not in features:
            tables["lubricant"]["shear"] = {"law": "newtonian"}
        elif tables["lubricant"]["shear"]["law"] == "newtonian":
            tables["lubricant"]["shear"] = {"law": "eyring", "stress": between(rng, (2e6, 2e7))}
        try:
            bare = ContactProblem.model_validate(tables)
            features |= _motion(rng, tables, bare)
            _add(rng, tables, features, bare)
            problem = ContactProblem.model_validate(tables)
        except ValueError:
            continue
        if not CREDIBLE[0] <= problem.entrainment_speed <= CREDIBLE[1]:
            continue
        scaled = ScaledProblem.of(problem)
        if misplaced(scaled, duration_of(scaled)):
            continue
        return features, problem


def _plain(rng: np.random.Generator, kind: str) -> dict[str, Any]:
    """Return the tables of a contact that rolls."""
    radius = between(rng, RADII)
    stated: dict[str, Any] = {
        "moes_load": between(rng, LOADS.get(kind, POINT_LOADS)),
        "moes_speed": between(rng, SPEEDS),
    }
    if kind in RATIOS:
        stated |= {"radius_x": radius, "radius_y": radius * between(rng, RATIOS[kind])}
    else:
        stated |= {"type": kind, "radius": radius}
    if kind == "angle":
        stated["entrainment_angle"] = float(rng.uniform(-0.5 * math.pi, 0.5 * math.pi))
    if rng.random() < SLIDING:
        stated["slide_roll_ratio"] = float(rng.uniform(-LARGEST_SLIDE, LARGEST_SLIDE))
    first, second = (str(one) for one in rng.choice(SOLIDS, 2))
    tables = {
        "contact": stated,
        "surface_1": {"material": first},
        "surface_2": {"material": second},
        "lubricant": oil(rng),
    }
    if kind == "roller":
        _roller(rng, tables)
    return tables


def _roller(rng: np.random.Generator, tables: dict[str, Any]) -> None:
    """Add length, profile and tilt of a roller."""
    stated = tables["contact"]
    line = ContactProblem.model_validate(tables | {"contact": stated | {"type": "line"}})
    length = 2.0 * line.hertz.half_width_x * between(rng, LENGTHS)
    drop = line.hertz.half_width_x**2 / stated["radius"]
    shapes: tuple[dict[str, Any], ...] = (
        {"shape": "logarithmic"},
        {"shape": "lundberg"},
        {"shape": "crown", "radius": 0.125 * length**2 / (drop * between(rng, CROWNS))},
        {"shape": "iso-16281", "diameter": 2.0 * stated["radius"]},
    )
    stated |= {"length": length, "profile": shapes[int(rng.integers(len(shapes)))]}
    if rng.random() < 1 / 3:
        stated["tilt"] = 2.0 * drop / length * float(rng.uniform(0.0, 0.5))


def _motion(rng: np.random.Generator, tables: dict[str, Any], bare: ContactProblem) -> set[str]:
    """Add sliding across and spin; return which of both."""
    stated, found = tables["contact"], set()
    if "slide_roll_ratio" in stated and rng.random() < ACROSS:
        stated["sliding_angle"] = float(rng.uniform(-math.pi, math.pi))
        found.add("across")
    if not bare.contact.has_lines and rng.random() < SPINNING:
        stated |= _spins(rng, bare)
        found.add("spin")
    return found


def _spins(rng: np.random.Generator, bare: ContactProblem) -> dict[str, float]:
    """Return the spins of both surfaces [rad/s]."""
    unit = bare.entrainment_speed / max(bare.hertz.half_width_x, bare.hertz.half_width_y)
    return {
        key: unit * float(rng.uniform(-LARGEST_SPIN, LARGEST_SPIN)) for key in ("spin_1", "spin_2")
    }


def _turned(rng: np.random.Generator, roller: ContactProblem) -> ContactProblem | None:
    """Return a roller that spins; None if no spin is drawn, or it is not a valid case."""
    if not rng.random() < SPINNING:
        return None
    given = roller.model_dump(exclude_none=True)
    given["contact"] |= _spins(rng, roller)
    try:
        problem = ContactProblem.model_validate(given)
    except ValueError:
        return None
    scaled = ScaledProblem.of(problem)
    return None if misplaced(scaled, duration_of(scaled)) else problem


def _add(
    rng: np.random.Generator, tables: dict[str, Any], features: set[str], bare: ContactProblem
) -> None:
    """Add the tables of the features."""
    scaled = ScaledProblem.of(bare)
    film = expected_central_film(scaled.groups) * scaled.scales.film_thickness
    made: dict[str, Any] = {
        "thermal": {},
        "transient": _transient(rng, scaled),
        "supply": {"ratio": float(rng.uniform(0.2, 0.95))},
        "cavitation": {"model": "conserving"},
        "asperities": {
            "model": "greenwood-tripp",
            "rms": film / between(rng, LAMBDAS),
            "summit_radius": 1e-6 * between(rng, (5.0, 50.0)),
            "summit_density": between(rng, (2e9, 3e10)),
        },
        "contact_film": {"thickness": film * between(rng, FILMS)},
    }
    tables |= {name: table for name, table in made.items() if name in features}
    if "rough" in features:
        tables["surface_2"]["roughness"] = rough = heights(rng, bare)
        if rough["type"] == "bump" and "transient" in features:
            # it is drawn inside the contact, where none may appear beside the film without it
            tables["transient"]["start"] = "standing"


def _transient(rng: np.random.Generator, scaled: ScaledProblem) -> dict[str, Any]:
    """Return a run whose load, speed, sliding or radius changes, or whose entrainment turns."""
    time = scaled.scales.half_width_x / scaled.scales.speed * between(rng, TRANSITS)
    swing = f"1 + {rng.uniform(0.1, 0.5):.3g}*sin(6.28*t/({time:.6g} s))"
    courses: tuple[dict[str, Any], ...] = (
        {"load": swing},
        {"entrainment_speed": swing},
        {"entrainment_speed": [[0.0, 1.0], [time, float(rng.uniform(-1.0, 0.3))]]},
        {"radius": swing, "load": [[0.0, 1.0], [time, float(rng.uniform(0.5, 1.5))]]},
    )
    return {"duration": time} | courses[int(rng.integers(len(courses)))]
