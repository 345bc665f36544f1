"""A dent passes through a contact.

A ball has a dent in its surface, 0.3 um deep and about as wide as half of the contact's radius; the
film is 0.32 um thick. The run follows the dent through the contact (the template `passing-dent`).
Each picture shows four moments: the film along y = 0, the pressure, and below them the undeformed
surface.

**In pure rolling** the dent and the oil in it move together. The film keeps more than half of the
depth, and the pressure hardly changes.

**With sliding they separate.** The oil in the contact is too viscous to be moved by the pressure:
it moves at the mean speed of both surfaces, and so does the thick film that the dent made in the
inlet. The dent moves with its surface: if that is the fast one (SRR = 0.5), the thick film falls
behind, if it is the slow one (SRR = -0.5), it runs ahead. The dent without its oil is flattened:
the pressure is low over the dent, and over the thick film up to half as high again as in the smooth
contact. The picture of place and time shows both paths.

The oil is Newtonian and isothermal: films and pressures are realistic, the traction is not.
"""

import sys
import tomllib
from functools import cache
from pathlib import Path

import numpy as np

import tehl
from tehl.io.templates import template_text
from tehl.plots.transient import moments, space_time
from tehl.post.transient import envelope, moving_profiles

SLIDES = (0.0, 0.5, -0.5)


@cache
def followed(slide: float, points: int = 129) -> tehl.TransientResult:
    """Return the transient film at one slide-to-roll ratio."""
    case = tomllib.loads(template_text("passing-dent"))
    del case["numerics"]
    case["contact"]["slide_roll_ratio"] = slide
    return tehl.solve_transient(tehl.ContactProblem(**case), tehl.Options(points=points))


def numbers(run: tehl.TransientResult) -> dict[str, float]:
    """Return extremes of film and pressure over the smooth ones, and the lead of the thick film."""
    inside = np.abs(run.start.scaled.x) < 0.7
    limits, smooth = envelope(run), run.profiles.film[0]
    seen = moving_profiles(run, 1)
    step = int(np.argmin(np.abs(seen.place)))
    change = run.profiles.film[step] - smooth
    return {
        "largest film over smooth": float((limits.film_largest / smooth)[inside].max()),
        "least film over smooth": float((limits.film_least / smooth)[inside].min()),
        "largest pressure over smooth": float(
            run.history.pressure_max.max() / run.history.pressure_max[0]
        ),
        "thick film ahead of the dent [um]": 1e6
        * (peak(run.x[inside], change[inside]) - float(seen.place[step])),
    }


def peak(x: np.ndarray, values: np.ndarray) -> float:
    """Return where the parabola through the largest value and its neighbours is largest."""
    k = int(values.argmax())
    below, top, above = values[k - 1 : k + 2]
    return float(x[k] + 0.5 * (x[1] - x[0]) * (below - above) / (below - 2.0 * top + above))


def main(points: int = 129) -> dict[float, dict[str, float]]:
    """Return the numbers of each passage, by slide-to-roll ratio."""
    return {slide: numbers(followed(slide, points)) for slide in SLIDES}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    table = main()
    print(f"{'SRR':<34}", *(f"{slide:8g}" for slide in SLIDES))
    for name in table[0.0]:
        print(f"{name:<34}", *(f"{table[slide][name]:8.3f}" for slide in SLIDES))
    for slide in SLIDES:
        ending = f"{slide:g}".replace("-", "minus_").replace(".", "_")
        moments(followed(slide)).savefig(folder / f"moments_{ending}.png", dpi=100)
    space_time(followed(0.5)).savefig(folder / "space_time.png", dpi=100)
