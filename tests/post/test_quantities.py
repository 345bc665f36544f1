"""The table of quantities: what a line in it shows everywhere."""

import numpy as np
import pytest

from tehl.api.results import Result
from tehl.cli.text import as_text
from tehl.explore.numbers import numbers
from tehl.io.summary import summary
from tehl.report.explain import explain
from tehl.report.page import report_text
from tehl.result import quantities
from tehl.result.quantity import Quantity
from tehl.result.registry import columns
from tehl.studies.answers import values_of
from tests.fixtures_result import make_result

PLACES = ("list", "text", "report", "page", "notebook", "axis")
ADDED = Quantity(
    "film.h_corner_m",
    lambda found: float(found.solution.scaled.film[0, 0] * found.solution.scales.film_thickness),
    error=lambda numbers: numbers.get("errors.central"),
    symbol="h_0",
    unit="nm",
    words=dict.fromkeys(PLACES, "film in the corner"),
)


@pytest.fixture
def result() -> Result:
    return make_result()


def flat(block: dict, path: str = "") -> dict:
    """Return the numbers of nested blocks by path."""
    found = {}
    for key, value in block.items():
        name = f"{path}{key}"
        found |= flat(value, f"{name}.") if isinstance(value, dict) else {name: value}
    return found


def test_the_mean_film_is_that_of_the_nodes_inside_the_contact(result: Result):
    x, y, film = result.scaled.x, result.scaled.y, result.scaled.film
    inside = [
        film[j, i] for j in range(y.size) for i in range(x.size) if x[i] ** 2 + y[j] ** 2 <= 1
    ]
    mean = summary(result)["film"]["h_mean_m"]
    assert mean == pytest.approx(np.mean(inside) * result.scales.film_thickness)
    assert result.film.minimum < mean


def test_a_line_in_the_table_is_shown_everywhere(result: Result, monkeypatch: pytest.MonkeyPatch):
    corner = result.scaled.film[0, 0] * result.scales.film_thickness
    monkeypatch.setattr(quantities, "QUANTITIES", (*quantities.QUANTITIES, ADDED))
    assert summary(result)["film"]["h_corner_m"] == pytest.approx(corner)
    assert "film.h_corner_m" in columns()
    found = values_of(flat(summary(result)))
    assert found["film in the corner [nm]"] == pytest.approx(corner * 1e9)
    assert "film in the corner" in as_text(result)
    assert "film in the corner" in report_text(result)
    shown = next(one for one in numbers(result, explain(result.problem)) if one.key == "h_corner_m")
    assert (shown.value, shown.unit) == (pytest.approx(corner * 1e9), "nm")


def test_every_quantity_of_the_table_has_a_unit_and_words_that_fit():
    for one in quantities.QUANTITIES:
        assert set(one.words) <= {*PLACES, "line", "rises", "bar"}, one.path
        if one.unit == "nm":
            assert one.key.endswith("_m"), one.path
