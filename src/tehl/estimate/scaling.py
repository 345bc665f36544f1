"""Scales of a contact, which make it dimensionless, and its dimensionless groups."""

import math
from dataclasses import dataclass, replace

from tehl.contact.moment import Moment, moment_at
from tehl.contact.problem import ContactProblem
from tehl.contact.roller import Roller
from tehl.contact.shape import LINE, Ellipse, Shape

CIRCULAR = 0.1
"""Largest difference of the ratio of the radii from one, for tables of circular contacts."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Scales:
    """One unit of each dimensionless quantity in SI."""

    half_width_x: float
    half_width_y: float
    """Hertz half-widths a_x, a_y [m]."""
    hertz_pressure: float
    """p_h [Pa]."""
    film_thickness: float
    """a_x^2 / R_x [m]."""
    viscosity: float
    density: float
    """eta_0 [Pa s] and rho_0 [kg/m^3] at ambient pressure and inlet temperature."""
    speed: float
    """Entrainment speed u_m [m/s]."""
    load: float
    """Normal load w [N]."""
    temperature: float
    """Inlet temperature [K]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Groups:
    """Dimensionless groups."""

    M: float
    L: float
    """Moes load and speed (lubricant) parameter."""
    U: float
    G: float
    """Speed and material of Hamrock and Dowson, with the mean speed and R_x."""
    lambda_bar: float
    """12 eta_0 u_m R_x^2 / (a_x^3 p_h)."""
    alpha_bar: float
    """alpha p_h."""
    ellipticity: float
    """kappa = a_y / a_x."""
    radius_ratio: float
    """D = R_x / R_y."""
    deflection_factor: float
    """2 Pi / pi with Pi = p_h R_x / (E' a_x): the factor before the kernel sum (circle 2/pi^2)."""
    skew: float = 0.0
    twist: float = 0.0
    """Of an ellipse at an angle to the entrainment, as of `tehl.contact.shape.Ellipse`."""

    roller: Roller | None = None
    """The roller under its load, if it is one."""

    @property
    def W(self) -> float:  # noqa: N802 (as in the literature)
        """The load of Hamrock and Dowson."""
        return self.M * (2.0 * self.U) ** self.shape.speed_power

    @property
    def shape(self) -> Shape:
        """The shape of the contact."""
        if self.roller is not None:
            return self.roller
        if self.radius_ratio == 0.0:
            return LINE
        return Ellipse(
            ellipticity=self.ellipticity,
            radius_ratio=self.radius_ratio,
            skew=self.skew,
            twist=self.twist,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaledProblem:
    """A contact in SI together with its scales and dimensionless groups.

    Made once at the start of a run and passed down, so that nothing is scaled twice.
    """

    problem: ContactProblem
    scales: Scales
    groups: Groups
    moment: Moment
    """Load, motion and radius: those of the contact, or of a transient run at its start."""
    flooded_oil: float | None = None
    """rho H in the middle of the same contact fully flooded [-]; None is that of the formula."""
    flooded_error: float = 0.0
    """Its relative error bar [-]."""

    @classmethod
    def of(cls, problem: ContactProblem) -> "ScaledProblem":
        """Scale a problem."""
        return cls(
            problem=problem,
            scales=scales(problem),
            groups=groups(problem),
            moment=moment_at(problem, 0.0),
        )

    @property
    def entering(self) -> Groups:
        """The groups with the viscosity of the oil that enters the contact.

        Along the bodies it has taken their temperature; the film formulas and the far field follow.
        """
        factor = _body_viscosity(self.problem)
        return self.groups if factor == 1.0 else _with_viscosity(self.groups, factor)


def scales(problem: ContactProblem) -> Scales:
    """Return one unit of each dimensionless quantity of ``problem`` in SI."""
    hertz = problem.hertz
    return Scales(
        half_width_x=hertz.half_width_x,
        half_width_y=hertz.half_width_y,
        hertz_pressure=hertz.pressure,
        film_thickness=hertz.half_width_x**2 / problem.radius_x,
        viscosity=problem.ambient_viscosity,
        density=problem.ambient_density,
        speed=problem.entrainment_speed,
        load=problem.load,
        temperature=problem.inlet_temperature,
    )


def groups(problem: ContactProblem) -> Groups:
    """Return the dimensionless groups of ``problem``."""
    hertz, modulus, radius = problem.hertz, problem.reduced_modulus, problem.radius_x
    speed, material = problem.speed_group, problem.material_group
    shape = problem.shape
    load = problem.load / shape.load_unit(radius, modulus)
    viscous = 12.0 * problem.ambient_viscosity * problem.entrainment_speed
    return Groups(
        roller=(
            shape.under(problem.load, problem.radii, modulus) if isinstance(shape, Roller) else None
        ),
        M=load * (2.0 * speed) ** -shape.speed_power,
        L=material * (2.0 * speed) ** 0.25,
        U=speed,
        G=material,
        lambda_bar=viscous * radius**2 / (hertz.half_width_x**3 * hertz.pressure),
        alpha_bar=problem.pressure_coefficient * hertz.pressure,
        ellipticity=hertz.ellipticity,
        radius_ratio=radius / problem.radius_y,
        deflection_factor=2.0 * hertz.pressure * radius / (math.pi * modulus * hertz.half_width_x),
        skew=hertz.skew,
        twist=shape.twist if isinstance(shape, Ellipse) else 0.0,
    )


def _body_viscosity(problem: ContactProblem) -> float:
    """Return the viscosity of the oil at the temperatures of the bodies, over that at the inlet."""
    bulk = problem.bulk_temperatures
    if problem.thermal is None or bulk[0] == bulk[1] == problem.inlet_temperature:
        return 1.0
    first, second = map(float, map(problem.lubricant.viscosity.ambient, bulk))
    return math.sqrt(first * second) / problem.ambient_viscosity


def _with_viscosity(known: Groups, factor: float) -> Groups:
    """Return the groups of the same contact with ``factor`` times the viscosity."""
    return replace(
        known,
        M=known.M * factor**-known.shape.speed_power,
        L=known.L * factor**0.25,
        U=known.U * factor,
        lambda_bar=known.lambda_bar * factor,
    )
