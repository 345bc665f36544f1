"""Time, memory and disk that a study will take, before any work."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.estimate.cpu_time import expected_seconds
from tehl.estimate.domain import planned
from tehl.estimate.memory import available_memory, needed_memory
from tehl.estimate.scaling import ScaledProblem
from tehl.studies.case import Case, Row

_CERTIFIED = 3.5
"""Work of a certified solve over that of its finest grid, to tight tolerances."""
_BASE_SECONDS, _START_SECONDS = 0.025, 3.0
"""Of a case, beside its solve; until workers solve."""
_ROW_BYTES, _FILE_BYTES = 3_500, 25_000
"""Of a finished case: its row; its file of fields, beside those by node."""
_FIELD_BYTES, _LAYER_BYTES = 37, 8
"""Compressed, per node: pressure, film and shear stresses; each layer of temperature."""
_ENOUGH = 3
"""Finished cases that show how fast this machine is."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Forecast:
    """Estimates of a study: times of the open cases, disk of all, memory of all workers at most."""

    cases: int
    open: int
    cpu_seconds: float
    wall_seconds: float
    disk_bytes: float
    memory_bytes: float
    is_calibrated: bool
    """Whether finished cases show how fast this machine solves these contacts."""


def forecast(
    cases: Sequence[Case], finished: Mapping[str, Row], *, jobs: int, fields: bool
) -> Forecast:
    """Return the estimates for a study.

    Parameters
    ----------
    cases : sequence of Case
        All cases of the study.
    finished : mapping of str to Row
        Finished cases by key; their times calibrate the estimate for the others.
    jobs, fields : int, bool
        Number of workers, and whether fields are kept.
    """
    every = {case.key: case for case in cases}
    waiting = [case for key, case in every.items() if key not in finished]
    known = {key: row.cost.cpu_seconds for key, row in finished.items() if row.cost.cpu_seconds > 0}
    estimated = sum(_seconds(every[key]) for key in known)
    slowness = sum(known.values()) / estimated if len(known) >= _ENOUGH else 1.0
    seconds = [slowness * _seconds(case) for case in waiting]
    workers = max(1, min(jobs, len(waiting)))
    disk = sum(_ROW_BYTES + (_field_bytes(case) if fields else 0) for case in every.values())
    needs = sorted((needed_memory(_plan(case), case.problem) for case in waiting), reverse=True)
    longest = max(sum(seconds) / workers, max(seconds, default=0.0))
    return Forecast(
        cases=len(every),
        open=len(waiting),
        cpu_seconds=sum(seconds),
        wall_seconds=longest + (_START_SECONDS if waiting else 0.0),
        disk_bytes=disk,
        memory_bytes=sum(needs[:workers]),
        is_calibrated=len(known) >= _ENOUGH,
    )


def expected_times(cases: Sequence[Case], finished: Mapping[str, Row]) -> dict[str, float]:
    """Return the CPU seconds to expect of the cases that are not finished, by their keys."""
    every = {case.key: case for case in cases}
    return {key: _seconds(case) for key, case in every.items() if key not in finished}


def check_memory_of(forecast: Forecast, jobs: int) -> None:
    """Raise an InputError if all workers together need more memory than is available."""
    available = available_memory()
    if available is None or forecast.memory_bytes <= available or jobs < 2:
        return
    raise InputError(
        f"{jobs} workers take about {forecast.memory_bytes / 1e9:.2g} GB of memory together, and "
        f"{available / 1e9:.2g} GB are available: take fewer --jobs or fewer points"
    )


def _plan(case: Case) -> Options:
    """Return the options of a case with the number of nodes to expect."""
    return planned(ScaledProblem.of(case.problem), case.options)


def _seconds(case: Case) -> float:
    seconds = expected_seconds(ScaledProblem.of(case.problem), case.options) + _BASE_SECONDS
    return seconds * (_CERTIFIED if case.certify else 1.0)


def _field_bytes(case: Case) -> int:
    thermal = case.problem.thermal
    layers = 0 if thermal is None else thermal.nodes + 2
    return (_FIELD_BYTES + _LAYER_BYTES * layers) * math.prod(_plan(case).shape) + _FILE_BYTES
