"""Surfaces that a formula gives."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from tehl.roughness import AnyRoughness, Bump, Crossed, Dimple, Pocket, Ridge, Smooth, Sum, Wave


class Body(BaseModel):
    roughness: AnyRoughness = Smooth()


def surface(stated):
    return Body.model_validate({"roughness": stated}).roughness


WAVE = {"type": "wave", "amplitude": "0.2 um", "wavelength": "0.1 mm", "angle": "45 deg"}
lengths = st.floats(5e-6, 1e-3)
heights = st.floats(-1e-6, 1e-6).filter(lambda h: h == 0 or abs(h) > 1e-12)
angles = st.floats(-7.0, 7.0) | st.sampled_from([0.0, math.pi / 2, math.pi, math.pi / 4])
places = st.floats(-1e-3, 1e-3) | st.just(0.0)

waves = st.builds(Wave, amplitude=heights.map(abs), wavelength=lengths, angle=angles, phase=angles)
crossed = st.builds(
    Crossed,
    amplitude=heights.map(abs),
    wavelength=lengths,
    angle=angles,
    phase=angles,
    phase_2=angles,
    form=st.sampled_from(["sum", "product"]),
)
bumps = st.builds(Bump, amplitude=heights, radius=lengths, x=places, y=places)
dimples = st.builds(Dimple, amplitude=heights, width=lengths, x=places, y=places)
pockets = st.builds(Pocket, amplitude=heights, radius=lengths, x=places, y=places)
ridges = st.builds(
    Ridge,
    amplitude=heights,
    width=lengths,
    angle=angles,
    x=places,
    y=places,
    profile=st.sampled_from(["gaussian", "cosine", "damped"]),
)
singles = st.one_of(waves, crossed, bumps, dimples, pockets, ridges, st.just(Smooth()))
sums = st.lists(singles, max_size=3).map(lambda parts: Sum(parts=tuple(parts)))
surfaces = singles | sums

X = np.linspace(-1e-3, 1e-3, 23)[None, :]
Y = np.linspace(-0.9e-3, 0.9e-3, 21)[:, None]
SMALL = 1e-14  # rounding of phases up to 2 pi 1e3 rad times heights of 1e-6 m


@given(surfaces, st.floats(0.0, 1e-3), st.floats(-2.0, 2.0))
def test_a_surface_travels_with_its_speed(rough, time, speed):
    moved = rough.height(X, Y, time, speed)
    np.testing.assert_array_equal(moved, rough.height(X - speed * time, Y))
    assert moved.shape == (21, 23)


@given(st.lists(singles, max_size=4))
def test_a_sum_is_the_sum_of_its_parts(parts):
    total = Sum(parts=tuple(parts)).height(X, Y, 1e-4, 1.0)
    np.testing.assert_allclose(
        total, sum((part.height(X, Y, 1e-4, 1.0) for part in parts), np.zeros((21, 23)))
    )


@given(surfaces)
def test_an_even_surface_mirrors_at_y_zero(rough):
    if rough.is_even_in_y:
        np.testing.assert_allclose(rough.height(X, Y), rough.height(X, -Y), atol=10 * SMALL)


@given(surfaces)
def test_a_smooth_surface_is_zero(rough):
    assert not (rough.is_smooth and rough.height(X, Y).any())
    assert not (rough.is_smooth and math.isfinite(rough.shortest_wavelength))


@given(surfaces)
def test_wavelengths_along_the_axes_are_no_shorter_than_the_shortest(rough):
    assert min(rough.shortest_wavelengths) >= rough.shortest_wavelength * (1 - 1e-12)


@given(surfaces)
def test_a_surface_is_stored_and_read_again(rough):
    stored = Body(roughness=rough).model_dump_json()
    assert Body.model_validate_json(stored).roughness == rough


@pytest.mark.parametrize(
    ("rough", "even"),
    [
        (Wave(amplitude=1e-7, wavelength=1e-4, angle=0.0, phase=0.3), True),
        (Wave(amplitude=1e-7, wavelength=1e-4, angle=math.pi, phase=0.3), True),
        (Wave(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 2, phase=math.pi), True),
        (Wave(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 2, phase=0.3), False),
        (Wave(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 4), False),
        (Crossed(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 4), True),
        (Crossed(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 4, phase=0.2), False),
        (
            Crossed(amplitude=1e-7, wavelength=1e-4, angle=math.pi / 4, phase=0.2, phase_2=-0.2),
            True,
        ),
        (Crossed(amplitude=1e-7, wavelength=1e-4, form="product"), True),
        (Ridge(amplitude=1e-7, width=1e-4, y=3.0), True),
        (Ridge(amplitude=1e-7, width=1e-4, angle=math.pi / 2), True),
        (Ridge(amplitude=1e-7, width=1e-4, angle=math.pi / 2, y=1e-5), False),
        (Bump(amplitude=1e-7, radius=1e-4, x=1e-5), True),
        (Dimple(amplitude=1e-7, width=1e-4, y=1e-5), False),
    ],
)
def test_symmetry_in_y_is_detected(rough, even):
    assert rough.is_even_in_y is even
    assert Sum(parts=(rough, Smooth())).is_even_in_y is even


@given(waves)
def test_two_waves_that_mirror_each_other_are_even(wave):
    mirror = wave.model_copy(update={"angle": -wave.angle})
    assert Sum(parts=(wave, mirror)).is_even_in_y


def test_the_wave_is_that_of_the_case_file():
    rough = surface(WAVE | {"phase": "90 deg"})
    along = (X - Y) * math.sqrt(0.5)
    expected = 0.2e-6 * np.cos(2 * np.pi * along / 1e-4 + np.pi / 2)
    np.testing.assert_allclose(rough.height(X, Y), expected, atol=SMALL)
    assert rough.shortest_wavelength == pytest.approx(1e-4)
    assert rough.shortest_wavelengths == pytest.approx((math.sqrt(2) * 1e-4,) * 2)


def test_heights_are_positive_outwards():
    for rough in (
        Bump(amplitude=1e-7, radius=1e-5),
        Dimple(amplitude=1e-7, width=1e-5),
        Ridge(amplitude=1e-7, width=1e-5),
        Wave(amplitude=1e-7, wavelength=1e-5),
        Crossed(amplitude=5e-8, wavelength=1e-5),
        Crossed(amplitude=1e-7, wavelength=1e-5, form="product"),
    ):
        assert rough.height(np.zeros(1), np.zeros(1)) == pytest.approx(1e-7)


def test_the_dimple_is_that_of_the_literature():
    dent = Dimple(amplitude=-1e-6, width=2e-5, x=1e-5)
    r = np.array([0.0, 5e-6, 1e-5, 2e-5])
    expected = -1e-6 * 10 ** (-10 * (r / 2e-5) ** 2) * np.cos(2 * np.pi * r / 2e-5)
    np.testing.assert_allclose(dent.height(1e-5 + r, np.zeros(4)), expected, atol=1e-20)


def test_a_ridge_has_its_width_across_its_crest():
    across = np.array([0.0, 5e-6, 1e-5])
    turned = across * math.sqrt(0.5)
    gaussian = Ridge(amplitude=1e-7, width=1e-5, angle=math.pi / 4)
    cosine = gaussian.model_copy(update={"profile": "cosine"})
    np.testing.assert_allclose(
        gaussian.height(turned, -turned), 1e-7 * np.exp([0.0, -1.0, -4.0]), rtol=1e-12
    )
    np.testing.assert_allclose(cosine.height(turned, -turned), [1e-7, 0, 0], atol=1e-20)
    damped = gaussian.model_copy(update={"profile": "damped"})
    dimple = Dimple(amplitude=1e-7, width=1e-5)
    np.testing.assert_allclose(
        damped.height(turned, -turned), dimple.height(turned, -turned), atol=1e-20
    )


def test_the_rms_is_that_of_the_heights():
    x, y = np.arange(64)[None, :] / 64e4, np.arange(64)[:, None] / 64e4
    base = {"amplitude": 2e-7, "wavelength": 1e-4}
    for rough in (
        Wave(**base),
        Crossed(**base, amplitude_2=1e-7),
        Crossed(**base, form="product"),
        Sum(parts=(Wave(**base), Wave(**base, phase=1.0))),
    ):
        assert rough.rms == pytest.approx(math.sqrt(np.mean(rough.height(x, y) ** 2)), rel=1e-9)


def test_a_list_is_a_sum():
    rough = surface([WAVE, {"type": "bump", "amplitude": "-0.1 um", "radius": "20 um"}])
    assert [part.type for part in rough.parts] == ["wave", "bump"]
    assert rough.resolved_on(1e-5, 1e-5).rms == rough.rms
    assert rough.shortest_wavelength == pytest.approx(8e-5)


def test_the_schema_has_tables_and_lists():
    schema = Body.model_json_schema()["properties"]["roughness"]
    assert [kind.get("type") for kind in schema["anyOf"]] == [None, "array"]


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (WAVE | {"amplitude": "0.2 N"}, "unit of a force"),
        (WAVE | {"amplitude": "-1 um"}, "must not be negative"),
        (WAVE | {"wavelength": 0}, "must be positive"),
        (WAVE | {"angle": "45 um"}, "angle"),
        (WAVE | {"lay": 1}, "Extra inputs"),
        ([WAVE, {"type": "wavy"}], "wavy"),
        (
            WAVE | {"type": "crossed", "form": "product", "amplitude_2": 1e-6},
            "amplitude_2 does not",
        ),
        (WAVE | {"amplitude": 0.2}, "not small beside wavelength = 0.0001 m"),
        ({"type": "bump", "amplitude": -1e-6, "radius": 2e-6}, "not small beside radius"),
        ({"type": "ridge", "amplitude": "1 mm", "width": "1 mm"}, "not small beside width"),
        ({"type": "bump", "amplitude": "nan", "radius": 1e-5}, "not a number"),
    ],
)
def test_wrong_tables_are_reported(stated, words):
    with pytest.raises(ValidationError, match=words):
        surface(stated)


def test_the_pocket_is_that_of_its_formula():
    pocket = surface({"type": "pocket", "amplitude": "-1 um", "radius": "40 um", "x": "10 um"})
    r = np.hypot(X - 1e-5, Y)
    expected = -1e-6 * np.cos(np.pi * r / 8e-5) * np.exp(-2 * (r / 4e-5) ** 2)
    np.testing.assert_allclose(pocket.height(X, Y), expected, atol=1e-20)
    edge = pocket.extent(1e-3)[0][1]
    assert abs(pocket.height(np.array(edge), np.array(0.0))) == pytest.approx(0.02e-6, rel=0.05)
    assert pocket.shortest_wavelength == pytest.approx(68e-6)
