"""Line and point relaxation against dense solves and finite differences."""

import numpy as np
import pytest

from tehl.kernels import properties, relaxation, reynolds
from tehl.kernels.faces import CLOSED, IN_TIME, Stencil
from tehl.kernels.lanes import LANES
from tehl.kernels.relaxation import LineRelaxation
from tests.kernels.interpreted import interpreted
from tests.kernels.reynolds_twin import isotropic, operator_twin, random_film, stencil_of

MIRROR = pytest.mark.parametrize("mirror", [0, 1])
python = interpreted("relaxation")
REACH = np.arange(8)


def relaxation_of(shape, xi=0.0, omega=(1.0, 1.0), influence=0.0, parts=(0.25, 0.25)):
    """Return settings under which a line bends itself by more the farther north it is."""
    (ny, nx), (along, aside) = shape, parts
    softer = influence * np.linspace(1.0, 2.0, ny)[:, np.newaxis]
    of_dipoles = np.tile([along, aside, aside, aside], (ny, 1))
    return LineRelaxation(
        xi=xi,
        omega_point=omega[0],
        omega_dipole=omega[1],
        shapes=relaxation.Shapes(
            point=relaxation.by_lanes(softer / (1.0 + REACH)),
            dipole=relaxation.by_lanes(softer / (1.0 + REACH) ** 3),
            parts=relaxation.by_lanes(of_dipoles),
        ),
        systems=relaxation.empty_systems(nx),
        kind=np.zeros(shape, np.uint8),
        delta=np.zeros(shape),
        frozen=np.zeros(shape, np.uint8),
        stiffness=np.zeros(shape),
        ends=np.full(shape[0], nx - 1),
    )


@pytest.mark.parametrize("drift", [0.0, 0.4])
def test_a_sweep_against_x_is_the_mirror_image_of_one_along_x(drift):
    shape, rng = (9, 24), np.random.default_rng(4)
    film, stencil = random_film(shape), stencil_of(0)
    film.p[3:5, 15:20] = 0.0
    rhs, found = rng.standard_normal(shape), []
    for way in (1, -1):
        turned = [field[:, ::way].copy(order="C") for field in film[:7]]
        moved = film._replace(**dict(zip(film._fields[:7], turned, strict=True)))
        moved = moved._replace(
            speed=way * np.linspace(0.5, 1.5, 9),
            drift=np.tile(drift * np.linspace(-1.0, 1.0, 24)[::way], (9, 1)),
        )
        settings = relaxation_of(shape, xi=20.0, omega=(0.7, 0.6), influence=0.2)
        shapes = settings.shapes
        curved = np.array([shapes.point[1, :, 0], shapes.dipole[1, :, 0]])
        settings = settings._replace(shapes=shapes._replace(curved=curved))
        relaxation.relax_lines(moved, stencil, np.ascontiguousarray(rhs[:, ::way]), settings)
        found.append(moved.p[:, ::way])
    assert np.abs(found[0] - film.p).max() > 0.01
    np.testing.assert_allclose(found[1], found[0], rtol=1e-10, atol=1e-12)


def system(nx):
    """The six-diagonal systems of eight lines, as records."""
    return relaxation.empty_systems(nx).nodes


def values(nodes, field):
    """A field of all nodes, (nx, LANES), as a view."""
    return nodes[field][3:-3]


def dense_band(nodes, lane):
    nx = len(nodes) - 6
    band = np.zeros((nx, nx))
    for i in range(1, nx - 1):
        for s in range(-3, 3):
            if 1 <= i + s <= nx - 2:
                band[i, i + s] = values(nodes, relaxation.BAND[s + 3])[i, lane]
    return band[1:-1, 1:-1]


def random_band(nx, seed=0):
    """Bands that fall monotonically: the diagonal dominates, neighbours raise one another."""
    rng = np.random.default_rng(seed)
    nodes = system(nx)
    for s in range(-3, 3):
        share = rng.random((nx, LANES))
        values(nodes, relaxation.BAND[s + 3])[:] = -6.0 - share if s == 0 else share
    values(nodes, "rest")[:] = rng.standard_normal((nx, LANES))
    values(nodes, "p")[:] = np.maximum(rng.standard_normal((nx, LANES)), 0.0)
    return nodes


def test_nodes_of_small_conductance_far_from_cavities_relax_as_dipoles():
    shape = (7, 9)
    film, stencil = random_film(shape), stencil_of(mirror=0)
    film.eps[:] = 1e-6
    film.eps[:, 6] = 1.0
    film.p[1, 1] = 0.0
    setting = relaxation_of(shape, xi=1.0)
    python.mark_dipoles(film, stencil, setting)
    expected = np.zeros(shape, np.uint8)
    expected[1:-1, 1:5] = 1
    expected[1, 1] = expected[1, 2] = expected[2, 1] = 0
    np.testing.assert_array_equal(setting.kind, expected)


def test_lines_that_are_far_apart_leave_each_other_their_kind_and_their_cavities():
    shape = (7, 9)
    film, stencil = random_film(shape), stencil_of(mirror=CLOSED, dy=2.0)
    film.eps[:] = 1e-6
    film.eps[3] = 1e4  # conducts well, but little flows to the lines beside
    film.p[3, 3:] = 0.0
    setting = relaxation_of(shape, xi=1.0, parts=(0.49, 0.01))._replace(apart=1)
    python.mark_dipoles(film, stencil, setting)
    expected = np.zeros(shape, np.uint8)
    expected[:, 1:-1] = 1
    expected[3] = 0
    np.testing.assert_array_equal(setting.kind, expected)
    setting.delta[2, 5] = -1.0
    python.add_dipoles(film, setting, stencil)
    assert film.p[3, 5] == 0.0  # a cavity is not filled from the line beside


@pytest.mark.parametrize("conserves", [0, IN_TIME])
def test_dipoles_do_not_fill_partly_filled_nodes_of_the_line_beside_in_a_time_step(conserves):
    shape = (7, 9)
    film, stencil = random_film(shape), stencil_of(mirror=0)._replace(conserves=conserves)
    film.p[3, 3:] = 0.0
    setting = relaxation_of(shape, xi=1.0)
    setting.delta[2, 5] = -1.0
    python.add_dipoles(film, setting, stencil)
    assert bool(film.p[3, 5] == 0.0) is (conserves == IN_TIME)


@MIRROR
@pytest.mark.parametrize(
    ("dipole", "parts"), [(0, (0.25, 0.25)), (1, (0.25, 0.25)), (1, (0.4, 0.1))]
)
def test_the_band_is_the_derivative_of_the_operator(dipole, parts, mirror):
    shape, j = (5, 12), 1
    if mirror:
        j = 0
    nx = shape[1]
    film, stencil = random_film(shape, 4), stencil_of(mirror)
    setting = relaxation_of(shape, influence=0.4, parts=parts)
    setting.kind[j, 1:-1] = dipole
    python.set_up(film, stencil, setting, (j, 1), (1, nx - 2))
    band = dense_band(setting.systems.nodes, 0)
    shapes = (setting.shapes.dipole if dipole else setting.shapes.point)[j % 2, :, j // 2]
    for k in range(1, nx - 1):
        change = np.zeros(shape)
        change[j, k] = 1.0
        if dipole:
            change[j, [k - 1, k + 1]] = -parts[0]
            change[[j + 1, abs(j - 1)], k] = -parts[1]
        lift = np.zeros(shape)
        lift[j] = np.append(shapes, np.zeros(nx))[np.abs(np.arange(nx) - k)]

        def moved(t, change=change, lift=lift):
            return operator_twin(
                film._replace(
                    p=film.p + t * change,
                    h=film.h + t * lift,
                    rho=film.rho + t * film.drho * change,
                ),
                stencil,
            )

        derivative = 0.5 * (moved(1.0) - moved(-1.0))[j, 1:-1]
        rows = np.arange(1, nx - 1)
        near = (rows >= k - 2) & (rows <= k + 3)
        np.testing.assert_allclose(band[near, k - 1], derivative[near], rtol=1e-11, atol=1e-11)


def test_band_solve_equals_a_dense_solve_in_every_lane():
    nx = 14
    nodes = random_band(nx)
    python.band_solve(nodes, 1, nx - 2)
    for lane in range(LANES):
        expected = np.linalg.solve(dense_band(nodes, lane), values(nodes, "rest")[1:-1, lane])
        np.testing.assert_allclose(values(nodes, "u")[1:-1, lane], expected, rtol=1e-11, atol=1e-13)


def test_cavitated_and_kept_nodes_enter_the_solve_with_known_changes():
    nx = 10
    nodes = random_band(nx, seed=3)
    state = values(nodes, "state")
    state[4, 0], state[7, 0] = 1.0, 2.0
    python.band_solve(nodes, 1, nx - 2)
    u, p = (values(nodes, name)[:, 0] for name in ("u", "p"))
    assert u[4] == -p[4]
    assert u[7] == 0.0
    lack = values(nodes, "rest")[1:-1, 0] - dense_band(nodes, 0) @ u[1:-1]
    np.testing.assert_allclose(np.delete(lack, [3, 6]), 0.0, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_policy_iteration_ends_with_complementary_pressure_and_residual(seed):
    nx = 25
    nodes = random_band(nx, seed)
    p, rest = (values(nodes, name) for name in ("p", "rest"))
    values(nodes, "state")[:] = (p <= 0.0) & (rest >= 0.0)
    assert python.complementarity(nodes, (1, nx - 2), nx - 2) == (1, nx - 2)
    for lane in range(LANES):
        u = values(nodes, "u")[1:-1, lane]
        new = p[1:-1, lane] + u
        lack = rest[1:-1, lane] - dense_band(nodes, lane) @ u
        assert new.min() > -1e-12
        assert lack[new < 1e-12].min(initial=0.0) > -1e-12
        np.testing.assert_allclose(lack[new > 1e-12], 0.0, atol=1e-11)


@MIRROR
@pytest.mark.parametrize("shape", [(25, 33), (20, 14)])
def test_lines_relaxed_side_by_side_equal_lines_relaxed_one_by_one(shape, mirror):
    film, stencil = random_film(shape, 5), stencil_of(mirror)
    rng = np.random.default_rng(6)
    film.p[rng.random(shape) < 0.2] = 0.0
    film.p[:, -6:] = 0.0
    film.eps[:, 4:9] = 1e-4
    rhs = 20.0 * rng.standard_normal(shape)
    setting = relaxation_of(shape, xi=0.1, omega=(0.8, 0.6), influence=0.1)
    setting.frozen[rng.random(shape) < 0.1] = 1
    one = film._replace(p=film.p.copy())
    relaxation.relax_lines(film, stencil, rhs, setting)
    assert setting.kind.any()
    setting.delta[:] = 0.0
    first = 0 if mirror else 1
    for colour in range(2):
        for j in range(first + colour, shape[0] - 1, 2):
            python.relax_batch(one, stencil, rhs, setting, (j, 1))
    python.add_dipoles(one, setting, stencil)
    np.testing.assert_allclose(film.p, one.p, rtol=1e-10, atol=1e-12)


@MIRROR
def test_a_sweep_that_ends_where_all_is_frozen_equals_a_sweep_over_whole_lines(mirror):
    shape = (25, 33)
    film, stencil = random_film(shape, 8), stencil_of(mirror)
    film.eps[:, 4:9] = 1e-4
    setting = relaxation_of(shape, xi=0.1, omega=(0.8, 0.6), influence=0.1)
    ends = np.random.default_rng(9).integers(3, shape[1] - 1, shape[0])
    ends[4:9] = 0
    setting.frozen[:] = np.arange(shape[1]) >= ends[:, np.newaxis]
    whole, part = (film._replace(p=film.p.copy()) for _ in range(2))
    relaxation.relax_lines(whole, stencil, np.ones(shape), setting)
    relaxation.relax_lines(part, stencil, np.ones(shape), setting._replace(ends=ends))
    assert np.abs(part.p - film.p).max() > 1e-3
    np.testing.assert_array_equal(part.p, whole.p)


@MIRROR
def test_relaxation_reduces_the_residual_of_a_linear_problem(mirror):
    shape = (17, 17)
    film = isotropic(*(np.ones(shape) for _ in range(5)))
    film.drho[:] = 0.0
    film.p[:, 1:-1] += np.random.default_rng(7).random((17, 15))
    stencil = Stencil(64.0, 64.0, 0.0, 0.0, 0.0, mirror)
    rhs = np.full(shape, -5.0)
    setting, out = relaxation_of(shape), np.empty(shape)
    before = reynolds.residual(film, stencil, rhs, 0.0, out)
    for _ in range(4):
        relaxation.relax_lines(film, stencil, rhs, setting)
    assert reynolds.residual(film, stencil, rhs, 0.0, out) < 0.15 * before


def test_a_line_without_oil_to_move_is_left_alone():
    shape = (5, 12)
    film, stencil = isotropic(*(np.ones(shape) for _ in range(5))), stencil_of(mirror=0)
    film.p[:] = 0.0
    relaxation.relax_lines(film, stencil, np.ones(shape), relaxation_of(shape))
    assert not film.p.any()


def test_a_broken_pressure_is_relaxed_as_a_wet_one():
    film, setting = random_film((5, 12)), relaxation_of((5, 12))
    film.p[2] = 0.0
    film.p[2, 5] = np.nan
    assert python.wet_range(film, setting, 2, 0) == (5, 5)


def test_frozen_nodes_keep_their_pressure():
    shape = (9, 13)
    film, stencil = random_film(shape, 8), stencil_of(mirror=1)
    setting = relaxation_of(shape)
    setting.frozen[2:5, 3:7] = 1
    before = film.p.copy()
    relaxation.relax_lines(film, stencil, np.zeros(shape), setting)
    np.testing.assert_array_equal(film.p[2:5, 3:7], before[2:5, 3:7])
    assert film.p.min() >= 0.0
    assert (film.p != before).any()


@MIRROR
def test_the_stiffness_of_a_hollow_is_the_slope_of_the_flow_into_it(mirror):
    """At a node lower than its neighbours the conductance alone changes the flow: by its slope."""
    step, decay = 1e-3, 12.0
    rows = np.arange(4001) * step
    mobility, ones = np.exp(-decay * rows), np.ones_like(rows)
    mobility = np.stack([mobility, -decay * step * mobility], axis=1)
    flow = properties.FlowTable(mobility, np.stack([ones, 0.0 * ones], axis=1), step)
    stencil, p = stencil_of(mirror), 1.0 + 0.1 * np.random.default_rng(3).random((7, 8))
    p[3, 4] = 0.3
    fields = (np.empty_like(p) for _ in range(3))
    film, flows, nudge = isotropic(p, np.ones_like(p), *fields), [], 1e-5
    for sign in (-1.0, 1.0):
        moved = p.copy()
        moved[3, 4] += sign * nudge
        properties.properties(film._replace(p=moved), flow, 0.0)
        out = np.empty_like(p)
        reynolds.operator(film, stencil, out)  # the pressure itself stays
        flows.append(out[3, 4])
    properties.properties(film, flow, 0.0)
    stiffness = np.empty_like(p)
    relaxation.stiffen(film, stencil, flow, 1, stiffness)
    assert stiffness[3, 4] == pytest.approx((flows[0] - flows[1]) / (2 * nudge), rel=1e-2)
    assert (stiffness >= 0.0).all()


@pytest.mark.parametrize("steps", [(1.0, 0.0), (1.0, 1.0)], ids=["one side", "both sides"])
def test_the_stiffness_between_lines_of_a_roller_is_the_slope_of_the_flow_between_them(steps):
    """What flows from a line of high pressure follows the conductance of the lower one."""
    step, decay, shape = 1e-3, 12.0, (7, 8)
    rows = np.arange(4001) * step
    mobility, ones = np.exp(-decay * rows), np.ones_like(rows)
    mobility = np.stack([mobility, -decay * step * mobility], axis=1)
    flow = properties.FlowTable(mobility, np.stack([ones, 0.0 * ones], axis=1), step)
    stencil = stencil_of(CLOSED)._replace(cx=0.0, arithmetic=1.0 / 3.0)
    p, h = np.full(shape, 0.3), np.geomspace(1.0, 8.0, 7)[:, np.newaxis] + np.zeros(shape)
    p[2] += steps[0]
    p[4] += steps[1]
    fields = (np.empty_like(p) for _ in range(3))
    film, flows, nudge = isotropic(p, h, *fields), [], 1e-5
    for sign in (-1.0, 1.0):
        moved, out = p.copy(), np.empty_like(p)
        moved[3, 4] += sign * nudge
        properties.properties(film._replace(p=moved), flow, 0.0)
        reynolds.operator(film, stencil, out)
        flows.append(out[3, 4])
    properties.properties(film, flow, 0.0)
    stiffness = np.empty_like(p)
    relaxation.stiffen(film, stencil, flow, 0, stiffness)
    assert stiffness[3, 4] == pytest.approx((flows[0] - flows[1]) / (2 * nudge), rel=1e-3)
    relaxation.stiffen(film, stencil._replace(cx=1e3), flow, 0, stiffness)
    assert stiffness[3, 4] == pytest.approx((flows[0] - flows[1]) / (2 * nudge), rel=1e-3)


def test_a_stiff_node_moves_by_less():
    shape, stencil = (7, 8), stencil_of(0)
    film, changes = random_film(shape), []
    for stiffness in (0.0, 50.0):
        p, setting = film.p.copy(), relaxation_of(shape)
        setting.stiffness[3, 4] = stiffness
        relaxation.relax_lines(film._replace(p=p), stencil, np.zeros(shape), setting)
        changes.append(abs(p[3, 4] - film.p[3, 4]))
    assert 0.0 < changes[1] < changes[0]
