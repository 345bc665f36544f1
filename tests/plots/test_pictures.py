"""Pictures: what must be drawn is drawn, and nothing global is touched."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from matplotlib.text import Text

from tehl import plots
from tehl.base.errors import InputError
from tehl.io.store import save
from tehl.plots import PICTURES
from tehl.plots.frame import write_png
from tehl.plots.maps import film_levels
from tehl.result.solution import Status
from tests.fixtures_result import CASE, make_result
from tests.fixtures_transient import make_transient

MAPS = ("film_map", "pressure_map", "interferogram")


def texts(figure) -> str:
    return " | ".join(artist.get_text() for artist in figure.findobj(Text))


@pytest.mark.parametrize("name", MAPS)
def test_maps_show_the_contact_in_equal_aspect(result, name):
    figure = getattr(plots, name)(result)
    axes = figure.axes[0]
    rims = [patch for patch in axes.patches if isinstance(patch, Ellipse)]
    assert len(rims) == 1
    assert rims[0].width == pytest.approx(2e6 * result.scales.half_width_x)
    assert axes.get_aspect() == 1.0
    assert "µm" in axes.get_xlabel()


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize(("radius_y", "word"), [(0.4, "compressed"), (0.004, "stretched")])
def test_maps_of_slender_contacts_are_stretched_and_say_so(name, radius_y, word):
    contact = CASE["contact"] | {"radius_x": 0.02, "radius_y": radius_y}
    del contact["radius"]
    axes = getattr(plots, name)(make_result(case={**CASE, "contact": contact})).axes[0]
    axes.figure.draw_without_rendering()
    place = axes.get_position()
    shape = place.height * axes.figure.get_figheight() / (place.width * axes.figure.get_figwidth())
    assert 0.6 < shape < 1.65
    assert word in axes.get_ylabel()


def test_no_label_of_a_map_is_cut(tmp_path):
    """The size of axes with a fixed aspect is known only after a first layout."""
    contact = CASE["contact"] | {"radius_x": 0.02, "radius_y": 0.036}
    del contact["radius"]
    picture = plots.film_map(make_result(case={**CASE, "contact": contact}))
    write_png(picture, tmp_path / "film.png", 100)
    width, height = picture.get_size_inches()
    drawn = picture.get_tightbbox()
    assert drawn.x0 >= 0.0
    assert drawn.y0 >= 0.0
    assert drawn.x1 <= width
    assert drawn.y1 <= height


@pytest.mark.parametrize("draw", PICTURES.values(), ids=PICTURES)
def test_each_picture_names_the_case_and_its_groups(result, draw):
    words = texts(draw(result))
    assert "Ball on disc" in words
    assert "M = 75.6" in words


@pytest.mark.parametrize("draw", PICTURES.values(), ids=PICTURES)
def test_each_picture_of_a_failure_carries_a_banner(stalled, draw):
    assert "NOT CONVERGED: stalled: grid too coarse" in texts(draw(stalled))


def test_dollar_signs_in_a_title_are_not_a_formula(result):
    problem = result.problem.model_copy(update={"title": "costs $5 and $6 \\frac"})
    figure = plots.film_map(replace(result, problem=problem))
    figure.canvas.draw()


def test_contour_levels_lie_close_in_the_contact():
    inner, outer = film_levels(0.12, 0.24)
    assert inner.min() > 0.12
    assert inner.max() <= 0.264
    assert outer.max() <= 0.72
    assert np.diff(inner).max() < np.diff(outer).min()


def test_centre_lines_draw_film_over_the_dry_contact(result):
    labels = [line.get_label() for axes in plots.centre_lines(result).axes for line in axes.lines]
    assert labels.count("film") == labels.count("dry Hertz") == 2


def test_a_film_with_holes_is_still_drawn(stalled):
    film = stalled.scaled.film.copy()
    film[30:34, 30:50] = -0.1
    fields = replace(stalled.scaled, film=film, pressure=np.zeros_like(film))
    broken = replace(stalled, scaled=fields)
    for draw in PICTURES.values():
        draw(broken).draw_without_rendering()


def test_a_non_finite_state_is_still_drawn(stalled):
    film = np.full_like(stalled.scaled.film, np.nan)
    fields = replace(stalled.scaled, film=film, pressure=film)
    numbers = replace(stalled.film_scaled, central=np.nan, minimum=np.nan)
    broken = replace(stalled, scaled=fields, film_scaled=numbers)
    for draw in PICTURES.values():
        draw(broken).draw_without_rendering()


ONE_AXES = (
    *("film_map", "pressure_map", "shear_stress_map", "heights_map", "mid_film_temperature"),
    *("interferogram", "film_distribution", "residual_history"),
)


@pytest.mark.parametrize("name", ONE_AXES)
def test_a_picture_with_one_axes_draws_into_given_ones(name, result, rough, sheared, thermal):
    of = {"shear_stress_map": sheared, "heights_map": rough, "film_distribution": rough}
    run = thermal if "temperature" in name else of.get(name, result)
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert getattr(plots, name)(run, ax=right) is figure
    assert right.has_data()
    assert not left.has_data()
    assert "Ball on disc" not in texts(figure)
    failed = replace(run, status=Status(kind="stalled", cause="grid_too_coarse"))
    getattr(plots, name)(failed, ax=left)
    assert "NOT CONVERGED: stalled: grid too coarse" in texts(figure)
    figure.draw_without_rendering()


def test_each_picture_leaves_out_its_title(thermal, rough):
    runs = (replace(thermal, shear=None), False), (rough, None), (make_transient(), None)
    for run, title in runs:
        for draw in plots.pictures_of(run).values():
            assert draw(run, title=title)._suptitle is None


def test_a_notebook_shows_a_picture_as_it_is(result):
    picture = plots.film_map(result)
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert not hasattr(picture, "number")  # pyplot, which would show it again, does not know it


@pytest.mark.parametrize(
    ("ending", "begin"),
    [pytest.param("pdf", b"%PDF", marks=pytest.mark.slow), ("svg", b"<?xml")],
)
def test_chosen_pictures_are_saved_as_vectors(result, tmp_path, ending, begin):
    pictures = plots.chosen(plots.pictures_of(result), ["residuals", "film"])
    paths = plots.save_all(result, tmp_path, pictures=pictures, ending=ending)
    assert [path.name for path in paths] == [f"residuals.{ending}", f"film.{ending}"]
    assert all(path.read_bytes().startswith(begin) for path in paths)
    with pytest.raises(InputError, match="picture heights: unknown; the result has film, "):
        plots.chosen(plots.pictures_of(result), ["heights"])


def test_an_empty_history_is_reported(result):
    assert "no cycles" in texts(plots.residual_history(replace(result, history=())))


def test_a_picture_drawn_once_is_that_of_matplotlib(result, tmp_path):
    plots.save_picture(plots.centre_lines(result), tmp_path / "once.png", dpi=50)
    plots.centre_lines(result).savefig(tmp_path / "twice.png", dpi=50)
    assert (tmp_path / "once.png").read_bytes() == (tmp_path / "twice.png").read_bytes()


def test_all_pictures_are_saved(result, tmp_path):
    paths = plots.save_all(result, tmp_path / "new" / "folder", dpi=40)
    assert [path.stem for path in paths] == list(PICTURES)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in paths)
    assert len(list((tmp_path / "new" / "folder").iterdir())) == len(paths)


def test_plotting_imports_no_compiler_and_no_global_pyplot(result, tmp_path):
    save(result, tmp_path / "out.nc")
    code = (
        "import sys, tehl.plots; from tehl.io.store import load; "
        "tehl.plots.film_map(load(sys.argv[1])); "
        "print([m for m in ('numba', 'matplotlib.pyplot', 'xarray') if m in sys.modules])"
    )
    run = [sys.executable, "-c", code, str(tmp_path / "out.nc")]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_both_minima_of_a_symmetric_contact_are_marked(result):
    axes = plots.film_map(result).axes[0]
    marks = next(line for line in axes.lines if line.get_label() == "minimum film")
    assert marks.get_ydata().sum() == pytest.approx(0.0)
    assert len(marks.get_ydata()) == 2


def test_the_colours_of_the_film_span_the_contact(result):
    mesh = plots.film_map(result).axes[0].images[0]
    low, high = mesh.get_clim()
    assert high == pytest.approx(1.6e6 * result.film.central)
    assert 0.9e6 * result.minimum_film_thickness < low < 1e6 * result.film.minimum_node
