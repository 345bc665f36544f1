"""The library of named oils."""

import math

import pytest

from tehl.errors import InputError
from tehl.lubricant import library, oil


@pytest.mark.parametrize("name", list(library()))
def test_every_named_oil_has_a_source_and_usual_values(name: str):
    lubricant = library()[name]
    assert lubricant.source
    assert lubricant.shear.law == "newtonian"
    assert 0.005 < lubricant.viscosity.eta_0 < 1.0
    assert 1e-8 < lubricant.viscosity.pressure_coefficient < 4e-8


@pytest.mark.parametrize("grade", [32, 68, 150, 320])
def test_the_iso_grades_follow_the_relations_they_cite(grade: int):
    law = oil(f"iso-vg-{grade}").viscosity
    centipoise = grade * 0.87
    assert law.eta_0 == pytest.approx(centipoise * 1e-3, rel=1e-3)
    wooster = (0.6 + 0.965 * math.log10(centipoise)) * 1e-8
    assert law.pressure_coefficient == pytest.approx(wooster, rel=5e-3)  # three digits stated


def test_an_unknown_oil_lists_the_known():
    with pytest.raises(InputError, match="mineral-oil"):
        oil("olive")
