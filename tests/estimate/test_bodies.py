"""Balance of the heat of two bodies, of formulas in place of films."""

import math

import numpy as np
import pytest

from tehl.api.problem import case_from_tables
from tehl.estimate.bodies import NotBalancedError, balanced
from tests.cases import ball_tables


def contact(first, second):
    tables = ball_tables(lubricant="mineral-oil", thermal={"temperature": 313.0})
    for name, one in (("surface_1", first), ("surface_2", second)):
        stated = "temperature" if one and 200 < one < 999 else "thermal_resistance"
        tables[name] = {"material": "steel"} | ({stated: one} if one is not None else {})
    return case_from_tables(tables)[0]


class Film:
    """Heat that falls with the temperature of the film, and flows from body to body."""

    def __init__(self, power, slope, conductance=0.05):
        self.power, self.slope, self.conductance, self.calls = power, slope, conductance, 0

    def __call__(self, first, second):
        self.calls += 1
        half = 0.5 * self.power * math.exp(-self.slope * (0.5 * (first + second) - 313.0))
        through = self.conductance * (first - second)
        return half - through, half + through


@pytest.mark.parametrize(("first", "second"), [(2.0, 20.0), (0.0, 50.0), (333.0, 5.0), (1e3, 1e3)])
def test_both_bodies_pass_on_the_heat_that_enters(first, second):
    film = Film(10.0, 0.04)
    warm = balanced(contact(first, second), film)
    if first == 333.0:  # stated, not a resistance
        assert warm[0] == first
        first = None
    for temperature, heat, one in zip(warm, film(*warm), (first, second), strict=True):
        if one is not None:
            assert temperature - 313.0 == pytest.approx(one * heat, rel=1e-6)
    assert film.calls <= 14


def test_bodies_without_resistance_take_one_film_at_the_temperature_of_the_oil():
    for small in (0.0, 1e-9):
        film = Film(10.0, 0.04)
        assert balanced(contact(small, small), film) == (313.0, 313.0)
        assert film.calls == 1


def test_heat_that_outruns_the_cooling_is_a_runaway():
    # friction that rises with the temperature, as where asperities take over
    with pytest.raises(NotBalancedError, match=r"runaway: .* beyond 800 K") as caught:
        balanced(contact(5.0, 5.0), Film(10.0, -0.05))
    assert caught.value.cause == "thermal_runaway"
    with pytest.raises(NotBalancedError, match="no film was found on the way") as caught:
        balanced(contact(1e3, 1e3), lambda one, _: (5.0, 5.0) if one < 330 else None)
    assert caught.value.cause == "thermal_runaway"


def test_a_step_without_a_film_is_halved_and_a_balance_that_never_settles_fails():
    film = Film(10.0, 0.04)
    found = balanced(contact(8.0, 8.0), lambda *at: film(*at) if at[0] < 339.5 else None)
    assert found == pytest.approx(balanced(contact(8.0, 8.0), film), rel=1e-6)
    noise = iter(np.tile([4.0, 5.0], 50))
    with pytest.raises(NotBalancedError, match="After 20 steps") as caught:
        balanced(contact(1.0, 1.0), lambda *_: (next(noise),) * 2)
    assert caught.value.cause == "bodies_not_balanced"
