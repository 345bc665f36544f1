"""Domain and grid: proposed values, and invalid ones."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.contact.options import Domain, Options, coarsenable, coarsenings
from tehl.contact.problem import ContactProblem
from tehl.estimate.domain import (
    ENTRY_PART,
    INLET_HEAT_PART,
    LARGEST_DOMAIN_FACTOR,
    SLENDER,
    THINNER_PART,
    chosen_domain,
    far_field_error,
    recommended_domain,
    thinner_error,
)
from tehl.estimate.entering import entry_error, heat_across, warmed_upstream
from tehl.estimate.nodes import expected_points, planned
from tehl.estimate.scaling import ScaledProblem, groups
from tests.reference import heated_contact, moes_contact


@pytest.mark.parametrize(
    ("x", "y"),
    [
        ((-0.9, 1.5), (-3.0, 3.0)),
        ((-4.5, 1.0), (-3.0, 3.0)),
        ((-4.5, 1.5), (-3.0, 0.5)),
    ],
)
def test_a_domain_that_cuts_the_contact_is_rejected(x, y):
    with pytest.raises(InputError, match="cuts the contact"):
        Domain(x=x, y=y)


@pytest.mark.parametrize("edge", [float("nan"), float("inf")])
def test_an_infinite_domain_is_rejected(edge):
    with pytest.raises(InputError, match="two finite numbers"):
        Domain(x=(-4.5, edge), y=(-3.0, 3.0))


@pytest.mark.parametrize("points", [67, 130, 200, (129, 131)])
def test_points_that_cannot_be_coarsened_are_rejected_with_two_that_can(points):
    with pytest.raises(InputError, match=r"such as (\d+) or (\d+) nodes"):
        Options(points=points)


@pytest.mark.parametrize(
    ("points", "fault"), [((545, 129), "at most 4 times"), ((497, 125), "4000 nodes, 2500 at most")]
)
def test_points_too_different_along_both_directions_are_rejected(points, fault):
    assert Options(points=(385, 97)).shape == (97, 385)
    with pytest.raises(InputError, match=fault):
        Options(points=points)


@pytest.mark.parametrize("points", [0, -129, 16, 100_001])
def test_points_out_of_range_are_rejected(points):
    with pytest.raises(InputError):
        Options(points=points)


@given(st.integers(17, 5000))
def test_the_proposed_nodes_can_be_coarsened(nodes):
    fewer, more = coarsenable(nodes)
    assert fewer <= max(nodes, 33) < more
    assert coarsenings(fewer) >= 1
    assert coarsenings(more) >= 1


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("load", [0.5, 5.0, 20.0, 200.0, 2000.0])
def test_the_centre_is_a_node_of_every_grid_of_the_proposed_domain(load, near):
    domain = recommended_domain(groups(moes_contact(load, 10.0)), near=near)
    (left, right), (south, north) = domain.x, domain.y
    assert -left / (right - left) * 16 == pytest.approx(round(-left / (right - left) * 16))
    assert south == -north


def test_the_proposed_domain_shrinks_with_load_to_the_smallest_one():
    widths = [-recommended_domain(groups(moes_contact(m, 10.0))).x[0] for m in (3, 20, 80, 500)]
    assert widths == sorted(widths, reverse=True)
    domain = recommended_domain(groups(moes_contact(200, 10.0)))
    assert (domain.x[0], domain.y) == (-3.4, (-2.3, 2.3))


def test_the_proposed_domain_grows_with_the_accuracy():
    wide, usual = (recommended_domain(groups(moes_contact(200, 10.0)), e) for e in (0.0025, 0.02))
    assert wide.x[0] == pytest.approx(2.0 * usual.x[0])


def test_near_edges_of_a_slender_contact_change_its_film_by_less_than_they_may():
    problem = moes_contact(350.0, 20.0, radius_ratio=16.0)
    case = groups(problem)
    near = recommended_domain(case)
    assert case.ellipticity > SLENDER
    assert near.y[1] < 2.3
    far = Domain(x=(2 * near.x[0], 2 * near.x[1]), y=(2 * near.y[0], 2 * near.y[1]))
    common = {"edges": "far_field", "accuracy": "tight", "tolerance": 1e-4, "wedge_order": 3}
    films = [
        solve(problem, Options.model_validate({"points": points, "domain": domain} | common))
        for points, domain in (((129, 65), near), ((257, 129), far))
    ]
    for name in ("central", "minimum"):
        here, there = (getattr(film.film_scaled, name) for film in films)
        assert here == pytest.approx(there, rel=far_field_error(case, near))


@pytest.mark.parametrize(
    ("load", "ratio", "angle"),
    [(300.0, 1.0, 0.0), (1000.0, 3.0, 0.0), (600.0, 25.0, 0.0), (300.0, 3.0, 0.8)],
)
def test_the_nearest_edges_change_a_film_by_less_than_they_may(load, ratio, angle):
    problem = moes_contact(load, 10.0, radius_ratio=ratio, angle=angle)
    case = groups(problem)
    near, far = recommended_domain(case, near=True), recommended_domain(case)
    area, usual = (np.prod([np.ptp(edges) for edges in (one.x, one.y)]) for one in (near, far))
    assert area < 0.8 * usual
    common = {"edges": "far_field", "accuracy": "tight", "tolerance": 1e-4, "wedge_order": 3}
    films = []
    for wider, points in ((1, (65, 65)), (2, (129, 129))):
        domain = Domain(x=[wider * edge for edge in near.x], y=[wider * edge for edge in near.y])
        options = Options.model_validate({"points": points, "domain": domain} | common)
        films.append(solve(problem, options).film_scaled)
    for name in ("central", "minimum"):
        here, there = (getattr(film, name) for film in films)
        assert here == pytest.approx(there, rel=far_field_error(case, near))


@pytest.mark.parametrize(
    ("load", "ratio", "columns"), [(20_000.0, 3.0, 1), (500.0, 3.0, 2), (20_000.0, 25.0, 4)]
)
def test_minima_close_to_the_edge_of_the_contact_get_as_many_lines_as_columns(load, ratio, columns):
    scaled = ScaledProblem.of(moes_contact(load, 10.0, radius_ratio=ratio))
    ny, nx = planned(scaled, Options()).shape
    assert nx - 1 == columns * (ny - 1)


@pytest.mark.parametrize("load", [20.0, pytest.param(600.0, marks=pytest.mark.slow)])
def test_the_heat_of_the_inlet_upstream_of_a_domain_makes_part_of_the_bar_of_its_film(load):
    """At 20 m/s (M = 2.7 and 82, L = 22) heat takes half of the film, 0.3 % upstream of the edge.

    That of the heavier contact is thin (H = 0.17), and errs by less than the formula for lines.
    """
    problem = heated_contact(0.1, sources="auto", entrainment_speed=20.0, load=load)
    scaled = ScaledProblem.of(problem)
    near = recommended_domain(scaled.entering, 0.02, near=True)
    width, films = (near.x[1] - near.x[0]) / 64, []
    common = {"edges": "far_field", "accuracy": "tight", "tolerance": 1e-4, "wedge_order": 3}
    for cells in (64, 128):
        domain = Domain(x=(near.x[1] - cells * width, near.x[1]), y=near.y)
        options = Options.model_validate({"points": (cells + 1, 65), "domain": domain} | common)
        films.append(solve(problem, options))
    here, there = (film.film_scaled.central for film in films)
    entering = entry_error(scaled, near)
    assert 0.4 * entering < here / there - 1.0 < entering
    assert films[0].errors.domain >= entering


def test_surfaces_are_warmed_upstream_of_a_domain_and_one_heats_the_other_by_that():
    """A line between steel and glass that rolls (M = 18, L = 7): 2 % and 4 % of their rises."""
    problem = heated_contact(
        0.0, sources="auto", solids=("steel", "glass"), type="line", entrainment_speed=1.0
    )
    scaled = ScaledProblem.of(problem)
    near, films = recommended_domain(scaled.entering, 0.02, near=True), []
    for times in (1, 2):
        x = near.x[1] - times * (near.x[1] - near.x[0]), near.x[1]
        common = {"edges": "far_field", "accuracy": "tight", "extrapolate": False}
        options = {"points": (256 * times + 1, 1), "domain": Domain(x=x, y=near.y)} | common
        films.append(solve(problem, Options.model_validate(options)))
    here, there = films
    reached = here.scaled.x[0] / there.scaled.x[0]
    warmer, bars = warmed_upstream(scaled, -near.x[0]), here.errors.bars
    pairs = [
        (film.temperature.surface_1_rise_max, film.temperature.surface_2_rise_max) for film in films
    ]
    for side in (0, 1):
        missing = (pairs[1][side] - pairs[0][side]) / (1.0 - reached**1.5)
        assert 0.2 * max(warmer) < missing < max(warmer[side], sum(warmer) / 2)
        assert missing < bars[f"surface_{side + 1}_rise_max"] * pairs[0][side]
    first, second = (film.heat.balance for film in films)
    moved = (first.surface_2 - second.surface_2) / (1.0 - reached)
    across = heat_across(scaled, warmer[1] - warmer[0])
    assert 0.8 * across < moved < across
    assert moved < bars["heat_surface_2"] * first.surface_2


def test_a_contact_that_heats_its_inlet_gets_a_longer_inlet_alone():
    scaled = ScaledProblem.of(heated_contact(0.1, sources="auto", entrainment_speed=20.0))
    least = recommended_domain(scaled.entering, 0.01, near=True)
    domain = chosen_domain(scaled, 0.01, near=True)
    assert entry_error(scaled, domain) <= INLET_HEAT_PART * 0.01 < entry_error(scaled, least)
    assert domain.x[0] < 1.2 * least.x[0]
    assert domain.y == least.y


@pytest.mark.parametrize("degrees", [40.0, -40.0])
def test_a_slender_contact_at_an_angle_has_a_farther_outlet_for_its_pressure_downstream(degrees):
    """A thick film (M = 3, R_y/R_x = 6) loses 0.7 % with an outlet at 2.9 half-widths."""
    problem = moes_contact(3.0, 4.0, radius_ratio=6.0, angle=math.radians(degrees))
    groups_here, films = ScaledProblem.of(problem).entering, []
    domain = recommended_domain(groups_here, 0.02, near=True)
    aligned = recommended_domain(groups(moes_contact(3.0, 4.0, radius_ratio=6.0)), 0.02, near=True)
    assert domain.x[1] / -domain.x[0] > 1.5 * aligned.x[1] / -aligned.x[0]
    width = (domain.x[1] - domain.x[0]) / 64
    for further in (-13, 0, 16):
        cells, outlet = 64 + further // 16 * 16, domain.x[1] + further * width
        wide = Domain(x=(outlet - cells * width, outlet), y=domain.y)
        common = {"edges": "far_field", "accuracy": "tight", "extrapolate": False}
        films.append(
            solve(
                problem,
                Options.model_validate({"points": (cells + 1, 65), "domain": wide} | common),
            )
        )
    near, here, far = (film.film_scaled.central for film in films)
    assert abs(far / here - 1.0) < 0.001 < 0.5 * far_field_error(groups_here, domain)
    assert far / near - 1.0 > 0.004
    assert far_field_error(groups_here, films[0].options.domain) > 0.01


def test_heavier_loads_need_more_points():
    contacts = [groups(moes_contact(m, 10.0)) for m in (20, 200, 2000)]
    points = [expected_points(one, recommended_domain(one), 0.02) for one in contacts]
    assert points == sorted(points)
    assert points[0] < points[-1]
    assert all(coarsenings(n) >= 1 for n in points)


@pytest.mark.parametrize("warmer", [0.0, 5.0, 20.0, 60.0])
def test_the_domain_leaves_the_oil_that_enters_a_part_of_the_error_or_is_the_largest(warmer):
    case, error = heated_contact(0.5), 0.01
    bodies = case.inlet_temperature + warmer
    scaled = ScaledProblem.of(case.with_bodies(bodies, bodies))
    domain, least = chosen_domain(scaled, error), recommended_domain(scaled.entering, error)
    factor = domain.x[0] / least.x[0]
    assert 1.0 <= factor <= LARGEST_DOMAIN_FACTOR * (1.0 + 1e-9)
    if factor < LARGEST_DOMAIN_FACTOR * (1.0 - 1e-9):
        assert entry_error(scaled, domain) <= ENTRY_PART * error


def test_oil_that_thins_upstream_gets_a_wider_domain_and_reaches_the_error():
    case = moes_contact(2.3, 10.5)
    thin = case.model_dump(exclude_none=True)
    thin["contact"]["slide_roll_ratio"] = 1.9
    thin["lubricant"]["shear"] = {"law": "limiting", "slope": 0.03}
    scaled, error = ScaledProblem.of(ContactProblem.model_validate(thin)), 0.02
    usual, wide = chosen_domain(ScaledProblem.of(case), error), chosen_domain(scaled, error)
    assert wide.x[0] < 1.2 * usual.x[0]
    assert wide.y[0] < 1.2 * usual.y[0]
    assert thinner_error(scaled, wide) <= THINNER_PART * error < thinner_error(scaled, usual)
    # the estimate bounds what the film changes by on the wider domain
    x, y = (tuple(1.5 * edge for edge in edges) for edges in (wide.x, wide.y))
    further = Domain(x=x, y=y)
    here, there = (
        solve(scaled.problem, Options(points=points, edges="far_field", domain=domain)).film_scaled
        for domain, points in ((usual, 193), (further, 385))
    )
    changed = abs(here.central / there.central - 1.0)
    assert 0.1 < changed / thinner_error(scaled, usual) < 1.0
    assert thinner_error(ScaledProblem.of(case), usual) == 0.0
