"""The range in which each quantity of a case usually lies, and what to think of values outside."""

from collections.abc import Iterator
from dataclasses import dataclass

from tehl.lubricant import Limiting, Roelands, RoelandsExponential, Walther
from tehl.problem import ContactProblem, Surface
from tehl.scaling import Groups

ROUNDING = 1e-9
"""Part of a limit by which a value may miss it: groups come back from SI with rounding."""


@dataclass(frozen=True, slots=True)
class Usual:
    """Range in which a quantity usually lies, in ``unit``, and what to think of outside."""

    name: str
    value: float
    limits: tuple[float, float]
    unit: str
    hint: str
    hint_above: str = ""

    def question(self) -> str | None:
        """Return the question, None inside the range."""
        low, high = self.limits
        if low * (1.0 - ROUNDING) <= self.value <= high * (1.0 + ROUNDING):
            return None
        hint = self.hint_above if self.value > high and self.hint_above else self.hint
        unit = f" {self.unit}" if self.unit else ""
        value = f"{float(f'{self.value:.3g}'):g}"  # 78500 rather than 7.85e+04
        return f"{self.name} is {value}{unit}, usual are {low:g} to {high:g}: {hint}"


_UNIT = "is the unit right (a bare number is SI)?"
_MOST_ALPHA = "most oils have 10 to 30"
_MOST_ETA = "is it in mPa s? Most oils have 0.005 to 1"
_MOST_Z = "most oils have 0.4 to 0.8, does alpha fit eta_0?"
_SOFT = "is the contact so soft or so lightly loaded?"
_YIELDS = "would the solids not yield? Check load, radius and modulus"
_NO_CONTACT = "is this an elastic contact at all?"
_FINE = "is the load right? The film needs a very fine grid"
_HALF_SPACE = "on this scale the solids are no half-spaces"
_SLENDER = "are radius_x and radius_y in the right order?"
_NO_POINT = "wider contacts may not converge; a line contact is not computed"
_KELVIN = "a bare number is in kelvin"
_GRAMS = "is it in g/cm^3? Steel has 7850"
_KILO = "is it in kJ/kg/K? Steel has 470"
_OIL = "is it in kJ/kg/K? Most oils have 2000"
_CONDUCTS = "steel has 46, glass 1.1"
_STORES = "most solids store 2 to 4, are both units right?"
_LIMIT = "most oils slip at 0.03 to 0.1 of the pressure"
_FALL = "most oils have 0.02 to 0.06"
_RUBBER = f"a polymer or rubber, or {_UNIT}"


def usual(problem: ContactProblem, groups: Groups) -> Iterator[Usual]:
    """Yield the quantities of a case with their usual ranges.

    Parameters
    ----------
    problem : ContactProblem
        The case.
    groups : Groups
        Its dimensionless groups.
    """
    hertz = problem.hertz
    slender = hertz.half_width_x / problem.radius_x
    yield Usual("Hertz pressure", hertz.pressure / 1e9, (0.05, 4), "GPa", _SOFT, _YIELDS)
    yield Usual("reduced radius_x", problem.radius_x, (1e-4, 5), "m", _UNIT)
    yield Usual("reduced radius_y", problem.radius_y, (1e-4, 5), "m", _UNIT)
    yield Usual("entrainment speed", problem.entrainment_speed, (1e-4, 100), "m/s", _UNIT)
    yield Usual("a_x / R_x", slender, (0, 0.2), "", _HALF_SPACE)
    yield Usual("a_y / a_x", groups.ellipticity, (0.05, 10), "", _SLENDER, _NO_POINT)
    yield Usual("Moes M", groups.M, (1, 2000), "", _NO_CONTACT, _FINE)
    yield Usual("Moes L", groups.L, (0, 25), "", "are speed and viscosity right?")
    for name in ("surface_1", "surface_2"):
        yield from _usual_of_solid(name, getattr(problem, name))
    yield from _usual_of_oil(problem)


def _usual_of_solid(name: str, surface: Surface) -> Iterator[Usual]:
    """Yield what a solid states: numbers that no solid has are odd in an isothermal case too."""
    solid = surface.material
    yield Usual(
        f"{name} young_modulus", solid.young_modulus / 1e9, (1, 1200), "GPa", _RUBBER, _UNIT
    )
    stated = (
        Usual(f"{name} density", solid.density or 0.0, (800, 23000), "kg/m^3", _GRAMS, _UNIT),
        Usual(
            f"{name} heat_capacity", solid.heat_capacity or 0.0, (100, 4300), "J/kg/K", _KILO, _UNIT
        ),
        Usual(f"{name} conductivity", solid.conductivity or 0.0, (0.1, 2500), "W/m/K", _CONDUCTS),
    )
    yield from (one for one in stated if one.value > 0)
    if solid.density and solid.heat_capacity and all(one.question() is None for one in stated[:2]):
        stored = solid.density * solid.heat_capacity / 1e6
        product = f"{name} density times heat_capacity"
        yield Usual(product, stored, (1, 5), "MJ/m^3/K", _STORES)


def _usual_of_oil(problem: ContactProblem) -> Iterator[Usual]:
    viscosity = problem.lubricant.viscosity
    alpha = problem.pressure_coefficient * 1e9
    if viscosity.law != "constant":
        yield Usual("pressure coefficient alpha", alpha, (5, 40), "1/GPa", _MOST_ALPHA)
    if isinstance(viscosity, Roelands | RoelandsExponential | Walther):
        yield Usual("Roelands z", viscosity.pressure_index, (0.2, 1), "", _MOST_Z)
    yield Usual("viscosity eta_0", viscosity.eta_0, (1e-3, 10), "Pa s", _MOST_ETA)
    yield Usual("density rho_0", problem.ambient_density, (600, 2000), "kg/m^3", _UNIT)
    inlet = problem.inlet_temperature
    yield Usual("temperature of the oil at the inlet", inlet, (240, 480), "K", _KELVIN)
    oil = problem.lubricant
    stated = (
        Usual(
            "lubricant.conductivity", oil.ambient_conductivity or 0.0, (0.05, 0.7), "W/m/K", _UNIT
        ),
        Usual(
            "lubricant.heat_capacity", oil.ambient_heat_capacity or 0.0, (800, 4300), "J/kg/K", _OIL
        ),
    )
    yield from (one for one in stated if one.value > 0)
    yield from _usual_of_flow(problem)


def _usual_of_flow(problem: ContactProblem) -> Iterator[Usual]:
    shear, pressure = problem.lubricant.shear, problem.hertz.pressure
    if isinstance(shear, Limiting):
        part = (shear.stress + shear.slope * pressure) / pressure
        yield Usual("limiting shear stress over p_h", part, (0.02, 0.15), "", _LIMIT)
    if problem.thermal is not None:
        fall = problem.temperature_coefficient
        yield Usual("-d ln eta/dT of the oil", fall, (0.005, 0.12), "1/K", _FALL)
