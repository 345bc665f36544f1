"""Load of a pressure field."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.contact.options import Domain
from tehl.operators.dry import dry_pressure, start_pressure
from tehl.operators.load import Load
from tests.operators.contacts import contact_groups, grid_of


@pytest.mark.parametrize("mirror", [True, False])
def test_hertz_pressure_carries_the_load(mirror):
    grid = grid_of(257, 257, mirror=mirror)
    pressure = dry_pressure(grid, contact_groups())
    # midpoint rule across the infinite slope at r = 1: h^(3/2) with h = 0.019
    assert Load(grid).integral(pressure) == pytest.approx(2 * np.pi / 3, rel=2.6e-3)


def test_half_a_domain_carries_the_load_of_the_full_one():
    half, full = (grid_of(33, 41, mirror=mirror) for mirror in (True, False))
    pressure = np.random.default_rng(0).random(half.shape)
    assert Load(half).integral(pressure) == pytest.approx(
        Load(full).integral(half.unfold(pressure)), rel=1e-13
    )


@pytest.mark.parametrize("mirror", [True, False])
def test_a_start_on_cells_larger_than_the_contact_carries_its_load(mirror):
    groups, fine = contact_groups(), grid_of(65, 65, mirror=mirror)
    whole = groups.shape.load
    assert np.array_equal(start_pressure(fine, groups, whole, 1.0), dry_pressure(fine, groups))
    wide = Domain(x=(-704.8, 320.4), y=(-633.0, 633.0))
    grid = replace(fine, nx=21, ny=21, domain=wide)
    assert not dry_pressure(grid, groups).any()
    for load in (whole, 0.3 * whole):
        pressure = start_pressure(grid, groups, load, 2.0)
        assert np.count_nonzero(pressure) > 4
        assert Load(grid).integral(pressure) == pytest.approx(load, rel=1e-12)
    # of another moment, smaller than the contact but wider than its cells
    fewer = start_pressure(fine, groups, 0.3 * whole, 2.0)
    assert Load(fine).integral(fewer) == pytest.approx(0.3 * whole, rel=0.02)
