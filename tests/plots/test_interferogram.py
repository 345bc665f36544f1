"""The physics and the colours of the synthetic interferogram."""

import numpy as np
import pytest

from tehl.plots.interferogram import Optics, colours

NM = 1e-9


@pytest.mark.parametrize("wavelength", [532 * NM, 635 * NM])
def test_fringes_follow_each_other_at_half_a_wavelength_in_the_oil(wavelength):
    optics = Optics(refractive_index=1.5)
    film = np.linspace(0, 2e-6, 200001)
    light = optics.reflectance(optics.thickness(film), wavelength)
    peaks = film[1:-1][(light[1:-1] > light[:-2]) & (light[1:-1] > light[2:])]
    assert np.diff(peaks) == pytest.approx(wavelength / (2 * 1.5), rel=1e-3)


def test_contact_is_dark_and_the_first_bright_fringe_is_a_quarter_wave_away():
    optics = Optics()
    thickness = np.array([0.0, 0.25 * 600 * NM])
    dark, bright = optics.reflectance(thickness, 600 * NM)
    first, second = 0.2, 0.55**2 * 0.6
    assert dark == pytest.approx((first**0.5 - second**0.5) ** 2)
    assert bright == pytest.approx((first**0.5 + second**0.5) ** 2)


def test_a_spacer_shifts_the_order():
    optics = Optics(spacer_thickness=150 * NM, spacer_index=1.46)
    assert optics.thickness(np.array([0.0])) == pytest.approx(219 * NM)


def test_the_index_grows_with_the_density():
    optics = Optics(refractive_index=1.48)
    q = 1.2 * (1.48**2 - 1) / (1.48**2 + 2)
    index = optics.thickness(np.array([1.0]), 1.2)
    assert index**2 == pytest.approx((1 + 2 * q) / (1 - q))
    assert index == pytest.approx(1.598, abs=2e-3)


def test_white_light_loses_its_colour_in_a_thick_film():
    thickness = np.linspace(0, 20e-6, 4001)
    spread = np.ptp(colours(thickness, Optics()), axis=-1)
    assert spread[:400].max() > 0.5
    assert spread[-400:].max() < 0.05


def test_a_thin_film_is_grey_and_the_first_colour_is_yellow():
    grey, yellow = colours(np.array([20.0, 100.0]) * NM * 1.0, Optics())[:2]
    assert np.ptp(grey) < 0.35
    red, green, blue = colours(np.array([210 * NM, 5e-6]), Optics())[0]
    assert red > blue
    assert green > blue
    assert np.all((yellow >= 0) & (yellow <= 1))


@pytest.mark.parametrize(("wavelength", "channel"), [(635 * NM, 0), (532 * NM, 1), (450 * NM, 2)])
def test_a_line_has_the_colour_of_its_wavelength(wavelength, channel):
    optics = Optics(light="monochromatic", wavelengths=(wavelength, 600 * NM))
    bright = colours(np.array([0.25 * wavelength, 1e-6]), optics)[0]
    assert int(np.argmax(bright)) == channel


def test_white_balance_leaves_even_light_grey():
    even = Optics(chromium_reflectance=0.0)
    assert np.ptp(colours(np.linspace(0, 1e-6, 50), even)) < 1e-9
