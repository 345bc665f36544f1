"""The discrete Reynolds operator against exact solutions and by its order."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.base.typing import Array
from tehl.contact.options import ROLLER_ENDS, Domain
from tehl.estimate.grid import Grid
from tehl.kernels import cavities, properties, reynolds
from tehl.kernels.faces import CLOSED, Stencil
from tehl.operators.influence import influence_of, matrix_of
from tehl.operators.reynolds import (
    line_influence,
    line_shapes,
    of_second_order,
    steady_flux,
    steady_stencil,
    steady_wedge,
)
from tests.kernels.interpreted import interpreted
from tests.operators.contacts import contact_groups, grid_of

python, faces = interpreted("reynolds"), interpreted("faces")
BOX = Domain(x=(-2.0, 2.0), y=(-1.5, 1.5))


def apply(grid: Grid, fields: dict[str, Array], *, ratio: float = 1.0, wedge: int = 2) -> Array:
    """L(p) for given p, h, eps, rho."""
    stencil = steady_stencil(grid, contact_groups(ratio), wedge)
    zero = np.zeros(grid.shape)
    film = properties.Film(
        p=fields.get("p", zero),
        h=fields.get("h", zero),
        eps=fields.get("eps", zero),
        rho=fields.get("rho", zero),
        drho=zero,
        eps_x=fields.get("eps", zero),
        eps_y=fields.get("eps", zero),
    )
    out = np.empty(grid.shape)
    reynolds.operator(film, stencil, out)
    return out


def order(error_of, coarse: int = 33, fine: int = 129) -> float:
    return float(np.log2(error_of(coarse) / error_of(fine)) / np.log2((fine - 1) / (coarse - 1)))


def poiseuille_error(points: int, *, mirror: bool, ratio: float) -> float:
    grid = grid_of(points, points, mirror=mirror, domain=BOX)
    x, y = grid.x[None, :], grid.y[:, None]
    kappa = contact_groups(ratio).ellipticity
    eps = 1.5 + 0.5 * np.sin(x) * np.cos(y)
    p = np.cos(x) * np.cos(2 * y)
    eps_x, eps_y = 0.5 * np.cos(x) * np.cos(y), -0.5 * np.sin(x) * np.sin(y)
    p_x, p_y = -np.sin(x) * np.cos(2 * y), -2 * np.cos(x) * np.sin(2 * y)
    exact = eps_x * p_x - eps * p + (eps_y * p_y - 4 * eps * p) / kappa**2
    error = apply(grid, {"p": p, "eps": eps}, ratio=ratio) - exact
    return float(np.abs(error[0 if mirror else 1 : -1, 1:-1]).max())


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("mirror", [True, False])
def test_the_poiseuille_term_is_of_second_order(mirror, ratio):
    assert order(lambda n: poiseuille_error(n, mirror=mirror, ratio=ratio)) == pytest.approx(
        2.0, abs=0.1
    )


@pytest.mark.parametrize("wedge", [1, 2, 3])
def test_the_wedge_that_a_film_keeps_in_time_is_that_of_its_operator(wedge):
    """Of a film that moves along x, against it, and of oil that cavities conserve."""
    grid = grid_of(9, 21, mirror=False, domain=BOX)
    h = 1.0 + np.random.default_rng(3).random(grid.shape)
    inner = (slice(1, -1), slice(1, -1))
    kept = -apply(grid, {"rho": np.ones(grid.shape), "h": h}, wedge=wedge)[inner]
    np.testing.assert_allclose(steady_wedge(h, grid, wedge)[inner], kept, rtol=1e-12, atol=1e-10)
    against = steady_wedge(h[:, ::-1], grid, wedge, backwards=True)[inner]
    np.testing.assert_allclose(against, -kept[:, ::-1], rtol=1e-12, atol=1e-10)
    zero, flags = np.zeros(grid.shape), (np.zeros(grid.shape, np.uint8) for _ in range(2))
    film = properties.Film(zero, h, zero, np.ones(grid.shape), zero, zero, zero, *flags)
    film = film._replace(layer=np.full(grid.shape[0], np.inf))
    stencil = steady_stencil(grid, contact_groups(1.0), wedge, conserves=True)
    cavities.mark_second_order(film, stencil)
    out = np.empty(grid.shape)
    reynolds.operator(film, stencil, out)
    flux = steady_flux(film, h, grid, wedge)[inner]
    np.testing.assert_allclose(flux, -out[inner], rtol=1e-12, atol=1e-10)


def wedge_error(points: int, wedge: int, *, upstream: bool = False) -> float:
    grid = grid_of(points, points, mirror=True, domain=BOX)
    x, y = grid.x[None, :], grid.y[:, None]
    rho, h = 1.2 + 0.1 * np.sin(x + y), 1.0 + 0.5 * x**2 + 0.5 * y**2
    exact = -(0.1 * np.cos(x + y) * h + rho * x)
    error = apply(grid, {"rho": rho, "h": h}, wedge=wedge) - exact
    last = int(np.searchsorted(grid.x, 0.0)) if upstream else -1
    return float(np.abs(error[:-1, 2:last]).max())  # the first node has only one upstream


@pytest.mark.parametrize("wedge", [1, 2])
def test_the_wedge_term_has_the_chosen_order(wedge):
    assert order(lambda n: wedge_error(n, wedge)) == pytest.approx(wedge, abs=0.1)


def test_a_wedge_of_third_order_is_one_upstream_of_the_centre():
    assert order(lambda n: wedge_error(n, 3, upstream=True)) == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize("factor", [1.0, 1.5, 4.0, 10.0])
def test_the_conductance_of_a_face_is_a_geometric_or_a_logarithmic_mean(factor):
    stencil = steady_stencil(grid_of(33, 33, mirror=True, domain=BOX), contact_groups(), 3)
    falling, rising = (0.5 * faces.both_x(stencil, *pair) for pair in ((factor, 1), (1, factor)))
    assert falling == pytest.approx(factor**0.5)
    exact = (factor - 1.0) / np.log(factor) if factor > 1.0 else 1.0
    assert rising == pytest.approx(exact, rel=0.02)


def closed_stencil(wedge: int) -> Stencil:
    """Return the weights on a roller."""
    ends = Domain.model_construct(x=(-3.4, 1.5), y=ROLLER_ENDS)
    return steady_stencil(grid_of(33, 33, mirror=True, domain=ends), contact_groups(), wedge)


def between_lines(stencil: Stencil, here: tuple[float, float], there: tuple[float, float]) -> float:
    """Return the conductance between two lines, each with its mobility and film."""
    eps = [mobility * film**3 for mobility, film in (here, there)]
    return 0.5 * faces.both(stencil, *eps, faces.opening_power(stencil, here[1], there[1]))


@pytest.mark.parametrize("wedge", [1, 2, 3])
def test_films_of_lines_of_a_roller_conduct_by_their_geometric_mean_on_all_grids(wedge):
    closed = closed_stencil(wedge)
    for one in (closed, of_second_order(closed)):
        assert between_lines(one, (1.0, 1.0), (1.0, 20.0)) == pytest.approx(20.0**1.5)
    open_ = steady_stencil(grid_of(33, 33, mirror=True, domain=BOX), contact_groups(), wedge)
    assert between_lines(of_second_order(open_), (1.0, 1.0), (1.0, 20.0)) == pytest.approx(4000.5)


@pytest.mark.parametrize("opening", [1.0, 5.0])
def test_oil_flows_out_of_a_line_of_a_roller_the_faster_the_larger_its_pressure(opening):
    """By a geometric mean of all it would not beyond 2/alpha: two pressures have one flow."""
    falls = np.linspace(0.0, 12.0, 49)  # alpha times the fall of the pressure
    stencil = closed_stencil(2)
    flows = np.array(
        [fall * between_lines(stencil, (np.exp(-fall), 1.0), (1.0, opening)) for fall in falls]
    )
    assert (np.diff(flows) > 0.0).all()
    exact = opening**1.5 * -np.expm1(-falls)  # that of a pressure linear between the lines
    assert flows[falls < 2.4] == pytest.approx(exact[falls < 2.4], rel=0.02)


@pytest.mark.parametrize("wedge", [1, 2, 3])
def test_the_wedge_of_a_linear_film_is_exact_from_the_first_node_on(wedge):
    grid = grid_of(33, 33, mirror=True, domain=BOX)
    film = 5.0 + np.broadcast_to(grid.x, grid.shape)
    out = apply(grid, {"rho": np.ones(grid.shape), "h": film.copy()}, wedge=wedge)
    np.testing.assert_allclose(out[:-1, 1:-1], -1.0, rtol=1e-12)


def sommerfeld_residual(points: int) -> float:
    """Residual of the exact full film between rigid paraboloids, over its largest term.

    ``p = -(6/5) eta u_s x / h^2`` solves ``div(h^3 grad p) = 6 eta u_s h_x`` for
    ``h = h_0 + (x^2 + y^2)/2`` (R = 1); with eps = h^3/6 it reads L(p) = 0.
    """
    grid = grid_of(points, points, mirror=True, domain=BOX)
    x, y = grid.x[None, :], grid.y[:, None]
    h = 0.5 + 0.5 * (x**2 + y**2)
    p = -1.2 * x / h**2
    out = apply(grid, {"p": p, "h": h, "eps": h**3 / 6.0, "rho": np.ones(grid.shape)})
    return float(np.abs(out[:-1, 2:-1]).max())


def test_the_exact_film_between_paraboloids_has_a_residual_of_second_order():
    assert order(sommerfeld_residual, 65, 257) == pytest.approx(2.0, abs=0.15)
    assert sommerfeld_residual(257) < 5e-3  # (h/h_0)^2 = 1e-3 times a few of the largest slope 1


def test_half_a_domain_and_the_full_one_have_the_same_operator():
    rng = np.random.default_rng(5)
    half, full = (grid_of(17, 17, mirror=mirror) for mirror in (True, False))
    fields = {name: rng.random(half.shape) for name in ("p", "h", "eps", "rho")}
    by_half = apply(half, fields)
    by_full = apply(full, {name: half.unfold(field) for name, field in fields.items()})
    np.testing.assert_allclose(by_half, by_full[8:], rtol=1e-12, atol=1e-9)


def test_a_dipole_changes_the_film_locally():
    grid = grid_of(65, 65, mirror=True, domain=BOX)
    point, dipole = line_influence(influence_of(grid, contact_groups()))
    assert point[0] == point.max()
    # a quadrupole in its far field: falls off with the third power of the distance
    assert abs(dipole[7]) < 0.02 * dipole[0]
    assert point[7] > 0.02 * point[0]


@pytest.mark.parametrize("mirror", [True, False])
def test_dipoles_on_lines_that_crowd_have_no_load_and_bend_their_line_as_stated(mirror):
    ends = Domain.model_construct(x=(-1.0, 1.0), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=33, domain=ends, mirror=mirror, crowding=1.8)
    influence, i = influence_of(grid, contact_groups(4.0)), 16
    shapes, matrix = line_shapes(grid, influence, (0.25, 0.25)), matrix_of(grid, influence)
    rows = grid.shape[0]
    for j in range(rows):
        change = np.zeros(grid.shape)
        neighbours = python.row_below(j, rows, CLOSED), python.row_above(j, rows, CLOSED)
        along, aside, *_ = shapes.parts[j]
        change[j, i], change[j, [i - 1, i + 1]] = 1.0, -along
        for row in set(neighbours):
            # as a sweep adds them: from the north to the line south and from the south
            south, north = python.row_below(row, rows, CLOSED), python.row_above(row, rows, CLOSED)
            for side, beside in ((2, south), (3, north)):
                change[row, i] -= shapes.parts[row, side] if beside == j else 0.0
        loads = change.sum(axis=1) * grid.widths
        assert loads.sum() == pytest.approx(0.0, abs=1e-12 * grid.widths[j])
        if mirror and j < 2:  # here images count too
            continue
        assert -change[list(neighbours), i].mean() == pytest.approx(aside, rel=1e-12)
        found = (matrix @ change.ravel()).reshape(grid.shape)[j, i : i + 8]
        # the matrix takes the mean of the work of each line on the other
        np.testing.assert_allclose(found, shapes.dipole[j], atol=0.03 * shapes.dipole[j, 0])
        if not mirror:
            point = matrix[j * grid.nx + i].reshape(grid.shape)[j, i : i + 8]
            np.testing.assert_allclose(point, shapes.point[j], rtol=0.05)


def test_lines_that_hardly_crowd_have_the_dipoles_of_even_ones():
    ends = Domain.model_construct(x=(-1.0, 1.0), y=(-1.0, 1.0))
    even = Grid(nx=33, ny=33, domain=ends, mirror=True)
    influence = influence_of(even, contact_groups(4.0))
    ratio = (influence.dx / influence.dy) ** 2
    parts = 0.5 / (1.0 + ratio), 0.5 * ratio / (1.0 + ratio)
    nearly = replace(even, crowding=1e-4)
    for one, other in zip(
        line_shapes(nearly, influence, parts, 2),
        line_shapes(even, influence, parts, 2),
        strict=True,
    ):
        np.testing.assert_allclose(one[:-3], other[:-3], rtol=1e-6)
