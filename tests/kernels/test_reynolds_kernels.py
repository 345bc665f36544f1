"""Compiled Reynolds kernels against numpy twins, dense solves and finite differences."""

import numpy as np
import pytest

from tehl.kernels import reynolds
from tehl.kernels.reynolds import LANES, Batch, Film, Mesh, Relaxation

MIRROR = pytest.mark.parametrize("mirror", [0, 1])


def isotropic(p, h, eps, rho, drho):
    """A film that conducts alike along x and y."""
    return Film(p, h, eps, rho, drho, eps_x=eps, eps_y=eps)


def random_film(shape, seed=0):
    rng = np.random.default_rng(seed)
    return isotropic(*(0.5 + rng.random(shape) for _ in range(5)))


def mesh_of(mirror, dx=0.25, dy=0.4):
    return Mesh(1.0 / dx**2, 1.0 / dy**2, 1.5 / dx, -2.0 / dx, 0.5 / dx, mirror)


def relaxation_of(shape, xi=0.0, omega=(1.0, 1.0), influence=0.0):
    nx = shape[1]
    reach = np.arange(nx + 5)
    return Relaxation(
        xi=xi,
        omega_point=omega[0],
        omega_dipole=omega[1],
        point=influence / (1.0 + reach),
        dipole=influence / (1.0 + reach) ** 3,
        kind=np.zeros(shape, np.uint8),
        delta=np.zeros(shape),
        frozen=np.zeros(shape, np.uint8),
        steep=np.zeros(shape),
    )


def workspace(nx, first=1, lanes=1):
    cells = np.zeros(reynolds.at(nx + 6, 0))
    return Batch(first, lanes, np.zeros((LANES, nx)), cells)


def values(batch, nx, field):
    """A field of all cells, (nx, LANES), as a view."""
    cells = batch.cells.reshape(nx + 6, reynolds.FIELDS, LANES)
    return cells[3 : nx + 3, field]


def operator_twin(film, mesh):
    """The operator from slices of fields that are extended over the mirror line."""
    fields = film
    if mesh.mirror:
        fields = [np.vstack([a[1:2], a]) for a in film]
    p, h, eps, rho, *_ = fields
    middle, inner = slice(1, -1), slice(1, -1)
    east = (eps[:, 1:] + eps[:, :-1]) * np.diff(p, axis=1)
    north = (eps[1:] + eps[:-1]) * np.diff(p, axis=0)
    flow = rho * h
    wedge = np.zeros_like(p)
    wedge[:, 2:] = mesh.w0 * flow[:, 2:] + mesh.w1 * flow[:, 1:-1] + mesh.w2 * flow[:, :-2]
    wedge[:, 1] = (mesh.w0 - mesh.w2) * (flow[:, 1] - flow[:, 0])
    result = 0.5 * mesh.cx * np.diff(east, axis=1)[middle]
    result += 0.5 * mesh.cy * np.diff(north, axis=0)[:, inner] - wedge[middle, inner]
    out = np.zeros_like(film.p)
    out[0 if mesh.mirror else 1 : -1, 1:-1] = result
    return out


def dense_band(batch, nx, lane):
    band = np.zeros((nx, nx))
    for i in range(1, nx - 1):
        for s in range(-3, 3):
            if 1 <= i + s <= nx - 2:
                band[i, i + s] = values(batch, nx, reynolds.BAND + s + 3)[i, lane]
    return band[1:-1, 1:-1]


def random_band(nx, lanes, seed=0):
    """Bands that fall monotonically: the diagonal dominates, neighbours raise one another."""
    rng = np.random.default_rng(seed)
    batch = workspace(nx, lanes=lanes)
    for s in range(-3, 3):
        share = rng.random((nx, LANES))
        values(batch, nx, reynolds.BAND + s + 3)[:] = -6.0 - share if s == 0 else share
    values(batch, nx, reynolds.REST)[:] = rng.standard_normal((nx, LANES))
    pressure = np.maximum(rng.standard_normal((nx, LANES)), 0.0)
    values(batch, nx, reynolds.P)[:] = pressure
    return batch


@MIRROR
def test_the_operator_equals_its_numpy_twin(mirror):
    film, mesh = random_film((7, 11)), mesh_of(mirror)
    out = np.full((7, 11), 9.0)
    reynolds.operator(film, mesh, out)
    np.testing.assert_allclose(out, operator_twin(film, mesh), rtol=1e-12, atol=1e-11)


@MIRROR
def test_the_residual_counts_wet_nodes_and_those_that_ought_to_be(mirror):
    shape = (7, 11)
    film, mesh = random_film(shape, 1), mesh_of(mirror)
    film.p[2:4, 5:9] = 0.0
    rhs = 100.0 * np.random.default_rng(2).standard_normal(shape)
    out = np.empty(shape)
    mean = reynolds.residual(film, mesh, rhs, 0.3, out)
    r = rhs - operator_twin(film, mesh)
    inner = np.zeros(shape, bool)
    inner[0 if mirror else 1 : -1, 1:-1] = True
    wet = inner & (film.p > 0.0)
    np.testing.assert_allclose(out, np.where(wet, r, 0.0), rtol=1e-12, atol=1e-10)
    weight = np.full(shape, 1.0 + mirror)
    weight[0] = 1.0
    weight *= wet | (inner & (r < 0.0))
    diagonal = np.ones(shape)
    for j in range(0 if mirror else 1, shape[0] - 1):
        reynolds.line_diagonal(film, mesh, 0.3, j, diagonal[j])
    assert mean == pytest.approx((weight * np.abs(r) / diagonal).sum() / weight.sum(), rel=1e-12)


def test_properties_reproduce_cubics_and_hold_the_film_at_its_floor():
    step, nodes = 0.5, np.arange(9) * 0.5
    table = np.column_stack(
        [
            2.0 + nodes**3,
            3.0 * nodes**2 * step,
            1.0 + 0.2 * nodes,
            np.full(9, 0.2 * step),
        ]
    )
    p = np.array([[-1.0, 0.0, 0.3, 1.7, 3.99, 4.0]])
    h = np.array([[0.5, 1e-9, 0.7, 0.01, 1.0, 2.0]])
    film = isotropic(p, h, np.empty((1, 6)), np.empty((1, 6)), np.empty((1, 6)))
    reynolds.properties(film, table, step, 0.1)
    positive = np.maximum(p, 0.0)
    np.testing.assert_allclose(film.eps, (2.0 + positive**3) * np.maximum(h, 0.1) ** 3, rtol=1e-13)
    np.testing.assert_allclose(film.rho, 1.0 + 0.2 * positive, rtol=1e-13)
    np.testing.assert_allclose(film.drho, 0.2, rtol=1e-13)


def test_the_factors_of_a_heated_film_give_its_mobility_and_density_back():
    """At the pressure they are taken at, whatever part of the mobility follows the pressure."""
    step, generator = 0.5, np.random.default_rng(5)
    rows = np.arange(9) * step
    table = np.column_stack(
        [np.exp(-rows), -step * np.exp(-rows), 1.0 + 0.2 * rows, np.full(9, 0.2 * step)]
    )
    p, h, *others = 3.0 * generator.random((9, 4, 6))
    heated = reynolds.Heated(*(0.2 + field for field in others[:5]))
    heated.steep[:] /= 4.0
    film = reynolds.Film(p, h, *np.empty((5, 4, 6)))
    factors = reynolds.Factors(*np.empty((5, 4, 6)))
    reynolds.factors_of(heated, film._replace(h=np.ones_like(h)), table, step, factors)
    reynolds.heated_properties(film, factors, table, step, 0.5)
    cube = np.maximum(h, 0.5) ** 3
    np.testing.assert_allclose(film.eps, heated.mobility * cube, rtol=1e-12)
    np.testing.assert_allclose(film.eps_x, heated.mobility * cube * heated.stretch_x, rtol=1e-12)
    np.testing.assert_allclose(film.eps_y, heated.mobility * cube * heated.stretch_y, rtol=1e-12)
    np.testing.assert_allclose(film.rho, heated.density, rtol=1e-12)
    cold = isotropic(p, h, *np.empty((3, 4, 6)))
    reynolds.properties(cold, table, step, 0.5)
    np.testing.assert_allclose(film.drho, cold.drho * heated.density / cold.rho, rtol=1e-12)


def test_nodes_of_small_conductance_far_from_cavities_relax_as_dipoles():
    shape = (7, 9)
    film, mesh = random_film(shape), mesh_of(mirror=0)
    film.eps[:] = 1e-6
    film.eps[:, 6] = 1.0
    film.p[1, 1] = 0.0
    relaxation = relaxation_of(shape, xi=1.0)
    reynolds.mark_dipoles(film, mesh, relaxation)
    expected = np.zeros(shape, np.uint8)
    expected[1:-1, 1:5] = 1
    expected[1, 1] = expected[1, 2] = expected[2, 1] = 0
    np.testing.assert_array_equal(relaxation.kind, expected)


@MIRROR
@pytest.mark.parametrize("dipole", [0, 1])
def test_the_band_is_the_derivative_of_the_operator(dipole, mirror):
    shape, j = (5, 12), 1
    if mirror:
        j = 0
    nx = shape[1]
    film, mesh = random_film(shape, 4), mesh_of(mirror)
    relaxation = relaxation_of(shape, influence=0.4)
    relaxation.kind[j, 1:-1] = dipole
    batch = workspace(nx, first=j)
    reynolds.load_line(film, mesh, relaxation, batch, 0, (0, nx - 1))
    reynolds.fill_band(batch, mesh, relaxation, 1, nx - 2)
    band = dense_band(batch, nx, 0)
    shapes = relaxation.dipole if dipole else relaxation.point
    for k in range(1, nx - 1):
        change = np.zeros(shape)
        change[j, k] = 1.0
        if dipole:
            change[j, [k - 1, k + 1]] = -0.25
            change[[j + 1, abs(j - 1)], k] = -0.25
        lift = np.zeros(shape)
        lift[j] = shapes[np.abs(np.arange(nx) - k)]

        def moved(t, change=change, lift=lift):
            return operator_twin(
                film._replace(
                    p=film.p + t * change,
                    h=film.h + t * lift,
                    rho=film.rho + t * film.drho * change,
                ),
                mesh,
            )

        derivative = 0.5 * (moved(1.0) - moved(-1.0))[j, 1:-1]
        rows = np.arange(1, nx - 1)
        near = (rows >= k - 2) & (rows <= k + 3)
        np.testing.assert_allclose(band[near, k - 1], derivative[near], rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("lanes", [1, 5, LANES])
def test_band_solve_equals_a_dense_solve_in_every_lane(lanes):
    nx = 14
    batch = random_band(nx, lanes)
    reynolds.band_solve(batch, 1, nx - 2)
    for lane in range(lanes):
        rest = values(batch, nx, reynolds.REST)[1:-1, lane]
        expected = np.linalg.solve(dense_band(batch, nx, lane), rest)
        np.testing.assert_allclose(
            values(batch, nx, reynolds.U)[1:-1, lane], expected, rtol=1e-11, atol=1e-13
        )


def test_cavitated_and_kept_nodes_enter_the_solve_with_known_changes():
    nx = 10
    batch = random_band(nx, 1, seed=3)
    state = values(batch, nx, reynolds.STATE)
    state[4, 0], state[7, 0] = 1.0, 2.0
    reynolds.band_solve(batch, 1, nx - 2)
    u, p = (values(batch, nx, f)[:, 0] for f in (reynolds.U, reynolds.P))
    assert u[4] == -p[4]
    assert u[7] == 0.0
    lack = values(batch, nx, reynolds.REST)[1:-1, 0] - dense_band(batch, nx, 0) @ u[1:-1]
    np.testing.assert_allclose(np.delete(lack, [3, 6]), 0.0, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_policy_iteration_ends_with_complementary_pressure_and_residual(seed):
    nx = 25
    batch = random_band(nx, LANES, seed)
    p, rest = (values(batch, nx, f) for f in (reynolds.P, reynolds.REST))
    values(batch, nx, reynolds.STATE)[:] = (p <= 0.0) & (rest >= 0.0)
    low, high = reynolds.complementarity(batch, 1, nx - 2, nx - 2)
    assert (low, high) == (1, nx - 2)
    for lane in range(LANES):
        new = (p + values(batch, nx, reynolds.U))[1:-1, lane]
        u = values(batch, nx, reynolds.U)[1:-1, lane]
        lack = rest[1:-1, lane] - dense_band(batch, nx, lane) @ u
        assert new.min() > -1e-12
        assert lack[new < 1e-12].min(initial=0.0) > -1e-12
        np.testing.assert_allclose(lack[new > 1e-12], 0.0, atol=1e-11)


@MIRROR
@pytest.mark.parametrize("shape", [(25, 33), (20, 14)])
def test_lines_relaxed_side_by_side_equal_lines_relaxed_one_by_one(shape, mirror):
    film, mesh = random_film(shape, 5), mesh_of(mirror)
    rng = np.random.default_rng(6)
    film.p[rng.random(shape) < 0.2] = 0.0
    film.p[:, -6:] = 0.0
    film.eps[:, 4:9] = 1e-4
    rhs = 20.0 * rng.standard_normal(shape)
    relaxation = relaxation_of(shape, xi=0.1, omega=(0.8, 0.6), influence=0.1)
    relaxation.frozen[rng.random(shape) < 0.1] = 1
    one = film._replace(p=film.p.copy())
    reynolds.relax_lines(film, mesh, rhs, relaxation)
    assert relaxation.kind.any()
    relaxation.delta[:] = 0.0
    first = 0 if mirror else 1
    for colour in range(2):
        for j in range(first + colour, shape[0] - 1, 2):
            batch = workspace(shape[1], first=j)
            reynolds.relax_batch(one, mesh, rhs, relaxation, batch)
    reynolds.add_dipoles(one.p, relaxation.delta, mirror)
    np.testing.assert_allclose(film.p, one.p, rtol=1e-10, atol=1e-12)


@MIRROR
def test_relaxation_reduces_the_residual_of_a_linear_problem(mirror):
    shape = (17, 17)
    film = isotropic(*(np.ones(shape) for _ in range(5)))
    film.drho[:] = 0.0
    film.p[:, 1:-1] += np.random.default_rng(7).random((17, 15))
    mesh = Mesh(64.0, 64.0, 0.0, 0.0, 0.0, mirror)
    rhs = np.full(shape, -5.0)
    relaxation, out = relaxation_of(shape), np.empty(shape)
    before = reynolds.residual(film, mesh, rhs, 0.0, out)
    for _ in range(4):
        reynolds.relax_lines(film, mesh, rhs, relaxation)
    assert reynolds.residual(film, mesh, rhs, 0.0, out) < 0.15 * before


def test_a_line_without_oil_to_move_is_left_alone():
    shape = (5, 12)
    film, mesh = isotropic(*(np.ones(shape) for _ in range(5))), mesh_of(mirror=0)
    film.p[:] = 0.0
    reynolds.relax_lines(film, mesh, np.ones(shape), relaxation_of(shape))
    assert not film.p.any()


def test_frozen_nodes_keep_their_pressure():
    shape = (9, 13)
    film, mesh = random_film(shape, 8), mesh_of(mirror=1)
    relaxation = relaxation_of(shape)
    relaxation.frozen[2:5, 3:7] = 1
    before = film.p.copy()
    reynolds.relax_lines(film, mesh, np.zeros(shape), relaxation)
    np.testing.assert_array_equal(film.p[2:5, 3:7], before[2:5, 3:7])
    assert film.p.min() >= 0.0
    assert (film.p != before).any()


def test_a_broken_pressure_is_not_passed_over():
    shape = (5, 12)
    film, mesh = random_film(shape), mesh_of(mirror=0)
    film.p[2, 5] = np.nan
    out = np.empty(shape)
    reynolds.operator(film, mesh, out)
    assert np.isnan(out[2, 4:7]).all()
    rest = np.zeros(12)
    assert reynolds.wet_range(film.p[2] * 0.0, np.zeros(12, np.uint8), rest) == (5, 5)


@MIRROR
def test_the_stiffness_of_a_hollow_is_the_slope_of_the_flow_into_it(mirror):
    """At a node lower than its neighbours the conductance alone changes the flow: by its slope."""
    step, decay = 1e-3, 12.0
    rows = np.arange(4001) * step
    mobility, ones = np.exp(-decay * rows), np.ones_like(rows)
    table = np.stack([mobility, -decay * step * mobility, ones, 0.0 * ones], axis=1)
    mesh, p = mesh_of(mirror), 1.0 + 0.1 * np.random.default_rng(3).random((7, 8))
    p[3, 4] = 0.3
    fields = (np.empty_like(p) for _ in range(3))
    film, flows, nudge = isotropic(p, np.ones_like(p), *fields), [], 1e-5
    for sign in (-1.0, 1.0):
        moved = p.copy()
        moved[3, 4] += sign * nudge
        reynolds.properties(film._replace(p=moved), table, step, 0.0)
        out = np.empty_like(p)
        reynolds.operator(film, mesh, out)  # the pressure itself stays
        flows.append(out[3, 4])
    reynolds.properties(film, table, step, 0.0)
    steep = np.empty_like(p)
    reynolds.stiffen(film, mesh, table, step, steep)
    assert steep[3, 4] == pytest.approx((flows[0] - flows[1]) / (2 * nudge), rel=1e-2)
    assert (steep >= 0.0).all()


def test_a_steep_node_moves_by_less():
    shape, mesh = (7, 8), mesh_of(0)
    film, changes = random_film(shape), []
    for steep in (0.0, 50.0):
        p, relaxation = film.p.copy(), relaxation_of(shape)
        relaxation.steep[3, 4] = steep
        reynolds.relax_lines(film._replace(p=p), mesh, np.zeros(shape), relaxation)
        changes.append(abs(p[3, 4] - film.p[3, 4]))
    assert 0.0 < changes[1] < changes[0]
