"""Plausibility of a case: typical ranges of its values, unusual combinations."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from tehl.base.units import percentage
from tehl.contact.heat import FAR_BODY, LAYERS
from tehl.contact.options import MOST_NODES_PER_AXIS, Domain, Options
from tehl.contact.problem import ContactProblem
from tehl.contact.summits import GreenwoodTripp
from tehl.contact.tables import Surface
from tehl.estimate.domain import domain_error, domain_of, proposed_domain
from tehl.estimate.duration import extremes_of
from tehl.estimate.film_formulas import (
    LARGEST_FILM_PART,
    film_over_radius,
    inlet_stress,
    likely_film,
    thick_film_advice,
)
from tehl.estimate.nodes import expected_bar, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.spin import flooded_reach, outside_by_spin
from tehl.estimate.starvation import supplied_film
from tehl.lubricant import Limiting, Roelands, RoelandsExponential, Walther
from tehl.post.traction import LARGEST_CREDIBLE
from tehl.report.expected_heat import NOTICEABLE, BodyEffect, ExpectedHeat
from tehl.report.placement import about_ends, about_places
from tehl.report.roughness import CONVERGES, RESOLVES, Asperities

SLIDING, WARM = 0.02, 5.0
"""Slide-roll ratio from which on surfaces count as sliding, and temperature rise from which on an
isothermal film is not plausible [K]."""
UNPHYSICAL, THINS, UNPHYSICAL_STRESS = 0.8e9, 5e6, 1.0
"""Hertz pressure, and shear stress at the mean one, from which on a sliding Newtonian film is not
plausible [Pa], and stress over the pressure, before heat, from which on one that thins is not."""
THICK_FILM = 0.01
"""Film over the reduced radius from which on the gap of a film is steep: its slope is 0.14 where it
is twice as wide as at the centre."""
STEEP_HEIGHTS = 0.6
"""Rms pressure that flattens the heights over p_h, from which on runs may not converge: of random
surfaces (M = 16 to 500) 0.41 and 0.56 take a second, 0.64 with heat minutes, of those with 0.79 and
more some do not converge on 257 nodes."""
SHARP = (1e-4, 1e-2)
"""Height of asperities over the radius of their summits: of machined surfaces."""
LIMIT_ROUNDING = 1e-9
"""Part of a limit by which a value may miss it: groups are computed from SI with rounding."""


class Typical(NamedTuple):
    """Typical range of a quantity, in its unit, and what to check outside."""

    name: str
    value: float
    low: float
    high: float
    unit: str
    hint: str
    hint_above: str = ""

    def question(self) -> str | None:
        """Return what is not plausible, None inside the range."""
        if self.low * (1.0 - LIMIT_ROUNDING) <= self.value <= self.high * (1.0 + LIMIT_ROUNDING):
            return None
        hint = self.hint_above if self.value > self.high and self.hint_above else self.hint
        unit = f" {self.unit}" if self.unit else ""
        value = f"{float(f'{self.value:.3g}'):g}"  # 78500 rather than 7.85e+04
        return (
            f"{self.name} = {value}{unit}: typical values are {self.low:g} to {self.high:g}{unit}; "
            f"{hint}"
        )


_UNIT = "check the unit (a bare number is SI)"
_RUBBER = f"a polymer or rubber? Otherwise {_UNIT}"
_YIELD = "the solids would yield, check load, radius and modulus"
_BLUNT = "check the units of rms and summit_radius"
_SHARP = f"summits this sharp would yield, {_BLUNT}"
_WIDE = 'a line contact has contact.type = "line", a roller "roller"'


def questions(
    scaled: ScaledProblem,
    options: Options,
    heat: ExpectedHeat | None,
    bodies: BodyEffect | None,
    heights: Asperities | None,
) -> tuple[str, ...]:
    """Return the values of a case that are not plausible, a sentence each.

    Parameters
    ----------
    scaled : ScaledProblem
        With dimensionless groups, Hertz contact and expected films.
    options : Options
        Its numerics.
    heat : ExpectedHeat or None
        Temperature rises to expect.
    bodies : BodyEffect or None
        Effect of bodies that are not at the temperature of the oil.
    heights : Asperities or None
        Heights of rough surfaces.
    """
    return (
        *untypical(scaled),
        *_about_groove(scaled.problem),
        *_about_limits(scaled.problem),
        *about_ends(scaled),
        *about_places(scaled),
        *_about_film(scaled),
        *_about_sliding(scaled, heat),
        *_about_heat(scaled.problem, heat),
        *_about_bodies(bodies),
        *_about_domain(options, scaled),
        *_about_grid(options, scaled),
        *(_about_heights(scaled, planned(scaled, options), heights) if heights else ()),
    )


def untypical(scaled: ScaledProblem) -> list[str]:
    """Return the values of a case that lie outside of their typical ranges, a sentence each."""
    return [found for one in typical_ranges(scaled) if (found := one.question())]


def typical_ranges(scaled: ScaledProblem) -> Iterator[Typical]:
    """Yield the quantities of a case with their typical ranges."""
    problem, groups, hertz = scaled.problem, scaled.groups, scaled.problem.hertz
    slender = hertz.half_width_x / problem.radius_x
    soft, rigid = "check for a soft or lightly loaded contact", "check that the contact is elastic"
    across: tuple[Any, ...] = (
        ("reduced radius_y", problem.radius_y, 1e-4, 5, "m", _UNIT),
        ("a_y / a_x", groups.ellipticity, 0.05, 60, "", "check the order of the radii", _WIDE),
    )
    for row in (
        ("Hertz pressure", extremes_of(scaled)[1] / 1e9, 0.05, 4, "GPa", soft, _YIELD),
        ("reduced radius_x", problem.radius_x, 1e-4, 5, "m", _UNIT),
        ("entrainment speed", problem.entrainment_speed, 1e-4, 100, "m/s", _UNIT),
        ("a_x / R_x", slender, 0, 0.2, "", "the solids are not half-spaces on this scale"),
        *(() if problem.contact.has_lines else across),
        ("Moes M", groups.M, 1, 50000, "", rigid, "check the load: a fine grid is needed"),
        ("Moes L", groups.L, 0, 25, "", "check speed and viscosity"),
        ("roughness Sq", problem.rms_roughness * 1e6, 0, 100, "um", _UNIT),
    ):
        yield Typical(*row)
    yield from _ranges_of_solid("surface_1", problem.surface_1)
    yield from _ranges_of_solid("surface_2", problem.surface_2)
    yield from _ranges_of_oil(problem)
    summits = problem.asperities
    if isinstance(summits, GreenwoodTripp):
        ratio, least, most = problem.asperity_rms / summits.summit_radius, *SHARP
        yield Typical("asperities.rms / summit_radius", ratio, least, most, "", _BLUNT, _SHARP)


def _about_groove(problem: ContactProblem) -> Iterator[str]:
    """Yield a surface that would be the groove of a ball if its radius across were negative."""
    surfaces = {"surface_1": problem.surface_1, "surface_2": problem.surface_2}
    for name, other in (("surface_1", "surface_2"), ("surface_2", "surface_1")):
        ball, across = surfaces[other].radius, surfaces[name].radius_y
        # conformities of 0.5025 to 0.625
        if ball and across and 1.005 <= across / ball <= 1.25:
            yield (
                f"{name}.radius_y = {1e3 * across:.4g} mm: the surface is convex across the "
                f"rolling direction; the groove of a ball has a negative radius_y, "
                f'"-{1e3 * across:.4g} mm"'
            )


def _ranges_of_solid(name: str, surface: Surface) -> Iterator[Typical]:
    """Yield the properties that a solid states, thermal ones of an isothermal case too."""
    solid = surface.material
    young, conductivity = solid.young_modulus / 1e9, solid.conductivity or 0.0
    density, heat_capacity = solid.density or 0.0, solid.heat_capacity or 0.0
    grams, kilo = "in g/cm^3? Steel has 7850", "in kJ/kg/K? Steel has 470"
    stated = (
        Typical("density", density, 800, 23000, "kg/m^3", grams, _UNIT),
        Typical("heat_capacity", heat_capacity, 100, 4300, "J/kg/K", kilo, _UNIT),
        Typical("conductivity", conductivity, 0.1, 2500, "W/m/K", "steel has 46, glass 1.1"),
    )
    found = [Typical("young_modulus", young, 1, 1200, "GPa", _RUBBER, _UNIT)]
    found += [one for one in stated if one.value > 0]
    if density and heat_capacity and all(one.question() is None for one in stated[:2]):
        stored, hint = density * heat_capacity / 1e6, "most solids have 2 to 4, check both units"
        found.append(Typical("density times heat_capacity", stored, 1, 5, "MJ/m^3/K", hint))
    yield from (one._replace(name=f"{name} {one.name}") for one in found)


def _ranges_of_oil(problem: ContactProblem) -> Iterator[Typical]:
    oil, viscosity = problem.lubricant, problem.lubricant.viscosity
    alpha, density = problem.pressure_coefficient * 1e9, problem.ambient_density
    alphas, inlet = "most oils have 10 to 30", problem.inlet_temperature
    if viscosity.law != "constant":
        yield Typical("pressure coefficient alpha", alpha, 5, 40, "1/GPa", alphas)
    if isinstance(viscosity, Roelands | RoelandsExponential | Walther):
        index, hint = viscosity.pressure_index, "most oils have 0.4 to 0.8, check alpha and eta_0"
        yield Typical("Roelands z", index, 0.2, 1, "", hint)
    hint = "in mPa s? Most oils have 0.005 to 1"
    at_reference = viscosity.ambient(viscosity.reference_temperature)
    yield Typical("viscosity eta_0", at_reference, 1e-3, 10, "Pa s", hint)
    yield Typical("density rho_0", density, 600, 2000, "kg/m^3", _UNIT)
    hint = "a bare number is in kelvin"
    yield Typical("temperature of the oil at the inlet", inlet, 240, 480, "K", hint)
    conductivity, capacity = oil.ambient_conductivity or 0.0, oil.ambient_heat_capacity or 0.0
    kilo = "in kJ/kg/K? Most oils have 2000"
    stated = (
        Typical("lubricant.conductivity", conductivity, 0.05, 0.7, "W/m/K", _UNIT),
        Typical("lubricant.heat_capacity", capacity, 800, 4300, "J/kg/K", kilo),
    )
    yield from (one for one in stated if one.value > 0)
    shear, pressure = oil.shear, problem.hertz.pressure
    if isinstance(shear, Limiting):
        part = (shear.stress + shear.slope * pressure) / pressure
        hint = "most oils slip at 0.03 to 0.1 of the pressure"
        yield Typical("limiting shear stress over p_h", part, 0.02, 0.15, "", hint)
    if problem.thermal is not None:
        fall, hint = problem.temperature_coefficient, "most oils have 0.02 to 0.06"
        yield Typical("-d ln eta/dT of the oil", fall, 0.005, 0.12, "1/K", hint)


def _about_limits(problem: ContactProblem) -> Iterator[str]:
    """Yield conditions in which the constants of the oil are not known."""
    oil, inlet, highest = problem.lubricant, problem.inlet_temperature, problem.hertz.pressure
    limits, name = oil.limits, oil.name or "the oil"
    if limits is not None and limits.temperature is not None:
        low, high = limits.temperature
        if not low <= inlet <= high:
            yield (
                f"temperature of the oil at the inlet = {inlet:.4g} K: the constants of {name} are "
                f"known from {low:.4g} to {high:.4g} K"
            )
    if limits is not None and limits.pressure is not None and highest > limits.pressure:
        yield (
            f"Hertz pressure = {highest / 1e9:.3g} GPa: the constants of {name} are known up to "
            f"{limits.pressure / 1e9:.3g} GPa"
        )


def _about_film(scaled: ScaledProblem) -> Iterator[str]:
    film, rough = likely_film(scaled).central_m, scaled.problem.rms_roughness
    if scaled.problem.asperities is not None:
        rough = 0.0  # they are computed
    thick = film_over_radius(scaled)
    if thick > THICK_FILM and scaled.problem.supply is None:
        yield (
            f"the expected film of {1e3 * film:.4g} mm is {thick:.3g} times the smaller reduced "
            "radius: Reynolds' equation needs a thin one, and a run accepts "
            f"{LARGEST_FILM_PART:g} at most; {thick_film_advice(scaled.problem)}"
        )
    film = min(film, supplied_film(scaled) * scaled.scales.film_thickness)
    if film < 5e-9:
        yield (
            f"the expected film of {film * 1e9:.2g} nm is a few molecules: the oil is not a "
            "continuum there, check speed and viscosity"
        )
    if rough > 0 and film / rough < 3:
        yield (
            f"the film is {film / rough:.2g} times the roughness: below 3 asperities touch, which "
            "a smooth calculation does not show"
        )


def _about_sliding(scaled: ScaledProblem, heat: ExpectedHeat | None) -> Iterator[str]:
    problem, shear = scaled.problem, scaled.problem.lubricant.shear
    slip, pressure = extremes_of(scaled)
    if abs(problem.motion.sliding_ratio[0]) > 2:
        yield (
            f"slide_roll_ratio = {problem.slide_roll_ratio:g}: the surfaces move in opposite "
            "directions; the ratio is (u_1 - u_2) / u_m, with u_m the mean speed"
        )
    high = slip > SLIDING and pressure >= UNPHYSICAL * (1.0 - LIMIT_ROUNDING)
    high = high or (heat is not None and heat.traction > LARGEST_CREDIBLE)
    high = high or inlet_stress(scaled) * problem.hertz.mean_pressure > THINS
    if high and shear.is_newtonian:
        yield (
            f"a Newtonian film slides at {pressure / 1e9:.2g} GPa: oils thin from shear stresses "
            "of some 5 MPa on, and traction coefficients above 0.1 are not physical; state an "
            'Eyring or limiting shear stress, such as shear = { law = "eyring", stress = "5 MPa" }'
        )
    elif problem.is_coupled and (stress := inlet_stress(scaled)) > UNPHYSICAL_STRESS:
        yield (
            f"lubricant.shear.law = {shear.law}: the shear stress is {stress:.2g} times the "
            "pressure before heat thins the oil; oils slip at 0.03 to 0.1 of it, state an Eyring "
            "or limiting shear stress"
        )


def _about_heat(problem: ContactProblem, heat: ExpectedHeat | None) -> Iterator[str]:
    """Yield what is missing of an isothermal case, or what is wrong in a thermal one."""
    thermal, newtonian = problem.thermal, problem.lubricant.shear.is_newtonian
    slides = problem.sliding_speed > SLIDING * problem.entrainment_speed
    neglects = "film neglects: its traction is far too high" if newtonian else "film neglects"
    if thermal is None and heat is not None and heat.largest > WARM:
        yield (
            f"[thermal] is missing: shear heats the film by about {heat.largest:.2g} K, which an "
            f"isothermal {'Newtonian ' if newtonian else ''}{neglects}"
        )
    elif thermal is None and newtonian and slides:
        yield (
            "the surfaces slide, but the film is isothermal and Newtonian: heat would thin it, and "
            "its traction is far too high"
        )
    if thermal is None:
        return
    # a temperature profile is under-resolved
    if thermal.scheme == "uniform" and thermal.layers is not None and thermal.layers < 15:
        yield (
            f"thermal.layers = {thermal.layers}: too few for uniform layers; take "
            f'{LAYERS["uniform"]} or more, or scheme = "chebyshev"'
        )
    for name, peclet in zip(("surface_1", "surface_2"), problem.solid_peclet, strict=True):
        # a line source deviates by more than four per cent
        if thermal.sources == "line" and peclet is not None and peclet < 5.0:
            yield (
                'thermal.sources = "line": valid for fast surfaces, but the Peclet number of '
                f'{name} is {peclet:.2g}; take "auto"'
            )


def _about_bodies(bodies: BodyEffect | None) -> Iterator[str]:
    """Yield bodies that are not at the temperature of the oil, which film formulas do not cover."""
    if bodies is None:
        return
    for name, offset in (("surface_1", bodies.surface_1), ("surface_2", bodies.surface_2)):
        if abs(offset) >= NOTICEABLE:
            far = (
                f"; beyond {FAR_BODY:g} K a run may not converge" if abs(offset) > FAR_BODY else ""
            )
            yield (
                f"{name}.temperature is {abs(offset):.3g} K {'above' if offset > 0 else 'below'} "
                f"the oil at the inlet, and the oil takes it on the way in{far}"
            )


def _about_domain(options: Options, scaled: ScaledProblem) -> Iterator[str]:
    """Yield domains longer than the bodies, edges of stated ones that are near, and the loss."""
    reach = -domain_of(scaled, options).x[0] * scaled.problem.hertz.half_width_x
    bodies = (scaled.problem.surface_1.radii, scaled.problem.surface_2.radii)
    least = min((abs(radii.x) for radii in bodies if radii), default=math.inf)
    if reach > 0.5 * least:  # where the gap is 7 % less than that of a parabola
        yield (
            f"the inlet is {1e3 * reach:.3g} mm long, but a body has a radius of {1e3 * least:.3g} "
            "mm: its gap is taken as a parabola; check the radii, and the load"
        )
    outside = outside_by_spin(scaled)
    if outside > 0.05 and options.has_far_field and scaled.problem.supply is None:
        radius = 1e3 * flooded_reach(scaled) * scaled.scales.half_width_x
        yield (
            f"as surfaces spin, oil outside the contact carries about {percentage(outside)} of the "
            f"load, out to {radius:.3g} mm; state contact.flooded_radius, or [supply], if oil ends "
            "nearer"
        )
    stated, wanted = options.domain, proposed_domain(scaled, options)
    if not isinstance(stated, Domain):
        return
    names = ("inlet edge x", "outlet edge x", "side edge y", "side edge y")
    edges = zip(names, (*stated.x, *stated.y), (*wanted.x, *wanted.y), strict=True)
    for name, here, there in edges:
        if abs(here) < 0.95 * abs(there):
            yield (
                f"numerics.domain has its {name} at {here:g}, recommended is {there:.3g}: the "
                "error of the film from the domain may be large"
            )
    if options.has_far_field:
        return
    missing = domain_error(scaled.entering, stated)
    if missing > 0.005:
        yield (
            "numerics.domain: zero pressure on its edges may change the film by up to "
            f'{percentage(missing)}; remove the domain, or set numerics.edges = "far_field"'
        )


def _about_grid(options: Options, scaled: ScaledProblem) -> Iterator[str]:
    if options.points == "auto":
        return
    if options.error is not None:
        yield (
            f"numerics.points is stated, so numerics.error = {percentage(options.error)} is not "
            "enforced: remove one of them"
        )
    groups, coupled = scaled.entering, scaled.problem.is_coupled
    nodes = _fewest(options)
    bar = expected_bar(groups, domain_of(scaled, options), nodes, is_coupled=coupled)
    if bar > options.target:
        size = "above 100 %" if bar > 1.0 else f"about {percentage(bar)}"
        yield (
            f"numerics.points = {nodes}: the expected error of the film is {size}, and a coarse "
            f'grid may not converge; set numerics.error = "{percentage(options.target)}" instead'
        )


def _fewest(options: Options) -> int:
    """Return the nodes of the direction that has fewer; a line contact has one row."""
    return min(one for one in options.shape if one > 1)


def _about_heights(scaled: ScaledProblem, options: Options, found: Asperities) -> Iterator[str]:
    film, pressure = likely_film(scaled).central_m, scaled.problem.hertz.pressure
    yield from found.remarks
    if found.resolution.warning is not None:
        yield found.resolution.warning
    if found.points_per_wave < CONVERGES:
        enough, better = (
            f"{points} nodes"
            if points <= MOST_NODES_PER_AXIS
            else f"more than {MOST_NODES_PER_AXIS} nodes"
            for points in (found.points_to_converge, found.points_to_resolve)
        )
        yield (
            f"numerics.points = {_fewest(options)}: {found.points_per_wave:.2g} nodes on the "
            f"shortest wave of the surfaces ({found.shortest_wave * 1e6:.3g} um), so a run may not "
            f"converge; {enough} put {CONVERGES} on it, {better} the {RESOLVES} that its ripples "
            "need"
        )
    if found.steepest > 0.1:
        yield (
            f"the surfaces have slopes up to {found.steepest:.2g}: Reynolds' equation needs small "
            "ones, check the units of height and length"
        )
    if film < found.composite:
        what = "the result shows where there is no film"
        if scaled.problem.contact_film is not None:
            what = "a share of the load needs patches of 8 cells"
        yield f"the film is {film / found.composite:.2g} times Sq: asperities may touch, and {what}"
    pressures = (t.elastic_pressure if t.pressure is None else t.pressure for _, t in found.waves)
    largest = max(pressures, default=0.0)
    if largest > pressure:
        yield (
            f"flattening a wave needs {largest / pressure:.2g} Hertz pressures: its valleys will "
            "cavitate, and a run may not converge"
        )
    elif found.flattening > STEEP_HEIGHTS * pressure:
        yield (
            f"flattening the surfaces needs {found.flattening / pressure:.2g} Hertz pressures (rms "
            "over the contact): a run may take minutes, and not converge"
        )
