"""Pictures of the stress below the surfaces: what they show, and the movie of a passing dent."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from tehl.base.errors import InputError
from tehl.contact.stress import Stress
from tehl.plots import pictures_of
from tehl.plots.animation import Movie
from tehl.plots.stress import DEEPEST_SHOWN, dress, moving_section, stress_section
from tehl.post.stress.moving import moving_stress
from tests.fixtures_result import make_result
from tests.fixtures_transient import make_transient

SETTINGS = Stress(depths=10)


def asking(result):
    return replace(result, problem=result.problem.model_copy(update={"stress": SETTINGS}))


def test_the_section_has_the_largest_shear_and_profiles_of_the_dry_contact():
    found = asking(make_result(65)).with_stress()
    assert "stress" in pictures_of(found)
    axes = stress_section(found).axes
    body = found.stress_numbers.worse
    lines = {line.get_label(): line for line in axes[1].lines}
    assert {"von Mises", "shear", "dry smooth"} <= set(lines)
    shear, depth = lines["shear"].get_data()
    assert shear.max() == pytest.approx(body.shear * 1e-9, rel=1e-2)
    assert depth[np.argmax(shear)] == pytest.approx(body.shear_depth * 1e6, rel=0.2)
    assert axes[0].get_ylim()[0] > axes[0].get_ylim()[1]  # the depth points down


@pytest.mark.parametrize(("length", "stretch"), [(2.0, 1.0), (60.0, 30.0)])
def test_sections_along_a_long_contact_are_stretched_to_be_read(result, length, stretch):
    axes, reach = Figure().subplots(), DEEPEST_SHOWN * result.scales.half_width_x * 1e6
    dress(axes, result, (-0.5 * length * reach, 0.5 * length * reach), "y")
    assert axes.get_aspect() == pytest.approx(stretch)
    assert ("stretched" in axes.get_ylabel()) == (stretch > 1.0)


def test_a_result_without_stresses_says_how_to_get_them(result):
    assert "stress" not in pictures_of(result)
    with pytest.raises(InputError, match="solve --stress"):
        stress_section(result)


def test_the_movie_shows_the_section_of_each_stored_field():
    run = replace(make_transient(), start=asking(make_transient().start))
    assert "moving_stress" in pictures_of(run)
    seen = moving_stress(run, 2)
    movie = Movie(run, dpi=40, stress=2)
    last = len(movie.steps) - 1
    movie.show(last)
    shown = movie.image.get_array()
    assert float(shown.max()) == pytest.approx(float(seen.plane[last].max()) * 1e-9, rel=0.05)
    history = moving_section(run).axes[1].lines[0].get_ydata()
    first = moving_stress(run, 1)
    np.testing.assert_allclose(history, first.shear.max(axis=1) * 1e-9)
