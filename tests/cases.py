"""Tables of cases shared by the tests of the front half: what a TOML file would parse to."""

from typing import Any

from tehl.api.problem import ContactProblem

Tables = dict[str, Any]


def ball_tables(**changes: Any) -> Tables:
    """Return the tables of a steel ball on a steel disc; ``changes`` replace whole tables."""
    tables: Tables = {
        "title": "ball",
        "contact": {"radius": "20 mm", "load": "80 N", "entrainment_speed": "1.5 m/s"},
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "viscosity": {"law": "roelands", "eta_0": "0.04 Pa s", "alpha": "22 1/GPa"},
            "density": {"law": "dowson-higginson", "rho_0": "890 kg/m^3"},
        },
    }
    return tables | changes


def moes_problem(load: float, speed: float, **radii: float) -> ContactProblem:
    """Return a contact with the given M and L, whose G = 4522 is that of many tables."""
    rigid = {"young_modulus": 1e11, "poisson_ratio": 0.0}
    return ContactProblem.model_validate(
        {
            "contact": {"moes_load": load, "moes_speed": speed} | (radii or {"radius": 0.02}),
            "surface_1": {"material": rigid},
            "surface_2": {"material": rigid},
            "lubricant": {
                "viscosity": {"law": "barus", "eta_0": 0.04, "alpha": 4522e-11},
                "density": {"law": "constant", "rho_0": 850.0},
            },
        }
    )
