"""Traction drive: what spin costs.

A roller drives a disc through an oil film. At the contact of a variable drive the two surfaces also
turn against each other about the normal: they spin.

**Without spin** a creep of one per cent brings the oil near to the limit of its shear stress.

**With spin** the stress at each place points against the local sliding, which turns around a pole.
Only with more creep does the pole leave the contact, and the force comes near to the limit again;
meanwhile the drilling moment turns power into heat.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tehl
from tehl import plots

CREEPS, SPINS = (0.002, 0.01, 0.05), (0.0, 1000.0)
"""Slide-roll ratios; angular velocity of each surface, in opposite directions [rpm]."""


def solved(creep: float, spin: float) -> tehl.Result:
    """Return the film at a slide-roll ratio and a spin [rpm]."""
    problem = tehl.ContactProblem(
        contact={
            "radius": "30 mm",
            "hertz_pressure": "1 GPa",
            "entrainment_speed": "8 m/s",
            "slide_roll_ratio": creep,
            "spin_1": f"{spin} rpm",
            "spin_2": f"{-spin} rpm",
        },
        surface_1={"material": "steel"},
        surface_2={"material": "steel"},
        lubricant={
            "viscosity": {"law": "roelands", "eta_0": 0.012, "alpha": 22e-9, "gamma": 0.032},
            "density": {"law": "dowson-higginson", "rho_0": 900.0},
            "shear": {"law": "limiting", "slope": 0.09, "stress": "2 MPa"},
            "conductivity": "0.11 W/m/K",
            "heat_capacity": "1900 J/kg/K",
        },
        thermal={"temperature": "60 degC"},
    )
    return tehl.solve(problem, tehl.Options(points=129))


def main() -> dict[tuple[float, float], tuple[float, float, float]]:
    """Return traction, drilling moment over its limit by Coulomb, and loss [W]."""
    table = {}
    for spin in SPINS:
        for creep in CREEPS:
            result = solved(creep, spin)
            found = result.traction
            limit = 3.0 * np.pi / 16.0 * 0.09 * result.load * result.scales.half_width_x
            moment = abs(found.drilling_moment or 0.0) / limit
            table[creep, spin] = abs(found.mid_film), moment, found.friction_power
            print(
                f"creep {100 * creep:4.1f} %  spin {spin:5.0f} rpm  traction {-found.mid_film:.4f}"
                f"  moment {moment:.2f} of its limit  loss {found.friction_power:5.2f} W"
            )
    return table


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    table = main()
    figure, axes = plt.subplots(layout="constrained")
    for spin in SPINS:
        force = [table[creep, spin][0] for creep in CREEPS]
        axes.semilogx([100 * creep for creep in CREEPS], force, "o-", label=f"spin {spin:g} rpm")
    axes.set(xlabel="creep [%]", ylabel="traction coefficient", title="Traction drive")
    axes.legend()
    figure.savefig(folder / "traction.png", dpi=100)
    plots.shear_stress_map(solved(CREEPS[1], SPINS[1])).savefig(folder / "stress.png", dpi=100)
