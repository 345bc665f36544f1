"""Strings with units become SI, or are rejected with a message."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from tehl.base.units import (
    Angle,
    AngularVelocity,
    Conductivity,
    Density,
    Force,
    Frequency,
    HeatCapacity,
    HeatTransfer,
    Height,
    KinematicViscosity,
    Length,
    Moment,
    Number,
    Pressure,
    PressureCoefficient,
    Radius,
    Speed,
    Temperature,
    TemperatureCoefficient,
    Viscosity,
    quantity,
)


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [
        (Pressure, "0.5 GPa", 5e8),
        (Viscosity, "40 mPas", 0.04),
        (Viscosity, "40 mPa.s", 0.04),
        (Density, "890 kg/m3", 890.0),
        (KinematicViscosity, "32 mm2/s", 32e-6),
        (Speed, "90 m/min", 1.5),
        (Speed, "500 rpm at 40 mm", 500 / 60 * 2 * math.pi * 0.04),
        (Speed, "500 1/min at 4 cm", 500 / 60 * 2 * math.pi * 0.04),
        (PressureCoefficient, "20 1/GPa", 2e-8),
        (PressureCoefficient, "20/GPa", 2e-8),
        (PressureCoefficient, "20 GPa^-1", 2e-8),
        (PressureCoefficient, "20 GPa⁻¹", 2e-8),
        (Temperature, "40 degC", 313.15),
        *((Temperature, f"104 {unit}", 313.15) for unit in ("degF", "° F", "°F")),
        (Length, "2 in", 0.0508),
        (Height, "16 µin", 16 * 25.4e-9),
        (Force, "10 lbf", 44.482216152605),
        (Pressure, "150 ksi", 150e3 * 4.4482216152605 / 0.0254**2),
        (Viscosity, "5 reyn", 5.0 * 4.4482216152605 / 0.0254**2),
        (Moment, "1 lbf in", 4.4482216152605 * 0.0254),
        (Temperature, "313.15 K", 313.15),
        *((Temperature, f"40 {unit}", 313.15) for unit in ("℃", "º C", "deg C")),
        (Temperature, "−40 °C", 233.15),
        (Angle, "2 arcmin", math.pi / 5400),
        (Viscosity, "0.04 Ns/m²", 0.04),
        (Density, "0.89 g/ml", 890.0),
        (Density, "0.89 kg/dm3", 890.0),
        *((Conductivity, f"0.14 {unit}", 0.14) for unit in ("W/mK", "W/m K", "W/m·K")),
        (HeatCapacity, "2 kJ/kgK", 2000.0),
        (HeatTransfer, "200 W/m²K", 200.0),
        (Moment, "5 Nm", 5.0),
        (Viscosity, "0.04 Pa s", 0.04),
        (Viscosity, "40 mPa·s", 0.04),
        (Viscosity, "40 cP", 0.04),
        (KinematicViscosity, "68 mm^2/s", 6.8e-5),
        (KinematicViscosity, "68 cSt", 6.8e-5),
        (Conductivity, "0.14 W/m/K", 0.14),
        (Conductivity, "0.14 W/(m K)", 0.14),
        (HeatCapacity, "2 kJ/kg/K", 2000.0),
        (Angle, "45 deg", math.pi / 4),
        (TemperatureCoefficient, "6.5e-4 1/K", 6.5e-4),
        (Height, "0.05 um", 5e-8),
        (Height, "50nm", 5e-8),
        (Density, "0.89 g/cm³", 890.0),
        (Radius, "-20 mm", -0.02),
        (Radius, "inf", math.inf),
        (Radius, "inf mm", math.inf),  # a column in mm has flat surfaces too
        (Radius, "∞", math.inf),
        (AngularVelocity, "300 /min", 10 * math.pi),
        (Force, 80, 80.0),
        (Number, "0.25", 0.25),
    ],
)
def test_a_string_with_a_unit_becomes_si(kind: object, text: object, value: float):
    assert quantity(kind).parse(text) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("80", "lacks a unit"),
        ("80 mm", "unit of a length"),
        ("80 foo", "unknown unit 'foo'"),
        ("80 N/", "unknown unit"),
        ("80 N / 2", "has a calculation .* work it out"),
        ("-2 * 40 N", "has a calculation .* work it out"),
        ("80 (N", "bracket"),
        ("80 N)", "unreadable unit"),
        ("80 N ^", "exponent"),
        ("80 N $", "unreadable unit"),
        ("80 lb", "unit of a mass .*[(]a force has N, kN or lbf[)]"),
        ("80 kn", "unknown unit 'kn', did you mean kN[?]"),
        ("1 200 N", "has a space in its number, leave it out"),
        ("1'200 N", "has a mark between its thousands, leave it out"),
        ("1,200 N", "has a comma in its number: .* no mark between thousands"),
        ("1.2·10^3 N", "has a power of ten apart: write it as in 2.2e-8"),
        ("80 J/kg m", "unit of another quantity"),
        ("nan N", "is not a number"),
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
def test_an_invalid_force_is_rejected_with_an_example(text: object, words: str):
    with pytest.raises(ValueError, match=words) as caught:
        quantity(Force).parse(text)
    assert 'expected a force such as "80 N"' in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "text", "words"),
    [
        (Speed, "500 rpm", 'rotational speed .rpm.: give the radius .* "500 rpm at 40 mm"'),
        (Speed, "500 min^-1", "rotational speed"),
        (Speed, "500 rpm at 40", "lacks a unit"),
        (Speed, "500 rpm at 40 N", "unit of a force"),
        (Speed, "500 rpm at", "does not begin with a number"),
        (Speed, "-500 rpm at 40 mm", "must be positive"),
        (Force, "500 rpm", "rotational speed"),
        (Frequency, "50 rad/s", "unit of an angular velocity .rad/s."),
    ],
)
def test_a_rotational_speed_needs_a_radius(kind: object, text: str, words: str):
    with pytest.raises(ValueError, match=words):
        quantity(kind).parse(text)


def test_a_unit_gives_the_same_bits_as_the_number_in_si():
    assert quantity(PressureCoefficient).parse("22 1/GPa") == 2.2e-8
    assert quantity(Height).parse("0.05 um") == 5e-8
    assert quantity(KinematicViscosity).parse("68 mm^2/s") == 6.8e-5


def test_a_plain_number_takes_no_unit():
    with pytest.raises(ValueError, match="unit of a length"):
        quantity(Number).parse("0.2 m")
    with pytest.raises(ValueError, match="unit of an angle"):
        quantity(Number).parse("0.2 deg")


def test_a_radius_of_zero_is_not_a_flat():
    with pytest.raises(ValueError, match="flat surface"):
        quantity(Radius).parse(0.0)


@given(st.floats(min_value=1e-12, max_value=1e12))
def test_every_prefix_scales_by_its_power_of_ten(value: float):
    assert quantity(Force).parse(f"{value!r} kN") == pytest.approx(1e3 * value)
    assert quantity(Pressure).parse(f"{value!r} N/mm^2") == pytest.approx(1e6 * value)


@given(st.text(max_size=12))
def test_no_text_breaks_the_reader(text: str):
    try:
        value = quantity(Force).parse(text)
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
    assert {choice["type"] for choice in properties["ratio"]["anyOf"]} == kinds
