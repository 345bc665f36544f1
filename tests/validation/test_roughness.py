"""Standing waves against linear theory (Hooke; Greenwood and Morales-Espejel).

Ripples are fitted where |X|, |Y| < 0.4, after the smooth film was subtracted. The film there is not
quite flat, its pressure falls by a sixth from the middle to the corners, and theory is linear in
the amplitude, which explains one to two per cent.
"""

from functools import cache

import pytest

from tehl.api.results import Result
from tehl.api.solvers import solve
from tehl.contact.options import Options
from tehl.post.waves import WaveResponse, wave_responses
from tests.reference import CLOSE, moes_contact, wavy_contact

LOADS = [(200.0, 10.0), (500.0, 12.34)]
WAVES = [0.15, 0.25, 0.35, 0.5]
OBLIQUE = [(0.0, 0.004), (30.0, 0.004), (45.0, 0.003), (45.0, 0.005), (60.0, 0.004)]
KEPT = {
    (200.0, 0.15): 0.866, (200.0, 0.25): 0.748, (200.0, 0.35): 0.640, (200.0, 0.5): 0.458,
    (500.0, 0.15): 0.724, (500.0, 0.25): 0.574, (500.0, 0.35): 0.461, (500.0, 0.5): 0.295,
}  # fmt: skip
"""Film amplitude of longitudinal waves, computed with this package; there is no published value."""


@cache
def smooth(load: float, speed: float, points: int) -> Result:
    return solve(moes_contact(load, speed), Options(points=points, domain=CLOSE))


def response(
    groups: tuple[float, float], wavelength: float, angle: float, amplitude: float, points: int
) -> WaveResponse:
    case = wavy_contact(*groups, amplitude=amplitude, wavelength=wavelength, angle=angle)
    rough = solve(case, Options(points=points, domain=CLOSE))
    (found,) = wave_responses(rough, smooth(*groups, points))
    return found


def check(found: WaveResponse, tolerance: float) -> None:
    theory = found.theory
    assert found.points_per_wave >= 16
    assert found.film_ratio == pytest.approx(theory.film_ratio, rel=tolerance)
    assert found.pressure_amplitude == pytest.approx(theory.pressure, rel=tolerance)
    # neither ripple is shifted along the wave [rad]
    assert abs(found.film_phase) < 0.02
    assert abs(found.pressure_phase) < 0.02


@pytest.mark.parametrize("angle", [0.0, 45.0])
def test_a_standing_wave_has_the_ripples_of_theory_on_sixteen_nodes(angle):
    check(response((200.0, 10.0), 0.25, angle, 0.004, 257), tolerance=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("groups", LOADS, ids=str)
@pytest.mark.parametrize("wavelength", WAVES)
@pytest.mark.parametrize(("angle", "amplitude"), OBLIQUE)
def test_standing_waves_have_the_ripples_of_theory(groups, wavelength, angle, amplitude):
    check(response(groups, wavelength, angle, amplitude, 513), tolerance=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("groups", LOADS, ids=str)
@pytest.mark.parametrize("wavelength", WAVES)
def test_longitudinal_waves_keep_much_of_their_amplitude(groups, wavelength):
    found = response(groups, wavelength, 90.0, 0.004, 513)
    assert found.theory.pressure == 0.0
    assert found.film_ratio == pytest.approx(KEPT[groups[0], wavelength], rel=0.01)
    # the pressure flattens the rest: h = s - 4 p / (E' kappa)
    flattened = found.pressure_amplitude / found.theory.elastic_pressure
    assert found.film_ratio + flattened == pytest.approx(1.0, abs=0.05)
