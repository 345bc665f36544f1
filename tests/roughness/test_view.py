"""The picture of a map has it where the contact gets it."""

import math

import numpy as np
import pytest

from tehl.plots.surface import surface_preview
from tehl.roughness import Map
from tehl.roughness.preview import Mesh, preview, view

NY, NX, PIXEL = 60, 80, 2e-6
PLACE = (-40e-6, 30e-6)
"""Where the peak lies on the map, from its middle."""
X = (np.arange(NX) - 0.5 * (NX - 1))[None, :] * PIXEL
Y = (np.arange(NY) - 0.5 * (NY - 1))[:, None] * PIXEL
CONTACT = Mesh(spacing=(2e-6, 2e-6), half_widths=(50e-6, 40e-6), points=(65, 65))


@pytest.fixture
def seen(tmp_path):
    def made(mesh=None, **keys):
        square = (X - PLACE[0]) ** 2 + (Y - PLACE[1]) ** 2
        np.save(tmp_path / "peak.npy", 1e-7 * np.exp(-square / 8e-6**2))
        file = {"file": str(tmp_path / "peak.npy"), "unit": "m", "pixel": "2 um"}
        return preview(Map.model_validate(file | {"level": "none"} | keys), mesh)

    return made


def peak(found):
    """Return where the highest point of a view lies [m]."""
    (left, right), (bottom, top) = found.window
    ny, nx = found.values.shape
    row, column = np.unravel_index(found.values.argmax(), found.values.shape)
    return left + (column + 0.5) * (right - left) / nx, bottom + (row + 0.5) * (top - bottom) / ny


def test_a_map_by_itself_is_shown_as_its_points(seen):
    found = seen()
    np.testing.assert_array_equal(view(found).values, found.heights.values)
    assert view(found).corners is None
    assert peak(view(found)) == pytest.approx(PLACE, abs=1.01 * PIXEL)


@pytest.mark.parametrize("mesh", [None, CONTACT])
def test_a_turned_and_moved_map_is_shown_where_it_lies(seen, mesh):
    found = seen(mesh, rotate="30 deg", x="0.02 mm", y="-0.01 mm")
    cosine, sine = math.cos(math.radians(30)), math.sin(math.radians(30))
    along, across = PLACE
    place = (20e-6 + along * cosine + across * sine, -10e-6 - along * sine + across * cosine)
    assert found.surface.height(*map(np.array, place)) == pytest.approx(1e-7, rel=0.1)
    assert peak(view(found)) == pytest.approx(place, abs=1.01 * PIXEL)


def test_the_corners_are_those_of_the_measured_part(seen):
    found = view(seen(CONTACT, rotate="90 deg", x="0.02 mm"))
    assert found.corners.min(axis=0) == pytest.approx((20e-6 - 60e-6, -80e-6))
    assert found.corners.max(axis=0) == pytest.approx((20e-6 + 60e-6, 80e-6))
    first = found.corners[0]  # the first column and row of the file
    assert first == pytest.approx((20e-6 - 60e-6, 80e-6))


def test_a_contact_beside_the_map_is_in_the_window_unless_it_is_far(seen):
    (left, right), (bottom, top) = view(seen(CONTACT, x="0.2 mm")).window
    assert left < -50e-6 < 280e-6 == pytest.approx(right)
    assert (bottom, top) == pytest.approx((-60e-6, 60e-6))
    far = view(seen(CONTACT, x="20 mm"))
    assert far.size == pytest.approx((160e-6, 120e-6))


def test_beyond_the_edges_the_heights_of_the_contact_are_shown(seen):
    wide = Mesh(spacing=(2e-6, 2e-6), half_widths=(2e-4, 2e-4), points=(65, 65))
    for outside, count in (("flat", 1), ("periodic", 6)):
        tops = view(seen(wide, outside=outside)).values > 0.7e-7
        assert tops.sum() >= 6 * count
        assert (tops.sum() < 30) == (count == 1)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({}, "dashed: Hertz contact"),
        ({"rotate": "20 deg"}, "dashed: Hertz contact, thin: edges of the map"),
        ({"x": "20 mm"}, "dashed: Hertz contact, cut off by this picture"),
    ],
)
def test_the_legend_names_the_lines(seen, keys, words):
    picture = surface_preview(seen(CONTACT, **keys))
    picture.draw_without_rendering()
    axes = next(one for one in picture.axes if one.get_xlabel() == "x along entrainment [µm]")
    assert axes.get_title() == words
    assert len(axes.patches) == 1 + ("thin" in words)
