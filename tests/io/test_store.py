"""A stored result comes back whole, or not at all with a reason."""

import json
import math
import subprocess
import sys
from dataclasses import replace

import h5netcdf
import h5py
import numpy as np
import pytest

from tehl.api.results import Result, load
from tehl.base.atomic import check_writable
from tehl.base.errors import FileFormatError, InputError
from tehl.io import store
from tehl.io.store import load_summary, save, to_dataset
from tehl.studies import Store
from tests.fixtures_result import CASE, make_result


def assert_equal(first: Result, second: Result) -> None:
    for name in ("x", "y", "pressure", "film"):
        assert np.array_equal(getattr(first.scaled, name), getattr(second.scaled, name))
    scalars = [
        replace(one, scaled=None, history=(), shear=None, heat=None) for one in (first, second)
    ]
    assert scalars[0] == scalars[1]
    assert first.history == second.history


def test_a_result_comes_back_bit_by_bit(result, tmp_path):
    save(result, tmp_path / "out.nc")
    assert_equal(load(tmp_path / "out.nc"), result)


def test_shear_and_heat_come_back_bit_by_bit(thermal, tmp_path):
    save(thermal, tmp_path / "out.nc")
    back = load(tmp_path / "out.nc")
    assert_equal(back, thermal)
    for name in ("surface_1", "mid_film", "surface_2", "across", "thinning"):
        assert np.array_equal(getattr(back.shear, name), getattr(thermal.shear, name))
    for name in ("zeta", "weights", "temperature", "flux_1", "flux_2"):
        assert np.array_equal(getattr(back.heat, name), getattr(thermal.heat, name))
    for name in ("balance", "solid_peclet", "sources"):
        assert getattr(back.heat, name) == getattr(thermal.heat, name)
    assert back.history[-1].temperature_change == 0.0125


def test_shear_without_heat_comes_back(sheared, tmp_path):
    save(sheared, tmp_path / "out.nc")
    back = load(tmp_path / "out.nc")
    assert np.array_equal(back.shear.mid_film, sheared.shear.mid_film)
    assert back.heat is None


def test_a_thermal_file_explains_itself(thermal, tmp_path):
    xr = pytest.importorskip("xarray")
    save(thermal, tmp_path / "out.nc")
    with xr.open_dataset(tmp_path / "out.nc", engine="h5netcdf") as stored:
        xr.testing.assert_equal(stored.load(), to_dataset(thermal))
        assert stored.temperature.dims == ("zeta", "y", "x")
        assert (stored.temperature.units, stored.heat_flux_1.units) == ("K", "W/m^2")
        assert "zeta" in stored.coords
        assert stored.shear_stress_mid.long_name == "tau_zx at z = h/2"
        assert all({"units", "long_name"} <= set(v.attrs) for v in stored.variables.values())


@pytest.mark.parametrize(("name", "points"), [("temperature", (9, 65, 65)), ("zeta", (9,))])
def test_impossible_layers_are_rejected(thermal, tmp_path, name, points):
    save(thermal, tmp_path / "out.nc")
    with h5netcdf.File(tmp_path / "out.nc", "a") as file:
        file.variables[name][...] = np.full(points, np.nan)
    with pytest.raises(FileFormatError, match=name):
        load(tmp_path / "out.nc")


def test_a_file_without_its_fluxes_is_not_whole(thermal, tmp_path):
    save(thermal, tmp_path / "out.nc")
    with h5py.File(tmp_path / "out.nc", "a") as file:
        del file["heat_flux_1"]
    with pytest.raises(FileFormatError, match="'heat_flux_1' is missing"):
        load(tmp_path / "out.nc")


def test_more_blocks_go_into_the_summary_of_the_file(result, tmp_path):
    save(result, tmp_path / "out.nc", extra={"isothermal": {"ratio": math.nan}})
    with h5netcdf.File(tmp_path / "out.nc") as file:
        stored = json.loads(file.attrs["summary"])
    assert stored == result.summary() | {"isothermal": {"ratio": None}}
    assert_equal(load(tmp_path / "out.nc"), result)


def test_a_certified_result_keeps_its_error_bars(certified, tmp_path):
    certified.save(tmp_path / "out.nc")
    assert load(tmp_path / "out.nc").uncertainty == certified.uncertainty


def test_a_failed_result_comes_back_marked(stalled, tmp_path):
    save(stalled, tmp_path / "out.nc")
    back = load(tmp_path / "out.nc")
    assert back.status == stalled.status
    with h5netcdf.File(tmp_path / "out.nc") as file:
        assert file.attrs["status"] == "stalled"
        assert file.attrs["converged"] == 0


def test_a_diverged_result_with_nan_is_stored(stalled, tmp_path):
    film = replace(stalled.film_scaled, minimum=math.nan, central=math.inf)
    fields = replace(stalled.scaled, film=np.full_like(stalled.scaled.film, math.nan))
    save(replace(stalled, film_scaled=film, scaled=fields), tmp_path / "out.nc")
    back = load(tmp_path / "out.nc")
    assert math.isnan(back.film_scaled.minimum)
    assert back.film_scaled.central == math.inf
    assert np.isnan(back.scaled.film).all()


def test_a_result_without_history_is_stored(result, tmp_path):
    save(replace(result, history=(), errors=None), tmp_path / "out.nc")
    back = load(tmp_path / "out.nc")
    assert back.history == ()
    assert back.errors is None


def test_flat_surfaces_survive(tmp_path):
    case = {
        **CASE,
        "contact": {"load": 80.0, "entrainment_speed": 1.5},
        "surface_1": {"material": "steel", "radius": 0.02},
        "surface_2": {"material": "steel", "radius": "inf"},
    }
    flat = make_result(33, case=case)
    save(flat, tmp_path / "out.nc")
    assert load(tmp_path / "out.nc").problem == flat.problem


def test_xarray_reads_the_file_as_the_dataset(result, tmp_path):
    xr = pytest.importorskip("xarray")
    save(result, tmp_path / "out.nc")
    with xr.open_dataset(tmp_path / "out.nc", engine="h5netcdf") as stored:
        xr.testing.assert_equal(stored.load(), to_dataset(result))
        assert stored.film_thickness.dims == ("y", "x")
        assert stored.film_thickness.units == "m"
        assert "2/E' =" in stored.definitions
        assert json.loads(stored.problem)["title"] == "Ball on disc"
        assert all({"units", "long_name"} <= set(v.attrs) for v in stored.variables.values())


def test_the_dataset_has_the_case_as_attributes(result):
    attrs = to_dataset(result).attrs
    assert json.loads(attrs["summary"]) == result.summary()
    assert json.loads(attrs["options"])["points"] == 65


def test_a_file_cut_short_is_called_truncated(result, tmp_path):
    path = tmp_path / "out.nc"
    save(result, path)
    whole = path.read_bytes()
    for part in (0.3, 0.7, 0.99):
        path.write_bytes(whole[: int(part * len(whole))])
        with pytest.raises(FileFormatError, match="truncated or damaged"):
            load(path)


def test_flipped_bits_in_a_field_are_seen(result, tmp_path):
    path = tmp_path / "out.nc"
    save(result, path)
    with h5netcdf.File(path) as file:
        chunk = file.variables["P"]._h5ds.id.get_chunk_info(0)
    data = bytearray(path.read_bytes())
    middle = chunk.byte_offset + chunk.size // 2
    data[middle] ^= 0xFF
    path.write_bytes(data)
    with pytest.raises(FileFormatError, match="truncated or damaged"):
        load(path)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b"title = 1\n", "not a NetCDF-4 file"),
        (b"CDF\x01" + bytes(100), "NetCDF-3"),
        (b"\x89HDF\r\n\x1a\n" + bytes(10), "truncated or damaged"),
    ],
)
def test_foreign_files_are_rejected_with_their_name(tmp_path, content, reason):
    path = tmp_path / "foreign.nc"
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match=rf"foreign\.nc.*{reason}"):
        load(path)


def test_a_netcdf_file_of_another_program_is_rejected(tmp_path):
    with h5netcdf.File(tmp_path / "other.nc", "w") as file:
        file.dimensions = {"x": 3}
        file.create_variable("a", ("x",), data=np.ones(3))
    with pytest.raises(FileFormatError, match="not a tehl result"):
        load(tmp_path / "other.nc")


def change(path, **attrs) -> None:
    with h5netcdf.File(path, "a") as file:
        file.attrs.update(attrs)


@pytest.mark.parametrize(
    ("attrs", "reason"),
    [
        ({"tehl_format": 99}, "format 99"),
        ({"state": "{}"}, "scales"),
        ({"state": "{"}, "not a valid"),
        ({"problem": "{}"}, "contact"),
    ],
)
def test_tampered_attributes_are_named(result, tmp_path, attrs, reason):
    save(result, tmp_path / "out.nc")
    change(tmp_path / "out.nc", **attrs)
    with pytest.raises(FileFormatError, match=rf"out\.nc.*{reason}"):
        load(tmp_path / "out.nc")


def test_a_key_of_another_version_is_named_with_that_version(result, tmp_path):
    save(result, tmp_path / "out.nc")
    tables = result.problem.model_dump(mode="json", exclude_none=True) | {"novelty": {"part": 1}}
    change(tmp_path / "out.nc", problem=json.dumps(tables), source="tehl 99.1")
    with pytest.raises(FileFormatError, match=r"novelty: .* \(written by tehl 99\.1, this is tehl"):
        load(tmp_path / "out.nc")


def test_a_missing_file_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match=r"none\.nc does not exist"):
        load(tmp_path / "none.nc")


@pytest.mark.parametrize("failure", [KeyboardInterrupt, OSError, MemoryError])
def test_a_broken_write_leaves_nothing(result, tmp_path, monkeypatch, failure):
    def broken(*_args):
        raise failure

    monkeypatch.setattr(store, "_write", broken)
    with pytest.raises(failure):
        save(result, tmp_path / "out.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_broken_write_keeps_the_older_file(result, tmp_path, monkeypatch):
    save(result, tmp_path / "out.nc")
    before = (tmp_path / "out.nc").read_bytes()
    monkeypatch.setattr(store, "attributes", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        save(result, tmp_path / "out.nc")
    assert (tmp_path / "out.nc").read_bytes() == before
    assert len(list(tmp_path.iterdir())) == 1


def test_a_place_that_is_not_writable_is_rejected(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        check_writable(tmp_path / "none" / "out.nc")
    with pytest.raises(InputError, match="is a folder"):
        check_writable(tmp_path)


def test_checking_makes_nothing(tmp_path):
    check_writable(tmp_path / "out.nc")
    assert list(tmp_path.iterdir()) == []


def test_saving_and_loading_import_no_compiler_and_no_xarray(result, tmp_path):
    save(result, tmp_path / "out.nc")
    code = (
        "import sys; from tehl.io.store import load, save; r = load(sys.argv[1]); "
        "print([m for m in ('numba', 'xarray', 'pandas', 'scipy') if m in sys.modules]); "
        "save(r, sys.argv[1]); "  # its drag beyond the grid needs scipy, as the solver did
        "print([m for m in ('numba', 'xarray', 'pandas') if m in sys.modules])"
    )
    run = [sys.executable, "-c", code, str(tmp_path / "out.nc")]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["[]", "[]"]


def test_a_damaged_byte_anywhere_is_reported_in_one_line_or_harmless(result, tmp_path):
    save(result, tmp_path / "out.nc")
    whole = (tmp_path / "out.nc").read_bytes()
    for place in range(8, min(len(whole), 4000), 61):
        data = bytearray(whole)
        data[place] ^= 0xFF
        (tmp_path / "bad.nc").write_bytes(data)
        try:
            load(tmp_path / "bad.nc")
        except FileFormatError as error:
            message = str(error)
            assert "bad.nc" in message
            assert "\n" not in message
            assert "Unable" not in message or "truncated or damaged" in message


@pytest.mark.parametrize("extra", [{"a": 1 + 2j}, {"a": np.array([1j])}, {"a": object()}])
def test_extra_blocks_that_are_not_plain_data_are_rejected(result, tmp_path, extra):
    with pytest.raises(InputError, match="not plain data"):
        save(result, tmp_path / "a.nc", extra=extra)
    assert not list(tmp_path.iterdir())


def test_extra_blocks_that_are_nested_too_deeply_are_rejected(result, tmp_path):
    deep: dict = {}
    for _ in range(10**5):
        deep = {"a": deep}
    with pytest.raises(InputError, match="nested too deeply"):
        save(result, tmp_path / "a.nc", extra=deep)
    while deep:  # or its destructor would recurse
        deep = deep["a"]


def test_a_name_with_a_nul_is_reported_before_any_work(result, tmp_path):
    for act in (
        lambda: save(result, f"{tmp_path}/a\0b.nc"),
        lambda: load(f"{tmp_path}/a\0b.nc"),
        lambda: Store(f"{tmp_path}/a\0b"),
    ):
        with pytest.raises(InputError, match=r"a\?b") as error:
            act()
        assert str(error.value).isprintable()


def test_complex_fields_and_deep_summaries_are_rejected(result, tmp_path):
    path = tmp_path / "a.nc"
    save(result, path)
    with h5py.File(path, "a") as file:
        values = file["P"][...]
        del file["P"]
        file["P"] = values + 1j
    with pytest.raises(FileFormatError, match="P does not hold real numbers"):
        load(path)
    save(result, path)
    with h5py.File(path, "a") as file:
        file.attrs["summary"] = "[" * 20_000 + "]" * 20_000
    with pytest.raises(FileFormatError, match="truncated or damaged"):
        load_summary(path)


def test_a_cut_result_and_a_film_below_zero_are_rejected(result, tmp_path):
    """Reports and pictures take the middle of the contact, and a film."""
    path = tmp_path / "cut.nc"
    for name, change_of, words in (
        ("X", lambda x: x - x[-1] - 0.1, "the coordinate x leaves out the middle of the contact"),
        ("H", lambda film: film - 1.0, "film is not positive in a converged result"),
    ):
        save(result, path)
        with h5py.File(path, "a") as file:
            file[name][...] = change_of(file[name][...])
        with pytest.raises(FileFormatError, match=words):
            load(path)
