"""A dimple: heat can thicken the middle of a film.

A steel ball and a glass disc slide: the ball moves slowly backwards, the disc fast forwards. Glass
conducts heat forty times worse than steel, so its surface is far warmer. The oil at the glass is
thin and shears; the oil at the cooler steel stays viscous and moves with it, backwards. The contact
then carries less oil than the mean speed suggests, and the film grows until the flow equals that of
the inlet: the temperature-viscosity wedge. The film is thicker in the middle than upstream of it.

**The cooler surface must be the slow one.** With the opposite slide-to-roll ratio the viscous oil
moves forwards with the fast steel, the contact carries more oil, and the film stays thin without a
dimple. With properties at the mean temperature of the film (`reynolds = "mean"`) the Reynolds
equation has no such wedge, and there is no dimple either.

The surface temperature of a slow surface, or one at rest, cannot be marched downstream; with
`sources = "auto"` it comes from the full moving source.
"""

import sys
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import tehl
from tehl import plots
from tehl.io.templates import template_text

SLIDE = 2.5
RUNS = {
    "ball slow (cool)": (SLIDE, "generalised"),
    "disc slow (warm)": (-SLIDE, "generalised"),
    "ball slow, mean temperature": (SLIDE, "mean"),
}


@cache
def solved(slide: float, reynolds: str) -> tehl.Result:
    """Return the film of the template `dimple` at one slide-to-roll ratio."""
    case = tomllib.loads(template_text("dimple"))
    del case["numerics"]
    case["contact"]["slide_roll_ratio"] = slide
    case["thermal"]["reynolds"] = reynolds
    case["title"] = f"Glass disc on steel ball, SRR = {slide:g}, {reynolds}"
    return tehl.solve(tehl.ContactProblem(**case), tehl.Options(points=129))


def centre_line(result: tehl.Result) -> tuple[np.ndarray, np.ndarray]:
    """Return X [-] and the film [nm] along y = 0."""
    row = int(np.argmin(np.abs(result.scaled.y)))
    return result.scaled.x, result.film_thickness[row] * 1e9


def dimple(result: tehl.Result) -> float:
    """Return the excess of a maximum in the middle over the least film upstream of it [nm]."""
    x, film = centre_line(result)
    inner = [i for i in np.flatnonzero(np.abs(x) < 0.5) if film[i] > max(film[i - 1], film[i + 1])]
    return max((float(film[i] - film[:i].min()) for i in inner), default=0.0)


def main() -> dict[str, float]:
    """Return the height of the dimple of each run [nm]."""
    return {name: dimple(solved(*run)) for name, run in RUNS.items()}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.add_subplot(xlabel="X = x / a, along y = 0", ylabel="film thickness [nm]")
    for name, height in main().items():
        result = solved(*RUNS[name])
        print(
            f"{name:<28} central film {result.film.central * 1e9:4.0f} nm, dimple {height:4.0f} nm"
        )
        axes.plot(*centre_line(result), label=name)
    axes.set(xlim=(-1.6, 1.3), ylim=(0, 1400))
    axes.legend()
    figure.savefig(folder / "centre_line.png", dpi=100)
    deep = solved(*RUNS["ball slow (cool)"])
    plots.film_map(deep).savefig(folder / "film.png", dpi=100)
    plots.temperature_section(deep).savefig(folder / "section.png", dpi=100)
    light = plots.Optics(light="monochromatic")
    plots.interferogram(deep, light).savefig(folder / "interferogram.png", dpi=100)
