"""What a notebook shows of a result: its main numbers with error bars beside a picture."""

import base64
import io
from html import escape
from typing import Any

from matplotlib.figure import Figure

from tehl.io.summary import summary
from tehl.plots import centre_lines, film_map, history
from tehl.plots.frame import write_png
from tehl.report.headline import headline
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution


def result_html(result: Solution | TransientSolution) -> str:
    """Return title, numbers and a picture of a result as HTML; each text is escaped."""
    found = summary(result)
    rows = headline(found) | _others(found)
    cells = "".join(
        f"<tr><th style='text-align: left'>{escape(name)}</th><td>{escape(value)}</td></tr>"
        for name, value in rows.items()
    )
    table = f"<table><caption>{escape(found['title'])}</caption>{cells}</table>"
    draw: Any = history
    if isinstance(result, Solution):
        draw = centre_lines if result.problem.contact.is_line else film_map
    picture = image_html(draw(result, title=False), "film of the contact")
    style = "display: flex; flex-wrap: wrap; gap: 1.5em; align-items: center"
    return f'<div style="{style}">{table}{picture}</div>'


def image_html(figure: Figure, words: str) -> str:
    """Return a matplotlib figure as an image in HTML."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=72, bbox_inches="tight")
    return f'<img alt="{escape(words)}" src="{_url(buffer)}">'


def data_url(figure: Figure, dpi: int) -> str:
    """Return a figure as a data URL."""
    write_png(figure, buffer := io.BytesIO(), dpi)
    return _url(buffer)


def _url(buffer: io.BytesIO) -> str:
    return f"data:image/png;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"


def _others(summary: dict[str, Any]) -> dict[str, str]:
    """Return error bars of a steady film, its friction and its temperature."""
    errors, found = summary.get("errors"), {}
    if errors:
        parts = (f"{100.0 * errors[name]:.2g} %" for name in ("central", "minimum"))
        found["error bars"] = "central {}, minimum {}".format(*parts)
    friction = (summary.get("traction") or {}).get("mid_film")
    if friction:
        found["friction coefficient"] = f"{abs(friction):.3g}"
    rise = (summary.get("temperature") or {}).get("film_rise_max_k")
    if rise is not None and summary.get("kind") != "transient":
        found["largest temperature rise"] = f"{rise:.3g} K"
    return found
