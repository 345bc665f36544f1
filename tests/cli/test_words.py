"""The lines that a solve prints."""

from dataclasses import replace

from tehl.cli.words import as_text, headline
from tehl.report.explain import length
from tehl.result import Estimate


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


def test_a_case_without_a_title_has_one(result):
    bare = replace(result, problem=result.problem.model_copy(update={"title": ""}))
    assert headline(bare).startswith("Lubricated point contact - ")
