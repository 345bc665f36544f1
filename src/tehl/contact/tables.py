"""The tables of a case that state a contact: its two surfaces, its load and its motion."""

from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from pydantic import model_validator

from tehl.base.table import Table
from tehl.base.units import (
    Angle,
    AngularVelocity,
    Direction,
    Force,
    ForcePerLength,
    Height,
    Length,
    Moment,
    Number,
    PositiveNumber,
    Pressure,
    Radius,
    Speed,
    Temperature,
    ThermalResistance,
)
from tehl.contact.bodies import Radii
from tehl.contact.cooling import Cooling
from tehl.contact.materials import NamedSolid
from tehl.contact.profile import Profile, Tabulated
from tehl.contact.roller import LARGEST_TILT, Ends
from tehl.contact.velocities import Velocity, with_motion
from tehl.roughness import AnyRoughness, Smooth
from tehl.roughness.model import with_rms


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
        if (self.radius_x, self.radius_y) == (None, None):
            return self
        self._check_pair()
        if self.radius is not None:
            raise ValueError("takes either radius or the pair radius_x and radius_y")
        if (self.radius_x is None) != (self.radius_y is None):
            raise ValueError(f"needs both radius_x and radius_y{self.FLAT}")
        return self

    def _check_pair(self) -> None:
        """Check that radii along and across the entrainment apply."""

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


class ContactShape(_WithRadii):
    """Shape of the contact: a circle, an ellipse, a line or a roller."""

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
    ends: Ends = "open"
    """Of a roller: those of its length; mirrors, behind which it goes on, film and roughness too;
    or periodic, where it goes on with the film and roughness of the other end: a piece of a gear
    tooth or of a long roller."""
    profile: Profile | None = None
    """How far a roller drops towards its ends; None is straight."""
    tilt: Angle = 0.0
    """Angle between the axes of a roller and its raceway, by which the gap opens along y [rad]."""
    tilting_moment: Moment | None = None
    """Moment of the load of a roller about x [N m], positive if positive y carries more, in place
    of the tilt, which then follows; zero aligns the roller."""

    def _check_pair(self) -> None:
        if self.has_lines:
            stated = " and ".join(self._stated("radius_x", "radius_y"))
            raise ValueError(f"states {stated}: a {self.type} contact takes radius")

    @model_validator(mode="after")
    def _must_have_its_shape(self) -> Self:
        if self.type == "roller":
            self._check_roller()
        elif stated := self._stated("length", "profile", "tilt", "tilting_moment", "ends"):
            raise ValueError(
                f'states {" and ".join(stated)}: only a contact with type = "roller" has ends'
            )
        return self

    def _check_roller(self) -> None:
        """Check that a roller has a length, and one statement of its tilt and ends."""
        if self.length is None:
            raise ValueError('needs length, on which the roller touches, such as "10 mm"')
        stated = self._stated("profile", "tilt", "tilting_moment")
        if stated and self.ends != "open":
            raise ValueError(
                f'states ends = "{self.ends}" and {" and ".join(stated)}: a piece that goes on is '
                "straight; state one of them"
            )
        if not abs(self.tilt) <= LARGEST_TILT:
            raise ValueError(
                f"states tilt = {self.tilt:g} rad: rollers tilt by some 0.001 rad; a bare number "
                'is in radians, write "0.05 deg"'
            )
        if self.tilt != 0.0 and self.tilting_moment is not None:
            raise ValueError(
                "states tilt and tilting_moment: the tilt is given, or follows from the moment of "
                "the load; leave one of them out"
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

    def _stated(self, *names: str) -> list[str]:
        known = type(self).model_fields
        return [name for name in names if getattr(self, name) != known[name].default]

    def _exactly_one(self, *names: str) -> None:
        stated = [name for name in names if getattr(self, name) is not None]
        if len(stated) > 1:
            raise ValueError(f"states {' and '.join(stated)}: only one of them may be given")
        if not stated:
            raise ValueError(f"needs one of {', '.join(names)}")


class LoadedContact(ContactShape):
    """Shape of the contact, and what presses it together."""

    load: Force | None = None
    load_per_length: ForcePerLength | None = None
    hertz_pressure: Pressure | None = None
    moes_load: PositiveNumber | None = None
    """Exactly one: w [N], in a line contact w [N/m], p_h [Pa] or M [-]."""

    @model_validator(mode="after")
    def _must_be_loaded_once(self) -> Self:
        own, other = ("load_per_length", "load") if self.is_line else ("load", "load_per_length")
        if getattr(self, other) is not None:
            raise ValueError(f"states {other}: a {self.type} contact takes {own}")
        self._exactly_one(own, "hertz_pressure", "moes_load")
        return self


class Contact(LoadedContact):
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
        "radius_1": "radii of [contact] are those of both surfaces together; did you mean "
        "surface_1.radius?",
        "radius_2": "radii of [contact] are those of both surfaces together; did you mean "
        "surface_2.radius?",
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
        "flooded_radius": "oil_radius pool_radius bath_radius",
        "radius_x": "rx r_x",
        "radius_y": "ry r_y",
        "radius": "r",
        "entrainment_angle": "angle entrainment_direction theta",
        "length": "effective_length l_we roller_length",
        "tilt": "misalignment misalignment_angle",
        "tilting_moment": "moment tilt_moment misalignment_moment",
        "lubricant.temperature": "temperature oil_temperature",
    }

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
    flooded_radius: Length | None = None
    """Radius out to which there is oil around an ellipse that spins [m]; without it the smaller of
    both radii of curvature."""

    @model_validator(mode="before")
    @classmethod
    def _convert_velocities(cls, stated: Any) -> Any:
        return with_motion(stated)

    @model_validator(mode="after")
    def _must_move_once(self) -> Self:
        if self.has_lines and self.entrainment_angle != 0.0:
            key = "entrainment_angle" if self.velocity_1 is None else "velocities at an angle to x"
            raise ValueError(
                f"states {key}: along a line contact nothing changes, so only the speed "
                "across it makes a film; state that alone"
            )
        self._exactly_one("entrainment_speed", "moes_speed")
        return self
