"""The JSON schema of case files: it accepts what is read, with limits, names and descriptions."""

import json
import re
from typing import Any

import pytest
from pydantic import TypeAdapter

from tehl.base.errors import InputError
from tehl.base.units import Force, Number, PressureCoefficient, Radius, Speed, quantity
from tehl.contact.materials import material
from tehl.io.case import case_schema


def test_the_schema_has_every_table_and_forbids_others():
    schema = json.loads(json.dumps(case_schema()))
    tables = {"title", "contact", "surface_1", "surface_2", "lubricant", "thermal", "transient"}
    tables |= {"supply", "asperities", "contact_film", "cavitation", "stress", "dynamics"}
    assert set(schema["properties"]) == tables | {"numerics"}
    assert schema["additionalProperties"] is False
    named = {choice.get("type") for choice in schema["properties"]["lubricant"]["anyOf"]}
    assert "string" in named


def test_the_schema_states_the_limits_of_options():
    options = case_schema()["$defs"]["Options"]["properties"]
    assert options["points"]["anyOf"][0] == {"minimum": 17, "maximum": 16385, "type": "integer"}
    assert options["pre_sweeps"]["maximum"] == 10
    assert options["tolerance"]["exclusiveMaximum"] == 1


def test_the_schema_has_every_law_and_the_thermal_keys():
    parts = json.loads(json.dumps(case_schema()))["$defs"]
    laws = {part["properties"]["law"]["const"] for part in parts.values() if _is_law(part)}
    viscosity = {"roelands", "roelands-exponential", "barus", "walther", "tait-doolittle"}
    shear = {"newtonian", "eyring", "carreau", "limiting"}
    assert laws == viscosity | shear | {"dowson-higginson", "tait", "constant"}
    thermal = parts["Thermal"]["properties"]
    assert set(thermal) == {"temperature", "reynolds", "layers", "scheme", "sources"}
    assert thermal["scheme"]["enum"] == ["chebyshev", "uniform"]
    assert parts["OilByName"]["anyOf"] == [{"required": ["oil"]}, {"required": ["name"]}]
    assert "temperature" in parts["Surface"]["properties"]


def test_the_schema_has_the_names_of_solids_and_oils():
    schema = case_schema()
    oils = names_in(schema["properties"]["lubricant"])["enum"]
    assert {"mineral-oil", "iso-vg-68", "VG 68"} <= set(oils)
    solids = names_in(schema["$defs"]["Surface"]["properties"]["material"])["enum"]
    assert {"steel", "100Cr6", "Si3N4"} <= set(solids)
    assert all(material(name) for name in solids)


@pytest.mark.parametrize("name", ["Steel", "100CR6", "aisi52100", "SI3N4", "stel"])
def test_the_schema_accepts_names_in_any_capitals_as_cases_do(name: str):
    choice = names_in(case_schema()["$defs"]["Surface"]["properties"]["material"])
    try:
        known = bool(material(name))
    except InputError:
        known = False
    assert bool(re.search(choice["pattern"], name)) == known == (name != "stel")


def names_in(choices: dict[str, Any]) -> dict[str, Any]:
    """Return the enumeration and the pattern of names among the choices of a schema."""
    named = next(one for one in choices["anyOf"] if "enum" in one.get("anyOf", [{}])[0])
    return named["anyOf"][0] | named["anyOf"][1]


@pytest.mark.parametrize(
    ("kind", "good", "bad"),
    [
        (Force, ("80 N", "8e1N", " .5 kN", "+3 N"), ("80", "-80 N", "eighty N", "")),
        (Speed, ("1.5 m/s", "500 rpm at 4 cm"), ("1.5",)),
        (PressureCoefficient, ("22 1/GPa", "0 1/Pa"), ("22", "1")),
        (Radius, ("-20 mm", "inf"), ("-inf", "20")),
        (Number, ("-0.25", "1e3"), ("0.25 m", "x")),
    ],
)
def test_the_schema_accepts_the_texts_that_are_read(kind: Any, good: Any, bad: Any):
    choices = TypeAdapter(kind).json_schema(mode="validation")["anyOf"]
    pattern = next(one["pattern"] for one in choices if "pattern" in one)
    for text in good:
        assert re.search(pattern, text)
        quantity(kind).parse(text)
    for text in bad:
        assert not re.search(pattern, text)
        with pytest.raises(ValueError, match="such as"):
            quantity(kind).parse(text)


def _is_law(part: dict[str, Any]) -> bool:
    return "const" in part.get("properties", {}).get("law", {})
