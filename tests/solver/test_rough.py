"""Rough surfaces at rest: convergence of the cycles, and the status of the result."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tehl import load
from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid
from tehl.estimate.nodes import finest_grid, planned
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.operators.heights import full_weighting, heights_of
from tehl.report.page import report_text
from tehl.solver import steady
from tehl.solver.cycle.anderson import Anderson
from tehl.solver.cycle.ladder import BETWEEN_ROUGH
from tests.cases import ball_tables
from tests.operators.contacts import FLAT
from tests.reference import DOMAIN, moes_contact
from tests.solver.rough import bumpy, rough_film, wave_on
from tests.solver.runs import film_of, tight

FULL = {"half_domain": "never"}


def options(points: int, **changes: object) -> Options:
    """Return the options of a default run on the domain of most published films."""
    return Options.model_validate({"points": points, "domain": DOMAIN, **changes})


def test_heights_fade_on_coarser_grids_and_keep_their_mean():
    grid = finest_grid(ScaledProblem.of(moes_contact(200.0, 10.0)), tight(65, half_domain="never"))
    heights = wave_on(grid, 0.1, 8.0 * grid.dx)
    coarse, fine = heights.on([grid.coarser(), grid])
    inner = (slice(2, -2), slice(2, -2))
    # eight nodes per wave: the 1-2-1 means leave (1 + cos(pi/4))/2
    assert coarse[inner] == pytest.approx(fine[::2, ::2][inner] * (1 + np.sqrt(0.5)) / 2)
    assert heights.points_per_wave(grid.coarser()) == pytest.approx(4.0)


def test_the_mirror_row_is_weighted_with_its_image():
    half = np.arange(25.0).reshape(5, 5) ** 2
    whole = np.concatenate([half[:0:-1], half])
    square = Domain.model_construct(x=(-1.0, 1.0), y=(-1.0, 1.0))
    fine = Grid(nx=5, ny=9, domain=square, mirror=True)
    both = replace(fine, mirror=False, domain=FLAT)
    coarse = full_weighting(whole, both, both.coarser())
    assert coarse.shape == (5, 3)
    # the ends of the square are mirrors too
    assert full_weighting(half, fine, fine.coarser())[:-1] == pytest.approx(coarse[2:-1])
    assert full_weighting(half, fine, fine.coarser())[-1, 1] == pytest.approx(
        np.array([0.25, 0.5, 0.25]) @ (half[-1, 1:4] + half[-2, 1:4]) / 2.0
    )
    lines = replace(fine, ny=5)  # halved alone, the columns stay
    assert full_weighting(half, fine, lines)[1] == pytest.approx(
        0.25 * half[1] + 0.5 * half[2] + 0.25 * half[3]
    )


def test_heights_of_zero_give_the_smooth_film():
    smooth = film_of(20.0, 10.0, tight(65))
    result = rough_film((20.0, 10.0), tight(65), (1e-12, 1.0, 0.0))
    assert result.heights is not None
    assert result.scaled.film == pytest.approx(smooth.scaled.film, abs=1e-5)


def test_half_and_full_domain_agree_between_symmetric_waves():
    half, full = (
        rough_film((57.0, 10.0), tight(65, **more), (0.03, 1.0, 0.0)) for more in ({}, FULL)
    )
    assert full.scaled.film == pytest.approx(half.scaled.film, abs=1e-5)


@pytest.mark.parametrize("degrees", [0.0, 45.0, 90.0])
def test_a_wave_converges_as_fast_as_a_smooth_contact(degrees):
    result = rough_film((200.0, 10.0), tight(129, **FULL), (0.03, 1.0, degrees))
    last = [report for report in result.history if report.points == (129, 129)]
    assert {report.smoother for report in last} == {"rough"}
    assert len(last) < 16


def test_a_strong_wave_falls_back_to_the_accelerated_cycles():
    result = rough_film((126.0, 12.34), tight(129), (0.2, 1.0, 0.0))
    assert result.status.converged
    assert result.scaled.film.min() > 0.0


def test_a_default_run_is_close_to_the_tight_one():
    default, exact = (
        rough_film((57.21, 10.52), o, (0.1, 1.0, 45.0))
        for o in (options(129, **FULL), tight(129, **FULL))
    )
    assert default.errors is not None
    for name in ("central", "minimum"):
        value, true = (getattr(r.film_scaled, name) for r in (default, exact))
        bar = getattr(default.errors, f"discretisation_{name}")
        assert abs(value - true) < bar * true / 3


@pytest.mark.parametrize("height", [-0.3, 0.3])
def test_a_dent_and_a_bump_change_the_film_where_they_are(height):
    contact, chosen = (200.0, 10.0), options(129)
    result = solve(bumpy(contact, height, 0.3), chosen)
    smooth = solve(moes_contact(*contact), chosen)
    assert (result.film_scaled.central - smooth.film_scaled.central) * height < 0
    assert abs(result.film_scaled.central - smooth.film_scaled.central) < 0.5 * abs(height)


def test_asperities_that_would_touch_are_reported():
    with pytest.raises(ConvergenceError) as caught:
        rough_film((500.0, 10.0), options(65), (0.2, 1.5, 90.0))
    status = caught.value.result.status
    assert status.cause in ("asperity_contact", "grid_too_coarse")
    assert caught.value.result.scaled.pressure.shape == (65, 65)


def test_a_minimum_with_an_error_above_100_percent_is_reported_and_bounded():
    """Ridges of nearly twice the smooth film: one spot is thin, the rest is accurate."""
    contact, shape = (57.21, 10.52), (0.2, 1.0, 90.0)
    coarse, fine = (rough_film(contact, options(points), shape) for points in (65, 129))
    assert coarse.status.converged
    assert coarse.status.cause is None
    assert "its value is not known" in (coarse.status.message or "")
    assert "numerics.points = 257" in str(coarse.status.hint)
    assert coarse.errors is not None
    assert coarse.errors.discretisation_minimum > 1.0
    most = (1.0 + coarse.errors.discretisation_minimum) * coarse.film_scaled.minimum_node
    assert 0.0 < fine.film_scaled.minimum < most
    off = abs(coarse.film_scaled.central / fine.film_scaled.central - 1.0)
    assert off < coarse.errors.discretisation_central
    assert fine.status.message is None
    text = as_text(coarse)
    assert "uncertain        The minimum film" in text
    assert "hint             Set numerics.points = 257" in text


def test_a_film_that_is_not_positive_is_reported_with_its_place():
    with pytest.raises(ConvergenceError) as caught:
        rough_film((126.0, 12.34), options(65), (0.2, 1.0, 90.0))
    status = caught.value.result.status
    assert status.cause == "grid_too_coarse"
    assert "not positive: smallest H = -0.03" in (status.message or "")


def test_anderson_takes_the_combination_that_changes_least():
    """Compared with a library least-squares solution, with two nearly parallel changes."""
    generator = np.random.default_rng(2)
    befores, afters = generator.standard_normal((2, 4, 50))
    afters[2] = befores[2] + (afters[1] - befores[1]) * (1.0 + 1e-5 * befores[0])
    anderson = Anderson(3)
    for before, after in zip(befores, afters, strict=True):
        combined = anderson.combine(before, after)
    changes = afters - befores
    by_state, by_change = (befores[3] - befores[:3]).T, (changes[3] - changes[:3]).T
    weights = np.linalg.lstsq(by_change, changes[3], rcond=None)[0]
    assert combined == pytest.approx(afters[3] - (by_state + by_change) @ weights, rel=1e-9)


def test_anderson_solves_a_linear_iteration_that_diverges():
    generator = np.random.default_rng(1)
    rates = np.concatenate([[-1.6, 1.3], np.linspace(-0.5, 0.5, 30)])
    turn = np.linalg.qr(generator.standard_normal((32, 32)))[0]
    matrix, goal = turn @ np.diag(rates) @ turn.T, generator.standard_normal(32)
    anderson, state = Anderson(10), np.zeros(32)
    for _ in range(40):
        after = goal + matrix @ (state - goal)
        state = anderson.combine(state, after)
    assert np.abs(state - goal).max() < 1e-6


@pytest.mark.parametrize("wavelength", [0.01, 0.09375, 0.3], ids=["short", "mesh", "few"])
def test_waves_that_the_grid_would_alias_are_rejected(wavelength):
    """The mesh width is 0.09375; a wave of that length would be a flat surface."""
    with pytest.raises(InputError, match=r"the shortest wave has .* nodes per wavelength"):
        rough_film((57.21, 10.52), options(65), (0.01, wavelength, 0.0))


def test_a_dent_between_the_nodes_is_rejected():
    case = moes_contact(57.21, 10.52).model_dump(exclude_none=True)
    case["surface_1"]["roughness"] = {"type": "bump", "amplitude": -1e-8, "radius": 1e-6}
    with pytest.raises(InputError, match=r"increase numerics\.points"):
        solve(ContactProblem.model_validate(case), options(65))


def test_the_short_waves_of_a_map_are_filtered_and_not_rejected(tmp_path):
    """Blue noise: even the waves that remain have fewer than four nodes."""
    smooth = moes_contact(57.21, 10.52)
    case, units = smooth.model_dump(exclude_none=True), scales(smooth)
    noise = np.random.default_rng(5).standard_normal((96, 96))
    np.save(tmp_path / "noise.npy", 1e-9 * (noise - np.roll(noise, 1, axis=1)))
    pixel = 0.05 * units.half_width_x
    table = {"type": "map", "file": str(tmp_path / "noise.npy"), "unit": "m", "pixel": pixel,
             "outside": "periodic"}  # fmt: skip
    case["surface_1"]["roughness"] = table
    problem = ScaledProblem.of(ContactProblem.model_validate(case))
    grid = finest_grid(problem, options(65))
    assert heights_of(problem, grid).points_per_wave(grid) < 4.0
    case["surface_1"]["roughness"] = [table, {"type": "bump", "amplitude": -1e-8, "radius": 1e-6}]
    problem = ScaledProblem.of(ContactProblem.model_validate(case))
    with pytest.raises(InputError, match="the shortest wave has"):
        heights_of(problem, grid)


@pytest.mark.usefixtures("no_pictures")
def test_waves_that_the_grid_loses_are_reported_and_count_for_lambda(tmp_path):
    x = np.arange(800) * 1e-6
    short = 2 * np.cos(2 * np.pi * x / 8e-6) * np.cos(2 * np.pi * x / 8e-6)[:, None]
    np.save(tmp_path / "a.npy", 10 * np.cos(2 * np.pi * x / 1e-4) + 20 * short)
    table = {"type": "map", "file": str(tmp_path / "a.npy"), "unit": "nm", "pixel": "1 um"}
    surface = {"material": "steel", "roughness": table}
    case = ContactProblem.model_validate(ball_tables(surface_2=surface))
    result = solve(case, Options(points=65))
    found = result.roughness
    assert found.composite == pytest.approx(21.2e-9, rel=0.1)
    assert max(found.sq_on_grid) < 8e-9
    assert found.resolution.lost_share > 0.85
    block = result.summary()["roughness"]
    assert block["composite_sq_on_grid_m"] == max(found.sq_on_grid)
    assert 0.7 < block["surface_2_sa_m"] / block["surface_2_sq_m"] < 0.9
    assert "of the variance in waves too short" in block["warning"]
    assert "warning          the grid carries" in as_text(result)
    assert f"nm of both, Sa = 0 nm and {1e9 * block['surface_2_sa_m']:.4g} nm" in as_text(result)
    assert "mean absolute height of surface 1 and of surface 2" in report_text(result, dpi=40)
    result.save(tmp_path / "a.nc")
    assert load(tmp_path / "a.nc").resolution == result.resolution


@pytest.mark.parametrize("degrees", [0.0, pytest.param(30.0, marks=pytest.mark.slow)])
def test_a_rough_film_of_third_order_lies_within_its_bars_on_fewer_nodes(degrees: float) -> None:
    contact, shape = (200.0, 6.0), (0.03, 1.0, degrees)
    found = rough_film(contact, Options(), shape)
    second = rough_film(contact, Options(wedge_order=2), shape)
    fine = rough_film(contact, Options(points=1025, wedge_order=2), shape)
    assert found.scaled.film.size < 0.3 * second.scaled.film.size
    assert found.errors is not None
    for name in ("central", "minimum"):
        value, true = (getattr(one.film_scaled, name) for one in (found, fine))
        assert value == pytest.approx(true, rel=getattr(found.errors, name))


def test_heights_follow_strategies_to_grids_with_other_lines(monkeypatch: Any) -> None:
    """A wedge of second order has as many lines as columns, where a slender contact has fewer."""
    problem = moes_contact(50.0, 6.0, radius_ratio=30.0)
    tables, unit = problem.model_dump(exclude_none=True), scales(problem)
    wave = {"amplitude": 0.03 * unit.film_thickness, "wavelength": unit.half_width_x}
    tables["surface_1"]["roughness"] = wave | {"type": "wave", "angle": 0.0}
    rough = ContactProblem.model_validate(tables)
    second = (replace(BETWEEN_ROUGH[0], wedge_order=2),)
    monkeypatch.setattr(steady, "ladder", lambda *_, **__: second)
    found = steady.solve(rough, Options(error=0.02))
    (ny, nx), (lines, nodes) = (
        found.scaled.film.shape,
        planned(ScaledProblem.of(rough), Options(error=0.02)).shape,
    )
    assert lines < nodes
    assert nx >= nodes
    assert ny == nx
    assert found.heights is not None
    assert found.heights.surface_1.shape == (ny, nx)
