"""A rough patch: dry contact, flow through its gap, and the curves of both."""

import numpy as np
import pytest

from tehl.api.problem import case_from_tables
from tehl.api.results import load
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.contact.summits import mean_gap, shear_flow
from tehl.io.store import save
from tehl.patch import contact
from tehl.patch.contact import pressed
from tehl.patch.curves import VANISHES, patch_curves, periodic_patch
from tehl.patch.flow import flow_through
from tests.reference import moes_contact


def wave(nodes: int, *, both: bool) -> np.ndarray:
    """Return a cosine of amplitude 0.01 and length one, along x or along both."""
    x = np.cos(2.0 * np.pi * np.arange(nodes) / nodes)
    return 0.01 * (np.outer(x, x) if both else np.tile(x, (8, 1)))


def random_patch(nodes: int = 128) -> np.ndarray:
    """Return self-affine heights, Hurst exponent 0.8, Sq = 0.01, on the unit square."""
    q = nodes * np.hypot(np.fft.fftfreq(nodes)[:, None], np.fft.rfftfreq(nodes))
    q[0, 0] = 1.0
    amplitude = np.where((q > 4.0) & (q < 32.0), q**-1.8, 0.0)
    phase = np.exp(2j * np.pi * np.random.default_rng(3).random(amplitude.shape))
    z = np.fft.irfft2(amplitude * phase, s=(nodes, nodes))
    return 0.01 * z / z.std()


# ---- dry contact


@pytest.mark.parametrize("part", [0.05, 0.2, 0.5, 0.8])
def test_a_wave_touches_on_the_area_of_westergaard(part):
    found = pressed(wave(256, both=False), (1 / 256, 1 / 256), part * np.pi * 0.01)
    assert found.area == pytest.approx(2.0 / np.pi * np.arcsin(np.sqrt(part)), rel=0.01)
    assert found.mean_pressure == pytest.approx(part * np.pi * 0.01, rel=1e-9)
    assert found.spots == 1  # a stripe over the edges
    assert pressed(wave(64, both=True), (1 / 64, 1 / 64), 0.003).spots == 2


@pytest.mark.parametrize(("both", "factor"), [(False, 1.0), (True, np.sqrt(2.0))])
def test_a_wave_is_pressed_flat_by_its_full_contact_pressure(both, factor):
    full = factor * np.pi * 0.01  # Westergaard; Johnson, Greenwood and Higginson
    z, pixel = wave(32, both=both), (1 / 32, 1 / 32)
    flat = pressed(z, pixel, 1.01 * full)
    assert flat.area == 1.0
    assert np.ptp(flat.pressure) == pytest.approx(2.0 * full, rel=1e-6)
    assert flat.gap.max() == 0.0
    assert pressed(z, pixel, 0.97 * full).area < 1.0


# ---- flow


def test_the_flow_along_and_across_a_wave_is_exact():
    gap = 1.0 + 50.0 * wave(128, both=False)
    found = flow_through(gap, (1 / 128, 1 / 128))
    assert found.along == pytest.approx(1.0 / np.mean(gap**-3.0), rel=1e-9)
    assert found.across == pytest.approx(np.mean(gap**3), rel=1e-9)


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_a_sliding_wave_carries_what_the_closed_form_says(part):
    """Across the flow <g> - <g^-2>/<g^-3>, of a cosine with integrals known; along it nothing."""
    gap = 1.0 + 100.0 * part * wave(128, both=False)
    exact = 1.0 - (1.0 - part**2) / (1.0 + 0.5 * part**2)
    assert flow_through(gap, (1 / 128, 1 / 8)).carried == pytest.approx(exact, rel=1e-9)
    lines = np.ascontiguousarray(gap.T)
    assert flow_through(lines, (1 / 8, 1 / 128)).carried == pytest.approx(0.0, abs=1e-12)


def test_low_waves_carry_by_their_direction():
    """3/h times the mean of z^2 cos^2, of the angle between wave and sliding."""
    z = random_patch(64) / 0.01
    rough = [flow_through(h + z, (1 / 64, 1 / 64)).carried * h for h in (50.0, 100.0)]
    q = np.stack(np.meshgrid(np.fft.fftfreq(64), np.fft.fftfreq(64)))
    power, size = np.abs(np.fft.fft2(z)) ** 2, (q**2).sum(axis=0)
    size[0, 0] = 1.0
    exact = 3.0 * (power * q[0] ** 2 / size).sum() / power.sum()
    assert rough == pytest.approx([exact, exact], rel=0.05)  # 4 nodes per shortest wave
    assert rough[1] == pytest.approx(rough[0], rel=2e-3)


def test_closed_pools_move_with_the_rough_surface():
    x = np.linspace(-1.0, 1.0, 32, endpoint=False)
    pools = np.maximum(0.3 - np.hypot(x[:, None], x), 0.0)
    assert flow_through(pools, (1.0, 1.0)).carried == pytest.approx(pools.mean(), rel=0.01)


def gaussian_heights(seed: int, nodes: int = 96) -> np.ndarray:
    """Random heights of unit deviation, smooth over some nodes."""
    q = np.hypot(nodes * np.fft.fftfreq(nodes)[:, None], nodes * np.fft.rfftfreq(nodes))
    phase = np.exp(2j * np.pi * np.random.default_rng(seed).random(q.shape))
    z = np.fft.irfft2(np.exp(-((q / 8.0) ** 2)) * phase, s=(nodes, nodes))
    return (z - z.mean()) / z.std()


def test_flow_factors_are_those_of_patir_and_cheng_but_for_their_scatter():
    found = []
    for z in map(gaussian_heights, range(4)):  # rigid, cut off where they touch
        gaps = (2.0, 3.0, 6.0)
        flows = [flow_through(np.maximum(h + z, 0.0), (1, 1)) for h in gaps]
        factors = [0.5 * (f.along + f.across) / h**3 for f, h in zip(flows, gaps, strict=True)]
        found.append(factors + [flow.carried for flow in flows])
    factors, carried = np.mean(found, axis=0).reshape(2, 3)
    assert factors == pytest.approx(1.0 - 0.9 * np.exp(-0.56 * np.array(gaps)), abs=0.08)
    assert carried == pytest.approx(shear_flow(np.array(gaps)), rel=0.15)


def test_gaussian_valleys_take_their_oil_along_where_surfaces_nearly_touch():
    gaps = np.array([-0.5, 0.0, 0.25, 0.5])
    found = [
        [
            flow_through(gap, (1, 1)).carried / gap.mean()
            for gap in np.maximum(gaps[:, None, None] + z, 0.0)
        ]
        for z in map(gaussian_heights, range(4))
    ]
    assert np.mean(found, axis=0) == pytest.approx(shear_flow(gaps) / mean_gap(gaps), abs=0.06)


# ---- curves


@pytest.fixture(scope="module")
def curves():
    """Return the curves of the random patch."""
    return patch_curves(1e-4 * random_patch(), (1e-6, 1e-6))


def test_the_middle_of_a_large_patch_is_taken_and_continued_by_its_mirror_image():
    z = np.random.default_rng(3).standard_normal((250, 300))
    middle = z[29:221, 54:246]
    found = periodic_patch(z, fits=True)
    assert found.shape == (384, 384)
    assert found[:192, :192] == pytest.approx(middle - middle.mean())
    np.testing.assert_array_equal(found, found[::-1, ::-1])
    small = periodic_patch(z[:40, :50], fits=True)
    assert small == pytest.approx(z[:40, :50] - z[:40, :50].mean())


@pytest.mark.filterwarnings("ignore:Could not import mpi4py")
def test_a_random_patch_agrees_with_contact_mechanics(curves):
    """The package has the same influence in Fourier space: what remains is interpolation."""
    from ContactMechanics import PeriodicFFTElasticHalfSpace, make_system  # noqa: PLC0415 (2 s)
    from SurfaceTopography import Topography  # noqa: PLC0415

    z, size, start = 100.0 * random_patch(), (128.0, 128.0), None  # [um]
    sigma = z.std()
    for pressure in (1e-4, 1e-3, 2e-2, 0.1):
        space = PeriodicFFTElasticHalfSpace(z.shape, 1.0, size)
        system = make_system(substrate=space, surface=Topography(z, size, periodic=True))
        assert system.minimize_proxy(
            external_force=pressure * 128.0**2, pentol=1e-6 * sigma
        ).success
        area = system.compute_relative_contact_area()
        gap = system.compute_gap(system.disp, system.offset).mean()
        found = pressed(z, (1.0, 1.0), pressure, start)
        start = found.pressure
        assert found.area == pytest.approx(area, rel=1e-3)
        assert found.mean_gap == pytest.approx(gap, rel=1e-6)
        assert (found.gap >= 0.0).all()
        assert (found.gap[found.pressure > 0.0] == 0.0).all()
        assert curves.load(np.array([gap / sigma])) == pytest.approx(pressure, rel=0.02)
        if area > 0.01:
            assert curves.touching(np.array([gap / sigma])) == pytest.approx(area, rel=0.01)


def test_the_curves_are_monotone_and_go_on_beyond_their_ends(curves):
    gaps = np.linspace(-3.0, 12.0, 300)
    assert (np.diff(curves.load(gaps)) <= 0.0).all()
    assert curves.load(gaps).min() >= 0.0
    assert (np.diff(curves.mean_gap(gaps)) > 0.0).all()
    assert curves.mean_gap(gaps).min() > 0.0
    assert (np.diff(curves.conducts(gaps)) > 0.0).all()
    assert curves.conducts(np.array([12.0])) == pytest.approx(12.0, rel=1e-2)
    assert curves.conducts_across(np.array([12.0])) == pytest.approx(1.0, abs=1e-2)
    carries = curves.carries(gaps)
    assert (carries > 0.0).all()
    assert (carries < 1.0).all()
    assert (np.diff(carries) <= 0.0).all()
    assert curves.carries(np.array([VANISHES, 40.0])) == pytest.approx(0.0, abs=1e-15)
    assert curves.load(curves.gaps) == pytest.approx(curves.pressure, rel=1e-9)
    assert (np.diff(curves.area) <= 0.0).all()


def test_a_measured_patch_shares_the_load(tmp_path):
    np.savetxt(tmp_path / "ground.csv", 2e-5 * random_patch(64), delimiter=",")
    tables = moes_contact(100.0, 8.0).model_dump(exclude_none=True)
    patch = {"file": str(tmp_path / "ground.csv"), "pixel": 4e-6, "unit": "m"}
    patch |= {"outside": "periodic"}
    tables["asperities"] = {"model": "surface", "map": patch}
    problem = case_from_tables(tables)[0]
    assert problem.asperity_rms == pytest.approx(0.2e-6, rel=1e-3)
    found = [solve(problem, Options(points=n)).load_sharing for n in (129, 257)]
    shares = [one.share for one in found]
    assert 10 < found[1].spots.number < 10_000
    assert found[0].spots.number == pytest.approx(found[1].spots.number, rel=0.15)
    assert 2e-6 < found[1].spots.radius < 4e-5  # half a pixel to ten
    assert 0.05 < shares[1] < 0.7
    assert shares[0] == pytest.approx(shares[1], rel=0.15)


def test_a_patch_carries_more_oil_on_the_faster_surface(tmp_path):
    """On the line y = 0 in the contact, where no oil flows by pressure, the oil is constant."""
    file, rq = tmp_path / "ground.csv", {"rms_roughness": 0.2e-6}
    np.savetxt(file, 2e-5 * random_patch(64), delimiter=",")
    tables = patch_case(file, outside="periodic")
    films = []
    for rough, sliding, sign in (("1", 1, 1), ("2", -1, 1), ("2", 1, -1), ("12", 1, 0), ("", 1, 0)):
        case = tables | {f"surface_{n}": tables[f"surface_{n}"] | rq for n in rough}
        case["contact"] = tables["contact"] | {"slide_roll_ratio": sliding}
        found = solve(case_from_tables(case)[0], Options(points=65))
        films.append(found.film.central)
        law, middle = found.problem.asperities, found.y.size // 2
        inside = np.abs(found.x) < 0.6 * found.scales.half_width_x
        gap = (found.asperities.separation / law.rms)[middle, inside]
        pressure, inlet = found.pressure[middle, inside], found.problem.inlet_temperature
        density = found.problem.lubricant.density.density(pressure, inlet)
        carried = density * law.mean_gap(gap) * (1.0 + 0.5 * sign * law.carried(gap))
        assert np.ptp(carried) < 0.03 * carried.mean()
    rolling = solve(case_from_tables(tables)[0], Options(points=65)).film.central
    assert films[0] == pytest.approx(films[1], rel=1e-9)  # surfaces and directions swapped
    assert films[2] > 1.05 * films[0]
    assert films[3] == films[4] == rolling  # as rough as each other, or not stated


def patch_case(file, **settings) -> dict:
    """Return a case whose asperities are those of a patch in a file."""
    tables = moes_contact(100.0, 8.0).model_dump(exclude_none=True)
    patch = {"file": str(file), "pixel": 4e-6, "unit": "m"} | settings
    return tables | {"asperities": {"model": "surface", "map": patch}}


def test_a_changed_file_is_another_patch_and_a_result_needs_none(tmp_path):
    file = tmp_path / "ground.csv"
    np.savetxt(file, 2e-5 * random_patch(32), delimiter=",")
    problem = case_from_tables(patch_case(file))[0]
    first = solve(problem, Options(points=65))
    np.savetxt(file, 1e-5 * random_patch(32), delimiter=",")
    second = solve(problem, Options(points=65))
    assert second.load_sharing.share < 0.7 * first.load_sharing.share
    save(first, tmp_path / "first.nc")
    file.unlink()
    kept = load(tmp_path / "first.nc")
    assert kept.load_sharing == first.load_sharing
    assert kept.roughness.lambda_central == first.roughness.lambda_central
    with pytest.raises(InputError, match="ground"):
        solve(problem)


@pytest.mark.parametrize("name", ["x", "y", "rotate"])
def test_a_patch_has_no_place(tmp_path, name):
    np.savetxt(tmp_path / "ground.csv", 2e-5 * random_patch(64), delimiter=",")
    with pytest.raises(InputError, match=rf"map\.{name} does not apply to a patch"):
        case_from_tables(patch_case(tmp_path / "ground.csv", **{name: 1e-5}))


def test_a_patch_whose_contact_does_not_converge_is_refused(monkeypatch):
    monkeypatch.setattr(contact, "MOST_ITERATIONS", 1)
    with pytest.raises(InputError, match="does not converge; a lambda_s removes spikes"):
        patch_curves(1e-4 * random_patch(32), (1e-6, 1e-6))


def test_a_contact_of_two_summits_comes_to_rest():
    """Their gaps are rounding, of which a step has no length."""
    random = np.random.default_rng(177).normal(size=(48, 48))
    squares = np.add.outer(np.fft.fftfreq(48) ** 2, np.fft.fftfreq(48) ** 2)
    z = np.fft.ifft2(np.fft.fft2(random) * np.exp(-18.0 * np.pi**2 * squares)).real
    z *= 0.15e-6 / z.std()
    found = patch_curves(z - z.mean(), (1e-6, 1e-6))
    assert np.isfinite(found.pressure).all()
    assert (np.diff(found.pressure) < 0.0).all()
