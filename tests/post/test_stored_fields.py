"""Instants of a transient run, read like steady films."""

import numpy as np
import pytest

from tehl import InputError, solve_transient
from tehl.contact.options import Options
from tehl.estimate.wave_theory import drift_of_heights
from tehl.post.micro_film import micro_film
from tehl.post.roughness import area_below, rough_film
from tehl.post.transient import film_at, smooth_start
from tests.reference import DOMAIN
from tests.solver.test_transient import in_time, wave

OPTIONS = Options(points=65, domain=DOMAIN)


@pytest.fixture(scope="module")
def run():
    """A wave on each surface enters the contact in pure rolling."""
    return solve_transient(
        in_time(5.0, surface_1=wave(), surface_2=wave(0.005, phase=1.0)), OPTIONS
    )


def test_a_snapshot_has_the_fields_and_heights_of_its_time(run):
    last, film = film_at(run), run.frames.film[-1]
    np.testing.assert_allclose(last.film_thickness, film, rtol=1e-6)
    assert last.film_scaled.minimum == pytest.approx(float(film.min() / last.scales.film_thickness))
    np.testing.assert_allclose(
        last.heights.surface_1 + last.heights.surface_2, run.frames.height[-1], atol=1e-13
    )
    first, second = rough_film(last).sq
    assert second == pytest.approx(0.5 * first, rel=0.1)
    assert last.film_scaled.central == pytest.approx(
        run.history.film_central[-1] / last.scales.film_thickness, rel=1e-5
    )


def test_the_initial_film_is_the_smooth_reference_of_each_field(run):
    smooth = smooth_start(run)
    none, some = (micro_film(film_at(run, k), smooth) for k in (0, -1))
    middle = np.ix_(np.abs(run.start.scaled.y) < 0.4, np.abs(run.start.scaled.x) < 0.4)
    assert np.abs(none.film[middle]).max() < 1e-6 * run.history.film_central[0]
    assert 0.2 < np.abs(some.film[middle]).max() / np.abs(run.frames.height[-1]).max() < 1.1


def test_the_numbers_of_rough_films_are_those_of_the_snapshot(run):
    last = film_at(run)
    found = rough_film(last, smooth_start(run))
    assert found.lambda_central == pytest.approx(
        run.history.film_central[-1] / found.composite, rel=0.2
    )
    assert area_below(last, 2.0 * found.lambda_central * found.composite) == pytest.approx(1.0)


def test_a_field_that_was_not_stored_is_an_error(run):
    with pytest.raises(InputError, match="frame = 3: the run has 3 stored fields"):
        film_at(run, 3)


def test_a_run_with_a_rough_start_has_no_reference():
    standing = in_time(0.2, surface_1=wave(), transient={"start": "standing"})
    assert smooth_start(solve_transient(standing, OPTIONS)) is None


def test_a_wave_found_in_a_map_moves_with_its_surface(tmp_path, run):
    """In pure rolling the inlet decides of it, as of the same wave by its formula."""
    units = run.start.scales
    pixel = 1.5 * units.half_width_x / 32.0
    heights = 0.01 * units.film_thickness * np.cos(np.arange(64) * np.pi / 16.0)
    np.save(tmp_path / "wave.npy", np.tile(heights, (64, 1)))
    table = {"type": "map", "file": str(tmp_path / "wave.npy"), "unit": "m", "level": "none",
             "pixel": pixel, "outside": "periodic"}  # fmt: skip
    moving = in_time(5.0, surface_1={"roughness": table})
    assert drift_of_heights(moving) == (0.0, 0.0)
    assert drift_of_heights(in_time(1.0, slide=0.5, surface_1={"roughness": table}))[0] > 0.0
    both = in_time(1.0, slide=0.5, surface_1={"roughness": table}, surface_2={"roughness": table})
    assert drift_of_heights(both) is None
    steady = moving.model_copy(update={"transient": None})
    assert drift_of_heights(steady) == (-units.speed, 0.0)
