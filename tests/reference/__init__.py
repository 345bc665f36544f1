"""Cited numbers, each with its source, and the contacts they belong to."""

import tomllib
from pathlib import Path
from typing import Any

from tehl.options import Domain
from tehl.problem import ContactProblem

DOMAIN = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
"""The domain of most published films, in Hertz half-widths."""


def read(name: str) -> dict[str, Any]:
    """Return the tables of ``tests/reference/<name>.toml``."""
    path = Path(__file__).with_name(f"{name}.toml")
    return tomllib.loads(path.read_text(encoding="utf-8"))


def moes_contact(
    load: float,
    speed: float,
    *,
    radius_ratio: float = 1.0,
    density: tuple[float, float] = (0.6e-9, 1.7e-9),
) -> ContactProblem:
    """Return steel on steel at M = ``load``, L = ``speed`` with the oil of the reference films.

    Parameters
    ----------
    load, speed : float
        Moes numbers [-].
    radius_ratio : float
        R_y / R_x; R_x is 20 mm.
    density : (float, float)
        Slope and saturation of the Dowson-Higginson law [1/Pa].
    """
    slope, saturation = density
    return ContactProblem.model_validate(
        {
            "title": f"M = {load:g}, L = {speed:g}, radius_y/radius_x = {radius_ratio:g}",
            "contact": {
                "radius_x": 0.02,
                "radius_y": 0.02 * radius_ratio,
                "moes_load": load,
                "moes_speed": speed,
            },
            "surface_1": {"material": "steel"},
            "surface_2": {"material": "steel"},
            "lubricant": {
                "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
                "density": {
                    "law": "dowson-higginson",
                    "rho_0": 890.0,
                    "slope": slope,
                    "saturation": saturation,
                },
            },
        }
    )
