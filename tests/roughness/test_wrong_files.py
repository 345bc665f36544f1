"""Files of heights that are wrong, damaged or dangerous: one sentence, and nothing runs."""

import gc
import io
import struct
import sys
import zipfile
from contextlib import suppress
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import xarray as xr

from tehl.base.errors import InputError
from tehl.roughness import Map
from tehl.roughness.files import checked, read
from tests.roughness.files import relief, write_x3p

HEIGHTS = relief()


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
    "prose": ("a.txt", b"It was a dark and stormy night; the rain fell.", "line 1 has|only text"),
    "words above": (
        "a.txt",
        b"Zygo XYZ Data\nsome more\n1 2 3\n",
        'line 2 .* header are "key: val',
    ),
    "half npz": ("a.npz", b"PK\x03\x04" + b"\0" * 99, "not a complete .npz file"),
    "binary text": ("a.txt", b"\x89PNG\xff\xfe\x00", "not a text in UTF-8"),
    "ragged": ("a.csv", b"1,2,3,4\n1,2,3\n", "line 2 has 3 numbers, .* have 4"),
    "ragged by two": ("a.csv", b"1,2,3,4\n1,2,\n", "line 2 has 2 numbers, .* have 4"),
    "longer": ("a.csv", b"1,2,3,\n1,2,3,4,\n", "line 2 has 4 numbers, .* have 3"),
    "underscores": ("a.csv", b"1,2,3,4\n1,2,3_0,4\n", "line 2 has '3_0', which is not a number"),
    "only names": ("a.csv", b"x,y,z\n", "contains only text"),
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
    "no zip": ("a.x3p", b"PK\x03\x04" + b"\0" * 99, "not a complete x3p"),
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
        ({"dx": "wide"}, "lacks a number at Record1/Axes/CX"),
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
            assert "not a complete x3p" in str(error)  # noqa: PT017 (a byte may have no effect)


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
        (str(tmp_path / "none.npy"), f'no map "none.npy" in {tmp_path}'),
        ("/dev/null", "not a regular file"),
        ("a\0b.npy", "cannot be read"),
        ("a" * 5000 + ".npy", "cannot be read"),
    ):
        with pytest.raises(InputError, match=words):
            checked(name)


def test_a_zip_bomb_is_not_unpacked(tmp_path):
    path = write_x3p(tmp_path / "map.x3p", np.zeros((1000, 1000)), nx=10, ny=10)
    assert path.stat().st_size < 10**6
    with pytest.raises(InputError, match="larger than its header allows"):
        read(path)


def test_a_wrong_length_in_a_header_is_reported(tmp_path):
    path = tmp_path / "a.npy"
    path.write_bytes(b"\x93NUMPY\x02\x00" + struct.pack("<I", 2**32 - 1) + b"{")
    with pytest.raises(InputError, match="header cannot be read"):
        read(path)
