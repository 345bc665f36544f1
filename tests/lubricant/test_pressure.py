"""The pressure coefficient: stated, estimated, or reported as missing."""

import pytest
from pydantic import TypeAdapter

from tehl.base.errors import InputError
from tehl.lubricant import Barus, Lubricant, Roelands, RoelandsExponential, ViscosityLaw, oil
from tehl.lubricant.pressure import wooster

LAW = TypeAdapter(ViscosityLaw)


@pytest.mark.parametrize(
    # mineral oils: 20 1/GPa at 32 mPa s to 30 at 300 mPa s, the range of the textbooks
    ("viscosity", "low", "high"),
    [(0.01, 14e-9, 18e-9), (0.04, 20e-9, 24e-9), (0.1, 23e-9, 27e-9), (0.3, 27e-9, 32e-9)],
)
def test_the_estimate_is_that_of_usual_mineral_oils(viscosity, low, high):
    assert low < wooster(viscosity) < high


def test_the_named_grades_have_the_estimate():
    for grade in (32, 46, 68, 100, 150, 320):
        law = oil(f"ISO VG {grade}").viscosity
        assert law.pressure_coefficient == pytest.approx(wooster(law.eta_0), rel=3e-3)


@pytest.mark.parametrize("law", ["roelands", "roelands-exponential", "barus"])
def test_an_estimated_coefficient_counts_and_is_kept(law):
    found = LAW.validate_python({"law": law, "eta_0": "40 mPa s", "alpha": "estimated"})
    stated = found.model_copy(update={"alpha": wooster(0.04)})
    assert found.is_estimated
    assert not stated.is_estimated
    assert found.pressure_coefficient == stated.pressure_coefficient
    assert found.viscosity(5e8, 313.15) == stated.viscosity(5e8, 313.15)
    assert LAW.validate_json(found.model_dump_json()) == found


def test_the_estimate_of_a_data_sheet_holds_at_its_temperature():
    table = {"law": "walther", "nu_40": "68 cSt", "nu_100": "8.7 cSt", "alpha": "estimated"}
    density = {"law": "constant", "rho_0": 870}
    for at in ("40 degC", "80 degC"):
        stated = Lubricant.model_validate(
            {"viscosity": table | {"alpha_temperature": at}, "density": density}
        ).viscosity
        kelvin = stated.alpha_temperature
        assert stated.pressure_coefficient_at(kelvin) == wooster(stated.ambient(kelvin))


@pytest.mark.parametrize("kind", [Roelands, RoelandsExponential, Barus])
def test_a_missing_coefficient_is_reported_with_usual_values(kind):
    with pytest.raises(InputError, match=r"18 to 25 1/GPa for mineral.* PAO.*\"estimated\""):
        kind(eta_0=0.04)
    with pytest.raises(InputError, match='has alpha = "estimated" at a viscosity of 30 Pa s'):
        kind(eta_0=30.0, alpha="estimated")
    with pytest.raises(InputError, match='expected an inverse pressure such as "22 1/GPa"'):
        kind(eta_0=0.04, alpha="guessed")
