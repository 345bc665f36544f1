import numpy as np
import pytest
from numba import njit

from tehl.kernels import energy
from tehl.kernels.lanes import addresses, load, store
from tehl.lubricant import (
    ConstantDensity,
    ConstantViscosity,
    Eyring,
    Lubricant,
    Newtonian,
    ShearLaw,
)
from tehl.operators.across import SCHEMES
from tehl.operators.law_table import law_table
from tehl.scaling import Scales
from tehl.typing import Array

ROWS = 2 * energy.BLOCK
UNITS = Scales(
    half_width_x=1e-4,
    half_width_y=1e-4,
    hertz_pressure=1e9,
    film_thickness=1e-6,
    viscosity=0.04,
    density=870.0,
    speed=1.0,
    load=1.0,
    temperature=313.0,
)


class Station:
    """Two blocks of rows of one station, layer by layer."""

    def __init__(self, *, scheme: str = "chebyshev", nodes: int = 9, shear: ShearLaw | None = None):
        self.across = SCHEMES[scheme](nodes)
        self.nodes = nodes
        lubricant = Lubricant(
            viscosity=ConstantViscosity(eta_0=UNITS.viscosity),
            density=ConstantDensity(rho_0=UNITS.density),
            shear=shear or Newtonian(),
        )
        numbers = dict.fromkeys(energy.Terms._fields, 0.0)
        numbers |= {"poiseuille": 7.0, "slide": -0.4, "speed": 1.2, "over_x": 30.0, "over_y": 20.0}
        numbers |= {"w0": 1.5, "w1": -2.0, "w2": 0.5, "inlet": UNITS.temperature}
        terms = energy.Terms(**numbers)._replace(mirror=1, mean=0, heat=1)
        self.model = energy.Model(self.across, law_table(lubricant, UNITS), terms)
        self.work = energy.scratch(nodes, ROWS, 1)
        self.cells = self.work.cells.reshape(ROWS // energy.BLOCK, -1)
        layers = self.cells[:, energy.LINE :]
        self.layers = layers.reshape(len(self.cells), nodes, -1, energy.BLOCK)
        random = np.random.default_rng(4)
        for name, low, high in (("H", 0.5, 1.0), ("PX", -1.0, 1.0), ("PY", -1.0, 1.0)):
            self.set_line(name, random.uniform(low, high, ROWS))
        self.set_line("STRESS", np.full(ROWS, 1.5))
        self.fill("LN_ETA", random.uniform(-1.0, 1.0, (nodes, ROWS)))
        self.fill("RHO", random.uniform(0.9, 1.1, (nodes, ROWS)))
        self.fill("T", np.full((nodes, ROWS), UNITS.temperature))

    def places(self, i: int = 3) -> list[energy.Place]:
        width = self.cells.shape[1]
        return [
            energy.Place(i, energy.BLOCK * block, width * block, self.nodes, ROWS, 1)
            for block in range(len(self.cells))
        ]

    def set_line(self, name: str, values: Array) -> None:
        at = getattr(energy, name)
        self.cells[:, at : at + energy.BLOCK] = values.reshape(len(self.cells), -1)

    def line(self, name: str) -> Array:
        at = getattr(energy, name)
        return self.cells[:, at : at + energy.BLOCK].ravel()

    def fill(self, name: str, values: Array) -> None:
        blocks = values.reshape(self.nodes, len(self.cells), energy.BLOCK)
        self.layers[:, :, getattr(energy, name) // energy.BLOCK] = blocks.transpose(1, 0, 2)

    def layer(self, name: str) -> Array:
        """Return a quantity of all layers, (n, rows)."""
        return np.concatenate(self.layers[:, :, getattr(energy, name) // energy.BLOCK], axis=1)

    def flow(self, steps: int = 0) -> None:
        for place in self.places():
            energy.flow(addresses(self.model), steps, addresses(self.work), place)

    def mobility(self) -> Array:
        out = np.zeros(ROWS)
        for place in self.places():
            write_mobility(addresses(self.across), addresses(self.work), place, addresses(out))
        return out


@njit
def write_exponentials(x: Array, count: int, out: Array) -> None:
    for at in range(0, count, energy.BLOCK):
        store(out, at, energy.exponential(load(x, at)))


@njit
def write_mobility(
    across: energy.Across, work: energy.Work, place: energy.Place, out: Array
) -> None:
    store(out, place.j, energy.mobility(across, work, place))


def test_exponential_is_that_of_numpy() -> None:
    x = np.concatenate([np.linspace(-689.0, 689.0, 4000), np.linspace(-2.0, 2.0, 4000)])
    y = np.zeros(len(x))
    write_exponentials(addresses(x), len(x), addresses(y))
    assert np.max(np.abs(y / np.exp(x) - 1.0)) < 1e-15


@pytest.mark.parametrize(("nodes", "band"), [(5, 4), (9, 8), (13, 2)])
def test_elimination_solves_the_columns(nodes: int, band: int) -> None:
    random = np.random.default_rng(1)
    columns = random.uniform(-1.0, 1.0, (nodes, nodes, energy.BLOCK))
    apart = np.abs(np.subtract.outer(np.arange(nodes), np.arange(nodes)))
    columns[apart > band] = 0.0
    columns[apart == 0] += 2.0 * nodes
    rhs = random.uniform(-1.0, 1.0, (nodes, energy.BLOCK))
    matrix = np.concatenate([columns.ravel(), rhs.ravel()])
    energy.solve_columns(addresses(matrix), nodes, band)
    found = matrix[columns.size :].reshape(nodes, -1)
    exact = np.linalg.solve(columns.transpose(2, 0, 1), rhs.T[:, :, None])[:, :, 0].T
    np.testing.assert_allclose(found, exact, rtol=1e-13, atol=1e-15)


def flow_by_numpy(station: Station) -> tuple[Array, Array, Array, Array]:
    """Return u, v, mobility and the cumulative mass flux along y of a Newtonian film."""
    across, terms = station.across, station.model.terms
    h, p_x, p_y = station.line("H"), station.line("PX"), station.line("PY")
    fluid, rho = np.exp(-station.layer("LN_ETA")), station.layer("RHO")
    arm = across.zeta[:, None] - 0.5
    i0, i1 = np.cumsum(across.step @ fluid, axis=0), np.cumsum(across.step @ (arm * fluid), axis=0)
    # u_zeta = h fluid (tau + 12/lambda h arm p_x), which goes from one wall to the other
    tilt = terms.poiseuille * h * i1[-1] / i0[-1]
    tau_x, tau_y = terms.slide / h / i0[-1] - tilt * p_x, -tilt * p_y
    u = terms.speed + h * (tau_x * i0 + terms.poiseuille * h * p_x * i1)
    v = h * (tau_y * i0 + terms.poiseuille * h * p_y * i1)
    # of unit h and gradient, zero at both walls
    profile = i1[-1] / i0[-1] * i0 - i1
    return u, v, 12.0 * across.weights @ (rho * profile), np.cumsum(across.step @ (h * rho * v), 0)


@pytest.mark.parametrize(("scheme", "nodes"), [("chebyshev", 9), ("uniform", 13)])
def test_flow_of_a_station(scheme: str, nodes: int) -> None:
    station = Station(scheme=scheme, nodes=nodes)
    station.flow()
    u, v, mobility, _ = flow_by_numpy(station)
    np.testing.assert_allclose(station.layer("U"), u, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(station.layer("V"), v, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(station.mobility(), mobility, rtol=1e-12)
    assert np.allclose(u[-1] - u[0], station.model.terms.slide)


@pytest.mark.parametrize("mirror", [0, 1])
def test_flow_across_the_layers_conserves_mass(mirror: int) -> None:
    station = Station()
    station.model = station.model._replace(terms=station.model.terms._replace(mirror=mirror))
    terms, work, places = station.model.terms, station.work, station.places()
    station.flow()
    work.mass[:] = np.random.default_rng(5).uniform(-1.0, 1.0, work.mass.shape)
    for place in places:
        energy.mass_fluxes(addresses(station.across), addresses(work), place)
    energy.complete_mass(terms, addresses(work), places[0])
    for place in places:
        energy.cross_flow(addresses(station.model), addresses(work), place)
    *_, side = flow_by_numpy(station)
    before = -side[:, 1] if mirror else 2.0 * side[:, 0] - side[:, 1]
    after = 2.0 * side[:, -1] - side[:, -2]
    wide = np.column_stack([before, side, after])
    here, last, older = (work.mass[(3 - back) % 3] for back in range(3))
    omega = -terms.over_x * (terms.w0 * here + terms.w1 * last + terms.w2 * older)
    omega -= 0.5 * terms.over_y * (wide[:, 2:] - wide[:, :-2])
    omega -= station.across.zeta[:, None] * omega[-1]
    np.testing.assert_allclose(station.layer("OMEGA"), omega, rtol=1e-11, atol=1e-12)


def test_uniform_film_has_the_isothermal_mobility() -> None:
    station = Station()
    station.fill("LN_ETA", np.full((station.nodes, ROWS), np.log(2.0)))
    station.fill("RHO", np.full((station.nodes, ROWS), 1.1))
    station.flow()
    np.testing.assert_allclose(station.mobility(), 1.1 / 2.0, rtol=1e-14)


def test_constant_laws_give_one() -> None:
    station = Station()
    station.set_line("P", np.linspace(0.0, 3.0, ROWS))
    for place in station.places():
        energy.evaluate_laws(addresses(station.model), addresses(station.work), place)
    np.testing.assert_allclose(station.layer("LN_ETA"), 0.0, atol=1e-14)
    np.testing.assert_allclose(station.layer("RHO"), 1.0, rtol=1e-14)


@pytest.mark.parametrize("slide", [-0.4, 0.4, 1e-6])
def test_stress_of_a_couette_film(slide: float) -> None:
    station = Station(shear=Eyring(stress=1e7))
    terms = station.model.terms._replace(slide=slide)
    station.model = station.model._replace(terms=terms)
    ln_eta = np.linspace(-2.0, 12.0, ROWS)
    station.fill("LN_ETA", np.tile(ln_eta, (station.nodes, 1)))
    station.set_line("PX", np.zeros(ROWS))
    station.set_line("PY", np.zeros(ROWS))
    station.flow(steps=40)
    scale, h = station.line("STRESS"), station.line("H")
    exact = np.arcsinh(np.exp(ln_eta) * slide / h * scale)
    np.testing.assert_allclose(station.line("TAU_X") * scale, exact, rtol=2e-7)
    np.testing.assert_allclose(station.line("TAU_Y"), 0.0, atol=1e-12)


@njit
def write_tangent(
    across: energy.Across, fluid: int, work: energy.Work, place: energy.Place, out: Array
) -> None:
    energy.moments(across, fluid, work, place)
    store(out, place.j, energy.mobility(across, work, place))


def flow_down(axis: str, slide: float, gradient: Array) -> tuple[Array, Array]:
    """Return the flow of an Eyring film along the gradient, and what it should rise by with it."""
    station = Station(shear=Eyring(stress=1e7))
    terms = station.model.terms._replace(slide=slide)
    station.model = station.model._replace(terms=terms)
    station.fill("RHO", np.ones((station.nodes, ROWS)))
    for name in ("PX", "PY"):
        station.set_line(name, gradient if name[1:].lower() == axis else np.zeros(ROWS))
    station.flow(steps=60)
    rise = np.zeros(ROWS)
    fluid = getattr(energy, f"TANGENT_{axis.upper()}")
    velocity = station.layer({"x": "U", "y": "V"}[axis])
    for place in station.places():
        write_tangent(
            addresses(station.across), fluid, addresses(station.work), place, addresses(rise)
        )
    return station.across.weights @ velocity, -terms.poiseuille / 12.0 * station.line(
        "H"
    ) ** 2 * rise


@pytest.mark.parametrize(("axis", "slide"), [("x", 0.0), ("x", -0.4), ("y", 0.0)])
def test_tangent_is_what_more_flows_when_the_gradient_grows(axis: str, slide: float) -> None:
    """Along either axis, at stresses of several scales of the law, the sliding being kept."""
    gradient, step = np.linspace(0.5, 6.0, ROWS), 1e-5
    more, _ = flow_down(axis, slide, gradient + step)
    less, _ = flow_down(axis, slide, gradient - step)
    flow, rise = flow_down(axis, slide, gradient)
    np.testing.assert_allclose((more - less) / (2.0 * step), rise, rtol=2e-5)
    if slide == 0.0:
        assert np.all(rise[-4:] / (flow[-4:] / gradient[-4:]) > 2.0)
