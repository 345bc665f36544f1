"""Parts of the energy kernels against closed forms and numpy."""

import numpy as np
import pytest
from numba import njit

from tehl.base.typing import Array
from tehl.estimate.scaling import Scales
from tehl.kernels.energy import laws, records
from tehl.kernels.raw import lanes, raw
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
from tests.kernels import station as twin
from tests.kernels.interpreted import interpreted

column, flow, python_laws = (interpreted(f"energy.{name}") for name in ("column", "flow", "laws"))
ROWS = 2 * records.BLOCK
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
    """Two blocks of rows of one station."""

    def __init__(self, *, scheme: str = "chebyshev", nodes: int = 9, shear: ShearLaw | None = None):
        self.nodes = nodes
        lubricant = Lubricant(
            viscosity=ConstantViscosity(eta_0=UNITS.viscosity),
            density=ConstantDensity(rho_0=UNITS.density),
            shear=shear or Newtonian(),
        )
        numbers = dict.fromkeys(records.Terms._fields, 0.0)
        numbers |= {"poiseuille": 7.0, "over_x": 30.0, "over_y": 20.0}
        numbers |= {"w0": 1.5, "w1": -2.0, "w2": 0.5, "inlet": UNITS.temperature}
        terms = records.Terms(**numbers)._replace(mirror=1, period=0, mean=0, heat=1)
        self.model = records.Model(SCHEMES[scheme](nodes), law_table(lubricant, UNITS), terms)
        self.work = records.scratch(nodes, ROWS, 1)
        random = np.random.default_rng(4)
        for name, low, high in (("h", 0.5, 1.0), ("p_x", -1.0, 1.0), ("p_y", -1.0, 1.0)):
            self.set_line(name, random.uniform(low, high, ROWS))
        motion = {"slide_x": -0.4, "slide_y": 0.3, "speed_x": 1.2, "speed_y": -0.1}
        for name, value in ({"over_scale": 1.5, "over_y": 20.0} | motion).items():
            self.set_line(name, np.full(ROWS, value))
        self.fill("ln_eta", random.uniform(-1.0, 1.0, (nodes, ROWS)))
        self.fill("rho", random.uniform(0.9, 1.1, (nodes, ROWS)))
        self.fill("t", np.full((nodes, ROWS), UNITS.temperature))

    def set_line(self, name: str, values: Array) -> None:
        self.work.lines[name] = values.reshape(-1, records.BLOCK)

    def line(self, name: str) -> Array:
        return self.work.lines[name].ravel()

    def fill(self, name: str, values: Array) -> None:
        self.work.layers[name] = values.reshape(self.nodes, -1, records.BLOCK).transpose(1, 0, 2)

    def layer(self, name: str) -> Array:
        """Return a quantity of all layers, (n, rows)."""
        return np.concatenate(self.work.layers[name], axis=1)

    def flow(self, steps: int = 0) -> None:
        flow_of_blocks(self.model, self.work, steps)

    def mobility(self) -> Array:
        out = np.zeros(ROWS)
        write_mobility(self.model.across, self.work, out)
        return out


@njit
def write_exponentials(x: Array, out: Array) -> None:
    x, out = raw((x, out))
    for at in range(0, x.shape[0], records.BLOCK):
        out[lanes(at)] = laws.exponential(x[lanes(at)])


def flow_of_blocks(model: records.Model, work: records.Work, steps: int) -> None:
    for block in range(work.lines.shape[0]):
        flow.flow(model, work.lines[block], work.layers[block], steps)


def write_mobility(across: records.Across, work: records.Work, out: Array) -> None:
    for block in range(work.lines.shape[0]):
        flow.moments(across, work.layers[block])
        out[lanes(records.BLOCK * block)] = flow.mobility(across, work.layers[block])


def cross_flows(model: records.Model, work: records.Work, i: int) -> None:
    for block in range(work.lines.shape[0]):
        flow.mass_fluxes(model.across, work, records.Place(i, block))
    flow.complete_mass(model.terms, work, i)
    for block in range(work.lines.shape[0]):
        flow.cross_flow(model, work, records.Place(i, block))


def evaluate(model: records.Model, work: records.Work) -> None:
    for block in range(work.lines.shape[0]):
        python_laws.evaluate_laws(model, work.terms, work.lines[block], work.layers[block])


def test_exponential_is_that_of_numpy() -> None:
    x = np.concatenate([np.linspace(-689.0, 689.0, 4000), np.linspace(-2.0, 2.0, 4000)])
    y = np.zeros(len(x))
    write_exponentials(x, y)
    assert np.max(np.abs(y / np.exp(x) - 1.0)) < 1e-15


@pytest.mark.parametrize(("nodes", "band"), [(5, 4), (9, 8), (13, 2)])
def test_elimination_solves_the_columns(nodes: int, band: int) -> None:
    random = np.random.default_rng(1)
    columns = random.uniform(-1.0, 1.0, (nodes, nodes, records.BLOCK))
    apart = np.abs(np.subtract.outer(np.arange(nodes), np.arange(nodes)))
    columns[apart > band] = 0.0
    columns[apart == 0] += 2.0 * nodes
    rhs = random.uniform(-1.0, 1.0, (nodes, records.BLOCK))
    exact = np.linalg.solve(columns.transpose(2, 0, 1), rhs.T[:, :, None])[:, :, 0].T
    column.solve_columns(columns, rhs, band)
    np.testing.assert_allclose(rhs, exact, rtol=1e-13, atol=1e-15)


def twin_station(station: Station) -> twin.Station:
    """The same station for the equations in numpy."""
    names = {"p": "p", "h": "h", "px": "p_x", "py": "p_y", "pt": "p_t", "over_scale": "over_scale"}
    same = ("climb_x", "climb_y", "capacity", "conductivity", "tau_x", "tau_y")
    names |= {name: name for name in same}
    rows = {ours: station.line(theirs) for ours, theirs in names.items()}
    for name in ("slide", "speed"):
        rows[name] = station.line(f"{name}_x"), station.line(f"{name}_y")
    return twin.Station(**rows, t=station.layer("t"))


@pytest.mark.parametrize(("scheme", "nodes"), [("chebyshev", 9), ("uniform", 13)])
def test_flow_of_a_station(scheme: str, nodes: int) -> None:
    station = Station(scheme=scheme, nodes=nodes)
    station.flow()
    fluid = np.exp(-station.layer("ln_eta"))
    u, v = twin.velocities(station.model, twin_station(station), fluid)
    mobility = twin.mobility(station.model.across, station.layer("rho"), fluid)
    np.testing.assert_allclose(station.layer("u"), u, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(station.layer("v"), v, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(station.mobility(), mobility, rtol=1e-12)
    assert np.allclose(u[-1] - u[0], -0.4)
    assert np.allclose(v[-1] - v[0], 0.3)


@pytest.mark.parametrize("mirror", [0, 1])
def test_flow_across_the_layers_conserves_mass(mirror: int) -> None:
    station = Station()
    station.model = station.model._replace(terms=station.model.terms._replace(mirror=mirror))
    work, step = station.work, station.model.across.step
    station.flow()
    work.mass[:] = np.random.default_rng(5).uniform(-1.0, 1.0, work.mass.shape)
    cross_flows(station.model, work, 3)
    masses = [work.mass[(3 - back) % 3] for back in range(3)]
    flux = station.line("h") * station.layer("rho") * station.layer("v")
    through = twin.through_layers(station.model, masses, np.cumsum(step @ flux, axis=0))
    np.testing.assert_allclose(station.layer("through"), through, rtol=1e-11, atol=1e-12)


def test_uniform_film_has_the_isothermal_mobility() -> None:
    station = Station()
    station.fill("ln_eta", np.full((station.nodes, ROWS), np.log(2.0)))
    station.fill("rho", np.full((station.nodes, ROWS), 1.1))
    station.flow()
    np.testing.assert_allclose(station.mobility(), 1.1 / 2.0, rtol=1e-14)


def test_constant_laws_give_one() -> None:
    station = Station()
    station.set_line("p", np.linspace(0.0, 3.0, ROWS))
    evaluate(station.model, station.work)
    np.testing.assert_allclose(station.layer("ln_eta"), 0.0, atol=1e-14)
    np.testing.assert_allclose(station.layer("rho"), 1.0, rtol=1e-14)


@pytest.mark.parametrize("angle", [0.0, 0.7, np.pi])
@pytest.mark.parametrize("slide", [0.4, 1e-6])
def test_stress_of_a_couette_film(slide: float, angle: float) -> None:
    station = Station(shear=Eyring(stress=1e7))
    for name, part in (("slide_x", np.cos(angle)), ("slide_y", np.sin(angle))):
        station.set_line(name, np.full(ROWS, slide * part))
    ln_eta = np.linspace(-2.0, 12.0, ROWS)
    station.fill("ln_eta", np.tile(ln_eta, (station.nodes, 1)))
    station.set_line("p_x", np.zeros(ROWS))
    station.set_line("p_y", np.zeros(ROWS))
    station.flow(steps=40)
    scale, h = station.line("over_scale"), station.line("h")
    exact = np.arcsinh(np.exp(ln_eta) * slide / h * scale)
    np.testing.assert_allclose(station.line("tau_x") * scale, exact * np.cos(angle), rtol=2e-7)
    np.testing.assert_allclose(
        station.line("tau_y") * scale, exact * np.sin(angle), rtol=2e-7, atol=1e-12
    )


def flow_down(axis: str, slide: float, gradient: Array) -> tuple[Array, Array]:
    """Return the flow of an Eyring film along the gradient, and what it should rise by with it."""
    station = Station(shear=Eyring(stress=1e7))
    for name in ("slide_x", "slide_y", "speed_x", "speed_y"):
        station.set_line(name, np.full(ROWS, slide if name == f"slide_{axis}" else 0.0))
    station.fill("rho", np.ones((station.nodes, ROWS)))
    for name in ("p_x", "p_y"):
        station.set_line(name, gradient if name[2:] == axis else np.zeros(ROWS))
    station.flow(steps=60)
    station.fill("integrand", station.layer(f"tangent_{axis}"))
    rise = station.model.terms.poiseuille / 12.0 * station.line("h") ** 2 * station.mobility()
    return station.model.across.weights @ station.layer({"x": "u", "y": "v"}[axis]), -rise


@pytest.mark.parametrize(("axis", "slide"), [("x", 0.0), ("x", -0.4), ("y", -0.4)])
def test_tangent_is_what_more_flows_when_the_gradient_grows(axis: str, slide: float) -> None:
    """Along either axis, at stresses of several scales of the law, the sliding being kept."""
    gradient, step = np.linspace(0.5, 6.0, ROWS), 1e-5
    more, _ = flow_down(axis, slide, gradient + step)
    less, _ = flow_down(axis, slide, gradient - step)
    flow_now, rise = flow_down(axis, slide, gradient)
    np.testing.assert_allclose((more - less) / (2.0 * step), rise, rtol=2e-5)
    if slide == 0.0:
        assert np.all(rise[-4:] / (flow_now[-4:] / gradient[-4:]) > 2.0)
