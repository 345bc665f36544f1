"""The problem: a contact whose tables state it completely, only once, and within limits.

Each check raises `ValueError` with one sentence: the key, its value, what is wrong, what would be
right. `tehl.io.case` turns them into `InputError` with the name of the file.
"""

import math
from typing import Self

from pydantic import BaseModel, model_validator

from tehl.base.mistakes import part_of_case
from tehl.base.units import (
    Conductivity,
    HeatCapacity,
    Quantity,
    SolidConductivity,
    SolidDensity,
    SolidExpansion,
    SolidHeatCapacity,
    quantity,
)
from tehl.contact.bodies import direction, reduced_radius
from tehl.contact.boundary_contact import THICKEST_BOUNDARY_FILM, THINNEST_BOUNDARY_FILM
from tehl.contact.heat import LEAST_LINE
from tehl.contact.point_contact import Contact, PointContact, Surface
from tehl.contact.roller import Roller
from tehl.contact.summits import GreenwoodTripp
from tehl.contact.transient import COURSES, MOTION
from tehl.lubricant.registered import package_of

__all__ = ["Contact", "ContactProblem", "Surface"]

SURFACES = ("surface_1", "surface_2")
THERMAL_PROPERTIES = {
    "density": quantity(SolidDensity),
    "heat_capacity": quantity(SolidHeatCapacity),
    "conductivity": quantity(SolidConductivity),
}
COLDEST_TEMPERATURE, HOTTEST_TEMPERATURE = 200.0, 800.0
"""Limits of the temperature of an oil or a solid [K]."""
SOLID_PART = (
    "solid contact adds a stiffness and a hysteresis of its own, and only those of the oil are "
    "computed"
)
"""Why stiffness and damping are not computed where surfaces touch."""
LARGEST_TURN = 0.8
"""Largest spin of a heated surface times a_y over its speed: beyond it rows of the contact have too
little speed along x for their heat to be followed from station to station."""
LEAST_LENGTH = 3.0
"""Least length of a roller over the width of its contact."""
LARGEST_RATIO = 1e3
"""Largest ratio of the reduced radii, either way: beyond it the contact is a line contact."""


@part_of_case("", "contact", "lubricant", "thermal", "transient")
class ContactProblem(PointContact):
    """A lubricated contact: a circle, an ellipse or a line.

    Its fields are the tables of the case file, so that reading a case is validating the parsed
    file.
    """

    @model_validator(mode="after")
    def _check(self) -> Self:
        check(self)
        return self


def check(problem: PointContact) -> None:
    """Check that the tables of a problem state one contact, completely and only once.

    Raises ValueError with one sentence on the first fault.
    """
    _check_classes(problem, "")
    check_radii(problem)
    check_line(problem)
    check_roller(problem)
    check_temperatures(problem)
    check_heat(problem)
    check_transient(problem)
    check_spin(problem)
    check_supply(problem)
    check_asperities(problem)
    check_contact_film(problem)
    check_dynamics(problem)
    check_stress(problem)
    check_motion(problem)
    if problem.contact.moes_speed is not None and not problem.pressure_coefficient > 0:
        raise ValueError(
            "contact.moes_speed does not determine a speed: lubricant.viscosity has no pressure "
            "coefficient; give contact.entrainment_speed"
        )
    ratio = problem.radii_of_axes.y / problem.radii_of_axes.x
    if not problem.contact.has_lines and not 1.0 / LARGEST_RATIO <= ratio <= LARGEST_RATIO:
        raise ValueError(
            f"radius_y / radius_x = {ratio:.3g} is a line contact, not a point contact: it must "
            f'be between {1.0 / LARGEST_RATIO:g} and {LARGEST_RATIO:g}, or contact.type "line"'
        )
    check_size(problem)
    check_turning(problem)
    check_bodies(problem)


def _check_classes(table: BaseModel, path: str) -> None:
    """Check that laws and surfaces are those of this package or registered: a file names them."""
    for name in type(table).model_fields:
        value, key = getattr(table, name), f"{path}{name}"
        if not isinstance(value, BaseModel):
            continue
        kind = type(value)
        if kind.__module__.partition(".")[0] == __name__.partition(".")[0]:
            _check_classes(value, f"{key}.")
        elif package_of(value) is None:
            raise ValueError(
                f"{key} = {kind.__qualname__}: own classes are not supported, as a result file "
                f"would store its parent {kind.__base__.__name__ if kind.__base__ else ''}; use a "
                "law of tehl.lubricant or a surface of tehl.roughness, or register a law in the "
                "entry-point group tehl.laws"
            )


def check_size(problem: PointContact) -> None:
    """Check that load, speed and pressure are within the range of floating-point arithmetic."""
    try:
        sizes = [problem.radius_x, problem.load, problem.entrainment_speed, problem.hertz.pressure]
        twice_speed = 2.0 * problem.speed_group
        shape = problem.shape
        unit = shape.load_unit(problem.radius_x, problem.reduced_modulus)
        unit *= twice_speed**shape.speed_power
        load_number, speed_number = problem.load / unit, problem.material_group * twice_speed**0.25
    except ArithmeticError:
        sizes, load_number, speed_number = [], math.nan, math.nan
    is_possible = all(1e-30 < size < 1e30 for size in sizes)
    if not (is_possible and 1e-6 < load_number < 1e9 and speed_number < 1e6):
        raise ValueError(
            "load, speed and Hertz pressure are far outside the physical range (Moes numbers "
            f"M = {load_number:.3g}, L = {speed_number:.3g}): check the units of contact, "
            "materials and viscosity"
        )


def check_temperatures(problem: PointContact) -> None:
    """Check the temperatures of oil and bodies, and that the viscosity is known there."""
    oil, thermal = problem.lubricant, problem.thermal
    heated = thermal.temperature if thermal else None
    stated = {
        "lubricant.temperature": oil.temperature,
        "thermal.temperature": heated,
        "surface_1.temperature": problem.surface_1.temperature,
        "surface_2.temperature": problem.surface_2.temperature,
    }
    for key, value in stated.items():
        if value is not None and not COLDEST_TEMPERATURE <= value <= HOTTEST_TEMPERATURE:
            raise ValueError(
                f"{key} = {value:g} K is not a temperature of a lubricated contact "
                f"({COLDEST_TEMPERATURE:g} to {HOTTEST_TEMPERATURE:g} K): "
                'a bare number is in kelvin, write "40 degC"'
            )
    if oil.temperature is not None and heated is not None and oil.temperature != heated:
        raise ValueError(
            f"lubricant.temperature = {oil.temperature:g} K and thermal.temperature = "
            f"{heated:g} K conflict: both are the temperature of the oil at the inlet; state one"
        )
    law, inlet = oil.viscosity, problem.inlet_temperature
    is_constant = law.law == "constant" or law.temperature_coefficient > 0
    if inlet != law.reference_temperature and not is_constant:
        raise ValueError(
            f"lubricant.viscosity is given at {law.reference_temperature:g} K without a "
            f"temperature coefficient, but the inlet is at {inlet:g} K: {_remedy(problem)}"
        )


def check_heat(problem: PointContact) -> None:
    """Check that a thermal run has the properties it needs, and an isothermal one no bodies'."""
    oil = problem.lubricant
    for key in SURFACES:
        surface = getattr(problem, key)
        for name in ("temperature", "thermal_resistance", "cooling"):
            if problem.thermal is None and getattr(surface, name) is not None:
                raise ValueError(
                    f"{key}.{name} has an effect in thermal runs only: add a [thermal] table, or "
                    "state lubricant.temperature for an isothermal film"
                )
        for name, wanted in THERMAL_PROPERTIES.items() if problem.thermal else ():
            _need(f"{key}.material.{name}", getattr(surface.material, name), wanted)
    if problem.thermal is None:
        return
    _need("lubricant.conductivity", oil.conductivity, quantity(Conductivity))
    _need("lubricant.heat_capacity", oil.heat_capacity, quantity(HeatCapacity))
    if not oil.viscosity.temperature_coefficient > 0:
        raise ValueError(
            "lubricant.viscosity has no temperature coefficient, which a thermal run needs: "
            f"{_remedy(problem)}"
        )


def check_bodies(problem: PointContact) -> None:
    """Check that bodies whose temperature follows from their heat have one steady film."""
    if not problem.computes_bodies:
        return
    table = "[transient]" if problem.transient is not None else "supply.passes"
    if problem.transient is not None or problem.has_passes:
        raise ValueError(
            f"thermal_resistance and cooling of a surface are for a single steady film: state its "
            f"temperature, or leave out {table}"
        )
    _ = problem.resistances


def _need(key: str, value: object, wanted: Quantity) -> None:
    """Raise if a property that a thermal run needs is missing."""
    if value is None:
        raise ValueError(
            f"{key} is missing, which a thermal run needs: give {wanted.name} such as "
            f"{wanted.example}"
        )


def _remedy(problem: PointContact) -> str:
    """Return the key that makes the viscosity depend on temperature."""
    keys = type(problem.lubricant.viscosity).model_fields
    if "gamma" in keys:
        return 'add gamma, such as "0.04 1/K"'
    if "expansion" in keys:
        return 'add expansion, such as "8e-4 1/K"'
    return 'take a law with gamma, or law = "walther"'


def check_transient(problem: PointContact) -> None:
    """Check that a transient run has something that changes, and heat that it can follow."""
    transient, thermal = problem.transient, problem.thermal
    if transient is None:
        return
    if thermal is not None and thermal.sources == "full":
        raise ValueError(
            'thermal.sources = "full" is for steady films: in a transient run the surfaces are '
            "heated by line sources that move along with them"
        )
    varying = any(getattr(transient, key) for key in MOTION)
    for key in SURFACES if thermal is not None and not varying else ():
        speed = problem.motion.speed_1 if key == "surface_1" else problem.motion.speed_2
        if not speed * transient.stride >= 0.5 * problem.entrainment_speed * (1.0 - 1e-9):
            raise ValueError(
                f"{key} moves at {speed:g} m/s, less than half the entrainment speed over "
                f"transient.stride = {transient.stride}, too slow for heat in a transient run: "
                "take a larger stride, or a smaller slide_roll_ratio"
            )
    if transient.radius and problem.contact.entrainment_angle != 0.0:
        raise ValueError(
            "transient.radius changes that along x, which is none of both axes of an ellipse at an "
            "angle: leave out contact.entrainment_angle"
        )
    stated = [getattr(transient, key) for key in COURSES]
    if transient.duration is None and any(isinstance(one, str) for one in stated):
        raise ValueError(
            "transient.duration is missing: a formula of t has no end, so state when the run ends"
        )
    if transient.duration is None and not (problem.is_rough or any(stated)):
        raise ValueError(
            "transient: nothing changes with time; give a surface roughness, transient.load, "
            "transient.entrainment_speed or transient.duration"
        )


def check_motion(problem: PointContact) -> None:
    """Check that sliding across the entrainment, and spin, go with the rest of the problem."""
    contact = problem.contact
    turned = [name for name in ("spin_1", "spin_2") if getattr(contact, name) != 0.0]
    turned += ["sliding_angle"] if direction(contact.sliding_angle)[1] != 0.0 else []
    if not turned:
        return
    supply, law = problem.supply, problem.asperities
    one_is_rougher = problem.surface_1.rms_roughness != problem.surface_2.rms_roughness
    excluded = {
        "transient": (problem.transient is not None, "heights move along x alone"),
        "supply.passes": (
            supply is not None and supply.passes is not None,
            "both surfaces return along x alone",
        ),
        "dynamics": (
            problem.dynamics is not None and problem.is_coupled,
            "what sliding carries along y is not linearised for heat and shear thinning",
        ),
        "asperities": (
            law is not None and one_is_rougher and getattr(law, "rms", None) is None,
            "the rougher surface carries oil along x alone; state asperities.rms of both together",
        ),
        f'contact.type = "{contact.type}"': (
            contact.has_lines and turned != ["sliding_angle"],
            "with spin the speed changes along a line",
        ),
    }
    for name, (is_stated, why) in excluded.items():
        if is_stated:
            raise ValueError(f"contact.{turned[0]} and {name} exclude each other: {why}")


def check_turning(problem: PointContact) -> None:
    """Check that surfaces that spin have a speed along x, by which their heat is followed."""
    width, motion = problem.hertz.half_width_y, problem.motion
    for number, spin, peclet in zip(
        (1, 2), (motion.spin_1, motion.spin_2), problem.solid_peclet, strict=True
    ):
        if problem.thermal is None or spin == 0.0:
            continue
        speed = motion.speed_of(number)
        most = max(LARGEST_TURN * speed / width, 0.0)
        if peclet is not None and peclet < LEAST_LINE:
            most = 0.0
        if abs(spin) > most:
            raise ValueError(
                f"contact.spin_{number} = {spin:g} rad/s is too fast for [thermal]: at {speed:g} "
                f"m/s along the entrainment the heat of this surface is computed up to {most:.3g} "
                f"rad/s, {LARGEST_TURN:g} u/a_y, and from a Peclet number of {LEAST_LINE:g} on"
            )


def check_spin(problem: PointContact) -> None:
    """Check that nothing follows oil or heat along x alone where the mean motion spins."""
    if problem.contact.spin_1 + problem.contact.spin_2 == 0.0:
        return
    excluded = {
        f'contact.type = "{problem.contact.type}"': (
            problem.contact.has_lines,
            "the speed changes along a line",
        ),
        "transient": (problem.transient is not None, "heights and films move along x alone"),
        "contact_film": (problem.contact_film is not None, "oil is conserved along x alone"),
        "supply": (problem.conserves_oil, "oil in cavities is conserved along x alone"),
        "dynamics": (problem.dynamics is not None, "moving films are linearised along x alone"),
    }
    for name, (is_stated, why) in excluded.items():
        if is_stated:
            raise ValueError(
                f"contact.spin_1, spin_2 and {name} exclude each other if the spins are not "
                f"opposite: {why}"
            )


def check_supply(problem: PointContact) -> None:
    """Check that the oil of a starved contact is conserved, and passes have steady films."""
    supply, cavitation = problem.supply, problem.cavitation
    if supply is not None and cavitation is not None and cavitation.model == "reynolds":
        raise ValueError(
            'cavitation.model = "reynolds" does not conserve oil, which [supply] needs: '
            'take "conserving", or leave out [cavitation]'
        )
    if problem.has_passes and problem.transient is not None:
        raise ValueError(
            "supply.passes and [transient] exclude each other: each pass has a steady film; leave "
            "out one"
        )


def check_asperities(problem: PointContact) -> None:
    """Check that the asperities have a height, and that the run can have them."""
    if problem.asperities is None:
        return
    law = problem.asperities
    if isinstance(law, GreenwoodTripp) and not problem.asperity_rms > 0.0:
        raise ValueError(
            "asperities.rms is missing or zero: give the rms roughness of both surfaces together, "
            'such as "0.3 um", here or as rms_roughness of the surfaces'
        )
    if isinstance(law, GreenwoodTripp) and (fault := law.fault(problem.asperity_rms)):
        raise ValueError(f"asperities: {fault}; check the units")


def check_contact_film(problem: PointContact) -> None:
    """Check that the boundary film is one, and that the run can have contact through it."""
    film = problem.contact_film
    if film is None:
        return
    if not THINNEST_BOUNDARY_FILM <= film.thickness <= THICKEST_BOUNDARY_FILM:
        raise ValueError(
            f"contact_film.thickness = {film.thickness:g} m is not a boundary film: it must be "
            f'between {THINNEST_BOUNDARY_FILM:g} and {THICKEST_BOUNDARY_FILM:g} m, such as "5 nm"'
        )


def check_line(problem: PointContact) -> None:
    """Check that a line contact states nothing that lines do not have."""
    if not problem.contact.is_line:
        return
    supply, thermal = problem.supply, problem.thermal
    resting = thermal is not None and any(problem.motion.speed_of(one) == 0.0 for one in (1, 2))
    excluded = {
        "supply": (
            supply is not None and (supply.profile is not None or supply.track is not None),
            "no oil flows aside, so profile, track and passes have no effect; state layer or ratio",
        ),
        "thermal": (resting, "a surface at rest has no steady temperature under a line of heat"),
        "cooling": (
            problem.computes_bodies,
            "its track has no width; state the temperature of the body",
        ),
    }
    for name, (is_stated, why) in excluded.items():
        if is_stated:
            raise ValueError(f'contact.type = "line" and {name} exclude each other: {why}')


def check_stress(problem: PointContact) -> None:
    """Check that the heat of a thermal stress is computed, and that the bodies expand by it."""
    stress = problem.stress
    if stress is None or not stress.thermal:
        return
    if problem.thermal is None:
        raise ValueError("stress.thermal = true needs the heat of the film: add [thermal]")
    for body in stress.bodies:
        if (problem.surface_1, problem.surface_2)[body - 1].material.expansion is None:
            raise ValueError(
                f"surface_{body}.material.expansion is missing, which stress.thermal needs: give "
                f"{quantity(SolidExpansion).name} such as {quantity(SolidExpansion).example}"
            )


def check_roller(problem: PointContact) -> None:
    """Check that a roller is longer than its contact is wide."""
    shape = problem.shape
    if not isinstance(shape, Roller):
        return
    if problem.dynamics is not None:
        raise ValueError(
            'contact.type = "roller" and dynamics exclude each other: the response of the oil '
            "upstream of a roller is not known"
        )
    width = 2.0 * problem.hertz.half_width_x
    if not shape.length >= LEAST_LENGTH * width:
        raise ValueError(
            f"contact.length = {1e3 * shape.length:.4g} mm: less than {LEAST_LENGTH:g} times the "
            f"width of the contact, {1e3 * width:.4g} mm; rollers are longer, check length and load"
        )


def check_dynamics(problem: PointContact) -> None:
    """Check that the film has one steady state, which oil alone carries."""
    excluded = {
        "transient": (problem.transient is not None, "a transient run has no steady state"),
        "supply.passes": (problem.has_passes, "each pass has another film"),
        "asperities": (problem.asperities is not None, SOLID_PART),
        "contact_film": (problem.contact_film is not None, SOLID_PART),
    }
    for name, (is_stated, why) in excluded.items():
        if problem.dynamics is not None and is_stated:
            raise ValueError(f"dynamics and {name} exclude each other: {why}; leave out one")
    held = None if problem.dynamics is None else problem.dynamics.held_at
    if held is not None and not problem.contact.is_line:
        raise ValueError("dynamics.held_at is only for line contacts; leave it out")
    if held is not None and not held > problem.hertz.half_width_x:
        raise ValueError(
            f"dynamics.held_at = {held:g} m: must be outside the contact, whose half-width is "
            f"{problem.hertz.half_width_x:.3g} m"
        )


def check_radii(problem: PointContact) -> None:
    """Check that the radii are stated once, and make a contact along both axes."""
    contact, on_surfaces = problem.contact.radii, [getattr(problem, key).radii for key in SURFACES]
    if contact is not None:
        if on_surfaces != [None, None]:
            raise ValueError(
                "radii are stated twice: leave out those of [contact], which are reduced, or "
                "those of the surfaces"
            )
        return
    if on_surfaces == [None, None]:
        raise ValueError("contact.radius is missing: give it, or radii of both surfaces")
    for key, radii in zip(SURFACES, on_surfaces, strict=True):
        if radii is None:
            raise ValueError(f'{key}.radius is missing: give it ("inf" is flat)')
    for axis in ("x",) if problem.contact.has_lines else ("x", "y"):
        try:
            reduced_radius(*(getattr(radii, axis) for radii in on_surfaces))
        except ValueError as error:
            once = (getattr(problem, key).radius is not None for key in SURFACES)
            pairs = zip(SURFACES, once, strict=True)
            keys = " and ".join(f"{key}.radius" + ("" if one else f"_{axis}") for key, one in pairs)
            is_line = axis == "y" and all(math.isinf(radii.y) for radii in on_surfaces)
            why = ' (a line contact has contact.type = "line")' if is_line else ""
            raise ValueError(f"{keys}: {error}{why}") from None
