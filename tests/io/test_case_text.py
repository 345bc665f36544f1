"""Case files as texts: their syntax, encodings, and files that are not a case."""

import os
from pathlib import Path

import pytest

from tehl.api.problem import read_case
from tehl.base.errors import InputError
from tehl.io.templates import template_text


@pytest.mark.parametrize(
    ("text", "number", "shown"),
    [
        ("[contact\nload = 3", 1, "[contact"),
        ('a = 1\nload = "80 N', 2, "80 N"),
        ("a = 1\n\nload = 80 N # kN", 3, 'with units in quotes, load = "80 N"'),
        ("load = 80,5", 1, "write a decimal point in place of the comma"),
        ("load = “80 N”", 1, 'write straight quotes "'),
        ("a = 1\na = 2\n", 2, "'a = 2' is not valid TOML: Cannot overwrite a value"),
        ("x = '''abc", 1, "abc"),
    ],
)
def test_a_toml_syntax_error_shows_its_line(tmp_path: Path, text: str, number: int, shown: str):
    path = tmp_path / "slip.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_case(path)
    assert f"line {number}: " in str(caught.value)
    assert shown in str(caught.value)


def test_a_file_that_cannot_be_read_is_reported(tmp_path: Path):
    with pytest.raises(InputError, match="case file does not exist"):
        read_case(tmp_path / "none.toml")
    with pytest.raises(InputError, match="cannot be read"):
        read_case(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\x89HDF\r\n\xff\xfe")
    with pytest.raises(InputError, match="UTF-16; if it is a case file, save it as UTF-8"):
        read_case(tmp_path / "binary.toml")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"a = " + b"[" * 5000, "nested too deeply"),
        (b"a." * 5000 + b"b = 1", "nested too deeply"),
        (b'title = "two\\u0000lines"', "must be one line without control characters"),
        (b"a = " + b"9" * 5000, "too many digits"),
        (b"x" * 100_000, "line 1: 'xxx"),
        (bytes(5000), "line 1: "),
        (b"\xff\xfea\x00b", "UTF-16"),
        (b"#" * 2_000_000, "larger than 1 MB"),
        (b'"a\\nb" = 3', "is not a known key"),
    ],
)
def test_a_strange_file_is_reported_in_one_short_line(tmp_path: Path, content: bytes, words: str):
    path = tmp_path / "strange.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_case(path)
    message = str(caught.value)
    assert words in message
    assert message.startswith(str(path))
    assert "\n" not in message
    assert len(message) < 300 + len(str(path))


def test_a_byte_order_mark_is_accepted(case: Path):
    text = case.read_bytes()
    case.write_bytes(b"\xef\xbb\xbf" + text)
    assert read_case(case).load == 80.0


def test_a_named_pipe_is_rejected_at_once(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(InputError, match="not a regular file"):
        read_case(tmp_path / "pipe.toml")


def test_a_case_comes_through_a_pipe_without_a_name(case: Path):
    reading, writing = os.pipe()
    os.write(writing, case.read_bytes())
    os.close(writing)
    assert read_case(f"/dev/fd/{reading}").load == 80.0
    os.close(reading)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_a_case_file_may_be_in_the_encodings_of_windows(tmp_path, encoding):
    text = template_text("ball-on-disc").replace("[contact]", "# µ\n[contact]", 1)
    mark = "\ufeff" if encoding[-2:] in ("le", "be") else ""
    (tmp_path / "a.toml").write_text(mark + text, encoding=encoding)
    (tmp_path / "b.toml").write_text(text, encoding="utf-8")
    assert read_case(tmp_path / "a.toml") == read_case(tmp_path / "b.toml")


@pytest.mark.parametrize(
    ("tables", "key"),
    [
        ('[surface_2.roughness]\ntype = "map"\nfile = "no.npy"', "surface_2.roughness.file"),
        (
            '[[surface_2.roughness]]\ntype = "wave"\namplitude = "1 nm"\nwavelength = "50 um"\n'
            '[[surface_2.roughness]]\ntype = "map"\nfile = "no.npy"',
            "surface_2.roughness.1.file",
        ),
    ],
)
def test_a_missing_map_is_named_with_its_key_and_folder(case, tables, key):
    case.write_text(f"{case.read_text(encoding='utf-8')}\n{tables}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_case(case)
    assert str(caught.value) == f'{case}: {key}: no map "no.npy" in {case.parent}'
