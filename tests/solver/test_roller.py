"""Rollers of finite length: dry pressure, middle and ends of the film, tilt; long cells."""

import tomllib
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

import tehl
from tehl.api.problem import case_from_tables
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tehl.estimate.domain import domain_of
from tehl.estimate.grid import Grid, distances
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.estimate.settled import settled
from tehl.estimate.third_order import third_order_bar
from tehl.io.templates import template_text
from tehl.operators.dry import at_loaded_ends, dry_pressure
from tehl.plots import pressure_map
from tehl.plots.frame import pressure_top
from tehl.result.bars import ErrorEstimate
from tehl.solver.judging.film_errors import _lost_between_lines
from tehl.solver.judging.film_summary import film_summary
from tehl.solver.judging.goal import Goal
from tehl.solver.judging.measures import SAMPLED, side_reach

STEEL = {"material": "steel"}
LOGARITHMIC = {"shape": "logarithmic"}
STANDARD = {"shape": "iso-16281", "diameter": "20 mm"}


def contact(**stated: object) -> tehl.ContactProblem:
    """Return a contact of steel with L = 10."""
    oil, second = stated.pop("lubricant", "mineral-oil"), stated.pop("surface_2", STEEL)
    others = {name: stated.pop(name, None) for name in ("thermal", "asperities", "transient")}
    return tehl.ContactProblem(
        contact={"moes_speed": 10.0, **stated},
        surface_1=STEEL,
        surface_2=second,
        lubricant=oil,
        **others,
    )


def roller(load: float = 50.0, **stated: object) -> tehl.ContactProblem:
    """Return a roller of 10 mm on a radius of 10 mm."""
    shape = {"type": "roller", "radius": "10 mm", "length": "10 mm", "moes_load": load}
    return contact(**shape | stated)


@pytest.mark.parametrize("law", ["logarithmic", "lundberg"])
def test_a_logarithmic_profile_is_pressed_evenly(law):
    scaled = ScaledProblem.of(roller(profile={"shape": law}))
    ends = Domain.model_construct(x=(-1.6, 1.6), y=(-1.0, 1.0))
    grid = Grid(nx=65, ny=129, domain=ends, mirror=True)
    loads = dry_pressure(grid, scaled.groups).sum(axis=1) * grid.dx / (0.5 * np.pi)
    assert loads[grid.y < 0.9] == pytest.approx(1.0, abs=0.03)
    assert loads @ grid.widths == pytest.approx(2.0, rel=1e-6)


@pytest.fixture(scope="module")
def logarithmic() -> tehl.Result:
    """Return the certified film of a roller with a logarithmic profile."""
    return tehl.certify(roller(profile=LOGARITHMIC), Options(points=(257, 129)))


def test_the_middle_of_a_roller_is_a_line_contact(logarithmic):
    found = logarithmic
    line = tehl.solve(contact(type="line", radius="10 mm", moes_load=50.0))
    row = found.scaled.film[64]
    assert found.film_scaled.central == pytest.approx(line.film_scaled.central, rel=0.01)
    assert row.min() == pytest.approx(line.film_scaled.minimum, rel=0.01)
    # the identity w e = 2 F R, and the film at the ends is the thinnest
    assert found.rolling.closure_error == pytest.approx(0.0, abs=1e-4)
    assert found.rolling.T == pytest.approx(line.rolling.T, rel=0.05)
    assert abs(found.scaled.y[found.scaled.film.min(axis=1).argmin()]) > 0.9


def test_the_minimum_film_beside_a_steep_end_is_positive():
    ends = Domain.model_construct(x=(-1.6, 1.6), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=65, domain=ends, mirror=False)
    film = 1e-3 * (1.0 + grid.x**2) + 1e2 * np.maximum(np.abs(grid.y[:, None]) - 0.9, 0.0) ** 2
    assert film_summary(grid, film).minimum == pytest.approx(1e-3, rel=0.15)


def test_only_the_inlet_edge_can_starve_a_roller():
    """Its ends are edges of the nodes, through which no oil flows."""
    found = tehl.solve(roller(20.0, profile=LOGARITHMIC), Options(points=(97, 33), edges="zero"))
    assert found.status.converged


@pytest.mark.parametrize(
    "physics",
    [
        {"thermal": {"temperature": "40 degC"}, "surface_1": STEEL | {"temperature": "45 degC"}},
        {"lubricant": {"name": "mineral-oil", "shear": {"law": "eyring", "stress": "5 MPa"}}},
        {"supply": {"layer": "0.1 um"}},
        {
            "asperities": {
                "model": "greenwood-tripp",
                "rms": "0.05 um",
                "summit_radius": "20 um",
                "summit_density": "4e10 1/m^2",
            }
        },
    ],
    ids=["heat", "thinning", "scarce", "asperities"],
)
def test_physics_join_in_the_middle_as_in_a_line_contact(physics):
    slip = 0.3 if "lubricant" in physics else 0.0
    # a warm layer is thinner than a cell along the line of the coarser grid
    columns = 257 if "thermal" in physics else 129
    motion = {"radius": "10 mm", "moes_load": 50.0, "moes_speed": 10.0, "slide_roll_ratio": slip}
    stated = {"surface_1": STEEL, "surface_2": STEEL, "lubricant": "mineral-oil"} | physics
    ends = {"type": "roller", "length": "10 mm", "profile": LOGARITHMIC}
    found, line = (
        tehl.solve(
            tehl.ContactProblem(contact=motion | kind, **stated),
            Options(points=(columns, rows), wedge_order=3),
        )
        for kind, rows in ((ends, (columns + 3) // 4), ({"type": "line"}, 1))
    )
    # the domain ends with the roller, also where warm bodies or scarce oil change it
    assert found.scaled.y[-1] == 1.0
    # by its profile the middle carries up to 2 % more than the mean
    assert found.film_scaled.central == pytest.approx(line.film_scaled.central, rel=3e-3)


@pytest.mark.parametrize(
    ("shape", "load", "length", "points"),
    [
        ("logarithmic", 150.0, "10 mm", (161, 81)),  # 41 x 41 nodes by halving are too coarse
        # ends that open by the film from line to line
        pytest.param("lundberg", 75.0, "12 mm", (257, 129), marks=pytest.mark.slow),
        ("logarithmic", 150.0, "30 mm", (129, 129)),  # an inlet that all lines share
    ],
    ids=["heavy", "steep", "long"],
)
def test_cycles_of_heavily_loaded_rollers_converge(shape, load, length, points):
    options = Options(points=points, wedge_order=3, smoother="fast", accuracy="tight", max_cycles=6)
    with pytest.raises(tehl.ConvergenceError) as caught:  # after few cycles
        tehl.solve(roller(load, length=length, profile={"shape": shape}), options)
    residuals = [one.residual for one in caught.value.result.history if one.points == points]
    assert (residuals[5] / residuals[0]) ** 0.2 < 0.5


@pytest.mark.parametrize(
    ("profile", "points", "left"),
    [
        (LOGARITHMIC, (129, 65), 0.35),
        ({"shape": "lundberg"}, (129, 65), 0.4),
        ({"shape": "crown", "radius": "0.25 m"}, (129, 65), 0.35),
        pytest.param(LOGARITHMIC, (257, 129), 0.35, marks=pytest.mark.slow),
        # with 17 lines on the coarsest grid it ends at 1e-5
        pytest.param({"shape": "lundberg"}, (257, 129), 0.5, marks=pytest.mark.slow),
    ],
    ids=["logarithmic", "lundberg", "crown", "logarithmic-fine", "lundberg-fine"],
)
def test_cycles_on_lines_that_crowd_leave_a_part_of_the_residual(profile, points, left):
    options = Options(points=points, wedge_order=3, smoother="fast", accuracy="tight", max_cycles=6)
    with pytest.raises(tehl.ConvergenceError) as caught:  # after few cycles
        tehl.solve(roller(profile=profile), options)
    residuals = [one.residual for one in caught.value.result.history if one.points == points]
    # one set of coefficients for all lines leaves 0.41 of a logarithmic profile, others diverge
    assert (residuals[5] / residuals[1]) ** 0.25 < left


@pytest.mark.parametrize(
    "tilt", [pytest.param(0.0, marks=pytest.mark.slow, id="even"), pytest.param(1e-4, id="tilted")]
)
def test_a_thick_film_at_a_steep_end_converges(tilt):
    """By a geometric mean of conductances two pressures of a line had one flow, and alternated."""
    steep = roller(11.7, moes_speed=15.3, radius="8 mm", profile={"shape": "lundberg"}, tilt=tilt)
    found = tehl.solve(steep, Options(points=(257, 129), smoother="fast", wedge_order=3))
    assert len([one for one in found.history if one.points == (257, 129)]) <= 8
    if not tilt:  # 513 x 257 nodes
        assert found.film_scaled.minimum == pytest.approx(0.0988, rel=found.errors.minimum)


def test_a_straight_roller_has_the_film_of_a_line_in_its_middle():
    found = tehl.solve(roller(9.3, moes_speed=14.4, length="8 mm"))
    assert {one.smoother for one in found.history} == {"fast"}  # on lines that crowd none converges
    line = tehl.solve(contact(type="line", radius="10 mm", moes_load=9.3, moes_speed=14.4))
    assert found.film_scaled.central == pytest.approx(line.film_scaled.central, rel=0.02)
    assert not found.errors.minimum_has_limit


def test_single_nodes_at_the_ends_do_not_keep_cycles_from_a_finer_grid():
    tilted = roller(12.0, moes_speed=15.0, length="8 mm", profile=LOGARITHMIC, tilt=2e-4)
    found = tehl.solve(tilted, Options(points=161))
    assert {one.smoother for one in found.history} == {"fast"}
    assert max(found.errors.central, found.errors.minimum) < 0.05


def test_the_domain_of_a_crowned_roller_contains_its_widest_slice():
    problem = roller(60.0, profile={"shape": "crown", "radius": "0.25 m"})
    shape = ScaledProblem.of(problem).groups.shape
    assert shape.widest > 1.3
    found = tehl.solve(problem, Options(error=0.05))
    wet = found.scaled.x[found.scaled.pressure[found.scaled.y.size // 2] > 0.0]
    # slices that deflect by themselves spread the load
    assert 1.0 < wet[-1] / shape.widest < 1.15
    assert found.scaled.x[-1] > 1.2 * wet[-1]
    assert found.errors.minimum < 0.05


def test_the_bars_to_expect_of_ellipses_do_not_limit_those_of_rollers():
    short = roller(20.0, length="2.3 mm", profile=LOGARITHMIC)
    found, scaled = tehl.solve(short, Options(points=(129, 129))), ScaledProblem.of(short)
    expected = third_order_bar(scaled, domain_of(scaled, found.options), 129)
    assert found.errors.discretisation_minimum > 1.5 * expected
    # 513 x 513 nodes
    assert found.film_scaled.minimum == pytest.approx(0.06255, rel=found.errors.minimum)


def test_lines_crowd_at_the_ends_and_resolve_the_film_there(logarithmic):
    """On uniform lines it is 0.0255 and 0.0223 with as many and twice as many, 0.0197 with four."""
    found = logarithmic
    y = found.scaled.y
    assert y[-1] - y[-2] < 0.15 * (y[65] - y[64])
    # 1025 x 513 nodes, also with a logarithmic mean of all of the conductance
    assert found.film_scaled.minimum == pytest.approx(0.0180, rel=found.errors.minimum)
    assert found.errors.minimum < 0.08  # uniform lines err by a third


def test_rough_rollers_have_a_wedge_of_third_order():
    """With one of second order the middle is 0.0225, 20 % thinner, on these nodes."""
    wave = {"type": "wave", "amplitude": "1 nm", "wavelength": "0.2 mm"}
    stated = {
        "profile": {"shape": "crown", "radius": "1 m"},
        "surface_2": STEEL | {"roughness": wave},
    }
    found = tehl.solve(roller(**stated), Options(points=(129, 65)))
    smooth = tehl.solve(roller(profile=stated["profile"]), Options(points=(129, 65)))
    assert found.film_scaled.central == pytest.approx(smooth.film_scaled.central, rel=5e-3)
    moving = roller(**stated, transient={"duration": "1 ms", "load": "1 + t/(1 ms)"})
    assert settled(moving, Options()).order == 3  # in time too


@pytest.mark.parametrize("law", ["logarithmic", "lundberg"])
def test_the_end_of_a_roller_is_resolved_between_rough_surfaces_and_boundary_films(law):
    """On uniform lines the minimum is 15 % too thick, and more than three times under `lundberg`.

    A boundary film has fluxes of second order, which make the middle 4 % thinner here.
    """
    on, profile = Options(points=(129, 129)), {"shape": law}
    smooth = tehl.solve(roller(20.0, profile=profile), on).film_scaled
    wave = {"type": "wave", "amplitude": "0.1 nm", "wavelength": "1 mm", "angle": "90 deg"}
    rough = roller(20.0, profile=profile, surface_2=STEEL | {"roughness": wave})
    found = tehl.solve(rough, on)
    assert found.film_scaled.minimum == pytest.approx(smooth.minimum, rel=0.01)
    tables = roller(20.0, profile=profile).model_dump(exclude_none=True)
    thin = tehl.ContactProblem.model_validate(tables | {"contact_film": {"thickness": "1 nm"}})
    assert tehl.solve(thin, on).film_scaled.minimum == pytest.approx(smooth.minimum, rel=0.06)
    # the response of a film needs uniform lines: no smallest film is claimed there
    shaken = tehl.ContactProblem.model_validate(tables | {"dynamics": {"frequencies": ["1 kHz"]}})
    assert not tehl.solve(shaken, on).errors.minimum_has_limit


def test_the_middle_of_a_roller_has_third_order_while_its_speed_varies():
    """Of second order it errs by 6 % on 65 nodes, and by 1.6 % on 129.

    At its ends lines crowd: on uniform ones the minimum is 4 % too thick on both grids.
    """
    shape = {"length": "1 mm", "profile": LOGARITHMIC, "moes_speed": 6.0}
    units = scales(roller(10.0, **shape))
    unit = units.half_width_x / units.speed
    course = {"duration": 2 * unit, "entrainment_speed": f"1 + 0.3*sin(2*t/({unit!r} s))"}
    case = roller(10.0, **shape, transient=course | {"frames": 0})
    assert settled(case, Options()).order == 3
    fine, coarse = (
        tehl.solve_transient(case, Options(points=(nodes, 65), wedge_order=3)).history
        for nodes in (129, 65)
    )
    middle = np.interp(coarse.time, fine.time, fine.film_central)
    assert np.ptp(middle) > 0.1 * middle[0]
    assert coarse.film_central == pytest.approx(middle, rel=5e-3)
    thinnest = 3.948e-8  # of the steady film at the beginning on 513 x 257 nodes
    assert coarse.film_minimum[0] == pytest.approx(thinnest, rel=0.02)
    assert fine.film_minimum[0] == pytest.approx(thinnest, rel=0.015)
    # 65 and 129 nodes are 1.8 and 1.1 % too thick at the beginning, and differ by 1.4 % at most
    least = np.interp(coarse.time, fine.time, fine.film_minimum)
    assert coarse.film_minimum == pytest.approx(least, rel=0.02)


def test_a_sharp_end_under_pressure_has_no_thinnest_film():
    found = tehl.solve(roller(), Options(points=(129, 129), wedge_order=3))
    assert abs(found.film_scaled.minimum_at[1]) == 1.0
    assert found.errors.of("film_minimum") is None
    assert found.errors.film() == found.errors.central < 0.05
    assert "the minimum film has no limit" in found.status.message
    # lists show the outcome beside a pressure that a user would take for the contact's
    assert found.status.outcome == "converged, minimum film and largest pressure open"
    assert "Nor has the largest pressure" in found.status.message


def test_the_largest_pressure_at_a_sharp_end_has_no_limit_and_does_not_scale_pictures():
    """It is 3.7, 5.2 and 7.8 Hertz pressures on 97, 129 and 257 nodes."""
    found = tehl.solve(roller(20.0, profile=LOGARITHMIC, tilt=2e-4), Options(points=(97, 49)))
    assert not found.errors.pressure_has_limit
    assert found.errors.minimum_has_limit
    assert found.errors.of("pressure_max") is None
    assert found.status.outcome == "converged, largest pressure open"
    assert "grows with each finer grid" in found.status.message
    assert found.summary()["errors"]["pressure_has_limit"] is False
    assert "open, at an end of the roller" in as_text(found)
    top = pressure_top(found) / found.scales.hertz_pressure
    assert 1.0 < top < 0.7 * found.scaled.pressure.max()
    colours = pressure_map(found).axes[0].collections[0]
    assert colours.get_clim()[1] == pytest.approx(top * found.scales.hertz_pressure * 1e-9)


def test_a_roller_is_certified_between_its_ends(logarithmic):
    central = logarithmic.uncertainty["film_central"]
    assert 1.0 < central.observed_order < 2.5
    assert central.domain < 1e-3 * central.value  # the larger domain is longer along x alone
    assert central.uncertainty < 0.03 * central.value
    minimum = logarithmic.uncertainty["film_minimum"]
    # 1025 x 513 nodes; on uniform lines it was 0.0245
    assert minimum.uncertainty < 0.06 * minimum.value
    assert minimum.value == pytest.approx(0.0180, abs=minimum.uncertainty)


def test_a_tilted_roller_mirrors_and_carries_more_where_the_gap_closes():
    crowned = {"shape": "crown", "radius": "2 m"}
    first, second = (
        tehl.solve(roller(20.0, profile=crowned, tilt=tilt), Options(points=(97, 49)))
        for tilt in (2e-4, -2e-4)
    )
    assert first.scaled.film == pytest.approx(second.scaled.film[::-1], rel=2e-3)
    loads = first.scaled.pressure.sum(axis=1)
    assert loads[:24].sum() > 1.2 * loads[25:].sum()
    # a dry roller makes nearly the same moment
    scaled = first.scaled_problem
    grid = Grid(nx=97, ny=49, domain=domain_of(scaled, Options()), mirror=False)
    dry = dry_pressure(grid, scaled.groups).sum(axis=1) * grid.dx * first.scales.hertz_pressure
    area = first.scales.half_width_x * first.scales.half_width_y**2
    moment = first.rolling.tilting
    assert moment == pytest.approx(dry @ (grid.y * grid.widths) * area, rel=0.05)
    assert moment == pytest.approx(-second.rolling.tilting, rel=2e-3)
    assert first.errors.bars["tilting"] < 0.02
    assert "of the load about x" in as_text(first)
    even = tehl.solve(roller(20.0, profile=crowned), Options(points=(97, 49)))
    assert even.summary()["rolling"]["tilting_moment_n_m"] is None


@pytest.mark.parametrize("stretch", [10.0, 20.0, 50.0])
def test_wide_ellipses_converge_as_fast_as_circles(stretch):
    # radii for a_y/a_x of 10 to 50, on cells up to 35 times as long as wide
    ratio = {10.0: 36.5, 20.0: 117.6, 50.0: 581.0}[stretch]
    wide = contact(radius_x="10 mm", radius_y=0.01 * ratio, moes_load=1000.0)
    options = Options(points=(257, 129), smoother="fast", accuracy="tight", max_cycles=9)
    try:
        found = tehl.solve(wide, options)
    except tehl.ConvergenceError as error:
        found = error.result
    assert found.groups.ellipticity == pytest.approx(stretch, rel=1e-3)
    residuals = [one.residual for one in found.history if one.points == (257, 129)]
    rate = (residuals[-1] / residuals[1]) ** (1.0 / (len(residuals) - 2))
    assert rate < 0.3


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"length": None}, "needs length"),
        ({"tilt": 1.0}, "rollers tilt by some 0.001 rad"),
        ({"length": 1e-4}, "rollers are longer"),
        ({"profile": {"shape": "iso-16281"}}, "needs diameter"),
        ({"profile": {"shape": "table", "drops": [[0.0, 0.0], [1e-3, 1e-6]]}}, "does not cover"),
        ({"type": "point"}, 'only a contact with type = "roller" has ends'),
    ],
)
def test_bad_input_is_named(stated, message):
    with pytest.raises(tehl.TehlError, match=message):
        roller(**stated)


def test_the_template_converges_by_the_first_strategy():
    """On end cells as long as between thin films its cycles stall, and take a minute."""
    problem, _ = case_from_tables(tomllib.loads(template_text("roller")))
    found = tehl.solve(problem)
    assert {one.smoother for one in found.history} == {"fast"}
    assert found.history[-1].points == (257, 129)


def test_the_film_is_thin_where_a_roller_leaves_the_raceway():
    """With lines that crowd at its ends, which carry nothing, the minimum errs by 23 %."""
    short = roller(60.0, length="3 mm", profile=STANDARD)
    coarse = tehl.solve(short, Options(points=(257, 129), wedge_order=3))
    place = abs(coarse.film_scaled.minimum_at[1])
    assert 0.8 < place < 0.85
    assert np.interp(place, coarse.scaled.y[1:], np.diff(coarse.scaled.y)) < 0.4 * 2.0 / 128
    difference = abs(coarse.film_scaled.minimum / 0.00833 - 1.0)  # 257 x 257 nodes
    assert difference < coarse.errors.minimum < 0.07


@pytest.mark.slow
def test_lines_crowd_at_the_steep_end_of_the_loaded_part():
    """On longer cells, which crowd at the end of the roller, the minimum is 0.0030."""
    found = tehl.solve(
        roller(profile={"shape": "lundberg"}), Options(points=(513, 257), wedge_order=3)
    )
    # 513 x 1025 nodes
    assert found.film_scaled.minimum == pytest.approx(0.00224, rel=found.errors.minimum)
    assert found.errors.minimum < 0.02


def test_cells_at_a_steep_end_are_as_short_as_a_thin_film_needs():
    """On cells with a third of the length of those at gradual ends the minimum is 18 % off."""
    thin = roller(64.0, length="4 mm", moes_speed=1.3, profile={"shape": "lundberg"})
    options = Options(points=(257, 129), wedge_order=3)
    # 513 x 257 nodes
    assert tehl.solve(thin, options).film_scaled.minimum == pytest.approx(5.35e-4, rel=0.05)


@pytest.mark.parametrize("part", [0.0, 0.25, 0.5, 0.75])
def test_a_minimum_beside_a_steep_end_is_within_reach_of_lines(part):
    """A film as of a lundberg profile: it falls to a kink between two lines, and rises at once."""
    scaled = ScaledProblem.of(roller(profile={"shape": "lundberg"}))
    plan = Options(points=(257, 129), wedge_order=3)
    grid = at_loaded_ends(finest_grid(scaled, plan), scaled.groups)
    kappa, row = scaled.groups.ellipticity, int(np.abs(grid.y - grid.edges[1]).argmin())
    kink = grid.y[row] + part * (grid.y[row + 1] - grid.y[row])
    inside, outside = kappa * np.maximum(kink - grid.y, 0.0), kappa * np.maximum(grid.y - kink, 0.0)
    film = (0.002 + 0.06 * inside + outside**1.5)[:, None] + 0.05 * (grid.x - 0.1) ** 2
    found = film_summary(grid, film).minimum
    reach = side_reach(Mock(grid=grid, film=Mock(h=film))) / SAMPLED
    assert (1.0 - reach) * found < 1.001 * 0.002 < 1.06 * found


def test_lines_stay_where_the_load_reaches_the_ends_of_a_roller():
    grid = Grid(
        nx=65,
        ny=65,
        domain=Domain.model_construct(x=(-3.0, 1.5), y=(-1.0, 1.0)),
        mirror=True,
        crowding=2.0,
    )
    found = {
        shape: at_loaded_ends(grid, ScaledProblem.of(roller(profile=profile)).groups)
        for shape, profile in (
            ("logarithmic", LOGARITHMIC),
            ("crown", {"shape": "crown", "radius": "0.5 m"}),
        )
    }
    assert found["logarithmic"] == grid
    assert found["crown"].edges == pytest.approx((0.6, 0.6), abs=0.2)
    least, _ = distances(found["crown"].crowding, found["crown"].edges)
    assert least == pytest.approx(distances(2.0, (1.0, 1.0))[0], rel=1e-6)
    straight = replace(grid, crowding=0.0)
    assert at_loaded_ends(straight, ScaledProblem.of(roller()).groups) is straight


def test_the_first_strategy_solves_the_first_grid_of_a_tilted_roller_under_load():
    """Its points would take steps too long for an error of the inlet that all lines share."""
    stated = {"moes_speed": 1.7, "length": "3.56 mm", "tilt": 1.3e-5, "profile": LOGARITHMIC}
    found = tehl.solve(roller(78.0, **stated), Options(points=(257, 129), wedge_order=3))
    assert {one.smoother for one in found.history} == {"fast"}


def test_lines_that_waves_hold_apart_claim_no_smallest_film():
    wave = {"type": "wave", "amplitude": "0.1 nm", "wavelength": "1 mm", "angle": "60 deg"}
    rough = roller(20.0, profile={"shape": "lundberg"}, surface_2=STEEL | {"roughness": wave})
    found = tehl.solve(rough, Options(points=(129, 65)))
    assert found.status.cause == "minimum_film_and_largest_pressure_open"
    assert "too few lines only" in found.status.message
    assert not found.errors.minimum_has_limit
    assert "numerics.points = [129, 257]" in found.status.hint.advice
    more = tehl.solve(rough, Options(points=(129, 257)))
    smooth = tehl.solve(roller(20.0, profile={"shape": "lundberg"}), Options(points=(129, 257)))
    assert more.status.cause is None
    assert more.film_scaled.minimum == pytest.approx(smooth.film_scaled.minimum, rel=0.05)


def test_the_pressure_at_a_sharp_end_is_open_between_rough_surfaces_too():
    wave = {"type": "wave", "amplitude": "1 nm", "wavelength": "1 mm"}
    tilted = {"profile": LOGARITHMIC, "tilt": 2e-4}
    both = roller(20.0, **tilted), roller(20.0, **tilted, surface_2=STEEL | {"roughness": wave})
    smooth, rough = (tehl.solve(one, Options(points=(129, 129))).status for one in both)
    assert smooth.cause == rough.cause == "largest_pressure_open"


def test_a_roller_takes_more_columns_where_its_lines_fill_the_memory():
    """They do not where more columns do not help, or the mesh may be halved."""
    scaled = ScaledProblem.of(roller(profile={"shape": "lundberg"}))
    grid = at_loaded_ends(finest_grid(scaled, Options(points=(257, 1025))), scaled.groups)
    mesh = ErrorEstimate(
        discretisation_central=0.05,
        discretisation_minimum=0.05,
        iteration_central=0.0,
        iteration_minimum=0.0,
        domain=0.0,
    )
    outside = replace(mesh, discretisation_central=0.0, discretisation_minimum=0.0, domain=0.1)
    found = []
    for memory, errors in ((1e9, mesh), (1e9, outside), (1e11, mesh)):
        goal = Goal(scaled=scaled, options=Options(error=0.02, max_memory=memory))
        found.append(goal.other_nodes(Mock(grid=grid), errors))
    assert found == [(513, 1025), None, None]


def test_waves_fade_where_lines_that_crowd_are_rarest():
    ends = Domain.model_construct(x=(-1.6, 1.6), y=(-1.0, 1.0))
    grid = Grid(nx=33, ny=65, domain=ends, mirror=False, crowding=2.0)
    level = Mock(grid=grid, film=Mock(h=np.full(grid.shape, 0.2)))
    waves = Mock(amplitude=0.01, points=5.0)
    assert _lost_between_lines(level, waves) == pytest.approx(0.01 / (0.2 * 25.0))
    even = Mock(grid=replace(grid, crowding=0.0), film=level.film)
    assert _lost_between_lines(even, waves) == 0.0
