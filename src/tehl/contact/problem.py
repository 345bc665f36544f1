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
    SolidHeatCapacity,
    quantity,
)
from tehl.contact.bodies import reduced_radius
from tehl.contact.boundary_contact import THICKEST_BOUNDARY_FILM, THINNEST_BOUNDARY_FILM
from tehl.contact.exclusions import (
    check_dynamics,
    check_flooded,
    check_line,
    check_motion,
    check_roller,
    check_spin,
    check_stress,
    check_turning,
)
from tehl.contact.moment import courses_of
from tehl.contact.point_contact import PointContact
from tehl.contact.summits import GreenwoodTripp
from tehl.contact.transient import COURSES, MOTION
from tehl.lubricant.registered import package_of

SURFACES = ("surface_1", "surface_2")
THERMAL_PROPERTIES = {
    "density": quantity(SolidDensity),
    "heat_capacity": quantity(SolidHeatCapacity),
    "conductivity": quantity(SolidConductivity),
}


COLDEST_TEMPERATURE, HOTTEST_TEMPERATURE = 200.0, 800.0
"""Limits of the temperature of an oil or a solid [K]."""
LARGEST_RATIO = 1e3
"""Largest ratio of the reduced radii, either way: beyond it the contact is a line contact."""
LARGEST_SLIDING = 1e6
"""Largest sliding over the entrainment: bodies that move against each other entrain nearly nothing
from some 1e3 on."""


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
    check_flooded(problem)
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
    if not abs(problem.slide_roll_ratio) <= LARGEST_SLIDING:
        raise ValueError(
            f"contact.slide_roll_ratio = {problem.slide_roll_ratio:g} is (u_1 - u_2) over their "
            f"mean, at most {LARGEST_SLIDING:g}: check the speeds"
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
                'a bare number is in kelvin, "40 degC" is not'
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
    oil, needed = problem.lubricant, dict[str, tuple[object, Quantity]]()
    for key in SURFACES:
        surface = getattr(problem, key)
        for name in ("temperature", "thermal_resistance", "cooling"):
            if problem.thermal is None and getattr(surface, name) is not None:
                raise ValueError(
                    f"{key}.{name} has an effect in thermal runs only: add a [thermal] table, or "
                    "state lubricant.temperature for an isothermal film"
                )
        for name, wanted in THERMAL_PROPERTIES.items():
            needed[f"{key}.material.{name}"] = getattr(surface.material, name), wanted
    if problem.thermal is None:
        return
    needed["lubricant.conductivity"] = oil.conductivity, quantity(Conductivity)
    needed["lubricant.heat_capacity"] = oil.heat_capacity, quantity(HeatCapacity)
    missing = {key: wanted for key, (value, wanted) in needed.items() if value is None}
    if missing:
        (key, wanted), *others = missing.items()
        listed = ", ".join(f"{other} ({of.example})" for other, of in others)
        raise ValueError(
            f"{key} is missing, which a thermal run needs: give {wanted.name} such as "
            f"{wanted.example}" + (f"; missing too: {listed}" if others else "")
        )
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
    courses_of(problem)  # reads the values that have a unit


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
