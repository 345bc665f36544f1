"""The lines that a solve prints."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tehl.cli.reference_runs import Comparisons
from tehl.cli.text import as_text, failure_text
from tehl.contact.heat import Thermal
from tehl.estimate.inlet_heating import InletFactor
from tehl.post.micro_film import roughness_effect
from tehl.post.roughness import rough_film
from tehl.post.thermal_effect import ThermalEffect
from tehl.report.page import report_text
from tehl.report.readable import length
from tehl.result.bars import Estimate
from tehl.result.solution import Hint, Status
from tests.fixtures_result import CASE
from tests.fixtures_rough import make_rough
from tests.fixtures_transient import passing


def test_a_film_reads_in_the_unit_that_explain_takes(result):
    thick = replace(result.film_scaled, central=4e-6 / result.scales.film_thickness)
    shown = as_text(replace(result, film_scaled=thick))
    assert f"minimum film     {length(result.film.minimum)} " in shown
    assert "central film     4 um " in shown


def test_a_certified_value_shows_the_parts_of_its_bar(result):
    name, unit = ("nm", 1e9) if result.film.central < 1e-6 else ("um", 1e6)
    unit *= result.scales.film_thickness
    bar = Estimate(
        value=400 / unit,
        uncertainty=5 / unit,
        discretisation=4 / unit,
        domain=3 / unit,
        observed_order=2.0,
        values=(1.0, 1.0, 1.0),
    )
    shown = as_text(replace(result, uncertainty={"film_central": bar}))
    assert f"certified 400 +- 5 {name} (grid 4, domain 3)" in shown


def test_an_isothermal_run_has_no_rows_of_heat(result):
    shown = as_text(result)
    assert not any(word in shown for word in ("temperature", "traction", "heat"))


def test_a_thermal_run_has_rows_of_temperature_traction_and_balance(thermal):
    lines = {line[2:19].strip(): line[19:] for line in as_text(thermal).splitlines()[1:]}
    found, traction = thermal.temperature, thermal.traction
    assert f"rise {found.film_rise_max:.4g} K" in lines["film temperature"]
    assert f"{found.surface_1_rise_max:.4g} K and" in lines["surfaces"]
    assert f"error {100 * thermal.heat.balance.error:.2g} %, and " in lines["heat balance"]
    for value in (traction.surface_1, traction.mid_film, traction.surface_2):
        assert f"{value:.4g}" in lines["traction"]


def test_a_traction_that_no_oil_can_carry_is_doubted(sheared):
    assert "more than any oil can" not in as_text(sheared)
    shear = replace(sheared.shear, mid_film=5 * sheared.shear.mid_film)
    shown = as_text(replace(sheared, shear=shear))
    assert "the shear law is newtonian, state lubricant.shear" in shown


def test_the_effect_of_heat_names_its_formulas(thermal):
    effect = ThermalEffect(
        central=0.93,
        minimum=0.91,
        isothermal_h_central_m=1e-7,
        isothermal_h_min_m=5e-8,
        inlet_factors=(InletFactor(formula="Wilson-Sheu", source="", factor=0.95, remarks=()),),
    )
    shown = as_text(thermal, Comparisons(heat=effect))
    assert "0.9300 of the central, 0.9100 of the minimum" in shown
    assert "0.9500 Wilson-Sheu" in shown
    bare = Comparisons(heat=replace(effect, inlet_factors=()))
    assert "formula" not in as_text(thermal, bare)


def test_a_rough_run_has_lambda_its_regime_and_the_rest_of_its_wave(rough, smooth):
    lines = {line[2:19].strip(): line[19:] for line in as_text(rough).splitlines()[1:]}
    found = rough.roughness
    by_both = f"{found.lambda_central:.3g} by the central film, {found.lambda_minimum:.3g} by the"
    assert lines["lambda"] == f"{by_both} minimum film: full film (at least 3, Tallian 1967)"
    assert " at 45 deg: " in lines["waves left"]
    assert "20 % in the film (theory" in as_text(
        rough, Comparisons(rough_film=rough_film(rough, smooth))
    )
    assert "roughness" not in as_text(smooth)


def test_a_heated_wave_has_no_theory_and_a_line_why(rough):
    heated = replace(rough, problem=rough.problem.model_copy(update={"thermal": Thermal()}))
    lines = as_text(heated).splitlines()
    here = next(n for n, line in enumerate(lines) if "waves left" in line)
    assert "(theory" not in lines[here]
    assert "flattens it)" in lines[here]
    assert lines[here + 1].strip().startswith("no theory: it is for isothermal Newtonian films")


def test_a_wave_that_is_too_long_has_a_line(rough):
    notes = replace(rough.roughness, waves=(), wave_notes=("1 mm is too long",))
    assert "  waves left       1 mm is too long" in as_text(rough, Comparisons(rough_film=notes))


def test_crests_along_the_entrainment_are_determined_by_the_inlet():
    shown = as_text(make_rough(angle=0.5 * math.pi))
    assert "determined by the inlet" in shown
    assert " at 90 deg: " in shown


def test_the_effect_of_roughness_includes_traction_if_there_is_sliding(rough, smooth):
    effect = roughness_effect(rough, smooth)
    shown = as_text(rough, Comparisons(roughness=effect))
    assert "1.0000 of the central" in shown
    assert "traction" not in shown
    sliding = Comparisons(roughness=replace(effect, traction=1.25))
    assert "1.2500 of the traction" in as_text(rough, sliding)


def test_a_case_without_a_title_has_one(result):
    bare = replace(result, problem=result.problem.model_copy(update={"title": ""}))
    assert as_text(bare).startswith("Lubricated contact - ")


def test_a_film_that_is_not_positive_has_no_value(result):
    thin = replace(result.film_scaled, central=-0.01, minimum=-0.02, minimum_node=-0.02)
    status = Status(kind="not_converged", cause="film_not_positive")
    bad = replace(result, film_scaled=thin, status=status)
    shown = as_text(bad)
    assert shown.count("none: the last iterate is not positive") == 2
    assert "H = -" not in shown
    film = bad.summary()["film"]
    assert film["h_min_m"] is film["H_central"] is film["H_min_moes"] is None


def test_a_grid_error_above_the_value_itself_is_a_percentage(result):
    errors = replace(result.errors, discretisation_minimum=1.3)
    assert "error about 130 %" in as_text(replace(result, errors=errors))


def test_an_error_far_above_the_value_has_no_digits(result):
    errors = replace(result.errors, discretisation_minimum=5.9e5)
    shown = as_text(replace(result, errors=errors))
    assert "error above 1000 %" in shown


def test_a_failure_has_its_hint_in_a_second_line():
    status = Status(
        kind="stalled", cause="grid_too_coarse", message="too coarse", hint=Hint("take 513")
    )
    assert failure_text(status, None) == (
        "tehl: not converged (grid_too_coarse): too coarse\nhint: take 513"
    )
    assert failure_text(Status(kind="diverged"), "NaN").endswith("(diverged): NaN")


@pytest.mark.usefixtures("no_pictures")
def test_a_certified_run_reports_how_its_grids_ended(result):
    message = "Grids of the error bars: 65 x 65 too coarse for the film."
    assert message in as_text(replace(result, status=Status(kind="converged", message=message)))
    assert message in report_text(replace(result, status=Status(kind="converged", message=message)))


def test_sliding_that_changes_has_a_row_of_its_own():
    transient = {"duration": 1e-4, "sliding_speed": [[0.0, -1.0], [1e-4, 2.0]]}
    run = passing(CASE | {"transient": transient})
    sliding = np.linspace(-1.0, 2.0, run.history.time.size)
    run = replace(run, history=replace(run.history, sliding=sliding))
    assert "sliding          -1.5 to 3   (at the start -1.5) m/s" in as_text(run)
    assert "SRR" not in as_text(run)
    assert "SRR = 0.25" in as_text(passing(CASE | {"transient": {"duration": 1e-4}}))


def test_friction_is_shown_where_only_the_course_slides():
    contact = CASE["contact"] | {"slide_roll_ratio": 0.0}
    transient = {"duration": 1e-4, "slide_roll_ratio": [[0.0, 0.0], [1e-4, 1.0]]}
    summits = {"model": "greenwood-tripp", "summit_radius": "10 um", "rms": "0.2 um"}
    summits |= {"summit_density": "2e10 1/m^2"}
    run = passing(CASE | {"contact": contact, "transient": transient, "asperities": summits})
    history = replace(run.history, sliding=np.linspace(0.0, 1.0, run.history.time.size))
    assert "friction  " in as_text(replace(run, history=history))
