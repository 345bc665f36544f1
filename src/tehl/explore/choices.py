"""Controls that choose between words: how a case states its load, a material, a surface.

Each option has the keys that it sets; the contact stays the same where only its statement changes.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.contact.materials import SOLIDS
from tehl.contact.problem import SURFACES
from tehl.contact.shape import LINE
from tehl.estimate.scaling import ScaledProblem
from tehl.explore.case_text import CaseText, named_table
from tehl.explore.knobs import Choice, Settings
from tehl.lubricant.fluid import OILS

OWN = "own values"
_LAWS: dict[str, tuple[str, Any]] = {
    "newtonian": ("Newtonian", {"law": "newtonian"}),
    "eyring": ("Eyring", {"law": "eyring", "stress": "5 MPa"}),
    "carreau": ("Carreau", {"law": "carreau", "modulus": "6 MPa", "exponent": 0.42}),
    "limiting": ("limiting stress", {"law": "limiting", "slope": 0.05}),
}
_SUPPLIES: dict[str, tuple[str, Any]] = {
    "flooded": ("fully flooded", None),
    "layer": ("layer", {"layer": "0.3 um"}),
    "ratio": ("share of flooded", {"ratio": 0.6}),
}

_OF_A_WHOLE_ROLLER = ("profile", "tilt", "tilting_moment")
_SPINS = ("spin_1", "spin_2")


@dataclass(frozen=True)
class State:
    """The case whose controls are made."""

    case: CaseText
    problem: ContactProblem

    @cached_property
    def scaled(self) -> ScaledProblem:
        """The scaled problem."""
        return ScaledProblem.of(self.problem)

    def roughness_of(self, table: str) -> str:
        """Return the type of the roughness of a surface, as the text states it."""
        stated = self.case.get(f"{table}.roughness") or {"type": "smooth"}
        return str(stated.get("type", "other")) if isinstance(stated, Mapping) else "other"


def _choice(
    path: str, label: str, chosen: str, options: dict[str, tuple[str, Settings]], **others: str
) -> Choice:
    """Return a choice; ``others`` name what only the text can state."""
    if chosen not in options:
        options |= {chosen: (others.get(chosen, chosen), {})}
    return Choice(path, label, chosen, options)


def _values(path: str, values: Mapping[str, tuple[str, Any]]) -> dict[str, tuple[str, Settings]]:
    """Return the options of what a key states."""
    return {option: (name, {path: value}) for option, (name, value) in values.items()}


def _one_of(state: State, label: str, values: dict[str, tuple[str, Any]]) -> Choice:
    """Return the choice of one of several keys of the contact."""
    chosen = next(key for key in values if getattr(state.problem.contact, key) is not None)
    without = dict.fromkeys((f"contact.{key}" for key in values), None)
    options = {
        key: (name, without | {f"contact.{key}": value}) for key, (name, value) in values.items()
    }
    return _choice(f"contact.{'|'.join(values)}", label, chosen, options)


def load(state: State) -> Choice:
    """Return the choice of how the load is stated."""
    problem = state.problem
    by_length = ("load per length", f"{1e-3 * problem.load:.5g} N/mm")
    force = ("load", f"{problem.load:.5g} N")
    stated = {"load_per_length": by_length} if problem.contact.is_line else {"load": force}
    loads = stated | {
        "hertz_pressure": ("Hertz pressure", f"{problem.hertz.pressure * 1e-9:.5g} GPa"),
        "moes_load": ("Moes M", float(f"{state.scaled.groups.M:.5g}")),
    }
    return _one_of(state, "load given as", loads)


def speed(state: State) -> Choice:
    """Return the choice of how the speed is stated."""
    speeds = {
        "entrainment_speed": ("entrainment speed", f"{state.problem.entrainment_speed:.5g} m/s"),
        "moes_speed": ("Moes L", float(f"{state.scaled.groups.L:.5g}")),
    }
    return _one_of(state, "speed given as", speeds)


def kind(state: State) -> Choice:
    """Return the choice of point, line or roller, under the same Hertz pressure."""
    problem, pressure = state.problem, f"{state.problem.hertz.pressure * 1e-9:.5g} GPa"
    contact, radius = problem.contact, f"{1e3 * problem.radii_of_axes.x:.6g} mm"
    width = (
        2.0
        * LINE.hertz(
            LINE.load_of_pressure(problem.hertz.pressure, problem.radii, problem.reduced_modulus),
            problem.radii,
            problem.reduced_modulus,
        ).half_width_x
    )
    keys = ("load", "load_per_length", "moes_load", "length", "ends", *_OF_A_WHOLE_ROLLER)
    point = {f"contact.{key}": None for key in keys} | {"contact.hertz_pressure": pressure}
    turned = ("radius_x", "radius_y", "entrainment_angle", *_SPINS)
    line = point | {f"contact.{key}": None for key in turned}
    line |= {"contact.radius": radius} if contact.radii is not None else {}
    # as usual for rollers: 15 times the width of the line contact
    roller: Settings = {"contact.length": f"{1e3 * 15.0 * width:.3g} mm"}
    roller |= {"contact.profile": {"shape": "logarithmic"}}
    options = {
        "point": ("ball or ellipse", point | {"contact.type": None}),
        "line": ("line without ends", line | {"contact.type": "line"}),
        "roller": ("roller", line | roller | {"contact.type": "roller"}),
    }
    return _choice("contact.type", "contact", contact.type, options)


def roller_ends(state: State) -> Choice | None:
    """Return the choice between a whole roller and a piece that goes on beyond its ends."""
    contact, path = state.problem.contact, "contact.ends"
    if contact.type != "roller":
        return None
    straight: Settings = {f"contact.{key}": None for key in (*_OF_A_WHOLE_ROLLER, *_SPINS)}
    options: dict[str, tuple[str, Settings]] = {
        "open": ("free", {path: None}),
        "mirrored": ("it goes on, mirrored", {path: "mirrored"} | straight),
        "periodic": ("it repeats itself", {path: "periodic"} | straight),
    }
    return _choice(path, "ends of the roller", contact.ends, options)


def is_whole_roller(state: State) -> bool:
    """Return whether the contact is a roller with both its ends."""
    contact = state.problem.contact
    return contact.type == "roller" and contact.ends == "open"


def roller_tilt(state: State) -> Choice | None:
    """Return the choice of what tilts a roller."""
    if not is_whole_roller(state):
        return None
    length = state.problem.contact.length or 0.0
    moment = f"{0.02 * state.problem.load * length:.2g} N m"  # both ends carry
    stated = {"tilting_moment": ("moment of the load", moment), "tilt": ("angle", None)}
    return _one_of(state, "tilt given as", stated)


def roller_profile(state: State) -> Choice | None:
    """Return the choice of the profile of a roller."""
    if not is_whole_roller(state):
        return None
    contact = state.problem.contact
    path = "contact.profile"
    shapes = {name: {"shape": name} for name in ("logarithmic", "lundberg")}
    options: dict[str, tuple[str, Settings]] = {"straight": ("straight", {path: None})}
    options |= _values(path, {name: (name, table) for name, table in shapes.items()})
    chosen = "straight" if contact.profile is None else contact.profile.shape
    return _choice(path, "profile", chosen, options)


def shape(state: State) -> Choice:
    """Return the choice of how the shape is stated."""
    radii, contact = state.problem.radii_of_axes, state.problem.contact
    x, y = f"{1e3 * radii.x:.6g} mm", f"{1e3 * radii.y:.6g} mm"
    bodies = {"surface_1.radius_x": x, "surface_1.radius_y": y}
    if contact.has_lines or math.isclose(radii.x, radii.y, rel_tol=1e-6):
        bodies = {"surface_1.radius": x}
    keys = [
        f"{table}.radius{axis}" for table in ("contact", *SURFACES) for axis in ("", "_x", "_y")
    ]
    without = dict.fromkeys(keys, None)
    options = {
        "bodies": ("radii of both", without | bodies | {"surface_2.radius": "inf"}),
        "circle": ("reduced radius", without | {"contact.radius": x}),
    }
    if not contact.has_lines:
        both = {"contact.radius_x": x, "contact.radius_y": y}
        options["ellipse"] = ("two reduced radii", without | both)
    chosen = "circle" if contact.radius else "ellipse" if contact.radius_x is not None else "bodies"
    return _choice("contact.radius|", "shape given by", chosen, options)


def material(state: State, *, number: int) -> Choice:
    """Return the choice of the material of a body."""
    path = f"surface_{number}.material"
    stated = state.case.get(path)
    options = _values(path, {name: (name.replace("-", " "), name) for name in SOLIDS.entries()})
    own = {path: named_table("material", stated)} if isinstance(stated, str) else {}
    named = getattr(state.problem, f"surface_{number}").material.name or OWN
    chosen = OWN if isinstance(stated, Mapping) else named
    return _choice(path, f"body {number}", chosen, options | {OWN: (OWN, own)})


def oil(state: State) -> Choice:
    """Return the choice of the oil; its shear law stays."""
    stated, shear_law = state.case.get("lubricant"), state.case.get("lubricant.shear")
    oils, chosen = OILS.entries(), OWN
    if isinstance(stated, str) or (isinstance(stated, Mapping) and "viscosity" not in stated):
        chosen = state.problem.lubricant.name or OWN
    elif state.problem.lubricant.viscosity.law == "walther":
        chosen = "sheet"
    sheet = chosen if chosen.startswith("iso-vg") else "iso-vg-68"
    own = chosen if chosen in oils else "mineral-oil"
    values: dict[str, tuple[str, Any]] = {
        name: (name.replace("iso-vg-", "ISO VG ").replace("-", " "), name) for name in oils
    }
    values["sheet"] = "data sheet", named_table("lubricant", sheet)
    values[OWN] = OWN, named_table("lubricant", own)
    kept = {} if shear_law is None else {"lubricant.shear": shear_law}
    options = {
        option: (name, {"lubricant": value} | kept) for option, (name, value) in values.items()
    }
    return _choice("lubricant", "oil", chosen, options)


def shear(state: State) -> Choice:
    """Return the choice of the shear law."""
    path, law = "lubricant.shear", state.problem.lubricant.shear.law
    return _choice(path, "shear law", law, _values(path, _LAWS))


def heat(state: State) -> Choice:
    """Return the choice of whether the heat is computed."""
    oil, inlet = state.problem.lubricant, state.case.get("thermal.temperature")
    off = dict.fromkeys(("thermal", *(f"{key}.temperature" for key in SURFACES)), None)
    if inlet is not None:  # the oil keeps the temperature of the inlet
        off |= {"lubricant.temperature": inlet}
    on: dict[str, Any] = {"thermal": {}}  # and what is missing is that of an average mineral oil
    if oil.conductivity is None:
        on["lubricant.conductivity"] = "0.14 W/m/K"
    if oil.heat_capacity is None:
        on["lubricant.heat_capacity"] = "2000 J/kg/K"
    if not oil.viscosity.temperature_coefficient > 0 and hasattr(oil.viscosity, "gamma"):
        on["lubricant.viscosity.gamma"] = "0.042 1/K"
    chosen = "off" if state.problem.thermal is None else "on"
    options = {"off": ("isothermal", off), "on": ("computed", on)}
    return _choice("thermal", "heat", chosen, options)


def surface(state: State, *, number: int) -> Choice:
    """Return the choice of the roughness of a surface."""
    table, half = f"surface_{number}", state.problem.hertz.half_width_x * 1e6
    path, transient = f"{table}.roughness", state.case.get("transient")
    wave, bump, length = (f"{part * half:.3g} um" for part in (0.5, 0.25, 0.15))
    rough: dict[str, tuple[str, Settings]] = {
        "wave": ("wave", {"amplitude": "0.1 um", "wavelength": wave}),
        "bump": ("dent or bump", {"amplitude": "-0.2 um", "radius": bump}),
        "random": ("random", {"rms": "20 nm", "correlation_length": length, "seed": 1}),
    }
    smooth: Settings = {path: None}
    other = state.case.get(f"surface_{3 - number}.roughness")
    if isinstance(transient, Mapping) and not (other or {"load", "duration"} & {*transient}):
        smooth["transient"] = None  # nothing would change with time
    without = {f"{table}.rms_roughness": None, f"{table}.ra_roughness": None}
    options = {"smooth": ("smooth", smooth)} | {
        kind: (name, {path: {"type": kind} | values} | without)
        for kind, (name, values) in rough.items()
    }
    chosen = state.roughness_of(table)
    return _choice(
        path, f"surface {number}", chosen, options, map="measured surface", other="as in the file"
    )


def moves(state: State) -> Choice | None:
    """Return the choice of whether rough surfaces move along; None if both are smooth."""
    if not state.problem.is_rough and state.problem.transient is None:
        return None
    values = {"stands": ("stands still", None), "moves": ("moves along", {"frames": 41})}
    chosen = "stands" if state.problem.transient is None else "moves"
    return _choice("transient", "roughness", chosen, _values("transient", values))


def supply(state: State) -> Choice:
    """Return the choice of the supply of oil."""
    stated, chosen = state.problem.supply, "flooded"
    if stated is not None:
        chosen = "layer" if stated.layer is not None else "ratio"
        chosen = "profile" if stated.profile is not None else chosen
    options = _values("supply", _SUPPLIES)
    return _choice("supply", "oil supply", chosen, options, profile="profile over y")


def asperities(state: State) -> Choice:
    """Return the choice of the asperities."""
    path, stated = "asperities", state.problem.asperities
    summits = {
        "model": "greenwood-tripp",
        "summit_radius": "10 um",
        "summit_density": "2e10 1/m^2",
        "friction": 0.1,
    }
    if not state.problem.rms_roughness > 0:
        summits["rms"] = "0.2 um"
    values = {"none": ("not computed", None), "greenwood-tripp": ("Greenwood-Tripp", summits)}
    chosen = "none" if stated is None else stated.model
    return _choice(path, path, chosen, _values(path, values), surface="measured patch")
