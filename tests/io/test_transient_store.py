"""Transient results on disk: saved and loaded without loss, and messages for other files."""

from dataclasses import asdict, fields, replace

import h5netcdf
import h5py
import numpy as np
import pytest

import tehl
from tehl.api.results import Result, TransientResult, load_as
from tehl.base.errors import FileFormatError
from tehl.result.solution import Status
from tests.fixtures_transient import make_certified, make_transient


@pytest.fixture
def stored(tmp_path):
    path = tmp_path / "run.nc"
    make_transient().save(path)
    return path


def same(one, other) -> None:
    for field in fields(one):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))


def test_a_run_comes_back_bit_by_bit(stored):
    run, again = make_transient(), tehl.load(stored)
    assert isinstance(again, tehl.TransientResult)
    for name in ("history", "profiles", "frames"):
        same(getattr(run, name), getattr(again, name))
    assert again.frames.film.dtype == np.float32
    assert again.start.problem == run.start.problem
    assert (again.start.pressure == run.start.pressure).all()
    assert (again.time_step, again.status, again.cost) == (run.time_step, run.status, run.cost)
    assert again.provenance == run.provenance


def test_a_run_without_fields_comes_back(tmp_path):
    run = make_transient(frames=False)
    run.save(tmp_path / "run.nc")
    again = tehl.load(tmp_path / "run.nc")
    assert again.frames.film.shape == (0, 33, 33)


def test_error_bars_come_back_bit_by_bit(tmp_path):
    run = make_certified()
    run.save(tmp_path / "run.nc")
    again = tehl.load(tmp_path / "run.nc")
    assert again.uncertainty == run.uncertainty
    assert again.status == run.status
    same(run.bars, again.bars)


def test_a_run_without_error_bars_comes_back(stored):
    again = tehl.load(stored)
    assert again.uncertainty == {}
    assert again.bars is None


def test_error_bars_have_units_in_the_dataset_and_must_be_whole(tmp_path):
    data = make_certified().to_xarray()
    assert data.h_min_bar.dims == ("bar",)
    assert data.p_max_bar.attrs["units"] == "Pa"
    assert "bar_time" in data.coords
    make_certified().save(tmp_path / "run.nc")
    with h5py.File(tmp_path / "run.nc", "a") as file:
        file.pop("h_min_bar")
    with pytest.raises(FileFormatError, match="'h_min_bar' is missing"):
        tehl.load(tmp_path / "run.nc")


def test_the_summary_mirrors_certified_values():
    run = make_certified()
    found = run.summary()["uncertainty"]
    film = found["film"]
    assert film["h_min_m"]["value"]["value"] == run.uncertainty["film_minimum"].value
    assert film["h_central_m"]["least"]["domain"] == run.uncertainty["film_central_least"].domain
    assert set(film["h_central_m"]) == {"least", "largest"}
    assert found["pressure"]["p_max_pa"]["value"]["values"][2] < run.history.pressure_max.max()
    assert set(found) == {"film", "pressure", "temperature", "traction", "history"}
    assert found["history"]["h_min_m"] == run.bars.film_minimum.max()
    assert found["history"]["instants"] == 16
    assert "uncertainty" not in make_transient().summary()


def test_a_failed_run_says_so_in_its_file(tmp_path):
    status = Status(kind="stalled", cause="step_not_settled", message="it did not settle")
    replace(make_transient(), status=status).save(tmp_path / "run.nc")
    with h5netcdf.File(tmp_path / "run.nc") as file:
        assert file.attrs["converged"] == 0
    assert tehl.load(tmp_path / "run.nc").status == status


def test_a_steady_film_is_loaded_as_one(tmp_path, result):
    result.save(tmp_path / "film.nc")
    assert isinstance(tehl.load(tmp_path / "film.nc"), tehl.Result)
    assert load_as(Result, tmp_path / "film.nc").problem == result.problem
    with pytest.raises(FileFormatError, match="holds a steady result; expected a transient one"):
        load_as(TransientResult, tmp_path / "film.nc")


def test_a_reader_of_steady_results_rejects_a_transient_one(stored):
    assert load_as(TransientResult, stored).time_step > 0
    with pytest.raises(FileFormatError, match="holds a transient result; expected a steady one"):
        load_as(Result, stored)


def test_the_dataset_has_units_and_dimensions():
    data = make_transient().to_xarray()
    assert data.film_centre_line.dims == ("time", "x")
    assert data.film_frames.dims == ("frame", "y", "x")
    assert data.p_max.attrs["units"] == "Pa"
    assert "time" in data.coords
    assert all(one.attrs["long_name"] for one in data.variables.values())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda file: file.pop("film_frames"), "'film_frames' is missing"),
        (lambda file: file.pop("time"), "'time' is missing"),
        (
            lambda file: file["h_min"].write_direct(np.full(61, np.nan)),
            "h_min has non-finite",
        ),
        (lambda file: file.attrs.update(tehl_kind="movie"), "of kind 'movie'"),
        (lambda file: file["frame_step"].write_direct(np.full(4, 99)), "frame_step names steps"),
        (lambda file: file.attrs.update(transient="{"), "not a valid tehl result"),
    ],
)
def test_what_does_not_fit_is_reported_in_one_sentence(stored, change, words):
    with h5py.File(stored, "a") as file:
        change(file)
    with pytest.raises(FileFormatError, match=words) as caught:
        tehl.load(stored)
    assert "\n" not in str(caught.value)


def test_a_truncated_file_is_reported(stored):
    stored.write_bytes(stored.read_bytes()[:5000])
    with pytest.raises(FileFormatError, match="truncated or damaged"):
        tehl.load(stored)


def test_the_summary_has_extremes_with_their_times():
    run = make_transient()
    found = run.summary()
    least = found["film"]["h_min_m"]
    assert least["value"] == run.history.film_minimum.min()
    assert least["time_s"] == run.history.time[run.history.film_minimum.argmin()]
    assert found["cycles"]["per_step"] == 3.0
    assert found["start"]["film"]["h_min_m"] == pytest.approx(run.start.film.minimum)
    assert found["cost"] == asdict(run.cost)
    assert found["time"]["steps"] == 60
