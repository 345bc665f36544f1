"""Stress of a half-space: exact solutions, independent values, equilibrium, load at every depth."""

import math
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, RectBivariateSpline

from tehl import solve
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.options import Options
from tehl.contact.stress import Stress
from tehl.post.stress.below import stress_below
from tehl.post.stress.influence import HalfSpace
from tehl.post.stress.measures import largest_shear, von_mises, worst
from tehl.post.stress.numbers import peak, stress_numbers
from tehl.post.stress.window import window_of
from tests.post.stress.periodic import periodic_stresses

REFERENCE = tomllib.loads(
    (Path(__file__).parents[2] / "reference" / "stress.toml").read_text(encoding="utf-8")
)
NU = 0.3
ENDLESS = 1e5
"""Length of the cells of a line contact: plane strain to 1e-5."""


@cache
def hertz(ratio: float, traction: float) -> tuple:
    """Return x, y, half-space and spectra of a Hertz contact with a traction along x."""
    x = np.linspace(-1.5, 1.5, 161 if ratio else 2401)
    y = np.zeros(1) if ratio == 0.0 else ratio * x
    scale = ratio or 1.0
    pressure = np.sqrt(np.maximum(1.0 - x**2 - (y[:, None] / scale) ** 2, 0.0))
    step = x[1] - x[0]
    space = HalfSpace(pressure.shape, (ratio * step or ENDLESS, step))
    spectra = space.spectra_of(pressure, traction * pressure, 0.0 * pressure)
    return x, y, space, spectra


def stress_at(ratio: float, traction: float, z: float) -> np.ndarray:
    _, _, space, spectra = hertz(ratio, traction)
    return space.stresses(spectra, space.influence(z), NU)


@pytest.mark.parametrize(
    "point", REFERENCE["point"], ids=lambda p: f"{p['ratio']}-{p['at']}-{p['traction']}"
)
def test_all_components_below_a_hertz_contact_are_those_of_an_independent_solver(point):
    x, y, z = point["at"]
    nodes, rows, _, _ = hertz(point["ratio"], point["traction"])
    found = stress_at(point["ratio"], point["traction"], z)
    if point["ratio"] == 0.0:
        here = np.array([CubicSpline(nodes, one[0])(x) for one in found])
    else:
        here = np.array([RectBivariateSpline(rows, nodes, one)(y, x)[0, 0] for one in found])
    # uniform cells of 1/53 half-width: 5e-4 of the largest pressure near the rim, 1e-4 inside
    assert here == pytest.approx(point["stress"], abs=6e-4)
    assert float(von_mises(here)) == pytest.approx(point["von_mises"], abs=3e-4)
    assert float(largest_shear(here)) == pytest.approx(point["shear"], abs=2e-4)


@pytest.mark.parametrize("limit", REFERENCE["maximum"], ids=lambda p: f"ratio {p['ratio']}")
def test_the_largest_shear_on_the_axis_and_its_depth(limit):
    depths = np.geomspace(0.04, 3.0, 20)  # those of a result on 257 nodes
    x, y, space, spectra = hertz(limit["ratio"], 0.0)
    middle = y.size // 2, x.size // 2
    axis = np.array([space.stresses(spectra, space.influence(z), NU)[:, *middle] for z in depths]).T
    found = peak(depths, largest_shear(axis))
    assert found.value == pytest.approx(limit["shear"], rel=5e-3)
    assert found.depth == pytest.approx(limit["depth"], abs=5e-3)
    if limit["ratio"] == 1.0:
        assert peak(depths, von_mises(axis)).value == pytest.approx(0.620041, rel=5e-3)
    if limit["ratio"] == 0.0:
        worst = peak(depths, von_mises(axis))  # Johnson 1985, plane strain
        assert worst.value == pytest.approx(0.557516, rel=5e-3)
        assert worst.depth == pytest.approx(0.704292, abs=5e-3)


def test_the_orthogonal_shear_below_a_line_is_a_quarter_at_half_a_half_width():
    x = hertz(0.0, 0.0)[0]
    depths = np.geomspace(0.2, 1.2, 12)
    lines = [stress_at(0.0, 0.0, z)[5, 0] for z in depths]
    found = peak(depths, np.array([0.5 * (line.max() - line.min()) for line in lines]))
    assert found.value == pytest.approx(0.25, rel=2e-3)
    assert found.depth == pytest.approx(0.5, abs=5e-3)
    assert abs(x[int(np.argmax(stress_at(0.0, 0.0, 0.5)[5, 0]))]) == pytest.approx(0.866, abs=0.02)


def test_traction_raises_the_shear_below_a_line_and_brings_it_to_the_surface():
    series = REFERENCE["in_plane"]
    x = hertz(0.0, 0.0)[0]
    depths = np.arange(0.02, 1.0, 0.01)
    without, unit = (
        np.stack([stress_at(0.0, traction, z)[:, 0] for z in depths], axis=1)
        for traction in (0.0, 1.0)
    )
    for k, traction in enumerate(series["traction"]):
        xx, _, zz, _, _, zx = without + traction * (unit - without)
        shear = np.hypot(0.5 * (xx - zz), zx)
        row, column = np.unravel_index(int(np.argmax(shear)), shear.shape)
        assert shear[row, column] == pytest.approx(series["shear"][k], rel=1e-2)
        assert depths[row] == pytest.approx(series["depth"][k], abs=0.02 + 1e-9)
        assert x[column] == pytest.approx(series["x"][k], abs=0.02 + 1e-9)
    xx, _, zz, _, _, zx = without + 0.45 * (unit - without)
    assert int(np.argmax(np.hypot(0.5 * (xx - zz), zx).max(axis=1))) == 0


@pytest.mark.parametrize(("mirror", "depth"), [(False, 0.4), (True, 0.4), (True, 0.8)])
def test_deep_down_fewer_waves_and_rows_give_the_same_stresses(mirror, depth):
    """Of rough loads that end inside the grid, symmetric about the middle row or about none."""
    draw, shape, spacing = np.random.default_rng(3), (65, 57), (0.04, 0.03)
    y, x = (np.linspace(-1.4, 1.4, size) for size in shape)
    hertz = np.sqrt(np.maximum(1.0 - x**2 - y[:, None] ** 2, 0.0))
    loads = [hertz * draw.uniform(0.5, 1.5, shape) for _ in range(3)]
    if mirror:
        loads = [one + sign * one[::-1] for one, sign in zip(loads, (1, 1, -1), strict=True)]
    every = HalfSpace(shape, spacing)
    space = HalfSpace(shape, spacing, row=32, mirror=mirror)
    steps = space.steps(depth)
    full = every.stresses(every.spectra_of(*loads), every.influence(depth), NU)
    spectra = space.thinned(space.spectra_of(*loads), steps)
    thin = space.stresses(spectra, space.influence(depth, steps), NU)
    assert steps == ((2, 2) if depth == 0.4 else (4, 4))
    rows = space.rows(steps)
    largest = np.abs(full).max()
    np.testing.assert_allclose(thin, full[:, rows], atol=1e-5 * largest)
    column = space.on_all_rows(thin[:, :, 20], steps)
    np.testing.assert_allclose(column[:, rows], full[:, rows, 20], atol=1e-5 * largest)
    assert column[:, 5:-5] == pytest.approx(full[:, 5:-5, 20], abs=3e-3 * largest)


LENGTHS = (3.0, 2.0)


def harmonics() -> tuple:
    """Return wave numbers and the products of cosines and sines of one period."""
    points = 16
    alpha, beta = (2.0 * math.pi / length for length in LENGTHS[::-1])
    x, y = (np.arange(points) * length / points for length in LENGTHS[::-1])
    cx, sx, cy, sy = np.cos(alpha * x), np.sin(alpha * x), np.cos(beta * y), np.sin(beta * y)
    return alpha, beta, np.outer(cy, cx), np.outer(cy, sx), np.outer(sy, cx), np.outer(sy, sx)


@pytest.mark.parametrize("depth", [0.0, 0.2, 1.0])
def test_a_sinusoidal_pressure_has_the_exact_stresses(depth):
    """Tripp, Van Kuilenburg, Morales-Espejel and Lugt 2003, with tension positive."""
    a, b, cc, sc, cs, ss = harmonics()
    zeta = math.hypot(a, b)
    fall = math.exp(-zeta * depth)
    found = periodic_stresses((cc, 0.0 * cc, 0.0 * cc), LENGTHS, depth, NU)
    along = (a**2 - a**2 * zeta * depth + 2.0 * NU * b**2) / zeta**2
    across = (b**2 - b**2 * zeta * depth + 2.0 * NU * a**2) / zeta**2
    exact = (
        -along * fall * cc,
        -across * fall * cc,
        -(1.0 + zeta * depth) * fall * cc,
        a * b / zeta**2 * (1.0 - 2.0 * NU - zeta * depth) * fall * ss,
        -b * depth * fall * cs,
        -a * depth * fall * sc,
    )
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-10)
    trace = -2.0 * (1.0 + NU) * fall
    np.testing.assert_allclose(found[:3].sum(axis=0), trace * cc, rtol=0.0, atol=1e-10)
    pulled = periodic_stresses((0.0 * cc, cc, 0.0 * cc), LENGTHS, depth, NU)
    np.testing.assert_allclose(pulled[:3].sum(axis=0), trace * a / zeta * sc, rtol=0.0, atol=1e-10)


@cache
def bump() -> tuple:
    """Return smooth loads of all three kinds that end well inside their grid."""
    step, points = 0.05, 81
    x = step * (np.arange(points) - points // 2)
    shape = np.exp(-3.0 * ((x - 0.1) ** 2 + x[:, None] ** 2))
    loads = shape, 0.3 * shape * (1.0 + x), 0.2 * shape * (x[:, None] - 1.0)
    return step, x, loads


def test_cells_and_fourier_series_agree_for_loads_of_all_kinds():
    """Two formulations of the half-space; waves from other periods fall with the padding."""
    step, x, loads = bump()
    space = HalfSpace((x.size, x.size), (step, step))
    spectra = space.spectra_of(*loads)
    wide = [np.zeros((512, 512)) for _ in loads]
    for field, load in zip(wide, loads, strict=True):
        field[: x.size, : x.size] = load
    for depth in (0.1, 0.5):
        cells = space.stresses(spectra, space.influence(depth), 0.27)
        series = periodic_stresses(tuple(wide), (512 * step, 512 * step), depth, 0.27)
        # cells smooth the load by h^2/24 times its curvature, 1.3e-3; the period brings 7e-4
        assert np.abs(cells - series[:, : x.size, : x.size]).max() < 2e-3


def test_stresses_are_in_equilibrium():
    """Divergence by central differences over all three axes, of order h^2, against their terms."""
    step, x, loads = bump()
    space = HalfSpace((x.size, x.size), (step, step))
    spectra, gap = space.spectra_of(*loads), 0.02
    above, here, below = (
        space.stresses(spectra, space.influence(z), NU) for z in (0.6 - gap, 0.6, 0.6 + gap)
    )
    xx, yy, _, xy, yz, zx = here
    inside = np.s_[2:-2, 2:-2]

    def slope(field, axis):
        eight = 8.0 * (np.roll(field, -1, axis) - np.roll(field, 1, axis))
        return (eight - np.roll(field, -2, axis) + np.roll(field, 2, axis)) / (12.0 * step)

    down = (below - above) / (2.0 * gap)
    for along_x, along_y, along_z in ((xx, xy, down[5]), (xy, yy, down[4]), (zx, yz, down[2])):
        terms = slope(along_x, 1), slope(along_y, 0), along_z
        largest = max(np.abs(one[inside]).max() for one in terms)
        assert np.abs(sum(terms)[inside]).max() < 1e-3 * largest


@pytest.mark.parametrize("depth", [0.1, 0.5, 2.0])
def test_every_depth_carries_the_load(depth):
    """The sum of sigma_z over a square is what Boussinesq's solution brings into it, exactly."""
    step, x, loads = bump()
    space = HalfSpace((x.size, x.size), (step, step))
    half = 0.5 * x.size * step

    def corner(along, across):
        r = np.sqrt(along**2 + across**2 + depth**2)
        sides = 1.0 / (along**2 + depth**2) + 1.0 / (across**2 + depth**2)
        angle = np.arctan(along * across / (depth * r))
        return (angle + along * across * depth / r * sides) / (2.0 * math.pi)

    ends = [half - x, half + x]
    inside = sum(corner(along, across[:, None]) for along in ends for across in ends)
    normal = float((loads[0] * inside).sum())
    found = space.stresses(space.spectra_of(loads[0]), space.influence(depth), NU)
    assert -float(found[2].sum()) == pytest.approx(normal, rel=1e-6)


def test_the_cycle_of_a_material_begins_without_load():
    """A normal stress of one to two, which is nowhere zero, has half of its largest one as range.

    Its middle is one, so that the amplitude is one and its shear a half; a residual stress that is
    there without load too takes part in the tension alone.
    """
    stress = np.zeros((6, 3, 5))
    stress[2] = -np.linspace(1.0, 2.0, 5)
    settings = Stress(dang_van_slope=0.0)
    assert worst(stress, settings, 0.0, np.ones(3)).dang_van == pytest.approx(0.5)
    stress[:2] -= 0.3
    sloped = Stress(dang_van_slope=0.3)
    found = worst(stress, sloped, 0.0, np.ones(3), residual=-0.3)
    # without load: half of one, and a tension of -0.6 / 3
    assert found.dang_van == pytest.approx(0.5 - 0.3 * 0.2)


def rolled(load: float, speed: float) -> Result:
    """Return a line of steel on steel in pure rolling, with its stress [N/m], [m/s]."""
    line = ContactProblem(
        contact={"type": "line", "load_per_length": load, "entrainment_speed": speed},
        surface_1={"material": "steel", "radius": 0.01},
        surface_2={"material": "steel", "radius": "inf"},
        lubricant={"name": "mineral-oil"},
        stress={},
    )
    return solve(line, Options(points=(257, 1)))


def test_the_dang_van_stress_of_a_dry_line_is_that_of_its_whole_way():
    """By the integral of Johnson (1985), section 2.5, over 12 half-widths on each side."""
    film = rolled(6e5, 2.0)
    found = stress_below(film, Stress())
    wide = HertzLine(film.problem.hertz.pressure, Stress().dang_van_slope).dang_van()
    assert wide == pytest.approx(0.2255 * film.problem.hertz.pressure, rel=1e-3)
    assert found.dang_van_dry[0].max() == pytest.approx(wide, rel=0.01)


class HertzLine:
    """Plane-strain stresses below a dry line contact of half-width one, of strips."""

    def __init__(self, pressure: float, slope: float) -> None:
        self.pressure, self.slope = pressure, slope

    def dang_van(self) -> float:
        """Return the largest stress of Dang Van of a way of 24 half-widths."""
        s = np.cos(np.pi * (np.arange(400) + 0.5) / 400)  # p ds = sin^2 dt
        weight = np.sin(np.pi * (np.arange(400) + 0.5) / 400) ** 2 * np.pi / 400 * self.pressure
        x = np.linspace(-12.0, 12.0, 2401)
        largest = 0.0
        for z in np.linspace(0.3, 1.5, 25):
            d = x[:, None] - s
            kernel = -2.0 / np.pi * z / (d**2 + z**2) ** 2 * weight
            xx, zz, zx = ((kernel * one).sum(axis=1) for one in (d**2, z**2 + 0.0 * d, d * z))
            yy = 0.3 * (xx + zz)
            stress = np.stack([xx, yy, zz, 0.0 * xx, 0.0 * xx, zx])
            middle = 0.5 * (stress.min(axis=1) + stress.max(axis=1))
            shear = largest_shear(stress - middle[:, None])
            largest = max(largest, float((shear + self.slope / 3.0 * (xx + yy + zz)).max()))
        return largest


def test_bars_hold_the_load_that_is_left_out():
    """Of a line whose inlet begins far ahead: a thousandth of it, to the power of the life."""
    film = rolled(1e5, 4.0)
    window = window_of(film, film.pressure)
    left_out = 1.0 - film.pressure[:, window.columns].sum() / film.pressure.sum()
    assert left_out > 1e-3
    numbers = stress_numbers(film).worse
    power = Stress().stress_exponent / Stress().weibull_slope
    assert numbers.shear_error > left_out
    assert numbers.life_ratio_error > power * left_out
