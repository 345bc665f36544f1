"""Solids and the library of named ones."""

import re

import pytest

from tehl.base.errors import InputError
from tehl.contact.materials import SOLIDS, Solid, material, reduced_modulus
from tehl.lubricant.fluid import OILS


def test_the_reduced_modulus_is_twice_the_contact_modulus():
    steel = material("steel")
    contact_modulus = 1.0 / (2.0 * (1.0 - 0.3**2) / 206e9)
    assert reduced_modulus(steel, steel) == pytest.approx(2.0 * contact_modulus)
    assert reduced_modulus(steel, steel) == pytest.approx(226.4e9, rel=1e-3)


def test_a_rigid_partner_leaves_twice_the_compliance_of_the_other():
    soft = Solid(young_modulus=1e9, poisson_ratio=0.5)
    rigid = Solid(young_modulus=1e30, poisson_ratio=0.0)
    assert reduced_modulus(soft, rigid) == pytest.approx(2.0 * 1e9 / 0.75)


@pytest.mark.parametrize("name", list(SOLIDS.entries()))
def test_every_named_solid_is_complete_and_has_a_source(name: str):
    solid = material(name)
    assert solid.name == name
    assert solid.source
    assert solid.diffusivity is not None
    assert 1e-8 < solid.diffusivity < 2e-4


def test_a_solid_without_thermal_properties_has_no_diffusivity():
    assert Solid(young_modulus=1e9, poisson_ratio=0.3).diffusivity is None


def test_an_unknown_name_suggests_one_and_says_what_lists_them():
    with pytest.raises(InputError, match=r"did you mean steel.* tehl solids lists 24"):
        material("steal")


@pytest.mark.parametrize("ratio", [0.6, -1.0, float("nan")])
def test_an_invalid_poisson_ratio_is_rejected(ratio: float):
    with pytest.raises(InputError):
        Solid(young_modulus=2e11, poisson_ratio=ratio)


@pytest.mark.parametrize(
    ("alias", "name"),
    [
        ("100Cr6", "steel"),
        ("AISI 52100", "steel"),
        ("sae-52100", "steel"),
        ("STEEL", "steel"),
        ("Si3N4", "silicon-nitride"),
        ("Silicon Nitride", "silicon-nitride"),
        ("ZrO2", "zirconia"),
        ("n-bk7", "glass"),
        ("aluminum", "aluminium"),
    ],
)
def test_a_solid_is_found_by_other_names(alias: str, name: str):
    assert material(alias) == material(name)


def test_no_two_tables_have_one_name():
    for library in (SOLIDS, OILS):
        words = [word for one in library.entries().values() for word in one.words]
        plain = [re.sub(r"[\W_]+", "", word.lower()) for word in words]
        assert len(set(plain)) == len(plain)
