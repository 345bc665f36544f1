"""Estimated iteration errors of damped cycles, error bars between rough surfaces, damping."""

from dataclasses import replace
from functools import partial
from unittest.mock import Mock

import numpy as np
import pytest

from tehl.contact.options import Options
from tehl.kernels.properties import Factors, Heated
from tehl.result.solution import CycleReport
from tehl.solver.cycle.iteration import GridIteration
from tehl.solver.cycle.relaxation import STEEP, THIN, Relaxation
from tehl.solver.judging.convergence import (
    LEAST_CONVERGENCE_RATE,
    LEAST_CYCLES,
    LEAST_KELVIN,
    SECOND_RATE,
    Criteria,
    GridTrace,
    converged,
    film_converged,
    recedes,
    touching_converged,
)
from tehl.solver.judging.film_errors import MOST_EXPECTED, comparable
from tehl.solver.judging.grid_errors import (
    AGREED,
    AGREED_ON_TWO,
    COMBINED,
    GROWTH_AT_SIDES,
    LEAST_CENTRAL,
    LEAST_MINIMUM,
    LEAST_OF_SCARCE,
    LINE_MINIMUM,
    PART_AT_ENDS,
    PART_AT_SIDES,
    THIRD_CHANGE,
    THIRD_PART,
    FilmTraits,
    error_estimate,
    extrapolated_bars,
)
from tehl.solver.judging.measures import _bend, _nodes_across
from tehl.solver.judging.value_errors import (
    HEAT_OF_ROLLING,
    UNEVEN,
    UNRESOLVED_STRESS,
    further_errors,
)
from tehl.solver.physics.lag import LARGEST_LOG_STEP, Lag, damped


@pytest.mark.parametrize("damping", [0.3, 0.5])
def test_the_iteration_error_of_a_damped_cycle_is_not_underestimated(damping: float) -> None:
    """The film changes by a constant part of its error per cycle."""
    trace, left = GridTrace(Criteria(damping=damping)), [1.0]
    for _ in range(6):
        trace.central.values.append(0.3 + left[-1])
        left.append((1.0 - damping) * left[-1])
        if len(trace.central.values) > 1:
            assert trace.central.iteration_error() >= 0.999 * left[-2]


def test_a_small_change_between_large_ones_does_not_hide_what_is_left() -> None:
    """A minimum film (M = 21,000), after 30 cycles 7.161: of it 0.3 was seen after cycle 5."""
    films = (7.339, 7.309, 7.264, 7.243, 7.211, 7.203, 7.180, 7.180, 7.167, 7.169, 7.163)
    trace = GridTrace(Criteria(damping=0.5, rate=STEEP.rate))
    for number, film in enumerate(films):
        trace.note(1.0, film)
        if number > 2:
            assert trace.minimum.iteration_error() > 0.5 * (film - 7.161)


def test_a_swinging_film_that_hardly_changes_once_has_its_way_to_go() -> None:
    """A heated line (240 K): over four cycles each it changes by 0.48 and 0.22 %."""
    films = (15.4337, 15.4313, 15.4059, 15.3909, 15.3595, 15.3537, 15.3436, 15.3268, 15.3263)
    trace = GridTrace(Criteria(rate=STEEP.rate))
    for film in films:
        trace.note(film, 1.0)
    assert trace.central.iteration_error() > 0.025


def test_a_damping_factor_of_one_changes_nothing() -> None:
    trace = GridTrace(Criteria(damping=1.0))
    assert (trace.criteria.least_cycles, trace.central.least_rate) == (
        LEAST_CYCLES,
        LEAST_CONVERGENCE_RATE,
    )


@pytest.mark.parametrize(("single", "share", "ends"), [(0.9, 0.41, True), (0.9, 0.46, False)])
def test_the_share_of_contact_and_not_single_nodes_ends_cycles_where_surfaces_touch(
    single: float, share: float, ends: bool
) -> None:
    """It has changed by 0.2 from the coarser grid: a ninth of that may be left."""
    coarse, fine = GridTrace(), GridTrace(Criteria(steady=1e-3, largest_change=0.01))
    for trace, shares in ((coarse, (0.6, 0.6)), (fine, (0.42, share))):
        for cycle, touching in enumerate(shares, start=1):
            trace.add(report(cycle, 10.0**-cycle), touching)
    last = replace(fine.reports[-1], change=single, mean_change=5e-3)
    fine.reports[-1] = last
    assert film_converged(fine, coarse) == ends
    fine.reports[-1] = replace(last, mean_change=0.02)
    assert not film_converged(fine, coarse)


def test_a_film_that_meets_the_same_heat_again_has_not_converged_for_that() -> None:
    """A line at 50 K: 1.37 % off, it changed by 1e-5 in the cycle after a sweep was skipped."""
    trace = GridTrace()
    trace.note(0.1710, 0.1460)
    for film, rests in ((0.1703, False), (0.1697, False), (0.1692, True), (0.16919, False)):
        trace.add(replace(report(1, 1e-4), film_central=film), rests=rests)
    assert trace.central.values == [0.1710, 0.1703, 0.1697, 0.16919]
    assert trace.central.iteration_error() > 0.002
    assert len(trace.reports) == 4
    assert len(trace.rise.values) == 3  # the skipped sweep left it as it was


def test_a_share_that_creeps_while_single_nodes_come_and_go_has_its_way_to_go() -> None:
    """A part of 0.96 is left after each cycle; each second one hardly changes it."""
    trace = GridTrace()
    trace.touching.values = [1.0 - 0.96 ** (2 * (cycle // 2)) for cycle in range(26)]
    left = 1.0 - trace.touching.values[-1]
    assert trace.touching.iteration_error() == 0.0
    assert trace.touching.creep(4) == pytest.approx(left, rel=0.3)
    trace.touching.values[-5:] = [0.5, 0.6, 0.5, 0.6, 0.5]
    assert trace.touching.creep(4) == 0.0


@pytest.mark.parametrize(("share", "ends"), [(0.4201, False), (0.461, True)])
def test_a_share_that_oscillates_has_not_converged_where_it_hardly_changes_once(
    share: float, ends: bool
) -> None:
    coarse, fine = GridTrace(), GridTrace()
    coarse.touching.values = [0.6]
    fine.touching.values = [0.5, 0.46, share + 0.0001, share]
    assert touching_converged(fine, coarse) is ends


@pytest.mark.parametrize(("swing", "ends"), [(0.004, True), (0.02, False)])
def test_a_share_that_swings_about_its_limit_errs_by_its_swing_at_most(
    swing: float, ends: bool
) -> None:
    """Single nodes that come and go leave it as it is: changes that alternate do not add up."""
    coarse, fine = GridTrace(), GridTrace()
    coarse.touching.values = [0.19]
    fine.touching.values = [0.04 + swing * (-1) ** cycle * (1 - 0.01 * cycle) for cycle in range(9)]
    assert fine.touching.iteration_error() > 4.0 * swing
    assert touching_converged(fine, coarse) is ends


@pytest.mark.parametrize(("coarse", "bar"), [(0.010, 0.35), (0.0, 0.70), (-0.020, 2.0)])
def test_the_bar_of_a_rough_minimum_far_from_its_limit_is_its_whole_change(
    coarse: float, bar: float
) -> None:
    """Near the limit it is seven tenths of the change between two grids that have the heights."""
    traces = [GridTrace(), GridTrace()]
    for trace, minimum in zip(traces, (coarse, 0.020), strict=True):
        trace.note(0.1, minimum)
    estimate = error_estimate(traces, FilmTraits(order=2, rough=True))
    assert estimate.discretisation_minimum == pytest.approx(bar)
    assert estimate.discretisation_central == 0.0


def test_two_grids_that_agree_by_chance_have_the_bar_of_their_mesh() -> None:
    """A starved bearing (M = 1254): minima on 129 and 257 nodes are both 2 % above their limit."""
    traces = [GridTrace(), GridTrace(), GridTrace()]
    films = zip((1.0084, 1.0013, 1.0002), (1.0098, 1.0206, 1.0218), strict=True)
    for trace, (central, minimum) in zip(traces, films, strict=True):
        trace.note(central, minimum)
        trace.note(central, minimum)
    assert error_estimate(traces, FilmTraits(order=3)).discretisation_minimum < 0.002
    estimate = error_estimate(traces, FilmTraits(order=3, least=0.03))
    assert estimate.discretisation_minimum == pytest.approx(LEAST_MINIMUM * 0.03)
    assert estimate.discretisation_central == pytest.approx(LEAST_CENTRAL * 0.03)


def test_an_isothermal_film_makes_no_bar_of_heated_ones() -> None:
    """A heated roller (M = 13): 0.0924 on 65 nodes without heat would make a bar of 2.1 %."""
    traces = [GridTrace(coupled=heated) for heated in (False, True, True)]
    for trace, film in zip(traces, (0.0924, 0.0719, 0.0721), strict=True):
        trace.note(film, film)
    assert error_estimate(traces, FilmTraits(order=3)).discretisation_central > 0.02
    assert comparable(traces) == traces[1:]
    assert error_estimate(comparable(traces), FilmTraits(order=3)).discretisation_central < 0.002
    traces[0].coupled = True
    assert comparable(traces) == traces
    traces[1].diverged = True
    assert comparable(traces) == [traces[0], traces[2]]


def test_grids_of_a_piece_that_differ_in_their_lines_alone_make_no_bar() -> None:
    traces = [GridTrace(columns=columns) for columns in (65, 65, 129)]
    assert comparable(traces[:2], goes_on=True) == traces[1:2]
    assert comparable(traces, goes_on=True) == traces[1:]
    assert comparable(traces) == traces  # at the ends of a roller films change along y
    traces[0].columns = 33
    assert comparable(traces, goes_on=True) == traces


@pytest.mark.parametrize(
    ("change", "bar"),
    [(0.02, MOST_EXPECTED * 0.006), (0.04, THIRD_CHANGE * 0.04), (0.06, THIRD_PART * 0.06)],
)
def test_a_film_of_third_order_has_little_more_than_the_bar_to_expect(
    change: float, bar: float
) -> None:
    """A bearing (M = 601) changes by 2 % from 81 to 161 nodes, and by 0.04 % from there on."""
    traces = [GridTrace(), GridTrace()]
    for trace, film in zip(traces, (1.0 + change, 1.0), strict=True):
        trace.note(film, film)
        trace.note(film, film)
    estimate = error_estimate(traces, FilmTraits(order=3, least=0.006, most=MOST_EXPECTED * 0.006))
    assert estimate.discretisation_central == pytest.approx(bar)
    assert estimate.discretisation_minimum == pytest.approx(bar)


def test_the_minimum_of_a_roller_has_the_bar_of_films_between_its_nodes() -> None:
    """A lundberg profile (M = 50) on 257 to 1025 nodes: that of the last grid is within 0.5 %."""
    traces = [GridTrace(), GridTrace(), GridTrace()]
    nodal, between = (2.227e-3, 2.329e-3, 2.230e-3), (2.214e-3, 2.267e-3, 2.230e-3)
    for trace, film in zip(traces, nodal, strict=True):
        trace.note(0.0297, film)
        trace.note(0.0297, film)
    traits = FilmTraits(order=3, kind="roller")
    bar = LINE_MINIMUM * THIRD_PART * (2.329 / 2.230 - 1.0)
    assert error_estimate(traces, traits).discretisation_minimum == pytest.approx(bar)
    for trace, film in zip(traces, between, strict=True):
        trace.measured = {"film_central": 0.0297, "film_minimum": film, "pressure_max": 1.0}
        trace.measured |= {"spike": 0.5, "excess": 0.01}
    change = 2.267 / 2.230 - 1.0
    assert error_estimate(traces, traits).discretisation_minimum == pytest.approx(change)
    traits = replace(traits, crowded=True)
    part = PART_AT_ENDS * change
    assert error_estimate(traces, traits).discretisation_minimum == pytest.approx(part)
    assert error_estimate(traces[1:], traits).discretisation_minimum == pytest.approx(change)
    traces[1].measured["film_minimum"] = 2.25e-3  # a change of less than a percent
    bar = LINE_MINIMUM * THIRD_PART * (2.25 / 2.230 - 1.0)
    assert error_estimate(traces, traits).discretisation_minimum == pytest.approx(bar)


@pytest.mark.parametrize(
    ("growth", "bar"),
    [(0.05, PART_AT_SIDES * 0.05), (0.15, THIRD_PART * 0.15), (-0.06, THIRD_PART * 0.06)],
)
def test_a_film_that_grows_at_the_sides_is_extrapolated_from_two_grids(
    growth: float, bar: float
) -> None:
    """A rig (M = 14,420): its minimum grows by 5.4 % to 641 x 1281 nodes, and by 1.8 % then."""
    traces = [GridTrace(), GridTrace()]
    for trace, film in zip(traces, (1.0 - growth, 1.0), strict=True):
        trace.note(film, film)
        trace.note(film, film)
        trace.measured = {"film_central": film, "film_minimum": film, "pressure_max": 1.0}
        trace.measured |= {"spike": 0.5, "excess": 0.01}
        trace.outputs = Mock()
    found = error_estimate(traces, FilmTraits(order=3, thinnest="sides"), extrapolate=True)
    assert found.extrapolated == (0.0 < growth < GROWTH_AT_SIDES)
    assert found.discretisation_minimum == pytest.approx(bar)


def test_a_central_film_of_scarce_oil_may_shrink_while_that_at_the_sides_grows() -> None:
    """A rig (M = 3,960): 2.480 and 2.466 in the middle, 0.960 and 0.980 at the sides."""
    traces = [GridTrace(), GridTrace()]
    for trace, central, minimum in zip(traces, (2.480, 2.466), (0.960, 0.980), strict=True):
        trace.note(central, minimum)
        trace.note(central, minimum)
        trace.measured = {"film_central": central, "film_minimum": minimum, "pressure_max": 1.0}
        trace.measured |= {"spike": 0.5, "excess": 0.01}
        trace.outputs = Mock()
    at_sides = FilmTraits(order=3, thinnest="sides")
    assert not error_estimate(traces, at_sides, extrapolate=True).extrapolated
    found = error_estimate(traces, replace(at_sides, scarce=True), extrapolate=True)
    alone = error_estimate(traces, FilmTraits(order=3, scarce=True))
    assert found.extrapolated
    assert found.discretisation_minimum == pytest.approx(PART_AT_SIDES * 0.020 / 0.980)
    added = found.discretisation_central - alone.discretisation_central
    assert added == pytest.approx(0.014 / 2.466 / 3.0)


def test_a_minimum_at_the_exit_is_not_extrapolated_by_an_order_shown_by_chance() -> None:
    """An outer ring (M = 17,100): 7.665 on 321 x 321 nodes, 7.653 on 641 x 641."""
    traces = [GridTrace(), GridTrace(), GridTrace()]
    for trace, film in zip(traces, (6.637, 7.454, 7.665), strict=True):
        trace.note(film, film)
        trace.note(film, film)
        trace.measured = {"film_central": film, "film_minimum": film, "pressure_max": 1.0}
        trace.measured |= {"spike": 0.5, "excess": 0.01}
        trace.outputs = Mock()
    off = 7.665 + (7.665 - 7.454) / 3.0 - 7.653  # of the extrapolated film
    assert extrapolated_bars(traces, 3, 0.005)[COMBINED[1]] < off / 7.653
    most = MOST_EXPECTED * 0.005
    traits = FilmTraits(order=3, least=0.005, most=most, thinnest="exit")
    found = error_estimate(traces, traits, extrapolate=True)
    assert not found.extrapolated
    assert found.discretisation_minimum > 7.665 / 7.653 - 1.0


@pytest.mark.parametrize(
    ("films", "bar"),
    [
        ((1.0001, 1.0, 1.0), LEAST_OF_SCARCE),
        ((1.02, 1.002, 1.0), AGREED[0] * 0.018 + AGREED[1] * 0.002),
        ((1.078, 1.008, 1.0), LEAST_MINIMUM * 0.02),
        ((1.002, 1.0), AGREED_ON_TWO * 0.002),
        ((1.01, 1.0), LEAST_MINIMUM * 0.02),
    ],
)
def test_films_of_scarce_oil_that_agree_need_no_bar_to_expect(
    films: tuple[float, ...], bar: float
) -> None:
    """A rig between asperities (M = 23,200): 1.457, 1.453 and 1.453 on 193 to 769 nodes."""
    traces = [GridTrace() for _ in films]
    for trace, film in zip(traces, films, strict=True):
        trace.note(film, film)
        trace.note(film, film)
    found = error_estimate(traces, FilmTraits(order=3, least=0.02, scarce=True))
    assert found.discretisation_minimum == pytest.approx(bar)
    flooded = error_estimate(traces, FilmTraits(order=3, least=0.02))
    assert flooded.discretisation_minimum == pytest.approx(LEAST_MINIMUM * 0.02)


def factors(*values: float) -> Factors:
    """Return factors of one node: rest, mobility, density and stretches; the film counts whole."""
    return Factors(*(np.array([value]) for value in (*values, 1.0, 0.0)))


def test_damped_factors_converge_to_the_new_ones() -> None:
    """Damped in their logarithms, the whole mobility at the pressure of the new sweep."""
    old, new = factors(0.0, 1.0, 1.0, 1.0, 2.0), factors(0.5, 1.0, 0.9, 1.2, 2.0)
    mobility = np.array([0.5])
    half = damped(old, new, mobility, 0.5)
    assert half.rest + half.mobility * mobility == pytest.approx(0.5**0.5)
    np.testing.assert_allclose(np.ravel(half[2:]), [0.9**0.5, 1.2**0.5, 2.0, 1.0, 0.0])
    for _ in range(60):
        old = damped(old, new, mobility, 0.3)
    np.testing.assert_allclose(np.ravel(old), np.ravel(new), rtol=1e-8)


def test_a_film_behind_its_heat_is_driven_by_a_part_of_the_slope_until_it_has_caught_up() -> None:
    """Of a flow as the cube of the slope, that part at which the oil flows as the film does."""
    new = factors(0.0, 1.2, 1.0, 3.0, 1.0)
    old, lag = new._replace(mobility=np.array([1.0])), Lag(0.5, heats=True)
    old, ones = lag.damped(old, new, np.ones(1)), np.ones(1)
    assert lag.part is not None
    assert lag.part**3 == pytest.approx(old.mobility / new.mobility)
    heated = Heated(new.mobility * lag.part**2, ones, ones, new.stretch_x, new.stretch_y)
    lag.complete(heated)
    assert heated.mobility == pytest.approx(new.mobility)
    for _ in range(40):
        old = lag.damped(old, new, ones)
    assert lag.part == pytest.approx(1.0, abs=1e-9)


def test_a_sweep_changes_the_factors_by_a_limited_step() -> None:
    """The gradient of a pressure not in balance may ask for 1e9 times the mobility."""
    old, new = factors(0.0, 1.0, 1.0, 1.0, 1.0), factors(3e8, 1e9, 1.0, 20.0, 0.1)
    step = damped(old, new, np.array([1.0]), 1.0)
    assert step.rest + step.mobility == pytest.approx(np.exp(LARGEST_LOG_STEP))
    assert step.stretch_x == pytest.approx(np.exp(LARGEST_LOG_STEP))
    assert step.stretch_y == pytest.approx(np.exp(-LARGEST_LOG_STEP))


def test_the_heat_of_a_surface_has_half_the_error_of_the_heat_that_it_is_part_of() -> None:
    """Its own change between two grids may be small by chance."""
    traces = [GridTrace(), GridTrace(), GridTrace()]
    values = zip((1.00, 1.04, 1.05), (0.500, 0.499, 0.4991), strict=True)
    for trace, (shear, surface) in zip(traces, values, strict=True):
        trace.measured = {"heat_shear": shear, "heat_surface_1": surface}
        trace.measured["film_rise_max"] = 100.0
    bars = further_errors(traces, 1.0, 0.0, sliding=1.0)
    assert bars["heat_shear"] == pytest.approx(UNEVEN * 0.01 / 1.05)
    assert bars["heat_surface_1"] == pytest.approx(0.5 * UNEVEN * 0.01 / 0.4991)
    assert further_errors(traces, 1.0, 0.0, film=0.03)["heat_shear"] == 0.03
    assert further_errors(traces, 1.0, 0.0)["heat_shear"] == HEAT_OF_ROLLING
    for trace in traces:  # cycles end at temperatures that change by as much
        trace.measured["film_rise_max"] = LEAST_KELVIN
    bars = further_errors(traces, 1.0, 0.0, sliding=1.0)
    assert bars["heat_surface_1"] == pytest.approx(0.5 * 1.05 / 0.4991)


def spiky(rows: dict[str, tuple[float, float]]) -> list[GridTrace]:
    """Return two grids with a spike that the finer one has more of, and with values of both."""
    traces = [GridTrace(), GridTrace()]
    spike = {"pressure_max": (0.9559, 0.9562), "spike": (0.785, 0.806), "excess": (0.123, 0.155)}
    for number, trace in enumerate(traces):
        trace.measured = {name: values[number] for name, values in (spike | rows).items()}
        trace.note(0.1, 0.1)
        trace.note(0.1, 0.1)
    return traces


def test_a_stress_that_follows_an_unresolved_spike_may_change_by_several_times_its_change() -> None:
    """A gear tooth (M = 137): 8.599 and 8.478 per mille, 8.359 and 8.228 on finer grids."""
    measured = {"traction_mid_film": (-8.599e-3, -8.478e-3)}
    found = error_estimate(spiky(measured), FilmTraits(order=2))
    assert not found.spike_resolved
    assert 0.04 < found.bars["traction_mid_film"] < 0.08


def test_heat_that_rolling_generates_below_an_unresolved_spike_is_hardly_known() -> None:
    """An ellipse (M = 271): 9 % more on a finer grid, and half of that in either surface."""
    measured = {"heat_shear": (1.0, 1.001), "heat_surface_1": (0.5, 0.5), "film_rise_max": (9, 9)}
    found = error_estimate(spiky(measured), FilmTraits(order=2))
    assert found.bars["heat_shear"] == pytest.approx(UNRESOLVED_STRESS * HEAT_OF_ROLLING)
    assert found.bars["heat_surface_1"] == pytest.approx(found.bars["heat_shear"], rel=0.01)


def test_a_largest_pressure_of_few_nodes_is_uncertain_though_two_grids_agree() -> None:
    """A circle (M = 5, L = 6): 0.8667 and 0.8672 on 41 and 81 nodes, 0.877 on 641."""
    low = {"spike": (0.01, 0.016), "excess": (0.01, 0.016)}
    agreeing = low | {"pressure_max": (0.8667, 0.8672), "bend": (0.2, 0.109)}
    found = error_estimate(spiky(agreeing), FilmTraits(order=2))
    assert 0.01 < found.bars["pressure_max"] < 0.04
    assert _bend(np.array([[0.1, 0.2, 0.1], [0.5, 0.9, 0.7], [0.4, 0.8, 0.1]])) == pytest.approx(
        0.8
    )
    assert _bend(np.array([[0.1, 0.2, 0.1]])) == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("row", "nodes"),
    [([0, 0, 4, 0], 1), ([1, 2, 4, 3, 2], 4), ([4, 3, 1, 3], 2), ([3, 1, 2, 4], 2), ([4, 4], 2)],
)
def test_a_spike_is_as_wide_as_the_nodes_with_half_of_its_excess(
    row: list[float], nodes: int
) -> None:
    assert _nodes_across(np.array([[0.0] * len(row), row])) == nodes


@pytest.mark.parametrize(("narrow", "resolved"), [(0.0, True), (0.155, False)])
def test_a_spike_of_few_nodes_may_become_the_largest_pressure(
    narrow: float, resolved: bool
) -> None:
    """A line (L = 11): 0.86 and 0.84 p_h beside 0.982 on 129 and 257 nodes, 1.11 on 4097."""
    rows = {"spike": (0.835, 0.83), "excess": (0.155, 0.155), "narrow": (narrow, narrow)}
    assert error_estimate(spiky(rows), FilmTraits(order=2)).spike_resolved is resolved


@pytest.mark.parametrize(("sliding", "least", "most"), [(0.0, 1.0, 1.0), (0.095, 0.3, 0.6)])
def test_oil_hotter_than_the_surfaces_may_be_hotter_still_in_an_unresolved_spike(
    sliding: float, least: float, most: float
) -> None:
    """A gear tooth (M = 201): 4.07 K on two grids, 4.40 and 4.76 K on finer ones."""
    rises = {"film_rise_max": (4.069, 4.067), "surface_1_rise_max": (1.745, 1.743)}
    friction = {"traction_mid_film": (-8.6e-3, -8.6e-3)} if sliding else {}
    found = error_estimate(spiky(rises | friction), FilmTraits(order=2, sliding=sliding))
    assert least <= found.bars["film_rise_max"] <= most


@pytest.mark.parametrize(("sliding", "least", "most"), [(0.015, 0.5, 0.9), (1.0, 0.05, 0.2)])
def test_oil_may_be_hotter_in_a_low_spike_of_few_nodes(
    sliding: float, least: float, most: float
) -> None:
    """An inner ring (M = 3,500) that rolls: 3.66 and 3.81 K, 5.8 K on a finer grid."""
    spike = {"spike": (0.532, 0.541), "excess": (0.115, 0.163), "narrow": (0.115, 0.163)}
    rises = {"film_rise_max": (3.658, 3.815), "surface_1_rise_max": (2.106, 2.094)}
    friction = {"traction_mid_film": (-4.53e-2, -4.54e-2), "pressure_max": (0.9938, 0.9935)}
    found = error_estimate(spiky(spike | rises | friction), FilmTraits(order=2, sliding=sliding))
    assert found.spike_resolved
    assert least <= found.bars["film_rise_max"] <= most


def test_heat_that_sliding_generates_is_hardly_better_known_than_traction() -> None:
    """Ten elevenths of its error at a slide-to-roll ratio of 1."""
    measured = {"traction_mid_film": (-0.0109, -0.01), "heat_shear": (1.0, 1.0)}
    rolls, slides = (further_errors(spiky(measured), 1.0, 0.0, sliding=s) for s in (0.001, 1.0))
    assert slides["heat_shear"] == pytest.approx(slides["traction_mid_film"] / 1.1)
    assert rolls["heat_shear"] == pytest.approx(HEAT_OF_ROLLING / 1.01)


@pytest.mark.parametrize(
    ("ratio", "cycles", "ends"), [(0.9, 2, False), (0.9, 8, True), (0.3, 2, True)]
)
def test_cycles_whose_residual_hardly_falls_go_on(ratio: float, cycles: int, ends: bool) -> None:
    coarse, fine = GridTrace(), GridTrace()
    coarse.note(0.100, 0.050)
    fine.note(0.101, 0.051)
    for number in range(1, cycles + 1):
        fine.add(
            CycleReport(
                points=(65, 65),
                cycle=number,
                residual=1e-4 * ratio**number,
                change=1e-3,
                load_error=0.0,
                film_central=0.101,
                film_minimum=0.051,
                smoother="robust",
            )
        )
    assert film_converged(fine, coarse) is ends


@pytest.mark.parametrize(("swing", "kept"), [(1.0, True), (100.0, False)])
def test_a_film_that_rests_while_its_residual_grows_is_kept_with_a_larger_error(
    swing: float, kept: bool
) -> None:
    """Single nodes may grow where the film has been found (an ellipse with spin, M = 258)."""
    coarse, fine = GridTrace(), GridTrace()
    coarse.note(0.1, 0.05)
    for number in range(1, 6):
        grown = replace(report(number, 1e-6 * 1.5**number), film_central=0.1, change=1e-3)
        fine.add(replace(grown, film_minimum=0.05 * (1.0 + swing * 0.1**number)))
    run = Mock(traces=[coarse, fine], options=Options(), strategy=Mock(gives_up=True, patience=1))
    run.roughness.spare.return_value = run._negligible.return_value = 4e-3
    run._coarser_trace.return_value = coarse
    run._accept = partial(GridIteration._accept, run)
    assert GridIteration._is_done(run, fine, finest=True)
    assert converged(run.traces[-1], coarse, run.options) is kept
    larger = run.traces[-1].minimum.iteration_error() / fine.minimum.iteration_error()
    assert larger == pytest.approx(120.0 if kept else 1.0)


@pytest.mark.parametrize(
    ("residuals", "found"),
    [
        ((1e-4, 5e-5, 7e-5, 1e-4), True),
        ((6e-6, 2e-6, 4e-6, 1e-6, 3e-6), False),
        ((6e-4, 8e-4, 3e-4, 7e-4), False),
        ((6e-4, 8e-4, 3e-4, 7e-4, 5e-4, 8e-4), True),
        ((1.0, 2.0), False),
    ],
)
def test_cycles_recede_where_the_residual_grows_twice_in_succession_or_in_all(
    residuals: tuple[float, ...], found: bool
) -> None:
    trace = GridTrace()
    for number, residual in enumerate(residuals, 1):
        trace.add(report(number, residual))
    assert recedes(trace) is found


@pytest.mark.parametrize("gives_up", [True, False])
def test_a_strategy_that_gives_up_does_not_wait_until_the_oil_balances(gives_up: bool) -> None:
    trace = GridTrace()
    for number, residual in enumerate((1.0, 2.0, 3.0), 1):
        trace.add(report(number, residual))
    iteration = Mock(spec=GridIteration)
    iteration.strategy = Mock(patience=1, gives_up=gives_up)
    iteration.balance = Mock(is_settled=False)
    assert GridIteration._is_done(iteration, trace, finest=True) is gives_up
    assert not GridIteration._is_done(iteration, trace, finest=False)


@pytest.mark.parametrize(
    ("left", "least", "extrapolated"),
    [(1e-3, 0.008, True), (0.04, 0.008, False), (1e-3, 0.01, False)],
)
def test_a_first_grid_that_has_not_converged_or_is_too_coarse_shows_no_order(
    left: float, least: float, extrapolated: bool
) -> None:
    """``left`` is the iteration error of the minimum film on the first of three grids."""
    traces = [GridTrace(outputs=Mock()) for _ in range(3)]
    for trace, film in zip(traces, (0.92, 0.98, 0.995), strict=True):
        trace.measured = {"film_central": film, "film_minimum": film}
        trace.central.values += [film, film]
        trace.minimum.values += [film - left * 0.7 / 0.3, film]
        trace.reports.append(report(1, 1e-6))
    assert (extrapolated_bars(traces, 3, least) is not None) is extrapolated


def test_a_minimum_on_which_two_grids_agree_by_chance_keeps_its_bar() -> None:
    traces = [GridTrace(outputs=Mock()) for _ in range(3)]
    for trace, central, minimum in zip(
        traces, (0.92, 0.98, 0.995), (0.9, 0.99, 0.9905), strict=True
    ):
        trace.measured = {"film_central": central, "film_minimum": minimum}
        trace.central.values += [central, central]
        trace.minimum.values += [minimum, minimum]
        trace.reports.append(report(1, 1e-6))
    assert list(extrapolated_bars(traces, 3) or {}) == ["discretisation_central"]
    assert set(extrapolated_bars(traces, 2) or {}) == set(COMBINED)


def report(cycle: int, residual: float) -> CycleReport:
    """Return the report of a cycle, with nothing but a residual."""
    zeros = dict.fromkeys(("change", "load_error", "film_central", "film_minimum"), 0.0)
    return CycleReport(points=(33, 33), cycle=cycle, residual=residual, smoother="fast", **zeros)


@pytest.mark.parametrize("relaxation", [STEEP, THIN])
def test_small_steps_do_not_pass_for_convergence(relaxation: Relaxation) -> None:
    """A change that falls to a tenth may be followed by slow ones, which small steps hide."""
    trace = GridTrace(Criteria(rate=relaxation.rate))
    for film in (1.0, 1.1, 1.11):
        trace.note(film, film)
    assert trace.central.iteration_error() >= 0.01
    assert GridTrace().criteria.least_cycles <= trace.criteria.least_cycles


def test_the_rate_of_the_first_cycle_on_a_grid_is_not_that_of_the_next_ones() -> None:
    """It removes errors of the interpolated start: most of the second change is left."""
    trace = GridTrace(Criteria(second_rate=SECOND_RATE))
    for film in (1.0, 1.2, 1.21):
        trace.note(film, film)
    assert trace.central.iteration_error() > 0.008
    trace.note(1.211, 1.211)
    assert trace.central.iteration_error() < 0.001
