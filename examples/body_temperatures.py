"""A ball and a disc that their contact warms.

The template `thermal` at 3 m/s, with both bodies cooled by air and oil mist instead of kept at the
temperature of the oil. Their thermal resistances follow from shape and heat transfer coefficient;
the film is solved until each body passes on the heat that enters it.

With more sliding both become warmer, the ball more, as it has less surface. Warm bodies warm the
oil before it enters, and the film is thinner than between bodies of the temperature of the oil. The
traction does not fall with it: the thinner film is sheared faster, and loses its heat more easily.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt

import tehl
from tehl.api.problem import case_from_tables
from tehl.io.templates import template_text
from tehl.post.bodies import bodies

SLIDING = (0.0, 0.3, 1.0)
COOLED = {
    "surface_1": {"body": "ball", "radius": "20 mm", "heat_transfer": "50 W/m^2/K"},
    "surface_2": {
        "body": "disc",
        "track_radius": "40 mm",
        "radius": "50 mm",
        "thickness": "8 mm",
        "heat_transfer": "50 W/m^2/K",
    },
}


def solved(sliding: float, *, cooled: bool) -> tehl.Result:
    """Return the film at a slide-roll ratio, between cooled bodies or those of the oil's warmth."""
    case = tomllib.loads(template_text("thermal"))
    case["contact"] |= {"slide_roll_ratio": sliding, "entrainment_speed": "3 m/s"}
    case["numerics"] = {"points": 97, "extrapolate": True}
    for name, cooling in COOLED.items() if cooled else ():
        case[name]["cooling"] = cooling
    return tehl.solve(*case_from_tables(case))


def main() -> dict[float, dict[str, float]]:
    """Return temperatures [degC], films [nm] and tractions [-] by slide-roll ratio."""
    table = {}
    for sliding in SLIDING:
        warm, cold = solved(sliding, cooled=True), solved(sliding, cooled=False)
        found = bodies(warm)
        table[sliding] = {
            "ball [degC]": found.temperature_1 - 273.15,
            "disc [degC]": found.temperature_2 - 273.15,
            "heat into the ball [W]": found.heat_1,
            "heat into the disc [W]": found.heat_2,
            "central film [nm]": 1e9 * warm.film.central,
            "traction": -warm.traction.mid_film,
            "film, bodies of 40 degC [nm]": 1e9 * cold.film.central,
            "traction, bodies of 40 degC": -cold.traction.mid_film,
        }
    return table


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found = main()
    for sliding, row in found.items():
        print(f"SRR {sliding:g}:", ", ".join(f"{name} {value:.4g}" for name, value in row.items()))
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
    for name in ("ball [degC]", "disc [degC]"):
        left.plot(SLIDING, [row[name] for row in found.values()], "o-", label=name.split()[0])
    left.set(xlabel="slide-roll ratio", ylabel="temperature of the body [°C]")
    for name, label in (
        ("central film [nm]", "warm bodies"),
        ("film, bodies of 40 degC [nm]", "bodies of 40 °C"),
    ):
        right.plot(SLIDING, [row[name] for row in found.values()], "o-", label=label)
    right.set(xlabel="slide-roll ratio", ylabel="central film [nm]", ylim=(0, None))
    for axes in (left, right):
        axes.legend()
    figure.savefig(folder / "body_temperatures.png", dpi=100)
