"""The energy equation across the film against exact solutions.

One film is driven through `FilmState`, as the solver does, but with a pressure and a thickness that
the test states. Walls that keep their temperature are solids that conduct without end; insulated
ones are solids that do not conduct.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import quad

from tehl.api.problem import ContactProblem
from tehl.base.typing import Array
from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.energy import FilmState, driving_slopes, pressure_slopes
from tehl.operators.heated_film import HeatedFilm

COLD = 313.0
ROWS = 17
DOMAIN = Domain(x=(-2.0, 2.0), y=(-1.5, 1.5))
KEPT = {"density": 1e8, "heat_capacity": 1e8, "conductivity": 1e8}
INSULATED = {"density": 1e-3, "heat_capacity": 1e-3, "conductivity": 1e-3}
GAMMA = 0.04


@dataclass(kw_only=True)
class Layer:
    """A film with its scheme; by default it conducts and shears only, at constant viscosity."""

    slide: float = 0.0
    bulk: tuple[float, float] = (COLD, COLD)
    walls: dict[str, float]
    gamma: float = 1e-12
    eta_0: float = 0.04
    alpha: float = 1e-20
    beta: float = 0.0
    heat_capacity: float = 1e-9
    conductivity: float = 0.14
    nodes: int = 9
    scheme: str = "chebyshev"
    reynolds: str = "generalised"
    shear: dict[str, object] | None = None
    points: int = 17

    def problem(self) -> ContactProblem:
        solid = self.walls | {"young_modulus": 226e9, "poisson_ratio": 0.0}
        return ContactProblem.model_validate(
            {
                "contact": {
                    "radius": 0.02,
                    "hertz_pressure": 0.5e9,
                    "entrainment_speed": 1.5,
                    "slide_roll_ratio": self.slide,
                },
                "surface_1": {"material": solid, "temperature": self.bulk[0]},
                "surface_2": {"material": solid, "temperature": self.bulk[1]},
                "lubricant": {
                    "viscosity": {
                        "law": "barus",
                        "eta_0": self.eta_0,
                        "alpha": self.alpha,
                        "gamma": self.gamma,
                        "reference_temperature": COLD,
                    },
                    "density": {
                        "law": "dowson-higginson",
                        "rho_0": 890.0,
                        "slope": 0.0,
                        "saturation": 0.0,
                        "beta": self.beta,
                        "reference_temperature": COLD,
                    },
                    "shear": self.shear or {"law": "newtonian"},
                    "conductivity": self.conductivity,
                    "heat_capacity": self.heat_capacity,
                },
                "thermal": {
                    "layers": self.nodes,
                    "scheme": self.scheme,
                    "reynolds": self.reynolds,
                    "sources": "line",
                },
            }
        )

    def state(self, *, film: float = 1.0, slope: float = 0.0, mirror: bool = True) -> FilmState:
        """Return the state of a film of constant thickness whose pressure rises by ``slope``."""
        problem = self.problem()
        grid = Grid(nx=self.points, ny=ROWS, domain=DOMAIN, mirror=mirror)
        state = FilmState(grid, HeatedFilm(ScaledProblem.of(problem)), 2)
        pressure = 0.5 + np.broadcast_to(slope * grid.x, grid.shape)
        state.set_film(pressure.copy(), np.full(grid.shape, film))
        return state


def test_slopes_that_drive_the_flow_are_those_of_a_smooth_pressure_and_small_at_a_foot():
    groups = ScaledProblem.of(Layer(walls=KEPT).problem()).groups
    stiff = replace(groups, alpha_bar=30.0)
    grid = Grid(nx=65, ny=ROWS, domain=DOMAIN, mirror=True)
    smooth = np.sqrt(np.maximum(1.0 - grid.x**2 / 9.0 - grid.y[:, None] ** 2 / 9.0, 0.0))
    for whole, driving in zip(
        pressure_slopes(grid, stiff, smooth), driving_slopes(grid, stiff, smooth), strict=True
    ):
        np.testing.assert_allclose(driving, whole, rtol=0, atol=1e-5)
    front = np.where(grid.x < 0.0, 1.0, 0.01 * np.exp(-grid.x)) + np.zeros(grid.shape)
    foot = int(np.argmax(front[0] < 0.5))
    whole, driving = (
        -slopes(grid, stiff, front)[0][0, foot] * grid.dx
        for slopes in (pressure_slopes, driving_slopes)
    )
    assert whole > 0.4
    assert 0.0 < driving < 0.005


def settled(state: FilmState, sweeps: int = 60) -> FilmState:
    """Sweep until the temperature no longer changes."""
    for _ in range(sweeps):
        change = state.sweep(20)
        if change < 1e-10:
            return state
    assert change < 1e-6
    return state


def rise(state: FilmState) -> Array:
    """Rise across the film half-way along it, over the inlet [K]."""
    return state.temperature[state.grid.nx // 2, :, 3] - COLD


def brinkman(layer: Layer) -> float:
    """Return eta u_m^2 / k [K]."""
    return layer.eta_0 * 1.5**2 / layer.conductivity


@pytest.mark.parametrize("scheme", ["chebyshev", "uniform"])
@pytest.mark.parametrize("bulk", [(COLD, COLD), (COLD, COLD + 25.0)])
@pytest.mark.parametrize("slide", [-1.0, 0.7])
def test_couette_flow_between_walls_heats_to_a_parabola(scheme, bulk, slide):
    layer = Layer(slide=slide, bulk=bulk, walls=KEPT, scheme=scheme)
    state = settled(layer.state(film=0.7))
    zeta = state.film.across.zeta
    heated = 0.5 * brinkman(layer) * slide**2
    exact = bulk[0] - COLD + (bulk[1] - bulk[0]) * zeta + heated * zeta * (1.0 - zeta)
    # exact on either set of nodes; the walls conduct 1e8 times better than steel, not without end
    np.testing.assert_allclose(rise(state), exact, rtol=0, atol=1e-6)
    # eta du^2 / (2 h) into each wall, and what the difference of the walls drives
    for side, flux in enumerate(state.fluxes):
        driven = (bulk[1] - bulk[0]) * (1 - 2 * side)
        np.testing.assert_allclose(flux[8, 3] * 0.7, heated + driven, rtol=1e-6)


def nahme(number: float) -> tuple[float, float, float]:
    """Return c, b dT at mid-film and the stress over the isothermal one."""
    c = math.asinh(math.sqrt(number / 8.0))
    return c, math.log1p(number / 8.0), c / math.sqrt(number / 8.0 * (1.0 + number / 8.0))


NAHME = [
    (0.1, 0.0124225, 0.991749),
    (1.0, 0.117783, 0.924196),
    (8.0, 0.693147, 0.623225),
    (10.0, 0.810930, 0.573879),
    (100.0, 2.602690, 0.152069),
    (1000.0, 4.836282, 0.0247755),
]


def nahme_layer(number: float, nodes: int, scheme: str = "chebyshev") -> Layer:
    """Return a film whose viscosity falls exponentially, at the sliding speed of a Nahme number."""
    layer = Layer(walls=KEPT, gamma=GAMMA, nodes=nodes, scheme=scheme, conductivity=0.5)
    layer.slide = -math.sqrt(number / (GAMMA * brinkman(layer)))
    return layer


def nahme_errors(number: float, nodes: int, scheme: str = "chebyshev") -> tuple[float, float]:
    """Errors of mid-film temperature and stress, relative."""
    layer = nahme_layer(number, nodes, scheme)
    state = settled(layer.state(), sweeps=400)
    _, warmer, softer = nahme(number)
    stress = state.view("tau_x")[8, 3] / -layer.slide
    return GAMMA * rise(state)[nodes // 2] / warmer - 1.0, stress / softer - 1.0


@pytest.mark.parametrize(("number", "warmer", "softer"), NAHME)
def test_the_closed_form_of_nahme_is_that_of_the_table(number, warmer, softer):
    _, mid_film, stress = nahme(number)
    assert mid_film == pytest.approx(warmer, rel=1e-5)
    assert stress == pytest.approx(softer, rel=1e-5)


TABLE = 1e-4
"""How well the tables of the laws know a viscosity that falls by exp(30) over their range."""


@pytest.mark.parametrize(
    ("nodes", "accuracy"),
    [
        (9, (TABLE, TABLE, TABLE, TABLE, 1e-3, 1e-2)),
        (13, (TABLE, TABLE, TABLE, TABLE, TABLE, 5e-4)),
        (21, (TABLE, TABLE, TABLE, TABLE, TABLE, TABLE)),
    ],
)
def test_a_film_that_thins_by_its_own_heat_is_that_of_nahme(nodes, accuracy):
    for (number, _, _), limit in zip(NAHME, accuracy, strict=True):
        warmer, softer = nahme_errors(number, nodes)
        assert abs(warmer) < limit, number
        assert abs(softer) < limit, number


def test_uniform_layers_meet_nahme_to_second_order():
    coarse, fine = (nahme_errors(100.0, nodes, "uniform") for nodes in (21, 41))
    np.testing.assert_allclose(np.log2(np.divide(coarse, fine)), 2.0, atol=0.1)


def test_the_temperature_of_nahme_is_met_at_all_nodes():
    layer = nahme_layer(10.0, 9)
    state = settled(layer.state(), sweeps=400)
    c, _, _ = nahme(10.0)
    exact = np.log((1.0 + 10.0 / 8.0) / np.cosh(c * (1.0 - 2.0 * state.film.across.zeta)) ** 2)
    np.testing.assert_allclose(GAMMA * rise(state), exact, rtol=0, atol=TABLE)


@pytest.mark.parametrize("scheme", ["chebyshev", "uniform"])
def test_a_pressure_gradient_heats_to_the_fourth_power(scheme):
    slope, film = 0.2, 0.8

    def error(nodes: int) -> float:
        layer = Layer(walls=KEPT, scheme=scheme, nodes=nodes)
        state = settled(layer.state(film=film, slope=slope))
        heated = (
            brinkman(layer)
            * (12.0 / state.film.scaled.groups.lambda_bar * slope * film**2) ** 2
            / 192.0
        )
        exact = heated * (1.0 - (1.0 - 2.0 * state.film.across.zeta) ** 4)
        return float(np.abs(rise(state) - exact).max() / heated)

    if scheme == "chebyshev":
        assert error(9) < 1e-7
    else:
        assert np.log2(error(21) / error(41)) == pytest.approx(2.0, abs=0.05)


LAWS = [
    {"law": "eyring", "stress": 5e6},
    {"law": "carreau", "modulus": 6e6, "exponent": 0.42},
    {"law": "limiting", "stress": 20e6},
]


@pytest.mark.parametrize("shear", LAWS, ids=lambda law: law["law"])
def test_a_thinning_film_bears_the_stress_of_its_law(shear):
    layer = Layer(slide=-0.4, walls=KEPT, shear=shear, eta_0=20.0)
    state = settled(layer.state(film=0.6))
    scale = state.film.scaled.scales
    thickness, sliding = 0.6 * scale.film_thickness, 0.4 * scale.speed
    law = state.film.scaled.problem.lubricant.shear
    unit = float(law.stress_scale(np.zeros(1))[0])
    stress = unit * float(law.stress_at(np.array([20.0 * sliding / thickness / unit]))[0])
    found = state.view("tau_x")[8, 3] * scale.viscosity * scale.speed / scale.film_thickness
    assert found == pytest.approx(stress, rel=2e-6)  # ln F is tabulated
    heated = stress * sliding * thickness / (8.0 * layer.conductivity)
    assert rise(state)[4] == pytest.approx(heated, rel=1e-5)


SLUG = {"eta_0": 1e7, "heat_capacity": 2000.0, "walls": INSULATED}
"""Oil so stiff that it moves as one, between walls that take no heat."""


def test_a_slug_is_heated_along_its_way():
    layer = Layer(slide=2e-3, **SLUG | {"eta_0": 2e4})
    state = settled(layer.state())
    x = state.grid.x
    per_length = brinkman(layer) * layer.slide**2 / state.model.terms.peclet
    # the source begins half-way between the last node before the film and its first
    exact = per_length * (x - x[0] + 0.5 * state.grid.dx)
    assert exact[-1] > 1.0
    for layer_rise in (state.temperature[:, :, 3] - COLD).T:
        # the start of a difference over three nodes is forgotten after some
        np.testing.assert_allclose(layer_rise[6:], exact[6:], rtol=1e-4)


def mean(state: FilmState, row: int) -> Array:
    """Rise of the mean temperature across the film, along it [K]."""
    return (state.temperature[:, :, row] - COLD) @ state.film.across.weights


def test_compression_heats_a_slug_as_its_expansion_says():
    """dT/dp = beta T / (rho c) along the way, with the beta and the rho of the law."""
    beta, slope = 6.5e-4, 0.1

    def error(points: int) -> float:
        state = settled(Layer(beta=beta, points=points, **SLUG).state(slope=slope))
        x = state.grid.x
        pressure = (
            state.film.scaled.scales.hertz_pressure * slope * (x - x[0] + 0.5 * state.grid.dx)
        )
        # rho^2 c dT = rho_0 beta T dp with rho = rho_0 (1 - beta (T - T_0)), integrated
        warm = np.linspace(COLD, COLD + 60.0, 2001)
        rate = 890.0 * 2000.0 * (1.0 - beta * (warm - COLD)) ** 2 / (beta * warm)
        needed = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(warm))])
        exact = np.interp(pressure, needed, warm) - COLD
        assert exact.max() > 20.0
        away = slice(points // 2, None)
        return float(np.abs(mean(state, 3) - exact)[away].max())

    assert error(65) < 1e-3
    assert np.log2(error(17) / error(65)) / 2.0 == pytest.approx(2.0, abs=0.3)


def test_oil_that_enters_between_warm_walls_is_warmed_to_second_order():
    wall, film = 10.0, 10.0

    def error(points: int) -> float:
        layer = Layer(
            walls=KEPT, bulk=(COLD + wall, COLD + wall), heat_capacity=2000.0, nodes=13,
            eta_0=1e7, points=points,
        )  # fmt: skip
        state = settled(layer.state(film=film))
        x, zeta = state.grid.x[:, None], state.film.across.zeta[None, :]
        way = (x - x[0] + 0.5 * state.grid.dx) / (state.model.terms.peclet * film**2)
        cold = sum(
            4.0 / (n * np.pi) * np.sin(n * np.pi * zeta) * np.exp(-((n * np.pi) ** 2) * way)
            for n in range(1, 40, 2)
        )
        found = (state.temperature[:, :, 3] - COLD - wall) / -wall
        return float(np.abs(found - cold)[x[:, 0] > -1.0].max())

    errors = [error(points) for points in (33, 65, 129)]
    assert errors[-1] < 1e-3
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.2)


@pytest.mark.parametrize("reynolds", ["generalised", "mean", "mean-all"])
@pytest.mark.parametrize("slide", [0.0, 1.2])
def test_constant_properties_give_back_the_isothermal_coefficients(reynolds, slide):
    layer = Layer(slide=slide, walls=KEPT, reynolds=reynolds, alpha=15e-9)
    state = layer.state()
    shape, rng = state.grid.shape, np.random.default_rng(2)
    pressure = 0.2 + 0.5 * rng.random(shape)
    state.set_film(pressure, 0.5 + rng.random(shape))
    state.sweep(1)
    eta = np.exp(15e-9 * state.film.scaled.scales.hertz_pressure * pressure)
    np.testing.assert_allclose(state.view("mobility").T * eta, 1.0, rtol=1e-5)
    np.testing.assert_allclose(state.view("density"), 1.0, rtol=1e-6)


def test_there_is_no_wedge_where_the_viscosity_is_the_same_across_the_film():
    layer = Layer(slide=1.9, walls=KEPT, bulk=(COLD, COLD + 50.0))
    state = settled(layer.state())
    assert np.ptp(rise(state)) > 40.0
    np.testing.assert_allclose(state.view("density"), 1.0, rtol=1e-10)
    np.testing.assert_allclose(state.view("mobility"), 1.0, rtol=1e-6)


@pytest.mark.parametrize("warmer", [-40.0, 25.0, 80.0])
@pytest.mark.parametrize("slide", [-1.5, 1.0])
def test_walls_of_unequal_temperature_make_the_wedge_of_their_viscosities(warmer, slide):
    """A linear temperature across the film and ln eta linear in it: closed forms."""
    layer = Layer(
        slide=slide, walls=KEPT, bulk=(COLD, COLD + warmer), gamma=GAMMA, eta_0=1e-7, nodes=13
    )
    state = settled(layer.state())
    c = GAMMA * warmer
    sheared = 1.0 / c - 1.0 / math.expm1(c)  # mean of int_0^zeta dz/eta over that to the wall
    speed = 1.0 + 0.5 * slide  # of surface 1
    np.testing.assert_allclose(state.view("density")[8, 3], speed - slide * sheared, rtol=TABLE)
    assert abs(state.view("density")[8, 3] - 1.0) > 0.05

    def fluidity(zeta: float) -> float:
        return math.exp(c * zeta)

    whole = quad(fluidity, 0.0, 1.0)[0]
    moment = quad(lambda z: z * fluidity(z), 0.0, 1.0)[0]
    # int_0^1 int_0^zeta f dz dzeta = int_0^1 (1 - z) f dz
    single = quad(lambda z: (1.0 - z) * fluidity(z), 0.0, 1.0)[0]
    double = quad(lambda z: (1.0 - z) * z * fluidity(z), 0.0, 1.0)[0]
    exact = 12.0 * (single * moment / whole - double)
    np.testing.assert_allclose(state.view("mobility")[8, 3], exact, rtol=2.0 * TABLE)


def test_half_a_film_and_the_full_one_have_the_same_temperature():
    layer = Layer(slide=0.8, walls=KEPT, gamma=GAMMA, heat_capacity=2000.0, beta=6e-4)
    half, full = (layer.state(mirror=mirror) for mirror in (True, False))
    x, y = half.grid.x[None, :], half.grid.y[:, None]
    pressure = np.maximum(1.0 - x**2 - y**2, 0.0)
    film = 0.3 + 0.2 * x**2 + 0.1 * y**2
    half.set_film(pressure, film)
    full.set_film(half.grid.unfold(pressure), half.grid.unfold(film))
    for _ in range(10):
        half.sweep(20)
        full.sweep(20)
    np.testing.assert_allclose(
        full.temperature[:, :, ROWS // 2 :], half.temperature, rtol=0, atol=1e-9
    )
    np.testing.assert_allclose(full.temperature[:, :, ::-1], full.temperature, rtol=0, atol=1e-9)
