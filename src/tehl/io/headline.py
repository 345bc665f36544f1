"""A result in a line and in a small table: what Python and notebooks show of it."""

from html import escape

from tehl.post.film import no_film
from tehl.result import Result
from tehl.transient_result import TransientResult


def headline(result: Result | TransientResult) -> dict[str, str]:
    """Return the main numbers of a result with their units, by name."""
    start = result.start if isinstance(result, TransientResult) else result
    nodes = f"{start.scaled.x.size} x {start.scaled.y.size} nodes"
    numbers = _transient(result) if isinstance(result, TransientResult) else _steady(result)
    return {"status": result.status.outcome, **numbers, "grid": nodes}


def _steady(result: Result) -> dict[str, str]:
    if reason := no_film(result):
        return {"film": f"none, {reason}"}
    highest = float(result.scaled.pressure.max()) * result.scales.hertz_pressure
    return {
        "central film": _nm(result.film.central),
        "minimum film": _nm(result.film.minimum),
        "largest pressure": _gpa(highest),
    }


def _transient(run: TransientResult) -> dict[str, str]:
    history = run.history
    return {
        "least minimum film": _nm(history.film_minimum.min()),
        "largest pressure": _gpa(history.pressure_max.max()),
        "duration": f"{history.time[-1] * 1e3:.4g} ms in {history.time.size - 1} steps",
    }


def _nm(metres: float) -> str:
    return f"{metres * 1e9:.4g} nm"


def _gpa(pressure: float) -> str:
    return f"{pressure * 1e-9:.4g} GPa"


def as_line(result: Result | TransientResult) -> str:
    """Return a result in one line, for ``repr``."""
    status, *others = headline(result).items()
    numbers = ", ".join(f"{name} {value}" for name, value in others)
    return f"<{type(result).__name__} {_title(result)!r}: {status[1]}, {numbers}>"


def as_html(result: Result | TransientResult) -> str:
    """Return a result as a small HTML table, for notebooks; each text is escaped."""
    rows = "".join(
        f"<tr><th style='text-align: left'>{escape(name)}</th><td>{escape(value)}</td></tr>"
        for name, value in headline(result).items()
    )
    return f"<table><caption>{escape(_title(result))}</caption>{rows}</table>"


def _title(result: Result | TransientResult) -> str:
    start = result.start if isinstance(result, TransientResult) else result
    return start.problem.title
