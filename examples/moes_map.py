"""Film formulas over the Moes map: where each of them can be trusted.

A study solves circular contacts over the Moes numbers M (load) and L (speed and lubricant), and
the picture shows the central film in Moes form and by how much each formula is off it.

The central film of Nijenbanning, Venner and Moes is the one to trust over the widest range: from
M = 10 on it is within 5 % where L stays below 5 and M below 200, isoviscous contacts included.
Where both numbers are large it gets too thick: 11 % at M = 200 and L = 10, 28 % at M = 2000 and L
= 20. At M = 5 it is 15 to 34 % too thick. Chittenden's central film is the best guess in the
elastic-piezoviscous middle: within 6 % for L from 3.5 on and M from 20 to 500, within 10 % to M =
2000. That of Hamrock and Dowson lies 2 to 9 % above it. Neither was made for L = 1, where both
are 10 to 20 % too thin, nor for M = 5, where both are up to a third too thick. Their minimum
films hardly know the load: 10 to 50 % too thin up to M = 10, right about M = 50 to 100, a third
too thick at M = 200 and twice as thick as computed at M = 2000. Take no formula for the minimum
above M = 100.

The computed films are those of one grid each and known to 1 to 4 %, the minimum at M = 2000 to 8
%.
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
    """Return how far central films by formula are off at some M and L [%]."""
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
