"""What a notebook shows of the table of a study."""

import pandas as pd
import pytest

from tehl.studies.frame import StudyTable


@pytest.fixture
def table():
    lines = [
        {
            "name": f"{speed:g}",
            "speed": speed,
            "status": "converged" if speed < 4 else "stalled",
            "cause": None if speed < 4 else "grid_too_coarse",
            "message": None,
            "film.h_central_m": 300e-9 * speed**0.67 if speed < 4 else None,
            "errors.central": 0.01,
            "numerics.x": 1.0,
            "key": str(speed),
        }
        for speed in (0.5, 1.0, 2.0, 4.0)
    ]
    found = StudyTable(lines)
    found.attrs["units"] = {"speed": "m/s", "film.h_central_m": "m"}
    return found


def test_main_columns_have_units_and_readable_numbers(table):
    page = table._repr_html_()
    assert "<th>speed [m/s]</th>" in page
    assert "<th>central film [nm]</th>" in page
    assert "<td>300</td>" in page
    assert "numerics.x" not in page
    assert "stalled: grid_too_coarse" in page


def test_cases_without_a_cause_have_their_status_alone(table):
    whole = StudyTable(table.iloc[:3].convert_dtypes())
    assert "<td>converged</td>" in whole._repr_html_()
    assert "nan" not in whole._repr_html_()


def test_a_curve_follows_from_three_converged_cases_on(table):
    assert table._repr_html_().count("data:image/png;base64,") == 1
    assert "data:image" not in table.iloc[:2]._repr_html_()


def test_a_part_without_the_main_columns_is_shown_as_pandas_does(table):
    part = table[["speed", "key"]]
    assert isinstance(part, pd.DataFrame)
    assert part._repr_html_() == pd.DataFrame(part)._repr_html_()


def test_cells_are_escaped(table):
    table.loc[0, "status"] = "<b>"
    assert "<td>&lt;b&gt;</td>" in table._repr_html_()
