"""The library of named oils."""

import math

import numpy as np
import pytest
from pydantic import TypeAdapter

from tehl.base.errors import InputError
from tehl.lubricant import Lubricant, NamedLubricant, oil
from tehl.lubricant.fluid import OILS


@pytest.mark.parametrize("name", list(OILS.entries()))
def test_every_named_oil_has_a_source_and_usual_values(name: str):
    lubricant = oil(name)
    assert lubricant.source
    assert 0.005 < lubricant.viscosity.eta_0 < 1.1
    assert 1e-8 < lubricant.viscosity.pressure_coefficient < 4e-8


@pytest.mark.parametrize("grade", [32, 68, 150, 320])
def test_the_iso_grades_follow_their_cited_relations(grade: int):
    law = oil(f"iso-vg-{grade}").viscosity
    centipoise = grade * 0.87
    assert law.eta_0 == pytest.approx(centipoise * 1e-3, rel=1e-3)
    wooster = (0.6 + 0.965 * math.log10(centipoise)) * 1e-8
    assert law.pressure_coefficient == pytest.approx(wooster, rel=5e-3)  # three digits stated


@pytest.mark.parametrize("name", [name for name in OILS.entries() if name != "mourier-2006"])
def test_a_named_oil_has_its_thermal_properties(name: str):
    lubricant = oil(name)
    assert lubricant.conductivity
    assert lubricant.heat_capacity
    assert 0.02 < lubricant.viscosity.temperature_coefficient < 0.09


def test_a_named_oil_may_be_changed():
    lubricant = TypeAdapter(NamedLubricant).validate_python(
        {"name": "iso-vg-68", "temperature": "80 degC", "shear": {"law": "eyring", "stress": 5e6}}
    )
    assert lubricant.temperature == pytest.approx(353.15)
    assert lubricant.shear.law == "eyring"
    assert lubricant.viscosity == oil("iso-vg-68").viscosity
    own = {"viscosity": {"law": "barus", "eta_0": 0.1, "alpha": 2e-8}, "name": "iso-vg-68"}
    own["density"] = {"law": "constant", "rho_0": 900}
    assert TypeAdapter(NamedLubricant).validate_python(own).conductivity is None


def test_a_data_sheet_takes_the_density_of_the_oil_at_40_degrees():
    sheet = {"law": "walther", "nu_40": "68 cSt", "nu_100": "8.7 cSt", "alpha": "23 1/GPa"}
    density = {"law": "dowson-higginson", "rho_0": 880, "beta": 6.5e-4}
    density["reference_temperature"] = "15 degC"
    lubricant = Lubricant.model_validate({"viscosity": sheet, "density": density})
    assert lubricant.viscosity.eta_0 == pytest.approx(68e-6 * 880 * (1 - 6.5e-4 * 25))
    stated = Lubricant.model_validate({"viscosity": sheet | {"density": 900}, "density": density})
    assert stated.viscosity.eta_0 == pytest.approx(68e-6 * 900)


def test_thermal_properties_grow_with_pressure_where_the_oil_states_it():
    table = {"value": "0.154 W/m/K", "slope": "1.40 1/GPa", "saturation": "0.34 1/GPa"}
    heat = {"value": 2000, "slope": "0.1 1/GPa"}
    parts = oil("mineral-oil").model_dump() | {"conductivity": table, "heat_capacity": heat}
    lubricant = Lubricant.model_validate(parts)
    pressure = np.array([0.0, 1e9])
    # Larsson and others (2000): 0.154 (1 + 1.40 / 1.34) at 1 GPa
    assert lubricant.conductivity_at(pressure) == pytest.approx([0.154, 0.154 * (1 + 1.4 / 1.34)])
    assert lubricant.heat_capacity_at(pressure) == pytest.approx([2000, 2200])
    assert lubricant.ambient_conductivity == 0.154
    volume = heat | {"slope": "0.41 1/GPa", "saturation": "1.05 1/GPa", "basis": "volume"}
    measured = Lubricant.model_validate(parts | {"heat_capacity": volume})
    growth = (1 + 0.41 / 2.05) / (1 + 0.6 / 2.7)  # of volume over density at 1 GPa
    assert measured.heat_capacity_at(pressure) == pytest.approx([2000, 2000 * growth])
    plain = oil("mineral-oil")
    assert plain.conductivity_at(pressure).tolist() == [0.14, 0.14]
    assert plain.ambient_heat_capacity == 2000
    with pytest.raises(InputError, match=r"lubricant\.conductivity is missing"):
        oil("mourier-2006").conductivity_at(pressure)


def test_an_unknown_oil_says_what_lists_the_known_ones():
    with pytest.raises(InputError, match="tehl oils lists 60, such as mineral-oil"):
        oil("olive")
