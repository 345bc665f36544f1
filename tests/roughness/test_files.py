"""Files of heights: right ones are read, wrong ones are reported in a sentence."""

import gc
import hashlib
import io
import struct
import sys
import zipfile
from contextlib import suppress
from importlib.util import find_spec
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import xarray as xr

from tehl.errors import InputError
from tehl.roughness import Map
from tehl.roughness.files import INSTRUMENTS, checked, read
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


def npy(shape, dtype="<f8", content=b""):
    """Return a .npy file with any header."""
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": dtype, "fortran_order": False, "shape": shape}
    )
    return file.getvalue() + content


def saved(array):
    file = io.BytesIO()
    np.save(file, array, allow_pickle=True)
    return file.getvalue()


WRONG = {
    "4 GB header": ("a.npy", npy((23000, 23000)), "claims 23000 x 23000 points"),
    "huge shape": ("a.npy", npy((10**12, 10**12)), "claims 1000000000000 x"),
    "truncated npy": ("a.npy", npy((100, 100), content=b"0" * 9000), "truncated.* 80000 bytes"),
    "half a header": ("a.npy", saved(HEIGHTS)[:40], "header cannot be read"),
    "garbage npy": ("a.npy", b"\x00\xff" * 400, "not a file of numpy"),
    "negative sides": ("a.npy", npy((-5, -5), content=b"0" * 400), r"claims .* shape \(-5, -5\)"),
    "one negative side": ("a.npy", npy((-5, 5), content=b"0" * 400), r"shape \(-5, 5\)"),
    "truth as a side": ("a.npy", npy((20, True), content=b"0" * 400), r"shape \(20, True\)"),
    "nothing times much": ("a.npy", npy((0, 10**30)), "claims 0 x 1000"),
    "endless header": ("a.npy", npy((4,) * 2000), "shape 4 x 4 x .* x [.]{3}, but"),
    "pickle": ("a.npy", saved(np.array([[object()]])), "holds objects"),
    "complex": ("a.npy", saved(HEIGHTS * 1j), "holds complex numbers"),
    "words": ("a.npy", saved(np.array([["a", "b"]])), "holds text"),
    "records": ("a.npy", saved(np.zeros((4, 4), [("a", "f8")])), "holds records"),
    "a row of numbers": ("a.npy", saved(np.zeros(9)), "array of shape 9, but"),
    "a single number": ("a.npy", saved(np.float64(1)), "array of shape no"),
    "several layers": ("a.npy", saved(np.zeros((2, 3, 4))), "shape 2 x 3 x 4"),
    "text garbage": ("a.csv", b"1 2 3 4\n1 2 hello 4\n", "line 2 has 'hello'"),
    "prose": ("a.txt", b"It was a dark and stormy night; the rain fell.", "line 1 has|no numbers"),
    "words above": (
        "a.txt",
        b"Zygo XYZ Data\nsome more\n1 2 3\n",
        'line 2 .* header are "key: val',
    ),
    "half npz": ("a.npz", b"PK\x03\x04" + b"\0" * 99, "not a whole .npz file"),
    "binary text": ("a.txt", b"\x89PNG\xff\xfe\x00", "not a text in UTF-8"),
    "ragged": ("a.csv", b"1,2,3,4\n1,2,3\n", "line 2 has 3 numbers, .* have 4"),
    "ragged by two": ("a.csv", b"1,2,3,4\n1,2,\n", "line 2 has 2 numbers, .* have 4"),
    "longer": ("a.csv", b"1,2,3,\n1,2,3,4,\n", "line 2 has 4 numbers, .* have 3"),
    "underscores": ("a.csv", b"1,2,3,4\n1,2,3_0,4\n", "line 2 has '3_0', which is not a number"),
    "only names": ("a.csv", b"x,y,z\n", "holds no numbers"),
    "nothing": ("a.csv", b"", "is empty"),
    "two heights": ("a.xyz", b"0 0 1\n1 0 1\n0 1 1\n1 1 1\n1 1 2\n", "several heights at one"),
    "four columns": ("a.xyz", b"0 0 1 1\n1 0 1 1\n", "has 4 columns"),
    "a spiral": (
        "a.xyz",
        "\n".join(f"{t * np.cos(t)} {t * np.sin(t)} 1" for t in range(50)).encode(),
        "not a lattice",
    ),
    "uneven": ("a.xyz", b"0 0 1\n1 0 1\n3 0 1\n0 1 1\n1 1 1\n3 1 1\n", "equal, rising"),
    "garbage netcdf": ("a.nc", b"\x00\x01" * 99, "is not a NetCDF file"),
    "half netcdf": ("a.nc", b"\x89HDF\r\n\x1a\n" + b"\0" * 99, "truncated or damaged"),
    "classic netcdf": ("a.nc", b"CDF\x01\0\0\0\0\0\0", "truncated or damaged"),
    "no zip": ("a.x3p", b"PK\x03\x04" + b"\0" * 99, "not a whole x3p"),
    "picture": ("a.png", b"\x89PNG", "ending that is not a format"),
    "pickle file": ("a.pkl", b"\x80\x04.", "ending that is not a format"),
    "no ending": ("a", b"1 2 3 4", "ending that is not a format"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_files_are_reported(tmp_path, case):
    name, content, words = WRONG[case]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=words) as error:
        Map(file=str(path), unit="um", pixel="2 um").load()
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cut": 8}, "truncated"),
        ({"md5": "0" * 32}, "checksum of bindata/data.bin"),
        ({"checksum": "0" * 32}, "checksum of its header"),
        ({"doctype": '<!DOCTYPE a [<!ENTITY b "c">]>'}, "document type or entities"),
        ({"nx": 70000, "ny": 70000}, "claims 70000 x 70000"),
        ({"nx": 5000, "ny": 5000}, "truncated"),
        ({"nx": 8}, "larger than its header allows"),
        ({"nx": "1e3"}, "no count at SizeX"),
        ({"dx": "wide"}, "no number at Record1/Axes/CX"),
        ({"dx": 0}, "not positive"),
        ({"feature": "PRF"}, "type PRF"),
        ({"valid": "<ValidPointsLink>../../etc/passwd</ValidPointsLink>"}, "without"),
        ({"feature": "&lol;"}, "not XML"),
    ],
)
def test_wrong_x3p_are_reported(tmp_path, changes, words):
    path = write_x3p(tmp_path / "map.x3p", HEIGHTS, **changes)
    with pytest.raises(InputError, match=words):
        read(path)


@pytest.mark.parametrize("method", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2, zipfile.ZIP_DEFLATED])
def test_a_flipped_byte_of_packed_heights_is_reported_or_without_effect(tmp_path, method):
    path = write_x3p(tmp_path / "map.x3p", HEIGHTS, method=method)
    whole = path.read_bytes()
    start = whole.index(b"bindata/data.bin") + 16
    for place in range(start, start + 200, 7):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        try:
            np.testing.assert_array_equal(read(path).heights, HEIGHTS)
        except InputError as error:
            assert "not a whole x3p" in str(error)  # noqa: PT017 (a byte may have no effect)


@pytest.mark.parametrize("encoding", ["foo", "rot13", "hex", "utf-7"])
def test_a_header_in_an_unknown_encoding_is_reported(tmp_path, encoding):
    path = write_x3p(tmp_path / "map.x3p", HEIGHTS, encoding=encoding)
    with pytest.raises(InputError, match=r"encoding that cannot be read, .*: it must be UTF-8"):
        read(path)


def test_damaged_netcdf_is_reported_without_warnings(tmp_path, monkeypatch):
    noise = []
    monkeypatch.setattr("sys.unraisablehook", noise.append)
    path = tmp_path / "a.nc"
    xr.Dataset({"z": (("y", "x"), HEIGHTS)}, attrs={"a": "b"}).to_netcdf(path, engine="h5netcdf")
    whole = path.read_bytes()
    for place in range(48, 400):  # the header of the root and its attributes
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        with suppress(InputError):
            read(path)
    gc.collect()
    assert noise == []


def test_hdf5_without_names_of_dimensions_is_read_without_warnings(tmp_path, recwarn):
    with h5py.File(tmp_path / "a.nc", "w") as file:
        file["z"] = HEIGHTS
    np.testing.assert_array_equal(read(tmp_path / "a.nc").heights, HEIGHTS)
    assert not recwarn.list


@pytest.mark.parametrize("way", ["storage", "link", "link in a group", "virtual"])
def test_hdf5_that_reads_another_file_is_rejected(tmp_path, way):
    HEIGHTS.tofile(tmp_path / "other.bin")
    with h5py.File(tmp_path / "other.nc", "w") as file:
        file["z"] = HEIGHTS
    with h5py.File(tmp_path / "a.nc", "w") as file:
        if way == "storage":
            outside = [(str(tmp_path / "other.bin"), 0, HEIGHTS.nbytes)]
            file.create_dataset("z", HEIGHTS.shape, HEIGHTS.dtype, external=outside)
        elif way == "virtual":
            layout = h5py.VirtualLayout(HEIGHTS.shape, HEIGHTS.dtype)
            layout[:] = h5py.VirtualSource(tmp_path / "other.nc", "z", HEIGHTS.shape)
            file.create_virtual_dataset("z", layout)
        else:
            group = file if way == "link" else file.create_group("inner")
            group["z"] = h5py.ExternalLink(str(tmp_path / "other.nc"), "/z")
            file["heights"] = HEIGHTS
    with pytest.raises(InputError, match=r"has data in another file .*: copy all into one file"):
        read(tmp_path / "a.nc")


def test_hdf5_of_an_instrument_does_not_read_another_file(tmp_path, monkeypatch):
    reader = SimpleNamespace(open_topography=lambda *_, **__: pytest.fail("was opened"))
    monkeypatch.setitem(sys.modules, "SurfaceTopography", SimpleNamespace(IO=reader))
    monkeypatch.setitem(sys.modules, "SurfaceTopography.IO", reader)
    with h5py.File(tmp_path / "a.datx", "w") as file:
        file["z"] = h5py.ExternalLink(str(tmp_path / "other.nc"), "/z")
    with pytest.raises(InputError, match="has data in another file"):
        read(tmp_path / "a.datx")


def test_code_in_a_pickle_does_not_run(tmp_path):
    class Bomb:
        def __reduce__(self):
            return (open, (str(tmp_path / "executed"), "w"))

    np.save(tmp_path / "a.npy", np.array([[Bomb()]], dtype=object), allow_pickle=True)
    with pytest.raises(InputError):
        read(tmp_path / "a.npy")
    assert not (tmp_path / "executed").exists()


def test_places_that_are_not_files_are_reported(tmp_path):
    for name, words in (
        (str(tmp_path), "is a folder"),
        (str(tmp_path / "none.npy"), "does not exist"),
        ("/dev/null", "not a regular file"),
        ("a\0b.npy", "cannot be read"),
        ("a" * 5000 + ".npy", "cannot be read"),
    ):
        with pytest.raises(InputError, match=words):
            checked(name)


def test_a_zip_bomb_is_not_unpacked(tmp_path):
    path = write_x3p(tmp_path / "map.x3p", np.zeros((3000, 3000)), nx=10, ny=10)
    assert path.stat().st_size < 10**6
    with pytest.raises(InputError, match="larger than its header allows"):
        read(path)


def test_a_wrong_length_in_a_header_is_reported(tmp_path):
    path = tmp_path / "a.npy"
    path.write_bytes(b"\x93NUMPY\x02\x00" + struct.pack("<I", 2**32 - 1) + b"{")
    with pytest.raises(InputError, match="header cannot be read"):
        read(path)
