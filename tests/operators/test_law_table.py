import numpy as np
import pytest
from numba import njit

from tehl.base.typing import Array
from tehl.estimate.scaling import Scales
from tehl.kernels.energy import records
from tehl.kernels.energy.laws import evaluate_laws
from tehl.kernels.raw import raw
from tehl.lubricant import (
    Barus,
    ConstantDensity,
    ConstantViscosity,
    DowsonHigginson,
    Lubricant,
    RoelandsExponential,
    TaitDensity,
    TaitDoolittle,
    fluid,
    oil,
)
from tehl.operators.across import uniform
from tehl.operators.law_table import law_table

COLD = 313.15
HERTZ = 1.5e9
THICK = 40.0
PRESSURES = np.linspace(0.0, 4.0 * HERTZ, 96)
TEMPERATURES = np.linspace(COLD - 60.0, COLD + 700.0, 191)
GLASS = {"bulk_modulus": 1.2e9, "expansion": 8e-4, "softening": 6e-3}
FREE_VOLUME = TaitDoolittle(eta_0=0.0156, B=4.71, occupied=0.698, occupied_expansion=-1e-3, **GLASS)
DENSE = DowsonHigginson(rho_0=870.0, beta=6.5e-4)
OILS: dict[str, Lubricant] = {
    **{name: oil(name) for name in fluid.OILS.entries()},
    "barus": Lubricant(viscosity=Barus(eta_0=0.04, alpha=2e-8, gamma=0.04), density=DENSE),
    "exponential": Lubricant(
        viscosity=RoelandsExponential(eta_0=0.04, alpha=2e-8, gamma=0.04),
        density=DENSE.model_copy(update={"form": "additive"}),
    ),
    "constant": Lubricant(
        viscosity=ConstantViscosity(eta_0=0.04), density=ConstantDensity(rho_0=870.0)
    ),
    "tait": Lubricant(
        viscosity=Barus(eta_0=0.04, alpha=2e-8), density=TaitDensity(rho_0=870.0, **GLASS)
    ),
}
FREE = Lubricant(viscosity=FREE_VOLUME, density=TaitDensity(rho_0=870.0, **GLASS))
FITTED = [name for name in OILS if name != "squalane"]
SMOOTH = [name for name in FITTED if name != "tait"]
STEEP = ("cylinder-oil-2000", "n100", "nynas-t-22")
"""Oils of a low viscosity index, whose tables are weighted to the temperatures of films."""
FILM = TEMPERATURES < COLD + 290.0


def units(lubricant: Lubricant) -> Scales:
    return Scales(
        half_width_x=1e-4,
        half_width_y=1e-4,
        hertz_pressure=HERTZ,
        film_thickness=1e-6,
        viscosity=lubricant.viscosity.ambient(COLD),
        density=lubricant.density.ambient(COLD),
        speed=1.0,
        load=1.0,
        temperature=COLD,
    )


@njit
def evaluate(model: records.Model, work: records.Work) -> None:
    model, work = raw((model, work))
    for block in range(work.lines.shape[0]):
        evaluate_laws(model, work.terms, work.lines[block], work.layers[block])


def tabulated(lubricant: Lubricant) -> dict[str, Array]:
    """Return ln eta, rho and their slopes at all temperatures (first axis) and pressures."""
    scales = units(lubricant)
    nodes, rows = len(TEMPERATURES), len(PRESSURES)
    terms = records.Terms(**dict.fromkeys(records.Terms._fields, 0))
    model = records.Model(uniform(nodes), law_table(lubricant, scales), terms)
    work = records.scratch(nodes, rows, 1)
    work.layers["t"] = TEMPERATURES[:, None]
    work.lines["p"] = (PRESSURES / HERTZ).reshape(-1, records.BLOCK)
    evaluate(model, work)
    return {
        name: np.concatenate(work.layers[name], axis=1)
        for name in ("ln_eta", "slope", "rho", "rho_t")
    }


def warm(name: str) -> Array:
    """Return at which temperatures the table of an oil is that of its law, as a column."""
    return (FILM | (name not in STEEP))[:, None]


def exact(lubricant: Lubricant, warmer: float = 0.0) -> tuple[Array, Array]:
    p, t = np.meshgrid(PRESSURES, TEMPERATURES + warmer)
    scales = units(lubricant)
    with np.errstate(divide="ignore"):
        ln_eta = np.log(lubricant.viscosity.viscosity(p, t) / scales.viscosity)
    return ln_eta, lubricant.density.density(p, t) / scales.density


@pytest.mark.parametrize("name", FITTED)
def test_viscosity_is_that_of_the_law(name: str) -> None:
    ln_eta, _ = exact(OILS[name])
    error = np.abs(tabulated(OILS[name])["ln_eta"] - ln_eta)
    assert np.max(error[(ln_eta < THICK) & warm(name)]) < 2e-6


@pytest.mark.parametrize("name", SMOOTH)
def test_density_is_that_of_the_law(name: str) -> None:
    _, rho = exact(OILS[name])
    assert np.max(np.abs(tabulated(OILS[name])["rho"] / rho - 1.0)) < 1e-6


@pytest.mark.parametrize("name", SMOOTH)
def test_slopes_are_those_of_the_laws(name: str) -> None:
    table, (low, rho_low), (high, rho_high) = (
        tabulated(OILS[name]),
        exact(OILS[name], -0.01),
        exact(OILS[name], 0.01),
    )
    inner = (low < THICK) & (np.abs(TEMPERATURES - COLD - 320.0) < 340.0)[:, None] & warm(name)
    slope, rho_t = (low - high) / 0.02, (rho_high - rho_low) / 0.02
    assert np.max(np.abs(table["slope"] - slope)[inner]) < 1e-5
    assert np.max(np.abs(table["rho_t"] - rho_t)[inner]) < 1e-6


def test_density_of_tait_is_that_of_the_law_where_its_modulus_is() -> None:
    _, rho = exact(OILS["tait"])
    assert np.max(np.abs(tabulated(OILS["tait"])["rho"] / rho - 1.0)[FILM]) < 1e-6


@pytest.mark.parametrize(
    ("lubricant", "bounds"), [(FREE, (3e-6, 1e-4, 1e-3)), (OILS["squalane"], (1e-4, 6e-4, 6e-4))]
)
def test_free_volume_viscosity_is_that_of_the_law_far_from_the_glass(lubricant, bounds) -> None:
    ln_eta, _ = exact(lubricant)
    error = np.abs(tabulated(lubricant)["ln_eta"] - ln_eta)
    fluid = (ln_eta < THICK) & FILM[:, None]
    for pressure, bound in zip((0.5e9, 2e9, 4e9), bounds, strict=True):
        assert np.max(error[fluid & (pressure > PRESSURES)]) < bound


def test_temperature_beyond_the_table_is_that_of_its_end() -> None:
    lubricant = OILS["mineral-oil"]
    table = law_table(lubricant, units(lubricant))
    assert (table.coldest, table.hottest) == (COLD - 60.0, COLD + 700.0)
