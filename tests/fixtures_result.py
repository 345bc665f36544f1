"""A result made without the solver: dry Hertz pressure, dry gap and a film with a horseshoe."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.options import Options
from tehl.contact.shape import Shape
from tehl.estimate.scaling import groups, scales
from tehl.result.bars import ErrorEstimate, Estimate
from tehl.result.fields import Fields, FilmSummary
from tehl.result.solution import Cost, CycleReport, Hint, Provenance, Status

CASE = {
    "title": "Ball on disc",
    "contact": {"radius": 0.02, "load": 80.0, "entrainment_speed": 1.5, "slide_roll_ratio": 0.25},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
        "density": {"law": "dowson-higginson", "rho_0": 890.0},
    },
}


def make_result(points: int = 65, *, case: dict = CASE, title: str | None = None) -> Result:
    """Return a converged result that looks like a film; central H is 0.1."""
    problem = ContactProblem.model_validate({**case, "title": title or case["title"]})
    numbers = groups(problem)
    fields = _fields(points, numbers.shape)
    node = float(fields.film.min())
    centre = (int(np.argmin(np.abs(fields.y))), int(np.argmin(np.abs(fields.x))))
    return Result(
        problem=problem,
        options=Options(points=points),
        scales=scales(problem),
        groups=numbers,
        scaled=fields,
        rigid_approach=-0.93,
        film_scaled=FilmSummary(
            central=float(fields.film[centre]),
            minimum=0.99 * node,
            minimum_node=node,
            minimum_at=(0.1, 0.9),
        ),
        status=Status(kind="converged"),
        history=_history(points),
        errors=ErrorEstimate(
            discretisation_central=1e-3,
            discretisation_minimum=4e-3,
            iteration_central=1e-4,
            iteration_minimum=2e-4,
        ),
        cost=Cost(cpu_seconds=0.05, wall_seconds=0.06, work=30.5),
        provenance=Provenance(versions={"tehl": "0.1.0"}, created="2026-01-01T00:00:00+00:00"),
    )


def _fields(points: int, shape: Shape) -> Fields:
    x, y = np.linspace(-4.5, 1.5, points), np.linspace(-3.0, 3.0, points)
    xx, yy = x[None, :], y[:, None]
    radius = np.hypot(xx, yy)
    rim = np.exp(-(((radius - 0.92) / 0.1) ** 2))
    towards = np.clip(0.5 + 0.5 * xx / np.maximum(radius, 1e-9), 0, 1) ** 0.5
    side = np.exp(-(((np.abs(yy) - 0.88) / 0.3) ** 2) - ((xx - 0.1) / 0.5) ** 2)
    film = 0.1 * (1 - rim * np.maximum(0.28 * towards, 0.5 * side)) + shape.dry_gap(xx, yy)
    pressure = shape.dry_pressure(xx, yy)
    pressure = pressure + 0.2 * np.exp(-(((xx - 0.88) / 0.03) ** 2) - (yy / 0.4) ** 2) * (
        radius < 1
    )
    return Fields(x=x, y=y, pressure=pressure, film=film)


def _history(points: int) -> tuple[CycleReport, ...]:
    grids = [(points // 2 + 1, points // 2 + 1), (points, points)]
    return tuple(
        CycleReport(
            points=grid,
            cycle=cycle,
            residual=1e-3 * 0.2**cycle,
            change=1e-2 * 0.2**cycle,
            load_error=1e-4 * 0.1**cycle,
            film_central=0.1,
            film_minimum=0.05 + 1e-3 * 0.2**cycle,
            smoother="fast",
        )
        for grid in grids
        for cycle in (1, 2, 3)
    )


@pytest.fixture(scope="session")
def result() -> Result:
    return make_result()


@pytest.fixture(scope="session")
def certified(result: Result) -> Result:
    estimate = Estimate(
        value=0.101,
        uncertainty=0.002,
        discretisation=0.0016,
        domain=0.0012,
        observed_order=2.01,
        values=(0.11, 0.103, 0.1015),
    )
    names = ("film_central", "film_minimum", "pressure_max")
    return replace(result, uncertainty=dict.fromkeys(names, estimate))


@pytest.fixture(scope="session")
def stalled(result: Result) -> Result:
    status = Status(
        kind="stalled",
        cause="grid_too_coarse",
        message="the grid is too coarse for the film",
        hint=Hint("take points = 513"),
    )
    return replace(result, status=status)
