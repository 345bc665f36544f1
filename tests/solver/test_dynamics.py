"""Stiffness and damping: independent values, two steady films, the march in time, passivity."""

from importlib.metadata import version
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result, load
from tehl.api.solvers import solve, solve_transient
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.io.export import export
from tehl.io.store import save
from tehl.operators.flow import flow_table
from tehl.plots.dynamics import dynamics_curves
from tehl.result.solution import Hint, Status
from tehl.solver.cycle.equations import Equations
from tehl.solver.cycle.level import Level
from tehl.solver.cycle.relaxation import FAST
from tehl.solver.cycle.start import pose_problem
from tehl.solver.physics import dynamics, frequencies
from tehl.solver.physics.dynamics import changes
from tehl.studies.bearing import bearing_table, in_series, radial_loads
from tests.cases import ball_tables
from tests.reference import moes_contact

INDEPENDENT = {
    (50.0, 10.0): {0.1: (3.04164833, 0.0227288612), 1.0: (3.16664125, 0.125741431),
                   3.0: (3.12817813, 0.105834422)},
    (50.0, 5.0): {0.1: (3.040861, 0.0192162414), 1.0: (3.13311085, None), 3.0: (3.13767678, None)},
    (100.0, 5.0): {0.1: (3.08136716, None), 1.0: (3.13998161, None), 3.0: (3.13064637, None)},
}  # fmt: skip
"""k and Omega c of an independent solver (dense Newton's method, three grids), over M, L, Omega."""
DOMAIN = Domain(x=(-3.5, 1.5), y=(-2.5, 2.5))


LINES = {
    (100.0, 11.0): {0.1: (4.50010561, 0.00897385956), 1.0: (4.55554681, 0.0432743875),
                    3.0: (4.5171808, 0.0536961194)},
    (20.0, 10.0): {0.1: (4.34669678, 0.0481125348), 1.0: (4.65038614, 0.233766637),
                   3.0: (4.47579953, 0.237891212), 10.0: (4.74892539, 0.414197655)},
}  # fmt: skip
"""The same of line contacts held at a half-width, in p_h R/b, of the same solver."""


def on(points: int, **settings: object) -> Options:
    return Options(points=points, domain=DOMAIN, edges="zero", **settings)


def at(problem: ContactProblem, *omegas: float) -> ContactProblem:
    """Return a problem with dynamics at some omega a_x/u_m."""
    unit = 2.0 * np.pi * time_of(problem)
    given = problem.model_dump(exclude_none=True)
    table = {"frequencies": [one / unit for one in omegas]} if omegas else {}
    return ContactProblem.model_validate(given | {"dynamics": table})


def time_of(problem: ContactProblem) -> float:
    return scales(problem).half_width_x / scales(problem).speed


def dimensionless(found: Result) -> tuple[np.ndarray, np.ndarray]:
    """Return k and Omega c [-]."""
    one = found.scales
    unit = one.hertz_pressure * one.half_width_x * one.half_width_y / one.film_thickness
    response = found.dynamics.impedance / unit
    return response.real, response.imag


@pytest.fixture(scope="module")
def swept() -> Result:
    """Return a film at the default frequencies."""
    return solve(at(moes_contact(50.0, 10.0)), on(65))


@pytest.mark.parametrize(
    "group",
    [
        *list(INDEPENDENT)[:2],
        *(pytest.param(one, marks=pytest.mark.slow) for one in list(INDEPENDENT)[2:]),
    ],
    ids=str,
)
def test_stiffness_and_damping_are_those_of_an_independent_solver(group):
    known = INDEPENDENT[group]
    found = solve(at(moes_contact(*group), *known), on(129))
    stiffness, damping = dimensionless(found)
    bar = found.dynamics.stiffness_error / found.dynamics.stiffness
    for number, (k, omega_c) in enumerate(known.values(), start=1):
        assert stiffness[number] == pytest.approx(k, rel=max(1e-3, bar[number]))
        if omega_c is not None:
            assert damping[number] == pytest.approx(omega_c, rel=0.03)


def line_problem(load, speed, **tables):
    contact = {"type": "line", "radius": 0.02, "moes_load": load, "moes_speed": speed}
    point = moes_contact(load, speed).model_dump(exclude_none=True)
    return ContactProblem.model_validate(point | {"contact": contact} | tables)


@pytest.mark.parametrize("group", LINES, ids=str)
def test_a_line_contact_has_the_response_of_an_independent_solver(group):
    known, problem = LINES[group], line_problem(*group)
    film = solve(at(problem, *known), Options(points=513)).dynamics
    scale, E = scales(problem), problem.reduced_modulus
    unit = scale.hertz_pressure * problem.radius_x / scale.half_width_x
    # without the solids from a half-width to R_x, at which surfaces are held by default
    solids = 4.0 / (np.pi * E) * np.log(problem.radius_x / scale.half_width_x)
    near = 1.0 / (1.0 / film.impedance - solids) / unit
    for number, (k, omega_c) in enumerate(known.values(), start=1):
        assert near.real[number] == pytest.approx(k, rel=2.5e-3)
        # the far field of a line: 0.5 % at Omega = 1, 1.5 % at 3 and 3 % at 10
        assert near.imag[number] == pytest.approx(omega_c, rel=0.035)
    assert film.stiffness[0] < 0.4 * unit * 4.5


def test_lines_with_heat_or_scarce_oil_and_at_other_distances_have_a_response():
    oil = moes_contact(50.0, 10.0).model_dump(exclude_none=True)["lubricant"]
    oil["viscosity"] |= {"gamma": 0.04}
    oil |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    parts = {"thermal": {}, "lubricant": oil}, {"supply": {"ratio": 0.6}}, {}
    warm, scarce, plain = (
        solve(at(line_problem(50.0, 10.0, **part), 1.0), Options(points=257)).dynamics
        for part in parts
    )
    for film in (warm, scarce):
        assert (film.damping > 0.0).all()
        assert (film.stiffness_error < 0.02 * film.stiffness).all()
        assert film.stiffness == pytest.approx(plain.stiffness, rel=0.05)
    problem = line_problem(50.0, 10.0)
    half = scales(problem).half_width_x
    given = at(problem, 1.0).model_dump(exclude_none=True)
    given["dynamics"] |= {"held_at": 100.0 * half}
    far = solve(ContactProblem.model_validate(given), Options(points=257)).dynamics
    more = 4.0 / (np.pi * problem.reduced_modulus) * np.log(100.0 * half / problem.radius_x)
    np.testing.assert_allclose(1.0 / far.impedance, 1.0 / plain.impedance + more, rtol=1e-6)
    given["dynamics"] |= {"held_at": 0.5 * half}
    with pytest.raises(ValueError, match="outside the contact"):
        ContactProblem.model_validate(given)
    ball = moes_contact(50.0, 10.0).model_dump(exclude_none=True)
    with pytest.raises(ValueError, match="only for line contacts"):
        ContactProblem.model_validate(ball | {"dynamics": {"held_at": 0.01}})


def test_at_rest_the_stiffness_is_that_of_two_steady_films():
    problem, change = moes_contact(50.0, 10.0), 5e-5
    forces, places = [], []
    for factor in (1.0 - change, 1.0 + change):
        given = problem.model_dump(exclude_none=True)
        whole = scales(problem)
        given["contact"] = {
            "radius": problem.radius_x,
            "load": factor * whole.load,
            "entrainment_speed": whole.speed,
        }
        loaded = ContactProblem.model_validate(given)
        part = whole.half_width_x / scales(loaded).half_width_x  # the same nodes
        x, y = (tuple(part * edge for edge in edges) for edges in (DOMAIN.x, DOMAIN.y))
        options = Options(points=65, domain=Domain(x=x, y=y), edges="zero", accuracy="tight")
        found = solve(loaded, options.model_copy(update={"tolerance": 1e-10}))
        forces.append(found.load)
        places.append(found.rigid_approach * found.scales.film_thickness)
    slope = -(forces[1] - forces[0]) / (places[1] - places[0])
    still = solve(at(problem, 1.0), on(65, accuracy="tight")).dynamics.stiffness[0]
    assert still == pytest.approx(slope, rel=1e-4)


ROLLER_STIFFNESS = 452.2e6
"""Limit of the stiffness at rest of `even_roller` [N/m], first order over 65, 129 and 257 lines."""


def even_roller(*omegas: float, factor: float = 1.0) -> ContactProblem:
    """Return a roller pressed evenly, under ``factor`` times its load, at some omega b/u_m."""
    shape = {"type": "roller", "radius": "20 mm", "length": "10 mm"}
    given = line_problem(20.0, 10.0).model_dump(exclude_none=True)
    once = scales(ContactProblem.model_validate(given))
    load, speed = 0.01 * once.load, once.speed
    profile = {"shape": "logarithmic", "design_load": load}
    given["contact"] = shape | {
        "load": factor * load, "entrainment_speed": speed, "profile": profile
    }  # fmt: skip
    problem = ContactProblem.model_validate(given)
    return at(problem, *omegas) if omegas else problem


def test_at_rest_the_stiffness_of_a_roller_is_that_of_two_steady_films():
    change, forces, places = 1e-4, [], []
    options = {"points": (97, 33), "edges": "far_field", "accuracy": "tight"}
    width = scales(even_roller()).half_width_x
    for factor in (1.0 - change, 1.0 + change):
        problem = even_roller(1.0, factor=factor)  # on even lines, as the dynamics need them
        part = width / scales(problem).half_width_x  # the same nodes
        domain = Domain(x=(-3.5 * part, 1.5 * part), y=(-1.0, 1.0))
        tight = Options(domain=domain, **options).model_copy(update={"tolerance": 1e-10})
        found = solve(problem, tight)
        forces.append(found.load)
        places.append(found.rigid_approach * found.scales.film_thickness)
    slope = -(forces[1] - forces[0]) / (places[1] - places[0])
    domain = Domain(x=(-3.5, 1.5), y=(-1.0, 1.0))
    film = solve(even_roller(1.0), Options(domain=domain, **options)).dynamics
    assert film.stiffness[0] == pytest.approx(slope, rel=1e-4)
    assert abs(film.stiffness[0] - ROLLER_STIFFNESS) < film.stiffness_error[0]
    assert (film.stiffness_error < 0.03 * film.stiffness).all()


def test_the_film_of_a_long_roller_yields_like_that_of_a_line():
    """Compliances over the frequency, less those at rest: the solids are in series with the film.

    The ends make a difference of 4 %, on 257 x 129 nodes too.
    """
    omegas = 0.3, 1.0
    roller = solve(even_roller(*omegas), Options(points=(129, 65))).dynamics
    line = solve(at(line_problem(20.0, 10.0), *omegas), Options(points=513)).dynamics
    still, moving = (1.0 / film.impedance[1:] - 1.0 / film.impedance[0] for film in (line, roller))
    # of the line: that of one metre
    assert np.abs(100.0 * still - moving).max() < 0.05 * np.abs(moving).max()
    assert (roller.damping > 0.0).all()
    assert abs(roller.stiffness[0] - ROLLER_STIFFNESS) < roller.stiffness_error[0]
    assert (roller.stiffness_error < 0.015 * roller.stiffness).all()
    assert (roller.damping_error < 0.03 * roller.damping)[:-1].all()


def marched(omega, options):
    """Return the response k + i omega c to a load with an amplitude of 1 %, by its phase."""
    problem, periods = moes_contact(50.0, 10.0), 3
    period = 2.0 * np.pi / omega * time_of(problem)
    times = np.linspace(0.0, periods * period, 24 * periods + 1)
    given = problem.model_dump(exclude_none=True)
    phase = omega * times / time_of(problem)
    given["transient"] = {
        "duration": times[-1],
        "load": [[t, 1.0 + 0.01 * np.sin(one)] for t, one in zip(times, phase, strict=True)],
        "frames": 0,
        "tolerance": 1e-6,
    }
    run = solve_transient(ContactProblem.model_validate(given), options)
    history = run.history
    last = history.time > (periods - 1) * period
    angle = omega * history.time[last] / time_of(problem)
    basis = np.stack([np.ones(angle.size), np.sin(angle), np.cos(angle)], axis=1)
    (_, sine, cosine), *_ = np.linalg.lstsq(basis, history.rigid_approach[last], rcond=None)
    (_, load_sine, load_cosine), *_ = np.linalg.lstsq(basis, history.load[last], rcond=None)
    target = 2.0 * np.pi / 3.0
    return -target * (load_sine + 1j * load_cosine) / (sine + 1j * cosine)


@pytest.mark.parametrize(
    ("omega", "points"),
    [
        pytest.param(0.3, 97, marks=pytest.mark.slow),
        (1.0, 49),
        pytest.param(3.0, 129, marks=pytest.mark.slow),
    ],
)
def test_the_march_in_time_has_the_same_response(omega, points):
    found = marched(omega, on(points))
    stiffness, damping = dimensionless(solve(at(moes_contact(50.0, 10.0), omega), on(points)))
    assert found.real == pytest.approx(stiffness[1], rel=0.01)
    assert found.imag == pytest.approx(damping[1], rel=0.03)


def test_the_edges_of_a_run_have_what_its_gap_squeezes():
    """By the wedge alone on the edges the damping would be 13 % too low."""
    options = Options(points=49, edges="far_field", wedge_order=3)
    found = marched(1.0, options)
    stiffness, damping = dimensionless(solve(at(moes_contact(50.0, 10.0), 1.0), options))
    assert found.real == pytest.approx(stiffness[1], rel=0.01)
    assert found.imag == pytest.approx(damping[1], rel=0.05)


def test_frequencies_within_a_factor_of_two_share_a_factorisation(monkeypatch):
    def inverse(_, omega, order=None):
        close = SimpleNamespace(perm_c=np.arange(3))
        return SimpleNamespace(omega=omega, order=order, close=close)

    monkeypatch.setattr(frequencies, "CloseInverse", inverse)
    inverses = frequencies.CloseInverses(None)
    assert inverses.at(1.0) is inverses.at(2.0) is inverses.at(0.5)
    assert inverses.at(1.0).order is None  # the first one finds it
    assert inverses.at(0.0) is inverses.at(0.0)
    assert inverses.at(0.0).order is not None
    assert len({id(inverses.at(omega)) for omega in (0.0, 1.0, 2.1, 0.4)}) == 4


def test_films_absorb_and_obey_kramers_and_kronig():
    """k(Omega) - k(0) = -(2 Omega^2/pi) P int c(Omega') / (Omega'^2 - Omega^2) from c alone.

    With frequencies up to 30 it is right to 13 % at Omega = 3, up to 100 to 0.1 %, up to 300 to
    0.01 %: waves of oil reach far. At Omega = 0.1 k has risen by 0.07 % only.
    """
    given = np.geomspace(0.03, 300.0, 80)
    swept = solve(at(moes_contact(50.0, 10.0), *given), on(65))
    assert (swept.dynamics.damping > 0.0).all()
    stiffness, absorbed = dimensionless(swept)
    fine = np.exp(np.linspace(np.log(given[0]), np.log(given[-1]), 8001))
    c = CubicSpline(np.log(given), absorbed[1:] / given)(np.log(fine))
    k = CubicSpline(np.log(given), stiffness[1:])(np.log(fine))
    step = np.log(fine[1] / fine[0])
    for omega, rel in ((0.1, 5e-3), (0.3, 2e-3), (1.0, 2e-3), (3.0, 2e-3), (10.0, 1e-2)):
        place = int(np.argmin(np.abs(fine - omega)))
        odd = np.arange(fine.size) % 2 != place % 2  # the principal value: nodes on both sides
        integral = 2.0 * step * (c * fine)[odd] @ (1.0 / (fine[odd] ** 2 - fine[place] ** 2))
        below = (fine[place] - fine[0]) / (fine[place] + fine[0])
        integral += c[0] * np.log(below) / (2.0 * fine[place])
        risen = -2.0 * fine[place] ** 2 / np.pi * integral
        assert risen == pytest.approx(k[place] - stiffness[0], rel=rel)


def test_a_film_that_is_thin_leaves_the_dry_stiffness():
    stiffness, damping = dimensionless(solve(at(moes_contact(300.0, 14.0), 0.3), on(129)))
    assert stiffness == pytest.approx(np.pi, rel=0.015)
    assert damping[1] < 0.03


@pytest.mark.parametrize("table", [{"supply": {"ratio": 0.6}}, {"thermal": {}}], ids=str)
def test_starved_and_heated_films_have_both(table):
    tables = ball_tables(dynamics={"frequencies": ["200 Hz", "2 kHz"]}, **table)
    if "thermal" in table:
        tables["lubricant"] |= {"conductivity": "0.14 W/(m K)", "heat_capacity": "2000 J/(kg K)"}
        tables["lubricant"]["viscosity"] |= {"gamma": "0.04 1/K"}
        tables["contact"] |= {"slide_roll_ratio": 0.3}
    found = solve(case_from_tables(tables)[0], Options(points=65))
    stiffness, damping = dimensionless(found)
    assert stiffness == pytest.approx(np.pi, rel=0.05)
    assert damping[1] > 0.0
    # behind a meniscus the damping is of first order, and its bar may exceed it
    assert (found.dynamics.damping + found.dynamics.damping_error > 0.0).all()


def test_the_bar_of_a_starved_stiffness_contains_that_of_steady_films():
    """Films of the same layer at four loads around 80 N, on 257 nodes: 49.63 N/um."""
    tables = ball_tables(supply={"layer": "0.2 um"}, dynamics={"frequencies": ["200 Hz"]})
    domain = Domain(x=(-2.6, 1.5), y=(-1.9, 1.9))
    found = solve(case_from_tables(tables)[0], Options(points=129, domain=domain)).dynamics
    assert 0.0 < found.stiffness_error[0] < 0.05 * found.stiffness[0]
    assert abs(found.stiffness[0] - 49.63e6) < found.stiffness_error[0]


def test_results_keep_and_show_stiffness_and_damping(swept: Result, tmp_path):
    save(swept, tmp_path / "a.nc")
    again = load(tmp_path / "a.nc")
    assert (again.dynamics.damping == swept.dynamics.damping).all()
    assert len(again.summary()["dynamics"]["over_frequency"]) == swept.dynamics.frequency.size
    assert "  dynamics  " in as_text(again)
    assert dynamics_curves(again).axes
    export(again, tmp_path / "a.csv", what="dynamics")
    columns = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True)
    assert columns["frequency_hz"].tolist() == swept.dynamics.frequency.tolist()
    assert columns["damping_n_s_per_m"].tolist() == swept.dynamics.damping.tolist()
    assert len(columns.dtype.names or ()) == 12


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"dynamics": {"frequencies": ["2 kHz", "1 kHz"]}}, "must exceed the one before"),
        (
            {"dynamics": {}, "contact_film": {"thickness": "5 nm"}},
            "dynamics and contact_film exclude each other",
        ),
    ],
)
def test_mistakes_are_one_sentence(tables, words):
    with pytest.raises(InputError, match=words):
        case_from_tables(ball_tables(**tables))


def test_two_films_in_series_are_half_as_stiff():
    film = np.array([1e8 + 2e6j])
    assert in_series(film, film) == pytest.approx(0.5 * film)
    assert abs(in_series(film, film, 1e14)[0] - film[0]) < 1e-5 * abs(film[0])  # it stays at rest


def test_rotor_programs_read_the_table_of_a_bearing():
    """ROSS takes the coefficients of a bearing over the frequency, and a disc on it vibrates.

    ROSS 3 takes those over speed and frequency: between two speeds of the table it has their mean.
    """
    rings = tuple(case_from_tables(ball_tables())[0] for _ in range(2))
    angles, loads = radial_loads(100.0, 7)
    assert (loads * np.cos(angles)).sum() == pytest.approx(100.0)
    table = bearing_table(
        rings, (angles, loads), [200.0, 400.0], [100.0, 300.0],
        entrainment_radius=0.02, options=Options(points=65),
    )  # fmt: skip
    found = table.coefficients(300.0)
    assert found["kxx"].min() > 1e7
    assert found["kxx"].min() > found["kyy"].max()  # along the force
    assert np.abs(found["kxy"]).max() < 1e-6 * found["kxx"].max()
    assert (found["cxx"] > 0.0).all()
    with pytest.raises(InputError, match="beyond the table"):
        table.coefficients(1000.0)
    one = {"type": "line", "load_per_length": 5e4, "entrainment_speed": 1.0, "radius": 0.01}
    line = case_from_tables(ball_tables(contact=one))[0]
    with pytest.raises(InputError, match='state "roller" with it'):
        bearing_table((line, line), (angles, loads), [200.0], [100.0], entrainment_radius=0.02)
    whole = table.coefficients()
    assert whole["cyy"].shape == (2, 2)
    np.testing.assert_allclose(whole["cyy"].mean(axis=0), found["cyy"])
    ross = pytest.importorskip("ross", reason="ross-rotordynamics is not installed")
    steel = ross.Material(name="steel", rho=7810.0, E=211e9, G_s=81.2e9)
    shaft = [ross.ShaftElement(L=0.25, idl=0.0, odl=0.05, material=steel) for _ in range(2)]
    disk = ross.DiskElement.from_geometry(n=1, material=steel, width=0.07, i_d=0.05, o_d=0.28)
    bearings = [ross.BearingElement(n=node, **found) for node in (0, 2)]
    rotor = ross.Rotor(shaft, [disk], bearings)
    first = rotor.run_modal(speed=300.0).wn[0]
    assert first > 100.0
    if int(version("ross-rotordynamics").split(".")[0]) >= 3:
        bearings = [ross.BearingElement(n=node, **whole) for node in (0, 2)]
        read = bearings[0].K(frequency=100.0, speed=300.0)[0, 0]
        assert read == pytest.approx(found["kxx"][0], rel=1e-6)
        modes = ross.Rotor(shaft, [disk], bearings).run_modal(speed=300.0)
        assert modes.wn[0] == pytest.approx(first, rel=1e-3)


def squeezed(scaled, gap, reach, points):
    """Return c of a parabolic gap without pressure, within ``reach`` of its lengths."""
    edge, levels = reach * np.sqrt(2.0 * gap), []
    square = Domain(x=(-edge, edge), y=(-edge, edge))
    for number in (17, points):
        grid = Grid(nx=number, ny=number // 2 + 1, domain=square, mirror=True)
        options = Options(deformation="fft", edges="zero")
        levels.append(Level(Equations.on(grid, scaled, flow_table(scaled), options), FAST))
        pose_problem(levels[-1])
        # hardly any pressure: nothing is cavitated, thickened or bent
        levels[-1].set_state(np.full(grid.shape, 1e-12), gap)
    return changes(levels, np.zeros(1), inputs=1).load_by_approach[1, 0]


def test_without_entrainment_a_stiff_film_damps_as_a_sphere_near_a_plane():
    """Reynolds' squeeze film, 6 pi eta R^2/h_0; both limits are of second order."""
    scaled, gap = ScaledProblem.of(moes_contact(50.0, 0.2)), 4.0
    near, far = (
        (4.0 * squeezed(scaled, gap, reach, 2 * n + 1) - squeezed(scaled, gap, reach, n + 1)) / 3.0
        for reach, n in ((6.0, 48), (12.0, 96))
    )
    exact = 0.5 * np.pi * scaled.groups.lambda_bar / gap
    assert (4.0 * far - near) / 3.0 == pytest.approx(exact, rel=0.01)


def test_directions_of_the_steady_film_serve_at_each_frequency():
    """(A - i Omega B) u is its triangular parts times orthonormal rows."""
    random = np.random.default_rng(1)
    steps, stored = random.normal(size=(2, 5, 40))
    steady = np.linalg.qr(random.normal(size=(40, 5)))[0].T
    parts, images = frequencies.SteadySteps(steps, steady, stored).at(3.0)
    assert images.conj() @ images.T == pytest.approx(np.eye(5), abs=1e-12)
    assert parts.T @ images == pytest.approx(steady - 3.0j * stored, abs=1e-12)


def test_a_response_that_does_not_converge_leaves_the_film(monkeypatch):
    monkeypatch.setattr(frequencies, "MOST_DIRECTIONS", 3)
    found = solve(at(moes_contact(20.0, 5.0), 1.0), on(49))
    assert found.dynamics is None
    assert found.status.outcome == "converged, stiffness open"
    assert "at 0 Hz" in found.status.message
    assert "does not converge" in as_text(found)
    sharp = Status(kind="converged", message="Sharp end.", hint=Hint("Relieve it."))
    monkeypatch.setattr(dynamics, "film_dynamics", Mock(side_effect=frequencies.NoResponseError(1)))
    known = dynamics.with_dynamics(found.but(status=sharp), None).status
    assert known.message.startswith("Sharp end. The response of the film at ")
