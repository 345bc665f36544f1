"""Which runs are no answer, and what it would take."""

import math
from collections.abc import Iterable

from tehl.reproduce.book import Book
from tehl.reproduce.measures import Measures
from tehl.reproduce.series import Heat, Treatment

THINNING = {"C": "C-eyring"}
"""Series, and the same with an oil that thins in shear."""
KNOWN = 0.05
"""Error bar of a film that is well known, over the film."""
_HEATS: tuple[Heat, Heat] = ("isothermal", "thermal")


def open_runs(
    book: Book,
    series: Iterable[str],
    heats: tuple[Heat, ...] = _HEATS,
    values: tuple[float, ...] = (),
    way: Treatment = "converged",
) -> str:
    """Return which of the fine runs are no converged answer, in words; empty if all are."""
    words = []
    for name in series:
        for heat in heats:
            line = book.line(name, way, heat)
            words += _refused(
                book, name, heat, {v: m for v, m in line.items() if _asked(v, values)}
            )
            words += [told] if (told := _coarser(book, name, heat, values)) else []
    return "; ".join(words)


def _asked(value: float, values: tuple[float, ...]) -> bool:
    return not values or value in values


def _refused(book: Book, name: str, heat: Heat, line: dict[float, Measures]) -> list[str]:
    """Say of each way to fail which runs of a line did, on which grid and domain."""
    failed: dict[str, list[float]] = {}
    for value, found in line.items():
        if not found.quality.converged:
            failed.setdefault(_failure(found), []).append(value)
    symbol = book.series[name].symbol
    return [
        f"no converged {heat} answer at {symbol} = {', '.join(f'{v:g}' for v in values)} "
        f"(series {name}): {how}"
        for how, values in failed.items()
    ]


def _failure(found: Measures) -> str:
    """Return how a run ended, with its grid and domain."""
    (nx, ny), edges = found.quality.points, found.quality.domain
    x, y = (f"[{first:g}, {last:g}]" for first, last in (edges[:2], edges[2:]))
    how = found.quality.outcome.replace("not converged: ", "")
    return f"{how} on {nx} × {ny} nodes of {x} × {y}"


def _coarser(book: Book, name: str, heat: Heat, values: tuple[float, ...]) -> str:
    """Say which answers are those of the coarser grid, and how well they are known."""
    one = book.series[name]
    runs = [book.run(name, "converged", heat, v) for v in one.values if not values or v in values]
    taken = [run for run in runs if run is not None and run.treatment == "coarser"]
    found = [m for run in taken if (m := book.measures(run)) is not None]
    if not found:
        return ""
    nodes = found[0].quality.points[0]
    which = ", ".join(f"{run.value:g}" for run in taken)
    errors = [m.film.minimum_error / m.film.minimum for m in found if m.film.minimum > 0]
    where = f"with heat it converges on {nodes} × {nodes} nodes only at {one.symbol} = {which}"
    known = f"{100 * min(errors):.0f} to {100 * max(errors):.0f} %" if errors else "no digit"
    needed = nodes_needed(nodes, max(errors, default=0.0))
    more = f": {100 * KNOWN:.0f} % would take {needed} × {needed}" if needed > nodes else ""
    return f"{where} (series {name}), where H_min is known to {known}{more}{_thinning(book, name)}"


def nodes_needed(nodes: int, error: float) -> int:
    """Return the nodes of the grid that makes ``error`` on ``nodes`` small, at second order."""
    finer = math.sqrt(max(error / KNOWN, 1.0))
    return (nodes - 1) * 2 ** math.ceil(math.log2(finer)) + 1


def _thinning(book: Book, name: str) -> str:
    """Say how an oil that thins does between the same waves; nothing if it was not tried."""
    other = THINNING.get(name, "")
    line = book.line(other, "converged", "thermal") if other in book.series else {}
    if not line:
        return ""
    found = list(line.values())
    nodes, answers = found[0].quality.points[0], [m for m in found if m.quality.converged]
    errors = [100 * m.film.minimum_error / m.film.minimum for m in answers]
    known = f", H_min known to {min(errors):.0f} to {max(errors):.0f} %" if errors else ""
    return (
        f"; an oil that thins (Eyring, 5 MPa) has an answer on {nodes} × {nodes} nodes at "
        f"{len(answers)} of {len(book.series[other].values)} loads{known}"
    )
