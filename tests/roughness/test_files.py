"""Files of heights: right ones are read, wrong ones are reported in a sentence."""

import hashlib
import sys
from importlib.util import find_spec

import h5py
import numpy as np
import pytest
import xarray as xr

from tehl.base.errors import InputError
from tehl.roughness import Map
from tehl.roughness.files import INSTRUMENTS, read
from tests.roughness.files import relief, write_metropro, write_x3p, write_xyz

HEIGHTS = relief()
HOLED = HEIGHTS.copy()
HOLED[3, 5:9] = np.nan


def test_npy_is_read(tmp_path):
    for name, heights in (
        ("a.npy", HEIGHTS),
        ("b.npy", np.asfortranarray(HEIGHTS)),
        ("c.npy", (HEIGHTS * 1e9).astype("<i4")),
    ):
        np.save(tmp_path / name, heights)
        np.testing.assert_array_equal(read(tmp_path / name).heights, heights)


@pytest.mark.parametrize("mark", [" ", ",", ";", "\t"])
def test_a_table_of_heights_is_read(tmp_path, mark):
    path = tmp_path / "map.csv"
    np.savetxt(path, HOLED * 1e6, delimiter=mark, header="heights in um")
    found = read(path)
    np.testing.assert_allclose(found.heights, HOLED * 1e6)
    assert (found.unit, found.pixel, found.kind) == (None, None, "table of heights")


def test_decimal_commas_are_read_where_another_mark_separates_the_cells(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("1,5;2,5;nan;;\n3,5;4,5;-1e-3;0;\n")
    np.testing.assert_array_equal(
        read(path).heights, [[1.5, 2.5, np.nan, np.nan], [3.5, 4.5, -1e-3, 0]]
    )


@pytest.mark.parametrize("ending", ["xyz", "csv"])
def test_columns_in_any_order_are_a_map(tmp_path, ending):
    path = write_xyz(tmp_path / f"map.{ending}", HOLED * 1e6, mark="," if ending == "csv" else " ")
    found = read(path)
    np.testing.assert_allclose(found.heights, HOLED * 1e6, rtol=1e-8)
    assert found.pixel == pytest.approx((2.0, 3.0))
    assert found.pixel_units == (None, None)


def test_a_line_of_names_is_skipped(tmp_path):
    path = tmp_path / "map.csv"
    path.write_text("x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,4\n")
    np.testing.assert_array_equal(read(path).heights, [[1, 2], [3, 4]])


NAN = np.nan


@pytest.mark.parametrize("word", ["nan", "NaN", "na", "N/A", "bad", "-", "***", "inf"])
@pytest.mark.parametrize("mark", [",", ";", "\t", " "])
def test_a_first_row_without_heights_is_not_a_line_of_names(tmp_path, word, mark):
    path = tmp_path / "map.csv"
    path.write_text("\n".join(map(mark.join, [[word] * 4, list("1234"), list("5678")])))
    found = read(path).heights
    assert found.shape == (3, 4)
    assert not np.isfinite(found[0]).any()
    path.write_text(mark.join("abcd") + "\n" + path.read_text())
    assert read(path).heights.shape == (3, 4)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1,2,3\n4,5,\n6,7,8\n", [[1, 2, 3], [4, 5, NAN], [6, 7, 8]]),
        ("1,2,\n4,5,\n6,7,8\n", [[1, 2, NAN], [4, 5, NAN], [6, 7, 8]]),
        (",,\n4,5,6\n,,\n", [[NAN] * 3, [4, 5, 6], [NAN] * 3]),
        ("1,2,3,\n4,5,6,\n", [[1, 2, 3], [4, 5, 6]]),
        ("1,2,3,\n4,5,,\n", [[1, 2, 3], [4, 5, NAN]]),
        ("1,2,3,\n4,5,6\n", [[1, 2, 3], [4, 5, 6]]),
        ("1,2,3\n4,5,6,\n7,8,\n", [[1, 2, 3], [4, 5, 6], [7, 8, NAN]]),
        ("a,b,c,\n4,5,6,\n", [[4, 5, 6]]),
        ("1,2,3\n \n\t\n4,5,6\n", [[1, 2, 3], [4, 5, 6]]),
        ("a,b,c\n4,5,6\n7,8,\n", [[4, 5, 6], [7, 8, NAN]]),
    ],
)
def test_a_mark_at_the_end_is_a_gap_only_where_one_is(tmp_path, text, expected):
    for mark in (",", ";", "\t"):
        path = tmp_path / "map.csv"
        path.write_text(text.replace(",", mark))
        np.testing.assert_array_equal(read(path, layout="matrix").heights, expected)


def test_a_table_of_three_columns_needs_a_layout(tmp_path):
    path = tmp_path / "map.csv"
    np.savetxt(path, HEIGHTS[:, :3])
    with pytest.raises(InputError, match="not a lattice of x and y"):
        read(path)
    np.testing.assert_allclose(read(path, layout="matrix").heights, HEIGHTS[:, :3])


def test_netcdf_is_read_with_units_and_axes(tmp_path):
    x, y = np.arange(32) * 2.0, np.arange(24) * 3.0
    data = xr.Dataset(
        {"z": (("x", "y"), HOLED.T * 1e6, {"units": "um"})},
        coords={"x": ("x", x, {"units": "um"}), "y": ("y", y, {"units": "um"})},
    )
    for engine in ("h5netcdf", "scipy"):
        path = tmp_path / f"{engine}.nc"
        data.to_netcdf(path, engine=engine)
        found = read(path)
        np.testing.assert_allclose(found.heights, HOLED * 1e6)
        assert (found.unit, found.pixel, found.pixel_units) == ("um", (2.0, 3.0), ("um", "um"))


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_netcdf_in_the_order_of_images_is_reversed(tmp_path, engine):
    """Rows from the top down, and columns from right to left."""
    ny, nx = HEIGHTS.shape
    places = {"y": np.arange(ny)[::-1] * 3.0, "x": -2.0 * np.arange(nx)}
    data = xr.Dataset({"z": (("y", "x"), HEIGHTS[::-1, ::-1])}, coords=places)
    data.to_netcdf(tmp_path / "a.nc", engine=engine)
    found = read(tmp_path / "a.nc")
    np.testing.assert_array_equal(found.heights, HEIGHTS)
    assert found.pixel == (2.0, 3.0)


def test_netcdf_with_uneven_falling_coordinates_is_reported(tmp_path):
    places = {"y": -(np.arange(HEIGHTS.shape[0]) ** 2.0)}
    xr.Dataset({"z": (("y", "x"), HEIGHTS)}, coords=places).to_netcdf(tmp_path / "a.nc")
    with pytest.raises(InputError, match="along y that do not follow at equal"):
        read(tmp_path / "a.nc")


def test_of_several_variables_one_must_be_named(tmp_path):
    path = tmp_path / "two.nc"
    tables = dict.fromkeys(("before", "after"), (("y", "x"), HEIGHTS))
    xr.Dataset(tables).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(InputError, match="has before, after: say which"):
        read(path)
    with pytest.raises(InputError, match='called "between": it has before, after'):
        read(path, variable="between")
    np.testing.assert_array_equal(read(path, variable="after").heights, HEIGHTS)


@pytest.mark.parametrize(("letter", "scale"), [("D", 1.0), ("F", 1.0), ("L", 1e-12), ("I", 1e-10)])
def test_x3p_is_read(tmp_path, letter, scale):
    path = write_x3p(tmp_path / "map.x3p", HOLED, letter, scale)
    found = read(path)
    np.testing.assert_allclose(found.heights, HOLED, rtol=1e-6, atol=0.51 * (scale % 1.0))
    assert (found.unit, found.pixel, found.pixel_units) == ("m", (2e-6, 3e-6), ("m", "m"))


def test_x3p_with_the_checksum_of_a_widespread_writer_is_read(tmp_path):
    digest = hashlib.md5(HEIGHTS.tobytes()).hexdigest()
    path = write_x3p(tmp_path / "map.x3p", HEIGHTS, checksum=digest)
    np.testing.assert_allclose(read(path).heights, HEIGHTS)


def test_files_of_instruments_need_an_extra_or_are_read(tmp_path):
    path = tmp_path / "map.sdf"
    ny, nx = HEIGHTS.shape
    keys = {"ManufacID": "test", "CreateDate": "010120261200", "ModDate": "010120261200"}
    keys |= {"NumPoints": nx, "NumProfiles": ny, "Xscale": 2e-6, "Yscale": 3e-6, "Zscale": 1e-9}
    keys |= {"Zresolution": -1, "Compression": 0, "DataType": 7, "CheckType": 0}
    lines = ["aISO-1.0", *(f"{key} = {value}" for key, value in keys.items()), "*"]
    numbers = " ".join(f"{value:.6f}" for value in (HEIGHTS * 1e9).ravel())
    path.write_text("\n".join([*lines, numbers, "*"]) + "\n")
    if find_spec("SurfaceTopography") is None:
        with pytest.raises(InputError, match=r"pip install \"tehl\[surfaces\]\""):
            read(path)
        return
    found = read(path)
    surface = Map(file=str(path), level="mean", unit=None)
    assert found.heights.shape == HEIGHTS.shape
    expected = HEIGHTS - HEIGHTS.mean()
    np.testing.assert_allclose(surface.load().values, expected, atol=1e-11)


def test_the_binary_dat_of_zygo_is_read_or_needs_the_extra(tmp_path):
    path = write_metropro(tmp_path / "map.dat", HOLED)
    if find_spec("SurfaceTopography") is None:
        with pytest.raises(InputError, match=r'format metropro, .* pip install "tehl\[surfaces\]"'):
            read(path)
        return
    found = read(path)
    np.testing.assert_allclose(found.heights, HOLED, atol=1e-11)
    assert (found.unit, found.pixel) == ("m", pytest.approx((2e-6, 2e-6)))
    assert "metropro, read by SurfaceTopography" in found.kind
    renamed = path.rename(tmp_path / "map.bin")
    assert read(renamed, form="metropro").heights.shape == HOLED.shape
    with pytest.raises(InputError, match="does not state how far its points are apart"):
        Map(file=str(write_metropro(path, HEIGHTS, pixel=0.0))).load()


def test_without_the_library_one_sentence_names_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography.IO", None)
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    path = write_metropro(tmp_path / "map.dat", HOLED)
    with pytest.raises(InputError, match=r'format metropro, .* pip install "tehl\[surfaces\]"'):
        read(path)


def test_a_format_is_forced(tmp_path):
    np.savetxt(tmp_path / "map.log", HEIGHTS * 1e6)
    with pytest.raises(InputError, match='or state one, format = "text"'):
        read(tmp_path / "map.log")
    np.testing.assert_allclose(read(tmp_path / "map.log", form="text").heights, HEIGHTS * 1e6)
    with pytest.raises(InputError, match="not a file of numpy"):
        read(tmp_path / "map.log", form="npy")


def test_each_format_that_a_case_may_state_has_a_reader(tmp_path):
    stated = Map.model_json_schema()["properties"]["format"]["enum"]
    assert set(stated) == {"auto", "npy", "npz", "text", "netcdf", "x3p", *INSTRUMENTS}
    path = tmp_path / "a.bin"
    path.write_bytes(b"\0" * 99)
    for form in stated:
        with pytest.raises(InputError):
            read(path, form=form)


def test_npz_is_read(tmp_path):
    np.savez_compressed(tmp_path / "one.npz", z=HEIGHTS)
    np.testing.assert_array_equal(read(tmp_path / "one.npz").heights, HEIGHTS)
    np.savez(tmp_path / "two.npz", z=HEIGHTS, x=np.arange(3.0), bad=np.array([object()]))
    found = read(tmp_path / "two.npz", variable="z")
    np.testing.assert_array_equal(found.heights, HEIGHTS)
    assert found.kind == "numpy archive, array z"
    for name, words in ((None, "has z, x, bad: say which"), ("y", 'called "y": it has z, x, bad')):
        with pytest.raises(InputError, match=words):
            read(tmp_path / "two.npz", variable=name)
    with pytest.raises(InputError, match="holds objects"):
        read(tmp_path / "two.npz", variable="bad")


HEADERS = {
    "comments": "# Channel: Height\n# Width: 64.0 um\n# Height: 72.0 µm\n# Value units: um\n",
    "keys": "Instrument: A 1\nSize = 64 um x 72 um\nData unit: um\n\n",
    "counts": "Size: 32 x 24\nPixel size: 2 um, 3 um\nData unit: [um]\n",
    "phase": "Pixel_Size = 0.002 mm x 3 um\nData unit = rad\nConversion factor = 1e-6 m/rad\n",
    "comma": "Size: 0,064 mm x 0,072 mm\nunit: rad\nconversion factor: 1 um\n",
}


@pytest.mark.parametrize("name", HEADERS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_the_header_of_a_text_states_size_and_unit(tmp_path, name, encoding):
    path = tmp_path / "map.asc"
    rows = "\n".join(" ".join(f"{value:.9g}" for value in row) for row in HEIGHTS * 1e6)
    path.write_text(HEADERS[name] + rows, encoding=encoding)
    found = read(path)
    np.testing.assert_allclose(found.heights, HEIGHTS * 1e6, rtol=1e-8)
    assert (found.pixel, found.pixel_units) == (pytest.approx((2e-6, 3e-6)), ("m", "m"))
    loaded = Map(file=str(path), level="mean").load()
    np.testing.assert_allclose(loaded.values, HEIGHTS - HEIGHTS.mean(), atol=1e-14)


def test_a_phase_without_its_height_is_explained(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("Data unit: rad\npixel size: 2 um\n")
    with path.open("a") as file:
        np.savetxt(file, HEIGHTS * 1e7)
    with pytest.raises(InputError, match=r"heights in rad, a phase: .* unit = \"50.4 nm\""):
        Map(file=str(path)).load()
    loaded = Map(file=str(path), unit="50.4 nm", level="mean").load()
    expected = 0.504 * (HEIGHTS - HEIGHTS.mean())
    np.testing.assert_allclose(loaded.values, expected, atol=1e-15)


# ---- wrong files


def test_hdf5_without_names_of_dimensions_is_read_without_warnings(tmp_path, recwarn):
    with h5py.File(tmp_path / "a.nc", "w") as file:
        file["z"] = HEIGHTS
    np.testing.assert_array_equal(read(tmp_path / "a.nc").heights, HEIGHTS)
    assert not recwarn.list
