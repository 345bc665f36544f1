"""Contact through a boundary film: dry limits, oil balance, complementarity, uniqueness."""

from dataclasses import fields, replace

import numpy as np
import pytest

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import Result, TransientResult, load
from tehl.api.solvers import solve, solve_transient
from tehl.base.errors import InputError
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tehl.estimate.film_formulas import expected_central_film
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.io.store import save
from tehl.io.summary import summary
from tehl.kernels import reynolds
from tehl.operators.deformation import FftDeformation, Flattening
from tehl.plots import centre_lines, contact_map, pictures_of
from tehl.post.boundary_contact import largest_patches
from tehl.report.page import report_text
from tehl.result.transient import Frames
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.relaxation import BESIDE_NEWTON
from tehl.solver.cycle.start import from_dry_pressure
from tehl.solver.physics.boundary_contact import TouchingNewton
from tehl.solver.physics.boundary_system import TouchingSystem
from tehl.solver.transient.snapshot import Snapshot, pack, unpack
from tehl.solver.transient.step import Stepper
from tests.cases import ball_tables
from tests.reference import moes_contact
from tests.solver.rough import bumpy, with_roughness

SQUARE = Domain(x=(-2.0, 2.0), y=(-2.0, 2.0))
AROUND_BUMP = Domain(x=(-2.5, 1.5), y=(-2.0, 2.0))


def through_film(problem: ContactProblem, film: float, **table: float) -> ContactProblem:
    """Return a contact with a boundary film of H_c = ``film``."""
    thickness = film * scales(problem).film_thickness
    given = problem.model_dump(exclude_none=True)
    return ContactProblem.model_validate(given | {"contact_film": {"thickness": thickness} | table})


def on(points: int, domain: Domain = SQUARE, **settings: object) -> Options:
    return Options(points=points, domain=domain, edges="zero", **settings)


def both_pressures(result: Result) -> np.ndarray:
    """Return the pressure of oil and contact together [-]."""
    return result.scaled.pressure + result.contact.pressure / result.scales.hertz_pressure


@pytest.fixture(scope="module")
def bump() -> Result:
    """Return the bump of the dense reference solutions, M = 200, L = 0.5, H_c = 0.02."""
    problem = through_film(bumpy((200.0, 0.5), 1.0, 0.25), 0.02)
    return solve(problem, on(65, AROUND_BUMP, accuracy="tight"))


@pytest.fixture(scope="module")
def dry() -> Result:
    """Return a smooth contact at a speed that leaves no film."""
    return solve(through_film(moes_contact(1e5, 1.0), 1e-3, friction=0.12), on(129))


def test_without_speed_the_contact_is_that_of_hertz(dry: Result):
    # an independent dry solver on the same grid: P_max 1.0000492, H00 -0.9999665, area 1.00995 pi
    assert both_pressures(dry).max() == pytest.approx(1.0, abs=2e-4)
    assert dry.rigid_approach - 1e-3 == pytest.approx(-1.0, abs=2e-4)
    assert dry.touching.area_part == pytest.approx(1.00995, abs=2e-3)
    assert dry.touching.share > 0.999
    assert dry.touching.is_share_known
    r = np.hypot.outer(dry.scaled.y, dry.scaled.x)
    inside = r < 0.9
    assert both_pressures(dry)[inside] == pytest.approx(np.sqrt(1.0 - r[inside] ** 2), abs=1e-3)


def test_without_speed_a_wave_touches_as_a_dry_solver_finds():
    # Polonsky-Keer on the same 129 nodes and heights: P_max 1.92473, area 0.67081, H00 -0.97396
    unit = scales(moes_contact(1e6, 1.0))
    problem = with_roughness(
        (1e6, 1.0),
        type="wave",
        amplitude=0.1 * unit.film_thickness,
        wavelength=0.5 * unit.half_width_x,
        angle=np.radians(90.0),
        phase=np.pi,
    )
    found = solve(through_film(problem, 1e-3), on(129))
    assert both_pressures(found).max() == pytest.approx(1.92473, rel=1e-3)
    assert found.touching.area_part == pytest.approx(0.67081, rel=1e-2)
    assert found.rigid_approach - 1e-3 == pytest.approx(-0.97396, abs=1e-4)


def test_film_and_contact_are_complementary_and_oil_is_conserved(bump: Result):
    film, contact = bump.scaled.film, bump.contact.pressure
    least = bump.problem.contact_film.thickness / bump.scales.film_thickness
    assert film.min() >= least * (1.0 - 1e-12)
    assert (contact >= 0.0).all()
    assert (bump.scaled.pressure >= 0.0).all()
    assert film[contact > 0.0] == pytest.approx(least, rel=1e-12)
    assert float(bump.contact.balance) < 1e-10
    cell = (bump.scaled.x[1] - bump.scaled.x[0]) * (bump.scaled.y[1] - bump.scaled.y[0])
    assert both_pressures(bump).sum() * cell == pytest.approx(2.0 * np.pi / 3.0, rel=1e-6)
    # 6.499 by another model on 385 nodes; on 65 nodes its value is 6.57
    assert both_pressures(bump).max() == pytest.approx(6.58, abs=0.03)


def started(found: Result, options: Options, oil: float) -> TouchingNewton:
    """Return Newton's method for a contact from the Hertz pressure, of which oil has a part."""
    scaled = ScaledProblem.of(found.problem)
    grid, heights = finest_grid(scaled, options), found.heights.together
    level = Hierarchy.on(grid, scaled, options, BESIDE_NEWTON).finest
    level.sources.heights = heights / scaled.scales.film_thickness
    if grid.mirror:
        level.sources.heights = level.sources.heights[grid.ny // 2 :]
    from_dry_pressure(level, 0.03)
    level.apply_heights(1.0)
    pressure = level.film.p.copy()
    level.set_state(oil * pressure, level.rigid_approach, (1.0 - oil) * pressure)
    return TouchingNewton(level, grid.coarser(), order=1)


def test_the_linear_equations_of_a_step_take_few_products(bump: Result):
    newton = started(bump, on(65, AROUND_BUMP), 0.3)
    for _ in range(6):
        newton.step()
        newton.level.update()
        system = TouchingSystem(newton)
        change = system.solve(2e-3)
        assert system.products < 15  # 318 in the last two steps without the third stage
        left = system.rest - system.product(change)
        assert np.linalg.norm(left) < 2.1e-3 * np.linalg.norm(system.rest)


def test_the_solution_does_not_depend_on_the_start(bump: Result):
    found = []
    for part in (1.0, 0.03, 0.3):  # without any oil it wanders, as the last digits have it
        newton = started(bump, on(65, AROUND_BUMP), part)
        level = newton.level
        for _ in range(30):
            newton.step()
            if newton.residual() < 1e-11:
                break
        assert newton.residual() < 1e-9
        found.append((level.film.p.copy(), level.film.asperity.copy()))
    for oil, contact in found[1:]:
        assert oil == pytest.approx(found[0][0], abs=1e-6)
        assert contact == pytest.approx(found[0][1], abs=1e-6)


def test_a_resolved_film_above_the_boundary_film_needs_no_contact():
    problem = through_film(bumpy((200.0, 0.5), 1.0, 0.25), 0.005)
    found = solve(problem, on(129, AROUND_BUMP))
    assert found.touching.patches is None
    assert found.touching.share == 0.0
    assert found.film_scaled.minimum > 0.005
    assert "this film needs no contact" in as_text(found)


def test_a_thin_boundary_film_leaves_a_smooth_film_as_it_is():
    problem = moes_contact(20.0, 5.0)
    film = solve(problem, Options(points=65, accuracy="tight"))
    found = solve(through_film(problem, 1e-3), Options(points=65, accuracy="tight"))
    assert found.scaled.film == pytest.approx(film.scaled.film, abs=2e-5)
    assert found.scaled.pressure == pytest.approx(film.scaled.pressure, abs=2e-4)


def test_shares_of_few_cells_are_not_printed(bump: Result):
    shared = bump.touching
    assert 0.0 < shared.solid_share < shared.share < 1.0
    assert shared.margin == pytest.approx(0.05 * bump.problem.contact_film.thickness)
    assert not shared.is_share_known  # an error of the film of 40 % may change what touches
    assert "too coarse for the oil" in shared.why_unknown
    fine = replace(shared, share_error=0.1)
    assert fine.is_share_known
    coarse = replace(fine, patches=replace(shared.patches, cells=5.0))
    assert not coarse.is_share_known
    assert "5 cells across" in coarse.why_unknown
    assert replace(coarse, is_certified=True).is_share_known


def test_the_bar_of_a_share_covers_that_of_a_finer_grid(bump: Result):
    coarse = bump.touching
    fine = solve(bump.problem, on(129, AROUND_BUMP)).touching
    assert 0.02 < abs(fine.share - coarse.share) < coarse.share_error
    assert fine.share == pytest.approx(0.456, abs=fine.share_error)  # 0.4561 on 257 nodes
    assert fine.share_error < 0.4 * coarse.share_error


def test_the_bar_of_a_film_that_touches_covers_the_change_of_its_share(bump: Result):
    """The film is the boundary film on each grid, and may lift off as less touches."""
    assert bump.film_scaled.central == pytest.approx(0.02, rel=1e-6)
    assert bump.errors.central >= 0.999 * bump.errors.bars["contact_share"] > 1e-4


def test_a_long_patch_is_resolved_if_its_width_is():
    film, round_one = np.full((3, 60, 60), 2.0), np.hypot.outer(*2 * [np.arange(60) - 30.0]) < 6.0
    film[0, 20:24, 10:50] = 1.0
    film[1, 20:30, 10:50] = 1.0
    film[2, round_one] = 1.0
    widths = [largest_patches(1.0, one[None], np.ones((1, 60, 60))) for one in film]
    assert widths == pytest.approx([4.0, 10.0, 2.0 * np.sqrt(round_one.sum() / np.pi)])


def test_a_patch_across_both_ends_of_a_film_that_wraps_is_one():
    round_one = np.hypot.outer(*2 * [np.arange(60) - 30.0]) < 6.0
    film = np.where(round_one, 1.0, 2.0)
    film = np.concatenate([film, film[:1]])
    moved = np.roll(film[:-1], 30, axis=0)
    moved = np.concatenate([moved, moved[:1]])
    loads = np.ones((1, *film.shape))
    here, there = (largest_patches(1.0, one[None], loads, wraps=True) for one in (film, moved))
    assert there == pytest.approx(here, rel=1e-12)
    assert largest_patches(1.0, moved[None], loads) < 0.8 * here


def test_friction_where_surfaces_touch_is_the_stated_coefficient():
    tables = ball_tables(contact_film={"thickness": "5 nm", "friction": 0.12})
    tables["contact"] = tables["contact"] | {
        "entrainment_speed": "1e-5 m/s",
        "slide_roll_ratio": 0.1,
    }
    problem = ContactProblem.model_validate(tables)
    found = solve(problem, Options(points=65))
    shared = found.touching
    assert shared.share > 0.9
    assert abs(found.traction.mid_film) == pytest.approx(shared.friction_film)  # of the film alone
    assert shared.friction_boundary == pytest.approx(0.12 * shared.share)
    assert shared.friction == pytest.approx(0.12, rel=0.05)


@pytest.mark.usefixtures("no_pictures")
def test_a_result_with_contact_is_stored_shown_and_drawn(bump: Result, tmp_path):
    save(bump, tmp_path / "bump.nc")
    again = load(tmp_path / "bump.nc")
    assert again.touching == bump.touching
    block = summary(bump)["touching"]
    assert block["area_part"] == pytest.approx(bump.touching.area_part)
    # the share is not known on this grid, so what follows from it is not stated
    assert not bump.touching.is_share_known
    assert all(block[key] is None for key in ("share", "friction", "power_boundary_w", "patches"))
    assert "contact" in pictures_of(bump)
    assert contact_map(bump).axes
    curves = {one.get_label(): one.get_ydata() for one in centre_lines(bump).axes[0].lines}
    both = both_pressures(bump)[bump.scaled.centre[0]] * bump.scales.hertz_pressure
    assert curves["with solids"] == pytest.approx(1e-9 * both)
    assert curves["pressure of the oil"].max() < curves["with solids"].max()
    assert "Contact through the boundary film" in report_text(bump, dpi=30)
    text = as_text(bump)
    assert "share of the load not known" in text
    assert "friction  " not in text
    assert "mass-balance error of film and contact" in text


def test_a_contact_without_boundary_film_has_no_map_of_contact():
    film = solve(moes_contact(20.0, 5.0), Options(points=33))
    assert film.touching is None
    with pytest.raises(InputError, match="no contact to draw"):
        contact_map(film)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"contact_film": {"thickness": "5 mm"}}, "contact_film.thickness = 0.005 m"),
        ({"contact_film": {"thickness": "-5 nm"}}, "contact_film.thickness"),
    ],
)
def test_mistakes_are_one_sentence(tables: dict, message: str):
    with pytest.raises(InputError, match=message):
        case_from_tables(ball_tables(**tables))


def test_flattening_inverts_the_deflection_of_a_patch():
    scaled = ScaledProblem.of(moes_contact(100.0, 5.0))
    grid = finest_grid(scaled, on(65))
    pressure, film, back = (np.zeros(grid.shape) for _ in range(3))
    x, y = grid.x[None, :], grid.y[:, None]
    pressure += np.maximum(1.0 - x**2 - y**2, 0.0) ** 2
    FftDeformation(grid, scaled.groups).deflect(pressure, film)
    Flattening(grid, scaled.groups).deflect(film, back)
    inside = np.broadcast_to(x**2 + y**2 < 0.5, grid.shape)
    assert back[inside] == pytest.approx(pressure[inside], abs=0.1)


def moving(height: float, film: float, *, slides: float, **transient: object) -> ContactProblem:
    """Return a bump that moves, M = 20, L = 5, in film thicknesses of the smooth contact.

    From upstream of the contact if it starts from the smooth film.
    """
    smooth = moes_contact(20.0, 5.0)
    found, units = expected_central_film(ScaledProblem.of(smooth).groups), scales(smooth)
    tables = bumpy((20.0, 5.0), height * found, 0.3).model_dump(exclude_none=True)
    tables["contact"]["slide_roll_ratio"] = slides
    tables["contact_film"] = {"thickness": film * found * units.film_thickness}
    if "start" not in transient:
        tables["surface_1"]["roughness"]["x"] = -2.4 * units.half_width_x
    moved = transient.pop("moved") * units.half_width_x / units.speed
    tables["transient"] = {"duration": moved, **transient}
    return ContactProblem.model_validate(tables)


def test_a_steady_contact_stays_as_it_is_in_time():
    problem = moving(1.5, 0.8, slides=-2.0, moved=0.5, start="standing", tolerance=1e-6)
    run = solve_transient(problem, Options(points=49))
    assert run.status.converged
    assert run.history.asperity_load[0] > 0.05
    for numbers in (run.history.asperity_load, run.history.film_central, run.history.pressure_max):
        assert np.ptp(numbers) < 1e-5 * numbers[0]


@pytest.fixture(scope="module")
def passing() -> tuple[TransientResult, list[Snapshot]]:
    """Return a bump that touches as it passes a rolling contact, and its snapshots."""
    kept: list[Snapshot] = []
    problem = moving(2.5, 0.4, slides=0.0, moved=3.6, frames=5)
    return solve_transient(
        problem, Options(points=49), keep=lambda one: kept.append(one.copy())
    ), kept


@pytest.mark.usefixtures("no_pictures")
def test_a_bump_that_passes_touches_in_the_contact_and_not_before(passing):
    run, kept = passing
    least, share = run.start.problem.contact_film.thickness, run.history.asperity_load
    assert run.status.converged
    assert share[0] == 0.0
    assert 0.05 < share.max() < 0.5
    assert share[-1] < 0.5 * share.max()
    # in the middle of the contact, where the bump is after 2.4 half-widths
    middle = 2.4 / 3.6 * run.history.time[-1]
    assert run.history.time[share.argmax()] == pytest.approx(middle, rel=0.2)
    assert run.frames.film.min() >= least * (1.0 - 1e-6)
    assert run.history.film_minimum.min() >= least * (1.0 - 1e-9)  # between nodes too
    assert all((one.fields["asperity"] >= 0.0).all() for one in kept)
    assert run.history.pressure_max.max() > 1.5 * run.history.pressure_max[0]
    text = as_text(run)
    assert "surfaces touch in" in text
    assert "8 are needed" in text  # of a bump on 49 nodes no share is stated
    assert "8 are needed" in report_text(run, dpi=30)
    kept_fields = {one.name: getattr(run.frames, one.name) for one in fields(Frames)}
    first = Frames(**{k: None if v is None else v[:1] for k, v in kept_fields.items()})
    assert "touch in no stored field" in as_text(replace(run, frames=first))
    assert summary(run)["asperity_load"]["value"] == pytest.approx(share.max())


def test_a_run_with_contact_continues_bit_by_bit(passing):
    run, kept = passing
    middle = next(one for one in kept if one.record.rows[-1][0] > 0.5 * run.history.time[-1])
    again = solve_transient(run.start.problem, Options(points=49), resume=unpack(pack(middle)))
    assert (again.history.film_minimum == run.history.film_minimum).all()
    assert (again.frames.pressure == run.frames.pressure).all()


def test_each_section_conserves_oil_while_surfaces_touch(monkeypatch):
    errors, touching, advance = [], [], Stepper.step

    def step(self, heights, load):
        end = advance(self, heights, load)
        level, flow = self.solver.finest, np.empty(self.oil.now.shape)
        film, weight = level.film, level.stencil.w0
        reynolds.operator(film, level.stencil, flow)  # pressure flow less weight * rho H
        held = weight * (film.rho * film.h - self.oil.now)
        missing = np.where(film.p > 0.0, flow + held + level.sources.history, 0.0)[:-1, 1:-1]
        missing[0] *= 0.5  # on the symmetry line
        errors.append(np.abs(missing.sum(axis=0) / (weight * self.oil.now.sum(axis=0)[1:-1])).max())
        touching.append(int(level.share.touching.sum()))
        return end

    monkeypatch.setattr(Stepper, "step", step)
    problem = moving(2.5, 0.4, slides=0.5, moved=2.4, frames=0, tolerance=1e-9, max_cycles=40)
    assert solve_transient(problem, Options(points=49)).status.converged
    assert max(touching) > 3
    assert max(errors) < 1e-8


def test_no_step_leaves_contact_pressure_where_surfaces_have_parted():
    least: list[float] = []
    problem = moving(4.0, 1.6, slides=0.5, moved=2.4, frames=0)
    run = solve_transient(
        problem, Options(points=49), keep=lambda one: least.append(one.fields["asperity"].min())
    )
    assert run.status.converged
    assert min(least) > -problem.transient.tolerance


def test_where_nothing_touches_steps_are_those_of_the_cycles():
    problem = moving(0.5, 0.02, slides=0.5, moved=2.6, tolerance=1e-6)
    plain = problem.model_copy(update={"contact_film": None})
    one, other = (solve_transient(each, Options(points=49)) for each in (problem, plain))
    assert not one.history.asperity_load.any()
    assert one.history.film_minimum == pytest.approx(other.history.film_minimum, rel=2e-4)
    assert one.history.pressure_max == pytest.approx(other.history.pressure_max, rel=2e-4)
    assert "needs no contact" in as_text(one)


@pytest.mark.parametrize("kind", ["point", "line"])
def test_oil_that_does_not_fill_the_boundary_film_carries_nothing(kind: str):
    """The contact is the dry one, and what is known of the supply does not limit its film."""
    tables = moes_contact(20.0, 2.0).model_dump(exclude_none=True) | {"supply": {"ratio": 0.3}}
    radius = {"radius": 0.02} if kind == "line" else {"radius_x": 0.02, "radius_y": 0.02}
    motion = {"moes_load": 20.0, "moes_speed": 2.0, "slide_roll_ratio": 0.5}
    starved = ContactProblem.model_validate(tables | {"contact": {"type": kind} | radius | motion})
    film = 0.5 * expected_central_film(ScaledProblem.of(starved).groups)
    result = solve(through_film(starved, film), Options(points=65 if kind == "point" else 257))
    assert result.pressure.max() == 0.0
    assert result.touching.share == pytest.approx(1.0, abs=1e-2)
    assert result.film_scaled.central == pytest.approx(film, rel=1e-9)
    assert result.errors.supply == 0.0
    assert "load" in as_text(result)


def test_a_film_that_contact_hides_on_coarse_grids_has_an_error_bar_that_holds():
    """With a boundary film of 0.8 times that of the oil 65 and 129 nodes have it everywhere."""
    smooth = moes_contact(500.0, 8.0)
    film = expected_central_film(ScaledProblem.of(smooth).groups)
    hidden, fine = (
        solve(through_film(smooth, 0.8 * film), Options(points=points)) for points in (129, 257)
    )
    assert hidden.film_scaled.central == pytest.approx(0.8 * film)
    assert fine.film_scaled.central > 1.05 * hidden.film_scaled.central
    for name in ("central", "minimum"):
        value, true = (getattr(one.film_scaled, name) for one in (hidden, fine))
        assert value == pytest.approx(true, rel=getattr(hidden.errors, name))
    # nothing hides where hardly any oil comes
    dry = solve(through_film(smooth, 2.0 * film), Options(points=65))
    assert dry.errors.central < 0.01
