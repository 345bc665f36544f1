"""Contacts of a ball bearing from catalogue numbers, as a list.

A deep-groove ball bearing 6206 has 9 balls of 9.525 mm on a pitch circle of 46 mm; grooves with a
radius of 0.52 of the ball. The ball that carries most takes 5 F/Z of a radial load F (Stribeck). At
n revolutions per minute of the inner ring both raceways entrain the oil with pi n d_m (1 - g^2) / 2
a minute, g the ball over the pitch diameter.

Each line of the list is one raceway at one load and speed. The films, their bars, lambda and the
load on asperities come back beside it, and as an Excel sheet with the command ``tehl contacts``.
"""

import math
import sys
from pathlib import Path

import pandas as pd

import tehl
from tehl import plots

BALL, PITCH, BALLS = 9.525e-3, 46e-3, 9
GROOVE = -0.52 * BALL
"""Negative across the rolling direction: the ball lies in it."""
TEMPLATE = {
    "title": "6206, ISO VG 68 at 60 degC",
    "contact": {"load": 100.0, "entrainment_speed": 1.0},
    "surface_1": {"material": "steel", "radius": BALL / 2, "rms_roughness": "0.02 um"},
    "surface_2": {"material": "steel", "radius_x": 0.01, "radius_y": GROOVE},
    "lubricant": {"name": "iso-vg-68", "temperature": "60 degC"},
}


def rows(forces: list[float], speeds: list[float]) -> pd.DataFrame:
    """Return the contacts of both raceways for radial loads [N] and speeds [rpm]."""
    ratio = BALL / PITCH
    found = []
    for force in forces:
        for speed in speeds:
            entrainment = math.pi * speed / 60 * PITCH / 2 * (1 - ratio**2)
            for ring, radius in (("inner", PITCH - BALL), ("outer", -PITCH - BALL)):
                found.append(
                    {
                        "ring": ring,
                        "radial load": f"{force / 1e3:g} kN",
                        "load [N]": 5 * force / BALLS,
                        "u_m [m/s]": entrainment,
                        "R_x 2 [mm]": 1e3 * radius / 2,
                        "R_y 2 [mm]": 1e3 * GROOVE,
                        "Sq 2 [um]": 0.06,
                    }
                )
    return pd.DataFrame(found)


def main() -> pd.DataFrame:
    """Return the answers for one load and speed."""
    template = tehl.ContactProblem.model_validate(TEMPLATE)
    return tehl.solve_contacts(rows([500.0], [3000.0]), template)


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    contacts = rows([250.0, 500.0, 1e3], [3000.0, 6000.0, 9000.0])
    films = tehl.solve_contacts(contacts, tehl.ContactProblem.model_validate(TEMPLATE), jobs=2)
    shown = ["ring", "radial load", "u_m [m/s]", "Hertz pressure [GPa]", "minimum film [nm]"]
    print(films[[*shown, "lambda", "regime", "status"]].to_string())
    films.to_csv(folder / "bearing_list.csv", index=False)
    picture = plots.curves(films, "u_m [m/s]", "minimum film [nm]", "radial load", "ring")
    picture.savefig(folder / "minimum_film.png", dpi=100)
