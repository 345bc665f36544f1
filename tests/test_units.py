"""Strings with units become SI, or are refused with a sentence."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from tehl import units
from tehl.units import Force, Length, Number, Quantity, Radius


@pytest.mark.parametrize(
    ("quantity", "text", "value"),
    [
        (units.PRESSURE, "0.5 GPa", 5e8),
        (units.PER_PRESSURE, "20 1/GPa", 2e-8),
        (units.PER_PRESSURE, "20 GPa^-1", 2e-8),
        (units.PER_PRESSURE, "20 GPa⁻¹", 2e-8),
        (units.TEMPERATURE, "40 degC", 313.15),
        (units.TEMPERATURE, "313.15 K", 313.15),
        (units.VISCOSITY, "0.04 Pa s", 0.04),
        (units.VISCOSITY, "40 mPa·s", 0.04),
        (units.VISCOSITY, "40 cP", 0.04),
        (units.KINEMATIC_VISCOSITY, "68 mm^2/s", 6.8e-5),
        (units.KINEMATIC_VISCOSITY, "68 cSt", 6.8e-5),
        (units.CONDUCTIVITY, "0.14 W/m/K", 0.14),
        (units.CONDUCTIVITY, "0.14 W/(m K)", 0.14),
        (units.HEAT_CAPACITY, "2 kJ/kg/K", 2000.0),
        (units.ANGLE, "45 deg", math.pi / 4),
        (units.PER_TEMPERATURE, "6.5e-4 1/K", 6.5e-4),
        (units.HEIGHT, "0.05 um", 5e-8),
        (units.HEIGHT, "50nm", 5e-8),
        (units.DENSITY, "0.89 g/cm³", 890.0),
        (units.RADIUS, "-20 mm", -0.02),
        (units.RADIUS, "inf", math.inf),
        (units.FORCE, 80, 80.0),
        (units.NUMBER, "0.25", 0.25),
    ],
)
def test_a_string_with_a_unit_becomes_si(quantity: Quantity, text: object, value: float):
    assert quantity.parse(text) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("80", "lacks a unit"),
        ("80 mm", "unit of a length"),
        ("80 foo", "unknown unit 'foo'"),
        ("80 N/", "unknown unit"),
        ("80 (N", "bracket"),
        ("80 N)", "unreadable unit"),
        ("80 N ^", "exponent"),
        ("80 N $", "unreadable unit"),
        ("eighty N", "does not begin with a number"),
        ("", "does not begin with a number"),
        ("nan", "is not a number"),
        (math.nan, "is not a number"),
        ("inf", "is not finite"),
        (math.inf, "is not finite"),
        (10**400, "is not finite"),
        ("1e400 N", "is not finite"),
        (0, "must be positive"),
        ("-80 N", "must be positive"),
        (True, "is not a number"),
        (None, "is not a number"),
        ([80], "is not a number"),
        ("80 deg", "unit of an angle"),
    ],
)
def test_what_is_no_force_is_refused_with_an_example(text: object, words: str):
    with pytest.raises(ValueError, match=words) as caught:
        units.FORCE.parse(text)
    assert 'give a force such as "80 N"' in str(caught.value)


def test_a_unit_gives_the_same_bits_as_the_number_in_si():
    assert units.PER_PRESSURE.parse("22 1/GPa") == 2.2e-8
    assert units.HEIGHT.parse("0.05 um") == 5e-8
    assert units.KINEMATIC_VISCOSITY.parse("68 mm^2/s") == 6.8e-5


def test_a_plain_number_takes_no_unit():
    with pytest.raises(ValueError, match="unit of a length"):
        units.NUMBER.parse("0.2 m")
    with pytest.raises(ValueError, match="unit of an angle"):
        units.NUMBER.parse("0.2 deg")


def test_a_radius_of_zero_is_told_from_a_flat():
    with pytest.raises(ValueError, match="flat surface"):
        units.RADIUS.parse(0.0)


@given(st.floats(min_value=1e-12, max_value=1e12))
def test_every_prefix_scales_by_its_power_of_ten(value: float):
    assert units.FORCE.parse(f"{value!r} kN") == pytest.approx(1e3 * value)
    assert units.PRESSURE.parse(f"{value!r} N/mm^2") == pytest.approx(1e6 * value)


@given(st.text(max_size=12))
def test_no_text_breaks_the_reader(text: str):
    try:
        value = units.FORCE.parse(text)
    except ValueError:
        return
    assert value > 0


class Model(BaseModel):
    load: Force
    width: Length | None = None
    radius: Radius = math.inf
    ratio: Number = 0.0


def test_a_model_field_reads_units():
    assert Model.model_validate({"load": "80 N", "width": "1 mm"}).width == pytest.approx(1e-3)
    with pytest.raises(ValidationError, match="lacks a unit"):
        Model.model_validate({"load": "80"})


def test_an_infinite_radius_survives_json():
    model = Model(load=1.0)
    assert Model.model_validate_json(model.model_dump_json()) == model
    assert Model.model_validate(model.model_dump(mode="json")) == model


def test_the_schema_shows_string_and_number():
    properties = Model.model_json_schema()["properties"]
    kinds = {choice["type"] for choice in properties["load"]["anyOf"]}
    assert kinds == {"string", "number"}
    assert properties["ratio"]["type"] == "number"
