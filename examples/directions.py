"""Entrainment in any direction: a turned ellipse, and surfaces that spin.

In hypoid gears and at the ribs of tapered rollers oil enters the contact along neither axis of the
ellipse, and the surfaces turn about its normal. x is the direction of the entrainment at the
centre; the ellipse turns, and the spin makes the surfaces slower on the left than on the right.

The smallest film moves to one side lobe: at an angle to the one where the rim runs along the flow,
with spin to the slower side. The central film changes little: by the square of a small spin.
"""

import math
import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SPINS = (0.0, 0.25, 0.5)
"""Of the mean motion, over the entrainment speed over a_x."""


def contact(angle: float = 0.0, spin: float = 0.0) -> tehl.ContactProblem:
    """Return an ellipse at an angle [deg], with a spin [1/s] of both surfaces."""
    steel = tehl.Surface(material="steel")
    return tehl.ContactProblem(
        contact=tehl.Contact(
            radius_x="10 mm",
            radius_y="28 mm",
            load="60 N",
            entrainment_speed="1 m/s",
            entrainment_angle=math.radians(angle),
            spin_1=spin,
            spin_2=spin,
        ),
        surface_1=steel,
        surface_2=steel,
        lubricant=tehl.oil("mineral-oil"),
    )


@cache
def at_angle(angle: float) -> tehl.Result:
    """Return the film of an ellipse at an angle [deg]."""
    return tehl.solve(contact(angle), tehl.Options(points=129))


@cache
def spinning(ratio: float) -> tehl.Result:
    """Return the film with a spin over u_m/a_x, entrained along the short axis."""
    plain = contact()
    omega = ratio * plain.entrainment_speed / plain.hertz.half_width_x
    return tehl.solve(contact(spin=omega), tehl.Options(points=129))


def main() -> dict[str, list[float]]:
    """Return central and smallest films [nm] at 0, 45 and 90 degrees, and with more and more spin.

    Of the smallest ones the place y over the half-width too, positive on the left.
    """
    found = {}
    for name, results in {
        "angle": [at_angle(angle) for angle in (0.0, 45.0, 90.0)],
        "spin": [spinning(ratio) for ratio in SPINS],
    }.items():
        found[f"{name}: central film"] = [1e9 * one.film.central for one in results]
        found[f"{name}: smallest film"] = [1e9 * one.film.minimum for one in results]
        found[f"{name}: its place Y"] = [one.film_scaled.minimum_at[1] for one in results]
    return found


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, values in main().items():
        print(f"{name:<22}" + "".join(f"{value:10.4g}" for value in values))
    plots.film_map(at_angle(45.0)).savefig(folder / "angle.png", dpi=100)
    plots.film_map(spinning(SPINS[-1])).savefig(folder / "spin.png", dpi=100)
