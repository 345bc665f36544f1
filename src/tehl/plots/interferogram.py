"""Synthetic interferograms of the film, as an optical rig shows them.

Light falls through a glass disc with a semi-reflecting chromium layer (and a transparent spacer, if
any) and the oil onto the steel ball. Two beams interfere, from the chromium and from the ball:

    I(lambda) = R1 + R2 + 2 sqrt(R1 R2) cos(4 pi d / lambda + phase),   d = n h + n_s h_s

with R1 the reflectance of the chromium and R2 that of the ball seen twice through the chromium.
Colours are the spectrum under the CIE 1931 observer, turned into sRGB.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tehl.base.typing import Array
from tehl.plots.arrows import MICRO
from tehl.plots.frame import figure_of, map_axes, window_part
from tehl.result.solution import Solution

Light = Literal["white", "dichromatic", "monochromatic"]
_PIXELS_ALONG_X = 900
"""Pixels along x; the film is interpolated so that fringes stay clean."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Optics:
    """Light, layers and oil of an optical rig."""

    light: Light = "white"
    """A halogen lamp with white balance, two lines or the first of them."""
    wavelengths: tuple[float, float] = (635e-9, 532e-9)
    """Middle of the two lines in vacuum [m]."""
    bandwidth: float = 3e-9
    """Width of a line (standard deviation of its Gaussian) [m]."""
    colour_temperature: float = 3200.0
    """Of the white lamp [K]."""
    refractive_index: float = 1.48
    """Of the oil at ambient pressure."""
    spacer_thickness: float = 0.0
    spacer_index: float = 1.46
    """Thickness [m] and refractive index of a spacer layer; none by default."""
    chromium_reflectance: float = 0.20
    chromium_transmittance: float = 0.55
    """Of the semi-reflecting layer."""
    ball_reflectance: float = 0.60
    """Of the ball."""
    phase: float = np.pi
    """Phase between the beams at zero distance [rad]; pi makes the zeroth order dark."""

    def thickness(self, film: Array, density_ratio: Array | float = 1.0) -> Array:
        r"""Return the optical thickness ``n h + n_s h_s`` [m] of a film and the spacer.

        The index n of the oil follows its density after Lorentz and Lorenz,
        :math:`(n^2 - 1)/(n^2 + 2) \propto \rho`: some 8 % more at 0.8 GPa.

        Parameters
        ----------
        film : Array
            Film thickness h [m].
        density_ratio : Array or float
            Density over that at ambient pressure [-].
        """
        squared = self.refractive_index**2
        refraction = (squared - 1.0) / (squared + 2.0) * density_ratio
        index = np.sqrt((1.0 + 2.0 * refraction) / (1.0 - refraction))
        return index * film + self.spacer_index * self.spacer_thickness

    def reflectance(self, thickness: Array, wavelength: Array | float) -> Array:
        """Return the reflected part of light [-], by two beams.

        Parameters
        ----------
        thickness : Array
            Optical thickness [m].
        wavelength : Array or float
            In vacuum [m], broadcast against ``thickness``.
        """
        first = self.chromium_reflectance
        second = self.chromium_transmittance**2 * self.ball_reflectance
        turn = 4.0 * np.pi * thickness / wavelength + self.phase
        return first + second + 2.0 * np.sqrt(first * second) * np.cos(turn)

    def spectrum(self, wavelength: Array) -> Array:
        """Return the light of the lamp at each wavelength [m], on any scale."""
        if self.light == "white":
            hc_over_k = 1.438777e-2
            return wavelength**-5 / np.expm1(hc_over_k / (wavelength * self.colour_temperature))
        lines = self.wavelengths[: 1 if self.light == "monochromatic" else 2]
        shapes = [np.exp(-0.5 * ((wavelength - line) / self.bandwidth) ** 2) for line in lines]
        luminosity = _observer(wavelength * 1e9)[:, 1]
        return np.sum([shape / (shape @ luminosity) for shape in shapes], axis=0)

    def caption(self) -> str:
        """Return light, index and spacer in words."""
        red, green = (f"{wavelength * 1e9:.0f} nm" for wavelength in self.wavelengths)
        light = {
            "white": f"white light, {self.colour_temperature:.0f} K, balanced",
            "dichromatic": f"{red} and {green}",
            "monochromatic": red,
        }[self.light]
        spacer = f", spacer {self.spacer_thickness * 1e9:.0f} nm" if self.spacer_thickness else ""
        return f"synthetic interferogram: {light}, n = {self.refractive_index:g} at ambient{spacer}"


def interferogram(
    result: Solution,
    optics: Optics | None = None,
    *,
    ax: Axes | None = None,
    title: bool | None = True,
) -> Figure:
    """Draw the film as an optical rig shows it; in white light if ``optics`` is left out.

    Parameters
    ----------
    result : Solution
        What to draw, as if seen through a transparent surface.
    optics : Optics or None
        Light, layers and oil.
    ax : Axes or None
        Where to draw; None makes a figure.
    title : bool or None
        Whether a new figure has a title.
    """
    from scipy.interpolate import RectBivariateSpline  # noqa: PLC0415 (0.3 s)

    chosen, part = Optics() if optics is None else optics, window_part(result)
    x, y = result.x[part[1]], result.y[part[0]]
    fine_x = np.linspace(x[0], x[-1], _PIXELS_ALONG_X)
    fine_y = np.linspace(y[0], y[-1], max(2, round(_PIXELS_ALONG_X * np.ptp(y) / np.ptp(x))))
    film, pressure = (
        np.nan_to_num(field[part], nan=0.0, posinf=0.0, neginf=0.0)
        for field in (result.film_thickness, result.pressure)
    )
    law = result.problem.lubricant.density
    ratio = law.density(pressure, result.scales.temperature) / result.scales.density
    thickness = RectBivariateSpline(y, x, chosen.thickness(film, ratio))(fine_y, fine_x)
    axes = map_axes(result, chosen.caption(), ax=ax, title=title)
    extent = (x[0] * MICRO, x[-1] * MICRO, y[0] * MICRO, y[-1] * MICRO)
    limits = {"xlim": axes.get_xlim(), "ylim": axes.get_ylim()}
    style: dict[str, Any] = {"origin": "lower", "interpolation": "bilinear"}
    axes.imshow(colours(thickness, chosen), extent=extent, aspect=axes.get_aspect(), **style)
    axes.set(**limits)
    return figure_of(axes)


def colours(thickness: Array, optics: Optics) -> Array:
    """Return the colours of an array of optical thickness.

    They are interpolated in a table over the thickness.

    Parameters
    ----------
    thickness : Array
        Optical thickness ``n h + n_s h_s`` [m], of any shape.
    optics : Optics
        Light, reflectances and phase.

    Returns
    -------
    Array
        sRGB from 0 to 1, one axis more than ``thickness``; the brightest fringe has 1.
    """
    top = max(float(np.max(thickness)), 1e-6)
    table = np.linspace(0.0, top, int(np.clip(top / 1e-9, 500, 20000)))
    wavelength = np.arange(380.0, 781.0) * 1e-9
    weights = optics.spectrum(wavelength)[:, None] * _observer(wavelength * 1e9) @ _SRGB.T
    if optics.light == "white":
        weights = weights / weights.sum(axis=0)
    spectra = optics.reflectance(table[:, None], wavelength[None, :])
    linear = np.maximum(spectra @ weights, 0.0)
    linear = linear / linear.max()
    screen = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.stack([np.interp(thickness, table, channel) for channel in screen.T], axis=-1)


def _observer(nm: Array) -> Array:
    """Return the CIE 1931 colour matching functions, (n, 3).

    Multi-lobe fit of Wyman, Sloan, Shirley (2013), J. Comput. Graph. Tech. 2(2), eq. 4.
    """

    def lobe(middle: float, below: float, above: float) -> Array:
        return np.exp(-0.5 * ((nm - middle) / np.where(nm < middle, below, above)) ** 2)

    x = 1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7)
    y = 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1)
    z = 1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)
    return np.stack([x - 0.065 * lobe(501.1, 20.4, 26.2), y, z], axis=-1)


# XYZ to linear sRGB (IEC 61966-2-1).
_SRGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
