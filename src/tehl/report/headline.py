"""A summary in a line, and its main numbers by name: what Python shows of a result."""

from collections.abc import Mapping
from typing import Any

from tehl.base.wording import grid_size
from tehl.result.registry import shown_in

Summary = Mapping[str, Any]


def as_line(kind: str, summary: Summary) -> str:
    """Return a summary in one line, for ``repr`` of a class called ``kind``."""
    status, *others = headline(summary).items()
    numbers = ", ".join(f"{name} {value}" for name, value in others)
    return f"<{kind} {summary['title']!r}: {status[1]}, {numbers}>"


def headline(summary: Summary) -> dict[str, str]:
    """Return the main numbers of a summary with their units, by name."""
    transient = summary.get("kind") == "transient"
    outcome = dict.fromkeys(filter(None, (summary["status"], summary["cause"])))
    start = summary["start"] if transient else summary
    return {
        "status": ": ".join(outcome).replace("_", " "),
        **(_transient(summary) if transient else _steady(summary)),
        "grid": grid_size(start["cost"]["points"]),
    }


def _steady(summary: Summary) -> dict[str, str]:
    found = {}
    for one in shown_in("line"):
        value = (summary[one.block] or {}).get(one.key)
        shown = "none" if value is None else f"{one.shown(value):.4g} {one.unit}".rstrip()
        found[one.words["line"]] = shown
    return found


def _transient(summary: Summary) -> dict[str, str]:
    time = summary["time"]
    return {
        "least minimum film": _nm(summary["film"]["h_min_m"]["value"]),
        "largest pressure": _gpa(summary["pressure"]["p_max_pa"]["value"]),
        "duration": f"{time['duration_s'] * 1e3:.4g} ms in {time['steps']} steps",
    }


def _nm(metres: float | None) -> str:
    return "none" if metres is None else f"{metres * 1e9:.4g} nm"


def _gpa(pressure: float | None) -> str:
    return "none" if pressure is None else f"{pressure * 1e-9:.4g} GPa"
