"""One table of quantities: each is in the summary, and a new line of it reaches every place."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest

from tehl.cli.text import as_text
from tehl.explore.numbers import numbers, value_of
from tehl.io.content import attributes, rebuild, variables
from tehl.plots.table_columns import certified, find_column
from tehl.plots.table_columns import numbers as column
from tehl.report.explain import explain
from tehl.report.page import report_text
from tehl.result import quantities
from tehl.result.quantity import UNITS, Quantity
from tehl.result.registry import OWNERS, at, bar_names, columns, named
from tehl.studies.answers import heading_of, values_of
from tehl.studies.case import Case, flat, row_of
from tehl.studies.tables import missing_column, table

PLACES = {"axis", "bar", "key", "line", "list", "notebook", "page", "report", "rises", "text"}
NEW = Quantity(
    "film.h_edge_m",
    lambda found: 2.0 * found.solution.film.central,
    name="film_edge",
    symbol="h_e",
    unit="nm",
    digits="0.0",
    words=dict.fromkeys(PLACES - {"bar", "key", "rises"}, "film at the edge"),
)


class Rows:
    """A store of one row."""

    def __init__(self, row):
        self.row = row

    def rows(self, cases):
        return {one.key: self.row for one in cases}


@pytest.fixture
def extended(result, monkeypatch):
    """Return a result while the table has one line more."""
    monkeypatch.setattr(quantities, "QUANTITIES", (*quantities.QUANTITIES, NEW))
    bars = {"film_edge": 0.05, "pressure_max": 0.01}
    return replace(result, errors=replace(result.errors, bars=bars))


def test_a_new_quantity_is_in_the_summary_with_its_bar(extended):
    summary = extended.summary()
    assert summary["film"]["h_edge_m"] == 2.0 * summary["film"]["h_central_m"]
    assert summary["errors"]["film_edge"] == 0.05


def test_a_new_quantity_is_a_column_of_studies_and_of_lists(extended):
    case = Case(name="one", problem=extended.problem, options=extended.options)
    row = row_of(case, extended)
    found = table([case], Rows(row))
    edge = 2e9 * extended.film.central
    assert find_column(found, "h_edge_m") == "film.h_edge_m"
    assert missing_column([], "h_edge_m") is None
    assert found.attrs["units"]["film.h_edge_m"] == "m"
    assert "film at the edge [nm]" in found._repr_html_()
    answers = values_of(row.summary)
    assert answers["film at the edge [nm]"] == pytest.approx(edge)
    assert answers["± film at the edge [nm]"] == pytest.approx(0.05 * edge)
    drawn = column(found, "film.h_edge_m")
    assert drawn.title == f"film at the edge [{drawn.unit}]"
    assert certified(found, drawn)[1] == pytest.approx(0.05 * drawn.values)


@pytest.mark.usefixtures("no_pictures")
def test_a_new_quantity_is_in_texts_reports_and_on_the_page(extended):
    edge = 2e9 * extended.film.central
    line = next(one for one in as_text(extended).splitlines() if "film at the edge" in one)
    assert line.startswith(f"  film at the edge {edge:.4g} nm")
    assert line.endswith("error about 5 %")
    assert f"film at the edge {edge:.4g} nm" in repr(extended)
    page = report_text(extended, dpi=20)
    assert f'film at the edge</td><td class="number">{edge:.4g} nm</td>' in page
    shown = value_of(numbers(extended, explain(extended.problem)), "h_edge")
    assert (shown.name, shown.symbol, shown.unit) == ("film at the edge", "h_e", "nm")
    assert shown.value == pytest.approx(edge)
    assert shown.error == 0.05


def test_the_table_has_each_quantity_once_and_in_known_places():
    paths = [one.path for one in quantities.QUANTITIES]
    assert len(set(paths)) == len(paths)
    for one in quantities.QUANTITIES:
        assert set(one.words) <= PLACES
        assert one.unit in UNITS
        assert not one.block or one.block in OWNERS
    listed = [heading_of(one) for one in quantities.QUANTITIES if "list" in one.words]
    assert len(set(listed)) == len(listed)


@pytest.mark.parametrize("which", ["result", "thermal", "sheared", "rough"])
def test_the_table_has_all_scalars_of_a_summary(which, request):
    summary = request.getfixturevalue(which).summary()
    known = set(columns())
    for block in OWNERS.keys() & summary.keys():
        for path, _ in flat({block: summary[block] or {}}):
            parts = [part for part in path.split(".") if not part.isdigit()]
            assert any(
                [part for part in one.split(".") if part != "0"] == parts for one in known
            ), path


def test_error_bars_are_attributes_too(result):
    errors = replace(result.errors, bars={"pressure_max": 0.02})
    assert errors.pressure_max == errors.of("pressure_max") == errors.at("pressure.max_pa") == 0.02
    assert errors.of("film_central") == errors.central == errors.at("film.h_central_m")
    assert all(getattr(errors, name) is None for name in bar_names() if name != "pressure_max")


def test_files_keep_error_bars_beside_the_other_numbers(result):
    bars = {"pressure_max": 0.02, "heat_shear": 1.0}
    changed = replace(result, errors=replace(result.errors, bars=bars))
    attrs = attributes(changed)
    stored = json.loads(attrs["state"])["errors"]
    assert stored["pressure_max"] == 0.02
    assert stored["film_rise_max"] is None
    assert "bars" not in stored
    arrays = {one.name: one.data for one in variables(changed)}
    back = rebuild(arrays, attrs)
    assert back.errors == changed.errors
    # as a file of before the last quantity
    older = json.loads(attrs["state"])
    del older["errors"]["film_mean"]
    assert rebuild(arrays, attrs | {"state": json.dumps(older)}).errors == changed.errors


def test_parts_of_a_solution_are_given_by_their_own_names(result):
    other = replace(result, rigid_approach=-1.0, history=(), heat=None)
    assert (other.rigid_approach, other.account.history) == (-1.0, ())
    assert result.but(history=()).status is result.status
    assert type(result.but(history=())) is type(result)
    with pytest.raises(TypeError, match="colour"):
        replace(result, colour="red")


def test_estimates_have_units():
    assert named("film_central").unit == "nm"
    assert named("traction_extreme").words["bar"] == "at the extreme"
    names = [at(path).name for path in ("touching.share", "load_sharing.share")]
    assert names == ["contact_share", "load_share"]


def test_the_mean_film_is_between_minimum_and_largest(result):
    film = result.summary()["film"]
    assert film["h_min_m"] < film["h_mean_m"] < 2.0 * film["h_central_m"]


def test_the_table_is_not_loaded_with_the_package():
    code = "import sys, tehl, tehl.cli; sys.exit('tehl.result.quantities' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
