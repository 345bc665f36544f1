"""Nodes across the film: what is differentiated and integrated exactly, and to which order."""

import numpy as np
import pytest

from tehl.operators.across import SCHEMES, chebyshev, uniform

LAYERS = (5, 9, 13, 21)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("nodes", LAYERS)
def test_nodes_rise_from_surface_to_surface_and_mirror(scheme, nodes):
    across = SCHEMES[scheme](nodes)
    assert across.zeta[0] == 0.0
    assert across.zeta[-1] == 1.0
    assert (np.diff(across.zeta) > 0.0).all()
    np.testing.assert_allclose(across.zeta + across.zeta[::-1], 1.0, rtol=0, atol=1e-15)
    np.testing.assert_allclose(across.weights, across.weights[::-1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(across.d1, -across.d1[::-1, ::-1], rtol=0, atol=1e-11)
    np.testing.assert_allclose(across.d2[1:-1], across.d2[-2:0:-1, ::-1], rtol=0, atol=1e-9)


@pytest.mark.parametrize("nodes", LAYERS)
def test_chebyshev_differentiates_polynomials_through_its_nodes(nodes):
    across = chebyshev(nodes)
    z = across.zeta
    for power in range(nodes):
        slope = power * z ** max(power - 1, 0)
        bend = power * (power - 1) * z ** max(power - 2, 0)
        # rounding grows with the fourth power of the nodes in the second derivative
        np.testing.assert_allclose(across.d1 @ z**power, slope, rtol=0, atol=1e-14 * nodes**3)
        np.testing.assert_allclose(across.d2 @ z**power, bend, rtol=0, atol=1e-14 * nodes**5)


@pytest.mark.parametrize("nodes", LAYERS)
def test_chebyshev_integrates_polynomials_through_its_nodes(nodes):
    across = chebyshev(nodes)
    z = across.zeta
    for power in range(nodes):
        exact = z ** (power + 1) / (power + 1)
        values = z**power
        np.testing.assert_allclose(np.cumsum(across.step @ values), exact, rtol=0, atol=1e-13)
        assert across.weights @ values == pytest.approx(exact[-1], rel=1e-13)


def test_uniform_layers_are_exact_for_parabolas_and_trapezoids():
    across = uniform(21)
    z = across.zeta
    np.testing.assert_allclose(across.d1 @ z**2, 2 * z, rtol=0, atol=1e-12)
    np.testing.assert_allclose((across.d2 @ z**2)[1:-1], 2.0, rtol=1e-11)
    np.testing.assert_allclose((across.d2 @ z**3)[1:-1], 6 * z[1:-1], rtol=1e-11)
    np.testing.assert_allclose(np.cumsum(across.step @ z), 0.5 * z**2, rtol=0, atol=1e-14)


def errors(scheme: str, nodes: int) -> np.ndarray:
    """Largest errors of slope, curvature inside, running and whole integral of exp(z)."""
    across = SCHEMES[scheme](nodes)
    exact = np.exp(across.zeta)
    found = (
        across.d1 @ exact - exact,
        (across.d2 @ exact - exact)[1:-1],
        np.cumsum(across.step @ exact) - (exact - 1.0),
        across.weights @ exact - (np.e - 1.0),
    )
    return np.array([np.abs(error).max() for error in found])


def test_uniform_layers_are_of_second_order():
    orders = np.log2(errors("uniform", 41) / errors("uniform", 81))
    np.testing.assert_allclose(orders, 2.0, atol=0.1)  # one-sided slopes at the walls included


def test_nine_chebyshev_nodes_do_what_two_hundred_layers_cannot():
    assert (errors("chebyshev", 9) < 1e-6).all()
    assert (errors("chebyshev", 9)[0] < errors("uniform", 201)[0]).all()


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_matrices_reach_no_farther_than_the_band(scheme):
    across = SCHEMES[scheme](11)
    k = np.arange(11)
    outside = np.abs(k[:, None] - k[None, :]) > across.band
    for matrix in (across.d1, across.d2, across.step):
        assert (matrix[outside] == 0.0).all()
