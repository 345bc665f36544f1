"""Table 1: what the paper states and what the reference parameter sets assume."""

from dataclasses import dataclass
from typing import Any

from tehl.reproduce.printed import printed
from tehl.reproduce.series import parameter_set, parameters, problem_of, series


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """A line of Table 1.

    Attributes
    ----------
    name, printed, set_a, set_b, remark : str
        Cells.
    assumed : bool
        Whether the paper does not print it.
    """

    name: str
    printed: str
    set_a: str
    set_b: str
    remark: str = ""
    assumed: bool = False


def parameter_rows() -> list[Parameter]:
    """Return the lines that are printed, then those that are assumed."""
    solids, oil = parameters()["solids"]["steel"], parameter_set("A")["lubricant"]
    used = {
        "Thermal conductivity of surfaces (W/mK)": solids["conductivity"],
        "Thermal conductivity of lubricant (W/mK)": oil["conductivity"],
        "Density (Kg/m^3)": solids["density"],
        "Specific heat of contact solids": solids["heat_capacity"],
        "Specific heat of lubricant (J/KgK)": oil["heat_capacity"],
        "Ambient density (Kg/m3)": oil["density"]["rho_0"],
        "Temperature-viscosity coefficient": f"S0 = {oil['viscosity']['S0']}",
        "Temperature-density coefficient of lubricant (K^{-1})": oil["density"]["beta"],
    }
    rows = [
        Parameter(
            name=name,
            printed=value,
            set_a=used.get(name, "not used"),
            set_b=used.get(name, "not used"),
        )
        for name, value in printed().parameters
    ]
    return rows + _assumed(oil, solids)


def _assumed(oil: dict[str, Any], solids: dict[str, Any]) -> list[Parameter]:
    """Return what the paper does not print."""
    del solids
    first, second = (_contact(name) for name in ("A", "hot"))
    radius = [parameter_set(name)["contact"]["radius"] for name in ("A", "B")]
    modulus = f"{first.reduced_modulus * 1e-9:.4g} GPa"
    speeds = [f"{one.entrainment_speed:.3g} m/s" for one in (first, second)]
    viscosity = oil["viscosity"]
    alpha = f"alpha = {first.pressure_coefficient * 1e9:.5g} 1/GPa"
    same = (
        (
            "reduced modulus E'",
            modulus,
            f"2/E' = sum of (1 - nu²)/E; G = {first.material_group:.0f}",
        ),
        ("ambient viscosity", str(viscosity["eta_0"]), ""),
        ("pressure index z of Roelands' law", str(viscosity["z"]), alpha),
        ("inlet temperature", str(viscosity["reference_temperature"]), ""),
    )
    rows = [
        Parameter(name=name, printed="", set_a=value, set_b=value, remark=remark, assumed=True)
        for name, value, remark in same
    ]
    rows.append(
        Parameter(name="reduced radius", printed="", set_a=radius[0], set_b=radius[1], assumed=True)
    )
    rows.append(
        Parameter(
            name="entrainment speed",
            printed="",
            set_a=speeds[0],
            set_b=speeds[1],
            remark="from L = 12.04",
            assumed=True,
        )
    )
    return rows


def _contact(name: str) -> Any:
    """Return a contact with M = 40 and L = 12.04."""
    one = series(name)
    return problem_of(one, one.runs[0], 40.0 if name == "A" else one.values[0])
