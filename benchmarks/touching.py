"""Cost of contact through a boundary film in FFT units: random surfaces, shares of the load."""

import time
from collections.abc import Iterator

from tests.reference import moes_contact
from tests.solver.rough import with_roughness

from benchmarks.measure import attempt, fft_unit
from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem
from tehl.contact.options import Options
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.scaling import ScaledProblem, scales

CONTACTS = ((100, 8, 0.3), (300, 5, 0.3), (1000, 4, 0.3), (1000, 4, 0.2))
"""Moes numbers M and L, and correlation length over the half-width."""
RATIO = 0.3
"""Smooth film by formula over the roughness: lambda."""
BOUNDARY_FILM = 5e-9
"""Thickness [m]."""
SHARED = (50.0, 8.0)
"""Moes numbers of the contacts of all shares."""
BOUNDARY_OVER_FILM = {
    "random": (0.02, 0.1, 0.3, 0.5, 0.8),
    "grooves": (0.3, 0.5, 0.7, 0.9),
    "smooth": (1.3, 2.0, 5.0),
}
"""Boundary film over the central film by formula, by surface."""


def contact(load: float, speed: float, length: float) -> ContactProblem:
    """Return a contact with a standing random surface."""
    smooth = moes_contact(load, speed)
    rough = with_roughness(
        (load, speed),
        type="random",
        rms=expected_film(ScaledProblem.of(smooth)) / RATIO,
        correlation_length=length * scales(smooth).half_width_x,
        seed=1,
    ).model_dump(exclude_none=True)
    return ContactProblem.model_validate(rough | {"contact_film": {"thickness": BOUNDARY_FILM}})


def of_share(surface: str, ratio: float) -> ContactProblem:
    """Return a contact of `SHARED` whose boundary film is ``ratio`` times that of the oil."""
    smooth = moes_contact(*SHARED)
    film = expected_film(ScaledProblem.of(smooth))
    half_width = scales(smooth).half_width_x
    rough: dict[str, object] = {}
    if surface == "random":
        rough = {"type": "random", "rms": 3.0 * film, "seed": 1}
        rough |= {"correlation_length": 0.3 * half_width}
    elif surface == "grooves":
        rough = {"type": "wave", "amplitude": film, "wavelength": half_width, "angle": "90 deg"}
    stated = with_roughness(SHARED, **rough) if rough else smooth
    boundary = {"contact_film": {"thickness": ratio * film}}
    return ContactProblem.model_validate(stated.model_dump(exclude_none=True) | boundary)


def shares(points: int) -> Table:
    """Return a row for each surface and boundary film: share of the load and cost."""
    made = Table(
        title=f"Contact at all shares of the load, M = 50, L = 8, {points} x {points} nodes",
        columns=("surface", "boundary film/film", "status", "share", "method", "FFT units"),
    )
    unit = fft_unit(points)
    for surface, ratios in BOUNDARY_OVER_FILM.items():
        for ratio in ratios:
            start = time.process_time()
            found = attempt(of_share(surface, ratio), Options(points=points))
            units = (time.process_time() - start) / unit
            share = found.touching.share if found.touching else 0.0
            status = found.status.cause or found.status.kind
            made.rows.append((surface, ratio, status, share, found.history[-1].smoother, units))
    return made


def row(load: float, speed: float, length: float, options: Options) -> tuple[Cell, ...]:
    """Solve a contact and return its row."""
    problem = contact(load, speed, length)
    start = time.process_time()
    found = attempt(problem, options)
    seconds = time.process_time() - start
    grid = found.history[-1].points
    share = found.touching.share if found.touching else 0.0
    return (
        load, speed, length, found.status.cause or found.status.kind, share,
        sum(one.points == grid for one in found.history), seconds, seconds / fft_unit(grid[0])
    )  # fmt: skip


def tables(points: int, *, quick: bool = False) -> Iterator[Table]:
    """Return a row for each contact, and one for each share."""
    made = Table(
        title=f"Contact through a boundary film: random surfaces, lambda = {RATIO}, "
        f"{points} x {points} nodes",
        columns=("M", "L", "length/a", "status", "share", "last steps", "CPU s", "FFT units"),
    )
    options = Options(points=points)
    if not quick:
        attempt(contact(*CONTACTS[0]), Options(points=65))  # compiles
    made.rows.extend(row(*one, options) for one in (CONTACTS[2:3] if quick else CONTACTS))
    yield made
    if not quick:
        yield shares(points)
