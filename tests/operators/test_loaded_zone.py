"""The loaded zone: its area, its symmetry, and the order of sums over it."""

import numpy as np
import pytest

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.operators.load import Load
from tehl.operators.loaded_zone import (
    RADIUS,
    beside,
    contact_mean,
    cut_error,
    is_inside,
    wet_part,
    zone_of,
    zone_part,
)


def disc(points: int, edge: float = 3.1, skew: float = 0.0) -> float:
    """Return the integral of 1 + x over the zone by the sum on a grid that is not aligned to it."""
    x, y = np.linspace(-edge, 2.7, points), np.linspace(-2.9, edge, points)
    area = (x[1] - x[0]) * (y[1] - y[0])
    return float(area * (zone_part(x, y, skew=skew) * (1.0 + 0.3 * x)).sum())


@pytest.mark.parametrize("skew", [0.0, -0.8])
def test_the_sum_over_the_zone_is_of_second_order(skew):
    exact = np.pi * RADIUS**2 * np.sqrt(1.0 - skew**2)
    coarse, fine = (abs(disc(points, skew=skew) - exact) for points in (41, 161))
    assert coarse < 2e-3 * exact
    assert fine < coarse / 4.0


@pytest.mark.parametrize("film", [3.0, 5.0])
@pytest.mark.parametrize(("mesh", "most"), [(2.5, 1.0), (1.25, 1.0), (0.6, 1.0), (0.3, 0.3)])
def test_cells_that_the_edge_of_the_zone_cuts_err_by_no_more_than_they_are_said_to(
    film: float, mesh: float, most: float
) -> None:
    exact, half = 2.0 * np.pi * np.log(1.0 + 0.5 * RADIUS**2 / film), 20.0 * mesh
    parts = []
    for shift in np.linspace(0.0, mesh, 7):
        ends = (shift - half, shift + half)
        grid = Grid(nx=41, ny=41, domain=Domain(x=ends, y=(-half, half)), mirror=False)
        rate = 1.0 / (film + 0.5 * (grid.x**2 + grid.y[:, None] ** 2))
        found = mesh**2 * (zone_part(grid.x, grid.y) * rate).sum()
        parts.append(abs(found / exact - 1.0) / cut_error(grid))
    assert max(parts) <= most


def test_half_a_symmetric_domain_has_the_same_parts():
    grid = Grid(nx=65, ny=65, domain=Domain(x=(-4.5, 2.0), y=(-3.0, 3.0)), mirror=True)
    whole = zone_part(grid.x, np.linspace(-3.0, 3.0, 65))
    difference = np.abs(grid.unfold(zone_of(grid)) - whole)
    assert difference[:32].max() < 1e-12
    assert difference[32].max() < 0.01  # the strips of a half cell are half as wide


@pytest.mark.parametrize("mirror", [True, False])
@pytest.mark.parametrize("skew", [0.0, -0.8])
def test_what_a_narrow_grid_has_of_the_zone_and_what_lies_beside_it_make_all(mirror, skew):
    grid = Grid(nx=129, ny=65, domain=Domain(x=(-4.5, 2.0), y=(-1.4, 1.4)), mirror=mirror)
    inside = Load(grid).integral(zone_of(grid, skew))
    exact = np.pi * RADIUS**2 * np.sqrt(1.0 - skew**2)
    assert inside + beside(grid, np.ones(grid.shape), skew) == pytest.approx(exact, rel=5e-3)
    wide = Grid(nx=129, ny=65, domain=Domain(x=(-4.5, 2.0), y=(-2.0, 2.0)), mirror=mirror)
    assert beside(wide, np.ones(wide.shape), skew) == 0.0


def test_nodes_within_the_zone_count_fully_and_those_outside_not():
    axis = np.linspace(-4.0, 4.0, 81)
    part, radius = zone_part(axis, axis), np.hypot.outer(axis, axis)
    assert np.abs(part[radius < RADIUS - 0.15] - 1.0).max() < 1e-12
    assert (part[radius > RADIUS + 0.15] == 0.0).all()
    assert is_inside(axis, axis).sum() == (radius <= RADIUS).sum()
    partly = zone_part(axis, axis, skew=0.6)
    assert (partly[is_inside(axis, axis, 0.6)] > 0.3).all()
    assert (partly[~is_inside(axis, axis, 0.6)] < 0.7).all()


@pytest.mark.parametrize("front", [0.5, 0.63, 0.99, 1.2, 1.49])
def test_the_front_of_a_discrete_film_is_found_between_nodes(front):
    """Nodal values of the discrete equation P'' = 2 with complementarity; front in mesh widths."""
    beta = 2.0 * (front - 1.0)
    nodes = np.arange(6.0, -1.0, -1.0)
    pressure = np.append(nodes**2 + beta * nodes, 0.0)[None, :]
    # cells reach half a mesh width beyond the last wet node, node 5; the front lies `front` beyond
    assert wet_part(pressure)[0].sum() == pytest.approx(6.0 + front - 0.5)


def test_a_single_wet_node_is_not_widened():
    assert wet_part(np.array([[0.0, 1.0, 0.0, 0.0]])).sum() == 1.0


def test_the_mean_over_a_contact_within_a_cell_is_the_value_at_its_middle():
    x, y = np.linspace(-4e4, 4e4, 81), np.linspace(0.0, 4e4, 41)
    field = 2.0 + np.hypot.outer(y, x)
    assert contact_mean(x, y, field) == 2.0
