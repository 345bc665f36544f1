"""A rough result made without the solver: known ripples on a smooth one."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.api.results import Result
from tehl.result.fields import Fields, SurfaceHeights
from tests.fixtures_result import CASE, make_result

WAVELENGTH, ANGLE, AMPLITUDE = 0.25, np.pi / 4, 0.01
"""Of the wave on surface 2, in a_x, rad and a_x^2/R_x."""
LEFT, CARRIED, PRESSURE = 0.2, 0.3, 0.05
"""What the film keeps of the wave and brings along from the inlet, and P of the ripple."""


def make_rough(points: int = 193, *, angle: float = ANGLE) -> Result:
    """Return a film with the ripples of one wave; it lies over the smooth one of the fixtures."""
    smooth = make_result(points)
    unit, width = smooth.scales.film_thickness, smooth.scales.half_width_x
    wave = {
        "type": "wave",
        "amplitude": AMPLITUDE * unit,
        "wavelength": WAVELENGTH * width,
        "angle": angle,
    }
    case = {**CASE, "surface_2": {"material": "steel", "roughness": wave}}
    x, y = smooth.scaled.x[None, :], smooth.scaled.y[:, None]
    number = 2.0 * np.pi / WAVELENGTH
    ripple = np.cos(number * (x * np.cos(angle) - y * np.sin(angle)))
    streak = np.sin(number * np.sin(angle) * y)
    film = smooth.scaled.film - AMPLITUDE * (LEFT * ripple + CARRIED * streak)
    fields = Fields(
        x=smooth.scaled.x,
        y=smooth.scaled.y,
        pressure=smooth.scaled.pressure + PRESSURE * ripple * (smooth.scaled.pressure > 0.1),
        film=film,
    )
    heights = AMPLITUDE * unit * ripple
    return replace(
        make_result(points, case=case, title="Wavy ball on disc"),
        scaled=fields,
        heights=SurfaceHeights(surface_1=np.zeros_like(heights), surface_2=heights),
    )


@pytest.fixture(scope="session")
def rough() -> Result:
    return make_rough()


@pytest.fixture(scope="session")
def smooth() -> Result:
    return make_result(193)
