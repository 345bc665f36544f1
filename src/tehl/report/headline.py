"""A summary in a line, and its main numbers by name: what Python shows of a result."""

from collections.abc import Mapping
from typing import Any

Summary = Mapping[str, Any]


def as_line(kind: str, summary: Summary) -> str:
    """Return a summary in one line, for ``repr`` of a class ``kind``."""
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
        "grid": "{} x {} nodes".format(*start["cost"]["points"]),
    }


def _steady(summary: Summary) -> dict[str, str]:
    film = summary["film"]
    return {
        "central film": _nm(film["h_central_m"]),
        "minimum film": _nm(film["h_min_m"]),
        "largest pressure": _gpa(summary["pressure"]["max_pa"]),
    }


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
