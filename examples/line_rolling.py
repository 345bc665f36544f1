"""Rolling friction of a line contact: which published law is right where.

The inlet of a line contact pushes its pressure upstream of the middle, which brakes both bodies.
Published laws for this moment have exponents of the load from 0 to 0.37. Here the number T* M^(3/2)
is computed at two speeds: it is constant where the force does not depend on the load.

**The exponent** -3/2 holds: over a tenfold load the number changes by a twelfth.

**The factor** 1.45 of Biboulet and Houpert is that of thick oil at high pressure; at low speed
numbers it is a fifth larger.

**The domain** counts more than the mesh: oil upstream of the grid brings up to a quarter of the
moment, and is added by an integral.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import tehl

LOADS, SPEEDS = (5.0, 15.0, 50.0), (2.5, 10.0)
PUBLISHED = 1.45
"""T* M^(3/2) of elastic films: Biboulet and Houpert, Proc. IMechE Part J 224 (2010)."""


def number(load: float, speed: float) -> tuple[float, float]:
    """Return T* M^(3/2) at Moes numbers M and L, and the part by the oil upstream of the grid."""
    problem = tehl.ContactProblem(
        contact={"type": "line", "radius": "10 mm", "moes_load": load, "moes_speed": speed},
        surface_1={"material": "steel"},
        surface_2={"material": "steel"},
        lubricant="mineral-oil",
    )
    found = tehl.solve(problem).rolling
    return found.T * load**1.5, found.tail_share


def main() -> dict[tuple[float, float], float]:
    """Return T* M^(3/2) over M and L."""
    table = {}
    for speed in SPEEDS:
        for load in LOADS:
            table[load, speed], tail = number(load, speed)
            print(
                f"M = {load:3g}  L = {speed:4g}  T* M^(3/2) = {table[load, speed]:.3f}"
                f"   {100 * tail:3.0f} % upstream of the grid"
            )
    return table


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    table = main()
    figure, axes = plt.subplots(layout="constrained")
    for speed in SPEEDS:
        axes.semilogx(LOADS, [table[load, speed] for load in LOADS], "o-", label=f"L = {speed:g}")
    axes.axhline(PUBLISHED, color="gray", linestyle="dashed", label="published, 1.45")
    axes.set(xlabel="M", ylabel="T* M^(3/2)", title="Rolling friction of line contacts")
    axes.legend()
    figure.savefig(folder / "line_rolling.png", dpi=100)
