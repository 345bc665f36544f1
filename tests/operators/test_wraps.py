"""A film whose last row is the first one again: operators do not depend on where its ends are."""

import numpy as np
import pytest

from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.contact.problem import ContactProblem
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels import transfer
from tehl.kernels.faces import CLOSED, WRAPPED
from tehl.operators.energy import FilmState
from tehl.operators.heated_film import HeatedFilm
from tehl.operators.heights import full_weighting
from tehl.operators.jacobian import interpolation, neighbour
from tehl.operators.transfer import refine_signed
from tests.kernels.interpreted import interpreted

ENDS = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0))
GRID = Grid(nx=65, ny=17, domain=ENDS, mirror=False, wraps=True)
EDGES = CLOSED + WRAPPED
python = interpreted("reynolds")


def moved(field: Array, rows: int) -> Array:
    """Return a field that repeats itself, some rows further north."""
    found = np.roll(field[:-1], rows, axis=0)
    return np.concatenate([found, found[:1]])


def ripples(grid: Grid = GRID, seed: int = 1) -> Array:
    """Return random values that repeat themselves, zero on the first and last column."""
    found = np.random.default_rng(seed).random(grid.shape)
    found[-1], found[:, [0, -1]] = found[0], 0.0
    return found


def test_neighbours_beyond_the_ends_are_those_of_the_other_end():
    inner, numbers = np.ones(GRID.shape, bool), np.arange(17.0)
    field = np.tile(numbers[:, None], (1, GRID.nx)).ravel()
    for way, row in ((-1, python.row_below), (1, python.row_above)):
        there = (neighbour(GRID, inner, way, 0, closed=True) @ field).reshape(GRID.shape)[:, 3]
        assert there.tolist() == [row(j, 17, EDGES) for j in range(17)]
    assert [python.row_below(0, 17, EDGES), python.row_above(16, 17, EDGES)] == [15, 1]
    assert [python.row_below(0, 17, CLOSED), python.row_above(16, 17, CLOSED)] == [1, 15]


@pytest.mark.parametrize("way", ["restrict_residual", "restrict_pressure", "weigh", "refine"])
def test_transfers_do_not_depend_on_where_the_ends_are(way):
    coarse, fine = GRID.coarser(), ripples()

    def transferred(field: Array) -> Array:
        if way == "weigh":
            return full_weighting(field, GRID, coarse)
        if way == "refine":
            return refine_signed(field[::2, ::2], GRID)
        out = np.zeros(coarse.shape)
        getattr(transfer, way)(field, EDGES, out)
        return out

    rows = 6 if way == "refine" else 3  # of the grid that comes out
    found, expected = transferred(moved(fine, 6)), moved(transferred(fine), rows)
    np.testing.assert_allclose(found, expected, rtol=1e-14)
    assert np.array_equal(found[0], found[-1])


def test_one_coarse_row_stands_for_both_ends():
    coarse = GRID.coarser()
    fine = (interpolation(GRID, coarse) @ ripples(coarse).ravel()).reshape(GRID.shape)
    assert np.array_equal(fine[0], fine[-1])
    assert not interpolation(GRID, coarse)[:, -coarse.nx :].nnz


def test_the_heat_of_a_film_does_not_depend_on_where_its_ends_are():
    """With flow along y; a shift by 5 rows of 16 puts the ends into other blocks of rows."""
    problem = ContactProblem.model_validate({
        "contact": {"type": "roller", "radius": "10 mm", "length": "0.2 mm", "ends": "periodic",
                    "moes_load": 50.0, "moes_speed": 10.0, "slide_roll_ratio": 0.3},
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {"name": "mineral-oil", "shear": {"law": "eyring", "stress": 5e6}},
        "thermal": {"temperature": "40 degC", "sources": "line"},
    })  # fmt: skip
    scaled = ScaledProblem.of(problem)
    x, y = GRID.x[None], np.pi * GRID.y[:, None]
    waves = 1.0 + 0.05 * np.cos(y + 1.0 + 3.0 * x) + 0.03 * np.sin(2.0 * y)
    pressure = np.sqrt(np.maximum(1.0 - x**2, 0.0)) * waves
    film = 0.05 + 0.3 * np.maximum(x**2 - 1.0, 0.0) + 0.005 * np.cos(y - 2.0 * x)
    states = []
    for rows in (0, 5):
        states.append(FilmState(GRID, HeatedFilm(scaled), 2))
        states[-1].set_film(moved(pressure, rows), moved(film, rows))
        for _ in range(12):
            change = states[-1].sweep(5)
        assert change < 1e-6
    first, second = (state.temperature for state in states)
    assert float(np.ptp(first, axis=2).max()) > 1.0
    assert second[..., :-1] == pytest.approx(np.roll(first[..., :-1], 5, axis=2), abs=1e-8)
    for name in ("mobility", "density", "tau_x"):
        there, here = (state.view(name).T for state in states)
        np.testing.assert_allclose(here, moved(there, 5), rtol=1e-9, atol=1e-12)
