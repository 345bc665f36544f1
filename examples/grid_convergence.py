"""How the error falls with the grid.

The scheme is of second order: halving the mesh width divides the error of the film by four. Four
grids show it for M = 20, L = 10. The last three give the order and, by Richardson extrapolation,
the film on an infinitely fine grid. `tehl solve --certify` does the same, and adds a run on a
larger domain.

Each grid is iterated to a tight tolerance (`accuracy = "tight"`), so that only the grid differs.
"""

import math
import sys
from functools import cache
from pathlib import Path

from matplotlib.figure import Figure

import tehl

GRIDS = (33, 65, 129, 257)


@cache
def film(points: int) -> float:
    """Return the central film H on one grid [-]."""
    problem = tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", moes_load=20.0, moes_speed=10.0),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
    )
    domain = tehl.Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
    options = tehl.Options(points=points, domain=domain, accuracy="tight", tolerance=1e-5)
    return tehl.solve(problem, options).film_scaled.central


def main() -> dict[str, float]:
    """Return the order seen on the last three grids and the extrapolated film [-]."""
    coarse, middle, fine = (film(points) for points in GRIDS[-3:])
    order = math.log2((middle - coarse) / (fine - middle))
    limit = fine + (fine - middle) / 3
    return {"order": order, "H on the finest grid": fine, "H at the limit": limit}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found = main()
    for name, value in found.items():
        print(f"{name:<24}{value:.5g}")
    width = [6.0 / (points - 1) for points in GRIDS]
    error = [abs(film(points) / found["H at the limit"] - 1) for points in GRIDS]
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axes = figure.add_subplot(xlabel="mesh width", ylabel="relative error of central film")
    axes.loglog(width, error, "o-", label="computed")
    axes.loglog(width, [error[1] * (w / width[1]) ** 2 for w in width], "--", label="slope 2")
    axes.legend(title="M = 20, L = 10")
    figure.savefig(folder / "order.png", dpi=100)
