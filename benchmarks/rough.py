"""Convergence of rough contacts at rest, from a cold start with the defaults.

Amplitudes are in units of a^2/R, lengths in half-widths a, angles 0 for transverse waves.
"""

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from tests.reference import DOMAIN, moes_contact

from benchmarks.table import Cell, Table
from tehl import solve
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError
from tehl.contact.options import Options
from tehl.estimate.scaling import Scales, scales

CONTACTS = ((57.21, 10.52), (126.0, 12.34), (200.0, 10.0), (500.0, 12.34))
AMPLITUDES, LENGTHS, ANGLES = (0.03, 0.1, 0.2), (1.0, 0.5, 0.25, 0.125), (0, 45, 90)
LEAST_POINTS = 8.0
BUMPS = tuple((height, radius) for height in (-0.3, -0.1, 0.1, 0.3) for radius in (0.3, 0.15, 0.1))
RANDOM = ((0.02, 0.2), (0.02, 0.1), (0.05, 0.2), (0.05, 0.1))
SEEDS = 20
HEATED = ((0.03, 0.5, 0), (0.03, 0.5, 45), (0.03, 0.5, 90), (0.1, 0.5, 0), (0.1, 0.5, 45))
COLUMNS = ("M", "surface", "status", "smoother", "cycles", "H_central", "H_min", "bar_m %",
           "P_max", "CPU s")  # fmt: skip


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """A contact M, L with the roughness ``table`` on surface 1, in scaled lengths."""

    load: float
    speed: float
    name: str
    table: dict[str, Any]
    heated: bool = False

    def problem(self) -> ContactProblem:
        """Return the problem in SI."""
        smooth = moes_contact(self.load, self.speed)
        given = smooth.model_dump(exclude_none=True)
        given["surface_1"]["roughness"] = in_metres(self.table, scales(smooth))
        if self.heated:
            given["contact"]["slide_roll_ratio"] = 0.5
            given["thermal"] = {}
            given["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
            given["lubricant"]["viscosity"]["gamma"] = 0.042
            given["lubricant"]["shear"] = {"law": "eyring", "stress": 5e6}
        return ContactProblem.model_validate(given)


def in_metres(table: dict[str, Any], units: Scales) -> dict[str, Any]:
    """Return a surface with its heights and lengths in metres."""
    heights, lengths = ("amplitude", "rms"), ("wavelength", "radius", "correlation_length")
    sizes = dict.fromkeys(heights, units.film_thickness)
    sizes |= dict.fromkeys(lengths, units.half_width_x)
    return {key: value * sizes[key] if key in sizes else value for key, value in table.items()}


def waves(points: int) -> Iterator[Case]:
    """Yield the waves with eight nodes or more on a grid."""
    mesh = (DOMAIN.x[1] - DOMAIN.x[0]) / (points - 1)
    for load, speed in CONTACTS:
        for amplitude in AMPLITUDES:
            for length in LENGTHS:
                for angle in ANGLES if length / mesh >= LEAST_POINTS else ():
                    yield wave(load, speed, (amplitude, length, angle))


def wave(load: float, speed: float, shape: tuple[float, float, float], **more: bool) -> Case:
    """Return one contact with a wave (amplitude, length, angle)."""
    amplitude, length, angle = shape
    table = {"type": "wave", "amplitude": amplitude, "wavelength": length,
             "angle": f"{angle} deg", "phase": "180 deg"}  # fmt: skip
    name = f"wave {amplitude:g}, {length:g}, {angle}"
    return Case(load=load, speed=speed, name=name, table=table, **more)


def spots() -> Iterator[Case]:
    """Yield bumps and dents in the centre."""
    for load, speed in CONTACTS:
        for height, radius in BUMPS:
            table = {"type": "bump", "amplitude": height, "radius": radius}
            yield Case(load=load, speed=speed, name=f"bump {height:g}, {radius:g}", table=table)


def random_surfaces(seeds: int) -> Iterator[Case]:
    """Yield Gaussian surfaces with Gaussian spectra."""
    for load, speed in CONTACTS:
        for rms, length in RANDOM:
            for seed in range(1, seeds + 1):
                table = {"type": "random", "rms": rms, "correlation_length": length, "seed": seed}
                name = f"random {rms:g}, {length:g}, seed {seed}"
                yield Case(load=load, speed=speed, name=name, table=table)


def heated() -> Iterator[Case]:
    """Yield thermal Eyring films, SRR 0.5, between waves."""
    for load, speed in CONTACTS[1:3]:
        for shape in HEATED:
            yield wave(load, speed, shape, heated=True)


def row(case: Case, points: int) -> tuple[Cell, ...]:
    """Solve a case and return its row."""
    start = time.process_time()
    try:
        run = solve(case.problem(), Options(points=points, domain=DOMAIN))
    except ConvergenceError as error:
        run = error.result
    last, film, errors = run.history[-1], run.film_scaled, run.errors
    bar = None if errors is None else 100.0 * errors.discretisation_minimum
    return (
        case.load, case.name, run.status.cause or run.status.kind, last.smoother, last.cycle,
        f"{film.central:.4f}", f"{film.minimum:.4f}", bar, float(run.scaled.pressure.max()),
        time.process_time() - start,
    )  # fmt: skip


def tables(points: int, *, quick: bool = False) -> Iterator[Table]:
    """Yield one table per kind of surface."""
    kinds = {
        "waves": waves(points),
        "bumps and dents": spots(),
        "random surfaces": random_surfaces(1 if quick else SEEDS),
        "waves with heat, Eyring 5 MPa, SRR 0.5": heated(),
    }
    for kind, wanted in kinds.items():
        made = Table(
            title=f"Roughness: {kind}, {points} x {points} nodes, defaults, cold", columns=COLUMNS
        )
        made.rows.extend(row(case, points) for case in wanted)
        counted = Counter((load, status) for load, _, status, *_ in made.rows)
        for load, _ in CONTACTS:
            words = [f"{count} {status}" for (m, status), count in counted.items() if m == load]
            made.notes.append(f"M = {load:g}: {', '.join(words)}")
        yield made
