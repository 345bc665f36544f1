"""Cost of contact through a boundary film between random surfaces, in FFT units."""

import time

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


def table(points: int, *, quick: bool = False) -> Table:
    """Return a row for each contact."""
    made = Table(
        title=f"Contact through a boundary film: random surfaces, lambda = {RATIO}, "
        f"{points} x {points} nodes",
        columns=("M", "L", "length/a", "status", "share", "last steps", "CPU s", "FFT units"),
    )
    options = Options(points=points)
    if not quick:
        attempt(contact(*CONTACTS[0]), Options(points=65))  # compiles
    made.rows.extend(row(*one, options) for one in (CONTACTS[2:3] if quick else CONTACTS))
    return made
