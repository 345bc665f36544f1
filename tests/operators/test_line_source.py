"""The moving line source: its sum of exponentials, and surfaces heated by known fluxes."""

import numpy as np
import pytest

from tehl.base.typing import Array
from tehl.operators.line_source import history

SUM = 1.2e-5
"""Relative error of the sum of exponentials, 2 exp(-pi^2 / (2 STEP)) and a little for its ends."""


def carried(flux: Array, spacing: float) -> Array:
    """Integral of flux(s) / sqrt(x - s) up to each node, carried on from node to node."""
    past = history(flux.size, spacing)
    out, modes = np.zeros(flux.size), np.zeros(past.decay.size)
    before = np.concatenate([[0.0, 0.0], flux])  # as the ghosts of the film, without flux
    for i, here in enumerate(flux):
        two, one = before[i], before[i + 1]
        modes = past.decay * modes + past.older * two + past.newer * one
        out[i] = past.near * here + past.next_ * one + modes.sum()
    return out


def by_definition(flux: Array, spacing: float) -> Array:
    """The same by the weights of the flux that is linear between nodes."""
    m = np.arange(1.0, flux.size)
    weights = np.concatenate([[1.0], (m + 1) ** 1.5 - 2 * m**1.5 + (m - 1) ** 1.5])
    return 4.0 / 3.0 * np.sqrt(spacing) * np.convolve(weights, flux)[: flux.size]


@pytest.mark.parametrize("nodes", [17, 129, 1025, 4097])
def test_the_exponentials_stand_for_the_whole_history(nodes):
    pulse = np.zeros(nodes)
    pulse[0] = 1.0
    found, exact = carried(pulse, 0.3), by_definition(pulse, 0.3)
    assert found[0] == exact[0]
    np.testing.assert_allclose(found, exact, rtol=2 * SUM)  # a hat is a second difference


@pytest.mark.parametrize("seed", range(3))
def test_any_flux_heats_as_the_weights_say(seed):
    flux = np.random.default_rng(seed).random(300)
    exact = by_definition(flux, 0.02)
    np.testing.assert_allclose(carried(flux, 0.02), exact, rtol=SUM)


def ramp(nodes: int) -> Array:
    """What a flux does that rises from 0 to 1 over the mesh width before the first node."""
    n = np.arange(float(nodes))
    return 4.0 / 3.0 * ((n + 1) ** 1.5 - n**1.5) - 2.0 * np.sqrt(n)


@pytest.mark.parametrize(
    ("q", "exact"),
    [(np.ones_like, lambda x: 2.0 * np.sqrt(x)), (lambda x: x, lambda x: 4.0 / 3.0 * x**1.5)],
    ids=["1", "s"],
)
@pytest.mark.parametrize("intervals", [16, 256])
def test_linear_fluxes_heat_exactly(q, exact, intervals):
    x = np.linspace(0.0, 1.0, intervals + 1)
    found = carried(q(x), x[1]) - q(x)[0] * np.sqrt(x[1]) * ramp(x.size)
    np.testing.assert_allclose(found, exact(x), rtol=0, atol=2.0 * SUM)


@pytest.mark.parametrize(
    ("q", "exact", "order"),
    [
        (lambda x: x**2, lambda x: 16.0 / 15.0 * x**2.5, 2.0),
        (np.sqrt, lambda x: np.pi / 2.0 * x, 1.0),  # its slope is not bounded
    ],
    ids=["s^2", "sqrt(s)"],
)
def test_other_fluxes_heat_to_the_order_of_the_mesh(q, exact, order):
    errors = []
    for intervals in (16, 32, 64):
        x = np.linspace(0.0, 1.0, intervals + 1)
        errors.append(np.abs(carried(q(x), x[1]) - exact(x)).max())
    observed = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(observed, order, atol=0.15)


BAND = {-0.5: 1.000474, 0.0: 1.748038, 0.5: 2.158386, 1.0: 1.885618, 2.0: 1.139488}
"""int sqrt(1 - s^2) / sqrt(x - s) ds from -1 to x: a band heated like a Hertz pressure."""
BAND_MAXIMUM, BAND_MEAN = 2.188307, 1.508495


def band(intervals: int) -> tuple[Array, Array]:
    """Places and rises of the Hertzian band with so many mesh widths on [-2, 2]."""
    x = np.linspace(-2.0, 2.0, intervals + 1)
    return x, carried(np.sqrt(np.maximum(1.0 - x**2, 0.0)), x[1] - x[0])


def test_the_band_of_a_hertzian_flux_is_met():
    x, rise = band(1024)
    for place, exact in BAND.items():
        error = abs(rise[np.argmin(np.abs(x - place))] - exact)
        # where the flux ends, with a slope that is not bounded, the error is larger
        assert error < (3e-3 if place == 1.0 else 2e-4), place
    assert rise.max() == pytest.approx(BAND_MAXIMUM, rel=5e-5)
    inside = np.abs(x) <= 1.0
    assert np.trapezoid(rise[inside], x[inside]) / 2.0 == pytest.approx(BAND_MEAN, rel=1e-4)


def test_the_band_is_met_to_the_order_of_its_flux():
    errors = []
    for intervals in (64, 128, 256):
        x, rise = band(intervals)
        errors.append([abs(rise[np.argmin(np.abs(x - s))] - BAND[s]) for s in (0.0, 0.5, 2.0)])
    observed = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(observed, 1.5, atol=0.2)  # sqrt(1 + s) at the leading edge


def test_nothing_is_heated_before_the_source():
    x, rise = band(128)
    assert (rise[x < -1.0 + 1e-12] == 0.0).all()
