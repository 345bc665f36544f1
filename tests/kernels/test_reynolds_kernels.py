"""Properties and operator of the Reynolds equation against numpy and exact values."""

import numpy as np
import pytest

from tehl.kernels import properties, reynolds
from tehl.kernels.faces import CLOSED, STEADILY
from tests.kernels.reynolds_twin import isotropic, operator_twin, random_film, stencil_of

MIRROR = pytest.mark.parametrize("mirror", [0, 1])


@MIRROR
@pytest.mark.parametrize("third", [False, True])
def test_the_operator_equals_its_numpy_twin(mirror, third):
    film, stencil = random_film((7, 11)), stencil_of(mirror, third=third, fore=6)
    out = np.full((7, 11), 9.0)
    reynolds.operator(film, stencil, out)
    np.testing.assert_allclose(out, operator_twin(film, stencil), rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize("third", [False, True])
def test_surfaces_that_do_not_spin_have_the_plain_wedge_turned_in_any_direction(third):
    """Speeds along x, against x, along y and against y are the same operator, turned."""
    shape, size = (9, 9), 0.25
    film = random_film(shape)
    stencil = stencil_of(0, dx=size, dy=size, third=third, fore=100)
    film.p[:] = 0.0  # the wedge alone
    plain = operator_twin(film, stencil)
    one, none = np.ones(9), np.zeros(9)
    turns = (
        (one, none, lambda field: field),
        (-one, none, lambda field: field[:, ::-1]),
        (none, one, lambda field: field.T),
        (none, -one, lambda field: field.T[::-1]),
    )
    for speed, drift, turn in turns:
        # behind the centre half the third difference: the centre is not within the grid
        fore = -100 if speed[0] < 0.0 else 100
        turned = [np.ascontiguousarray(turn(field)) for field in film[:7]]
        moved = film._replace(**dict(zip(film._fields[:7], turned, strict=True)))
        out = np.empty(shape)
        reynolds.operator(
            moved._replace(speed=speed, drift=np.tile(drift, (9, 1))),
            stencil._replace(fore=fore),
            out,
        )
        np.testing.assert_allclose(out, turn(plain), rtol=1e-12, atol=1e-11)


def test_the_layer_limits_what_comes_in_through_a_closed_end():
    """Of scarce oil that of the layer, else what the end line passes on, as if it was flooded."""
    shape, speed = (6, 9), 0.7
    film = random_film(shape)
    film.p[:] = 0.0  # the wedge alone
    marks = np.zeros(shape, np.uint8), np.ones(shape, np.uint8)
    film = film._replace(speed=np.zeros(6), partial=marks[0], second=marks[1])
    stencil = stencil_of(CLOSED)
    widths, mass = np.array([0.5, 1.0, 1.0, 1.0, 1.0, 0.5]), film.rho * film.h
    passed = 0.5 * (mass[0] + mass[1])[1:-1]  # where it enters rho H continues linearly
    for way in (1, -1):
        drift = np.full(shape, speed)
        drift[0] *= 2.0  # half a width
        turned = [np.ascontiguousarray(field[::way]) for field in film[:7]]
        moved = film._replace(**dict(zip(film._fields[:7], turned, strict=True)))
        moved, found = moved._replace(drift=way * drift[::way]), []
        for layer in (0.1, 0.3, np.inf):
            out = np.empty(shape)
            reynolds.operator(
                moved._replace(layer=np.full(6, layer)), stencil._replace(conserves=STEADILY), out
            )
            found.append(widths @ out[:, 1:-1] / (stencil.w0 - stencil.w2))
        np.testing.assert_allclose(found[1] - found[0], speed * 0.2, rtol=1e-12)
        np.testing.assert_allclose(found[2] - found[0], speed * (passed - 0.1), rtol=1e-12)
        flooded = np.empty(shape)
        reynolds.operator(moved, stencil, flooded)
        np.testing.assert_allclose(out, flooded, rtol=1e-12, atol=1e-12)


@MIRROR
def test_the_residual_counts_wet_nodes_and_those_that_ought_to_be(mirror):
    shape = (7, 11)
    film, stencil = random_film(shape, 1), stencil_of(mirror)
    film.p[2:4, 5:9] = 0.0
    rhs = 100.0 * np.random.default_rng(2).standard_normal(shape)
    out = np.empty(shape)
    mean = reynolds.residual(film, stencil, rhs, 0.3, out)
    r = rhs - operator_twin(film, stencil)
    inner = np.zeros(shape, bool)
    inner[0 if mirror else 1 : -1, 1:-1] = True
    wet = inner & (film.p > 0.0)
    np.testing.assert_allclose(out, np.where(wet, r, 0.0), rtol=1e-12, atol=1e-10)
    weight = np.full(shape, 1.0 + mirror)
    weight[0] = 1.0
    weight *= wet | (inner & (r < 0.0))
    diagonal = np.empty(shape)
    reynolds.diagonal(film, stencil, 0.3, diagonal)
    diagonal[~inner] = 1.0
    assert mean == pytest.approx((weight * np.abs(r) / diagonal).sum() / weight.sum(), rel=1e-12)


def linear(pressure: np.ndarray, step: float) -> np.ndarray:
    """Return the table of a density that grows with the pressure."""
    return np.column_stack([1.0 + 0.2 * pressure, np.full(pressure.size, 0.2 * step)])


def test_properties_reproduce_cubics_and_hold_the_film_at_its_floor():
    step, nodes = 0.5, np.arange(9) * 0.5
    mobility = np.column_stack([2.0 + nodes**3, 3.0 * nodes**2 * step])
    flow = properties.FlowTable(mobility, linear(nodes, step), step)
    p = np.array([[-1.0, 0.0, 0.3, 1.7, 3.99, 4.0, 0.5, 0.9, 2.1]])
    h = np.array([[0.5, 1e-9, 0.7, 0.01, 1.0, 2.0, 0.2, 0.1, 3.0]])
    film = isotropic(p, h, *np.empty((3, 1, 9)))
    properties.properties(film, flow, 0.1)
    positive = np.maximum(p, 0.0)
    np.testing.assert_allclose(film.eps, (2.0 + positive**3) * np.maximum(h, 0.1) ** 3, rtol=1e-13)
    np.testing.assert_allclose(film.rho, 1.0 + 0.2 * positive, rtol=1e-13)
    np.testing.assert_allclose(film.drho, 0.2, rtol=1e-13)


def test_the_factors_of_a_heated_film_give_its_mobility_and_density_back():
    """At the pressure they are taken at, whatever part of the mobility follows the pressure."""
    step, generator = 0.5, np.random.default_rng(5)
    rows = np.arange(9) * step
    mobility = np.column_stack([np.exp(-rows), -step * np.exp(-rows)])
    flow = properties.FlowTable(mobility, linear(rows, step), step)
    p, h, *others = 3.0 * generator.random((9, 4, 11))
    heated = properties.Heated(*(0.2 + field for field in others[:5]))
    heated.over_exponent[:] /= 4.0
    film = properties.Film(p, h, *np.empty((5, 4, 11)))
    factors, thickness = properties.Factors(*np.empty((7, 4, 11))), film.conducting(0.5)
    properties.factors_of(heated, film._replace(h=np.ones_like(h)), flow, thickness, factors)
    properties.heated_properties(film, factors, flow, 0.5)
    cube = np.maximum(h, 0.5) ** 3
    np.testing.assert_allclose(film.eps, heated.mobility * cube, rtol=1e-12)
    np.testing.assert_allclose(film.eps_x, heated.mobility * cube * heated.stretch_x, rtol=1e-12)
    np.testing.assert_allclose(film.eps_y, heated.mobility * cube * heated.stretch_y, rtol=1e-12)
    np.testing.assert_allclose(film.rho, heated.density, rtol=1e-12)
    cold = isotropic(p, h, *np.empty((3, 4, 11)))
    properties.properties(cold, flow, 0.5)
    np.testing.assert_allclose(film.drho, cold.drho * heated.density / cold.rho, rtol=1e-12)


def test_the_tangent_of_a_thinning_film_is_the_derivative_of_its_flow():
    """By slope, film and pressure, for an Eyring oil that rolls, of which the flow is known.

    With x the stress at the wall over that of Eyring the mobility is 3 (x cosh x - sinh x)/x^3 over
    the viscosity, here exp(p).
    """
    film = np.linspace(0.3, 6.0, 8)
    slope, pressure = np.ones(8), 0.7 * film

    def flow_at(slope, film, pressure):
        x = slope * film
        thinning = 3.0 * (x * np.cosh(x) - np.sinh(x)) / x**3
        return np.exp(-pressure) * thinning * film**3 * slope

    x = slope * film
    stretch = x**2 * np.sinh(x) / (x * np.cosh(x) - np.sinh(x)) - 2.0  # dln flow / dln slope
    mobility = flow_at(slope, film, pressure) / (film**3 * slope)
    ones, rows, step = np.ones((1, 8)), np.arange(400) * 0.02, 0.02
    table = np.column_stack([np.exp(-rows), -step * np.exp(-rows)])
    law = properties.FlowTable(table, linear(rows, step), step)
    heated = properties.Heated(mobility[None], ones, ones, stretch[None], ones)
    level = isotropic(*np.array([pressure, film])[:, None], *np.empty((3, 1, 8)))
    level = level._replace(eps_x=np.empty((1, 8)), eps_y=np.empty((1, 8)))
    factors = properties.Factors(*np.empty((7, 1, 8)))
    at_one = level._replace(h=ones)
    properties.factors_of(heated, at_one, law, level.conducting(0.0), factors)

    def tangent(slope, film, pressure):
        level.p[:], level.h[:] = pressure, film
        properties.heated_properties(level, factors, law, 0.0)
        return level.eps_x[0] * slope

    here = {"slope": slope, "film": film, "pressure": pressure}
    for name, value in here.items():
        there = here | {name: value * (1.0 + 1e-6)}
        exact = flow_at(**there) - flow_at(**here)
        np.testing.assert_allclose(tangent(**there) - tangent(**here), exact, rtol=2e-5)


def test_a_broken_pressure_is_not_passed_over():
    shape = (5, 12)
    film, stencil = random_film(shape), stencil_of(mirror=0)
    film.p[2, 5] = np.nan
    out = np.empty(shape)
    reynolds.operator(film, stencil, out)
    assert np.isnan(out[2, 4:7]).all()
