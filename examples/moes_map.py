"""Errors of film formulas over the Moes numbers.

A study solves circular contacts over the Moes numbers M (load) and L (speed and lubricant). The
picture shows the central film in Moes form and the error of each formula.

- Central film of Nijenbanning, Venner and Moes: within 5 % for M = 10 to 200 and L up to 5,
  isoviscous contacts included. It is 11 % too thick at M = 200, L = 10, 28 % at M = 2000, L = 20,
  and 15 to 34 % at M = 5.
- Central film of Chittenden et al.: within 6 % for M = 20 to 500 and L from 3.5 on, within 10 % to
  M = 2000; 10 to 20 % too thin at L = 1, up to a third too thick at M = 5.
- Central film of Hamrock and Dowson: 2 to 9 % above that of Chittenden.
- Minimum films of both: 10 to 50 % too thin up to M = 10, right at M = 50 to 100, a third too thick
  at M = 200, twice the computed film at M = 2000.

Use no formula for the minimum film above M = 100.

The computed films are those of one grid each, with errors of 1 to 4 %, at M = 2000 of 8 % in the
minimum.
"""

import sys
from pathlib import Path

import tehl
from tehl import plots, studies

LOADS, SPEEDS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000), (1, 2, 3.5, 5, 7, 10, 14, 20)
NODES = {100: 513, 200: 513, 500: 513, 1000: 1025, 2000: 1025}
"""Nodes per direction that high loads need."""
PROBLEM = tehl.ContactProblem(
    contact=tehl.Contact(radius="20 mm", moes_load=100, moes_speed=10),
    surface_1=tehl.Surface(material="steel"),
    surface_2=tehl.Surface(material="steel"),
    lubricant=tehl.Lubricant(
        viscosity={"law": "roelands", "eta_0": "0.04 Pa s", "alpha": "22 1/GPa"},
        density={"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
    ),
)


def films(loads: tuple[float, ...], speeds: tuple[float, ...], jobs: int = 1):
    """Return the table of the contacts with these M and L."""
    nodes = [NODES.get(load, 257) for load in loads]
    axes = [
        studies.Axis(path="contact.moes_load", name="M", values=list(loads), zip="load"),
        studies.Axis(path="numerics.points", values=nodes, zip="load"),
        studies.Axis(path="contact.moes_speed", name="L", values=list(speeds)),
    ]
    return tehl.study(PROBLEM, axes, jobs=jobs)


def main() -> dict[tuple[float, float], dict[str, float]]:
    """Return the errors of central films by formula at some M and L [%]."""
    table = films((10, 100), (2, 10))
    off = plots.film_deviations(table)
    return {
        (load, speed): dict(zip(off, values, strict=True))
        for load, speed, *values in zip(table["M"], table["L"], *off.values(), strict=True)
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    table = films(LOADS, SPEEDS, jobs=2)
    print(f"{(table['status'] == 'converged').sum()} of {len(table)} contacts converged")
    for name, values in plots.film_deviations(table).items():
        print(f"{name:<36} off by {values.min():5.1f} to {values.max():5.1f} %")
    plots.moes_map(table).savefig(folder / "moes_map.png", dpi=100)
