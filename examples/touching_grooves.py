"""Contact through a boundary film: grooved surfaces at falling speed.

Grooves along the motion squeeze the oil out between the crests, which touch where it would leave
less than the boundary film. Two pressures share the load: that of the oil, which flows everywhere,
and that of the contact, which takes what the oil does not carry.

**At high speed** the film is thicker than the boundary film everywhere: nothing touches.

**At low speed** the crests carry the load as in a dry contact.

A share of the load is known where the grid resolves the patches of contact, 8 cells or more, and
the film of the oil.
"""

import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SPEEDS = (0.02, 0.2, 2.0)


@cache
def solved(speed: float, points: int = 129) -> tehl.Result:
    """Return a ball with grooves on a disc at an entrainment speed [m/s]."""
    problem = tehl.ContactProblem(
        title=f"Grooves at {speed:g} m/s",
        contact=tehl.Contact(load=10.0, entrainment_speed=speed),
        surface_1=tehl.Surface(
            material="steel",
            radius=0.02,
            roughness={
                "type": "wave",
                "amplitude": 0.3e-6,
                "wavelength": 120e-6,
                "angle": "90 deg",
                "phase": "180 deg",  # a groove in the middle
            },
        ),
        surface_2=tehl.Surface(material="steel", radius=float("inf")),
        lubricant="mineral-oil",
        contact_film={"thickness": 50e-9},
    )
    # tight: the oil is balanced to the last digits
    return tehl.solve(problem, tehl.Options(points=points, accuracy="tight"))


def main() -> dict[float, tuple[float, float, float, float]]:
    """Return, by speed: load where surfaces touch, its bar, area over Hertz, oil balance [-]."""
    table = {}
    for speed in SPEEDS:
        shared = solved(speed).touching
        table[speed] = (shared.share, shared.share_error, shared.area_part, shared.balance)
    return table


def draw(folder: Path) -> None:
    """Draw where the surfaces touch."""
    picture = plots.contact_map(solved(SPEEDS[1]))
    picture.savefig(folder / "touching_grooves.png", dpi=100)


if __name__ == "__main__":
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    out.mkdir(parents=True, exist_ok=True)
    for speed, (share, bar, area, balance) in main().items():
        print(
            f"{speed:>6g} m/s: {100 * share:5.1f} +- {100 * bar:.0f} % of the load on contact, "
            f"on {100 * area:5.1f} % of the Hertz area; mass-balance error {balance:.0e}"
        )
    draw(out)
