"""The numbers of a transient run as one JSON object."""

from dataclasses import asdict
from typing import Any

import numpy as np

from tehl.io.summary import plain, summary
from tehl.transient_result import HistoryBars, TransientResult
from tehl.typing import Array


def transient_summary(run: TransientResult) -> dict[str, Any]:
    """Return the summary of ``run`` as JSON can hold it: null where a number is not finite.

    Keys that end in a unit (``_m``, ``_pa``, ``_k``, ``_s``) are SI, the others dimensionless.
    ``start`` is the summary of the steady film at the beginning. Times belong to the value before
    them; ``temperature`` is null for an isothermal run. A certified run has ``uncertainty``, which
    mirrors the values, with the largest bars along the history in the block ``history``.

    Parameters
    ----------
    run : TransientResult
        What a transient run returned or a file held.
    """
    status, history = run.status, run.history
    content = {
        "kind": "transient",
        "title": run.start.problem.title,
        "status": status.kind,
        "cause": status.cause,
        "message": status.message,
        "hint": status.hint,
        "time": _time(run),
        "film": {
            "h_min_m": _extreme(history.film_minimum, history.time, np.argmin),
            "h_central_m": _range(history.film_central),
        },
        "pressure": {"p_max_pa": _extreme(history.pressure_max, history.time, np.argmax)},
        "temperature": _temperature(run),
        "traction": _range(history.traction),
        "load_factor": _range(history.load),
        "cycles": _cycles(run),
        "cost": asdict(run.cost),
        "start": summary(run.start),
    }
    if run.uncertainty:
        content["uncertainty"] = _uncertainty(run)
    plain_content: dict[str, Any] = plain(content)
    return plain_content


def _time(run: TransientResult) -> dict[str, Any]:
    return {
        "duration_s": float(run.history.time[-1]),
        "step_s": run.time_step,
        "steps": len(run.history.time) - 1,
        "frames": len(run.frames.step),
    }


def _extreme(values: Array, times: Array, find: Any) -> dict[str, float]:
    place = int(find(values))
    return {"value": float(values[place]), "time_s": float(times[place]), "start": float(values[0])}


def _temperature(run: TransientResult) -> dict[str, Any] | None:
    """Return the largest rise, nothing for an isothermal run."""
    rise = run.history.temperature_rise
    if run.start.heat is None:
        return None
    return {"film_rise_max_k": _extreme(rise, run.history.time, np.argmax)}


_MIRRORED = (
    ("film_minimum", "film", ("h_min_m", "value")),
    ("film_central_least", "film", ("h_central_m", "least")),
    ("film_central_largest", "film", ("h_central_m", "largest")),
    ("pressure_max", "pressure", ("p_max_pa", "value")),
    ("film_rise_max", "temperature", ("film_rise_max_k", "value")),
    ("traction_extreme", "traction", ("extreme",)),
)
"""Names of estimates, and block and keys of the summary that they mirror."""


def _uncertainty(run: TransientResult) -> dict[str, Any]:
    blocks: dict[str, Any] = {}
    for name, block, keys in _MIRRORED:
        if name not in run.uncertainty:
            continue
        place = blocks.setdefault(block, {})
        for key in keys[:-1]:
            place = place.setdefault(key, {})
        place[keys[-1]] = asdict(run.uncertainty[name])
    if run.bars is not None:
        blocks["history"] = _history_bars(run.bars)
    return blocks


def _history_bars(bars: HistoryBars) -> dict[str, float]:
    return {
        "instants": len(bars.time),
        "h_central_m": float(bars.film_central.max()),
        "h_min_m": float(bars.film_minimum.max()),
        "p_max_pa": float(bars.pressure_max.max()),
    }


def _range(values: Array) -> dict[str, float]:
    return {
        "least": float(values.min()),
        "largest": float(values.max()),
        "start": float(values[0]),
        "end": float(values[-1]),
    }


def _cycles(run: TransientResult) -> dict[str, float]:
    cycles = run.history.cycles[1:]
    if not cycles.size:
        return {"per_step": 0.0, "most": 0.0, "total": 0.0}
    return {
        "per_step": float(cycles.mean()),
        "most": float(cycles.max()),
        "total": float(cycles.sum()),
    }
