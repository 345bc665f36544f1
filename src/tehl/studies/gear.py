"""Contacts of a pair of spur gears and of a flat-faced cam, as tables of a case over time."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tehl.base.errors import InputError

LEAST_SHARE = 1.0 / 3.0
"""Part of the load of a tooth where it comes into mesh or leaves it; it is linear up to two thirds
where it carries alone."""
JUMP = 0.02
"""Way over which it becomes the whole, over the base pitch."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SpurGears:
    """A pair of spur gears with involute teeth.

    Its load is shared linearly between two pairs in mesh, without the elasticity of the teeth.
    """

    module: float
    """[m]."""
    teeth: tuple[int, int]
    """Of pinion and wheel; the pinion drives."""
    width: float
    """Of the teeth [m]."""
    torque: float
    """At the pinion [N m]."""
    speed: float
    """Of the pinion [rad/s]."""
    pressure_angle: float = math.radians(20.0)
    shift: tuple[float, float] = (0.0, 0.0)
    """Profile shift of both over the module."""
    centres: float | None = None
    """Distance of the axes [m]; None is that of gears without shift."""

    def __post_init__(self) -> None:
        """Check that the teeth can mesh."""
        if min(self.module, self.width, self.torque, self.speed, *self.teeth) <= 0:
            raise InputError("module, teeth, width, torque and speed of gears must be positive")
        first, last = self.ends
        if not last - first > self.base_pitch:
            raise InputError(
                f"the teeth leave mesh before the next pair comes: the path of contact has "
                f"{1e3 * (last - first):.3g} mm, less than the base pitch of "
                f"{1e3 * self.base_pitch:.3g} mm; check centres and shift"
            )
        if not 1.0 + JUMP < (last - first) / self.base_pitch <= 2.0:
            raise InputError(
                f"the contact ratio is {(last - first) / self.base_pitch:.3g}: the load is shared "
                f"by one or two pairs of teeth, with a ratio above {1.0 + JUMP:g} and up to 2"
            )
        if not min(self.radii(first) + self.radii(last)) > 0.0:
            raise InputError(
                "the tips reach beyond the involute of the other gear: check the shift"
            )

    @property
    def base_radii(self) -> tuple[float, float]:
        """Radii of the base circles [m]."""
        first, second = (
            0.5 * self.module * one * math.cos(self.pressure_angle) for one in self.teeth
        )
        return first, second

    @property
    def base_pitch(self) -> float:
        """Distance of teeth along the line of action [m]."""
        return math.pi * self.module * math.cos(self.pressure_angle)

    @property
    def _distance(self) -> float:
        """Distance of the axes [m]."""
        return 0.5 * self.module * sum(self.teeth) if self.centres is None else self.centres

    @property
    def working_angle(self) -> float:
        """Angle of the line of action [rad]."""
        ratio = sum(self.base_radii) / self._distance
        if not ratio < 1.0:
            raise InputError(f"centres = {self._distance:g} m: less than both base radii")
        return math.acos(ratio)

    @property
    def tip_radii(self) -> tuple[float, float]:
        """Radii of the tips [m]: addendum of a module with shift, shortened to keep clearance."""
        half, module = 0.5 * self.module, self.module
        clearance = self._distance - half * sum(self.teeth) - module * sum(self.shift)
        clearance = min(clearance, 0.0)
        first, second = (
            half * teeth + module * (1.0 + shift) + clearance
            for teeth, shift in zip(self.teeth, self.shift, strict=True)
        )
        return first, second

    @property
    def ends(self) -> tuple[float, float]:
        """Start and end of the path of contact, from the pitch point [m]."""
        tangent = math.tan(self.working_angle)
        first, second = (
            math.sqrt(max(tip**2 - base**2, 0.0)) - base * tangent
            for tip, base in zip(self.tip_radii, self.base_radii, strict=True)
        )
        return -second, first

    def radii(self, place: float) -> tuple[float, float]:
        """Return the radii of curvature of both flanks at a place of the line of action [m]."""
        first, second = (base * math.tan(self.working_angle) for base in self.base_radii)
        return first + place, second - place

    def at(self, place: float) -> dict[str, float]:
        """Return radius, speeds and load per length at a place of the line of action, in SI.

        They are keys of ``[contact]``; sliding is that of the pinion over the wheel.
        """
        first, second = self.radii(place)
        fast, slow = self.speed * first, self.speed * self.teeth[0] / self.teeth[1] * second
        mean = 0.5 * (fast + slow)
        load = self.torque / (self.base_radii[0] * self.width)
        return {
            "radius": first * second / (first + second),
            "entrainment_speed": mean,
            "slide_roll_ratio": (fast - slow) / mean,
            "load_per_length": load * self.share(place),
        }

    @property
    def _corners(self) -> list[float]:
        """Places where the share of the load changes its slope, from the pitch point [m].

        It grows to the whole over `JUMP`.
        """
        (start, end), pitch = self.ends, self.base_pitch
        alone, jump = (end - pitch, start + pitch), JUMP * pitch
        return [start, alone[0] - jump, alone[0], alone[1], alone[1] + jump, end]

    def share(self, place: float) -> float:
        """Return the part of the load that a tooth carries."""
        least, most = LEAST_SHARE, 1.0 - LEAST_SHARE
        return float(np.interp(place, self._corners, [least, most, 1.0, 1.0, most, least]))

    def tables(self, points: int = 61) -> dict[str, dict[str, Any]]:
        """Return the tables ``contact`` and ``transient`` of a case: one tooth passes its mesh.

        The contact is that of the pitch point; the radius over time has this many points.
        """
        (start, end), pitch = self.ends, self.at(0.0)
        velocity = self.speed * self.base_radii[0]  # of the contact along the line of action

        def course(places: Any, value: Callable[[float], float]) -> list[list[float]]:
            return [[(one - start) / velocity, value(one)] for one in map(float, places)]

        def sliding(place: float) -> float:
            here = self.at(place)
            slid = here["slide_roll_ratio"] * here["entrainment_speed"]
            return slid / pitch["entrainment_speed"]

        speed = pitch["entrainment_speed"]
        return {
            "contact": {"type": "line"} | pitch,
            "transient": {
                "duration": (end - start) / velocity,
                "entrainment_speed": course(
                    (start, end), lambda one: self.at(one)["entrainment_speed"] / speed
                ),
                "sliding_speed": course((start, end), sliding),
                "radius": course(
                    np.linspace(start, end, points),
                    lambda one: self.at(one)["radius"] / pitch["radius"],
                ),
                "load": course(self._corners, self.share),
            },
        }


@dataclass(frozen=True, kw_only=True, slots=True)
class FlatCam:
    """A cam that lifts a flat follower by ``lift (1 - (angle/half)^2)^3``, and rests elsewhere."""

    base_radius: float
    lift: float
    """[m]."""
    half_angle: float
    """Half of the angle over which it lifts [rad]."""
    width: float
    """Of the follower [m]."""
    speed: float
    """[rad/s]."""
    spring: tuple[float, float]
    """Force at rest [N], and stiffness [N/m]."""
    mass: float = 0.0
    """That moves with the follower [kg]."""

    def at(self, angle: float) -> dict[str, float]:
        """Return radius, speeds and load per length at an angle from the nose, in SI.

        They are keys of ``[contact]``; the sliding is that of the cam over the follower. The
        contact moves along the follower, so both surfaces have speeds relative to it.
        """
        x, half = min(abs(angle) / self.half_angle, 1.0), self.half_angle
        lift = self.lift * (1.0 - x**2) ** 3
        bend = -6.0 * self.lift * (1.0 - x**2) * (1.0 - 5.0 * x**2) / half**2
        radius = self.base_radius + lift + bend
        load = self.spring[0] + self.spring[1] * lift + self.mass * self.speed**2 * bend
        if not min(radius, load) > 0.0:
            raise InputError(
                f"at {math.degrees(angle):.3g} degrees the cam has R = {radius:.3g} m under "
                f"{load:.3g} N: both must be positive; a smaller lift or a wider half_angle helps, "
                f"and for R a base_radius above {1e3 * self._least_base:.3g} mm"
            )
        return {
            "radius": radius,
            "entrainment_speed": 0.5 * self.speed * (radius + bend),
            "sliding_speed": self.speed * (self.base_radius + lift),
            "load_per_length": load / self.width,
        }

    @property
    def _least_base(self) -> float:
        """Return the base radius below which the cam is hollow at some angle [m]."""
        square = np.linspace(0.0, 1.0, 201)
        bend = 6.0 * (1.0 - square) * (1.0 - 5.0 * square) / self.half_angle**2
        return float((self.lift * (bend - (1.0 - square) ** 3)).max())

    def tables(self, reach: float, points: int = 121) -> dict[str, dict[str, Any]]:
        """Return the tables ``contact`` and ``transient`` of a case from -reach to reach [rad].

        The contact is that of the largest Hertz pressure with a fifth of the largest speed, or
        more, along x.
        """
        angles = np.linspace(-reach, reach, points)
        rows = [self.at(float(angle)) for angle in angles]
        least = 0.2 * max(abs(row["entrainment_speed"]) for row in rows)
        forth = [row for row in rows if row["entrainment_speed"] >= least] or rows
        here = max(forth, key=lambda row: row["load_per_length"] / row["radius"])
        time, speed = (angles + reach) / self.speed, here["entrainment_speed"]
        units = {"entrainment_speed": speed, "sliding_speed": speed, "radius": here["radius"]}
        units["load_per_length"] = here["load_per_length"]
        names = {"load_per_length": "load"}
        courses: dict[str, Any] = {
            names.get(key, key): [
                [float(when), row[key] / unit] for when, row in zip(time, rows, strict=True)
            ]
            for key, unit in units.items()
        }
        contact = {key: here[key] for key in ("radius", "entrainment_speed", "load_per_length")}
        return {
            "contact": {"type": "line"} | contact,
            "transient": {"duration": float(time[-1])} | courses,
        }
