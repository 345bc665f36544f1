"""Questions about a case: values that are possible, but seldom meant."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from tehl.domain import NEARLY_RIGID, domain_error, needed_points, recommended_domain
from tehl.heat import LAYERS, Thermal
from tehl.lubricant import Roelands, RoelandsExponential, Walther
from tehl.options import Domain, Options, coarsenable
from tehl.problem import ContactProblem
from tehl.report.heating import ExpectedHeat
from tehl.scaling import Groups

ROUNDING = 1e-9
"""Part of a limit by which a value may miss it: groups come back from SI with rounding."""

SLIDING = 0.02
"""Slide-roll ratio from which on surfaces count as sliding."""
WARM = 5.0
"""Temperature rise from which on an isothermal film is questioned [K]."""
UNPHYSICAL = 0.8e9
"""Hertz pressure from which on a sliding Newtonian film is questioned [Pa]."""
FEW_LAYERS = 15
"""Uniform layers below which a temperature profile is not resolved."""
SLOWEST_LINE = 5.0
"""Solid Peclet number below which a line source is off by more than four per cent."""


@dataclass(frozen=True, slots=True)
class _Usual:
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
        return f"{self.name} is {self.value:.3g}{unit}, usual are {low:g} to {high:g}: {hint}"


def questions(
    problem: ContactProblem,
    options: Options,
    groups: Groups,
    central_film: float,
    *,
    heat: ExpectedHeat | None = None,
) -> tuple[str, ...]:
    """Return what a careful reader would ask about a case, a sentence each.

    Parameters
    ----------
    problem, options : ContactProblem, Options
        The case.
    groups : Groups
        Its dimensionless groups.
    central_film : float
        Central film to expect [m].
    heat : ExpectedHeat or None
        Temperature rises to expect.
    """
    unusual = (usual.question() for usual in _usual(problem, groups))
    return (
        *(question for question in unusual if question),
        *_of_film(problem, central_film),
        *_of_sliding(problem),
        *_of_heat(problem, heat),
        *_of_numerics(options, groups),
    )


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
_RUBBER = f"a polymer or rubber, or {_UNIT}"


def _usual(problem: ContactProblem, groups: Groups) -> Iterator[_Usual]:
    hertz = problem.hertz
    slender = hertz.half_width_x / problem.radius_x
    yield _Usual("Hertz pressure", hertz.pressure / 1e9, (0.05, 4), "GPa", _SOFT, _YIELDS)
    yield _Usual("reduced radius_x", problem.radius_x, (1e-4, 5), "m", _UNIT)
    yield _Usual("reduced radius_y", problem.radius_y, (1e-4, 5), "m", _UNIT)
    yield _Usual("entrainment speed", problem.entrainment_speed, (1e-4, 100), "m/s", _UNIT)
    yield _Usual("a_x / R_x", slender, (0, 0.2), "", _HALF_SPACE)
    yield _Usual("a_y / a_x", groups.ellipticity, (0.05, 10), "", _SLENDER, _NO_POINT)
    yield _Usual("Moes M", groups.M, (1, 2000), "", _NO_CONTACT, _FINE)
    yield _Usual("Moes L", groups.L, (0, 25), "", "are speed and viscosity right?")
    for name, surface in (("surface_1", problem.surface_1), ("surface_2", problem.surface_2)):
        modulus = surface.material.young_modulus / 1e9
        yield _Usual(f"{name} young_modulus", modulus, (1, 1200), "GPa", _RUBBER, _UNIT)
    yield from _usual_of_oil(problem)


def _usual_of_oil(problem: ContactProblem) -> Iterator[_Usual]:
    viscosity = problem.lubricant.viscosity
    alpha = problem.pressure_coefficient * 1e9
    if viscosity.law != "constant":
        yield _Usual("pressure coefficient alpha", alpha, (5, 40), "1/GPa", _MOST_ALPHA)
    if isinstance(viscosity, Roelands | RoelandsExponential | Walther):
        yield _Usual("Roelands z", viscosity.pressure_index, (0.2, 1), "", _MOST_Z)
    yield _Usual("viscosity eta_0", viscosity.eta_0, (1e-3, 10), "Pa s", _MOST_ETA)
    yield _Usual("density rho_0", problem.ambient_density, (600, 2000), "kg/m^3", _UNIT)
    inlet = problem.inlet_temperature
    yield _Usual("temperature of the oil at the inlet", inlet, (240, 480), "K", _KELVIN)
    if problem.thermal is not None:
        yield from _usual_of_heat(problem)


def _usual_of_heat(problem: ContactProblem) -> Iterator[_Usual]:
    oil = problem.lubricant
    fall = problem.temperature_coefficient
    yield _Usual(
        "-d ln eta/dT of the oil", fall, (0.005, 0.12), "1/K", "most oils have 0.02 to 0.06"
    )
    conductivity, capacity = oil.ambient_conductivity, oil.ambient_heat_capacity
    yield _Usual("lubricant.conductivity", conductivity or 0.0, (0.05, 0.7), "W/m/K", _UNIT)
    yield _Usual("lubricant.heat_capacity", capacity or 0.0, (800, 4300), "J/kg/K", _UNIT)
    for name, surface in (("surface_1", problem.surface_1), ("surface_2", problem.surface_2)):
        solid = surface.material
        yield _Usual(f"{name} conductivity", solid.conductivity or 0, (0.1, 2500), "W/m/K", _UNIT)
        yield _Usual(
            f"{name} heat_capacity", solid.heat_capacity or 0, (100, 4300), "J/kg/K", _UNIT
        )
        yield _Usual(f"{name} density", solid.density or 0, (800, 23000), "kg/m^3", _UNIT)


def _of_film(problem: ContactProblem, central_film: float) -> Iterator[str]:
    if central_film < 5e-9:
        yield (
            f"the film will be about {central_film * 1e9:.2g} nm, a few molecules: the oil is no "
            "continuum there, is speed or viscosity too small?"
        )
    if problem.rms_roughness > 0 and central_film / problem.rms_roughness < 3:
        yield (
            f"the film is {central_film / problem.rms_roughness:.2g} times the roughness: below 3 "
            "asperities touch, which a smooth calculation does not show"
        )


def _of_sliding(problem: ContactProblem) -> Iterator[str]:
    slip = abs(problem.slide_roll_ratio)
    if slip > 2:
        yield (
            f"slide_roll_ratio = {problem.slide_roll_ratio:g} moves the surfaces in opposite "
            "directions: is it meant? It is (u_1 - u_2) / u_m, with u_m the mean speed"
        )
    high = problem.hertz.pressure >= UNPHYSICAL * (1.0 - ROUNDING)
    if slip > SLIDING and high and problem.lubricant.shear.is_newtonian:
        yield (
            f"a Newtonian film slides at {problem.hertz.pressure / 1e9:.2g} GPa, but traction "
            "coefficients above 0.1 are not physical: state an Eyring or limiting shear stress, "
            'such as shear = { law = "eyring", stress = "5 MPa" }'
        )


def _of_heat(problem: ContactProblem, heat: ExpectedHeat | None) -> Iterator[str]:
    if problem.thermal is not None:
        yield from _of_thermal(problem, problem.thermal)
        return
    newtonian = problem.lubricant.shear.is_newtonian
    if heat is not None and heat.largest > WARM:
        yield (
            f"[thermal] is missing, but shear will warm the film by about {heat.largest:.2g} K: an "
            f"isothermal {'Newtonian ' if newtonian else ''}film does not know of it"
        )
    elif newtonian and abs(problem.slide_roll_ratio) > SLIDING:
        yield (
            "surfaces slide, but an isothermal Newtonian film does not depend on it: heat would "
            "thin the film, and traction would be far too high"
        )


def _of_thermal(problem: ContactProblem, thermal: Thermal) -> Iterator[str]:
    if thermal.scheme == "uniform" and thermal.nodes < FEW_LAYERS:
        yield (
            f"thermal.layers = {thermal.nodes} are few for uniform layers: take "
            f'{LAYERS["uniform"]} or more, or scheme = "chebyshev"'
        )
    for name, peclet in zip(("surface_1", "surface_2"), problem.solid_peclet, strict=True):
        if thermal.sources == "line" and peclet is not None and peclet < SLOWEST_LINE:
            yield (
                'thermal.sources = "line" holds for fast surfaces, but the Peclet number of '
                f'{name} is {peclet:.2g}: take "auto"'
            )


def _of_numerics(options: Options, groups: Groups) -> Iterator[str]:
    if isinstance(options.domain, Domain):
        yield from _of_domain(options.domain, recommended_domain(groups))
    elif groups.M < NEARLY_RIGID:
        left_out = domain_error(groups, recommended_domain(groups))
        yield (
            f"M = {groups.M:.3g} is a nearly rigid contact, with part of its load far outside: the "
            f"proposed domain leaves out {_part(left_out)} of the film; --certify measures it"
        )
    needed = needed_points(groups)
    if min(options.shape) < needed:
        _, more = coarsenable(needed - 2)
        yield (
            f"numerics.points = {min(options.shape)} is coarse for so thin a film: take {more} or "
            "more, or expect a larger error bar or no convergence"
        )


def _part(part: float) -> str:
    return "more than half" if part > 0.5 else f"about {100 * part:.2g} %"


def _of_domain(stated: Domain, wanted: Domain) -> Iterator[str]:
    edges = (
        ("inlet edge x", stated.x[0], wanted.x[0]),
        ("outlet edge x", stated.x[1], wanted.x[1]),
        ("side edge y", stated.y[0], wanted.y[0]),
        ("side edge y", stated.y[1], wanted.y[1]),
    )
    for name, here, there in edges:
        if abs(here) < 0.99 * abs(there) and not math.isclose(here, there):
            yield (
                f"numerics.domain has its {name} at {here:g}, recommended is {there:.3g}: the "
                "error of the film from the domain may exceed 0.3 %"
            )
