"""Temperatures of a film: maps, rises and where they are."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.post.heat import lagrange_weights
from tests.fixtures_thermal import HOTTEST, with_heat


def test_an_isothermal_run_has_no_temperatures(result):
    assert result.temperature is None


def test_rises_are_over_the_inlet(thermal):
    found, layers = thermal.temperature, thermal.heat.temperature
    assert found.inlet == 313.15
    assert found.film_rise_max == layers.max() - 313.15
    assert found.surface_1_rise_max == layers[0].max() - 313.15
    assert found.surface_2_rise_max == layers[-1].max() - 313.15
    assert found.surface_2_rise_max == pytest.approx(0.8 * found.surface_1_rise_max)


def test_the_hottest_place_is_a_node_with_y_not_negative(thermal):
    x, y, zeta = thermal.temperature.film_rise_max_at
    column = int(np.flatnonzero(thermal.scaled.x == x)[0])
    row = int(np.flatnonzero(thermal.scaled.y == y)[0])
    layer = int(np.flatnonzero(thermal.heat.zeta == zeta)[0])
    assert thermal.heat.temperature[layer, row, column] == thermal.heat.temperature.max()
    assert y >= 0


@pytest.mark.parametrize("layers", [8, 9])
def test_mid_film_needs_no_node_in_the_middle(result, layers):
    found = with_heat(result, layers)
    centre = (32, int(np.argmin(np.abs(found.scaled.x))))
    surface = 0.9 * (found.heat.temperature[0][centre] - 313.15)
    rise = found.temperature.mid_film[centre] - 313.15
    assert rise == pytest.approx(surface + HOTTEST, rel=1e-12)


@pytest.mark.parametrize("nodes", [np.linspace(0, 1, 20), np.array([0.0, 0.3, 0.7, 1.0])])
def test_interpolation_is_exact_for_a_cubic(nodes):
    weights = lagrange_weights(nodes, 0.5)
    assert weights @ (nodes**3 - 2 * nodes) == pytest.approx(0.125 - 1.0, abs=1e-9)
    assert weights.sum() == pytest.approx(1.0)


def test_the_mean_takes_the_weights_of_the_scheme(thermal):
    """The mean of 4 zeta (1 - zeta) is 2/3 of its middle."""
    surfaces = 0.5 * (thermal.heat.temperature[0] + thermal.heat.temperature[-1])
    middle = thermal.temperature.mid_film - surfaces
    assert thermal.temperature.mean - surfaces == pytest.approx(2 / 3 * middle, abs=1e-9)


def test_central_values_are_those_at_the_origin(thermal):
    found = thermal.temperature
    middle = thermal.scaled.at_origin(found.mid_film) - 313.15
    assert found.mid_film_rise_central == middle
    assert found.mean_rise_central < middle


def test_the_origin_between_nodes_is_interpolated(result):
    fields = replace(result.scaled, x=result.scaled.x + 0.01)
    x, y = np.meshgrid(fields.x, fields.y)
    assert fields.at_origin(3.0 + x - 2 * y + x**2) == pytest.approx(3.0)


def test_the_error_of_the_balance_is_the_missing_power(thermal):
    balance = thermal.heat.balance
    total = balance.surface_1 + balance.surface_2
    assert balance.error == pytest.approx(0.01 * total / (1.03 * total))
