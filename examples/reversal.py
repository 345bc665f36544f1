"""A ball rolls to a stop and back: the film at the turning point.

The entrainment of a point contact goes from 1 to -1 in five half-widths of travel (the template
`reversal`). Interferograms of reciprocating contacts show the same shapes.

**The film is trapped**: when the entrainment stops the oil in the contact is too viscous to leave.
The plateau stays; its rim, where the oil leaves in all directions, closes to a ring.

**The new film comes in from the other side** with a front that moves at the mean speed of both
surfaces. In front of it the rim of the old film is thinnest: least of all film is found shortly
after the turn, not at it.

**Then the horseshoe is mirrored**: it opens where it was closed before.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tehl
from tehl.io.templates import template_text

MOMENTS = (0.4, 1.2, 1.5, 1.7, 1.9, 3.0)
"""[ms]; the entrainment turns at 1.2 ms."""


def turning(points: int = 97) -> tehl.TransientResult:
    """Return the run of the template, with fields at the moments."""
    case = tomllib.loads(template_text("reversal"))
    del case["numerics"]
    case["transient"]["frames"] = [f"{moment} ms" for moment in MOMENTS]
    return tehl.solve_transient(tehl.ContactProblem(**case), tehl.Options(points=points))


def main(points: int = 97) -> dict[str, float]:
    """Return times and films of the turn."""
    run = turning(points)
    history, (before, *_, after) = run.history, run.frames.film
    least = int(history.film_minimum.argmin())
    stop = int(np.argmin(np.abs(history.time - 1.2e-3)))
    return {
        "central film before [nm]": 1e9 * history.film_central[0],
        "central film at the stop [nm]": 1e9 * history.film_central[stop],
        "least film [nm]": 1e9 * history.film_minimum[least],
        "time of it after the stop [ms]": 1e3 * (history.time[least] - history.time[stop]),
        "minimum film at the stop [nm]": 1e9 * history.film_minimum[stop],
        "minimum film before [nm]": 1e9 * history.film_minimum[0],
        "mirrored film over the first": float(after.min() / before.min()),
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in main().items():
        print(f"{name:<32} {value:8.3f}")
    run = turning(129)
    half = run.start.scales.half_width_x
    figure, panels = plt.subplots(2, 3, figsize=(8, 5.4), layout="constrained")
    limit = 1.6e9 * run.history.film_central[0]
    for axes, moment, film in zip(panels.flat, MOMENTS, run.frames.film, strict=True):
        shown = axes.contourf(
            run.x / half, run.y / half, 1e9 * film, np.linspace(0.0, limit, 33), extend="max"
        )
        axes.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4), aspect="equal", title=f"{moment} ms")
    figure.colorbar(shown, ax=panels, label="film [nm]", ticks=np.arange(0.0, limit, 50.0))
    figure.savefig(folder / "reversal.png", dpi=100)
