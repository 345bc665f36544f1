"""Gears and cams: geometry of another program, and tables of a case over time."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from tehl import InputError
from tehl.api.problem import ContactProblem
from tehl.contact.moment import moment_at
from tehl.contact.options import Options
from tehl.estimate.duration import MOST_TIME_STEPS
from tehl.report.explain import explain
from tehl.studies.gear import FlatCam, SpurGears

STEEL = {"material": "steel"}
OIL = {
    "viscosity": {"law": "roelands", "eta_0": 0.01, "alpha": 15e-9},
    "density": {"law": "constant", "rho_0": 860.0},
}
FZG = {
    "module": 4.5e-3,
    "teeth": (16, 24),
    "width": 14e-3,
    "torque": 183.4,
    "speed": 8.3 / 36.6e-3,
    "shift": (0.182, 0.172),
    "centres": 91.5e-3,
}
CAM = {
    "base_radius": 18e-3,
    "lift": 6e-3,
    "half_angle": math.radians(75.0),
    "width": 12e-3,
    "speed": 100.0,
    "spring": (250.0, 30e3),
    "mass": 0.1,
}


def test_the_pitch_point_is_that_of_another_program():
    """The FZG gear type C: Arana et al., Proc. IMechE J 233 (2019) 303."""
    gears = SpurGears(**FZG)
    pitch = gears.at(0.0)
    assert math.degrees(gears.working_angle) == pytest.approx(22.44, abs=0.005)
    assert pitch["radius"] == pytest.approx(8.38e-3, rel=1e-3)
    assert pitch["load_per_length"] == pytest.approx(387e3, rel=1e-3)
    assert pitch["entrainment_speed"] == pytest.approx(3.17, rel=1e-3)
    assert pitch["slide_roll_ratio"] == pytest.approx(0.0, abs=1e-12)
    assert gears.tip_radii == pytest.approx((41.23e-3, 59.18e-3), rel=2e-4)  # of the drawing


def test_the_tables_over_time_are_the_contacts_along_the_path():
    gears = SpurGears(**FZG)
    case = ContactProblem(surface_1=STEEL, surface_2=STEEL, lubricant=OIL, **gears.tables(121))
    assert case.transient is not None
    (start, end), duration = gears.ends, case.transient.duration
    for place in np.linspace(start, end, 17):
        time = duration * (place - start) / (end - start)
        wanted, moment = gears.at(place), moment_at(case, time)
        speed = moment.speed * case.entrainment_speed
        assert case.radius_x / moment.curvature == pytest.approx(wanted["radius"], rel=1e-3)
        assert speed == pytest.approx(wanted["entrainment_speed"], rel=1e-9)
        assert moment.load * case.load == pytest.approx(wanted["load_per_length"], rel=1e-9)
        ratio = wanted["slide_roll_ratio"]
        assert moment.sliding / moment.speed == pytest.approx(ratio, rel=1e-9, abs=1e-9)


def test_gears_that_cannot_mesh_are_rejected():
    with pytest.raises(InputError, match="leave mesh"):
        SpurGears(**FZG | {"centres": 96e-3})
    with pytest.raises(InputError, match="less than both base radii"):
        SpurGears(**FZG | {"centres": 80e-3})


def test_a_cam_turns_its_entrainment_twice():
    cam = FlatCam(**CAM)
    tables = cam.tables(math.radians(85.0))
    case = ContactProblem(surface_1=STEEL, surface_2=STEEL, lubricant=OIL, **tables)
    times = np.linspace(0.0, case.transient.duration, 301)
    speeds = np.array([moment_at(case, time).speed for time in times])
    assert (np.diff(np.sign(speeds)) != 0).sum() == 2
    assert speeds[150] < 0.0
    # by differences of the lift: curvature radius, and velocities along the follower
    angle, step = math.radians(40.0), 1e-4
    lift = [6e-3 * (1 - ((angle + k * step) / cam.half_angle) ** 2) ** 3 for k in (-1, 0, 1)]
    bend = (lift[0] - 2 * lift[1] + lift[2]) / step**2
    here = cam.at(angle)
    assert here["radius"] == pytest.approx(18e-3 + lift[1] + bend, rel=1e-6)
    cam_speed, follower = 100.0 * here["radius"], 100.0 * bend
    assert here["entrainment_speed"] == pytest.approx(0.5 * (cam_speed + follower), rel=1e-6)
    assert here["sliding_speed"] == pytest.approx(cam_speed - follower, rel=1e-6)
    with pytest.raises(InputError, match="both must be positive") as caught:
        replace(cam, base_radius=5e-3).at(0.0)
    least = 1e-3 * float(re.search(r"base_radius above ([\d.]+) mm", str(caught.value))[1])
    angles = np.linspace(-cam.half_angle, cam.half_angle, 101)
    assert min(replace(cam, base_radius=1.01 * least).at(one)["radius"] for one in angles) > 0.0
    with pytest.raises(InputError):
        [replace(cam, base_radius=0.98 * least).at(one) for one in angles]


def test_a_whole_turn_of_a_cam_is_planned_on_the_nodes_of_its_thick_film():
    """On the 513 of steady lines it took 38,000 steps, and was refused."""
    spring = {"spring": (150.0, 30e3), "mass": 0.12, "speed": 1000.0 * 2.0 * math.pi / 60.0}
    cam = FlatCam(**CAM | spring | {"lift": 5e-3, "width": 14e-3})
    steel, tables = {"surface_1": STEEL, "surface_2": STEEL}, cam.tables(math.pi, 361)
    run = ContactProblem(lubricant=OIL, **steel, **tables)
    still = run.model_copy(update={"transient": None})
    moving, steady = (explain(one, Options(error=0.02)) for one in (run, still))
    assert moving.options.shape < steady.options.shape
    assert moving.time.steps < MOST_TIME_STEPS


@pytest.mark.parametrize(
    ("teeth", "angle", "shift", "words"),
    [
        ((60, 80), 14.5, (0.0, 0.0), "contact ratio is 2.23"),
        ((17, 25), 20.0, (0.5, 0.3), "the contact ratio is 1"),
    ],
)
def test_pairs_of_teeth_share_the_load_by_two_at_most(teeth, angle, shift, words):
    with pytest.raises(InputError, match=words):
        SpurGears(
            module=3e-3,
            teeth=teeth,
            width=0.02,
            torque=100.0,
            speed=100.0,
            pressure_angle=math.radians(angle),
            shift=shift,
        )
