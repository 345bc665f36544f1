"""Shear stresses and temperatures that look like those of a thermal run, without the solver."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.api.results import Result
from tehl.result.fields import FilmHeat, FilmShear, HeatBalance

HOTTEST = 40.0
"""Rise at mid-film over that of the surfaces, where p is the Hertz pressure [K]."""


def with_shear(result: Result) -> Result:
    """Return ``result`` with the stress ``-0.05 p`` at mid-film, in balance with the pressure."""
    pressure, film = result.pressure, result.film_thickness
    middle = -0.05 * pressure * np.sign(result.problem.slide_roll_ratio)
    half = 0.5 * film * np.gradient(pressure, result.x, axis=1)
    shear = FilmShear(
        surface_1=middle - half,
        mid_film=middle,
        surface_2=middle + half,
        across=0.5 * film * np.gradient(pressure, result.y, axis=0) * 0.1,
        thinning=np.full_like(film, 0.5),
    )
    return replace(result, shear=shear)


def with_heat(result: Result, layers: int = 9) -> Result:
    """Return ``result`` with a film that is hottest in the middle, and with its stresses."""
    zeta = 0.5 - 0.5 * np.cos(np.pi * np.arange(layers) / (layers - 1))
    flux = 2e8 * np.clip(result.scaled.pressure, 0, 1)
    surface = np.cumsum(flux, axis=1) * (result.scaled.x[1] - result.scaled.x[0]) * 5e-8
    surface *= np.exp(-np.maximum(result.scaled.x - 1, 0))
    middle = HOTTEST * np.clip(result.scaled.pressure, 0, 1) ** 1.2
    shape = 4 * zeta * (1 - zeta)
    walls = (1 - 0.2 * zeta)[:, None, None] * surface
    temperature = result.scales.temperature + walls + shape[:, None, None] * middle
    area = np.gradient(result.y)[:, None] * np.gradient(result.x)
    powers = [float(np.sum(area * part)) for part in (flux, 0.8 * flux)]
    heat = FilmHeat(
        zeta=zeta,
        weights=_mean_weights(zeta),
        temperature=temperature,
        flux_1=flux,
        flux_2=0.8 * flux,
        balance=HeatBalance(
            shear=1.02 * sum(powers),
            compression=0.01 * sum(powers),
            surface_1=powers[0],
            surface_2=powers[1],
            carried_out=0.02 * sum(powers),
        ),
        solid_peclet=(28.4, 22.1),
        sources=("line", "full"),
    )
    last = replace(result.history[-1], temperature_change=0.0125)
    return replace(with_shear(result), heat=heat, history=(*result.history[:-1], last))


def _mean_weights(zeta: np.ndarray) -> np.ndarray:
    """Return the weights that integrate all polynomials through ``zeta``."""
    powers = np.arange(zeta.size)
    return np.linalg.solve(np.vander(zeta, increasing=True).T, 1.0 / (powers + 1.0))


@pytest.fixture(scope="session")
def sheared(result: Result) -> Result:
    return with_shear(result)


@pytest.fixture(scope="session")
def thermal(result: Result) -> Result:
    return with_heat(result)
