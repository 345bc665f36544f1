"""Preparation of measured heights: gaps, spikes, form and filters."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tehl.base.errors import InputError
from tehl.roughness.prepare import filled, gaussian_mean, levelled, without_outliers
from tests.roughness.files import relief
from tests.roughness.maps import HEIGHTS, NX, NY, PIXEL, levelled_map, stated


def test_holes_are_counted_and_filled(tmp_path):
    holed = HEIGHTS * 1e6
    holed[10:13, 20:22] = np.nan
    holed[30, 7] = np.inf
    np.save(tmp_path / "few.npy", holed)
    surface = stated(str(tmp_path / "few.npy"))
    assert "7 missing points (0.23 %)" in surface.load().notes[0]
    assert np.abs(surface.load().values - levelled_map()).max() < 5 * levelled_map().std()
    with pytest.raises(InputError, match=r"7 points .*0.23 %.*row 11, column 21"):
        stated(str(tmp_path / "few.npy"), fill="refuse").load()
    holed[:10] = np.nan
    np.save(tmp_path / "many.npy", holed)
    with pytest.raises(InputError, match=r"647 points .*row 1, column 1.*say how to fill"):
        stated(str(tmp_path / "many.npy")).load()
    assert stated(str(tmp_path / "many.npy"), fill="nearest").rms > 0


def test_a_membrane_continues_a_plane():
    x, y = np.arange(30.0)[None, :], np.arange(20.0)[:, None]
    plane = 3 * x - 2 * y + 7
    holed = plane.copy()
    holed[5:12, 8:17] = np.nan
    np.testing.assert_allclose(filled(holed, "linear"), plane, atol=1e-4)
    with pytest.raises(InputError, match="too much to fill"):
        filled(np.where(y > 6, np.nan, plane), "linear")


@settings(deadline=None)
@given(arrays(float, (9, 8), elements=st.floats(-1, 1)), arrays(bool, (9, 8)))
def test_filling_never_leaves_the_range_and_keeps_the_rest(heights, gaps):
    if 0.0 < gaps.mean() <= 0.5:
        for how in ("linear", "nearest"):
            whole = filled(np.where(gaps, np.nan, heights), how)
            np.testing.assert_array_equal(whole[~gaps], heights[~gaps])
            assert heights[~gaps].min() - 1e-4 <= whole.min()
            assert whole.max() <= heights[~gaps].max() + 1e-4


def test_spikes_go_and_the_rest_stays():
    spiked = HEIGHTS.copy()
    spiked[7, 9] += 30e-6
    cleaned, count = without_outliers(spiked, 20.0)
    assert (count, np.isnan(cleaned[7, 9])) == (1, True)
    assert without_outliers(HEIGHTS, 20.0)[1] == 0


X, Y = np.arange(160.0)[None, :], np.arange(120.0)[:, None]
SMOOTH = {
    "wave": np.cos(2 * np.pi * X / 12) + 0 * Y,
    "crossed waves": np.cos(2 * np.pi * X / 12) * np.cos(2 * np.pi * Y / 14),
    "dent in a plane": np.where(np.hypot(X - 80, Y - 60) < 24, -1.0, 0.0)
    * np.cos(np.pi * np.hypot(X - 80, Y - 60) / 48) ** 2,
    "bump": np.exp(-((X - 80.3) ** 2 + (Y - 60.4) ** 2) / 5**2),
    "ball": -1e-3 * (X**2 + Y**2),
    "plane": 3 * X - 2 * Y,
    "flat": 0 * X + 0 * Y,
}


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("sigmas", [0.5, 3.0])
def test_no_point_of_a_smooth_map_is_a_spike(name, sigmas):
    assert without_outliers(1e-7 * SMOOTH[name] + 76e-3, sigmas)[1] == 0


@pytest.mark.parametrize("name", SMOOTH)
def test_spikes_of_smooth_maps_are_found(name):
    spiked = 1e-7 * SMOOTH[name]
    spiked[30:32, 40:42] += 3e-5
    spiked[90, 100] -= 3e-5
    cleaned, count = without_outliers(spiked, 3.0)
    assert (count, np.isnan(cleaned).sum()) == (5, 5)
    assert np.isnan(cleaned[30:32, 40:42]).all()


def test_a_missing_point_is_not_a_spike_and_makes_none():
    holed = 1e-7 * (SMOOTH["wave"] + SMOOTH["plane"])
    holed[20:25, 30:38] = np.nan
    assert without_outliers(holed, 3.0)[1] == 0


def test_spikes_and_missing_points_are_counted_apart_and_do_not_count(tmp_path):
    heights = relief(NY, NX)
    gaps, spikes = np.zeros((NY, NX), bool), np.zeros((NY, NX), bool)
    gaps[5:10, 20:22], spikes[30, 8:11] = True, True
    file = np.where(gaps, np.nan, np.where(spikes, heights + 5e-5, heights))
    np.save(tmp_path / "a.npy", file)
    loaded = stated(str(tmp_path / "a.npy"), unit="m", outliers=8.0, fill="linear").load()
    np.testing.assert_array_equal(loaded.measured, ~(gaps | spikes))
    assert (loaded.spikes, loaded.notes[:2]) == (
        3,
        ("3 spikes (0.098 %) were removed", "10 missing points (0.33 %) were filled"),
    )
    # the plane and Sq by least squares over the measured points alone
    rows, columns = np.nonzero(loaded.measured)
    terms = np.column_stack((np.ones(rows.size), rows, columns))
    rest = heights[loaded.measured]
    rest -= terms @ np.linalg.lstsq(terms, rest)[0]
    assert loaded.sq == pytest.approx(rest.std(), rel=1e-9)
    with pytest.raises(InputError, match=r"13 points without a height .*3 of them removed"):
        stated(str(tmp_path / "a.npy"), unit="m", outliers=8.0, fill="refuse").load()


@pytest.mark.parametrize(("how", "order"), [("mean", 0), ("plane", 1), ("quadratic", 2)])
def test_levelling_removes_the_stated_form_only(how, order):
    x, y = np.linspace(0, 3, 40)[None, :], np.linspace(-1, 5, 30)[:, None]
    terms = [np.ones((30, 40)), 2 * x - y, x**2 - 3 * x * y + 0.5 * y**2]
    form = sum(terms[: order + 1])
    np.testing.assert_allclose(levelled(form, how), 0, atol=1e-12)
    rest = levelled(HEIGHTS, how)
    np.testing.assert_allclose(levelled(rest, how), rest, atol=1e-20)
    assert rest.mean() == pytest.approx(0, abs=1e-20)


def test_half_of_a_wave_at_the_cut_off_passes_the_gaussian_filter():
    x = np.arange(2000) * 1e-6
    for cycles, passed in ((20, 0.5), (10, 0.5**0.25), (40, 0.5**4)):
        wave = np.tile(np.cos(np.pi * (x + 0.5e-6) * cycles / 1e-3), (8, 1))
        found = gaussian_mean(wave, (1e-6, 1e-6), 1e-4)  # wavelength 2 mm / cycles
        np.testing.assert_allclose(found, passed * wave, atol=2e-3)


def test_waves_between_both_cut_offs_are_kept(tmp_path):
    x = (np.arange(400) + 0.5) * PIXEL  # 800 um, mirrored at the edges
    waves = [np.cos(np.pi * x * count / 8e-4) for count in (2, 16, 160)]
    np.save(tmp_path / "a.npy", np.tile(sum(waves), (200, 1)))
    surface = stated(str(tmp_path / "a.npy"), unit="nm", lambda_c="300 um", lambda_s="30 um")
    kept = surface.load().values[100]
    # of the long wave nine percent are left, and six of the kept one are lost
    np.testing.assert_allclose(kept, 1e-9 * waves[1], atol=0.16e-9)
