"""Ellipses at an angle to the entrainment: independent values, mirror images, circles."""

import math

import numpy as np
import pytest

from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Domain, Options
from tehl.estimate.nodes import planned
from tehl.estimate.scaling import ScaledProblem
from tehl.report.page import report_text
from tests.reference import moes_contact, read

TURNED = read("directions")["turned"]
RATIO = 1.0 / 0.351771642
"""R_y/R_x of a_y/a_x = 2, by the D of the reference."""


def turned(degrees: float, ratio: float = RATIO, load: float = 100.0) -> ContactProblem:
    """Return the contact of the reference, with its axis of radius_x at an angle."""
    found = moes_contact(load, 10.0, radius_ratio=ratio)
    stated = {"load": found.load, "entrainment_speed": found.entrainment_speed}
    without = {"moes_load": None, "moes_speed": None, "entrainment_angle": math.radians(degrees)}
    contact = found.contact.model_copy(update=stated | without)
    return found.model_copy(update={"contact": contact})


def solved(degrees: float, **options) -> Result:
    return solve(turned(degrees), Options(**{"points": 65} | options))


@pytest.mark.parametrize("name", ["phi45", "phi90"])
def test_the_film_is_that_of_another_program(name):
    reference, on_axes = TURNED[name], turned(0.0)
    problem, unit = turned(reference["angle"]), on_axes.hertz.half_width_x
    x, y = (unit / half for half in (problem.hertz.half_width_x, problem.hertz.half_width_y))
    west, east, south, north = reference["box"]
    box = Domain(x=(west * x, east * x), y=(south * y, north * y))
    found = solve(problem, Options(points=257, domain=box, edges="zero", extrapolate=True))
    scale = unit**2 / on_axes.radius_x
    film = found.film_thickness / scale
    assert found.film.central / scale == pytest.approx(reference["h_central"], rel=2e-3)
    assert found.film.minimum / scale == pytest.approx(reference["minimum_left"], rel=2e-3)
    left, right = (film[rows].min() for rows in (found.y > 0.0, found.y < 0.0))  # nodes alone
    assert left == pytest.approx(reference["minimum_left"], rel=4e-3)
    assert right == pytest.approx(reference["minimum_right"], rel=4e-3)
    assert found.scaled.at_origin(found.scaled.pressure) == pytest.approx(
        reference["p_central"], rel=1e-3
    )


def test_a_mirror_image_has_the_mirrored_film():
    one, other = solved(30.0, tolerance=1e-9), solved(-30.0, tolerance=1e-9)
    assert other.film.central == pytest.approx(one.film.central, rel=1e-6)
    assert np.abs(other.scaled.film[::-1] / one.scaled.film - 1.0).max() < 1e-5
    assert one.film.minimum_at[1] == pytest.approx(-other.film.minimum_at[1], rel=1e-4)
    assert one.film.minimum_at[1] > 0.0  # on the left, as the ridge leads the oil there


def test_quarter_turns_and_circles_are_contacts_on_their_axes():
    problem = turned(90.0)
    exchanged = {"entrainment_angle": 0.0, "radius_x": 0.02 * RATIO, "radius_y": 0.02}
    contact = problem.contact.model_copy(update=exchanged)
    wanted = solve(problem.model_copy(update={"contact": contact}), Options(points=65))
    found = solved(90.0)
    assert np.array_equal(found.scaled.film, wanted.scaled.film)
    circles = [solve(turned(angle, 1.0), Options(points=65)) for angle in (0.0, 37.0)]
    assert np.array_equal(circles[0].scaled.film, circles[1].scaled.film)


@pytest.mark.usefixtures("no_pictures")
def test_report_text_and_list_state_the_axes_of_the_ellipse():
    found = solved(45.0)
    first, second, angle = found.problem.hertz.axes
    assert math.degrees(angle) == pytest.approx(-45.0)
    assert f"{1e6 * first:.6g} µm × {1e6 * second:.6g} µm" in report_text(found, dpi=20)
    text = repr(found.problem.explain())
    assert "at 45 deg to the axis of R = 20 mm" in text
    assert text.count("valid for entrainment along an axis") == 2  # Chittenden's holds at angles


@pytest.mark.parametrize(("degrees", "load", "speed"), [(60.0, 500.0, 2.0), (90.0, 100.0, 15.0)])
def test_the_planned_grid_is_enough(degrees, load, speed):
    problem = moes_contact(load, speed, radius_ratio=11.6, angle=math.radians(degrees))
    options = Options(error=0.02)
    lines, columns = planned(ScaledProblem.of(problem), options).shape
    found = solve(problem, options)  # with another number of lines it diverged
    assert found.errors.film() <= 0.02
    assert found.scaled.film.shape == (lines, columns)
    assert max(one.points for one in found.history) == (columns, lines)


def test_small_angles_change_the_film_by_their_square():
    films = [solved(angle, half_domain="never").film.central for angle in (0.0, 3.0, 6.0)]
    small, large = (film / films[0] - 1.0 for film in films[1:])
    assert large / small == pytest.approx(4.0, rel=0.1)


def test_a_line_contact_and_more_than_a_turn_are_refused():
    tables = {"type": "line", "radius": 0.01, "load_per_length": 1e5, "entrainment_speed": 1.0}
    contact = type(turned(0.0).contact)
    with pytest.raises(ValueError, match="only the speed across it makes a film"):
        contact.model_validate(tables | {"entrainment_angle": "20 deg"})
    point = {"radius_x": 0.01, "radius_y": 0.02, "load": 10.0, "entrainment_speed": 1.0}
    with pytest.raises(ValueError, match="entrainment_angle"):
        contact.model_validate(point | {"entrainment_angle": 45.0})
