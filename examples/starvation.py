"""Scarce oil: the film of a starved contact over its supply.

Grease and oil-air bearings run with less oil than their contacts could pass on. A layer of oil on
the surfaces then fills the gap only from a meniscus on, close to the contact, and the film is
hardly thicker than what comes.

**The film follows the supply.** With r, the oil that comes over what the flooded contact passes on,
the central film is `r / (1 + r^3)^(1/3)` of the flooded one within five per cent up to r = 0.7:
little oil is squeezed aside, because the pressure begins late and so does the flow to the sides.

**The meniscus comes near**: a half-width ahead of the contact at r = 2, 0.07 of it at r = 0.3, and
the pressure approaches that of the dry contact.

**Oil is conserved**: the flux through all sections across the flow is the same to the tolerance
of the iteration, in the film and where the gap is partly filled.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SUPPLIES = (2.0, 1.0, 0.7, 0.3)


@cache
def solved(ratio: float, points: int = 193) -> tehl.Result:
    """Return the film of a ball on a disc with a supply, over that of the flooded contact."""
    problem = tehl.ContactProblem(
        title=f"Starved ball on disc, r = {ratio:g}",
        contact=tehl.Contact(radius=0.02, load=80.0, entrainment_speed=1.5),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
        supply={"ratio": ratio},
    )
    return tehl.solve(problem, tehl.Options(points=points))


def main() -> dict[float, tuple[float, float, float, float]]:
    """Return, by supply: film over flooded film, by law, inlet distance [a], balance of the oil."""
    table = {}
    for ratio in SUPPLIES:
        found = solved(ratio).starvation
        distance = found.inlet_distance / solved(ratio).scales.half_width_x
        table[ratio] = (found.degree, found.degree_by_law, distance, found.balance)
    return table


def draw(folder: Path) -> None:
    """Draw where the oil is, with plenty of it and with little."""
    for ratio in (SUPPLIES[0], SUPPLIES[-1]):
        picture = plots.oil_map(solved(ratio))
        picture.savefig(folder / f"starvation_{ratio:g}.png", dpi=100)


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    out.mkdir(parents=True, exist_ok=True)
    for ratio, (degree, law, distance, balance) in main().items():
        print(
            f"r = {ratio:<4g} {degree:.3f} of the flooded film ({law:.3f} by the law), meniscus "
            f"{distance:.2f} half-widths ahead, oil flux constant to {balance:.0e}"
        )
    draw(out)
