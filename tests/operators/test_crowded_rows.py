"""Rows of the energy equation that crowd at the ends of a roller."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.operators.energy import still_rows
from tehl.operators.heated_film import closeness
from tehl.operators.surfaces import _between

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


def test_no_oil_flows_through_ends_and_symmetry_lines():
    whole = Grid(nx=33, ny=65, domain=ENDS, mirror=False)
    assert still_rows(CROWDED) == [0, 32]
    assert still_rows(whole) == [0, 64]
    sides = Grid(nx=33, ny=65, domain=Domain(x=(-3.0, 1.5), y=(-2.0, 2.0)), mirror=False)
    assert still_rows(sides) == []
