"""Traction curves: the effects of heat and shear thinning.

Friction grows with sliding, first in proportion to the shear rate. Then the oil thins under the
stress and by heat: the curve of a real oil rises, peaks and falls. Three shear laws at a Hertz
pressure of 0.8 GPa, with heat (circles) and without (squares):

- Eyring: the stress grows with the logarithm of the rate and stays in the range of real oils; with
  heat the traction peaks at 0.04.
- Carreau with an exponent of 0.42: the same at higher tractions.
- Newtonian: unphysical at this pressure. Without heat the traction is 18 at an SRR of one, beyond
  the picture; with heat it peaks above 0.2, twice what oils reach.

The inlet determines the film, which is nearly the same in all cases.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SLIDES = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)
LAWS = {
    "Eyring": {"law": "eyring", "stress": "5 MPa"},
    "Carreau": {"law": "carreau", "modulus": "6 MPa", "exponent": 0.42},
    "Newtonian": {"law": "newtonian"},
}


@cache
def solved(law: str, slide: float, *, heat: bool) -> tehl.Result:
    """Return the film of one law at one slide-to-roll ratio."""
    problem = tehl.ContactProblem(
        contact=tehl.Contact(
            radius="20 mm",
            hertz_pressure="0.8 GPa",
            entrainment_speed="1.5 m/s",
            slide_roll_ratio=slide,
        ),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant={"name": "mineral-oil", "shear": LAWS[law]},
        thermal={} if heat else None,
    )
    return tehl.solve(problem, tehl.Options(points=129))


def curve(law: str, *, heat: bool) -> list[float]:
    """Return the traction coefficients, positive as friction, over the slide-to-roll ratios."""
    return [-solved(law, slide, heat=heat).traction.mid_film for slide in SLIDES]


def main() -> dict[float, float]:
    """Return the traction of the heated Eyring film by slide-to-roll ratio [-]."""
    return dict(zip(SLIDES, curve("Eyring", heat=True), strict=True))


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    print(f"{'SRR':<23}", *(f"{slide:8g}" for slide in SLIDES))
    rows = []
    for law in LAWS:
        for heat in (True, False):
            name, values = f"{law}, {'heat' if heat else 'isothermal'}", curve(law, heat=heat)
            print(f"{name:<23}", *(f"{value:8.4f}" for value in values))
            rows += [(s, -v, heat, law) for s, v in zip(SLIDES, values, strict=True)]
    names = ("slide_roll_ratio", "traction", "thermal", "case")
    picture = plots.traction_curve(dict(zip(names, zip(*rows, strict=True), strict=True)))
    axes = picture.axes[0]
    axes.set(xscale="log", xlim=(0.25, 120.0), ylim=(0.0, 0.25))
    axes.set_xticks(ticks := [100.0 * slide for slide in SLIDES], [f"{tick:g}" for tick in ticks])
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
    picture.savefig(folder / "traction.png", dpi=100)
