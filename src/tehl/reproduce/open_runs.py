"""Which runs are no answer."""

from collections.abc import Iterable

from tehl.reproduce.book import Book
from tehl.reproduce.series import Heat

_HEATS: tuple[Heat, Heat] = ("isothermal", "thermal")


def open_runs(
    book: Book,
    series: Iterable[str],
    heats: tuple[Heat, ...] = _HEATS,
    values: tuple[float, ...] = (),
) -> str:
    """Return which of the fine runs are no converged answer, in words; empty if all are."""
    words = []
    for name in series:
        symbol = book.series[name].symbol
        for heat in heats:
            line = book.line(name, "converged", heat)
            failed = [v for v, m in line.items() if not m.quality.converged]
            failed = [v for v in failed if not values or v in values]
            if failed:
                nodes = line[failed[0]].quality.points[0]
                which = ", ".join(f"{v:g}" for v in failed)
                words.append(
                    f"no converged {heat} answer on {nodes} × {nodes} nodes at {symbol} = {which} "
                    f"(series {name})"
                )
            words += [told] if (told := _coarser(book, name, heat, values)) else []
    return "; ".join(words)


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
    return (
        f"with heat it converges on {nodes} × {nodes} nodes only at {one.symbol} = {which} (series "
        f"{name}), where H_min is known to {100 * min(errors):.0f} to {100 * max(errors):.0f} %"
    )
