"""Thermal stress of a moving half-space: Jaeger's source, free surface, equilibrium, layers."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import k0e

import tehl
from tehl.api.problem import case_from_tables
from tehl.base.errors import InputError
from tehl.contact.materials import material
from tehl.contact.stress import Stress
from tehl.io.templates import template_text
from tehl.post.stress.below import stress_below
from tehl.post.stress.heated import thermal_stress_of
from tehl.post.stress.influence import HalfSpace
from tehl.post.stress.numbers import stress_numbers
from tehl.post.stress.slow import RestingStress, SlowStress, free_stresses
from tehl.post.stress.thermal import Heated, ThermalStress
from tests.post.stress.periodic import periodic_stresses

STEEL = material("steel")
UNIT = STEEL.young_modulus * STEEL.expansion / (1.0 - STEEL.poisson_ratio)
WIDTH, FLUX = 1e-4, 1e8
"""Half-width of the heat [m], and its flux [W/m^2]."""


def line_of_heat(peclet, points=1001, side=1.0):
    """Return x and a body whose surface is heated evenly over |x| < WIDTH."""
    x = np.linspace(-2.5, 2.5, points) * WIDTH
    flux = FLUX * (np.abs(x) < 0.999999 * WIDTH) + 0.5 * FLUX * np.isclose(np.abs(x), WIDTH)
    speed = side * 2.0 * peclet * STEEL.diffusivity / WIDTH
    return x, Heated(flux[None], (1.0, x[1] - x[0]), speed, STEEL)


def spot(peclet, points=65):
    """Return mesh width and a body under a smooth spot of heat."""
    x = np.linspace(-2.0, 2.0, points) * WIDTH
    flux = FLUX * np.exp(-3.0 * ((x / WIDTH) ** 2 + (x[:, None] / WIDTH) ** 2))
    speed = 2.0 * peclet * STEEL.diffusivity / WIDTH
    return x[1] - x[0], Heated(flux, (x[1] - x[0], x[1] - x[0]), speed, STEEL)


@pytest.mark.parametrize("peclet", [2.0, 5.0, 50.0])
def test_the_temperature_is_that_of_jaegers_moving_source(peclet):
    """Carslaw and Jaeger 1959, section 10.7, by quadrature, at three places and two depths."""
    x, body = line_of_heat(peclet)
    found = ThermalStress(body)
    sources = np.linspace(-WIDTH, WIDTH, 20001)
    half = body.speed / (2.0 * STEEL.diffusivity)
    for depth in (0.05 * WIDTH, 0.3 * WIDTH):
        rise = found.temperature(depth)[0]
        for place in (-0.5 * WIDTH, 0.9 * WIDTH, 2.0 * WIDTH):
            along = place - sources
            r = np.hypot(along, depth)
            exact = np.trapezoid(np.exp(half * (along - r)) * k0e(half * r), sources)
            exact *= FLUX / (np.pi * STEEL.conductivity)
            assert np.interp(place, x, rise) == pytest.approx(exact, abs=4e-4 * rise.max())


def test_a_thin_warm_layer_is_pressed_along_the_surface_by_e_alpha_dt_over_one_less_nu():
    x, body = line_of_heat(2000.0, 4001)
    layer, inside = ThermalStress(body), np.abs(x) < 0.9 * WIDTH
    rise = layer.temperature(0.0)[0]
    fast = (
        2.0
        * FLUX
        / STEEL.conductivity
        * np.sqrt(STEEL.diffusivity * np.maximum(x + WIDTH, 0.0) / (np.pi * body.speed))
    )
    np.testing.assert_allclose(rise[inside], fast[inside], atol=2e-3 * fast.max())
    stress = layer.stresses(0.0)[:, 0]
    # in the layer, less the share sqrt(1/Pe) of what it pulls at the body below
    np.testing.assert_allclose(
        stress[0, inside], -UNIT * rise[inside], atol=0.03 * UNIT * rise.max()
    )
    np.testing.assert_allclose(
        stress[1, inside], -UNIT * rise[inside], atol=1e-3 * UNIT * rise.max()
    )


def test_the_surface_is_free_of_what_the_heat_leaves_on_it():
    _, body = spot(5.0)
    heat = ThermalStress(body)
    shape = tuple(heat.loads())
    lengths = tuple(step * size for step, size in zip(body.spacing, body.flux.shape, strict=True))
    freed = heat.stresses(0.0) + periodic_stresses(shape, lengths, 0.0, STEEL.poisson_ratio)
    # sigma_z, tau_yz and tau_zx
    assert np.abs(freed[[2, 4, 5]]).max() < 1e-12 * np.abs(heat.stresses(0.0)).max()


def test_the_trace_is_that_of_the_temperature_and_the_stresses_are_in_equilibrium():
    step, body = spot(4.0)
    heat, depth, gap = ThermalStress(body), 0.5 * WIDTH, 0.01 * WIDTH
    above, here, below = (heat.stresses(z) for z in (depth - gap, depth, depth + gap))
    # of Goodier's potential: sigma_x + sigma_y + sigma_z = -2 E alpha T/(1 - nu)
    np.testing.assert_allclose(
        here[:3].sum(axis=0), -2.0 * UNIT * heat.temperature(depth), atol=1e-9 * UNIT
    )
    xx, yy, _, xy, yz, zx = here
    down = (below - above) / (2.0 * gap)
    inside = np.s_[3:-3, 3:-3]
    for x, y, z in ((xx, xy, down[5]), (xy, yy, down[4]), (zx, yz, down[2])):
        terms = np.gradient(x, step, axis=1), np.gradient(y, step, axis=0), z
        largest = max(np.abs(one[inside]).max() for one in terms)
        assert np.abs(sum(terms)[inside]).max() < 0.01 * largest  # differences of order h^2


def test_potential_and_half_space_together_free_the_surface():
    """In cells too: stresses on the surface vanish with the depth, against -E alpha T/(1-nu)."""
    _, body = spot(5.0, 129)
    heat, space = ThermalStress(body), HalfSpace(body.flux.shape, body.spacing)
    spectra = space.spectra_of(*heat.loads())
    sizes = []
    for depth in (2.0 * body.spacing[0], 4.0 * body.spacing[0]):
        stress = heat.stresses(depth) + space.stresses(
            spectra, space.influence(depth), STEEL.poisson_ratio
        )
        sizes.append(np.abs(stress[[2, 4, 5], 32:-32, 32:-32]).max(axis=(1, 2)))
    assert (sizes[0] < 0.08 * UNIT * heat.temperature(0.0).max()).all()
    assert (sizes[0] < 0.75 * sizes[1]).all()


def test_a_body_that_moves_backwards_has_the_mirrored_stresses():
    _, forward = line_of_heat(5.0, 251)
    _, backward = line_of_heat(5.0, 251, side=-1.0)
    one, other = (
        ThermalStress(body).stresses(0.1 * WIDTH)[:, :, :] for body in (forward, backward)
    )
    sign = np.array([1.0, 1.0, 1.0, -1.0, 1.0, -1.0])[:, None, None]
    np.testing.assert_allclose(other, sign * one[..., ::-1], atol=1e-12 * np.abs(one).max())


def thermal_tables():
    """Return the tables of the template ``thermal``."""
    return tomllib.loads(template_text("thermal"))


@pytest.fixture(scope="module")
def warm():
    return tehl.solve(case_from_tables(thermal_tables())[0], tehl.Options(points=65))


def test_heat_stresses_both_bodies_of_a_film_at_their_surfaces(warm):
    cold, hot = (stress_below(warm, Stress(thermal=heat, depths=10)) for heat in (False, True))
    rises = warm.heat.temperature[[0, -1]].max(axis=(1, 2)) - warm.scales.temperature
    np.testing.assert_allclose(hot.thermal, UNIT * rises, rtol=0.03)
    row, column = (int(np.argmin(np.abs(axis))) for axis in (hot.y, hot.x - WIDTH))
    added = hot.xx[:, 0, column] - cold.xx[:, 0, column]
    assert (added < -0.2 * hot.thermal).all()
    np.testing.assert_allclose(hot.zz[:, 0], cold.zz[:, 0], atol=0.1 * hot.thermal.max())
    assert np.abs(hot.shear - cold.shear).max() < hot.thermal.max()
    assert hot.floor[0].max() == pytest.approx(hot.shear[0].max(), rel=1e-5)
    assert hot.floor[0, row].max() <= hot.floor[0].max()
    found = warm.with_stress(thermal=True, depths=10)
    assert found.summary()["stress"]["body_1"]["thermal_pa"] == hot.thermal[0]
    assert warm.with_stress(depths=10).summary()["stress"]["thermal_pa"] is None


def test_a_body_at_rest_under_a_round_spot_has_half_of_e_alpha_t_along_its_surface():
    x = np.linspace(-2.0, 2.0, 129) * WIDTH
    flux = FLUX * np.exp(-3.0 * ((x / WIDTH) ** 2 + (x[:, None] / WIDTH) ** 2))
    step = x[1] - x[0]
    body = thermal_stress_of(Heated(flux, (step, step), 0.0, STEEL))
    rise, stiffness = body.temperature(0.0)[64, 64], STEEL.young_modulus * STEEL.expansion
    exact = 0.5 * FLUX * WIDTH / STEEL.conductivity * np.sqrt(np.pi / 3.0)
    assert rise == pytest.approx(exact, rel=3e-4)
    assert body.stresses(0.0)[:2, 64, 64] == pytest.approx(-0.5 * stiffness * rise)
    xx, yy, _, xy, *_ = body.stresses(0.3 * WIDTH)
    inside = np.s_[3:-3, 3:-3]
    for one, axis in ((xx, 1), (yy, 0)):
        terms = np.gradient(one, step, axis=axis), np.gradient(xy, step, axis=1 - axis)
        assert np.abs(sum(terms)[inside]).max() < 1e-3 * np.abs(terms[0][inside]).max()
    assert not any(load.any() for load in body.loads())


def test_a_wave_of_slow_heat_leaves_the_surface_free():
    """Its stress is that of Goodier's potential and of the half-space that takes off its loads."""
    points, lengths, depth = 16, (3e-4, 2e-4), 4e-5
    a, b = 2.0 * np.pi / lengths[1], 4.0 * np.pi / lengths[0]
    y, x = (np.arange(points) / points * length for length in lengths)
    wave = np.exp(1j * (a * x + b * y[:, None]))
    for drift in (1e2, 3e4, -3e4):
        gamma = np.sqrt(a * a + b * b + 1j * drift * a)
        shape = np.array([b * b - gamma**2, a * a - gamma**2, a * a + b * b, -a * b])
        shape = np.append(shape, [-1j * b * gamma, -1j * a * gamma]) / (gamma * 1j * drift * a)
        loads = tuple((shape[k] * wave).real for k in (2, 5, 4))
        freed = periodic_stresses(loads, lengths, depth, STEEL.poisson_ratio)
        exact = freed + (shape[:, None, None] * np.exp(-gamma * depth) * wave).real
        waves = np.array([[a]]), np.array([[b]])
        found = (free_stresses(waves, drift, depth, STEEL.poisson_ratio) * wave).real
        np.testing.assert_allclose(found, exact, atol=1e-9 * np.abs(freed).max())
        surface = free_stresses(waves, drift, 0.0, STEEL.poisson_ratio)
        assert np.abs(surface[[2, 4, 5]]).max() == 0.0


@pytest.mark.parametrize("peclet", [0.01, 0.5, -5.0])
def test_a_slow_line_of_heat_has_the_temperature_of_jaegers_source(peclet):
    """In plane strain sigma_y = nu (sigma_x + sigma_z) - E alpha T."""
    x, body = line_of_heat(abs(peclet), 401, side=np.sign(peclet))
    half = body.speed / (2.0 * STEEL.diffusivity)
    sources, depth = np.linspace(-WIDTH, WIDTH, 20001), 0.1 * WIDTH
    xx, yy, zz = SlowStress(body).stresses(depth)[:3, 0]
    rise = (STEEL.poisson_ratio * (xx + zz) - yy) / (STEEL.young_modulus * STEEL.expansion)
    for place in (-2.0 * WIDTH, 0.0, 0.8 * WIDTH):
        along = place - sources
        r = np.hypot(along, depth)
        source = np.exp(half * along - abs(half) * r) * k0e(abs(half) * r)
        exact = np.trapezoid(source, sources) * FLUX / (np.pi * STEEL.conductivity)
        assert np.interp(place, x, rise) == pytest.approx(exact, abs=4e-4 * rise.max())


def test_slow_stress_lies_between_those_of_resting_and_of_fast_bodies():
    def warm(peclet):
        x = y = np.linspace(-2.0, 2.0, 65) * WIDTH
        x = np.append(x, x[-1] + (x[1] - x[0]) * np.arange(1, 129))  # its wake
        flux = FLUX * np.exp(-3.0 * ((x / WIDTH) ** 2 + (y[:, None] / WIDTH) ** 2))
        speed = 2.0 * peclet * STEEL.diffusivity / WIDTH
        return Heated(flux, (y[1] - y[0], x[1] - x[0]), speed, STEEL, np.s_[16:49, 8:57])

    depth = 0.3 * WIDTH
    still, slow = RestingStress(warm(0.0)).stresses(depth), SlowStress(warm(1e-3)).stresses(depth)
    np.testing.assert_allclose(slow, still, atol=2e-3 * np.abs(still).max())
    body = warm(10.0)
    heat, space = (
        ThermalStress(body._replace(part=np.s_[:, :])),
        HalfSpace(body.flux.shape, body.spacing),
    )
    loads = space.spectra_of(*heat.loads())
    fast = heat.stresses(depth) + space.stresses(loads, space.influence(depth), STEEL.poisson_ratio)
    slow = SlowStress(body).stresses(depth)
    np.testing.assert_allclose(slow, fast[:, *body.part], atol=0.02 * np.abs(slow).max())
    np.testing.assert_allclose(
        SlowStress(body).stresses(depth, slice(1, None, 4)), slow[:, 1::4], rtol=1e-12
    )


def test_some_rows_of_a_fast_body_are_those_of_all():
    _, body = spot(5.0, 65)
    heat = ThermalStress(body._replace(part=np.s_[3:60, 5:65]))
    depth = 1.3 * WIDTH
    every, some = heat.stresses(depth), heat.stresses(depth, slice(2, None, 4))
    largest = np.abs(heat.stresses(0.0)).max()
    np.testing.assert_allclose(some, every[:, 2::4], atol=1e-7 * largest)


@pytest.mark.parametrize("ratio", [2.0, 1.99])
def test_surfaces_at_rest_and_slow_ones_are_stressed(ratio):
    tables = thermal_tables()
    tables["contact"] |= {"slide_roll_ratio": ratio}
    film = tehl.solve(case_from_tables(tables)[0], tehl.Options(points=65))
    slow = int(np.argmin(film.heat.solid_peclet))
    found = film.with_stress(thermal=True, depths=10)
    rise = film.heat.temperature[-slow].max() - film.scales.temperature
    half = 0.5 * (1.0 - STEEL.poisson_ratio) * UNIT * rise
    assert found.stress.thermal[slow] == pytest.approx(half, rel=0.1)
    assert not stress_numbers(found).heat_left_out


def test_thermal_stress_at_an_angle_is_left_out_and_the_remark_states_the_most_of_it(warm):
    tables = thermal_tables()
    tables["contact"] |= {"sliding_angle": "20 deg"}
    problem = case_from_tables(tables)[0]
    found = replace(warm, problem=problem).with_stress(thermal=True, depths=10)
    numbers = stress_numbers(found)
    assert numbers.heat_left_out
    rise = warm.heat.temperature[[0, -1]].max() - warm.scales.temperature
    assert numbers.thermal_most == pytest.approx(UNIT * rise)
    assert any(f"most {1e-6 * numbers.thermal_most:.3g} MPa" in one for one in numbers.remarks)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"thermal": None}, r"add \[thermal\]"),
        ({"surface_1": {}}, "surface_1.material.expansion"),
        ({"transient": {"duration": "1 ms"}}, "keep the heat of earlier times"),
    ],
)
def test_thermal_stress_needs_heat_and_expansion(change, words):
    tables = thermal_tables() | {"stress": {"thermal": True}}
    if "surface_1" in change:
        own = STEEL.model_dump(exclude_none=True) | {"expansion": None}
        change = {"surface_1": tables["surface_1"] | {"material": own}}
    with pytest.raises((InputError, ValueError), match=words):
        case_from_tables(
            {key: value for key, value in (tables | change).items() if value is not None}
        )
