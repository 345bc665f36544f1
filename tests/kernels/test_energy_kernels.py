"""The energy kernels against their twin in plain numpy, `tests.kernels.station`."""

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.kernels.energy.march import sweep
from tehl.kernels.energy.outputs import NEGLIGIBLE_EXCESS
from tehl.kernels.energy.records import BLOCK
from tehl.operators.energy import FilmState
from tehl.operators.heated_film import HeatedFilm
from tests.kernels import station

SHEAR = {
    "newtonian": {"law": "newtonian"},
    "eyring": {"law": "eyring", "stress": 5e6},
    "limiting": {"law": "limiting", "slope": 0.05, "stress": 1e7},
}


def heated_state(shear, wedge, scheme, reynolds="generalised", mirror=True, **turned):
    """A small heated film under a pressure and a thickness that vary along x and y."""
    problem = ContactProblem.model_validate({
        "contact": {"radius": 0.02, "hertz_pressure": 0.6e9, "entrainment_speed": 1.5,
                    "slide_roll_ratio": 0.4},
        "surface_1": {"material": "steel"},
        "surface_2": {"material": "steel"},
        "lubricant": {
            "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 18e-9, "gamma": 0.04},
            "density": {"law": "dowson-higginson", "rho_0": 890, "beta": 6.5e-4},
            "shear": SHEAR[shear], "conductivity": 0.14, "heat_capacity": 2000.0,
        },
        "thermal": {"temperature": 313.0, "scheme": scheme, "reynolds": reynolds,
                    "sources": "line"},
    })  # fmt: skip
    domain = Domain(x=(-1.5, 1.5), y=(-1.5, 1.5))
    grid = Grid(nx=9, ny=31 if mirror else 16, domain=domain, mirror=mirror)
    state = FilmState(grid, HeatedFilm(ScaledProblem.of(problem)), wedge)
    if turned:  # slide across the entrainment, and spin
        state.whole = state.whole._replace(**turned, plain=0)
        state.model = state.model._replace(terms=state.whole)
        state.slide(1.0)
        for surface, power in zip(state.surfaces, (0.3, -0.2), strict=True):
            surface.slowness[:] = np.exp(power * state.fields.y)
    y, x = np.meshgrid(grid.y[-grid.shape[0] :], grid.x, indexing="ij")
    pressure = np.sqrt(np.maximum(1.0 - 0.3 * x**2 - 0.4 * y**2, 0.04))
    state.set_film(pressure, 0.25 + 0.1 * x**2 + 0.2 * np.abs(y))
    return state


def swept(state):
    """What a sweep and its twin make of the same film, after the stress has converged."""
    for _ in range(3):
        state.sweep(60)
    unheated = state.model._replace(terms=state.model.terms._replace(heat=0))
    for _ in range(4):  # the last Newton step of each is below the square of its tolerance
        sweep(unheated, state.fields, state.surfaces, state.work, (60, False))
    fields = state.fields._replace(**{k: v.copy() for k, v in state.fields._asdict().items()})
    surfaces = [surface._replace(flux=surface.flux.copy()) for surface in state.surfaces]
    twin = station.sweep(state.model, fields, type(state.surfaces)(*surfaces))
    state.sweep(60)
    excess_y = twin.pop("excess_y").reshape(len(fields.p), -1, BLOCK).max(axis=2)
    # blocks that need no other mobility
    straight = np.repeat(excess_y <= NEGLIGIBLE_EXCESS, BLOCK, axis=1)
    twin["stretch_y"] = np.where(straight, 1.0, twin["stretch_y"])
    twin["temperature"] = fields.temperature[2:-2, :, 2:-2]
    twin["flux_1"], twin["flux_2"] = (surface.flux[2:-2] for surface in surfaces)
    found = {name: getattr(state.fields, name) for name in twin if not name.startswith(("t", "f"))}
    found["temperature"] = state.fields.temperature[2:-2, :, 2:-2]
    found["flux_1"], found["flux_2"] = (surface.flux[2:-2] for surface in state.surfaces)
    return found, twin


def assert_equal(found, twin):
    for name, values in found.items():
        size = np.abs(twin[name]).max() or 1.0
        np.testing.assert_allclose(values / size, twin[name] / size, 0.0, 1e-10, err_msg=name)


@pytest.mark.parametrize("scheme", ["chebyshev", "uniform"])
@pytest.mark.parametrize("wedge", [1, 2])
@pytest.mark.parametrize("shear", list(SHEAR))
def test_a_sweep_equals_its_twin(shear, wedge, scheme):
    found, twin = swept(heated_state(shear, wedge, scheme))
    assert twin["temperature"].max() > 320.0
    assert_equal(found, twin)


@pytest.mark.parametrize("reynolds", ["mean", "mean-all"])
def test_a_sweep_with_mean_properties_equals_its_twin_on_the_full_domain(reynolds):
    assert_equal(*swept(heated_state("eyring", 2, "chebyshev", reynolds, mirror=False)))


@pytest.mark.parametrize("shear", list(SHEAR))
def test_a_sweep_with_sliding_across_and_spin_equals_its_twin(shear):
    state = heated_state(shear, 2, "chebyshev", mirror=False, slide_y=0.3, spin=0.2, spin_1=0.15)
    found, twin = swept(state)
    assert np.abs(twin["odd_density"]).max() > 0.0
    assert_equal(found, twin)
