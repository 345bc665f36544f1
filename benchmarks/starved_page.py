"""The part of docs/validation.md on starved contacts."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from tests.reference import DOMAIN, moes_contact, read

from benchmarks.markdown import head, row
from tehl.api.problem import case_from_tables
from tehl.api.results import Result
from tehl.api.solvers import solve, solve_passes
from tehl.contact.hertz import HertzContact
from tehl.contact.options import Options
from tehl.estimate.scaling import ScaledProblem
from tehl.post.layer import LayerDecay, layer_decay, rate_by_formula
from tehl.post.starvation import meniscus
from tehl.solver.judging.richardson import estimate
from tehl.solver.physics.passes import resolved

GRIDS = (129, 257, 513)
FILMS = """
## Starved films against an independent solver

Semi-smooth Newton solver for pressure and fill, finite volumes with face fluxes, extrapolated from
grids up to 1/h = 64. The oil that enters is stated; meniscus on y = 0 in half-widths, on 513².
Density constants 0.6 and 1.7 /GPa.
"""
DECAY = """
## Decay of starved films against measurements

Gao and others, Tribology International (2025), 111137: a steel ball (radius 9.53 mm, p_h = 0.48
GPa, track of 40 mm radius, base oil 0.38 Pa s, 30 /GPa) and a crowned roller on glass. The law of
side flow takes the pressure of the solved contact for the ball, the closed form for the roller,
whose contact is 69 times as wide as long. Passes: one after the other on 129², from r = 0.18, until
the meniscus comes nearer than a quarter of a mesh width (dashes).
"""
BALL = {
    "contact": {"hertz_pressure": 0.48e9, "entrainment_speed": 0.2},
    "surface_1": {"material": "steel", "radius": 9.53e-3},
    "surface_2": {"material": {"young_modulus": 63e9, "poisson_ratio": 0.2}, "radius": "inf"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": 0.38, "alpha": 30e-9},
        "density": {"law": "dowson-higginson", "rho_0": 891.0},
    },
}
TRACK, MEASURED, RESOLVED_SECONDS = 2.0 * math.pi * 0.04, 20.0, 330.0
"""Length of the track [m], film of the ball after 1020 s [nm], and time of the passes [s]."""


def films() -> Iterator[str]:
    """Yield the comparison of starved films with the independent solver."""
    yield FILMS
    yield from head(
        "M", "L", "r", "film", *(f"{n}²" for n in GRIDS), "tehl", "reference", "difference"
    )
    for case in read("starved")["films"]:
        runs = [starved_film(case, points) for points in GRIDS]
        label = [f"{case[name]:g}" for name in ("load", "speed", "ratio")]
        for name in ("central", "minimum"):
            values = [getattr(run.film_scaled, name) for run in runs]
            found = estimate((values[0], values[1], values[2]), domain=0.0)
            yield row(
                *label, name, *(f"{value:.5f}" for value in values),
                f"{found.value:.5f} ± {found.discretisation:.5f}", f"{case[name]:.5f}",
                f"{100 * (found.value / case[name] - 1):+.3f} %",
            )  # fmt: skip
        places = [meniscus(run)[run.scaled.y.size // 2] for run in runs]
        yield row(
            *label, "meniscus", *(f"{place:.4f}" for place in places), f"{places[-1]:.4f}",
            f"{case['meniscus']:.4f} ± {case['meniscus_error']:.4f}",
            f"{places[-1] - case['meniscus']:+.4f}",
        )  # fmt: skip
    yield "\nTolerances: 0.1 % (central), 0.3 % (minimum), 0.003 half-widths (meniscus)."


def starved_film(case: dict[str, Any], points: int) -> Result:
    """Return a starved film of the references, iterated to the tolerance."""
    contact = moes_contact(case["load"], case["speed"])
    unit = ScaledProblem.of(contact).scales.film_thickness
    tables = contact.model_dump(exclude_none=True) | {"supply": {"layer": case["oil"] * unit}}
    options = Options(points=points, domain=DOMAIN, accuracy="tight", max_cycles=60)
    return solve(case_from_tables(tables)[0], options)


def decay() -> Iterator[str]:
    """Yield the comparison of decaying films with measurements."""
    yield DECAY
    supply = {"ratio": 0.1805, "track": TRACK}
    law = layer_decay(solve(case_from_tables(BALL | {"supply": supply})[0]))
    count = round(RESOLVED_SECONDS / (0.5 * TRACK / 0.2))
    run = solve_passes(
        case_from_tables(BALL | {"supply": supply | {"passes": count}})[0], Options(points=129)
    )
    passes = run.passes
    assert passes is not None
    known = slice(resolved(passes, float(run.x[1] - run.x[0])))
    times = np.array([0.0, 120.0, 255.0, 510.0, 1020.0])
    found = [1e9 * law.film(times), 1e9 * law.film(times, by_formula=True)]
    by_pass = 1e9 * np.interp(times, passes.time[known], passes.film_central[known], right=np.nan)
    yield from head(
        "ball, time [s]", "law [nm]", "closed form [nm]", "passes [nm]", "measured [nm]"
    )
    for number, moment in enumerate(times):
        films = (values[number] for values in (*found, by_pass))
        measured = {0: "90", len(times) - 1: f"{MEASURED:g}"}.get(number, "")
        shown = ("-" if math.isnan(film) else f"{film:.1f}" for film in films)
        yield row(f"{moment:g}", *shown, measured)
    yield ""
    yield from head("roller, speed [mm/s]", "film [nm]", "law [nm/s]", "measured [nm/s]")
    for speed, flooded, part, rates in (
        (100, 353, 0.91, ".022, .028"),
        (150, 493, 0.65, ".035, .020"),
        (200, 524, 0.61, ".033, .022"),
    ):
        start = 1e-9 * flooded * part
        yield row(speed, f"{1e9 * start:.0f}", f"{1e9 * roller(start):.3f}", rates)


def roller(start: float) -> float:
    """Return the decay of the film of the roller by the law of side flow [m/s]."""
    hertz = HertzContact(
        pressure=0.22e9, half_width_x=39.2e-6, half_width_y=2710e-6, ellipticity=69.1, approach=0.0
    )
    rate = rate_by_formula(hertz, 0.38, 30e-9, 2.0 * math.pi * 0.045)
    known = {"rate": rate, "rate_by_formula": rate, "replenishment": 0.0}
    film = LayerDecay(**known, start=start, density=1.10).film(np.array([0.0, 60.0]))
    return next((before - after) / 60.0 for before, after in pairwise(film.tolist()))


def section() -> Iterator[str]:
    """Yield the lines of the part."""
    yield from films()
    yield from decay()
