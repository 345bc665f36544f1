"""Headings of lists of contacts: the keys and units that the usual words and spellings mean."""

import difflib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.base.keys import field_at, key_paths, models_at, quantity_of
from tehl.base.named import Library
from tehl.base.units import ForcePerLength, is_per_turn, is_unit, plain_signs, quantity
from tehl.base.wording import short
from tehl.contact.materials import SOLIDS
from tehl.contact.options import Options
from tehl.io.case import plain_value
from tehl.lubricant.fluid import OILS

_WORDS = (
    {
        "contact.type": "type contact_type",
        "contact.load": "load force normal_load normal_force ball_load w q f_n "
        "last kraft normalkraft",
        "contact.load_per_length": "load_per_length line_load unit_load specific_load w_l "
        "linienlast streckenlast",
        "contact.hertz_pressure": "p_h ph p_hertz p0 p_0 hertz_pressure hertzian_pressure "
        "pressung hertzsche_pressung",
        "contact.entrainment_speed": "u_m u speed entrainment_speed entrainment mean_speed "
        "entraining_speed rolling_speed geschwindigkeit rollgeschwindigkeit",
        "contact.slide_roll_ratio": "srr slip slide_roll_ratio slide_to_roll_ratio schlupf",
        "contact.entrainment_angle": "entrainment_angle angle",
        "contact.sliding_angle": "sliding_angle skew_angle",
        "contact.length": "length roller_length effective_length l_we länge rollenlänge",
        "contact.tilt": "tilt misalignment",
        "contact.tilting_moment": "tilting_moment misalignment_moment",
        "contact.profile.shape": "profile roller_profile",
        "contact.radius": "radius r reduced_radius",
        "contact.radius_x": "r_x rx radius_x reduced_radius_x",
        "contact.radius_y": "r_y ry radius_y reduced_radius_y",
        "lubricant.temperature": "temperature oil_temperature inlet_temperature temp oil_temp "
        "lube_temp t_oil t temperatur öltemperatur",
        "lubricant.oil": "oil lubricant öl oel schmierstoff",
        "lubricant.viscosity.nu_40": "nu_40 nu40 kv40 kv_40 viscosity_40",
        "lubricant.viscosity.nu_100": "nu_100 nu100 kv100 kv_100 viscosity_100",
        "lubricant.viscosity.eta_0": "eta_0 eta eta0 viscosity dynamic_viscosity",
        "lubricant.viscosity.alpha": "alpha pressure_viscosity_coefficient",
        "supply.ratio": "supply_ratio",
        "numerics.error": "error accuracy",
        "title": "title name contact position id no number nr bearing designation "
        "bezeichnung lager lfd_nr",
    }
    | {
        f"surface_{side}.{key}": " ".join(f"{word}_{side} {word}{side}" for word in words.split())
        for side in (1, 2)
        for key, words in {
            "rms_roughness": "rms_roughness sq rq sigma",
            "ra_roughness": "ra_roughness ra sa",
            "material": "material solid werkstoff",
            "radius": "radius r",
            "radius_x": "radius_x r_x rx",
            "radius_y": "radius_y r_y ry",
            "temperature": "temperature t",
            "thermal_resistance": "thermal_resistance r_th rth",
        }.items()
    }
    | {f"contact.spin_{side}": f"spin_{side} omega_{side}" for side in (1, 2)}
)


NO_WORDS: Mapping[str, str] = {}
_KEYS = {word: key for key, words in _WORDS.items() for word in words.split()}
"""Keys of the case by words of headings."""
_SIGNS = str.maketrans({"µ": "u", "μ": "u", "²": "^2", "³": "^3", "·": " ", "⋅": " ", "−": "-"})
_DEGREES = {"C": "degC", "F": "degF", "°": "deg"}
_HEADING = re.compile(
    r"(?P<name>.+?)\s*(?:\[(?P<a>.*)\]|\((?P<b>.*)\)|\s+in\s+(?P<c>\S.*)|\s*/\s*(?P<d>\S.*))\s*"
)


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a list: its heading as it was typed, the key of the case, and the unit."""

    heading: str
    key: str | None
    """None where the column is carried over as it is."""
    unit: str


def column_of(text: str, others: Mapping[str, str] = NO_WORDS) -> Column:
    """Return the column of a heading."""
    match = _HEADING.fullmatch(text)
    name, unit = text, ""
    if match is not None:
        name = match["name"]
        unit = next((one for one in match.group("a", "b", "c", "d") if one is not None), "")
    key, word = _key(name, others), unit_of(unit)
    if key is None and not unit and "_" in name:  # load_N
        first, _, last = name.rpartition("_")
        if is_unit(unit_of(last)) and (known := _key(first, others)) is not None:
            key, word = known, unit_of(last)
    if unit and not is_unit(word):
        if key is not None and word not in ("-", "1", ""):
            raise InputError(
                f'the unit of the column "{text}" is not known: {unit}{_expected(key)}'
            )
        word = ""
    return Column(text, key, "" if word in ("-", "1") else word)


def _expected(key: str) -> str:
    """Return what a key expects, as the end of a sentence; empty for a text."""
    table, *path = key.split(".")
    root, inside = (Options, path) if table == "numerics" else (ContactProblem, [table, *path])
    field = field_at(models_at(root, tuple(inside[:-1]))[-1], inside[-1])
    found = None if field is None else quantity_of(field)
    return "" if found is None else f"; {found.expected}"


def by_unit(column: Column) -> Column:
    """Return a column whose load per length has its key: people call that of a line a load too."""
    if column.key == "contact.load" and quantity(ForcePerLength).has_unit(column.unit):
        return replace(column, key="contact.load_per_length")
    return column


def unit_of(text: str) -> str:
    """Return a unit as case files spell it."""
    plain = text.strip().strip("[]()").strip()
    plain = plain_signs(plain).replace("°C", "degC").replace("°F", "degF")
    return _DEGREES.get(plain, plain.translate(_SIGNS))


def are_units(cells: Sequence[Any]) -> bool:
    """Whether a row has units in place of values."""
    words = [str(cell) for cell in cells if cell is not None]
    units = [word for word in words if is_unit(unit_of(word)) or word in ("-", "1")]
    return bool(units) and len(units) == len(words) and set(words) != {"1"}


def _key(name: str, others: Mapping[str, str]) -> str | None:
    """Return the key of the case, or the other name, that a heading means; None if not known."""
    text = name.strip()
    word = re.sub(r"(?:[^\w±]|_)+", "_", text.lower()).strip("_")
    if word in _KEYS or word in others:
        return others.get(word) or _KEYS[word]
    paths = _paths()
    if "." in text and text.split(".")[0] in (*ContactProblem.model_fields, "numerics"):
        return text
    if text in paths:
        return text
    ends = [path for path in paths if path.rpartition(".")[2] == word]
    return ends[0] if len(ends) == 1 else None


@cache
def _paths() -> tuple[str, ...]:
    return (*key_paths(ContactProblem), *key_paths(Options, "numerics."))


def check_columns(columns: Sequence[Column], lines: Sequence[Sequence[Any]]) -> None:
    """Raise for headings that are not known and hold numbers, and for keys that stand twice."""
    keys = [one.key for one in columns if one.key is not None]
    for one in columns:
        if one.key is not None and keys.count(one.key) > 1:
            raise InputError(f"two columns state {one.key}: remove one of them")
    if not keys:
        found = ", ".join(f'"{one.heading}"' for one in columns if one.heading)
        raise InputError(
            "has no column that a case file knows, such as load [N]: its first row must have the "
            f"headings, and is {short(found, 80)}"
        )
    for place, one in enumerate(columns):
        if one.key is None and one.heading:
            _check_carried(one, [line[place] for line in lines if line[place] is not None])


def _check_carried(column: Column, values: Sequence[Any]) -> None:
    """Raise for a column that states nothing if it has numbers or a unit, or names of a library."""
    numeric = [isinstance(plain_value(str(value)), int | float) for value in values]
    if column.unit or (values and all(numeric)):
        raise InputError(f'the column "{column.heading}" is not known; {_guess(column)}')
    for library, word in ((OILS, "oil"), (SOLIDS, "material 1 or material 2")):
        if values and all(_is_named(library, value) for value in values):
            raise InputError(
                f'the column "{column.heading}" is not known, and its cells name {library.kind}s: '
                f"call it {word}, or remove it"
            )


def _guess(column: Column) -> str:
    """Return what a heading may mean."""
    if is_per_turn(column.unit):
        return (
            "a contact has speeds, or a rotational speed with the radius at which the "
            'surfaces move: take u_m [m/s], or values such as "500 rpm at 40 mm" below u_m'
        )
    word = re.split(r"[\[(/]", column.heading)[0].strip().lower()
    near = difflib.get_close_matches(word, [*_KEYS, *_paths()], n=1, cutoff=0.6)
    usual = "load, p_h, u_m, SRR, R_x, temperature, nu_40, Ra 1"
    return (
        f"did you mean {near[0]}?"
        if near
        else f"take a usual word ({usual}), a key of the case file, or title if it names the rows"
    )


def _is_named(library: Library, value: Any) -> bool:
    """Return whether a library has a name."""
    try:
        library.find(str(value))
    except ValueError:
        return False
    return True
