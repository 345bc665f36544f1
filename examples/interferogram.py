"""Synthetic interferograms.

Film thickness is measured through a glass disc with a semi-reflecting chromium layer: light
reflected by the layer and by the steel ball interferes, and colours or fringes give the film. The
package draws the image that such a rig would show, for comparison with a photograph.

Three speeds at one load: the central film grows with a power of the speed, in film formulas 0.67
or 0.68.
"""

import math
import sys
from functools import cache
from pathlib import Path

import tehl
from tehl import plots

SPEEDS = (0.2, 0.4, 0.8)


@cache
def solved(speed: float) -> tehl.Result:
    """Return the film at one speed [m/s]."""
    problem = tehl.ContactProblem(
        title=f"Steel ball on glass disc, {speed:g} m/s",
        contact=tehl.Contact(load="20 N", entrainment_speed=speed),
        surface_1=tehl.Surface(material="steel", radius="9.525 mm"),
        surface_2=tehl.Surface(material="glass", radius="inf"),
        lubricant="iso-vg-68",
    )
    return tehl.solve(problem)


def main() -> float:
    """Return the power with which the central film grows with the speed [-]."""
    slow, fast = SPEEDS[0], SPEEDS[-1]
    films = solved(fast).film.central / solved(slow).film.central
    return math.log(films) / math.log(fast / slow)


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for speed in SPEEDS:
        print(f"{speed:g} m/s: central film {solved(speed).film.central * 1e9:.1f} nm")
        picture = plots.interferogram(solved(speed), plots.Optics(light="white"))
        picture.savefig(folder / f"white_{speed:g}.png", dpi=80)
    picture = plots.interferogram(solved(SPEEDS[-1]), plots.Optics(light="monochromatic"))
    picture.savefig(folder / "monochromatic.png", dpi=80)
    print(f"film ~ speed^{main():.3f}")
