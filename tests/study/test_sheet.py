"""Columns of a table in chosen units; values of an axis from a file."""

import pandas as pd
import pytest
from openpyxl import Workbook

from tehl.base.errors import InputError
from tehl.studies import read_study, study_of
from tehl.studies.output import check_sheet, sheet, write_sheet

STUDY = """
case = "case.toml"
[[axes]]
path = "contact.entrainment_speed"
{values}
"""
CASE = """
contact = { radius = "20 mm", load = "80 N", entrainment_speed = "1.5 m/s" }
surface_1 = { material = "steel" }
surface_2 = { material = "steel" }
lubricant = "mineral-oil"
"""


@pytest.fixture
def table() -> pd.DataFrame:
    frame = pd.DataFrame(
        {
            "contact.load": [20.0, 40.0],
            "status": ["converged"] * 2,
            "film.h_min_m": [1e-7, 2e-7],
            "pressure.max_pa": [8e8, 1e9],
            "temperature.inlet_k": [313.15, 353.15],
            "temperature.film_rise_max_k": [1.0, 2.0],
            "groups.M": [10.0, 20.0],
        }
    )
    frame.attrs["units"] = {
        "contact.load": "N",
        "film.h_min_m": "m",
        "pressure.max_pa": "Pa",
        "temperature.inlet_k": "K",
        "temperature.film_rise_max_k": "K",
        "groups.M": "1",
    }
    return frame


def test_columns_are_chosen_converted_and_named_with_their_units(table):
    wanted = ["load", "h_min_m [nm]", "max_pa [GPa]", "inlet_k [degC]", "M", "status"]
    found = sheet(table, wanted)
    assert list(found) == [
        "contact.load [N]",
        "film.h_min_m [nm]",
        "pressure.max_pa [GPa]",
        "temperature.inlet_k [degC]",
        "groups.M",
        "status",
    ]
    assert found.iloc[1, :5].tolist() == pytest.approx([40.0, 200.0, 1.0, 80.0, 20.0])
    assert list(sheet(table, []))[2] == "film.h_min_m [m]"
    in_kelvin = sheet(table, ["inlet_k [K]", "film_rise_max_k [K]"])  # there is no 0 K to convert
    assert in_kelvin.iloc[1].tolist() == [353.15, 2.0]


@pytest.mark.parametrize(
    ("column", "words"),
    [
        ("h_min_m [GPa]", "has the unit of a pressure"),
        ("M [nm]", "has no unit"),
        ("film_rise_max_k [degC]", "is a difference; state it in K"),
        ("thickness", "the table has no column thickness"),
    ],
)
def test_a_column_that_cannot_be_shown_is_an_input_error(table, column, words):
    with pytest.raises(InputError, match=words):
        sheet(table, [column])


@pytest.mark.parametrize("ending", ["csv", "xlsx"])
def test_a_sheet_is_written_by_its_ending(table, tmp_path, ending):
    path = tmp_path / f"films.{ending}"
    write_sheet(table, path, ["load", "h_min_m [nm]"])
    read = pd.read_csv(path) if ending == "csv" else pd.read_excel(path)
    assert list(read) == ["contact.load [N]", "film.h_min_m [nm]"]
    assert read["film.h_min_m [nm]"].tolist() == pytest.approx([100.0, 200.0])
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(InputError, match=r"ends in .csv or .xlsx"):
        check_sheet(tmp_path / "films.pdf")


def planned(folder, values: str):
    """Return the cases of a study file with one axis."""
    (folder / "case.toml").write_text(CASE)
    (folder / "study.toml").write_text(STUDY.format(values=values))
    return study_of(read_study(folder / "study.toml")).cases


def test_an_axis_takes_its_values_from_a_column_of_a_file(tmp_path):
    (tmp_path / "speeds.csv").write_text("run,speed [mm/s]\na,500\nb,1500\n")
    cases = planned(tmp_path, 'file = "speeds.csv"\ncolumn = "speed"')
    assert [case.problem.entrainment_speed for case in cases] == [0.5, 1.5]
    (tmp_path / "alone.csv").write_text("measured [m/s]\n2\n")
    assert planned(tmp_path, 'file = "alone.csv"')[0].problem.entrainment_speed == 2.0
    book = Workbook()
    for line in (("run", "speed [mm/s]"), ("a", 500), (None, None), ("b", 1500.0)):
        book.active.append(line)
    book.save(tmp_path / "speeds.xlsx")
    assert planned(tmp_path, 'file = "speeds.xlsx"\ncolumn = "speed"') == cases
    (tmp_path / "no.xlsx").write_text("no book")
    with pytest.raises(InputError, match=r"no\.xlsx cannot be read as Excel"):
        planned(tmp_path, 'file = "no.xlsx"')
    for name, words in (("speeds.csv", "its columns are run, speed"), ("no.csv", "does not exist")):
        with pytest.raises(InputError, match=words):
            planned(tmp_path, f'file = "{name}"')


def test_more_values_along_an_axis_leave_the_other_cases_as_they_are(tmp_path):
    few = planned(tmp_path, 'values = ["0.1 m/s", "1.5 m/s"]')
    more = planned(tmp_path, 'values = ["0.1 m/s", "1.5 m/s", "10 m/s"]')
    assert [case.key for case in more[:2]] == [case.key for case in few]
