"""Pictures of shear and heat: drawn where they apply, with the right numbers, for any state."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.contour import ContourSet
from matplotlib.patches import Ellipse
from matplotlib.text import Text

from tehl import plots
from tehl.base.errors import InputError
from tehl.plots import PICTURES, pictures_of
from tests.fixtures_result import CASE, make_result
from tests.fixtures_thermal import with_heat, with_shear

OURS = {
    "shear_stress": plots.shear_stress_map,
    "temperature": plots.mid_film_temperature,
    "temperature_layers": plots.temperature_layers,
    "temperature_section": plots.temperature_section,
    "surface_heat": plots.surface_heat,
}


def texts(figure) -> str:
    return " | ".join(artist.get_text() for artist in figure.findobj(Text))


def test_an_isothermal_run_has_the_basic_pictures(result):
    assert list(pictures_of(result)) == list(PICTURES)


def test_a_sliding_film_shows_its_stress(sheared):
    assert set(pictures_of(sheared)) - set(PICTURES) == {"shear_stress"}


def test_pure_rolling_has_no_stress_to_show(sheared):
    contact = sheared.problem.contact.model_copy(update={"slide_roll_ratio": 0.0})
    rolling = sheared.problem.model_copy(update={"contact": contact})
    assert list(pictures_of(replace(sheared, problem=rolling))) == list(PICTURES)


def test_a_thermal_run_has_all_pictures(thermal):
    assert list(pictures_of(thermal)) == [*PICTURES, *OURS]


def test_all_pictures_of_heat_are_saved(thermal, tmp_path, monkeypatch):
    monkeypatch.setattr("tehl.plots.PICTURES", {})
    paths = plots.save_all(thermal, tmp_path, dpi=40)
    assert [path.stem for path in paths] == list(OURS)


@pytest.mark.parametrize("draw", OURS.values(), ids=OURS)
def test_each_picture_names_the_case_and_its_groups(thermal, draw):
    words = texts(draw(thermal))
    assert "Ball on disc" in words
    assert "M = 75.6" in words


@pytest.mark.parametrize("draw", OURS.values(), ids=OURS)
def test_an_isothermal_run_raises_an_input_error(result, draw):
    with pytest.raises(InputError, match="to draw"):
        draw(result)


@pytest.mark.parametrize("draw", OURS.values(), ids=OURS)
def test_a_non_finite_state_is_still_drawn(thermal, stalled, draw):
    field = np.full_like(thermal.scaled.film, np.nan)
    broken = replace(
        thermal,
        status=stalled.status,
        scaled=replace(thermal.scaled, film=field, pressure=field),
        film_scaled=replace(thermal.film_scaled, central=np.nan, minimum=np.nan),
        shear=replace(thermal.shear, mid_film=field, across=field),
        heat=replace(
            thermal.heat,
            temperature=np.full_like(thermal.heat.temperature, np.nan),
            flux_1=field,
            flux_2=field,
        ),
    )
    figure = draw(broken)
    assert "NOT CONVERGED" in texts(figure)
    figure.draw_without_rendering()


@pytest.mark.parametrize("draw", OURS.values(), ids=OURS)
@pytest.mark.parametrize("radius_y", [0.005, pytest.param(0.2, marks=pytest.mark.slow)])
def test_slender_and_wide_contacts_are_drawn(draw, radius_y):
    contact = {k: v for k, v in CASE["contact"].items() if k != "radius"}
    case = {**CASE, "contact": contact | {"radius_x": 0.02, "radius_y": radius_y}}
    draw(with_heat(make_result(33, case=case), layers=8)).draw_without_rendering()


@pytest.mark.parametrize("name", ["mid_film_temperature", "shear_stress_map"])
def test_maps_show_the_contact_in_equal_aspect(thermal, name):
    axes = getattr(plots, name)(thermal).axes[0]
    assert axes.get_aspect() == 1.0
    assert len([patch for patch in axes.patches if isinstance(patch, Ellipse)]) == 1


def test_layers_share_one_scale_of_colours(thermal):
    figure = plots.temperature_layers(thermal)
    maps = [axes for axes in figure.axes if axes.patches]
    limits = {mesh.get_clim() for axes in maps for mesh in axes.collections[:1]}
    assert len(maps) == 6
    assert limits.pop() == pytest.approx((0.0, thermal.temperature.film_rise_max))
    assert not limits
    assert {axes.get_aspect() for axes in maps} == {1.0}
    assert "mid-film" in texts(figure)


def test_the_section_lies_in_the_film(thermal):
    upper, lower = plots.temperature_section(thermal).axes[:2]
    assert upper.get_ylim() == (0.0, 1.0)
    places = lower.collections[0].get_coordinates()
    film = lower.lines[0].get_ydata()
    assert np.array_equal(places[0, :, 1], np.zeros(film.size))
    assert np.array_equal(places[-1, :, 1], film)
    assert lower.get_ylabel() == "z [nm]"


def test_surface_heat_shows_fluxes_in_megawatts(thermal):
    lower = plots.surface_heat(thermal).axes[1]
    flux = {line.get_label(): line.get_ydata() for line in lower.lines}
    row = int(np.argmin(np.abs(thermal.scaled.y)))
    assert flux["into surface 1"] == pytest.approx(thermal.heat.flux_1[row] * 1e-6)
    assert "MW" in lower.get_ylabel()


def test_centre_lines_of_a_thermal_run_show_temperatures(thermal, result):
    assert len(plots.centre_lines(result).axes) == 4
    figure = plots.centre_lines(thermal)
    labels = [line.get_label() for axes in figure.axes for line in axes.lines]
    assert len(figure.axes) == 6
    assert labels.count("mid-film") == labels.count("surface 2") == 2
    assert labels.count("film") == 2


def test_the_history_shows_the_temperature_change_on_a_separate_axis_in_kelvin(thermal, result):
    left, right = plots.residual_history(thermal).axes
    assert "K" not in left.get_ylabel()
    assert "[K]" in right.get_ylabel()
    assert right.lines[0].get_ydata()[-1] == thermal.history[-1].temperature_change
    low, high = np.array(right.get_ylim()) / np.array(left.get_ylim())
    assert low == pytest.approx(high)  # the same decades, so one grid serves both
    assert np.log10(low) == pytest.approx(round(np.log10(low)))
    assert len(plots.residual_history(result).axes) == 1


def test_grids_are_named_only_where_there_is_room(thermal):
    crowded = replace(thermal, history=thermal.history * 8)
    named = [text.get_text() for text in plots.residual_history(crowded).axes[0].texts]
    assert len(named) < 4


def overlaps(boxes) -> bool:
    return any(a.x1 > b.x0 for a, b in pairwise(sorted(boxes, key=lambda box: box.x0)))


def test_labels_of_the_layers_do_not_touch(thermal):
    figure = plots.temperature_layers(thermal)
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    lowest = [axes for axes in figure.axes if axes.get_xlabel() == "x [µm]"]
    assert len(lowest) == 3
    boxes = [
        label.get_window_extent(renderer)
        for axes in lowest
        for label in axes.get_xticklabels()
        if label.get_text() and axes.get_xlim()[0] <= label.get_position()[0] <= axes.get_xlim()[1]
    ]
    assert len(boxes) >= 6
    assert not overlaps(boxes)


def test_no_contour_is_drawn_where_the_rise_is_flat_at_zero(thermal):
    heat = thermal.heat
    colder = np.array(heat.temperature)
    colder[:, 0, 0] -= 5.0  # so that zero lies within the span
    figure = plots.mid_film_temperature(replace(thermal, heat=replace(heat, temperature=colder)))
    sets = figure.findobj(ContourSet)
    assert sets
    assert all(0.0 not in lines.levels for lines in sets)


def sliding(result, ratio):
    contact = result.problem.contact.model_copy(update={"slide_roll_ratio": ratio})
    return replace(result, problem=result.problem.model_copy(update={"contact": contact}))


def test_traction_is_drawn_as_friction_over_sliding(result):
    runs = [with_shear(sliding(result, ratio)) for ratio in (0.2, 0.1, 0.0)]
    runs += [with_heat(sliding(result, 0.1))]
    axes = plots.traction_curve(runs).axes[0]
    curves = {line.get_label(): line for line in axes.lines}
    assert set(curves) == {"thermal", "isothermal"}
    assert curves["isothermal"].get_xdata() == pytest.approx([0.0, 10.0, 20.0])
    assert curves["isothermal"].get_ydata()[1:] == pytest.approx(-runs[0].traction.mid_film)
    assert curves["thermal"].get_marker() != curves["isothermal"].get_marker()
    assert axes.get_xlim()[0] == 0.0


def test_a_table_is_drawn_as_well():
    table = {"slide_roll_ratio": [0.1, -0.1], "traction": [-0.03, 0.03]}
    line = plots.traction_curve(table).axes[0].lines[0]
    assert line.get_ydata() == pytest.approx([-0.03, 0.03])


def test_contacts_that_differ_have_separate_curves():
    table = {
        "slide_roll_ratio": [0.1, 0.2, 0.1, 0.2],
        "traction": [-0.03, -0.04, -0.05, -0.06],
        "thermal": [True] * 4,
        "case": ["a", "a", "b", "b"],
    }
    assert len(plots.traction_curve(table).axes[0].lines) == 2


@pytest.mark.parametrize("runs", [[], {"slide_roll_ratio": []}, {"traction": [], "SRR": []}])
def test_nothing_to_draw_raises_an_input_error(runs):
    with pytest.raises(InputError, match="no"):
        plots.traction_curve(runs)
