"""Duration of a transient run: where roughness starts, when it has passed, what is rejected."""

import numpy as np
import pytest

from tehl import InputError, solve_transient
from tehl.api.problem import ContactProblem
from tehl.contact.course import Course
from tehl.contact.transient import Transient
from tehl.estimate.duration import duration_of, misplaced
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.estimate.schedule import check_peaks, schedule_of
from tehl.operators.heights import MovingHeights
from tehl.report.explain import explain
from tehl.solver.transient.checks import check_waves
from tehl.solver.transient.snapshot import kept_steps
from tests.reference import DOMAIN, moes_contact
from tests.solver.test_transient import OPTIONS, in_time, wave

UNITS = scales(moes_contact(50.0, 10.0))
WIDTH, FILM = UNITS.half_width_x, UNITS.film_thickness
GRID = Grid(nx=65, ny=65, domain=DOMAIN, mirror=False)


def dent(x: float, **more: float) -> dict:
    """A dent 0.1 a^2/R deep, 0.4 a in radius, at ``x`` half-widths."""
    return {"type": "bump", "amplitude": -0.1 * FILM, "radius": 0.4 * WIDTH, "x": x * WIDTH} | more


def deepest(case: ContactProblem, seconds: float) -> float:
    """The lowest height of surface 1 at a time, over a_x^2/R_x."""
    return float(MovingHeights(ScaledProblem.of(case), GRID, 2.5).at(seconds)[0].min())


@pytest.fixture
def dent_map(tmp_path) -> dict:
    """A map two half-widths wide with the same dent in its middle, as a table."""
    place = np.linspace(-1.0, 1.0, 129)
    values = -0.1 * FILM * np.exp(-(place[None, :] ** 2 + place[:, None] ** 2) / 0.4**2)
    np.save(tmp_path / "dent.npy", values)
    return {"type": "map", "file": str(tmp_path / "dent.npy"), "unit": "m", "level": "none",
            "pixel": WIDTH / 64.0}  # fmt: skip


@pytest.mark.parametrize(
    "other",
    [
        wave(amplitude=1e-3)["roughness"],
        {"type": "random", "rms": 1e-12, "correlation_length": 0.3 * WIDTH, "seed": 1},
    ],
    ids=["wave", "random"],
)
def test_roughness_that_enters_at_the_inlet_leaves_a_dent_beside_it_unchanged(other):
    """The dent is downstream of the entrance, where waves and random heights are not yet."""
    case = in_time(4.0, surface_1={"roughness": [dent(-1.9), other]})
    assert deepest(case, 1.9 * WIDTH / UNITS.speed) == pytest.approx(-0.1, rel=0.02)


def test_a_map_with_flat_surroundings_is_a_feature(dent_map):
    case = in_time(4.0, surface_1={"roughness": dent_map | {"x": -2.1 * WIDTH}})
    assert deepest(case, 2.1 * WIDTH / UNITS.speed) == pytest.approx(-0.1, rel=0.02)
    with pytest.raises(InputError, match=r"surface_1\.roughness: the map is in the contact at"):
        solve_transient(in_time(4.0, surface_1={"roughness": dent_map}), OPTIONS)


def test_a_periodic_map_enters_at_the_inlet(dent_map):
    case = in_time(4.0, surface_1={"roughness": dent_map | {"outside": "periodic"}})
    assert deepest(case, 0.0) == pytest.approx(-0.1, rel=0.05)  # far upstream
    start = MovingHeights(ScaledProblem.of(case), GRID, 2.5).at(0.0)[0]
    assert not start[:, GRID.x > -2.5].any()


@pytest.mark.parametrize(("slide", "x", "where"), [(0.0, 0.0, -1), (0.5, -1.5, -1), (-2.5, 0.0, 1)])
def test_a_feature_in_the_contact_at_time_zero_is_rejected_with_a_valid_position(slide, x, where):
    """The position that the message proposes is valid, and upstream of the moving surface."""
    message = r"surface_1\.roughness: the bump .* or place it upstream"
    with pytest.raises(InputError, match=message) as caught:
        solve_transient(in_time(4.0, slide=slide, surface_1={"roughness": dent(x)}), OPTIONS)
    place = float(str(caught.value).split("x = ")[1].split(" um")[0]) * 1e-6
    assert where * place == pytest.approx(1.8 * WIDTH, rel=0.01)
    better = in_time(30.0, slide=slide, surface_1={"roughness": dent(place / WIDTH)})
    speed = abs(1.0 + 0.5 * slide) * UNITS.speed
    assert deepest(better, 1.8 * WIDTH / speed) == pytest.approx(-0.1, rel=0.02)


@pytest.mark.parametrize(("slide", "x", "expected"), [
    (0.0, -2.0, 4.0), (0.0, -9.0, 10.8), (1.0, -9.0, 10.8), (-1.0, -9.0, 21.6), (0.0, None, 7.5),
])  # fmt: skip
def test_a_run_lasts_until_the_roughness_has_passed(slide, x, expected):
    """In a_x / u_m: the feature with its flank, or the wave that enters at the inlet."""
    rough = wave()["roughness"] if x is None else dent(x)
    case = in_time(1.0, slide=slide, surface_1={"roughness": rough})
    tables = case.model_dump(exclude_none=True)
    del tables["transient"]["duration"]
    found = duration_of(ScaledProblem.of(ContactProblem.model_validate(tables)))
    assert found * UNITS.speed / WIDTH == pytest.approx(expected)


@pytest.mark.parametrize(("start", "slide", "angle", "length", "expected"), [
    ("smooth", 0.0, 0, 0.4, 4.0),  # contains more than two periods anyway
    ("smooth", 0.0, 60, 0.5, 6.0),
    ("smooth", -1.0, 0, 1.0, 12.0),
    ("smooth", 0.0, 90, 1.0, 4.0),
    ("smooth", 0.0, 89, 1.0, 4.0),
    ("standing", 0.0, 0, 2.0, 5.0),
])  # fmt: skip
def test_two_waves_and_a_half_pass_the_centre_by_default(start, slide, angle, length, expected):
    """In a_x / u_m, after the front and its fade-in; waves as long as the domain do not count."""
    rough = wave(wavelength=length)["roughness"] | {"angle": np.deg2rad(angle)}
    given = {"start": start, "duration": None}
    case = in_time(1.0, slide=slide, surface_1={"roughness": rough}, transient=given)
    assert duration_of(ScaledProblem.of(case)) * UNITS.speed / WIDTH == pytest.approx(expected)


def test_a_dent_that_passes_quickly_counts_as_being_in_the_contact():
    """In a run so long that it is in the contact for a small part of it only."""
    far = dent(-250.0) | {"radius": 0.6 * WIDTH}
    case = in_time(300.0, surface_1={"roughness": far}, transient={"stride": 4})
    assert misplaced(ScaledProblem.of(case), 300.0 * WIDTH / UNITS.speed) is None
    beside = far | {"y": 3.0 * WIDTH}
    message = misplaced(ScaledProblem.of(in_time(300.0, surface_1={"roughness": beside})), 1.0)
    assert "does not enter the contact" in str(message)


def test_a_wave_that_the_time_steps_would_alias_is_rejected():
    """Sixteen nodes long, on a surface that moves by sixteen in a step."""
    long = wave(wavelength=1.5)
    case = in_time(4.0, slide=2.0, surface_1=long, transient={"stride": 4})
    with pytest.raises(InputError, match=r"moves by 0\.5 of its shortest wave per time step"):
        solve_transient(case, OPTIONS)


def test_a_run_starts_with_the_film_of_its_first_load():
    case = in_time(1.0, transient={"load": [(0.0, 1.3), (1.0, 1.3)]})
    history = solve_transient(case, OPTIONS).history
    assert history.pressure_max[0] / UNITS.hertz_pressure == pytest.approx(1.3 ** (1 / 3), rel=0.03)
    np.testing.assert_allclose(history.film_central, history.film_central[0], rtol=1e-5)


def test_a_load_pulse_between_two_steps_is_rejected():
    step = GRID.dx * WIDTH / UNITS.speed
    pulse = [(0.0, 1.0), (3.3 * step, 1.0), (3.5 * step, 3.0), (3.7 * step, 1.0)]
    for one in (explain, solve_transient):
        with pytest.raises(InputError, match=r"transient\.load = 3 at .* do not resolve it"):
            one(in_time(1.0, transient={"load": pulse}), OPTIONS)


def test_a_load_pulse_with_a_flat_top_between_two_steps_is_rejected_too():
    step = GRID.dx * WIDTH / UNITS.speed
    times = (0.0, 3.3, 3.35, 3.6, 3.65)
    pulse = [(n * step, load) for n, load in zip(times, (1.0, 1.0, 1.5, 1.5, 1.0), strict=True)]
    with pytest.raises(InputError, match=r"transient\.load = 1\.5 at .* do not resolve it"):
        solve_transient(in_time(1.0, transient={"load": pulse}), OPTIONS)
    stays = (*pulse[:3], (0.2, 1.5))  # a jump that the steps resolve
    check_peaks({"load": Course(stays)}, step)


def test_a_random_surface_loses_the_waves_that_long_steps_would_alias():
    """Two mesh widths in a step: its shortest waves are half of those that the grid carries."""
    rough = {"type": "random", "rms": 1e-9, "correlation_length": 0.05 * WIDTH, "seed": 1}
    slow, fast = (
        MovingHeights(
            ScaledProblem.of(in_time(1.0, slide=s, surface_1={"roughness": rough})), GRID, 2.5
        )
        for s in (0.0, 2.0)
    )
    lengths = [one.surfaces[0].parts[0][0].shortest_wavelengths[0] for one in (slow, fast)]
    assert lengths[1] > 1.5 * lengths[0]
    scaled = ScaledProblem.of(in_time(1.0, slide=2.0))
    check_waves(fast, GRID, schedule_of(scaled, GRID.dx, 4), 1)


def test_the_traction_coefficient_at_time_zero_refers_to_the_load_at_time_zero():
    run = solve_transient(in_time(0.2, slide=0.5, transient={"load": [(0.0, 1.3)]}), OPTIONS)
    assert run.start.traction.mid_film == pytest.approx(run.history.traction[0], rel=1e-6)


def test_a_duration_that_overflows_is_rejected():
    with pytest.raises(InputError, match="takes inf steps"):
        solve_transient(in_time(1.0, transient={"duration": "1e308 s"}), OPTIONS)


def test_fields_are_stored_at_chosen_instants():
    chosen = Transient(frames=(0.0, 0.31, 0.5))
    assert kept_steps(chosen, 10, 0.1) == {0, 3, 5}
    late = in_time(1.0, transient={"duration": "1 ms", "frames": ["2 s"]})
    for one in (explain, solve_transient):
        with pytest.raises(InputError, match=r"2 s: after the end of the run at 0\.001"):
            one(late, OPTIONS)
