"""A contact: two surfaces, a lubricant, a load and a motion, and what follows from them in SI."""

import math
from typing import Annotated, Self

from pydantic import AfterValidator

from tehl.base.table import Table
from tehl.contact.bodies import Motion, Radii, reduced_radius
from tehl.contact.boundary_contact import ContactFilm
from tehl.contact.cooling import OF_ELLIPSE, OF_ROLLER
from tehl.contact.dynamics import Dynamics
from tehl.contact.heat import HOT_LOADING, FilmEnergy, Thermal, rubbing_parts
from tehl.contact.hertz import HertzContact
from tehl.contact.materials import reduced_modulus
from tehl.contact.roller import Roller
from tehl.contact.shape import LINE, Ellipse, Shape
from tehl.contact.stress import Stress
from tehl.contact.summits import Asperities
from tehl.contact.supply import Cavitation, Supply
from tehl.contact.tables import Contact, Surface
from tehl.contact.transient import Transient
from tehl.lubricant import NamedLubricant


def _printable(title: str) -> str:
    if not title.isprintable():
        raise ValueError("must be one line without control characters")
    return title


Title = Annotated[str, AfterValidator(_printable)]


class LubricatedPair(Table):
    """Two bodies under a load and in motion, and the oil between them."""

    title: Title = ""
    """Shown in reports and pictures."""
    contact: Contact
    """Shape, load and motion."""
    surface_1: Surface
    surface_2: Surface
    """The bodies at z = 0 and z = h."""
    lubricant: NamedLubricant
    """A named oil or its laws."""
    thermal: Thermal | None = None
    """Settings of the heat; None is an isothermal film."""

    @property
    def surfaces(self) -> tuple[Surface, Surface]:
        """Return both bodies."""
        return self.surface_1, self.surface_2

    @property
    def radii(self) -> Radii:
        """Return the reduced radii, and the twist, along and across the entrainment."""
        return self.radii_of_axes.turned(self.contact.entrainment_angle)

    @property
    def radii_of_axes(self) -> Radii:
        """Return the reduced radii along the axes of the ellipse; one of a line is infinite."""
        first, second = self.surface_1.radii, self.surface_2.radii
        if self.contact.is_line and self.contact.radii is not None:
            return Radii(x=self.contact.radii.x, y=math.inf)
        if self.contact.radii is not None:
            return self.contact.radii
        if first is None or second is None:
            raise ValueError("no radii")
        x = reduced_radius(first.x, second.x)
        if self.contact.has_lines:
            return Radii(x=x, y=math.inf)
        return Radii(x=x, y=reduced_radius(first.y, second.y))

    @property
    def radius_x(self) -> float:
        """Return the reduced radius along entrainment R_x [m]."""
        return self.radii.x

    @property
    def radius_y(self) -> float:
        """Return the reduced radius across entrainment R_y [m]."""
        return self.radii.y

    @property
    def shape(self) -> Shape:
        """Return the shape of the contact."""
        if self.contact.is_line:
            return LINE
        contact = self.contact
        if contact.length is not None:
            return Roller(
                length=contact.length,
                profile=contact.profile,
                tilt=contact.tilt,
                goes_on=contact.ends != "open",
                wraps=contact.ends == "periodic",
                moment=contact.tilting_moment,
            )
        return Ellipse.of(self.radii)

    @property
    def reduced_modulus(self) -> float:
        """Return E' with ``2/E' = (1-nu_1^2)/E_1 + (1-nu_2^2)/E_2`` [Pa]."""
        return reduced_modulus(self.surface_1.material, self.surface_2.material)

    @property
    def ambient_viscosity(self) -> float:
        """Return eta_0 at ambient pressure and inlet temperature [Pa s]."""
        return self.lubricant.viscosity.ambient(self.inlet_temperature)

    @property
    def ambient_density(self) -> float:
        """Return rho_0 at ambient pressure and inlet temperature [kg/m^3]."""
        return self.lubricant.density.ambient(self.inlet_temperature)

    @property
    def pressure_coefficient(self) -> float:
        """Return alpha, the slope of ln eta at ambient pressure and inlet temperature [1/Pa]."""
        return self.lubricant.viscosity.pressure_coefficient_at(self.inlet_temperature)

    @property
    def temperature_coefficient(self) -> float:
        """Return -d ln eta / dT at ambient pressure and inlet temperature [1/K]."""
        return self.lubricant.viscosity.temperature_coefficient_at(self.inlet_temperature)

    @property
    def thermal_loading(self) -> float | None:
        """Return the thermal loading parameter ``eta_0 b u_m^2 / k`` at the inlet [-].

        b is -d(ln eta)/dT. None if the case states no conductivity or no temperature coefficient of
        the oil.
        """
        coefficient, conductivity = (
            self.temperature_coefficient,
            self.lubricant.ambient_conductivity,
        )
        if conductivity is None or not coefficient > 0:
            return None
        return self.ambient_viscosity * coefficient * self.entrainment_speed**2 / conductivity

    @property
    def has_hot_inlet(self) -> bool:
        """Whether the oil that flows back in the inlet is much hotter than the oil that enters."""
        return self.thermal is not None and (self.thermal_loading or 0.0) > HOT_LOADING

    @property
    def inlet_temperature(self) -> float:
        """Return the temperature of the oil at the inlet [K], stated or that of the viscosity."""
        in_table = self.thermal.temperature if self.thermal else None
        for stated in (in_table, self.lubricant.temperature):
            if stated is not None:
                return stated
        return self.lubricant.viscosity.reference_temperature

    @property
    def resistances(self) -> tuple[float | None, float | None]:
        """Return the thermal resistances of both bodies [K/W]; None where none is stated.

        Raises ValueError if the estimate of a rotating body does not hold.
        """
        speeds = (math.hypot(*self.motion.velocity_of(number)) for number in (1, 2))
        first, second = (
            self._resistance(f"surface_{number}", speed) for number, speed in enumerate(speeds, 1)
        )
        return first, second

    def _resistance(self, key: str, speed: float) -> float | None:
        surface: Surface = getattr(self, key)
        if surface.cooling is None:
            return surface.thermal_resistance
        try:
            variance = OF_ROLLER if self.shape.as_line else OF_ELLIPSE
            width = self.hertz.half_width_y
            return surface.cooling.resistance(surface.material, speed, width, variance)
        except ValueError as error:
            raise ValueError(f"{key}.cooling {error}; or state {key}.thermal_resistance") from None

    @property
    def computes_bodies(self) -> bool:
        """Whether the temperature of a body follows from its heat."""
        return any(one.thermal_resistance is not None or one.cooling for one in self.surfaces)

    def with_bodies(self, first: float | None, second: float | None) -> Self:
        """Return the same contact between bodies of stated temperatures.

        Parameters
        ----------
        first, second : float
            Temperatures of surface 1 and 2 far from the contact [K]; None is that of the oil.
        """
        nothing = {"thermal_resistance": None, "cooling": None}
        surfaces = {
            "surface_1": self.surface_1.model_copy(update={"temperature": first} | nothing),
            "surface_2": self.surface_2.model_copy(update={"temperature": second} | nothing),
        }
        return self.model_copy(update=surfaces)

    @property
    def is_coupled(self) -> bool:
        """Whether heat or shear thinning affect the flow."""
        return self.thermal is not None or not self.lubricant.shear.is_newtonian

    @property
    def speed_group(self) -> float:
        """Return U = eta_0 u_m / (E' R_x) [-]."""
        if self.contact.moes_speed is not None:
            return 0.5 * (self.contact.moes_speed / self.material_group) ** 4
        speed = self.contact.entrainment_speed or math.nan
        return self.ambient_viscosity * speed / (self.reduced_modulus * self.radius_x)

    @property
    def material_group(self) -> float:
        """Return G = alpha E' [-]."""
        return self.pressure_coefficient * self.reduced_modulus

    @property
    def entrainment_speed(self) -> float:
        """Return u_m = (u_1 + u_2)/2 [m/s], stated or from the Moes L."""
        if self.contact.entrainment_speed is not None:
            return self.contact.entrainment_speed
        return self.speed_group * self.reduced_modulus * self.radius_x / self.ambient_viscosity

    @property
    def load(self) -> float:
        """Return the normal load w [N], stated or from the Hertz pressure or the Moes M.

        That of a line contact is the load of one metre.
        """
        stated = self.contact.load_per_length if self.contact.is_line else self.contact.load
        if stated is not None:
            return stated
        if self.contact.hertz_pressure is not None:
            pressure = self.contact.hertz_pressure
            return self.shape.load_of_pressure(pressure, self.radii, self.reduced_modulus)
        load_group = (self.contact.moes_load or math.nan) * (
            2.0 * self.speed_group
        ) ** self.shape.speed_power
        return load_group * self.shape.load_unit(self.radius_x, self.reduced_modulus)

    @property
    def slide_roll_ratio(self) -> float:
        """Return (u_1 - u_2) / u_m [-]."""
        return self.contact.slide_roll_ratio

    @property
    def motion(self) -> Motion:
        """Return the speeds of both surfaces."""
        return Motion(
            entrainment_speed=self.entrainment_speed,
            slide_roll_ratio=self.slide_roll_ratio,
            sliding_angle=self.contact.sliding_angle,
            spin_1=self.contact.spin_1,
            spin_2=self.contact.spin_2,
        )

    @property
    def sliding_speed(self) -> float:
        """Return a typical size of u_1 - u_2 in the contact, with that of spin [m/s]."""
        motion = self.motion
        if motion.spin_1 == motion.spin_2:
            return abs(motion.sliding_speed)
        reach = 2.0 / 3.0 * math.sqrt(self.hertz.half_width_x * self.hertz.half_width_y)
        return math.hypot(motion.sliding_speed, reach * (motion.spin_1 - motion.spin_2))

    @property
    def hertz(self) -> HertzContact:
        """Return the dry contact under the same load."""
        return self.shape.hertz(self.load, self.radii, self.reduced_modulus)

    @property
    def solid_peclet(self) -> tuple[float | None, float | None]:
        """Return ``u_s a_x / (2 diffusivity)`` of both solids [-], signed; None if not stated."""
        motion, half_width = self.motion, 0.5 * self.hertz.half_width_x
        first, second = (one.material.diffusivity for one in self.surfaces)
        return (
            None if first is None else motion.speed_1 * half_width / first,
            None if second is None else motion.speed_2 * half_width / second,
        )

    @property
    def rubbing_parts(self) -> tuple[float, float]:
        """Return the parts of the heat of rubbing that both solids take [-]."""
        conductivities = [one.material.conductivity or 0.0 for one in self.surfaces]
        return rubbing_parts(conductivities, self.solid_peclet)

    @property
    def shortest_wavelengths(self) -> tuple[float, float]:
        """Return the shortest waves of both surfaces along x and along y [m]."""
        waves = (one.roughness.shortest_wavelengths for one in self.surfaces)
        along, across = (min(pair) for pair in zip(*waves, strict=True))
        return along, across

    @property
    def rms_roughness(self) -> float:
        """Return the stated roughness of both surfaces together, sqrt(Rq_1^2 + Rq_2^2) [m]."""
        return math.hypot(self.surface_1.rms_roughness, self.surface_2.rms_roughness)

    @property
    def is_rough(self) -> bool:
        """Whether a surface has heights."""
        return not all(one.roughness.is_smooth for one in self.surfaces)


class PointContact(LubricatedPair):
    """A lubricated contact as its tables state it; `ContactProblem` checks that they agree.

    Derived quantities in SI are properties.
    """

    transient: Transient | None = None
    """Settings of a transient run, in which roughness moves with its surface; None is steady."""
    supply: Supply | None = None
    """The oil that reaches the inlet; None is fully flooded."""
    asperities: Asperities | None = None
    """Asperities finer than the grid; None has none."""
    contact_film: ContactFilm | None = None
    """Boundary film through which the surfaces may touch; None has no contact."""
    cavitation: Cavitation | None = None
    """What happens to the oil in cavities; None conserves it in starved contacts only."""
    stress: Stress | None = None
    """Settings of the stress below the surfaces; None does not compute it."""
    dynamics: Dynamics | None = None
    """Frequencies of the stiffness and damping of the film; None does not compute them."""

    @property
    def bulk_temperatures(self) -> tuple[float, float]:
        """Return the temperatures of both bodies, that of the inlet if not stated [K]."""
        inlet = self.inlet_temperature
        stated = self.surface_1.temperature, self.surface_2.temperature
        first, second = (inlet if one is None else one for one in stated)
        return first, second

    @property
    def heat(self) -> FilmEnergy | None:
        """Return the heat problem of the film, None if it is isothermal."""
        if self.thermal is None:
            return None
        first, second = self.bulk_temperatures
        return FilmEnergy(
            temperature=self.inlet_temperature,
            bulk_1=first,
            bulk_2=second,
            reynolds=self.thermal.reynolds,
            layers=self.thermal.nodes(self.thermal_loading or 0.0),
            scheme=self.thermal.scheme,
            sources="line" if self.transient is not None else self.thermal.sources,
        )

    @property
    def asperity_rms(self) -> float:
        """Return sigma of the asperities finer than the grid, zero without [m]."""
        if self.asperities is None:
            return 0.0
        stated = self.asperities.rms
        return self.rms_roughness if stated is None else stated

    @property
    def is_even_in_y(self) -> bool:
        """Whether the problem is symmetric in y, so that half of the domain suffices."""
        if self.contact.is_line:
            return True
        if self.radii.twist or not self.motion.is_plain:
            return False
        supply = self.supply is None or self.supply.is_even_in_y
        surfaces, shape = (self.surface_1.roughness, self.surface_2.roughness), self.shape
        if isinstance(shape, Roller) and not shape.is_even:
            return False
        return supply and all(roughness.is_even_in_y for roughness in surfaces)

    @property
    def has_tilting_moment(self) -> bool:
        """Whether it is a roller, and its load has a moment about x."""
        has_ends = self.contact.type == "roller" and self.contact.ends == "open"
        return has_ends and not self.is_even_in_y

    @property
    def has_passes(self) -> bool:
        """Whether the same surfaces pass the contact repeatedly."""
        return self.supply is not None and self.supply.passes is not None

    @property
    def conserves_oil(self) -> bool:
        """Whether oil is conserved in cavities."""
        stated = self.cavitation is not None and self.cavitation.model == "conserving"
        return stated or self.supply is not None
