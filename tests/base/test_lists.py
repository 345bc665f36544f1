"""Lists as spreadsheets save them."""

import pytest

from tehl.base.errors import InputError
from tehl.base.lists import lines_of
from tehl.contact.columns import read_columns

TEXT = "u_m [m/s];T [°C]\n0,5;40\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_a_list_of_any_spreadsheet_is_read(tmp_path, encoding):
    path = tmp_path / "list.csv"
    path.write_bytes(TEXT.encode(encoding))
    assert lines_of(path) == [(1, ["u_m [m/s]", "T [°C]"]), (2, ["0.5", "40"])]


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
