"""A steel ball on a steel disc.

The contact of `make demo`, stated in Python: a ball of 20 mm radius on a flat disc of the same
steel, both surfaces at 1.5 m/s, under 80 N. Fields of a model accept strings with units, as a case
file does.

The film has the typical features of an elastohydrodynamic point contact: a plateau of nearly
constant thickness, and a horseshoe around its outlet with the smallest film in the two side lobes.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots


@cache
def solved() -> tehl.Result:
    """Return the film of the contact."""
    problem = tehl.ContactProblem(
        title="Steel ball on steel disc, mineral oil",
        contact=tehl.Contact(load="80 N", entrainment_speed="1.5 m/s"),
        surface_1=tehl.Surface(material="steel", radius="20 mm"),
        surface_2=tehl.Surface(material="steel", radius="inf"),
        lubricant="mineral-oil",
    )
    return tehl.solve(problem, tehl.Options(points=257))


def main() -> dict[str, float]:
    """Return central and minimum film [nm] and the largest pressure [GPa]."""
    result = solved()
    return {
        "central film [nm]": result.film.central * 1e9,
        "minimum film [nm]": result.film.minimum * 1e9,
        "largest pressure [GPa]": float(result.pressure.max()) * 1e-9,
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in main().items():
        print(f"{name:<24}{value:.4g}")
    plots.film_map(solved()).savefig(folder / "film.png", dpi=100)
    plots.centre_lines(solved()).savefig(folder / "centre_lines.png", dpi=100)
