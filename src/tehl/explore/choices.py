"""Controls that choose between words: how a case states its load, a material, a surface."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.base.named import read_tables
from tehl.contact.materials import SOLIDS
from tehl.contact.problem import SURFACES
from tehl.estimate.scaling import ScaledProblem
from tehl.explore.case_text import CaseText, named_table
from tehl.explore.knobs import Choice
from tehl.lubricant.fluid import OILS
from tehl.report.plausibility import typical_ranges

OWN = "own values"


class State:
    """The case whose controls are made."""

    def __init__(self, case: CaseText, problem: ContactProblem) -> None:
        self.case, self.problem = case, problem
        self.scaled = ScaledProblem.of(problem)
        self.oil, self.law = problem.lubricant, problem.lubricant.viscosity
        self.typical = {one.name: one for one in typical_ranges(self.scaled)}

    def has(self, path: str, kind: type = object) -> bool:
        """Return whether the text has a key, or a table under it rather than a name."""
        stated = self.case.get(path)
        return stated is not None and isinstance(stated, kind)

    def roughness_of(self, table: str) -> str:
        """Return the type of the roughness of a surface, as the text states it."""
        stated = self.case.get(f"{table}.roughness")
        if stated is None:
            return "smooth"
        return str(stated.get("type", "other")) if isinstance(stated, Mapping) else "other"


def _pick(
    path: str,
    label: str,
    chosen: str,
    kinds: Mapping[str, tuple[Any, str]],
    *,
    others: Mapping[str, str] | None = None,
    also: Callable[[CaseText, str], None] | None = None,
) -> Choice:
    """Return the choice of what a key states.

    ``kinds`` has what is stated, and how it is called; ``others`` how kinds are called that only
    the text can state, and ``also`` changes the text further.
    """
    names = {kind: name for kind, (_, name) in kinds.items()}
    if chosen not in names:
        names[chosen] = (others or {}).get(chosen, chosen)

    def change(case: CaseText, choice: str) -> None:
        if choice in kinds:
            case.set(path, kinds[choice][0])
            if also is not None:
                also(case, choice)

    return Choice(path, label, names, chosen, change)


def _one_of(state: State, label: str, keys: dict[str, tuple[str, Any]]) -> Choice:
    """Return the choice of one of several keys of the contact, which stays the same."""
    chosen = next(key for key in keys if getattr(state.problem.contact, key) is not None)

    def change(case: CaseText, key: str) -> None:
        for other in keys:
            case.set(f"contact.{other}", None)
        case.set(f"contact.{key}", keys[key][1])

    names = {key: name for key, (name, _) in keys.items()}
    return Choice(f"contact.{'|'.join(keys)}", label, names, chosen, change)


def load(state: State) -> Choice:
    """Return the choice of how the load is stated."""
    problem = state.problem
    loads = {
        "load": ("load", f"{problem.load:.5g} N"),
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


def shape(state: State) -> Choice:
    """Return the choice of how the shape is stated; the contact stays the same."""
    radii, contact = state.problem.radii, state.problem.contact
    names = {"bodies": "radii of both", "circle": "reduced radius", "ellipse": "two reduced radii"}
    chosen = "circle" if contact.radius else "ellipse" if contact.radius_x is not None else "bodies"

    def change(case: CaseText, choice: str) -> None:
        for key in ("contact", *SURFACES):
            for name in ("radius", "radius_x", "radius_y"):
                case.set(f"{key}.{name}", None)
        for path, value in _radii_as(choice, radii.x, radii.y).items():
            case.set(path, value)

    return Choice("contact.radius|", "shape given by", names, chosen, change)


def material(state: State, *, number: int) -> Choice:
    """Return the choice of the material of a body."""
    path = f"surface_{number}.material"
    names = {name: name.replace("-", " ") for name in read_tables(SOLIDS)} | {OWN: OWN}
    named = getattr(state.problem, f"surface_{number}").material.name or OWN

    def change(case: CaseText, choice: str) -> None:
        if choice != OWN:
            case.set(path, choice)
        elif isinstance(name := case.get(path), str):
            case.set(path, named_table("material", name))

    chosen = OWN if state.has(path, Mapping) else named
    return Choice(path, f"body {number}", names, chosen, change)


def oil(state: State) -> Choice:
    """Return the choice of the oil; its shear law stays."""
    stated, shear = state.case.get("lubricant"), state.case.get("lubricant.shear")
    names = {name: _oil_label(name) for name in read_tables(OILS)}
    names |= {"sheet": "data sheet", OWN: OWN}
    chosen = OWN
    if isinstance(stated, str) or (isinstance(stated, Mapping) and "viscosity" not in stated):
        chosen = state.oil.name or OWN
    elif state.law.law == "walther":
        chosen = "sheet"

    def change(case: CaseText, choice: str) -> None:
        made: Any = choice
        if choice == "sheet":
            name = chosen if chosen.startswith("iso-vg") else "iso-vg-68"
            made = named_table("lubricant", name)
        elif choice == OWN:
            name = chosen if chosen in read_tables(OILS) else "mineral-oil"
            made = named_table("lubricant", name)
        case.set("lubricant", made)
        if shear is not None:
            case.set("lubricant.shear", shear)

    return Choice("lubricant", "oil", names, chosen, change)


def shear(state: State) -> Choice:
    """Return the choice of the shear law."""
    laws = {
        "newtonian": ({"law": "newtonian"}, "Newtonian"),
        "eyring": ({"law": "eyring", "stress": "5 MPa"}, "Eyring"),
        "carreau": ({"law": "carreau", "modulus": "6 MPa", "exponent": 0.42}, "Carreau"),
        "limiting": ({"law": "limiting", "slope": 0.05}, "limiting stress"),
    }
    return _pick("lubricant.shear", "shear law", state.oil.shear.law, laws)


def heat(state: State) -> Choice:
    """Return the choice of whether the heat is computed."""

    def change(case: CaseText, choice: str) -> None:
        if choice == "off":
            _switch_heat_off(case)
        else:
            _switch_heat_on(case, state.problem)

    chosen = "off" if state.problem.thermal is None else "on"
    return Choice("thermal", "heat", {"off": "isothermal", "on": "computed"}, chosen, change)


def surface(state: State, *, number: int) -> Choice:
    """Return the choice of the roughness of a surface."""
    key, half = f"surface_{number}", state.problem.hertz.half_width_x * 1e6
    wave = {"type": "wave", "amplitude": "0.1 um", "wavelength": f"{0.5 * half:.3g} um"}
    bump = {"type": "bump", "amplitude": "-0.2 um", "radius": f"{0.25 * half:.3g} um"}
    length = f"{0.15 * half:.3g} um"
    random = {"type": "random", "rms": "20 nm", "correlation_length": length, "seed": 1}
    kinds: dict[str, tuple[Any, str]] = {
        "smooth": (None, "smooth"),
        "wave": (wave, "wave"),
        "bump": (bump, "dent or bump"),
        "random": (random, "random"),
    }
    others = {"map": "measured surface", "other": "as in the file"}

    def also(case: CaseText, choice: str) -> None:
        if choice != "smooth":
            case.set(f"{key}.rms_roughness", None)
            case.set(f"{key}.ra_roughness", None)
        _end_transient(case)

    path, chosen = f"{key}.roughness", state.roughness_of(key)
    return _pick(path, f"surface {number}", chosen, kinds, others=others, also=also)


def moves(state: State) -> Choice | None:
    """Return the choice of whether rough surfaces move along; None if both are smooth."""
    if not state.problem.is_rough and state.problem.transient is None:
        return None
    kinds = {"stands": (None, "stands still"), "moves": ({"frames": 41}, "moves along")}
    chosen = "stands" if state.problem.transient is None else "moves"
    return _pick("transient", "roughness", chosen, kinds)


def supply(state: State) -> Choice:
    """Return the choice of the supply of oil."""
    stated = state.problem.supply
    kinds: dict[str, tuple[Any, str]] = {
        "flooded": (None, "fully flooded"),
        "layer": ({"layer": "0.3 um"}, "layer"),
        "ratio": ({"ratio": 0.6}, "share of flooded"),
    }
    chosen = "flooded"
    if stated is not None:
        chosen = "layer" if stated.layer is not None else "ratio"
        chosen = "profile" if stated.profile is not None else chosen
    return _pick("supply", "oil supply", chosen, kinds, others={"profile": "profile over y"})


def asperities(state: State) -> Choice:
    """Return the choice of the asperities."""
    stated = state.problem.asperities
    summits = _summits(state.problem)
    kinds = {"none": (None, "not computed"), "greenwood-tripp": (summits, "Greenwood-Tripp")}
    chosen, others = "none" if stated is None else stated.model, {"surface": "measured patch"}
    return _pick("asperities", "asperities", chosen, kinds, others=others)


def _radii_as(choice: str, x: float, y: float) -> dict[str, str]:
    """Return the keys that state reduced radii [m] in one of the ways."""
    along, across = f"{1e3 * x:.6g} mm", f"{1e3 * y:.6g} mm"
    if choice == "circle":
        return {"contact.radius": along}
    if choice == "ellipse":
        return {"contact.radius_x": along, "contact.radius_y": across}
    flat = {"surface_2.radius": "inf"}
    if math.isclose(x, y, rel_tol=1e-6):
        return {"surface_1.radius": along, **flat}
    return {"surface_1.radius_x": along, "surface_1.radius_y": across, **flat}


def _oil_label(name: str) -> str:
    return name.replace("iso-vg-", "ISO VG ").replace("-", " ")


def _end_transient(case: CaseText) -> None:
    """Leave a transient run out in which nothing changes any more."""
    stated = case.get("transient")
    rough = any(case.get(f"{key}.roughness") for key in SURFACES)
    if isinstance(stated, Mapping) and not (rough or {"load", "duration"} & set(stated)):
        case.set("transient", None)


def _switch_heat_off(case: CaseText) -> None:
    """Leave the heat out; the oil keeps the temperature of the inlet."""
    inlet = case.get("thermal.temperature")
    case.set("thermal", None)
    for key in SURFACES:
        case.set(f"{key}.temperature", None)
    if inlet is not None:
        case.set("lubricant.temperature", inlet)


def _switch_heat_on(case: CaseText, problem: ContactProblem) -> None:
    """Add the heat, and the properties of an average mineral oil where they are not stated."""
    case.set("thermal", {})
    oil = problem.lubricant
    if oil.conductivity is None:
        case.set("lubricant.conductivity", "0.14 W/m/K")
    if oil.heat_capacity is None:
        case.set("lubricant.heat_capacity", "2000 J/kg/K")
    if not oil.viscosity.temperature_coefficient > 0 and hasattr(oil.viscosity, "gamma"):
        case.set("lubricant.viscosity.gamma", "0.042 1/K")


def _summits(problem: ContactProblem) -> dict[str, Any]:
    found: dict[str, Any] = {
        "model": "greenwood-tripp",
        "summit_radius": "10 um",
        "summit_density": "2e10 1/m^2",
        "friction": 0.1,
    }
    if not problem.rms_roughness > 0:
        found["rms"] = "0.2 um"
    return found
