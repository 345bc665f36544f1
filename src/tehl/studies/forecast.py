"""What a study will take: time, memory and disk, before any work."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tehl.errors import InputError
from tehl.memory import available_memory, needed_memory
from tehl.report.explain import SECONDS_COUPLED, SECONDS_PER_NODE
from tehl.studies.case import Case
from tehl.studies.row import Row

CERTIFIED = 3.5
"""Work of a certified solve over that of its finest grid, to tight tolerances."""
_ROW_BYTES = 3_500
"""Of a finished case without fields."""
_FIELD_BYTES, _SHEAR_BYTES, _LAYER_BYTES = 15.0, 22.0, 8.0
"""Compressed, per node: of pressure and film in both forms, of stresses, of each layer of heat."""
_LEAST_SECONDS = 0.045
"""Of a solve on few nodes, beside those by node."""
_ENOUGH = 3
"""Finished cases that tell how fast this machine is."""
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
    cases: Sequence[Case], finished: Mapping[str, Row], *, jobs: int, fields: bool
) -> Forecast:
    """Return what a study will take.

    Parameters
    ----------
    cases : sequence of Case
        All of the study.
    finished : mapping of str to Row
        What is finished, by key; what that took tells what the others will take.
    jobs : int
        Workers.
    fields : bool
        Whether fields are kept.
    """
    every = {case.key: case for case in cases}
    waiting = [case for key, case in every.items() if key not in finished]
    slow = _slowness([(every[key], row) for key, row in finished.items()])
    seconds = [slow * _seconds(case) for case in waiting]
    cpu, longest = sum(seconds), max(seconds, default=0.0)
    workers = max(1, min(jobs, len(waiting)))
    disk = sum(_ROW_BYTES + (_field_bytes(case) if fields else 0.0) for case in every.values())
    needs = sorted((needed_memory(case.options, case.problem) for case in waiting), reverse=True)
    return Forecast(
        cases=len(every),
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


def _slowness(finished: Sequence[tuple[Case, Row]]) -> float:
    """Return what finished cases took over their estimates; one if they are too few to tell."""
    known = [(case, row.cost.cpu_seconds) for case, row in finished if row.cost.cpu_seconds > 0]
    if len(known) < _ENOUGH:
        return 1.0
    return sum(seconds for _, seconds in known) / sum(_seconds(case) for case, _ in known)


def _nodes(case: Case) -> int:
    ny, nx = case.options.shape
    return ny * nx


def _seconds(case: Case) -> float:
    each = SECONDS_COUPLED if case.problem.is_coupled else SECONDS_PER_NODE
    return (each * _nodes(case) + _LEAST_SECONDS) * (CERTIFIED if case.certify else 1.0)


def _field_bytes(case: Case) -> float:
    each = _FIELD_BYTES
    each += _SHEAR_BYTES
    if case.problem.thermal is not None:
        each += _LAYER_BYTES * (case.problem.thermal.nodes + 2)
    return each * _nodes(case) + 25_000.0
