"""Mixed lubrication: a Stribeck curve, from dry to full film.

Asperities finer than the grid carry part of the load where the film is thin. Their pressure follows
from the distance of the mean planes (Greenwood and Tripp), and flows through the gap are hindered
(Patir and Cheng).

**At low speed** asperities carry most of the load, and friction tends to their coefficient.

**At high speed** the film separates the surfaces, and friction is that of the oil.

**Between both** friction has its minimum: asperities no longer touch much, and the film is not yet
sheared as much as its stress allows.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SPEEDS = (1e-4, 0.003, 0.03, 0.1, 0.3, 1.0, 5.0)
BOUNDARY = 0.1
"""Friction coefficient of the asperities."""


@cache
def solved(speed: float, points: int = 129) -> tehl.Result:
    """Return the contact of a ball and a ground disc at an entrainment speed [m/s]."""
    problem = tehl.ContactProblem(
        title=f"Ground disc at {speed:g} m/s",
        contact=tehl.Contact(load=80.0, entrainment_speed=speed, slide_roll_ratio=0.1),
        surface_1=tehl.Surface(material="steel", radius=0.02, rms_roughness=0.05e-6),
        surface_2=tehl.Surface(material="steel", radius=float("inf"), rms_roughness=0.2e-6),
        lubricant={"name": "mineral-oil", "shear": {"law": "eyring", "stress": 5e6}},
        asperities={
            "model": "greenwood-tripp",
            "summit_radius": 10e-6,
            "summit_density": 2e10,
            "friction": BOUNDARY,
        },
    )
    return tehl.solve(problem, tehl.Options(points=points))


def main() -> dict[float, tuple[float, float, float]]:
    """Return, by speed: share of the load on asperities, friction, that of the film."""
    table = {}
    for speed in SPEEDS:
        shared = solved(speed).load_sharing
        table[speed] = (shared.share, shared.friction, shared.friction_film)
    return table


def draw(folder: Path) -> None:
    """Draw the pressure of the asperities, where they carry much."""
    picture = plots.asperity_map(solved(SPEEDS[1]))
    picture.savefig(folder / "mixed.png", dpi=100)


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    out.mkdir(parents=True, exist_ok=True)
    for speed, (share, friction, film) in main().items():
        print(
            f"{speed:>7g} m/s: asperities carry {100 * share:5.1f} %, friction {friction:.4f}, "
            f"{film:.4f} of the film"
        )
    draw(out)
