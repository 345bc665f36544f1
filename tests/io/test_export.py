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


def test_the_maps_of_a_thermal_film_are_columns_and_point_arrays(thermal, tmp_path):
    write_csv(thermal, tmp_path / "lines.csv")
    write_vtk(thermal, tmp_path / "out.vtr")
    table = [row for row in rows(tmp_path / "lines.csv") if row["line"] == "x"]
    root = ET.parse(tmp_path / "out.vtr").getroot()
    arrays = {e.attrib["Name"]: decoded(e) for e in root.iter("DataArray")}
    row = int(np.argmin(np.abs(thermal.scaled.y)))
    for name, column, field in (
        ("temperature_mid", "temperature_mid_k", thermal.temperature.mid_film),
        ("temperature_2", "temperature_2_k", thermal.heat.temperature[-1]),
        ("heat_flux_1", "heat_flux_1_w_m2", thermal.heat.flux_1),
        ("shear_stress_mid", "shear_stress_mid_pa", thermal.shear.mid_film),
        ("shear_thinning", "shear_thinning", thermal.shear.thinning),
    ):
        assert [float(r[column]) for r in table] == field[row].tolist()
        assert np.array_equal(arrays[name].reshape(65, 65), field)


def test_the_heights_of_rough_surfaces_are_columns_and_point_arrays(rough, tmp_path):
    write_csv(rough, tmp_path / "lines.csv")
    write_csv(rough, tmp_path / "fields.csv", what="fields")
    write_vtk(rough, tmp_path / "out.vtr")
    root = ET.parse(tmp_path / "out.vtr").getroot()
    arrays = {e.attrib["Name"]: decoded(e) for e in root.iter("DataArray")}
    row = int(np.argmin(np.abs(rough.scaled.y)))
    along = [r for r in rows(tmp_path / "lines.csv") if r["line"] == "x"]
    every = rows(tmp_path / "fields.csv")
    for name, heights in (
        ("height_1", rough.heights.surface_1),
        ("height_2", rough.heights.surface_2),
    ):
        assert [float(r[f"{name}_m"]) for r in along] == heights[row].tolist()
        assert [float(r[f"{name}_m"]) for r in every] == heights.ravel().tolist()
        assert np.array_equal(arrays[name], heights.ravel())


def test_an_isothermal_table_has_no_columns_of_heat(result, tmp_path):
    write_csv(result, tmp_path / "lines.csv")
    assert list(rows(tmp_path / "lines.csv")[0])[-1] == "H"


def test_npz_and_mat_hold_the_layers(thermal, tmp_path):
    io = pytest.importorskip("scipy.io")
    write_npz(thermal, tmp_path / "out.npz")
    write_mat(thermal, tmp_path / "out.mat")
    with np.load(tmp_path / "out.npz", allow_pickle=False) as stored:
        assert np.array_equal(stored["temperature"], thermal.heat.temperature)
    stored = io.loadmat(tmp_path / "out.mat")
    assert np.array_equal(stored["temperature"], thermal.heat.temperature)
    assert np.array_equal(stored["shear_stress_1"], thermal.shear.surface_1)


def test_the_volume_of_the_film_has_its_nodes_in_metres(thermal, tmp_path):
    write_vtk(thermal, tmp_path / "out.vts")
    root = ET.parse(tmp_path / "out.vts").getroot()
    assert root.attrib["type"] == "StructuredGrid"
    assert root.find("StructuredGrid").attrib["WholeExtent"] == "0 64 0 64 0 8"
    arrays = {e.attrib["Name"]: decoded(e) for e in root.iter("DataArray")}
    points = arrays["points"].reshape(9, 65, 65, 3)
    assert np.array_equal(points[3, 7, :, 0], thermal.x)
    assert np.array_equal(points[-1, :, :, 2], thermal.film_thickness)
    assert np.array_equal(arrays["temperature"].reshape(9, 65, 65), thermal.heat.temperature)
    assert np.array_equal(arrays["pressure"].reshape(9, 65, 65)[4], thermal.pressure)


def test_the_volume_of_an_isothermal_film_has_two_layers(result, tmp_path):
    write_vtk(result, tmp_path / "out.vts")
    root = ET.parse(tmp_path / "out.vts").getroot()
    assert root.find("StructuredGrid").attrib["WholeExtent"] == "0 64 0 64 0 1"


@pytest.mark.parametrize("kind", sorted(WRITERS))
def test_each_format_has_an_ending_and_leaves_one_file(result, tmp_path, kind):
    path = tmp_path / f"out{SUFFIXES[kind]}"
    write(result, path, kind)
    assert list(tmp_path.iterdir()) == [path]


def test_the_ending_tells_the_format():
    assert kind_of("a.csv", None) == kind_of("a.CSV", "csv") == kind_of(None, "csv") == "csv"
    assert kind_of("a.vtr", None) == kind_of("a.vts", "vtk") == "vtk"


@pytest.mark.parametrize(
    ("path", "stated", "words"),
    [
        ("a.vtk", "vtk", "ends in .vtr"),
        ("a.vtu", None, "ends in .vtr"),
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
