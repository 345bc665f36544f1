"""What Python and notebooks show of results and explanations."""

from dataclasses import replace

import pytest

from tests.fixtures_transient import make_transient


def test_a_result_is_one_short_line(result, stalled):
    line = repr(result)
    assert line.startswith("<Result 'Ball on disc': converged, central film ")
    assert f"{result.film.minimum * 1e9:.4g} nm" in line
    assert "65 x 65 nodes" in line
    assert len(line) < 200
    assert "\n" not in line
    assert "stalled: grid too coarse" in repr(stalled)


def test_a_result_without_a_film_has_no_values(stalled):
    none = replace(stalled.film_scaled, minimum=-0.1)
    assert "minimum film none" in repr(replace(stalled, film_scaled=none))


def test_a_transient_result_shows_its_extremes():
    run = make_transient()
    assert repr(run).startswith("<TransientResult ")
    assert f"least minimum film {run.history.film_minimum.min() * 1e9:.4g} nm" in repr(run)
    assert f"in {run.history.time.size - 1} steps" in run._repr_html_()


def test_a_notebook_shows_numbers_with_error_bars_and_a_picture(result, thermal):
    page = result._repr_html_()
    assert f"{result.film.central * 1e9:.4g} nm" in page
    assert f"central {100 * result.errors.central:.2g} %" in page
    assert page.count('src="data:image/png;base64,') == 1
    assert f"{thermal.temperature.film_rise_max:.3g} K" in thermal._repr_html_()


@pytest.mark.parametrize("kind", ["result", "explanation"])
def test_notebooks_show_escaped_html(result, kind):
    title = "<script>alert(1)</script>"
    problem = result.problem.model_copy(update={"title": title})
    shown = replace(result, problem=problem) if kind == "result" else problem.explain()
    assert "<script>" not in shown._repr_html_()
    assert "&lt;script&gt;" in shown._repr_html_()
