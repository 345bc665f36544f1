"""The numbers of a result as one JSON object."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from itertools import groupby
from operator import attrgetter
from types import SimpleNamespace
from typing import Any, Literal, TypeVar

import numpy as np
from pydantic import TypeAdapter

from tehl.base.typing import Array
from tehl.post.following import Following
from tehl.post.roughness import RoughFilm
from tehl.post.transient_numbers import (
    friction,
    lambda_central,
    late_extremes,
    longer_duration,
    sliding_power,
    unresolved,
)
from tehl.result import quantities, registry
from tehl.result.quantity import Quantity
from tehl.result.solution import Solution
from tehl.result.transient import HistoryBars, TransientSolution

Block = dict[str, Any]
Part = TypeVar("Part")


def summary(result: Solution | TransientSolution) -> Block:
    """Return the summary of a result as JSON can hold it: null where a number is not finite.

    Keys that end in a unit (``_m``, ``_pa``, ``_k``, ``_s``, ``_w``) are SI, the others
    dimensionless. A film that is not positive is null; ``temperature`` and ``heat`` are null for an
    isothermal run, ``traction`` without shear stresses, ``roughness`` if no surface states any. A
    certified result has ``uncertainty``, which mirrors the values.

    A transient result has ``"kind": "transient"``, extremes with their times, and under ``start``
    the summary of the steady film at its start.
    """
    status = result.status
    if isinstance(result, TransientSolution):
        title, kind, content = result.start.problem.title, {"kind": "transient"}, _transient(result)
    else:
        title, kind, content = result.problem.title, {}, _steady(result)
    head = {"title": title, "status": status.kind, "cause": status.cause, "message": status.message}
    hint: Block = {"hint": None, "settings": None}
    if status.hint is not None:
        hint = {"hint": str(status.hint), "settings": dict(status.hint.settings)}
    found: Block = plain(kind | head | hint | content)
    return found


def plain(value: Any) -> Any:
    """Return ``value`` with plain numbers and lists, and None for each number not finite."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def from_block(kind: type[Part], block: Any) -> Part | None:
    """Return the dataclass that a block of a stored summary holds; None if it does not fit.

    Parameters
    ----------
    kind : type
        Dataclass with the keys of the block.
    block : object
        Parsed JSON of any kind, None if the summary has no such block.
    """
    try:
        return TypeAdapter(kind).validate_python(block)
    except ValueError:  # missing, or written by another program
        return None


def _mirrored(result: Solution | TransientSolution, rows: Iterable[Quantity]) -> Block:
    """Return the estimates of a result under the keys of their values."""
    blocks: Block = {}
    in_si = result.certified
    for one in rows:
        if one.name in in_si:
            found = (
                in_si if one.unit or not one.key.startswith(("H_", "P_")) else result.uncertainty
            )
            _block_of(blocks, one.block)[one.key] = asdict(found[one.name])
    return blocks


def _block_of(blocks: Block, path: str) -> Block:
    """Return the block at a dotted path, made if it is not there."""
    for key in path.split("."):
        blocks = blocks.setdefault(key, {})
    return blocks


# ---- steady results


def _steady(result: Solution) -> Block:
    content = _blocks_of(Following(result))
    if result.uncertainty:
        order = list(content)  # of blocks; in a block by name
        certified = sorted(
            (one for one in registry.certified() if content[one.block] is not None),
            key=lambda one: (order.index(one.block), one.name, one.path),
        )
        content["uncertainty"] = {"film": {}, "pressure": {}} | _mirrored(result, certified)
    return content


def _blocks_of(found: Any, only: str = "") -> Block:
    """Return the blocks of a summary, or ``only`` one; those without an owner are None."""
    content: Block = {}
    for path, rows in groupby(registry.in_summary(), key=lambda one: one.block):
        if not only or f"{path}.".startswith(f"{only}."):
            _add(content, path, registry.OWNERS[path](found), list(rows))
    return content


def _add(content: Block, path: str, owner: Any, rows: list[Quantity]) -> None:
    """Add quantities of one block to a summary; blocks inside one that is None are left out."""
    *parents, key = path.split(".")
    for parent in parents:
        content = content[parent]
        if content is None:
            return
    if owner is None:
        content[key] = None
    elif path in registry.LISTS:
        content[key] = [{row.key: row.of(one) for row in rows} for one in owner]
    else:
        content.setdefault(key, {}).update({row.key: row.of(owner) for row in rows})


def roughness_block(found: RoughFilm) -> Block:
    """Return the block ``roughness`` of a summary from the numbers of a rough film."""
    block: Block = _blocks_of(SimpleNamespace(rough=found), "roughness")["roughness"]
    return block


# ---- transient results


def _transient(run: TransientSolution) -> Block:
    history, times = run.history, run.history.time
    cycles = history.cycles[1:].astype(float) if history.cycles.size > 1 else np.zeros(1)
    content: Block = {
        "time": {
            "duration_s": float(times[-1]),
            "step_s": run.time_step,
            "steps": len(times) - 1,
            "nodes": np.unique(history.nodes)[::-1].tolist(),
            "frames": len(run.frames.step),
            "late_extremes": list(late_extremes(run)),
            "longer_duration_s": longer_duration(run),
        },
    }
    for one in HISTORY:
        values, (block, _, key) = one.of(run), one.path.partition(".")
        found = None if values is None else one.statistics(values, times)
        if key:
            content[block] = (content.get(block) or {}) | {key: found} if found else None
        else:
            content[block] = found
    content |= {
        "unresolved": unresolved(run),
        "cycles": {"per_step": cycles.mean(), "most": cycles.max(), "total": cycles.sum()},
        "cost": asdict(run.cost),
        "start": summary(run.start),
    }
    if run.uncertainty:
        content["uncertainty"] = _mirrored(run, quantities.TRANSIENT)
        if run.bars is not None:
            content["uncertainty"]["history"] = _history_bars(run.bars)
    return content


@dataclass(frozen=True, slots=True)
class Historical:
    """A number of each step in the summary of a transient result: extremes, mean and end."""

    path: str
    """Where it is."""
    of: Callable[[TransientSolution], Array | None]
    """Its values, (nt,); None where there are none."""
    extreme: Literal["least", "largest"] | None = None
    """The one extreme that matters, ``value`` at ``time_s``; None has both."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the paths of its statistics."""
        extremes = ("value", "time_s") if self.extreme else _BOTH
        return tuple(f"{self.path}.{key}" for key in (*extremes, "start", "end", "mean"))

    def statistics(self, values: Array, times: Array) -> Block:
        """Return extremes and their times, start, end, and mean over time.

        Parameters
        ----------
        values, times : Array
            At each step, (nt,), the times in [s].
        """
        low, high = int(values.argmin()), int(values.argmax())
        mean = float(np.mean(0.5 * (values[1:] + values[:-1]))) if values.size > 1 else values[0]
        places = {"least": (low,), "largest": (high,), None: (low, high)}[self.extreme]
        found = [one for place in places for one in (values[place], times[place])]
        keys = (column.rpartition(".")[2] for column in self.columns)
        return dict(zip(keys, (*found, values[0], values[-1], mean), strict=True))


_BOTH = ("least", "least_time_s", "largest", "largest_time_s")


def _if_any(name: str) -> Callable[[TransientSolution], Array | None]:
    """Return the function to a part of the history, None where it is zero throughout."""

    def found(run: TransientSolution) -> Array | None:
        values: Array = getattr(run.history, name)
        return values if values.any() else None

    return found


def _asperity_load(run: TransientSolution) -> Array | None:
    has_solids = run.start.asperities is not None or run.start.problem.contact_film is not None
    return run.history.asperity_load if has_solids else None


HISTORY = (
    Historical("film.h_min_m", attrgetter("history.film_minimum"), "least"),
    Historical("film.h_central_m", attrgetter("history.film_central")),
    Historical("pressure.p_max_pa", attrgetter("history.pressure_max"), "largest"),
    Historical(
        "temperature.film_rise_max_k",
        lambda run: None if run.start.heat is None else run.history.temperature_rise,
        "largest",
    ),
    Historical("traction", attrgetter("history.traction")),
    Historical("traction_across", _if_any("traction_across")),
    Historical("drilling.moment_n_m", _if_any("drilling_moment")),
    Historical(
        "rolling.moment_n_m",
        lambda run: run.history.rolling_moment if run.start.problem.contact.has_lines else None,
    ),
    Historical("friction", friction),
    Historical("sliding_power_w", sliding_power, "largest"),
    Historical("lambda_central", lambda_central, "least"),
    Historical("asperity_load", _asperity_load, "largest"),
    Historical("load_factor", attrgetter("history.load")),
    Historical("speed_factor", attrgetter("history.speed")),
    Historical("radius_factor", attrgetter("history.radius")),
    Historical("sliding_factor", attrgetter("history.sliding")),
)
"""Numbers of each step, in the order of the summary."""


def history_columns() -> dict[str, str]:
    """Return the paths of what a summary has of each step, and the path whose unit each has."""
    return {
        column: column if column.endswith("_s") else one.path
        for one in HISTORY
        for column in one.columns
    }


def _history_bars(bars: HistoryBars) -> Block:
    return {
        "instants": len(bars.time),
        "h_central_m": bars.film_central.max(),
        "h_min_m": _known(bars.film_minimum.max()),
        "p_max_pa": _known(bars.pressure_max.max()),
    }


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value
