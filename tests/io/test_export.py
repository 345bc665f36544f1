"""Exports can be read back by others and lose nothing."""

import base64
import csv
import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from tehl.errors import InputError
from tehl.io.export import (
    SUFFIXES,
    WRITERS,
    kind_of,
    write,
    write_csv,
    write_mat,
    write_npz,
    write_vtk,
)


def rows(path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_csv_lines_hold_both_centre_lines_bit_by_bit(result, tmp_path):
    write_csv(result, tmp_path / "lines.csv")
    table = rows(tmp_path / "lines.csv")
    along_x = [row for row in table if row["line"] == "x"]
    along_y = [row for row in table if row["line"] == "y"]
    assert len(along_x) == len(along_y) == 65
    row = int(np.argmin(np.abs(result.scaled.y)))
    assert [float(r["film_thickness_m"]) for r in along_x] == result.film_thickness[row].tolist()
    assert [float(r["y_m"]) for r in along_y] == result.y.tolist()


def test_csv_fields_hold_every_node(result, tmp_path):
    write_csv(result, tmp_path / "fields.csv", what="fields")
    table = rows(tmp_path / "fields.csv")
    pressure = np.array([float(row["pressure_pa"]) for row in table])
    assert np.array_equal(pressure.reshape(65, 65), result.pressure)
    assert all(all(row.values()) for row in table)


def test_npz_holds_arrays_and_summary(result, tmp_path):
    write_npz(result, tmp_path / "out.npz")
    with np.load(tmp_path / "out.npz", allow_pickle=False) as stored:
        assert np.array_equal(stored["film_thickness"], result.film_thickness)
        assert json.loads(str(stored["summary"])) == result.summary()


def test_mat_holds_arrays_and_summary(result, tmp_path):
    io = pytest.importorskip("scipy.io")
    write_mat(result, tmp_path / "out.mat")
    stored = io.loadmat(tmp_path / "out.mat")
    assert np.array_equal(stored["pressure"], result.pressure)
    assert stored["x"].shape == (65, 1)
    assert json.loads(stored["summary"][0])["status"] == "converged"


def decoded(element: ET.Element) -> np.ndarray:
    data = base64.b64decode(element.text)
    length = int(np.frombuffer(data[:8], "<u8")[0])
    assert len(data) == 8 + length
    return np.frombuffer(data[8:], "<f8")


def test_vtk_is_a_rectilinear_grid_in_metres(result, tmp_path):
    write_vtk(result, tmp_path / "out.vtr")
    root = ET.parse(tmp_path / "out.vtr").getroot()
    assert root.attrib["type"] == "RectilinearGrid"
    assert root.attrib["header_type"] == "UInt64"
    assert root.find("RectilinearGrid").attrib["WholeExtent"] == "0 64 0 64 0 0"
    arrays = {e.attrib["Name"]: decoded(e) for e in root.iter("DataArray")}
    assert np.array_equal(arrays["x"], result.x)
    assert np.array_equal(arrays["y"], result.y)
    assert arrays["z"].tolist() == [0.0]
    assert np.array_equal(arrays["pressure"].reshape(65, 65), result.pressure)
    assert np.array_equal(arrays["H"].reshape(65, 65), result.scaled.film)
    assert arrays["converged"].tolist() == [1.0]


def test_vtk_marks_what_did_not_converge(stalled, tmp_path):
    write_vtk(stalled, tmp_path / "out.vtr")
    root = ET.parse(tmp_path / "out.vtr").getroot()
    assert decoded(root.find(".//FieldData/DataArray")).tolist() == [0.0]


@pytest.mark.parametrize("kind", sorted(WRITERS))
def test_each_format_has_an_ending_and_leaves_one_file(result, tmp_path, kind):
    path = tmp_path / f"out{SUFFIXES[kind]}"
    write(result, path, kind)
    assert list(tmp_path.iterdir()) == [path]


def test_the_ending_tells_the_format():
    assert kind_of("a.csv", None) == kind_of("a.CSV", "csv") == kind_of(None, "csv") == "csv"
    assert kind_of("a.vtr", None) == "vtk"


@pytest.mark.parametrize(
    ("path", "stated", "words"),
    [
        ("a.vtk", "vtk", "ends in .vtr"),
        ("a.vts", None, "ends in .vtr"),
        ("a.csv", "npz", "ends in .npz"),
        ("a", "csv", "ends in .csv"),
        ("a.txt", None, "tells no format"),
        (None, None, "state a format"),
    ],
)
def test_an_ending_that_does_not_fit_is_refused(path, stated, words):
    with pytest.raises(InputError, match=words):
        kind_of(path, stated)


def test_an_unknown_format_is_refused_with_the_known_ones(result, tmp_path):
    with pytest.raises(InputError, match="csv, npz, vtk, mat"):
        write(result, tmp_path / "out.xls", "xls")
    assert list(tmp_path.iterdir()) == []
