"""What a contact cannot state together: each check raises `ValueError` with the physical reason."""

from tehl.base.units import SolidExpansion, quantity
from tehl.contact.bodies import direction
from tehl.contact.heat import LEAST_LINE
from tehl.contact.point_contact import PointContact
from tehl.contact.roller import LARGEST_TILT, Roller
from tehl.contact.stress import FAST_PECLET

SOLID_PART = (
    "solid contact adds a stiffness and a hysteresis of its own, and only those of the oil are "
    "computed"
)
"""Why stiffness and damping are not computed where surfaces touch."""
SPIN_OF_LINES = (
    "with spin the speed would change by spin times distance along the line, without end"
)
"""Why lines, and pieces of rollers that go on, do not spin."""
LARGEST_TURN = 0.8
"""Largest spin of a heated surface times a_y over its speed: beyond it rows of the contact have too
little speed along x for their heat to be followed from station to station."""
LEAST_LENGTH = 3.0
"""Least length of a roller over the width of its contact."""


def check_motion(problem: PointContact) -> None:
    """Check that sliding across the entrainment, and spin, go with the rest of the problem."""
    contact = problem.contact
    turned = [name for name in ("spin_1", "spin_2") if getattr(contact, name) != 0.0]
    turned += ["sliding_angle"] if direction(contact.sliding_angle)[1] != 0.0 else []
    if not turned:
        return
    supply, law = problem.supply, problem.asperities
    goes_on = contact.is_line or contact.ends != "open"
    one_is_rougher = problem.surface_1.rms_roughness != problem.surface_2.rms_roughness
    excluded = {
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
        'contact.type = "line"' if contact.is_line else f'contact.ends = "{contact.ends}"': (
            goes_on and turned != ["sliding_angle"],
            SPIN_OF_LINES,
        ),
        'contact.ends = "mirrored"': (
            contact.ends == "mirrored",
            "behind a mirror the surfaces would slide the other way along y; "
            'contact.ends = "periodic" has none',
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
    """Check that nothing follows oil along x alone where the mean motion spins."""
    if problem.contact.spin_1 + problem.contact.spin_2 != 0.0 and problem.dynamics is not None:
        raise ValueError(
            "contact.spin_1, spin_2 and dynamics exclude each other if the spins are not opposite: "
            "so far moving films are linearised along x alone"
        )


def check_flooded(problem: PointContact) -> None:
    """Check that the radius out to which there is oil is one, and that of a flooded contact."""
    radius, hertz = problem.contact.flooded_radius, problem.hertz
    if radius is None:
        return
    if problem.contact.has_lines:
        raise ValueError(
            "contact.flooded_radius belongs to ellipses that spin, which move oil far around the "
            "contact; lines and rollers do not: remove it"
        )
    if problem.supply is not None:
        raise ValueError(
            "contact.flooded_radius and supply exclude each other: the oil of a layer ends where "
            "the gap is as thick"
        )
    if radius < max(hertz.half_width_x, hertz.half_width_y):
        raise ValueError(
            f"contact.flooded_radius = {1e3 * radius:.3g} mm lies within the contact, whose "
            f"half-widths are {1e3 * hertz.half_width_x:.3g} and {1e3 * hertz.half_width_y:.3g} mm:"
            " state a larger one"
        )


def check_line(problem: PointContact) -> None:
    """Check that a line, or a piece of a roller that goes on, states nothing that needs ends."""
    contact = problem.contact
    kind = 'contact.type = "line"' if contact.is_line else f'contact.ends = "{contact.ends}"'
    if not contact.is_line and contact.ends == "open":
        return
    supply, thermal = problem.supply, problem.thermal
    resting = thermal is not None and any(problem.motion.speed_of(one) == 0.0 for one in (1, 2))
    aside = supply is not None and (
        supply.track is not None or (contact.is_line and supply.profile is not None)
    )
    profile = "profile, " if contact.is_line else ""
    computed = [
        f"surface_{index}.{key}"
        for index, surface in enumerate(problem.surfaces, 1)
        for key in ("thermal_resistance", "cooling")
        if getattr(surface, key) is not None
    ]
    excluded = {
        "supply": (
            aside,
            f"no oil flows aside, so {profile}track and passes have no effect; state layer or "
            "ratio",
        ),
        "thermal": (resting, "a surface at rest has no steady temperature under a line of heat"),
        " and ".join(computed): (
            bool(computed),
            "its track has no width; state the temperature of the body",
        ),
        "stress.thermal": (
            not contact.is_line and _has_slow_heat(problem),
            "so far the heat of bodies with a solid Peclet number below "
            f"{FAST_PECLET:g} is that of a whole contact",
        ),
    }
    for name, (is_stated, why) in excluded.items():
        if is_stated:
            raise ValueError(f"{kind} and {name} exclude each other: {why}")


def _has_slow_heat(problem: PointContact) -> bool:
    """Whether a thermal stress is that of a body whose heat runs ahead of the contact."""
    if problem.stress is None or not problem.stress.thermal:
        return False
    found = [problem.solid_peclet[body - 1] for body in problem.stress.bodies]
    return any(peclet is not None and abs(peclet) < FAST_PECLET for peclet in found)


def check_stress(problem: PointContact) -> None:
    """Check that the heat of a thermal stress is computed, and that the bodies expand by it."""
    stress = problem.stress
    if stress is None or not stress.thermal:
        return
    if problem.thermal is None:
        raise ValueError("stress.thermal = true needs the heat of the film: add [thermal]")
    if problem.transient is not None:
        raise ValueError(
            "stress.thermal = true and transient exclude each other: the bodies keep the heat of "
            "earlier times, and the fluxes of these are not kept"
        )
    for body in stress.bodies:
        if problem.surfaces[body - 1].material.expansion is None:
            raise ValueError(
                f"surface_{body}.material.expansion is missing, which stress.thermal needs: give "
                f"{quantity(SolidExpansion).name} such as {quantity(SolidExpansion).example}"
            )


def check_roller(problem: PointContact) -> None:
    """Check that a roller is longer than its contact is wide, and can carry its moment."""
    shape = problem.shape
    if not isinstance(shape, Roller) or shape.goes_on:
        return
    width = 2.0 * problem.hertz.half_width_x
    if not shape.length >= LEAST_LENGTH * width:
        raise ValueError(
            f"contact.length = {1e3 * shape.length:.4g} mm: less than {LEAST_LENGTH:g} times the "
            f"width of the contact, {1e3 * width:.4g} mm; rollers are longer, check length and load"
        )
    if shape.moment is not None:
        _check_moment(problem, shape, shape.moment)


def _check_moment(problem: PointContact, shape: Roller, moment: float) -> None:
    """Check that a roller can carry a moment of the load [N m], and that a tilt follows from it."""
    stated, most = f"contact.tilting_moment = {moment:.4g} N m", 0.5 * problem.load * shape.length
    if not abs(moment) < most:
        raise ValueError(
            f"{stated}: must be less than load times half the length, {most:.4g} N m, which the "
            "end of the roller alone would carry"
        )
    tilt = shape.under(problem.load, problem.radii, problem.reduced_modulus).tilt
    if not abs(tilt) < LARGEST_TILT * (1.0 - 1e-6):
        raise ValueError(
            f"{stated}: tilts the roller by more than {LARGEST_TILT:g} rad; check moment and load"
        )
    for name in ("transient", "contact_film"):
        if getattr(problem, name) is not None:
            raise ValueError(
                f"contact.tilting_moment and {name} exclude each other: so far the tilt follows in "
                "steady films between surfaces that do not touch; state contact.tilt"
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
