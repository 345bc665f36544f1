"""Numbers of a rough film, and the same beside its smooth reference run."""

import math
from dataclasses import asdict, replace

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.contact.heat import Thermal
from tehl.contact.options import Options
from tehl.contact.shape import Ellipse
from tehl.estimate.film_formulas import lubrication
from tehl.io.store import load_summary, save
from tehl.io.summary import from_block, roughness_block
from tehl.post.micro_film import (
    RoughnessEffect,
    micro_film,
    roughness_effect,
    smooth_reference,
    typical_wavelength,
)
from tehl.post.roughness import (
    area_below,
    film_histogram,
    film_in_contact,
    ripples,
    rough_film,
    weighted_quantiles,
)
from tehl.post.stress.loads import on_even_lines
from tehl.post.thermal_effect import ThermalEffect
from tests.fixtures_result import CASE, make_result
from tests.fixtures_rough import AMPLITUDE, CARRIED, LEFT, PRESSURE, WAVELENGTH, make_rough
from tests.solver.test_roller import roller


def test_sq_is_that_of_the_heights_in_the_contact(rough):
    found = rough_film(rough)
    unit = rough.scales.film_thickness
    assert found.sq[0] == 0.0
    # |X|, |Y| < 1 does not hold whole waves
    assert found.composite == pytest.approx(AMPLITUDE * unit / math.sqrt(2), rel=0.02)
    assert found.lambda_central == pytest.approx(0.1 * math.sqrt(2) / AMPLITUDE, rel=0.02)
    assert found.largest_pressure == rough.scaled.pressure.max()
    assert found.minimum_at == rough.film_scaled.minimum_at


def test_a_stated_roughness_of_a_smooth_film_has_its_lambda_central(result):
    rms = {"surface_1": {"material": "steel", "rms_roughness": 3e-8},
           "surface_2": {"material": "steel", "rms_roughness": 4e-8}}  # fmt: skip
    found = rough_film(replace(result, problem=ContactProblem.model_validate({**CASE, **rms})))
    assert found.composite == pytest.approx(5e-8)
    assert found.lambda_central == pytest.approx(result.film.central / 5e-8)
    assert found.lambda_minimum == pytest.approx(result.film.minimum / 5e-8)
    assert found.waves == ()


def test_the_regime_of_lubrication_follows_the_limits_of_the_textbooks():
    words = [lubrication(value) for value in (0.99, 1.0, 2.99, 3.0)]
    assert words == ["boundary", "mixed", "mixed", "full film"]


def test_a_smooth_film_and_no_film_have_no_numbers(result, rough):
    assert rough_film(result) is None
    none = replace(rough.film_scaled, minimum=-0.01)
    assert rough_film(replace(rough, film_scaled=none)) is None


def test_quantiles_and_areas_are_those_of_the_film_in_the_contact(rough):
    found, film = rough_film(rough), film_in_contact(rough)
    for part, level in found.quantiles:
        assert area_below(rough, level) == pytest.approx(part, abs=1e-3)
    assert found.below_composite == pytest.approx(np.mean(film < found.composite), rel=1e-12)
    assert area_below(rough, np.inf) == 1.0


def test_lines_that_crowd_do_not_weigh_more():
    """A crowned roller whose lines crowd where its load ends: the film is thin there."""
    profile = {"shape": "crown", "radius": "6 m"}
    smooth = solve(roller(20.0, profile=profile), Options(points=(129, 65)))
    steps = np.diff(smooth.y)
    assert steps.max() > 3.0 * steps.min()
    even = on_even_lines(smooth)
    for level in (0.8, 0.9, 1.1):  # by nodes alone it was 0.09 at 0.9
        part = area_below(smooth, level * smooth.film.central)
        assert part == pytest.approx(area_below(even, level * smooth.film.central), abs=0.01)


def test_equal_weights_give_the_quantiles_of_numpy():
    values, parts = np.random.default_rng(3).normal(size=50), (0.01, 0.3, 0.5, 0.99)
    found = weighted_quantiles(values, np.full(50, 0.2), parts)
    assert found == pytest.approx(np.quantile(values, parts))


def test_the_histogram_holds_the_contact(rough):
    edges, share = film_histogram(rough)
    assert np.sum(share * np.diff(edges)) == pytest.approx(0.995, abs=1e-3)
    assert film_histogram(rough, [0.0, 1.0])[1] == pytest.approx([1.0])


def test_ripples_are_counted_with_their_depth():
    found = rough_film(make_rough(385, angle=0.0))
    # from -0.8 to 0.8 there are 6.4 waves, of which six have their valley between two hills
    assert found.ripples_x.count == 6
    assert found.ripples_x.depth == pytest.approx(
        2 * LEFT * AMPLITUDE * make_result(65).scales.film_thickness, rel=0.1
    )
    assert found.ripples_y.count == 0


def test_the_micro_film_is_the_rough_film_less_the_smooth_one(rough, smooth):
    ripples = micro_film(rough, smooth)
    assert ripples.by_reference
    assert np.abs(ripples.film).max() == pytest.approx(
        (LEFT + CARRIED) * AMPLITUDE * rough.scales.film_thickness, rel=0.02
    )
    assert ripples.pressure.max() == pytest.approx(PRESSURE * rough.scales.hertz_pressure)


def test_a_filter_replaces_a_missing_reference_run(rough, smooth):
    by_reference, by_filter = micro_film(rough, smooth), micro_film(rough)
    assert not by_filter.by_reference
    assert typical_wavelength(rough) == pytest.approx(
        # central differences of a wave on ten nodes are 5 % too flat
        WAVELENGTH * rough.scales.half_width_x,
        rel=0.07,
    )
    middle = np.ix_(np.abs(rough.scaled.y) < 0.4, np.abs(rough.scaled.x) < 0.4)
    one, other = by_reference.pressure[middle], by_filter.pressure[middle]
    assert np.corrcoef(one.ravel(), other.ravel())[0, 1] > 0.98


def test_films_on_different_grids_are_not_compared(rough, result):
    with pytest.raises(InputError, match="one grid"):
        micro_film(rough, result)


def test_the_smooth_reference_is_a_steady_case(rough):
    reference = smooth_reference(rough.problem)
    assert ContactProblem.model_validate(reference.model_dump(mode="json")) == reference
    assert not reference.is_rough
    assert reference.contact == rough.problem.contact
    with pytest.raises(InputError, match="no roughness"):
        smooth_reference(reference)


def test_the_effect_is_rough_over_smooth_and_survives_a_file(rough, smooth, tmp_path):
    effect = roughness_effect(rough, smooth)
    assert effect.central == 1.0  # the numbers of the fixture
    assert effect.largest_pressure == pytest.approx(
        rough.scaled.pressure.max() / smooth.scaled.pressure.max()
    )
    assert effect.traction is None
    assert effect.smooth_h_central_m == smooth.film.central
    save(rough, tmp_path / "rough.nc", extra={"roughness_effect": asdict(effect)})
    block = load_summary(tmp_path / "rough.nc")["roughness_effect"]
    assert from_block(RoughnessEffect, block) == effect


@pytest.mark.parametrize("block", [None, {}, {"central": 1.0}, {"central": "x"}, 3])
def test_without_a_whole_comparison_there_is_no_effect(block):
    assert from_block(RoughnessEffect, block) is None
    assert from_block(ThermalEffect, block) is None


def test_the_block_of_the_summary_has_si_and_ratios(rough, smooth):
    block = roughness_block(rough_film(rough, smooth))
    assert block["waves"][0]["film_ratio"] == pytest.approx(LEFT)
    assert rough.summary()["roughness"]["composite_sq_m"] == block["composite_sq_m"]
    assert block["wave_notes"] == []
    assert smooth.summary()["roughness"] is None


def test_theory_is_null_where_it_does_not_hold(rough):
    heated = replace(rough, problem=rough.problem.model_copy(update={"thermal": Thermal()}))
    block = heated.summary()["roughness"]
    assert block["waves"][0]["theory_film_ratio"] is None
    assert block["waves"][0]["theory_pressure_pa"] is None
    assert block["wave_notes"][0].startswith("no theory")


@pytest.mark.parametrize("half", [False, True])
def test_ripples_are_the_rms_about_a_parabola(half):
    x = np.linspace(-2.0, 2.0, 401)
    y = x[200:] if half else x
    wave = np.cos(40.0 * np.pi * x) + 0.0 * y[:, None]
    hertz = np.sqrt(np.maximum(0.0, 1.0 - x**2 - y[:, None] ** 2))
    film = 0.2 + 0.1 * x + 0.05 * y[:, None] ** 2 + 0.01 * wave
    circle = Ellipse(ellipticity=1.0, radius_ratio=1.0)
    found = ripples(x, y, film, hertz - 0.3 * wave, circle)
    assert found == pytest.approx((0.01 / math.sqrt(2.0), 0.3 / math.sqrt(2.0)), rel=0.02)
