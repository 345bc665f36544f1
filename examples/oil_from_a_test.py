"""The oil from a test: alpha and Eyring stress from films and tractions.

A ball of 3/4 inch on a steel disc, at 20 N and 40 degC: films over the speed without sliding, and
tractions at 2 m/s over the slide-to-roll ratio, heated. The measured values are those that the
solver gives for an oil with 22 1/GPa and 5 MPa, with noise of 3 % and 0.0005: the fit must find
the oil again, within its intervals.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

import tehl
from tehl import plots

SPEEDS, SLIDES = (0.4, 0.8, 1.5, 3.0), (0.01, 0.03, 0.1, 0.3)


def rig(alpha: float, stress: float, speed: float = 1.0, slide: float = 0.0) -> dict:
    """Return the tables of a case of the rig with an oil."""
    return {
        "title": "ball on disc",
        "contact": {
            "radius": "9.525 mm",
            "load": "20 N",
            "entrainment_speed": speed,
            "slide_roll_ratio": slide,
        },
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "viscosity": {
                "law": "roelands",
                "eta_0": "0.04 Pa s",
                "alpha": alpha,
                "gamma": "0.042 1/K",
            },
            "density": {"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
            "shear": {"law": "eyring", "stress": stress},
            "conductivity": "0.14 W/m/K",
            "heat_capacity": "2000 J/kg/K",
        },
        "thermal": {},
        "numerics": {"points": 65, "extrapolate": True},
    }


def measured() -> pd.DataFrame:
    """Return the test of the true oil, with noise."""
    rng, rows = np.random.default_rng(4), []
    for speed, slide in [(u, 0.0) for u in SPEEDS] + [(2.0, s) for s in SLIDES]:
        tables = rig(22e-9, 5e6, speed, slide)
        options = tehl.Options(**tables.pop("numerics"))
        result = tehl.solve(tehl.ContactProblem.model_validate(tables), options)
        film = 1e9 * result.film.central * (1.0 + 0.03 * rng.standard_normal())
        traction = abs(result.traction.mid_film) + 0.0005 * rng.standard_normal()
        row = {"u_m [m/s]": speed, "SRR": slide}
        rows.append(row | ({"traction": traction} if slide else {"film [nm]": film}))
    return pd.DataFrame(rows)


def main() -> tehl.OilFit:
    """Return the fit, from another oil on."""
    return tehl.fit(measured(), rig(18e-9, 8e6))


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found = main()
    print(found.text())
    found.save(folder / "oil.toml")
    plots.oil_fit(found.table).savefig(folder / "fit.png", dpi=100)
