"""Contact through a boundary film: grooved surfaces at falling speed.

Grooves along the motion squeeze the oil out between the crests, which touch where it would leave
less than the boundary film. Two pressures share the load: that of the oil, which flows everywhere,
and that of the contact, which takes what the oil does not carry.

**At high speed** the film is thicker than the boundary film everywhere: nothing touches.

**At low speed** the crests carry the load as in a dry contact.

A share of the load is stated where the grid resolves the patches of contact: 8 cells or more.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SPEEDS = (0.001, 0.01, 1.0)


@cache
def solved(speed: float, points: int = 65) -> tehl.Result:
    """Return a ball with grooves on a disc at an entrainment speed [m/s]."""
    problem = tehl.ContactProblem(
        title=f"Grooves at {speed:g} m/s",
        contact=tehl.Contact(load=80.0, entrainment_speed=speed),
        surface_1=tehl.Surface(
            material="steel",
            radius=0.02,
            roughness={
                "type": "wave",
                "amplitude": 0.3e-6,
                "wavelength": 300e-6,
                "angle": "90 deg",
                "phase": "180 deg",  # a groove in the middle
            },
        ),
        surface_2=tehl.Surface(material="steel", radius=float("inf")),
        lubricant="mineral-oil",
        contact_film={"thickness": 5e-9},
    )
    return tehl.solve(problem, tehl.Options(points=points))


def main() -> dict[float, tuple[float, float, float]]:
    """Return, by speed: load where surfaces touch [-], their area over Hertz [-], oil balance."""
    table = {}
    for speed in SPEEDS:
        shared = solved(speed).touching
        table[speed] = (shared.share, shared.area_part, shared.balance)
    return table


def draw(folder: Path) -> None:
    """Draw where the surfaces touch."""
    picture = plots.contact_map(solved(SPEEDS[1]))
    picture.savefig(folder / "touching_grooves.png", dpi=100)


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    out.mkdir(parents=True, exist_ok=True)
    for speed, (share, area, balance) in main().items():
        print(
            f"{speed:>6g} m/s: {100 * share:5.1f} % of the load where surfaces touch, on "
            f"{100 * area:5.1f} % of the Hertz area; oil made or lost {balance:.0e}"
        )
    draw(out)
