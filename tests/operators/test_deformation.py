"""Deflection by FFT, lines and multilevel sum against the direct sum, and against Hertz."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.contact.roller import Roller
from tehl.contact.shape import LINE
from tehl.estimate.grid import Grid
from tehl.operators.crowded import CrowdedDeformation
from tehl.operators.deformation import (
    DirectDeformation,
    FftDeformation,
    Flattening,
    LineDeformation,
    choose,
)
from tehl.operators.dry import dry_pressure
from tehl.operators.film import gap
from tehl.operators.influence import influence_of, matrix_of
from tehl.operators.multilevel import MultilevelDeformation
from tests.operators.contacts import contact_groups, grid_of
from tests.reference import DOMAIN, read

WIDE = Domain(x=(-4.0, 4.0), y=(-4.0, 4.0))
MULTILEVEL_ERROR = 3e-4
"""Largest error over the largest deflection; the discretisation error of a film of 0.1 exceeds 1e-3
on these coarse grids. Patches of 8 x 2 leave 2e-5 (257^2) to 2e-4 (49 x 33)."""
SHAPES = [(33, 33), (49, 33), (33, 65), (41, 57)]


def deflection(name: str, grid: Grid, pressure: Array, ratio: float = 1.0) -> Array:
    numbers = contact_groups(ratio)
    if name == "mlmi":
        method = MultilevelDeformation(grid, influence_of(grid, numbers))
    else:
        methods = {"fft": FftDeformation, "lines": LineDeformation, "direct": DirectDeformation}
        method = methods[name](grid, numbers)
    out = np.full(grid.shape, np.nan)
    method.deflect(pressure, out)
    return out


def zero_on_edges(field: Array, *, mirror: bool) -> Array:
    field[-1] = field[:, 0] = field[:, -1] = 0.0
    if not mirror:
        field[0] = 0.0
    return field


@pytest.mark.parametrize("name", ["fft", "lines"])
@pytest.mark.parametrize("ratio", [1.0, 3.0])
@pytest.mark.parametrize("mirror", [True, False])
@pytest.mark.parametrize(("nx", "ny"), SHAPES)
def test_a_sum_by_transforms_equals_the_direct_sum(nx, ny, mirror, ratio, name):
    grid = grid_of(nx, ny, mirror=mirror)
    pressure = zero_on_edges(np.random.default_rng(nx + ny).random(grid.shape), mirror=mirror)
    exact = deflection("direct", grid, pressure, ratio)
    transformed = deflection(name, grid, pressure, ratio)
    np.testing.assert_allclose(transformed, exact, rtol=0, atol=1e-13 * exact.max())


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 3.0, 100.0])
@pytest.mark.parametrize("mirror", [True, False])
@pytest.mark.parametrize(("nx", "ny"), SHAPES)
def test_the_multilevel_sum_of_the_hertz_pressure_is_close_to_the_direct_sum(nx, ny, mirror, ratio):
    grid = grid_of(nx, ny, mirror=mirror)
    pressure = dry_pressure(grid, contact_groups())
    exact = deflection("direct", grid, pressure, ratio)
    error = np.abs(deflection("mlmi", grid, pressure, ratio) - exact).max()
    assert error < MULTILEVEL_ERROR * exact.max()


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_the_multilevel_sum_of_any_pressure_is_close_to_the_exact_sum(seed, mirror):
    grid = grid_of(41, 41, mirror=mirror)
    pressure = zero_on_edges(np.random.default_rng(seed).random(grid.shape), mirror=mirror)
    exact = deflection("fft", grid, pressure)
    error = np.abs(deflection("mlmi", grid, pressure) - exact).max()
    assert error < MULTILEVEL_ERROR * exact.max()


def test_the_multilevel_sum_is_as_accurate_on_a_fine_grid():
    grid = grid_of(257, 257, mirror=True, domain=DOMAIN)
    pressure = dry_pressure(grid, contact_groups())
    exact = deflection("fft", grid, pressure)
    error = deflection("mlmi", grid, pressure) - exact
    inside = grid.x[None, :] ** 2 + grid.y[:, None] ** 2 < 1.0
    # the film of M = 100, L = 12 has an error of 1e-3 on this grid; a tenth of that suffices
    assert np.sqrt(np.mean(error[inside] ** 2)) < 2e-5
    assert np.abs(error).max() < 5e-5


def test_the_multilevel_sum_has_no_ripple_from_node_to_node():
    # the pressure of a stiff contact would have to balance it
    grid = grid_of(257, 257, mirror=True, domain=DOMAIN)
    pressure = dry_pressure(grid, contact_groups())
    error = deflection("mlmi", grid, pressure) - deflection("fft", grid, pressure)
    inner = (slice(1, -1), slice(1, -1))
    beside = error[1:-1, 2:] + error[1:-1, :-2] + error[2:, 1:-1] + error[:-2, 1:-1]
    ripple = (error[inner] - 0.25 * beside)[np.hypot.outer(grid.y, grid.x)[inner] < 0.8]
    assert np.abs(ripple).max() < 2e-6


@pytest.mark.parametrize("name", ["mlmi", "fft", "lines", "direct"])
def test_deflection_is_linear(name):
    grid = grid_of(33, 33, mirror=True)
    rng = np.random.default_rng(3)
    one, other = (zero_on_edges(rng.random(grid.shape), mirror=True) for _ in range(2))
    together = deflection(name, grid, one + 2.5 * other)
    apart = deflection(name, grid, one) + 2.5 * deflection(name, grid, other)
    np.testing.assert_allclose(together, apart, rtol=0, atol=1e-13 * together.max())


def hertz_errors(points: int) -> tuple[float, float]:
    """Largest error of the deflection at r = 0, 1.5, 2, 3, 4 against Hertz, and at r = 0 alone."""
    grid = grid_of(points, points, mirror=True, domain=WIDE)
    row = deflection("fft", grid, dry_pressure(grid, contact_groups()))[0]
    cited = read("exact")["circle"]
    places = [0.0, *cited["r"][1:]]
    exact = [1.0, *cited["deflection"][1:]]
    columns = [round((r + 4.0) / grid.dx) for r in places]
    errors = np.abs(row[columns] - exact)
    return float(errors.max()), float(errors[0])


def test_the_deflection_under_hertz_pressure_is_that_of_hertz():
    largest, centre = hertz_errors(257)
    assert largest < 2e-3  # h^(3/2) = 5.5e-3 at the edge of the pressure, h = 1/32
    assert centre < 2e-3


def test_refinement_brings_the_deflection_closer_to_hertz():
    coarse, fine = hertz_errors(65)[0], hertz_errors(257)[0]
    assert np.log2(coarse / fine) / 2 > 1.2  # the pressure slope is singular at r = 1


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 5.0])
def test_the_dry_gap_vanishes_in_a_contact_of_any_ellipticity(ratio):
    numbers = contact_groups(ratio)
    grid = grid_of(257, 257, mirror=True, domain=Domain(x=(-2.0, 2.0), y=(-2.0, 2.0)))
    film = gap(grid, numbers) + deflection("fft", grid, dry_pressure(grid, numbers), ratio)
    film -= film[0, 128]
    inside = grid.x[None, :] ** 2 + grid.y[:, None] ** 2 < 0.8**2
    # the error of cells at the edge of the pressure, h^(3/2) = 2e-3 for h = 1/64
    assert np.abs(film[inside]).max() < 2e-3
    assert film[0, -1] > 1.0


@pytest.mark.parametrize(
    ("across", "mirror", "method"),
    [
        (17, True, LineDeformation),
        (129, True, LineDeformation),
        (129, False, LineDeformation),
        (257, True, MultilevelDeformation),
        (257, False, MultilevelDeformation),
    ],
)
def test_auto_sums_by_lines_on_few_lines(across, mirror, method):
    assert isinstance(choose("auto", grid_of(257, across, mirror=mirror), contact_groups()), method)


@pytest.mark.parametrize(("nodes", "method"), [(129, DirectDeformation), (257, LineDeformation)])
def test_auto_sums_a_line_directly_on_few_nodes(nodes, method):
    numbers = replace(contact_groups(), radius_ratio=0.0)  # a line
    grid = Grid(nx=nodes, ny=1, domain=Domain(x=(-4.0, 4.0), y=LINE.sides), mirror=False)
    auto = choose("auto", grid, numbers)
    assert isinstance(auto, method)
    pressure = np.sqrt(np.maximum(1.0 - grid.x[None, :] ** 2, 0.0))
    found, exact = np.empty((2, 1, nodes))
    auto.deflect(pressure, found)
    LineDeformation(grid, numbers).deflect(pressure, exact)
    np.testing.assert_allclose(found, exact, atol=1e-13)


@pytest.mark.parametrize("ratio", [0.02, 10.0, 60.0])
def test_the_multilevel_sum_is_as_accurate_on_the_cells_of_bearings(ratio):
    grid, numbers = grid_of(257, 129, mirror=True, domain=DOMAIN), contact_groups()
    spike = np.exp(-(((grid.x - 0.8) / 0.05) ** 2))
    pressure = dry_pressure(grid, numbers) * (1.0 + 0.3 * spike)
    exact = deflection("lines", grid, pressure, ratio)
    error = deflection("mlmi", grid, pressure, ratio) - exact
    assert np.abs(error).max() < 1.2e-4 * exact.max()
    # second differences along x, which the pressure would have to balance
    assert np.abs(np.diff(error, 2, axis=1)).max() < 3e-5 * exact.max()


def test_auto_takes_the_multilevel_sum_on_all_but_very_long_cells():
    slender = contact_groups(13.0)
    auto = choose("auto", grid_of(513, 257, mirror=True), slender)
    assert isinstance(auto, MultilevelDeformation)
    wide = contact_groups(900.0)
    assert isinstance(choose("auto", grid_of(257, 257, mirror=True), wide), FftDeformation)
    assert isinstance(choose("auto", grid_of(65, 257, mirror=True), wide), LineDeformation)


def test_a_tight_film_is_deflected_to_rounding_under_a_narrow_peak():
    grid = grid_of(257, 257, mirror=True)
    x, y = np.meshgrid(grid.x, grid.y)
    pressure = np.exp(-((x**2 + y**2) / (1.5 * grid.dx) ** 2))
    tight, usual = (choose("auto", grid, contact_groups(), exact=exact) for exact in (True, False))
    reference = deflection("lines", grid, pressure)
    errors = []
    for method in (tight, usual):
        out = np.zeros(grid.shape)
        method.deflect(pressure, out)
        errors.append(np.abs(out - reference).max() / reference.max())
    assert errors[0] < 1e-12
    assert isinstance(usual, MultilevelDeformation)
    assert errors[1] > 1e-5


@pytest.mark.parametrize("mirror", [True, False])
def test_lines_that_crowd_at_the_ends_of_a_roller_are_bent_as_even_ones(mirror):
    ends, numbers = Domain.model_construct(x=(-2.0, 2.0), y=(-1.0, 1.0)), contact_groups(3.0)

    def bent(lines: int, crowding: float) -> tuple[Grid, Array]:
        grid = Grid(nx=33, ny=lines, domain=ends, mirror=mirror, crowding=crowding)
        found = np.empty(grid.shape)
        pressure = np.maximum(1.0 - grid.x**2, 0.0) * (1.0 + grid.y[:, None] ** 2)
        choose("auto", grid, numbers).deflect(pressure, found)
        by_matrix = matrix_of(grid, influence_of(grid, numbers)) @ pressure.ravel()
        np.testing.assert_allclose(found.ravel(), by_matrix, rtol=1e-12)
        return grid, found

    crowded, found = bent(65, 1.5)
    even, expected = bent(257, 0.0)
    for column in (0, 16):
        there = np.interp(crowded.y, even.y, expected[:, column])
        np.testing.assert_allclose(found[:, column], there, rtol=3e-3)


@pytest.mark.parametrize("mirror", [True, False])
def test_near_lines_alone_are_summed_at_most_wave_numbers(mirror):
    edges = (0.95, 0.95) if mirror else (0.9, 0.97)
    ends, numbers = Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0)), contact_groups(25.0)
    # far lines are sampled at each second and fourth offset
    grid = Grid(nx=257, ny=65, domain=ends, mirror=mirror, crowding=3.0, edges=edges)
    pressure, found = np.random.default_rng(1).random(grid.shape), np.empty(grid.shape)
    pressure[:, [0, -1]] = 0.0
    deformation = CrowdedDeformation(grid, numbers)
    deformation.deflect(pressure, found)
    lines, i = influence_of(grid, numbers).between(grid), np.arange(grid.nx)
    offsets = np.abs(i[:, None] - i)
    expected = [
        sum(line[offsets] @ p for line, p in zip(to, pressure, strict=True)) for to in lines
    ]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * np.max(expected))
    kept = sum(block.influences.size for block in deformation.blocks)
    assert kept < 0.8 * grid.nx * grid.shape[0] ** 2


def test_a_film_that_wraps_is_bent_by_its_neighbours_beyond_both_ends():
    ends = Domain.model_construct(x=(-2.0, 2.0), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=17, domain=ends, mirror=False, wraps=True)
    numbers = replace(contact_groups(3.0), roller=Roller(length=1.0, goes_on=True, wraps=True))
    pressure = np.random.default_rng(3).random(grid.shape)
    pressure[:, [0, -1]], pressure[-1] = 0.0, pressure[0]
    exact, found, shifted, even = np.empty((4, *grid.shape))
    choose("direct", grid, numbers).deflect(pressure, exact)
    choose("auto", grid, numbers).deflect(pressure, found)
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-13 * exact.max())
    # wherever the ends are; and as between mirrors if it is even about them
    rows = (np.arange(17) + 5) % 16
    choose("auto", grid, numbers).deflect(pressure[rows], shifted)
    np.testing.assert_allclose(shifted, found[rows], rtol=0.0, atol=1e-13 * exact.max())
    pressure += pressure[::-1]
    choose("auto", grid, numbers).deflect(pressure, found)
    half = replace(grid, mirror=True, wraps=False)
    choose("auto", half, numbers).deflect(pressure[8:], even[8:])
    np.testing.assert_allclose(found[8:], even[8:], rtol=0.0, atol=1e-13 * exact.max())


@pytest.mark.parametrize("wraps", [True, False])
def test_a_pressure_is_found_from_the_film_that_it_makes(wraps):
    ends = Domain.model_construct(x=(-2.0, 2.0), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=17, domain=ends, mirror=False, wraps=wraps)
    roller = Roller(length=1.0, goes_on=True, wraps=wraps)
    numbers, (film, found) = replace(contact_groups(3.0), roller=roller), np.empty((2, *grid.shape))
    x, y = grid.x[None], grid.y[:, None]
    pressure = np.exp(-40.0 * x**2) * (2.0 + np.cos(np.pi * y) + wraps * np.sin(2.0 * np.pi * y))
    choose("auto", grid, numbers).deflect(pressure, film)
    Flattening(grid, numbers).deflect(film, found)
    # exact but for what lies beyond the ends of x
    inside = slice(8, 25)
    np.testing.assert_allclose(found[:, inside], pressure[:, inside], atol=0.1 * pressure.max())


@pytest.mark.parametrize("mirror", [True, False])
def test_a_sum_by_cosines_between_mirrors_equals_the_direct_sum(mirror):
    ends = Domain.model_construct(x=(-2.0, 2.0), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=17, domain=ends, mirror=mirror)
    numbers = replace(contact_groups(3.0), roller=Roller(length=1.0, goes_on=True))
    pressure = np.random.default_rng(3).random(grid.shape)
    pressure[:, [0, -1]] = 0.0
    exact, found = np.empty((2, *grid.shape))
    choose("direct", grid, numbers).deflect(pressure, exact)
    choose("auto", grid, numbers).deflect(pressure, found)
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-13 * exact.max())
    # the same pressure on twice the piece is bent alike
    if not mirror:
        twice = Grid(nx=33, ny=33, domain=ends, mirror=False)
        wide = replace(numbers, ellipticity=2.0 * numbers.ellipticity)
        bent = np.empty(twice.shape)
        choose("auto", twice, wide).deflect(np.concatenate([pressure, pressure[-2::-1]]), bent)
        np.testing.assert_allclose(bent[:17], exact, rtol=0.0, atol=1e-6)
