"""Lists as spreadsheets save them."""

import pytest
from openpyxl import Workbook

from tehl.base.errors import InputError
from tehl.base.lists import Doubtful, lines_of, lines_of_file, spelling_of
from tehl.contact.columns import read_columns

TEXT = "u_m [m/s];T [°C]\n0,5;40\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_a_list_of_any_spreadsheet_is_read(tmp_path, encoding):
    path = tmp_path / "list.csv"
    path.write_bytes(TEXT.encode(encoding))
    assert lines_of(path) == [(1, ["u_m [m/s]", "T [°C]"]), (2, ["0.5", "40"])]
    # by a mark spreadsheets that do not write UTF-8 read the answers
    assert spelling_of(path).encoding == ("utf-8" if encoding == "utf-8" else "utf-8-sig")


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("sep=;\nload [N];mark\n1.111,5;1.5\n0,5;b\n", ["1111.5", "0.5"]),
        ("load [N];mark\n1.111;a\n0.5;b\n", ["1.111", "0.5"]),
    ],
)
def test_thousands_of_excel_are_read_or_refused_and_never_taken_for_fractions(
    tmp_path, text, values
):
    path = tmp_path / "list.csv"
    path.write_text(text)
    first = 2 if text.startswith("sep") else 1
    assert [line[0] for _, line in lines_of(path)] == ["load [N]", *values]
    assert lines_of(path)[0][0] == first


def test_a_cell_that_may_be_two_numbers_is_kept_and_refused_where_a_number_is_needed(tmp_path):
    path = tmp_path / "list.csv"
    path.write_text("load [N];mark\n1.111.000;22.205\n0,5;b\n")
    assert lines_of(path)[1] == (2, [Doubtful("1.111.000"), Doubtful("22.205")])
    message = r"line 2: 1\.111\.000 has a point, .* write 1111000$"
    with pytest.raises(InputError, match=message):
        lines_of_file(path)


def test_a_folder_and_formulas_without_values_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"cannot be read \(Is a directory\)"):
        lines_of(tmp_path)
    book, path = Workbook(), tmp_path / "list.xlsx"
    book.active.append(["load", "title"])
    book.active.append([80, None])
    book.active.append(["=2*80", "b"])
    book.save(path)  # as programs do that do not calculate: Excel stores the value as well
    with pytest.raises(InputError, match=r"list\.xlsx: cell A3 has a formula without its value"):
        lines_of(path)


def test_what_is_not_a_text_is_refused(tmp_path):
    path = tmp_path / "list.csv"
    path.write_bytes(b"\x81\x8d\x8f" * 9)
    with pytest.raises(InputError, match="it is not a text"):
        lines_of(path)


@pytest.mark.parametrize(
    "text",
    ["0,1;2,5\n0,2;3\n", "0.1, 2.5\n0.2, 3\n", "t [s];load [N]\n0,1;2,5\n0,2;3", "0.1 2.5\n0.2 3"],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_two_columns_are_read_as_spreadsheets_save_them(tmp_path, text, encoding):
    path = tmp_path / "course.csv"
    path.write_text(text, encoding=encoding)
    pairs, units = read_columns(path, ("time", "load"), "t [s], load [N]")
    assert pairs == [(0.1, 2.5), (0.2, 3.0)]
    assert units == (("s", "N") if "[" in text else None)
