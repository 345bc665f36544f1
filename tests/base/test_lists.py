"""Lists as spreadsheets save them."""

import pytest

from tehl.base.errors import InputError
from tehl.base.lists import numbered_lines

TEXT = "u_m [m/s];T [°C]\n0,5;40\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_a_list_of_any_spreadsheet_is_read(tmp_path, encoding):
    path = tmp_path / "list.csv"
    path.write_bytes(TEXT.encode(encoding))
    assert numbered_lines(path) == [(1, ["u_m [m/s]", "T [°C]"]), (2, ["0.5", "40"])]


def test_what_is_not_a_text_is_refused(tmp_path):
    path = tmp_path / "list.csv"
    path.write_bytes(b"\x81\x8d\x8f" * 9)
    with pytest.raises(InputError, match="it is not a text"):
        numbered_lines(path)
