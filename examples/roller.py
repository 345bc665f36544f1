"""A roller with crowned ends, straight and tilted: film and pressure along it.

The crowns keep the pressure at the ends low. A tilt of a thousandth of a radian moves the load to
one side. Where the moment of the load is stated in its place, the tilt follows.

**The middle** has the film of the line contact under the mean load.

**The thinnest film** is near the ends, and on the loaded side of a tilted roller.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tehl

TILTS = (0.0, 1e-3)


def roller(points: tuple[int, int], **stated: float) -> tehl.Result:
    """Return the film of a roller of 10 mm under 5 kN with a tilt [rad], or a moment [N m]."""
    problem = tehl.ContactProblem(
        contact={
            "type": "roller",
            "radius": "8 mm",
            "length": "10 mm",
            "load": "5 kN",
            "entrainment_speed": "4 m/s",
            "profile": {"shape": "crown", "radius": "0.4 m", "straight": "4 mm"},
            **stated,
        },
        surface_1={"material": "steel"},
        surface_2={"material": "steel"},
        lubricant="mineral-oil",
    )
    return tehl.solve(problem, tehl.Options(points=points))


def main(points: tuple[int, int] = (257, 129)) -> dict[float, tehl.Result]:
    """Return the films over the tilt."""
    found = {tilt: roller(points, tilt=tilt) for tilt in TILTS}
    for tilt, result in found.items():
        load = result.pressure.sum(axis=1)
        half = load.size // 2
        print(
            f"tilt {1e3 * tilt:.1f} mrad: central film {1e9 * result.film.central:.0f} nm, minimum "
            f"{1e9 * result.film.minimum:.0f} nm, {load[:half].sum() / load.sum():.0%} of the load "
            "on the side where the gap closes"
        )
    moment = found[TILTS[-1]].rolling.tilting
    half = roller(points, tilting_moment=0.5 * moment)
    print(f"half its moment, {0.5 * moment:.2f} N m: tilt {1e3 * half.rolling.tilt:.2f} mrad")
    return found | {half.rolling.tilt: half}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found = main()
    figure, (films, pressures) = plt.subplots(2, sharex=True, layout="constrained")
    for tilt, result in found.items():
        y, middle = 1e3 * result.y, int(np.abs(result.x).argmin())
        film = result.scaled.film.min(axis=1) * result.scales.film_thickness
        films.plot(y, 1e9 * film, label=f"{1e3 * tilt:.2g} mrad")
        pressures.plot(y, 1e-9 * result.pressure[:, middle])
    films.set(ylabel="thinnest film [nm]", ylim=(400, 1000), title="A roller along its axis")
    films.legend(title="tilt")
    pressures.set(xlabel="y [mm]", ylabel="pressure at x = 0 [GPa]")
    figure.savefig(folder / "roller.png", dpi=100)
