"""All figures, each as one PNG and one PDF."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imsave

from tehl.io.atomic import replacing
from tehl.reproduce.book import Book
from tehl.reproduce.draw.contours import contours
from tehl.reproduce.draw.layers import layers
from tehl.reproduce.draw.lines import centre_lines
from tehl.reproduce.draw.surfaces import surfaces
from tehl.reproduce.figures import FigureSpec

_KINDS: dict[str, Callable[[FigureSpec, Book], Figure]] = {
    "film-surface": surfaces,
    "pressure-surface": surfaces,
    "temperature-surface": surfaces,
    "film-contours": contours,
    "centre-lines": centre_lines,
    "layers": layers,
}
DPI = 110
SMALL = "small"
"""Folder of the same figures in few bytes, for the page."""


def draw(spec: FigureSpec, book: Book, folder: Path) -> Path:
    """Draw a figure into ``folder`` as PNG and PDF; return its PNG file."""
    picture = _KINDS[spec.kind](spec, book)
    picture.dpi = DPI
    canvas = FigureCanvasAgg(picture)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    target, small = folder / f"{spec.name}.png", folder / SMALL / f"{spec.name}.webp"
    small.parent.mkdir(parents=True, exist_ok=True)
    with replacing(target) as temporary:
        imsave(temporary, pixels, format="png")
    with replacing(small) as temporary:
        imsave(temporary, pixels, format="webp", pil_kwargs={"quality": 82})
    with replacing(target.with_suffix(".pdf")) as temporary:
        picture.savefig(temporary, format="pdf", dpi=DPI)
    return target
