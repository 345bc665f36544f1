"""Surfaces that remember their heat in time."""

import numpy as np
import pytest

from tehl.estimate.ways import Way, steady_way
from tehl.operators.carrying import Carrier
from tehl.operators.line_source import history
from tehl.operators.stream_source import StreamSource
from tehl.operators.trail import Trail, TurningTrail, VaryingTrail, lag_of

NODES, ROWS = 65, 8


@pytest.mark.parametrize(("steps", "first"), [(0.0, 0), (0.7, 0), (1.0, 0), (2.0, 0), (3.3, 2)])
def test_a_lag_finds_parabolas_exactly(steps, first):
    lag = lag_of(steps, first)
    ago = np.arange(3.0) + first
    weights = np.array([lag.now, lag.before, lag.older])
    for power in range(3):
        assert weights @ ago**power == pytest.approx(steps**power, abs=1e-12)


@pytest.mark.parametrize("lag", [0.6, 1.0, 1.5, 2.0])
def test_a_steady_flux_leaves_the_steady_rise(lag):
    x = np.linspace(0.0, 1.0, NODES)
    flux = np.repeat(np.sin(np.pi * x)[:, None] ** 2, ROWS, axis=1)
    trail = Trail(flux, x[1], lag)
    first = trail.past.copy()
    for _ in range(5):
        trail.update(flux)
        trail.advance()
    np.testing.assert_allclose(trail.past, first, rtol=0, atol=1e-12)


@pytest.mark.parametrize("lag", [0.6, 1.0, 1.5, 2.0])
def test_a_flux_that_grows_in_time_reaches_a_point_with_the_delay_of_the_way(lag):
    """Of q = x^2 (1 + g t): 16/15 x^(5/2) (1 + g t) - 16/105 g x^(7/2) / u."""
    spacing, growth = 1.0 / (NODES - 1), 0.8
    x = spacing * np.arange(NODES)[:, None]
    step = spacing / lag  # of time, at the speed u = 1 of the surface

    def flux(time: float) -> np.ndarray:
        return np.repeat(x**2 * (1.0 + growth * time), ROWS, axis=1)

    trail = Trail(flux(0.0), spacing, lag)
    steps = int(1.2 / step)  # before time zero the flux was constant: until that has left
    for number in range(1, steps + 1):
        trail.update(flux(number * step))
        if number < steps:
            trail.advance()
    end = steps * step
    rise = trail.past + history(NODES, spacing).near * flux(end)
    delay = 16.0 / 105.0 * growth * x**3.5
    exact = 16.0 / 15.0 * x**2.5 * (1.0 + growth * end) - delay
    assert delay[-1] > 0.05 * exact[-1]
    np.testing.assert_allclose(rise, np.repeat(exact, ROWS, 1), rtol=0, atol=5e-4)


@pytest.mark.parametrize("moved", [0.6, 1.0, 2.3])
def test_a_surface_of_varying_speed_begins_with_the_steady_rise(moved):
    """A step that moves it as before changes nothing, and the rise is that of the march along x."""
    x = np.linspace(0.0, 1.0, NODES)
    flux = np.repeat(np.sin(np.pi * x)[:, None] ** 4, ROWS, axis=1)
    trail = VaryingTrail(flux, moved * x[1], (x[1], moved * x[1]), (30, 12))
    first = trail.past.copy()
    for _ in range(3):
        trail.move(Way(moved * x[1]))
        np.testing.assert_allclose(trail.update(flux), first, rtol=0, atol=1e-12)
        trail.advance()
    steady = Trail(flux, x[1], 1.0)
    rise = steady.past + steady.near * flux
    np.testing.assert_allclose(first + trail.near * flux, rise, rtol=0, atol=2e-3 * rise.max())


def test_heat_moves_with_a_surface_forwards_and_backwards():
    """Exponentials of a row of nodes by plain numpy, forwards, at rest and backwards."""
    rng = np.random.default_rng(1)
    flux = np.abs(rng.normal(size=(NODES, ROWS)))
    trail = VaryingTrail(flux, 0.05, (1.0, 0.75), (30, 12))
    trail.update(flux)
    trail.advance()
    _, decay, older, newer = trail.weights
    nodes = np.arange(trail.line.size)
    for moved in (0.75, 0.5, 0.0, -0.25, -1.5, 1.0):
        now, before = trail.fluxes[1, 0], trail.fluxes[2, 0]
        taken = older[:, None, None] * before + newer[:, None, None] * now
        modes = decay[:, None, None] * trail.modes[1] + taken

        def there(field: np.ndarray, moved: float = moved) -> np.ndarray:
            whole = np.floor(nodes - moved).astype(int)
            part = nodes - moved - whole
            found = 0.0
            for k in range(-1, 3):  # Lagrange's cubics
                others = [one for one in range(-1, 3) if one != k]
                weight = np.prod([(part - one) / (k - one) for one in others], axis=0)
                found = found + weight * field[..., np.clip(whole + k, 0, nodes[-1])]
            return found

        wanted = trail.weights.next_ * there(now) + there(modes).sum(axis=0)
        trail.move(Way(moved))
        np.testing.assert_allclose(trail.past, wanted[:, trail.inside].T, rtol=1e-12)
        trail.update(flux)
        trail.advance()


def spot(x: np.ndarray, y: np.ndarray, place: tuple[float, float]) -> np.ndarray:
    """Return a flux of a spot around a place, (nx, ny)."""
    along, across = place
    return np.exp(-(((x[:, None] - along) / 0.3) ** 2) - ((y[None] - across) / 0.3) ** 2)


def test_a_surface_that_turns_keeps_its_heat_wherever_it_goes():
    """A spot of the surface takes up a constant flux on its circle, and on a way back and aside."""
    x, y, step = np.linspace(-2.0, 2.0, 97), np.linspace(-2.0, 2.0, 81), 0.02
    trail = TurningTrail(np.zeros((97, 81)), Carrier(x, y), step, Way(0.0), (60, 1))
    place, turn = np.array([-0.5, 0.3]), Way(0.0)
    for number in range(60):
        way = steady_way((1.0 - 0.05 * number, 0.4), 0.5, step)
        trail.move(way)
        turn = way.after(turn)
        cosine, sine = np.cos(way.turn), np.sin(way.turn)
        place = np.array([[cosine, -sine], [sine, cosine]]) @ place + way[:2]
        flux = spot(x, y, tuple(place))
        past = trail.update(flux)
        trail.advance()
    time = 60 * step
    rise = 4.0 / 3.0 * (time**1.5 - (time - step) ** 1.5) / step
    wanted = rise * spot(x, y, tuple(place))
    np.testing.assert_allclose(past + trail.near * flux, wanted, rtol=0, atol=2e-3 * wanted.max())
    begun = turn.back(*place)
    np.testing.assert_allclose(begun, (-0.5, 0.3), atol=1e-12)


@pytest.mark.parametrize("motion", [((1.0, 0.6), 0.0), ((0.8, 0.0), 0.4), ((1.2, -0.3), -0.5)])
def test_a_surface_that_turns_begins_with_the_steady_rise(motion):
    """Steps that move it as before change it by what they interpolate, and it is the known one."""
    x, y = np.linspace(-1.5, 2.0, 97), np.linspace(-2.0, 2.0, 111)
    (u, v), spin = motion
    flux, way = spot(x, y, (-0.2, 0.1)), steady_way((u, v), spin, x[1] - x[0])
    trail = TurningTrail(flux, Carrier(x, y), x[1] - x[0], way, (30, 300))
    first = trail.past + trail.near * flux
    for _ in range(40):
        trail.move(way)
        last = trail.update(flux) + trail.near * flux
        trail.advance()
    inside = slice(-4), np.abs(y) < 1.5  # at the edges it leaves they interpolate less well
    np.testing.assert_allclose(last[inside], first[inside], rtol=0, atol=1e-3 * first.max())
    steady = StreamSource(x, y, 1.0 / np.sqrt(u), v / u, spin / u).rise(flux)
    np.testing.assert_allclose(first[inside], steady[inside], atol=3e-3 * steady.max())
