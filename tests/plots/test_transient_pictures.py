"""Pictures of a transient run: what they show, on which axes, and files that appear whole."""

import base64
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.plots import save_all, transient
from tehl.plots.animation import Movie, animate
from tehl.result.solution import Status
from tests.fixtures_result import CASE
from tests.fixtures_transient import make_certified, make_transient


def test_the_history_shows_the_numbers_of_each_step():
    run = make_transient()
    axes = transient.history(run).axes
    assert len(axes) == 3
    np.testing.assert_allclose(axes[0].lines[0].get_ydata(), run.history.film_central * 1e6)
    np.testing.assert_allclose(axes[1].lines[0].get_ydata(), run.history.pressure_max * 1e-9)


def test_error_bars_are_bands_around_the_curves():
    run = make_certified()
    panels = transient.history(run).axes
    assert [len(axes.collections) for axes in panels] == [2, 1, 0]
    corners = panels[1].collections[0].get_paths()[0].vertices[:, 1]
    highest = ((run.history.pressure_max[::4] + run.bars.pressure_max) * 1e-9).max()
    assert corners.max() == pytest.approx(highest)
    assert not transient.history(make_transient()).axes[0].collections


def test_a_load_that_changes_has_its_panel():
    run = make_transient()
    load = np.linspace(1.0, 1.2, len(run.history.time))
    changed = replace(run, history=replace(run.history, load=load))
    drawn = transient.history(changed).axes[3].lines[0].get_ydata()
    assert drawn[-1] == pytest.approx(1.2 * 80.0)


def test_the_film_axis_follows_a_contact_that_grows():
    """The gap beside a contact that begins with a tenth of its width is not the film in it."""
    run = make_transient()
    steps, x = run.history.time.size, run.start.scaled.x
    radius = np.linspace(1e-3, 1.0, steps)
    width = radius[:, None] ** (1.0 / 3.0)
    gap = np.maximum((x / width) ** 2 - 1.0, 0.0)
    profiles = replace(run.profiles, film=1e-7 + 1e-5 * gap)
    grown = replace(run, profiles=profiles, history=replace(run.history, radius=radius))
    left, *_ = transient.space_time(grown).axes
    assert left.collections[0].get_clim()[1] < 0.2
    still = replace(run, profiles=profiles)
    assert transient.space_time(still).axes[0].collections[0].get_clim()[1] > 10.0


def test_the_load_of_a_line_is_drawn_per_millimetre():
    contact = {key: CASE["contact"][key] for key in ("entrainment_speed", "slide_roll_ratio")}
    contact |= {"type": "line", "radius": "10 mm", "load_per_length": "80 N/mm"}
    line = ContactProblem.model_validate(CASE | {"contact": contact})
    run = make_transient()
    load = np.linspace(1.0, 1.2, len(run.history.time))
    changed = replace(
        run, history=replace(run.history, load=load), start=run.start.but(problem=line)
    )
    moment, axes = transient.history(changed, title=False).axes[3:5]
    assert moment.get_ylabel() == "rolling moment\n[N mm/m]"
    assert axes.get_ylabel() == "load [N/mm]"
    assert axes.lines[0].get_ydata()[0] == pytest.approx(80.0)


def test_paths_of_both_surfaces_meet_where_the_dent_is_in_the_middle():
    run = make_transient()
    axes = transient.space_time(run).axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    assert set(lines) == {"surface 1", "surface 2", "mean"}
    passing = 2e-4 / run.start.problem.motion.speed_1 * 1e6
    for line in lines.values():
        middle = np.interp(0.0, line.get_xdata(), line.get_ydata())
        assert middle == pytest.approx(passing, rel=1e-6)


def test_moments_are_those_in_which_the_dent_is_inside():
    run = make_transient()
    steps = transient.moments_of(run)
    assert len(steps) == 4
    place = -2e-4 + run.start.problem.motion.speed_1 * run.history.time[steps]
    assert np.abs(place).max() < 1.2 * run.start.scales.half_width_x
    picture = transient.moments(run, times=[0.0, float(run.history.time[-1])])
    assert len(picture.axes) == 4  # one for pressure and one for film in each panel


def test_the_body_lies_below_the_film():
    run = make_transient()
    lines = transient.CentreLines(run, Figure().add_subplot())
    for step in (0, 20, 40):
        assert (lines.ground + lines.heights[step]).max() < 0.0
        assert (lines.ground + lines.heights[step]).min() >= lines.bottom


def test_a_run_that_stopped_carries_a_banner():
    run = replace(make_transient(), status=Status(kind="stalled", cause="step_not_settled"))
    assert "NOT CONVERGED" in transient.passage(run).get_supxlabel()


def test_all_pictures_are_files(tmp_path):
    paths = save_all(make_transient(), tmp_path / "new", dpi=30)
    assert [path.name for path in paths] == [
        "history.png",
        "space_time.png",
        "moments.png",
        "passage.png",
    ]
    assert all(path.read_bytes()[:4] == b"\x89PNG" for path in paths)


def test_a_movie_shows_the_stored_fields():
    run = make_transient()
    movie = Movie(run, dpi=30)
    assert list(movie.steps) == list(run.frames.step)
    movie.show(2)
    step = run.frames.step[2]
    assert f"{run.history.time[step] * 1e6:.4g}" in movie.caption.get_text()
    np.testing.assert_allclose(
        movie.lines.film.get_ydata(), run.profiles.film[step, movie.lines.part] * 1e6
    )
    assert movie.pixels(0).shape == (222, 186, 3)


def test_a_run_without_fields_shows_its_line_at_all_steps():
    assert len(Movie(make_transient(frames=False), dpi=30).steps) == 61


def test_a_frame_rate_of_zero_raises_an_input_error(tmp_path):
    with pytest.raises(InputError, match="per_second = 0: must be positive"):
        animate(make_transient(), tmp_path / "film.gif", per_second=0)


def test_an_animated_page_holds_its_moments_and_needs_no_network(tmp_path):
    run = make_transient()
    problem = run.start.problem.model_copy(update={"title": "</title><b>bold</b> {braces}"})
    animate(replace(run, start=replace(run.start, problem=problem)), tmp_path / "run.html", dpi=30)
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    moments = json.loads(re.search(r"const moments = (\[.*?\]);", page)[1])
    assert len(moments) == len(run.frames.step)
    assert all(base64.b64decode(one).startswith(b"\x89PNG") for one in moments)
    assert not re.search(r"https?:|<link|src=\"(?!data)", page)
    assert "<b>" not in page
