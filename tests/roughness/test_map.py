"""Measured surfaces: from a file to heights in the contact."""

import hashlib
import math
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError
from scipy import fft

from tehl.base.errors import InputError
from tehl.roughness import AnyRoughness, Map, Sum, Wave
from tests.roughness.files import relief, write_x3p, write_xyz
from tests.roughness.maps import HEIGHTS, NX, NY, PIXEL, levelled_map, stated


class Body(BaseModel):
    roughness: AnyRoughness


@pytest.fixture
def file(tmp_path):
    np.save(tmp_path / "map.npy", HEIGHTS * 1e6)
    return str(tmp_path / "map.npy")


def own_places(surface):
    """Return x and y of the points of a map."""
    ny, nx = surface.load().values.shape
    x = surface.x + (np.arange(nx) - 0.5 * (nx - 1)) * PIXEL
    y = surface.y + (np.arange(ny) - 0.5 * (ny - 1)) * PIXEL
    return x[None, :], y[:, None]


@pytest.mark.parametrize("outside", ["periodic", "mirror", "flat"])
def test_heights_at_the_points_are_those_of_the_file(file, outside):
    surface = stated(file, outside=outside, x="0.1 mm")
    found = surface.height(*own_places(surface))
    inner = (slice(8, -8), slice(8, -8))  # flat surroundings begin within
    np.testing.assert_allclose(found[inner], levelled_map()[inner], atol=1e-15)
    assert surface.rms == pytest.approx(levelled_map().std())


def test_a_map_is_not_transposed(file):
    """Columns are x, and rows are y, upward."""
    surface = stated(file, level="mean")
    x, y = own_places(surface)
    heights = HEIGHTS - HEIGHTS.mean()
    assert surface.height(x[:, 40], y[20, :]) == pytest.approx(heights[20, 40])
    turned = stated(file, level="mean", transpose=True)
    assert turned.height(y[20, :], x[:, 40]) == pytest.approx(heights[20, 40])
    flipped = stated(file, level="mean", flip_x=True, flip_y=True, upside_down=True)
    assert flipped.height(-x[:, 40], -y[20, :]) == pytest.approx(-heights[20, 40])


def test_beyond_the_edges_the_stated_rule_holds(file):
    repeated, mirrored, flat = (
        stated(file, outside=outside) for outside in ("periodic", "mirror", "flat")
    )
    x, y = own_places(repeated)
    width, height = NX * PIXEL, NY * PIXEL
    np.testing.assert_allclose(
        repeated.height(x + 3 * width, y - height), repeated.height(x, y), atol=1e-18
    )
    np.testing.assert_allclose(mirrored.height(width - x, y), mirrored.height(x, y), atol=1e-18)
    assert not flat.height(x + 1.5 * width, y).any()
    rim = flat.height(np.full((1, 1), 0.5 * width), y)
    assert np.abs(rim).max() < 0.02 * flat.rms
    assert "flat" in flat.load().notes[-1]
    assert "repeats" in repeated.load().notes[-1]


@settings(max_examples=25, deadline=None)
@given(st.floats(0, 1e-3), st.floats(-1, 1), st.floats(-4, 4))
def test_a_map_travels(tmp_path_factory, time, speed, angle):
    path = tmp_path_factory.getbasetemp() / "travel.npy"
    if not path.exists():
        np.save(path, HEIGHTS * 1e6)
    surface = stated(str(path), outside="mirror", rotate=angle)
    x, y = np.linspace(-1e-4, 1e-4, 12)[None, :], np.linspace(-1e-4, 1e-4, 10)[:, None]
    np.testing.assert_array_equal(
        surface.height(x, y, time, speed), surface.height(x - speed * time, y)
    )


def test_rotation_turns_as_the_angle_of_a_wave(tmp_path):
    x = np.arange(200) * PIXEL
    np.save(tmp_path / "a.npy", np.tile(np.cos(2 * np.pi * (x - 199 * PIXEL / 2) / 4e-5), (200, 1)))
    surface = stated(str(tmp_path / "a.npy"), unit="nm", rotate="30 deg", level="none")
    wave = Wave(amplitude=1e-9, wavelength=4e-5, angle=math.radians(30))
    places = np.linspace(-5e-5, 5e-5, 11)
    np.testing.assert_allclose(
        surface.height(places[None, :], places[:, None]),
        wave.height(places[None, :], places[:, None]),
        atol=1e-12,  # a cubic spline of twenty points per wave
    )


def test_a_mesh_gets_the_waves_that_it_can_carry(file):
    surface = stated(file, outside="periodic", level="mean")
    assert surface.resolved_on(1e-7, 1e-7).rms == pytest.approx(surface.rms, rel=1e-9)
    coarse = surface.resolved_on(4 * PIXEL, 4 * PIXEL)
    x, y = own_places(surface)
    power = np.abs(fft.rfft2(coarse.height(x, y))) ** 2
    whole = np.abs(fft.rfft2(surface.height(x, y))) ** 2
    np.testing.assert_allclose(power[1:4, 1:4], whole[1:4, 1:4], rtol=1e-6)  # long waves stay
    assert power[:, NX // 8 :].max() < 1e-12 * whole.max()  # two mesh widths and less go
    for outside in ("flat", "mirror"):
        other = stated(file, outside=outside, rotate=0.3)
        coarse = other.resolved_on(4 * PIXEL, 4 * PIXEL)
        assert 0.5 * other.rms < coarse.rms < other.rms
        assert coarse.shortest_wavelength > 1.2 * other.shortest_wavelength


@pytest.mark.parametrize("angle", [0.0, 90.0, 17.0])
def test_fine_maps_on_coarse_meshes_are_filtered_on_a_lattice_of_the_mesh(file, monkeypatch, angle):
    surface = stated(file, rotate=f"{angle} deg")
    mesh = (24 * PIXEL, 32 * PIXEL)
    whole = surface.resolved_on(*mesh)
    monkeypatch.setattr("tehl.roughness.tile._is_roomy", lambda *_: True)
    coarse = surface.resolved_on(*mesh)
    assert coarse.heights.size < 0.7 * whole.heights.size
    assert coarse.size == pytest.approx(whole.size)
    assert coarse.rms == pytest.approx(whole.rms, rel=1e-9)
    # slopes are differences over one pixel, which is up to twice as long
    assert coarse.shortest_wavelengths == pytest.approx(whole.shortest_wavelengths, rel=1e-3)
    x, y = np.linspace(-1e-4, 1e-4, 41)[None, :], np.linspace(-8e-5, 8e-5, 37)[:, None]
    expected = whole.height(x, y)
    np.testing.assert_allclose(coarse.height(x, y), expected, atol=2e-6 * np.abs(expected).max())


@pytest.mark.parametrize("pixel", ["10 nm", "0.1 nm"])
def test_the_rim_of_a_fine_map_is_never_stored(tmp_path, pixel):
    np.save(tmp_path / "afm.npy", relief(128, 160) * 1e6)
    surface = Map(file=str(tmp_path / "afm.npy"), unit="nm", pixel=pixel, level="none")
    tracemalloc.start()
    coarse = surface.resolved_on(2e-5, 2e-5)  # with its rim, 576 million points and more
    assert tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()
    (ny, nx), (width, height) = coarse.heights.shape, coarse.size
    assert max(ny, nx) < 250
    assert min(width, height) > 12 * 2e-5
    middle = float(coarse.height(np.zeros(1), np.zeros(1))[0])
    assert 0.0 < abs(middle) < 0.1 * surface.rms  # what a wave of two widths has of so small a map


def test_a_map_is_stored_and_read_without_its_file(file, tmp_path):
    rough = Body.model_validate(
        {"roughness": [{"type": "map", "file": file, "unit": "um", "pixel": ["2 um", "2 um"]}]}
    )
    (tmp_path / "map.npy").unlink()
    again = Body.model_validate_json(rough.model_dump_json())
    assert again == rough
    assert isinstance(again.roughness, Sum)
    with pytest.raises(InputError, match=r'no map "map\.npy" in /'):
        again.roughness.height(np.zeros(1), np.zeros(1))


def test_a_file_lies_beside_its_case(file, tmp_path):
    keys = {"type": "map", "file": "map.npy", "unit": "um", "pixel": PIXEL}
    surface = Body.model_validate({"roughness": keys}, context={"folder": tmp_path}).roughness
    assert surface.file == file
    assert surface.fingerprint == hashlib.sha256(Path(file).read_bytes()).hexdigest()


def test_a_changed_file_is_read_again(file):
    surface = stated(file)
    before = surface.rms
    np.save(file, HEIGHTS[:-1] * 3e6)
    assert surface.rms > 2 * before


# ---- units


def test_units_come_from_the_file_or_are_required(file, tmp_path):
    for missing, words in (("unit", "unit of its heights"), ("pixel", "how far its points")):
        keys = {"unit": "um", "pixel": "2 um"}
        keys.pop(missing)
        with pytest.raises(InputError, match=words):
            Map(file=file, **keys).load()
    xyz = write_xyz(tmp_path / "a.xyz", HEIGHTS * 1e6)
    with pytest.raises(InputError, match=r"2 and 3 apart .* unit.*xy_unit"):
        Map(file=str(xyz), unit="um").load()
    known = Map(file=str(xyz), unit="um", xy_unit="micron").load()
    assert known.pixel == pytest.approx((2e-6, 3e-6))
    assert Map(file=file, unit="um", size=("64 um", "24 um")).load().pixel == (1e-6, 5e-7)


def write_netcdf(path, x_unit, y_unit):
    """Write heights [um] with points 2 apart along x and 0.003 along y."""
    units = [{} if unit is None else {"units": unit} for unit in (x_unit, y_unit)]
    places = {"x": np.arange(NX) * 2.0, "y": np.arange(NY) * 0.003}
    coords = {key: (key, places[key], attrs) for key, attrs in zip("xy", units, strict=True)}
    heights = (("y", "x"), HEIGHTS * 1e6, {"units": "um"})
    xr.Dataset({"z": heights}, coords=coords).to_netcdf(path, engine="h5netcdf")
    return str(path)


@pytest.mark.parametrize(("x_unit", "y_unit"), [("um", "mm"), ("micrometers", "millimetre")])
def test_x_and_y_have_separate_units(tmp_path, x_unit, y_unit):
    found = Map(file=write_netcdf(tmp_path / "a.nc", x_unit, y_unit)).load()
    assert found.pixel == pytest.approx((2e-6, 3e-6))
    assert len(found.notes) == 1


def test_a_stated_unit_of_x_and_y_that_the_file_contradicts_is_noted(tmp_path):
    path = write_netcdf(tmp_path / "a.nc", "micron", "mm")
    found = Map(file=path, xy_unit="um").load()
    assert found.pixel == pytest.approx((2e-6, 3e-9))
    assert found.notes[0] == "its y is taken in um, though the file says mm"
    assert len(found.notes) == 2
    stated_too = Map(file=path, xy_unit="um", pixel="2 um").load()
    assert stated_too.notes[0].endswith("2 and 2 um apart, though the file says 2 and 3 um")


def test_units_of_x_or_y_that_are_missing_or_unknown_are_reported(tmp_path):
    half = write_netcdf(tmp_path / "half.nc", "um", None)
    with pytest.raises(InputError, match=r"their unit along y: give xy_unit"):
        Map(file=half).load()
    foreign = write_netcdf(tmp_path / "foreign.nc", "degrees_east", "degrees_east")
    with pytest.raises(InputError, match=r"unit 'degrees_east' for its x, which is not a length"):
        Map(file=foreign).load()
    assert Map(file=foreign, pixel="2 um").load().pixel == (2e-6, 2e-6)


def test_a_stated_value_overrides_the_file_and_is_noted(tmp_path):
    path = str(write_x3p(tmp_path / "a.x3p", HEIGHTS * 1e3))
    plain = Map(file=path.replace("a.x3p", "b.x3p"))
    write_x3p(tmp_path / "b.x3p", HEIGHTS)
    assert plain.load().pixel == (2e-6, 3e-6)
    assert len(plain.load().notes) == 1
    other = Map(file=path, unit="mm", pixel="1 um").load()
    assert other.values.std() == pytest.approx(levelled_map().std())
    assert "though the file says m" in other.notes[0]
    assert "though the file says 2 and 3 um" in other.notes[1]


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"unit": "mm"}, "Sq = 2e[+]02 um|Sq = 200 um|is the unit right"),
        ({"pixel": "1 km"}, "check unit, xy_unit"),
        ({"pixel": "1e-12 m"}, "check unit, xy_unit"),
        ({"crop": {"x": ["0 um", "4 um"]}}, "crop leaves fewer"),
        ({"crop": {"y": ["0 um", "4 mm"]}}, "goes beyond"),
        ({"lambda_c": "9 mm"}, "too little for lambda_c"),
    ],
)
def test_implausible_heights_are_rejected(file, keys, words):
    with pytest.raises(InputError, match=words):
        stated(file, **keys).load()


@pytest.mark.parametrize(("scale", "unit"), [(1.0, "nm"), (1e-3, "nm"), (1e-12, "um")])
def test_heights_that_a_wrong_unit_makes_tiny_are_rejected(tmp_path, scale, unit):
    np.save(tmp_path / "a.npy", HEIGHTS * scale)  # of metres
    surface = stated(str(tmp_path / "a.npy"), unit=unit)
    with pytest.raises(
        InputError, match=r"Sq = 1.*e-\d\d m .* less than 1e-12 m .*: is the unit right[?]"
    ):
        surface.load()
    filtered = stated(str(tmp_path / "a.npy"), unit=unit, lambda_s="8 um")
    with pytest.raises(InputError, match=r"right, and do lambda_c and lambda_s leave any\?"):
        filtered.load()


@pytest.mark.parametrize("unit", ["nm", "um", "mm"])
@pytest.mark.parametrize("offset", [0.0, 0.1, 40.0])
def test_planes_are_constant_in_every_unit(tmp_path, unit, offset):
    x, y = np.linspace(-1, 1, 30)[None, :], np.linspace(0, 1, 20)[:, None]
    np.save(tmp_path / "a.npy", offset + 0.3 * x + 0.7 * y)
    with pytest.raises(InputError, match="is constant"):
        stated(str(tmp_path / "a.npy"), unit=unit).load()


@pytest.mark.parametrize(
    ("heights", "words"),
    [
        (np.ones((20, 20)), "is constant"),
        (np.add.outer(np.arange(20.0), np.arange(20.0)), "is constant"),
        (np.zeros((1, 1)), "has 1 x 1 points"),
        (np.zeros((1, 300)), "has 300 x 1 points"),
        (np.full((9, 9), np.nan), "no point with a height"),
        (np.full((9, 9), np.inf), "no point with a height"),
        (np.where(np.eye(9) > 0, -32768e300, 0.0), "marks missing points by a number"),
    ],
)
def test_maps_without_roughness_are_reported(tmp_path, heights, words):
    np.save(tmp_path / "a.npy", heights)
    with pytest.raises(InputError, match=words):
        stated(str(tmp_path / "a.npy")).load()


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"unit": "kg"}, "not a unit of length"),
        ({"size": "1 mm"}, "say the same"),
        ({"file": " "}, "not the name of a file"),
        ({"taper": "1 um", "outside": "mirror"}, "outside = .flat. only"),
        ({"lambda_s": "9 um", "lambda_c": "8 um"}, "must be shorter"),
        ({"crop": {"x": ["9 um", "2 um"]}}, "x must rise"),
        ({"level": "sphere"}, "'plane'"),
        ({"outliers": 0}, "must be positive"),
    ],
)
def test_wrong_keys_are_reported_without_the_file(keys, words):
    with pytest.raises(ValidationError, match=words):
        stated(**{"file": "missing.npy"} | keys)


def test_a_map_reports_how_it_fits_the_contact(file):
    surface = stated(file)  # 128 x 96 um
    assert surface.fits(9e-5, 9e-5) == ()
    assert (
        "smaller than the contact; beyond its edges the surface is flat"
        in surface.fits(2e-4, 5e-5)[0]
    )
    assert "128 x 96 um and the contact of 200 x 50 um" in surface.fits(2e-4, 5e-5)[0]
    assert "small part" in surface.fits(4e-6, 4e-6)[0]
    assert "too coarse" in surface.fits(1.5e-5, 1.5e-5)[0]
    assert "lies beside" in stated(file, x="1 mm").fits(9e-5, 9e-5)[0]
    assert Sum(parts=(surface, Wave(amplitude=0, wavelength=1))).fits(2e-4, 5e-5)


# ---- preparation


def test_a_crop_is_that_part_of_the_file(file):
    surface = stated(file, crop={"x": ["20 um", "80 um"]}, level="mean")
    part = HEIGHTS[:, 10:40]
    np.testing.assert_allclose(surface.load().values, part - part.mean())


def test_a_symmetric_map_is_even_unless_it_is_turned_or_moved(tmp_path):
    np.save(tmp_path / "a.npy", HEIGHTS + HEIGHTS[::-1])
    for keys, even in (
        ({}, True),
        ({"x": "1 mm", "rotate": "180 deg", "level": "quadratic", "lambda_s": "8 um"}, True),
        ({"y": "1 um"}, False),
        ({"rotate": "90 deg"}, False),
        ({"crop": {"y": ["0 um", "20 um"]}}, False),
    ):
        surface = stated(str(tmp_path / "a.npy"), unit="m", **keys)
        assert surface.is_even_in_y == even
        if even:
            x, y = np.linspace(-5e-5, 5e-5, 17)[None, :], np.linspace(0, 5e-5, 9)[:, None]
            filtered = surface.resolved_on(7e-6, 7e-6)
            for one in (surface, filtered):
                np.testing.assert_allclose(one.height(x, y), one.height(x, -y), atol=1e-13)
