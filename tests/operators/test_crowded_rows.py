"""Rows of the energy equation that crowd at the ends of a roller."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.operators.energy import driving_slopes, pressure_slopes
from tehl.operators.heated_film import closeness
from tehl.operators.surfaces import _between
from tests.operators.contacts import contact_groups

ENDS = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0))
CROWDED = Grid(nx=33, ny=65, domain=ENDS, mirror=True, crowding=2.0)


def test_differences_are_those_of_uniform_rows_times_the_closeness_of_second_order():
    errors = []
    for grid in (CROWDED, CROWDED.finer()):
        y, closer = grid.y, closeness(grid)[: grid.shape[0]]
        slope = np.gradient(np.cos(y), grid.dy) * closer
        errors.append(np.abs(slope + np.sin(y))[1:-1].max())
        assert closer[-1] > 5.0  # the last rows are close
    assert errors[0] < 2e-3
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert closeness(replace(CROWDED, crowding=0.0)).tolist() == [1.0] * 40


def test_sources_are_summed_on_uniform_rows():
    there, back = _between(CROWDED, 33)
    field = 1.0 + CROWDED.y
    assert there @ field == pytest.approx(np.linspace(1.0, 2.0, 33))
    assert back @ (there @ field) == pytest.approx(field)


@pytest.mark.parametrize("slopes", [pressure_slopes, driving_slopes])
def test_slopes_vanish_at_ends_and_symmetry_lines_but_not_where_the_film_wraps(slopes):
    whole = Grid(nx=33, ny=65, domain=ENDS, mirror=False)
    sides = Grid(nx=33, ny=65, domain=Domain(x=(-3.0, 1.5), y=(-2.0, 2.0)), mirror=False)
    wrapped = replace(whole, wraps=True)
    for grid, still in ((CROWDED, {0, 32}), (whole, {0, 64}), (sides, set()), (wrapped, set())):
        wave = np.sin(np.pi * grid.y[:, None] + 0.3) * (1.0 + 0.0 * grid.x)
        _, found = slopes(grid, contact_groups(3.0), wave)
        assert set(np.flatnonzero(np.abs(found).max(axis=1) < 1e-14)) == still
    groups = contact_groups(3.0)
    expected = np.pi * np.cos(np.pi * wrapped.y[:, None] + 0.3) / groups.ellipticity
    _, found = pressure_slopes(wrapped, groups, wave)
    assert found == pytest.approx(np.broadcast_to(expected, found.shape), abs=3e-3)
