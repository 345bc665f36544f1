"""Base oils of one viscosity: how the film depends on the kind of oil, and how well it is known.

Five oils of the library with 94 to 100 mm^2/s at 40 degC, in the same contact at 80 degC. There
the polyalphaolefin is a third more viscous than the mineral oils, since it thins less with heat,
and still has the thinnest film, since it thickens less under pressure; the polyglycol, twice as
viscous, has the thickest. Bars are the range of the pressure coefficient, which the film follows
to the power 0.53; of measured coefficients whose source states no error they are not drawn.
"""

import math
import re
import sys
from pathlib import Path

from matplotlib.figure import Figure

import tehl
from tehl.lubricant.fluid import OILS

NAMES = ("n100", "fva-3", "iso-vg-100", "pao-iso-100", "polyglycol-vg-100")


def problem(name: str) -> tehl.ContactProblem:
    """Return the contact with an oil of the library."""
    return tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", hertz_pressure="0.5 GPa", entrainment_speed="2 m/s"),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant={"oil": name, "temperature": "80 degC", "shear": {"law": "newtonian"}},
    )


def part(name: str) -> float:
    """Return the part by which the film may differ, from the range of the pressure coefficient."""
    within = re.search(r"(\d+) %", OILS.entries()[name].evidence["alpha"][1])
    return 0.53 * 0.01 * float(within[1]) if within else math.nan


def main() -> dict[str, float]:
    """Return the central film of each oil [nm]."""
    options = tehl.Options(points=129)
    return {name: 1e9 * tehl.solve(problem(name), options).central_film_thickness for name in NAMES}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    films = main()
    print("oil                 eta [mPa s]   alpha [1/GPa]   film [nm]")
    for name, film in films.items():
        case, bar = problem(name), film * part(name)
        eta, alpha = 1e3 * case.ambient_viscosity, 1e9 * case.pressure_coefficient
        known = f"+- {bar:.0f}" if bar > 0.0 else ""
        print(f"{name:<18} {eta:10.1f} {alpha:15.1f} {film:11.0f}", known)
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.add_subplot(ylabel="central film at 80 °C [nm]")
    bars = [film * part(name) for name, film in films.items()]
    axes.bar(list(films), list(films.values()), yerr=bars, capsize=5, color="0.75", ec="0.3")
    axes.tick_params(axis="x", labelsize=8)
    axes.grid(axis="y", lw=0.3)
    figure.savefig(folder / "base_oils.png", dpi=100)
