"""Elastic deflection: multilevel sum and sum by lines against FFT and the sum by definition."""

import numpy as np
from tests.reference import DOMAIN, moes_contact

from benchmarks.measure import attempt, cpu_seconds
from benchmarks.table import Cell, Table
from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import groups
from tehl.operators.deformation import (
    Deformation,
    DirectDeformation,
    FftDeformation,
    LineDeformation,
)
from tehl.operators.influence import influence_of
from tehl.operators.multilevel import MultilevelDeformation

SIZES = (33, 65, 129, 257, 513, 1025)
LARGEST_DIRECT = 65
"""Nodes per direction up to which the sum by definition fits into memory."""
REPEATS = 15


def row(points: int, *, mirror: bool) -> tuple[Cell, ...]:
    """Return times and errors on one grid, with the pressure of M = 200, L = 10."""
    problem = moes_contact(200.0, 10.0)
    result = attempt(problem, Options(points=points, domain=DOMAIN))
    grid = Grid(nx=points, ny=points, domain=DOMAIN, mirror=mirror)
    numbers = groups(problem)
    pressure = np.ascontiguousarray(result.scaled.pressure[points - grid.shape[0] :])
    influence = influence_of(grid, numbers)
    exact = FftDeformation(grid, numbers)
    multilevel = MultilevelDeformation(grid, influence)
    fft_ms, deflection = timed(exact, pressure)
    multilevel_ms, approximate = timed(multilevel, pressure)
    lines_ms, by_lines = timed(LineDeformation(grid, numbers), pressure)
    direct_ms, direct_error = None, None
    if points <= LARGEST_DIRECT:
        direct_ms, direct = timed(DirectDeformation(grid, numbers), pressure)
        direct_error = float(np.abs(deflection - direct).max())
    error = approximate - deflection
    inside = grid.x[None, :] ** 2 + grid.y[:, None] ** 2 < 1.0
    rms = float(np.sqrt(np.mean(error[inside] ** 2)))
    film = result.film_scaled.central
    discretisation = result.errors.discretisation_central * film if result.errors else float("nan")
    return (
        points, "half" if mirror else "full", fft_ms, multilevel_ms, fft_ms / multilevel_ms,
        lines_ms, fft_ms / lines_ms, float(np.abs(by_lines - deflection).max()),
        direct_ms, direct_error, rms, float(np.abs(error).max()), rms / discretisation,
    )  # fmt: skip


def timed(deformation: Deformation, pressure: Array) -> tuple[float, Array]:
    """Return milliseconds per evaluation, and the deflection."""
    out = np.empty_like(pressure)
    seconds = cpu_seconds(lambda: deformation.deflect(pressure, out), REPEATS)
    return 1e3 * seconds, out


def table(*, quick: bool = False) -> Table:
    """Return times and errors by grid, half and full domain."""
    made = Table(
        title="Deflection: multilevel sum (MLMI), sum by lines, FFT; pressure of M = 200, L = 10",
        columns=(
            "points", "domain", "FFT ms", "MLMI ms", "FFT/MLMI", "lines ms",
            "FFT/lines", "lines-FFT max", "direct ms", "FFT-direct max",
            "MLMI rms r<1", "MLMI max", "rms / discretisation error of H_central",
        ),
    )  # fmt: skip
    for points in (33, 65, 129) if quick else SIZES:
        made.rows.extend(row(points, mirror=mirror) for mirror in (True, False))
    return made
