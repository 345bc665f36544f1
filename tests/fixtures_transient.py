"""A transient run made without the solver: a dent or a wave passes a horseshoe film."""

from dataclasses import replace
from functools import cache

import numpy as np

from tehl.api.problem import ContactProblem
from tehl.api.results import TransientResult
from tehl.result.bars import Estimate
from tehl.result.solution import Cost, Provenance, Status
from tehl.result.transient import Frames, History, HistoryBars, Profiles
from tests.fixtures_result import CASE, make_result

STEPS = 60
DENT = {"type": "bump", "amplitude": -2e-7, "radius": 5e-5, "x": -2e-4}


@cache
def make_transient(*, points: int = 33, slide: float = 0.5, frames: bool = True) -> TransientResult:
    """Return a run in which a dent of surface 1 passes; the film follows it in full."""
    contact = CASE["contact"] | {"slide_roll_ratio": slide}
    surface = CASE["surface_1"] | {"roughness": DENT}
    case = CASE | {"contact": contact, "surface_1": surface, "transient": {}}
    return passing(case, points=points, frames=frames)


def make_certified() -> TransientResult:
    """Return the run of :func:`make_transient` with error bars at every fourth step."""
    run = make_transient()
    history, every = run.history, slice(None, None, 4)
    extremes = {
        "film_minimum": history.film_minimum.min(),
        "film_central_least": history.film_central.min(),
        "film_central_largest": history.film_central.max(),
        "pressure_max": history.pressure_max.max(),
        "film_rise_max": 3.0,
        "traction_extreme": history.traction.min(),
    }
    bars = HistoryBars(
        time=history.time[every].copy(),
        film_central=0.02 * history.film_central[every],
        film_minimum=0.03 * history.film_minimum[every],
        pressure_max=0.04 * history.pressure_max[every],
    )
    message = "Grids of the error bars: 9 x 9 converged, 17 x 17 converged, 33 x 33 converged."
    return replace(
        run,
        status=Status(kind="converged", message=message),
        uncertainty={name: _estimate(float(value)) for name, value in extremes.items()},
        bars=bars,
    )


def _estimate(value: float) -> Estimate:
    """Return a value with a bar of 5 % of it, 4 of the grid and 3 of the domain."""
    grid, domain = abs(0.04 * value), abs(0.03 * value)
    return Estimate(
        value=value,
        uncertainty=float(np.hypot(grid, domain)),
        discretisation=grid,
        domain=domain,
        observed_order=2.1 if value > 0 else None,
        values=(0.9 * value, 0.97 * value, 0.99 * value),
    )


def passing(
    case: dict, *, points: int = 33, frames: bool = True, flattened: float = 0.0
) -> TransientResult:
    """Return a run in which the roughness of surface 1 passes; its film lacks a part of it."""
    problem = ContactProblem.model_validate(case)
    start = replace(make_result(points), problem=problem)
    units = start.scales
    step = (start.x[1] - start.x[0]) / units.speed
    time = step * np.arange(STEPS + 1)
    heights = np.stack(
        [
            np.broadcast_to(
                problem.surface_1.roughness.height(
                    start.x[None, :], start.y[:, None], float(t), problem.motion.speed_1
                ),
                (points, points),
            )
            for t in time
        ]
    )
    film = start.film_thickness - (1 - flattened) * heights
    pressure = start.pressure * (1 + 1e5 * heights)
    row = points // 2
    kept = np.linspace(0, STEPS, 4).astype(np.int64) if frames else np.zeros(0, np.int64)
    return TransientResult(
        start=start,
        history=History(
            time=time,
            load=np.ones_like(time),
            speed=np.ones_like(time),
            radius=np.ones_like(time),
            sliding=np.full_like(time, problem.slide_roll_ratio),
            film_central=film[:, row, int(np.argmin(np.abs(start.x)))].copy(),
            film_minimum=film.min(axis=(1, 2)),
            pressure_max=pressure.max(axis=(1, 2)),
            traction=np.linspace(-0.04, -0.05, time.size),
            traction_across=np.zeros_like(time),
            drilling_moment=np.zeros_like(time),
            rolling_moment=np.zeros_like(time),
            asperity_load=np.zeros_like(time),
            solid_friction=np.zeros_like(time),
            rigid_approach=np.full_like(time, -0.9),
            temperature_rise=np.zeros_like(time),
            nodes=np.full(time.size, points),
            cycles=np.r_[0, np.full(STEPS, 3)],
            change=np.r_[0.0, np.full(STEPS, 5e-4)],
        ),
        profiles=Profiles(
            pressure=pressure[:, row].copy(),
            film=film[:, row].copy(),
            height_1=heights[:, row].copy(),
            height_2=np.zeros_like(heights[:, row]),
        ),
        frames=Frames(
            step=kept,
            pressure=pressure[kept].astype(np.float32),
            film=film[kept].astype(np.float32),
            height=heights[kept].astype(np.float32),
        ),
        time_step=float(step),
        status=Status(kind="converged"),
        cost=Cost(cpu_seconds=4.5, wall_seconds=4.6),
        provenance=Provenance(versions={"tehl": "0.1.0"}, created="2026-01-01T00:00:00+00:00"),
    )
