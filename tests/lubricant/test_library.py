"""The libraries of oils and solids: how each number is known, and catalogue values reproduced."""

import math
import re

import pytest

from tehl.contact.materials import SOLIDS
from tehl.lubricant import oil
from tehl.lubricant.fluid import OILS
from tests import reference

KINDS = {"measured", "data sheet", "handbook", "correlation", "stated", "assumed"}
NOT_CONSTANTS = ("name", "source", "law", "reference_temperature", "limits", "form", "basis")
CATALOGUE = reference.read("oils")
ENTRIES = [*OILS.entries().values(), *SOLIDS.entries().values()]


def constants(table, parent=""):
    for key, value in table.items():
        if key in (*NOT_CONSTANTS, "transparent"):
            continue
        if isinstance(value, dict):
            yield from constants(value, key)
        else:
            yield parent, key


def catalogue(name):
    return {oil: row for oil, row in CATALOGUE[name].items() if oil != "source"}.items()


def span(name, key):
    """Return the range that an entry states in per cent, as a part."""
    return 0.01 * float(re.search(r"(\d+) %", OILS.entries()[name].evidence[key][1])[1])


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.table["name"])
def test_each_number_says_how_it_is_known(entry):
    keys = list(constants(entry.table))
    for parent, key in keys:
        known = entry.evidence.get(key) or entry.evidence.get(parent)
        assert known is not None, (parent, key)
        kind, within, source = known
        assert kind in KINDS
        assert within
        assert source or kind == "assumed"
    assert entry.evidence.keys() <= {word for pair in keys for word in pair}
    assert entry.family


def test_there_are_oils_of_each_family_and_most_are_measured():
    oils = OILS.entries().values()
    families = {one.family for one in oils}
    assert families >= {"mineral", "PAO", "ester", "polyglycol", "traction fluid", "pure liquid"}
    kinds = [(one.evidence.get("nu_40") or one.evidence["eta_0"])[0] for one in oils]
    assert sum(kind in ("measured", "correlation", "data sheet") for kind in kinds) >= 30


@pytest.mark.parametrize(("name", "row"), catalogue("measured"))
def test_measured_viscosities_are_within_the_stated_range(name, row):
    law = oil(name).viscosity
    for celsius, eta, alpha in zip((30, 60, 100), *row, strict=True):
        kelvin = celsius + 273.15
        # the range is rounded up to a whole per cent
        assert 1e3 * law.ambient(kelvin) == pytest.approx(eta, rel=span(name, "eta_0"))
        if alpha:
            found = 1e9 * law.pressure_coefficient_at(kelvin)
            assert found == pytest.approx(alpha, rel=span(name, "alpha"))


@pytest.mark.parametrize(("name", "row"), catalogue("correlated"))
def test_correlations_are_within_the_stated_range(name, row):
    law = oil(name).viscosity
    for kelvin, eta, alpha in zip((313.15, 343.15, 373.15), *row, strict=True):
        assert 1e3 * law.ambient(kelvin) == pytest.approx(eta, rel=span(name, "eta_0"))
        found = 1e9 * law.pressure_coefficient_at(kelvin)
        assert found == pytest.approx(alpha, rel=span(name, "alpha"))


@pytest.mark.parametrize(("name", "row"), catalogue("viscometer"))
def test_oils_of_the_viscometer_have_its_numbers(name, row):
    nu_40, nu_100, density, limit, first, slope = row
    found = oil(name)
    assert found.viscosity.nu_40 == pytest.approx(1e-6 * nu_40)
    assert found.viscosity.nu_100 == pytest.approx(1e-6 * nu_100)
    assert found.density.ambient(288.75) == pytest.approx(density)
    assert found.shear.stress_scale(1e9) == pytest.approx(1e9 * limit)
    inverse = 1e7 * first + 1e5 * slope * 313.15
    assert found.viscosity.pressure_coefficient == pytest.approx(
        1 / inverse, rel=2.5e-3
    )  # 3 digits


@pytest.mark.parametrize(("name", "row"), catalogue("lines"))
def test_oils_by_their_viscosity_line(name, row):
    m, n, density, fall = row
    law = oil(name).viscosity
    for kelvin, found in ((313.15, law.nu_40), (373.15, law.nu_100)):
        line = 10**10 ** (m - n * math.log10(kelvin)) - 0.7
        assert 1e6 * found == pytest.approx(line, rel=5e-4)  # four digits
    assert oil(name).density.ambient(288.15) == pytest.approx(density)
    assert oil(name).density.beta == pytest.approx(1e-4 * fall)
    assert law.pressure_coefficient == pytest.approx(by_index(oil(name)), rel=5e-3)  # three digits


def by_index(found):
    """Return the pressure coefficient by Roelands' index, as Nguyen-Schaefer gives it."""

    def height(kelvin):
        kinematic = {313.15: found.viscosity.nu_40, 373.15: found.viscosity.nu_100}[kelvin]
        density = found.density.rho_0 * (1 - found.density.beta * (kelvin - 288.15))
        return math.log10(math.log10(1e3 * kinematic * density) + 1.2)

    high, low = height(313.15), height(373.15)
    index = (7.81 * (high - low)) ** 1.5 * (0.885 - 0.864 * high)
    ester = OILS.entries()[found.name].family == "ester"
    return 5.1e-9 * index * (math.log(found.viscosity.eta_0) + 9.67) / (1.35 if ester else 1.0)


def test_the_index_is_good_to_its_range_where_the_coefficient_was_measured():
    errors = []
    for name, _ in catalogue("measured"):
        law = oil(name).viscosity
        high, low = (math.log10(math.log10(1e3 * law.ambient(t)) + 1.2) for t in (313.15, 373.15))
        index = (7.81 * (high - low)) ** 1.5 * (0.885 - 0.864 * high)
        errors.append(index / law.pressure_index - 1)
    assert max(map(abs, errors)) < 0.25
    assert sum(error**2 for error in errors) / len(errors) < 0.12**2
