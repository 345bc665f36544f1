"""A tooth of a spur gear passes its mesh: film and temperature along the path of contact.

Radius, entrainment, sliding and load of the FZG type C gear (module 4.5 mm, 16 and 24 teeth,
183 N m, 8.3 m/s) follow from its geometry (`tehl.studies.gear.SpurGears`). The transient film is
compared with steady ones at places along the path, on the same number of nodes.

**The film follows** the steady ones within some per cent, as oil passes the contact in a twentieth
of the mesh. Where a second pair of teeth takes a part of the load or leaves it, the bodies part or
approach, and the film is thicker or thinner by a sixth for that time.

**The friction** changes its sign at the pitch point, where the surfaces roll, and the film is as
cold as the oil there.
"""

import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tehl
from tehl.studies.gear import SpurGears

GEARS = SpurGears(
    module=4.5e-3,
    teeth=(16, 24),
    width=14e-3,
    torque=183.4,
    speed=2.0 * math.pi * 36.1,
    shift=(0.182, 0.172),
    centres=91.5e-3,
)
OIL = {
    "viscosity": {
        "law": "roelands",
        "eta_0": "9.5 mPa s",
        "alpha": "15 1/GPa",
        "gamma": "0.03 1/K",
        "reference_temperature": "90 degC",
    },
    "density": {"law": "dowson-higginson", "rho_0": "840 kg/m^3"},
    "shear": {"law": "eyring", "stress": "6 MPa"},
    "conductivity": "0.13 W/m/K",
    "heat_capacity": "2200 J/kg/K",
}


def case(**tables: object) -> tehl.ContactProblem:
    """Return a contact of the teeth."""
    steel, thermal = {"material": "steel"}, {"temperature": "90 degC"}
    return tehl.ContactProblem(
        surface_1=steel, surface_2=steel, lubricant=OIL, thermal=thermal, **tables
    )


def meshing(points: int, stride: int = 2) -> tuple[np.ndarray, tehl.TransientResult]:
    """Return the places of the contact from the pitch point [m], and the run of a tooth."""
    tables = GEARS.tables()
    tables["transient"] |= {"frames": 0, "stride": stride}
    run = tehl.solve_transient(case(**tables), tehl.Options(points=points))
    return GEARS.ends[0] + GEARS.speed * GEARS.base_radii[0] * run.history.time, run


def steady(place: float, points: int) -> tuple[float, float, float, float]:
    """Return central and minimum film [m], largest rise [K] and friction of a steady contact."""
    options = tehl.Options(points=points, extrapolate=False, wedge_order=2)
    found = tehl.solve(case(contact={"type": "line"} | GEARS.at(place)), options)
    summary = found.summary()
    return (
        found.film.central,
        found.film.minimum,
        summary["temperature"]["film_rise_max_k"],
        summary["traction"]["mid_film"],
    )


def main(count: int = 3, points: int = 257, stride: int = 4) -> dict[str, np.ndarray]:
    """Return places, the values of the run there, and those of steady contacts."""
    way, run = meshing(points, stride)
    history = run.history
    places = np.linspace(*GEARS.ends, count + 2)[1:-1]
    names = ("film_central", "film_minimum", "temperature_rise", "traction")
    moving = np.array([np.interp(places, way, getattr(history, name)) for name in names])
    standing = np.array([steady(place, points) for place in places]).T
    print("place [mm]   film [nm]   steady   rise [K]   steady   friction")
    for k, place in enumerate(places):
        print(
            f"{1e3 * place:10.2f} {1e9 * moving[0, k]:11.1f} {1e9 * standing[0, k]:8.1f}"
            f" {moving[2, k]:10.1f} {standing[2, k]:8.1f} {moving[3, k]:10.4f}"
        )
    return {"place": places, "run": moving, "steady": standing}


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found, (way, run) = main(40, stride=2), meshing(257)
    history, labels = run.history, ("central film [nm]", "largest rise [K]", "friction")
    lines = (1e9 * history.film_central, history.temperature_rise, history.traction)
    figure, panels = plt.subplots(3, 1, sharex=True, figsize=(6, 7), layout="constrained")
    for axes, line, row, label in zip(panels, lines, (0, 2, 3), labels, strict=True):
        scale = 1e9 if row == 0 else 1.0
        axes.plot(1e3 * way, line, label="one tooth")
        axes.plot(1e3 * found["place"], scale * found["steady"][row], ".", label="steady")
        axes.set_ylabel(label)
    panels[0].legend()
    panels[-1].set_xlabel("place from the pitch point [mm]")
    figure.savefig(folder / "gear_mesh.png", dpi=100)
