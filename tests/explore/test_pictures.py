"""Pictures of the page: scales, ticks, maps that reproduce the field, numbers with their bars."""

import base64
import io
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import tehl
from tehl.api.problem import case_from_tables
from tehl.explore.axes import Scale, log_ticks, ticks
from tehl.explore.colour_map import (
    film_limits,
    film_picture,
    pressure_limits,
    pressure_picture,
    stress_limits,
    stress_picture,
    value_at,
)
from tehl.explore.curves import Point, line_charts, line_tops, swept_chart, values_on_line
from tehl.explore.numbers import numbers, value_of
from tehl.explore.shown import maps_of, shown
from tehl.io.templates import template_text
from tehl.report.explain import explain
from tests.cases import ball_tables

SIZE = (640.0, 560.0)


@pytest.fixture
def seen(result):
    return shown(result, explain(result.problem, result.options), view="fringes")


def test_ticks_are_round_and_inside():
    assert ticks(0.0, 1.0, 5) == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert ticks(-433.0, 310.0, 4) == pytest.approx([-400, -200, 0, 200])
    assert log_ticks(0.01, 30.0, 4) == pytest.approx([0.01, 0.1, 1, 10])
    assert ticks(1.0, 1.0, 5) == []


@pytest.mark.parametrize("is_log", [False, True])
def test_a_scale_is_its_own_inverse(is_log):
    scale = Scale(2.0, 50.0, 400.0, 20.0, is_log)
    for value in (2.0, 7.5, 50.0):
        assert scale.data(scale(value)) == pytest.approx(value)


def test_the_image_has_the_film_in_its_colours(seen):
    limits = film_limits(seen.maps)
    picture = film_picture(seen.maps, limits, SIZE)
    image = Image.open(io.BytesIO(base64.b64decode(picture.image.partition(",")[2])))
    indices = np.asarray(image)
    frame = picture.frame
    row = round((frame.y(0.0) - frame.y.end) / frame.place[3] * (indices.shape[0] - 1))
    column = round((frame.x(0.0) - frame.x.start) / frame.place[2] * (indices.shape[1] - 1))
    film = limits.low * (limits.high / limits.low) ** (indices[row, column] / 255.0)
    assert film == pytest.approx(seen.maps.central, rel=0.01)  # one of 256 colours


def test_the_ground_around_the_contact_has_no_colour(seen):
    picture = film_picture(seen.maps, film_limits(seen.maps), SIZE)
    image = Image.open(io.BytesIO(base64.b64decode(picture.image.partition(",")[2])))
    alpha = np.asarray(image.convert("RGBA"))[..., 3]
    rows, columns = alpha.shape
    frame = picture.frame
    row = round((frame.y(0.0) - frame.y.end) / frame.place[3] * (rows - 1))
    column = round((frame.x(0.0) - frame.x.start) / frame.place[2] * (columns - 1))
    assert alpha[row, column] == 255
    assert alpha[0, 0] == alpha[-1, -1] == 0
    assert 0.4 < (alpha == 0).mean() < 0.9


def test_both_maps_have_contact_and_labels(seen):
    film = film_picture(seen.maps, film_limits(seen.maps), SIZE).overlay
    pressure = pressure_picture(seen.maps, pressure_limits(seen.maps), SIZE).overlay
    assert film.count('class="hertz"') == pressure.count('class="hertz"') == 1
    assert "minimum film" in film
    assert "minimum film" not in pressure
    assert "pressure [GPa]" in pressure


def test_the_value_under_the_pointer_is_that_of_the_field(seen):
    maps = seen.maps
    row, column = len(maps.y) // 2, len(maps.x) // 3
    found = value_at(maps.x, maps.y, maps.film, float(maps.x[column]), float(maps.y[row]))
    assert found == pytest.approx(float(maps.film[row, column]), rel=1e-6)
    assert value_at(maps.x, maps.y, maps.film, 1e9, 0.0) is None


def test_a_turned_ellipse_is_narrower_on_the_centre_line_than_as_a_whole(seen):
    turned = replace(seen.maps, skew=0.6)
    assert turned.half_width == pytest.approx(0.8 * turned.half_widths[0])
    assert seen.maps.half_width == seen.maps.half_widths[0]


def test_the_interferogram_is_an_image_of_bytes(seen):
    assert seen.fringes.dtype == np.uint8
    assert seen.fringes.shape[2] == 3


def test_the_stress_is_drawn_below_the_surface_where_it_is_asked_for(result):
    found = shown(result, explain(result.problem, result.options), view="stress")
    deep = found.stress
    body = result.with_stress().stress_numbers.worse
    assert deep.shear.max() == pytest.approx(body.shear * 1e-9, rel=1e-2)
    row = int(deep.shear.max(axis=1).argmax())
    assert deep.z[row] == pytest.approx(-1e6 * body.shear_depth, rel=0.1)
    picture = stress_picture(deep, found.maps, stress_limits(deep), SIZE)
    assert picture.image.startswith("data:image")
    assert f"below surface {body.body}" in picture.overlay
    assert picture.frame.y(-10.0) > picture.frame.y(0.0)
    assert shown(result, explain(result.problem, result.options)).stress is None


def test_centre_lines_and_sweeps_are_drawings(seen):
    charts = line_charts(seen, SIZE, line_tops(seen.lines))
    assert [chart.overlay.count("<svg") for chart in charts] == [1, 1]
    points = [Point(1.0, 2.0, 0.1), Point(10.0, None), Point(100.0, 3.0)]
    drawing = swept_chart(points, ("speed", "film"), SIZE, (1.0, 100.0)).overlay
    assert drawing.count('class="point"') == 2
    assert drawing.count('class="whisker"') == 1
    assert drawing.count('class="minimum"') == 1


def test_film_and_pressure_on_a_centre_line_are_read_under_the_pointer(seen):
    charts = line_charts(seen, SIZE, line_tops(seen.lines))
    frame = charts[0].frame
    words = values_on_line(seen.lines, charts, frame.x(0.0), 100.0)
    assert words.startswith("x = 0 µm:  h = ")
    assert f"h = {seen.maps.central:.4g} nm" in words
    below = charts[1].frame.x(0.0), frame.height + 9.0
    assert values_on_line(seen.lines, charts, *below).startswith("y = 0")
    assert values_on_line(seen.lines, charts, 2.0, 100.0) == ""


def test_numbers_are_those_of_the_result_with_bars_and_formulas(result):
    explanation = explain(result.problem, result.options)
    found = numbers(result, explanation)
    film = value_of(found, "h_central")
    assert film.value == result.film.central * 1e9
    assert film.error == result.errors.central
    assert film.formulas[0][1] == pytest.approx(explanation.films[0].central_m * 1e9)
    assert value_of(found, "p_max").formulas[0][0] == "Hertz"
    assert value_of(found, "t_max").value is None
    assert value_of(found, "t_max").remark


def test_the_dry_contact_of_a_roller_is_a_strip_to_its_ends():
    case, _ = case_from_tables(tomllib.loads(template_text("roller")))
    found = tehl.solve(case, tehl.Options(points=65))
    maps = maps_of(found)
    half, far = maps.half_widths
    assert half == pytest.approx(1e6 * found.scales.half_width_x)
    at = half * np.sqrt(1.0 - (maps.window[1][1] / far) ** 2)  # of the rim, at the end
    assert at == pytest.approx(half, rel=1e-3)
    y, *_, dry = shown(found, explain(case, found.options)).lines.y
    at = np.interp(0.8e6 * found.scales.half_width_y, y, dry)
    assert at > 0.9 * dry.max()  # 0.6 on an ellipse


def test_a_line_contact_is_a_strip_of_equal_lines():
    contact = {"type": "line", "radius": 0.02, "load_per_length": "200 N/mm"}
    problem = tehl.ContactProblem.model_validate(
        ball_tables(contact=contact | {"entrainment_speed": 1.5})
    )
    result = tehl.solve(problem, tehl.Options(points=257))
    found = shown(result, explain(problem, result.options), view="fringes")
    assert found.fringes is not None
    np.testing.assert_array_equal(found.maps.film[0], found.maps.film[-1])
    for draw, limits in ((film_picture, film_limits), (pressure_picture, pressure_limits)):
        assert draw(found.maps, limits(found.maps), SIZE).image.startswith("data:image")
    assert found.lines.y[1] == pytest.approx([found.maps.central] * 2, rel=1e-3)
    assert len(line_charts(found, SIZE, line_tops(found.lines))) == 2
