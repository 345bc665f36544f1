"""Heat in the inlet: how it thins a fast film in pure rolling.

In pure rolling, too, oil flows back in the inlet and is sheared. At high speed this heats the oil,
and since the inlet determines the film, it is thinner than without heat. Three formulas give the
factor as a function of the thermal loading parameter eta_0 b u_m^2 / k (b is the fall of ln eta
with temperature, k the conductivity of the oil).

Each speed is solved with heat and without. The computed reduction is a quarter (1 m/s) to two
thirds (16 m/s) of that of the formulas. The formulas are fits with an accuracy of 10 to 15 % in the
film, which they keep up to 8 m/s.
"""

import sys
from functools import cache
from pathlib import Path

from matplotlib.figure import Figure

import tehl
from tehl.post.thermal_effect import ThermalEffect, isothermal_reference, thermal_effect

SPEEDS = (1.0, 2.0, 4.0, 8.0, 16.0)


def problem(speed: float) -> tehl.ContactProblem:
    """Return the contact at one speed [m/s], rolling."""
    return tehl.ContactProblem(
        contact=tehl.Contact(radius="20 mm", hertz_pressure="1 GPa", entrainment_speed=speed),
        surface_1=tehl.Surface(material="steel"),
        surface_2=tehl.Surface(material="steel"),
        lubricant="mineral-oil",
        thermal={},
    )


@cache
def effect(speed: float) -> ThermalEffect:
    """Return the effect of heat on the film at one speed [m/s]."""
    case, options = problem(speed), tehl.Options(points=129)
    return thermal_effect(
        tehl.solve(case, options), tehl.solve(isothermal_reference(case), options)
    )


def main() -> dict[float, dict[str, float]]:
    """Return, for each speed [m/s], the film over the isothermal one, computed and by formula."""
    return {
        speed: {"computed": effect(speed).central}
        | {one.formula: one.factor for one in effect(speed).inlet_factors}
        for speed in SPEEDS
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    rows = main()
    loads = [problem(speed).thermal_loading for speed in SPEEDS]
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.add_subplot(xlabel="entrainment speed [m/s]", ylabel="film / isothermal film")
    print(f"{'speed [m/s]':<18}", *(f"{speed:7g}" for speed in SPEEDS))
    print(f"{'thermal loading':<18}", *(f"{load:7.3f}" for load in loads))
    for name in rows[SPEEDS[0]]:
        values = [rows[speed][name] for speed in SPEEDS]
        print(f"{name:<18}", *(f"{value:7.4f}" for value in values))
        axes.plot(SPEEDS, values, "ko-" if name == "computed" else "--", label=name)
    axes.set(xscale="log", ylim=(0.6, 1.02))
    axes.set_xticks(SPEEDS, [f"{speed:g}" for speed in SPEEDS])
    axes.set_xticks([], minor=True)
    axes.legend()
    axes.grid(lw=0.3)
    figure.savefig(folder / "inlet_heating.png", dpi=100)
