"""Exports can be read back by others and lose nothing."""

import base64
import csv
import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from tehl.base.errors import InputError
from tehl.io.export import ending_of, export
from tests.fixtures_transient import make_certified, make_transient


def rows(path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_csv_lines_hold_both_centre_lines_bit_by_bit(result, tmp_path):
    export(result, tmp_path / "lines.csv")
    table = rows(tmp_path / "lines.csv")
    along_x = [row for row in table if row["line"] == "x"]
    along_y = [row for row in table if row["line"] == "y"]
    assert len(along_x) == len(along_y) == 65
    row = int(np.argmin(np.abs(result.scaled.y)))
    assert [float(r["film_thickness_m"]) for r in along_x] == result.film_thickness[row].tolist()
    assert [float(r["y_m"]) for r in along_y] == result.y.tolist()


def test_csv_fields_hold_every_node(result, tmp_path):
    export(result, tmp_path / "fields.csv", what="fields")
    table = rows(tmp_path / "fields.csv")
    pressure = np.array([float(row["pressure_pa"]) for row in table])
    assert np.array_equal(pressure.reshape(65, 65), result.pressure)
    assert all(all(row.values()) for row in table)


def test_npz_holds_arrays_and_summary(result, tmp_path):
    export(result, tmp_path / "out.npz")
    with np.load(tmp_path / "out.npz", allow_pickle=False) as stored:
        assert np.array_equal(stored["film_thickness"], result.film_thickness)
        assert json.loads(str(stored["summary"])) == result.summary()


def test_mat_holds_arrays_and_summary(result, tmp_path):
    io = pytest.importorskip("scipy.io")
    export(result, tmp_path / "out.mat")
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
    export(result, tmp_path / "out.vtr")
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
    export(stalled, tmp_path / "out.vtr")
    root = ET.parse(tmp_path / "out.vtr").getroot()
    assert decoded(root.find(".//FieldData/DataArray")).tolist() == [0.0]


def test_the_maps_of_a_thermal_film_are_columns_and_point_arrays(thermal, tmp_path):
    export(thermal, tmp_path / "lines.csv")
    export(thermal, tmp_path / "out.vtr")
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
    export(rough, tmp_path / "lines.csv")
    export(rough, tmp_path / "fields.csv", what="fields")
    export(rough, tmp_path / "out.vtr")
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
    export(result, tmp_path / "lines.csv")
    assert list(rows(tmp_path / "lines.csv")[0])[-1] == "H"


def test_npz_and_mat_hold_the_layers(thermal, tmp_path):
    io = pytest.importorskip("scipy.io")
    export(thermal, tmp_path / "out.npz")
    export(thermal, tmp_path / "out.mat")
    with np.load(tmp_path / "out.npz", allow_pickle=False) as stored:
        assert np.array_equal(stored["temperature"], thermal.heat.temperature)
    stored = io.loadmat(tmp_path / "out.mat")
    assert np.array_equal(stored["temperature"], thermal.heat.temperature)
    assert np.array_equal(stored["shear_stress_1"], thermal.shear.surface_1)


def test_the_volume_of_the_film_has_its_nodes_in_metres(thermal, tmp_path):
    export(thermal, tmp_path / "out.vts")
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
    export(result, tmp_path / "out.vts")
    root = ET.parse(tmp_path / "out.vts").getroot()
    assert root.find("StructuredGrid").attrib["WholeExtent"] == "0 64 0 64 0 1"


KINDS = ("csv", "mat", "npz", "vtk")


@pytest.mark.parametrize("kind", KINDS)
def test_each_format_has_an_ending_and_leaves_one_file(result, tmp_path, kind):
    path = tmp_path / f"out{ending_of(result, kind)}"
    assert export(result, path, kind) == [path]
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("name", "stated", "start"),
    [
        ("a.csv", None, b"line,"),
        ("a.CSV", "csv", b"line,"),
        ("a.vtr", None, b"<?xml"),
        ("a.vts", "vtk", b"<?xml"),
    ],
)
def test_the_ending_gives_the_format(result, tmp_path, name, stated, start):
    export(result, tmp_path / name, stated)
    assert (tmp_path / name).read_bytes().startswith(start)


@pytest.mark.parametrize(
    ("path", "stated", "words"),
    [
        ("a.vtk", "vtk", "ends in .vtr"),
        ("a.vtu", None, "or .vtr"),
        ("a.pvd", None, "or .vtr"),
        ("a.csv", "npz", "ends in .npz"),
        ("a", "csv", "ends in .csv"),
        ("a.txt", None, "ends in .csv or .npz or"),
        ("a.xls", "xls", "unknown export format 'xls'; expected --to csv, npz, mat, vtk"),
    ],
)
def test_an_ending_that_does_not_match_is_rejected(result, tmp_path, path, stated, words):
    with pytest.raises(InputError, match=words):
        export(result, tmp_path / path, stated)
    assert list(tmp_path.iterdir()) == []


def test_a_transient_result_has_no_single_plane(tmp_path):
    with pytest.raises(InputError, match="collection of frames"):
        export(make_transient(), tmp_path / "run.vtr")


def test_a_format_must_be_stated(result):
    with pytest.raises(InputError, match="no format stated"):
        ending_of(result, None)


def test_csv_history_of_a_steady_result_has_a_row_per_cycle(result, tmp_path):
    export(result, tmp_path / "cycles.csv", what="history")
    table = rows(tmp_path / "cycles.csv")
    assert [float(row["history_residual"]) for row in table] == [r.residual for r in result.history]
    assert {row["history_smoother"] for row in table} == {r.smoother for r in result.history}


def test_csv_history_of_a_transient_result_has_a_row_per_step(tmp_path):
    run = make_transient()
    export(run, tmp_path / "run.csv")
    table = rows(tmp_path / "run.csv")
    assert [float(row["time_s"]) for row in table] == run.history.time.tolist()
    assert [float(row["h_min_m"]) for row in table] == run.history.film_minimum.tolist()
    assert {"load_factor", "p_max_pa", "rolling_moment_n_m", "film_rise_max_k"} <= set(table[0])


def test_csv_lines_of_a_transient_result_follow_the_line_at_each_step(tmp_path):
    run = make_transient()
    export(run, tmp_path / "run.csv", what="lines")
    table = rows(tmp_path / "run.csv")
    film = np.array([float(row["film_centre_line_m"]) for row in table])
    assert np.array_equal(film.reshape(run.profiles.film.shape), run.profiles.film)
    assert [float(row["x_m"]) for row in table[: run.x.size]] == run.x.tolist()
    assert {float(row["time_s"]) for row in table} == set(run.history.time.tolist())


def test_csv_fields_of_a_transient_result_hold_each_frame(tmp_path):
    run = make_transient()
    export(run, tmp_path / "run.csv", what="fields")
    table = rows(tmp_path / "run.csv")
    pressure = np.array([float(row["pressure_frames_pa"]) for row in table])
    assert np.array_equal(pressure.reshape(run.frames.pressure.shape), run.frames.pressure)
    times = run.history.time[run.frames.step]
    assert [float(row["frame_time_s"]) for row in table[:: run.x.size * run.y.size]] == list(times)


def test_npz_holds_all_parts_of_a_transient_result(tmp_path):
    run = make_certified()
    export(run, tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz", allow_pickle=False) as stored:
        assert np.array_equal(stored["film_frames"], run.frames.film)
        assert np.array_equal(stored["h_min_bar"], run.bars.film_minimum)
        assert np.array_equal(stored["film_thickness"], run.start.film_thickness)
        assert json.loads(str(stored["summary"])) == run.summary()


def test_vtk_of_a_transient_result_is_a_collection_of_planes(tmp_path):
    run = make_transient()
    written = export(run, tmp_path / "run.pvd")
    assert sorted(tmp_path.iterdir()) == sorted(written)
    listed = list(ET.parse(tmp_path / "run.pvd").getroot().iter("DataSet"))
    times = run.history.time[run.frames.step].tolist()
    assert [float(one.attrib["timestep"]) for one in listed] == times
    assert [one.attrib["file"] for one in listed] == [path.name for path in written[1:]]
    for number, one in enumerate(listed):
        root = ET.parse(tmp_path / one.attrib["file"]).getroot()
        arrays = {e.attrib["Name"]: decoded(e) for e in root.iter("DataArray")}
        assert np.array_equal(arrays["x"], run.x)
        for name in ("pressure", "film", "height"):
            found = arrays["film_thickness" if name == "film" else name]
            assert np.array_equal(found, getattr(run.frames, name)[number].ravel())


def test_what_a_result_does_not_have_is_not_expected(result, tmp_path):
    with pytest.raises(InputError, match="no depths to export; expected lines or fields or hist"):
        export(result, tmp_path / "depths.csv", what="depths")


@pytest.mark.parametrize(("name", "what"), [("run.csv", "fields"), ("run.pvd", "")])
def test_a_transient_result_without_frames_has_none_to_export(tmp_path, name, what):
    with pytest.raises(InputError, match=r"has no (fields|frames) to export"):
        export(make_transient(frames=False), tmp_path / name, what=what)
    assert list(tmp_path.iterdir()) == []
