"""The Moes numbers M and L, and film formulas.

Papers state a circular contact by its load number M and its speed number L. This script compares
the computed central film with the formulas of Hamrock and Dowson, of Chittenden et al., and of
Nijenbanning, Venner and Moes, from light to heavy load at L = 10.

With Roelands' law a contact also depends on the pressure coefficient, here 22 per GPa, and on the
Hertz pressure. The viscosity is 0.04 Pa s.
"""

import sys
from functools import cache
from pathlib import Path

from matplotlib.figure import Figure

import tehl
from tehl.estimate.film_formulas import film_estimates

LOADS = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0)


@cache
def solved(load: float) -> tehl.Result:
    """Return the film for one Moes load at L = 10."""
    problem = tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", moes_load=load, moes_speed=10.0),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
    )
    return tehl.solve(problem)


def main() -> dict[float, dict[str, float]]:
    """Return, for each load, the central film H by the solver and by the formulas [-]."""
    table = {}
    for load in LOADS:
        result = solved(load)
        films = {
            film.formula: film.central for film in film_estimates(result.groups, result.scales)
        }
        table[load] = {"computed": result.film_scaled.central, **films}
    return table


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axes = figure.add_subplot(xlabel="M", ylabel="central film H", xscale="log", yscale="log")
    rows = main()
    for name in rows[LOADS[0]]:
        style = "o" if name == "computed" else "--"
        axes.plot(LOADS, [rows[load][name] for load in LOADS], style, label=name)
        print(f"{name:<26}", *(f"{rows[load][name]:8.4f}" for load in LOADS))
    axes.legend(title="L = 10")
    figure.savefig(folder / "film_against_load.png", dpi=100)
