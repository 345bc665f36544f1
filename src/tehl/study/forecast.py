"""What a study will take: time, memory and disk, before any work."""

from collections.abc import Sequence
from dataclasses import dataclass

from tehl.errors import InputError
from tehl.memory import available_memory, needed_memory
from tehl.report.explain import SECONDS_COUPLED, SECONDS_PER_NODE
from tehl.study.case import Case

CERTIFIED = 3.5
"""Work of a certified solve over that of its finest grid, to tight tolerances."""
_ROW_BYTES = 3_500
"""Of a finished case without fields."""
_FIELD_BYTES, _SHEAR_BYTES, _LAYER_BYTES = 15.0, 22.0, 8.0
"""Compressed, per node: of pressure and film in both forms, of stresses, of each layer of heat."""
_BEGIN = 3.0
"""Seconds until workers solve."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Forecast:
    """Estimates of a study; guides, not promises.

    Attributes
    ----------
    cases, open : int
        All of them, and those not finished yet.
    cpu_seconds, wall_seconds : float
        For those not finished.
    disk_bytes : float
        When all are finished.
    memory_bytes : float
        Of all workers together, at most.
    """

    cases: int
    open: int
    cpu_seconds: float
    wall_seconds: float
    disk_bytes: float
    memory_bytes: float


def forecast(
    cases: Sequence[Case], waiting: Sequence[Case], *, jobs: int, fields: bool
) -> Forecast:
    """Return what a study will take.

    Parameters
    ----------
    cases, waiting : sequence of Case
        All, and those not finished yet.
    jobs : int
        Workers.
    fields : bool
        Whether fields are kept.
    """
    seconds = [_seconds(case) for case in waiting]
    cpu, longest = sum(seconds), max(seconds, default=0.0)
    workers = max(1, min(jobs, len(waiting)))
    disk = sum(_ROW_BYTES + (_field_bytes(case) if fields else 0.0) for case in cases)
    needs = sorted((needed_memory(case.options, case.problem) for case in waiting), reverse=True)
    return Forecast(
        cases=len(cases),
        open=len(waiting),
        cpu_seconds=cpu,
        wall_seconds=max(cpu / workers, longest) + (_BEGIN if waiting else 0.0),
        disk_bytes=disk,
        memory_bytes=sum(needs[:workers]),
    )


def check_memory_of(forecast: Forecast, jobs: int) -> None:
    """Refuse a study whose workers do not fit into the memory together.

    Raises
    ------
    InputError
        If the estimate exceeds what there is.
    """
    available = available_memory()
    if available is None or forecast.memory_bytes <= available or jobs < 2:
        return
    raise InputError(
        f"{jobs} workers take about {forecast.memory_bytes / 1e9:.2g} GB of memory together, and "
        f"{available / 1e9:.2g} GB are available: take fewer --jobs or fewer points"
    )


def _nodes(case: Case) -> int:
    ny, nx = case.options.shape
    return ny * nx


def _seconds(case: Case) -> float:
    each = SECONDS_COUPLED if case.problem.is_coupled else SECONDS_PER_NODE
    return each * _nodes(case) * (CERTIFIED if case.certify else 1.0)


def _field_bytes(case: Case) -> float:
    each = _FIELD_BYTES
    each += _SHEAR_BYTES
    if case.problem.thermal is not None:
        each += _LAYER_BYTES * (case.problem.thermal.nodes + 2)
    return each * _nodes(case) + 25_000.0
