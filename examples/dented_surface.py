"""A dent and a bump in the contact.

A bump and a dent of 0.2 um, both 20 um in radius, stand in the middle of a ball on a disc. The oil
around them is too viscous to flow aside.

**The bump is flattened** by a pressure of more than twice the Hertz pressure; a tenth of its height
remains in the film, due to the compressibility of the oil. The rest of the film does not change.

**The dent is filled less.** The pressure above it falls to a third, the oil there becomes thin and
flows, and three tenths of the depth remain. The oil that leaves the dent is carried downstream: the
film behind it is thicker up to the outlet, and the pressure higher.

The features stand still, as on a surface at rest. Features that move with their surface need a
transient run, with a table `[transient]`.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots
from tehl.roughness import Bump

HEIGHTS = {"smooth": 0.0, "bump": 0.2e-6, "dent": -0.2e-6}
RADIUS = 20e-6
DOMAIN = tehl.Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))


@cache
def solved(name: str) -> tehl.Result:
    """Return the film with one feature in the middle of the contact."""
    disc = tehl.Surface(material="steel")
    if HEIGHTS[name]:
        bump = Bump(amplitude=HEIGHTS[name], radius=RADIUS)
        disc = disc.model_copy(update={"roughness": bump})
    problem = tehl.ContactProblem(
        title=f"Steel ball on a steel disc: {name}",
        contact=tehl.Contact(radius="20 mm", load="80 N", entrainment_speed="1.5 m/s"),
        surface_1=tehl.Surface(material="steel"),
        surface_2=disc,
        lubricant="mineral-oil",
    )
    return tehl.solve(problem, tehl.Options(points=257, domain=DOMAIN))


def main() -> dict[str, dict[str, float]]:
    """Return the central film [nm], and the largest and the central pressure over Hertz [-]."""
    table = {}
    for name in HEIGHTS:
        result = solved(name)
        pressure = result.scaled.pressure
        table[name] = {
            "central film [nm]": result.film.central * 1e9,
            "largest pressure": float(pressure.max()),
            "central pressure": result.scaled.at_origin(pressure),
        }
    return table


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, numbers in main().items():
        print(f"{name:<8}" + ", ".join(f"{what} {n:.4g}" for what, n in numbers.items()))
        if HEIGHTS[name]:
            line = plots.rough_centre_line(solved(name), solved("smooth"))
            line.savefig(folder / f"line_{name}.png", dpi=90)
            plots.film_map(solved(name)).savefig(folder / f"film_{name}.png", dpi=90)
