"""A contact: two surfaces, a lubricant, a load and a motion, and what follows from them in SI."""

import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import AfterValidator, model_validator

from tehl.base.table import Table
from tehl.base.units import (
    Angle,
    AngularVelocity,
    Direction,
    Force,
    ForcePerLength,
    Height,
    Length,
    Number,
    PositiveNumber,
    Pressure,
    Radius,
    Speed,
    Temperature,
    ThermalResistance,
)
from tehl.contact.bodies import Motion, Radii, reduced_radii, reduced_radius
from tehl.contact.boundary_contact import ContactFilm
from tehl.contact.cooling import Cooling
from tehl.contact.dynamics import Dynamics
from tehl.contact.heat import FilmEnergy, Thermal
from tehl.contact.hertz import HertzContact
from tehl.contact.materials import NamedSolid, reduced_modulus
from tehl.contact.profile import Profile, Tabulated
from tehl.contact.roller import Roller
from tehl.contact.shape import LINE, Ellipse, Shape
from tehl.contact.stress import Stress
from tehl.contact.summits import Asperities
from tehl.contact.supply import Cavitation, Supply
from tehl.contact.transient import Transient
from tehl.contact.velocities import Velocity, with_motion
from tehl.lubricant import NamedLubricant
from tehl.roughness import AnyRoughness, Smooth
from tehl.roughness.model import with_rms

LARGEST_TILT = 0.05
"""Largest tilt of a roller [rad]: real ones have 0.0001 to 0.005."""


class _WithRadii(Table):
    """Base of the tables that state one radius, or two of them."""

    FLAT: ClassVar[str] = ""
    """Hint of the message on a single one of both radii."""

    if TYPE_CHECKING:
        radius: float | None
        radius_x: float | None
        radius_y: float | None

    @model_validator(mode="after")
    def _radii_must_agree(self) -> Self:
        if self.radius is not None and (self.radius_x, self.radius_y) != (None, None):
            raise ValueError("takes either radius or the pair radius_x and radius_y")
        if (self.radius_x is None) != (self.radius_y is None):
            raise ValueError(f"needs both radius_x and radius_y{self.FLAT}")
        return self

    @property
    def radii(self) -> Radii | None:
        """Return the stated radii, None without any."""
        x = self.radius if self.radius_x is None else self.radius_x
        y = self.radius if self.radius_y is None else self.radius_y
        return None if x is None or y is None else Radii(x=x, y=y)


class Surface(_WithRadii):
    """One of the two bodies."""

    other_words: ClassVar = {"diameter": "did you mean radius, half of it?"}
    synonyms: ClassVar = {
        "rms_roughness": "rq sq sigma rms roughness_rms",
        "ra_roughness": "ra sa roughness_ra",
        "temperature": "temp bulk_temperature body_temperature",
        "thermal_resistance": "resistance r_th rth",
        "contact.entrainment_speed": "speed velocity",
        "material.young_modulus": "e young youngs_modulus elastic_modulus modulus young_modulus",
        "material.poisson_ratio": "nu poisson poissons_ratio poisson_ratio",
        "material.conductivity": "conductivity thermal_conductivity",
        "material.density": "density rho",
        "material.heat_capacity": "heat_capacity specific_heat",
    }
    not_tables: ClassVar = {
        "roughness": (
            "must be a table of heights; a number alone, for the ratio lambda, is rms_roughness "
            "or ra_roughness"
        )
    }

    FLAT = ' ("inf" is flat)'

    material: NamedSolid
    """A named material or a table of properties."""
    radius: Radius | None = None
    """Radius of a ball [m]."""
    radius_x: Radius | None = None
    radius_y: Radius | None = None
    """Radii along and across entrainment [m]; infinite is flat, negative is hollow."""
    rms_roughness: Height = 0.0
    """Rq [m], for lambda of a smooth calculation."""
    ra_roughness: Height | None = None
    """Ra [m], instead of Rq: of Gaussian heights, Rq = Ra sqrt(pi/2)."""
    roughness: AnyRoughness = Smooth()
    """Heights of the surface; smooth if left out."""
    temperature: Temperature | None = None
    """Temperature far from the contact [K], in thermal runs; None is that of the oil at the
    inlet."""
    thermal_resistance: ThermalResistance | None = None
    """Rise of that temperature over the oil at the inlet per heat that enters from the contact
    [K/W], instead of the temperature, which is then computed."""
    cooling: Cooling | None = None
    """A rotating body whose thermal resistance is estimated, instead of stating it."""

    @model_validator(mode="before")
    @classmethod
    def _convert_ra(cls, stated: Any) -> Any:
        return with_rms(stated, "ra_roughness", "rms_roughness")

    @model_validator(mode="after")
    def _must_be_warm_once(self) -> Self:
        keys = ("temperature", "thermal_resistance", "cooling")
        stated = [key for key in keys if getattr(self, key) is not None]
        if len(stated) > 1:
            raise ValueError(
                f"states {' and '.join(stated)}: the temperature of the body is given, or follows "
                "from its heat; leave one of them out"
            )
        return self

    @model_validator(mode="after")
    def _must_be_rough_once(self) -> Self:
        if self.rms_roughness > 0 and not self.roughness.is_smooth:
            raise ValueError(
                "states rms_roughness, which is that of a surface computed as smooth, and "
                "roughness: leave one of them out"
            )
        return self


class Contact(_WithRadii):
    """Shape, load and motion of the contact."""

    other_words: ClassVar = {
        "width": 'a roller has type = "roller" and length, a contact without ends type = "line"',
        "speed": "did you mean entrainment_speed, the mean speed of both surfaces?",
        "sliding_speed": "did you mean slide_roll_ratio, (u_1 - u_2) over the mean speed?",
        **dict.fromkeys(
            ("spin", "spin_speed", "omega", "spin_ratio"),
            "did you mean spin_1 and spin_2, the angular velocities of both surfaces about the "
            'normal of the contact, such as "300 rpm"?',
        ),
        "diameter": "did you mean radius, half of it?",
    }
    synonyms: ClassVar = {
        "load": "force normal_load normal_force weight w f",
        "load_per_length": "line_load unit_load specific_load w_l",
        "hertz_pressure": "pressure max_pressure maximum_pressure hertz_stress p_h",
        "entrainment_speed": "velocity mean_speed rolling_speed rolling_velocity u_m u",
        "slide_roll_ratio": "srr slip slide_ratio sliding_ratio slide_to_roll",
        "sliding_angle": "slip_angle sliding_direction skew_angle",
        "spin_1": "omega_1 spin_speed_1",
        "spin_2": "omega_2 spin_speed_2",
        "radius_x": "rx r_x radius_1",
        "radius_y": "ry r_y radius_2",
        "radius": "r",
        "entrainment_angle": "angle entrainment_direction theta",
        "length": "effective_length l_we roller_length",
        "tilt": "misalignment misalignment_angle",
        "lubricant.temperature": "temperature oil_temperature",
    }

    type: Literal["point", "line", "roller"] = "point"
    """A circle or an ellipse; a line without ends: then nothing changes across the entrainment, and
    forces and powers are those of one metre; or a roller of finite ``length``."""
    radius: Length | None = None
    """Reduced radius of a circular contact, or along the entrainment of a line or a roller [m]."""
    radius_x: Length | None = None
    radius_y: Length | None = None
    """Reduced radii along and across entrainment [m]. Without any radius here both surfaces state
    theirs."""
    length: Length | None = None
    """Of a roller [m]: that on which it touches its raceway, without chamfers."""
    profile: Profile | None = None
    """How far a roller drops towards its ends; None is straight."""
    tilt: Angle = 0.0
    """Angle between the axes of a roller and its raceway, by which the gap opens along y [rad]."""
    load: Force | None = None
    load_per_length: ForcePerLength | None = None
    hertz_pressure: Pressure | None = None
    moes_load: PositiveNumber | None = None
    """Exactly one: w [N], in a line contact w [N/m], p_h [Pa] or M [-]."""
    entrainment_speed: Speed | None = None
    moes_speed: PositiveNumber | None = None
    """Exactly one: u_m [m/s] or L [-]."""
    entrainment_angle: Direction = 0.0
    """Angle from the axis of radius_x to the entrainment, counter-clockwise [rad]; radii, of the
    surfaces too, are those along the axes of the ellipse, while x is along the entrainment."""
    slide_roll_ratio: Number = 0.0
    """(u_1 - u_2) / u_m [-]."""
    sliding_angle: Direction = 0.0
    """Direction of u_1 - u_2 from that of the entrainment, counter-clockwise [rad]."""
    velocity_1: Velocity | None = None
    velocity_2: Velocity | None = None
    """Velocities of both surfaces at the centre along the axes of radius_x and radius_y [m/s], in
    place of entrainment speed and angle, slide-roll ratio and sliding angle."""
    spin_1: AngularVelocity = 0.0
    spin_2: AngularVelocity = 0.0
    """Angular velocities of the surfaces about z, counter-clockwise [rad/s]; speeds are those at
    the centre."""

    @model_validator(mode="before")
    @classmethod
    def _convert_velocities(cls, stated: Any) -> Any:
        return with_motion(stated)

    @model_validator(mode="after")
    def _must_be_stated_once(self) -> Self:
        own, other = ("load_per_length", "load") if self.is_line else ("load", "load_per_length")
        if getattr(self, other) is not None:
            raise ValueError(f"states {other}: a {self.type} contact takes {own}")
        if self.has_lines and self.radius_x is not None:
            raise ValueError(f"states radius_x and radius_y: a {self.type} contact takes radius")
        self._check_roller()
        if self.has_lines and self.entrainment_angle != 0.0:
            key = "entrainment_angle" if self.velocity_1 is None else "velocities at an angle to x"
            raise ValueError(
                f"states {key}: along a line contact nothing changes, so only the speed "
                "across it makes a film; state that alone"
            )
        self._exactly_one(own, "hertz_pressure", "moes_load")
        self._exactly_one("entrainment_speed", "moes_speed")
        return self

    def _check_roller(self) -> None:
        """Check that a roller has a length, and no other contact what rollers have."""
        if self.type != "roller":
            stated = [name for name in ("length", "profile", "tilt") if getattr(self, name)]
            if stated:
                raise ValueError(
                    f'states {" and ".join(stated)}: only a contact with type = "roller" has ends'
                )
            return
        if self.length is None:
            raise ValueError('needs length, on which the roller touches, such as "10 mm"')
        if not abs(self.tilt) <= LARGEST_TILT:
            raise ValueError(
                f"states tilt = {self.tilt:g} rad: rollers tilt by some 0.001 rad; a bare number "
                'is in radians, write "0.05 deg"'
            )
        fault = self.profile.fault(self.length) if isinstance(self.profile, Tabulated) else ""
        if fault:
            raise ValueError(f"states profile.{fault}")

    @property
    def is_line(self) -> bool:
        """Whether it is a line contact."""
        return self.type == "line"

    @property
    def has_lines(self) -> bool:
        """Whether it is a line contact or a roller, with a radius along the entrainment alone."""
        return self.type != "point"

    def _exactly_one(self, *names: str) -> None:
        stated = [name for name in names if getattr(self, name) is not None]
        if len(stated) > 1:
            raise ValueError(f"states {' and '.join(stated)}: only one of them may be given")
        if not stated:
            raise ValueError(f"needs one of {', '.join(names)}")


def _printable(title: str) -> str:
    if not title.isprintable():
        raise ValueError("must be one line without control characters")
    return title


Title = Annotated[str, AfterValidator(_printable)]


class PointContact(Table):
    """A lubricated contact as its tables state it; `ContactProblem` checks that they agree.

    Derived quantities in SI are properties.
    """

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
        if self.contact.has_lines:
            return Radii(x=reduced_radius(first.x, second.x), y=math.inf)
        return reduced_radii(first, second)

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
            return Roller(length=contact.length, profile=contact.profile, tilt=contact.tilt)
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
    def inlet_temperature(self) -> float:
        """Return the temperature of the oil at the inlet [K], stated or that of the viscosity."""
        in_table = self.thermal.temperature if self.thermal else None
        for stated in (in_table, self.lubricant.temperature):
            if stated is not None:
                return stated
        return self.lubricant.viscosity.reference_temperature

    @property
    def heat(self) -> FilmEnergy | None:
        """Return the heat problem of the film, None if it is isothermal."""
        if self.thermal is None:
            return None
        inlet, first = self.inlet_temperature, self.surface_1.temperature
        second = self.surface_2.temperature
        return FilmEnergy(
            temperature=inlet,
            bulk_1=inlet if first is None else first,
            bulk_2=inlet if second is None else second,
            reynolds=self.thermal.reynolds,
            layers=self.thermal.nodes,
            scheme=self.thermal.scheme,
            sources="line" if self.transient is not None else self.thermal.sources,
        )

    @property
    def resistances(self) -> tuple[float | None, float | None]:
        """Return the thermal resistances of both bodies [K/W]; None where none is stated.

        Raises ValueError if the estimate of a rotating body does not hold.
        """
        motion = self.motion
        first = self._resistance("surface_1", motion.speed_1)
        return first, self._resistance("surface_2", motion.speed_2)

    def _resistance(self, key: str, speed: float) -> float | None:
        surface: Surface = getattr(self, key)
        if surface.cooling is None:
            return surface.thermal_resistance
        try:
            return surface.cooling.resistance(surface.material, speed, self.hertz.half_width_y)
        except ValueError as error:
            raise ValueError(f"{key}.cooling {error}; or state {key}.thermal_resistance") from None

    @property
    def computes_bodies(self) -> bool:
        """Whether the temperature of a body follows from its heat."""
        surfaces = (self.surface_1, self.surface_2)
        return any(one.thermal_resistance is not None or one.cooling for one in surfaces)

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
        first, second = (one.material.diffusivity for one in (self.surface_1, self.surface_2))
        return (
            None if first is None else motion.speed_1 * half_width / first,
            None if second is None else motion.speed_2 * half_width / second,
        )

    @property
    def rms_roughness(self) -> float:
        """Return the stated roughness of both surfaces together, sqrt(Rq_1^2 + Rq_2^2) [m]."""
        return math.hypot(self.surface_1.rms_roughness, self.surface_2.rms_roughness)

    @property
    def asperity_rms(self) -> float:
        """Return sigma of the asperities finer than the grid, zero without [m]."""
        if self.asperities is None:
            return 0.0
        stated = self.asperities.rms
        return self.rms_roughness if stated is None else stated

    @property
    def is_rough(self) -> bool:
        """Whether a surface has heights."""
        return not (self.surface_1.roughness.is_smooth and self.surface_2.roughness.is_smooth)

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
    def has_passes(self) -> bool:
        """Whether the same surfaces pass the contact repeatedly."""
        return self.supply is not None and self.supply.passes is not None

    @property
    def conserves_oil(self) -> bool:
        """Whether oil is conserved in cavities."""
        stated = self.cavitation is not None and self.cavitation.model == "conserving"
        return stated or self.supply is not None
