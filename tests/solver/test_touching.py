"""Contact through a boundary film: dry limits, oil balance, complementarity, uniqueness."""

from dataclasses import replace

import numpy as np
import pytest

from tehl.cli.text import as_text
from tehl.errors import InputError
from tehl.io.case import case_from_tables
from tehl.io.store import load, save
from tehl.io.summary import summary
from tehl.operators.deformation import FftDeformation, FftFlattening
from tehl.options import Domain, Options
from tehl.plots import contact_map, pictures_of
from tehl.problem import ContactProblem
from tehl.report.page import report_text
from tehl.result import Result
from tehl.scaling import ScaledProblem, scales
from tehl.solver import solve
from tehl.solver.hierarchy import Hierarchy
from tehl.solver.relaxation import BESIDE_NEWTON
from tehl.solver.steady import finest_grid
from tehl.solver.touching import TouchingNewton
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
    return solve(through_film(bumpy((200.0, 0.5), 1.0, 0.25), 0.02), on(65, AROUND_BUMP))


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
    assert dry.touching.is_resolved
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


def test_the_solution_does_not_depend_on_the_start(bump: Result):
    problem = bump.problem
    scaled = ScaledProblem.of(problem)
    options = on(65, AROUND_BUMP)
    heights = bump.heights.together / scaled.scales.film_thickness
    found = []
    for oil, contact in ((1.0, 0.0), (0.0, 1.0), (0.3, 0.7)):
        grid = finest_grid(scaled, options)
        level = Hierarchy.on(grid, scaled, options, BESIDE_NEWTON).finest
        level.heights = heights[grid.ny // 2 :] if grid.mirror else heights
        level.start_from_hertz(0.03)
        level.apply_heights(1.0)
        pressure = level.film.p.copy()
        level.set_state(oil * pressure, level.rigid_approach, contact * pressure)
        newton = TouchingNewton(level, grid.coarser(), order=1)
        for _ in range(60):
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
    found = solve(through_film(problem, 1e-3), Options(points=65))
    assert found.scaled.film == pytest.approx(film.scaled.film, abs=2e-5)
    assert found.scaled.pressure == pytest.approx(film.scaled.pressure, abs=2e-4)


def test_shares_of_few_cells_are_not_printed(bump: Result):
    shared = bump.touching
    assert 0.0 < shared.solid_share < shared.share < 1.0
    assert shared.margin == pytest.approx(0.05 * bump.problem.contact_film.thickness)
    assert shared.is_share_known
    coarse = replace(shared, patches=replace(shared.patches, cells=5.0))
    assert not coarse.is_share_known
    assert replace(coarse, is_certified=True).is_share_known


def test_friction_where_surfaces_touch_is_the_stated_coefficient():
    tables = ball_tables(contact_film={"thickness": "5 nm", "friction": 0.12})
    tables["contact"] = tables["contact"] | {
        "entrainment_speed": "1e-5 m/s",
        "slide_roll_ratio": 0.1,
    }
    problem = ContactProblem.model_validate(tables)
    shared = solve(problem, Options(points=65)).touching
    assert shared.share > 0.9
    assert shared.friction_boundary == pytest.approx(0.12 * shared.share)
    assert shared.friction == pytest.approx(0.12, rel=0.05)


def test_a_result_with_contact_is_stored_shown_and_drawn(bump: Result, tmp_path):
    save(bump, tmp_path / "bump.nc")
    again = load(tmp_path / "bump.nc")
    assert again.touching == bump.touching
    block = summary(bump)["touching"]
    assert block["area_part"] == pytest.approx(bump.touching.area_part)
    assert block["patches"]["number"] >= 1
    assert "contact" in pictures_of(bump)
    assert contact_map(bump).axes
    assert "Contact through the boundary film" in report_text(bump, dpi=30)
    text = as_text(bump)
    assert "patches" in text
    assert "made or lost in film and contact" in text


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
        ({"contact_film": {"thickness": "5 nm"}, "supply": {"ratio": 1.0}}, "supply"),
        ({"contact_film": {"thickness": "5 nm"}, "transient": {"duration": "1 s"}}, "transient"),
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
    FftFlattening(grid, scaled.groups).deflect(film, back)
    inside = np.broadcast_to(x**2 + y**2 < 0.5, grid.shape)
    assert back[inside] == pytest.approx(pressure[inside], abs=0.1)
