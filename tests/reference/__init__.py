"""Cited numbers, each with its source, and the contacts they belong to."""

import tomllib
from pathlib import Path
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.options import Domain
from tehl.estimate.film_formulas import expected_film
from tehl.estimate.scaling import ScaledProblem

DOMAIN = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
"""The domain of most published films, in Hertz half-widths."""
CLOSE = Domain(x=(-2.5, 1.5), y=(-2.0, 2.0))
"""A domain close to the contact, for short waves on 513 nodes; theory takes the film as it is."""


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
    angle: float = 0.0,
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
    angle : float
        Of the entrainment to the axis of R_x [rad].
    """
    slope, saturation = density
    return ContactProblem.model_validate(
        {
            "title": f"M = {load:g}, L = {speed:g}, radius_y/radius_x = {radius_ratio:g}",
            "contact": {
                "radius_x": 0.02,
                "radius_y": 0.02 * radius_ratio,
                "entrainment_angle": angle,
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


def wavy_contact(
    load: float, speed: float, *, amplitude: float, wavelength: float, angle: float
) -> ContactProblem:
    """Return the contact of the reference films with a wave that stands on surface 2.

    Parameters
    ----------
    load, speed : float
        Moes numbers [-].
    amplitude, wavelength : float
        In a^2/R and in a [-].
    angle : float
        Zero is transverse [degree].
    """
    smooth = moes_contact(load, speed)
    width = smooth.hertz.half_width_x
    wave = {
        "type": "wave",
        "amplitude": amplitude * width**2 / smooth.radius_x,
        "wavelength": wavelength * width,
        "angle": f"{angle} deg",
    }
    surface = {"material": "steel", "roughness": wave}
    title = f"M = {load:g}, L = {speed:g}, wave of {wavelength:g} a at {angle:g} degrees"
    tables = smooth.model_dump(mode="json") | {"surface_2": surface, "title": title}
    return ContactProblem.model_validate(tables)


def touching_contact(
    load: float,
    speed: float,
    ratio: float,
    *,
    steep: float = 1e-2,
    dense: float = 0.05,
    radius_ratio: float = 1.0,
) -> ContactProblem:
    """Return a `moes_contact` with the asperities of Greenwood and Tripp.

    Parameters
    ----------
    load, speed, radius_ratio : float
        Those of the smooth contact.
    ratio : float
        Its film by formula over sigma.
    steep, dense : float
        sigma/beta and eta beta sigma.
    """
    case = moes_contact(load, speed, radius_ratio=radius_ratio)
    sigma = expected_film(ScaledProblem.of(case)) / ratio
    beta = sigma / steep
    asperities = {
        "model": "greenwood-tripp",
        "rms": sigma,
        "summit_radius": beta,
        "summit_density": dense / beta / sigma,
    }
    tables = case.model_dump(exclude_none=True) | {"asperities": asperities}
    return ContactProblem.model_validate(tables)


def heated_contact(
    slide_roll_ratio: float = 0.5,
    *,
    reynolds: str | None = "generalised",
    shear: dict[str, Any] | None = None,
    solids: tuple[str, str] | None = None,
    sources: str = "line",
    layers: int = 9,
    **contact: float,
) -> ContactProblem:
    """Return the contact of the heated reference films.

    Parameters
    ----------
    slide_roll_ratio : float
        (u_1 - u_2) / u_m [-].
    reynolds : str or None
        Form of the Reynolds equation; None leaves the heat out.
    shear : dict
        Table of the shear law; Newtonian if left out.
    solids : (str, str)
        Names of materials; the solid of the reference if left out.
    sources : {"line", "auto", "full"}
        How the solids conduct.
    layers : int
        Nodes across the film.
    **contact : float
        Keys of the contact table that replace those of the reference.
    """
    given = read("thermal")
    case, solid, oil = given["contact"], given["solid"], given["oil"]
    same = solid | {"young_modulus": case["reduced_modulus"], "poisson_ratio": 0.0}
    first, second = solids or (same, same)
    loaded = {"load", "hertz_pressure", "moes_load"} & contact.keys()
    return ContactProblem.model_validate(
        {
            "title": f"heated, SRR = {slide_roll_ratio:g}",
            "contact": {
                "radius": case["radius"],
                "entrainment_speed": case["entrainment_speed"],
                "slide_roll_ratio": slide_roll_ratio,
            }
            | ({} if loaded else {"hertz_pressure": case["hertz_pressure"]})
            | contact,
            "surface_1": {"material": first},
            "surface_2": {"material": second},
            "lubricant": {
                "viscosity": {
                    "law": "roelands",
                    "eta_0": oil["eta_0"],
                    "alpha": oil["alpha"],
                    "gamma": oil["gamma"],
                    "reference_temperature": case["temperature"],
                },
                "density": {
                    "law": "dowson-higginson",
                    "rho_0": oil["rho_0"],
                    "slope": oil["density_slope"],
                    "saturation": oil["density_saturation"],
                    "beta": oil["beta"],
                    "form": "additive",
                    "reference_temperature": case["temperature"],
                },
                "shear": shear or {"law": "newtonian"},
                "conductivity": oil["conductivity"],
                "heat_capacity": oil["heat_capacity"],
            },
            "thermal": None
            if reynolds is None
            else {"reynolds": reynolds, "sources": sources, "layers": layers},
        }
    )


def heated_numbers(run: Result) -> dict[str, float]:
    """Return what is compared of a heated film, by its keys in the reference.

    The friction is over all nodes under pressure, as the reference has it.
    """
    temperature, shear, wet = run.temperature, run.shear, run.scaled.pressure > 0
    assert temperature is not None
    assert shear is not None
    area = (run.x[1] - run.x[0]) * (run.y[1] - run.y[0]) / run.scales.load
    return {
        "h_central": run.film_scaled.central,
        "h_minimum": run.film_scaled.minimum,
        "p_central": run.scaled.at_origin(run.scaled.pressure),
        "mid_film_rise": temperature.mid_film_rise_central,
        "traction_surface_1": float(area * shear.surface_1[wet].sum()),
        "traction_mid_film": float(area * shear.mid_film[wet].sum()),
    }
