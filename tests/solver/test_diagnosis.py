"""Likely causes of an iteration that diverged or stalled."""

from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.contact.options import Domain, Options
from tehl.estimate.grid import Grid
from tehl.estimate.nodes import finest_grid
from tehl.estimate.scaling import ScaledProblem
from tehl.io.case import tables_of_text
from tehl.io.templates import template_text
from tehl.result.solution import CycleReport
from tehl.solver.cycle.film_solver import FilmSolver
from tehl.solver.cycle.hierarchy import Hierarchy
from tehl.solver.cycle.ladder import COUPLED
from tehl.solver.judging.diagnosis import (
    LikelyCause,
    diverged,
    grid_hint,
    likely_cause,
    not_reached,
)
from tests.cases import ball_tables
from tests.reference import heated_contact, moes_contact
from tests.solver.test_roller import LOGARITHMIC, roller

DOMAIN = Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))


def changed(part: str, **values: object) -> ContactProblem:
    """Return the heated reference contact with some keys of a table replaced."""
    case = heated_contact(0.5).model_dump(exclude_none=True)
    case[part].update(values)
    return ContactProblem.model_validate(case)


def cause_of(problem: ContactProblem, points: int = 257) -> LikelyCause | None:
    grid = Grid(nx=points, ny=points, domain=DOMAIN, mirror=False)
    return likely_cause(grid, ScaledProblem.of(problem))


@pytest.mark.parametrize(("kelvin", "way"), [(60.0, "above"), (-60.0, "below")])
def test_a_body_far_from_the_temperature_of_the_oil_is_a_likely_cause(kelvin, way):
    found = cause_of(changed("surface_2", temperature=313.0 + kelvin))
    assert found is not None
    assert found.cause == "body_temperature"
    assert f"60 K {way}" in found.message
    assert "surface_2" in str(found.hint)


def test_a_body_near_the_temperature_of_the_oil_is_not_a_likely_cause():
    assert cause_of(changed("surface_1", temperature=333.0)) is None


def test_a_stress_beyond_that_of_oils_is_attributed_to_the_shear_law():
    sliding = changed("contact", hertz_pressure=2e9, slide_roll_ratio=1.9)
    found = cause_of(sliding, 1025)
    assert found is not None
    assert found.cause == "shear_stress"
    assert "lubricant.shear" in str(found.hint)
    tables = sliding.model_dump(exclude_none=True)
    tables["lubricant"]["shear"] = {"law": "eyring", "stress": 5e6}
    tables["contact"] |= {"hertz_pressure": 0.5e9, "slide_roll_ratio": 1e4}
    thinning = cause_of(ContactProblem.model_validate(tables), 1025)
    assert thinning is not None
    assert str(thinning.hint).startswith("Take a slide_roll_ratio nearer to zero")


@pytest.mark.parametrize(("pressure", "is_glass"), [(1e9, False), (5e9, True)])
def test_a_glass_by_the_law_of_barus_is_a_likely_cause(pressure, is_glass):
    tables = ball_tables(contact={"radius": 0.01, "hertz_pressure": pressure, "moes_speed": 10.0})
    tables["lubricant"]["viscosity"] = {"law": "barus", "eta_0": 0.1, "alpha": "15 1/GPa"}
    found = cause_of(ContactProblem.model_validate(tables), 1025)
    assert (found is not None and found.cause == "viscosity_law") is is_glass
    if found is not None and is_glass:  # 0.1 Pa s times e^75
        assert "10^32 Pa s" in found.message
        assert found.hint.settings == {"lubricant.viscosity.law": "roelands"}


def test_a_film_too_thin_for_the_grid_is_attributed_to_the_grid():
    found = cause_of(moes_contact(1000.0, 5.0), 65)
    assert found is not None
    assert found.cause == "film_below_grid"
    assert "numerics.points = " in str(found.hint)


@pytest.mark.parametrize(
    ("template", "changes"),
    [
        ("boundary-film", {"entrainment_speed": "1e-6 m/s"}),
        ("mixed", {"entrainment_speed": "1e-6 m/s", "load": "50 N"}),
    ],
)
def test_no_number_of_nodes_follows_from_the_film_where_solids_carry_the_load(template, changes):
    tables = tables_of_text(template_text(template))
    tables["contact"] = tables["contact"] | changes
    if template == "mixed":
        summits = {"summit_radius": "10 um", "summit_density": "2e10 1/m^2"}
        tables["asperities"] |= {"rms": "0.1 um"} | summits
        for name in ("surface_1", "surface_2"):
            tables[name].pop("rms_roughness", None)
    problem, _ = case_from_tables(tables)
    scaled = ScaledProblem.of(problem)
    assert grid_hint((65, 65), scaled).settings == {"numerics.points": 129}
    found = cause_of(problem, 65)
    assert found is None or found.cause != "film_below_grid"


@pytest.mark.parametrize(
    "edge",
    [{"profile": {"shape": "crown", "radius": "1 mm"}}, {"tilt": "1 deg"}],
    ids=["crown", "tilt"],
)
def test_a_load_on_the_edge_of_a_roller_is_attributed_to_its_profile_and_tilt(edge):
    scaled = ScaledProblem.of(roller(12.0, moes_speed=15.0, **({"profile": LOGARITHMIC} | edge)))
    grid = finest_grid(scaled, Options(points=(257, 129)))
    found = likely_cause(grid, scaled)
    assert found.cause == "load_on_an_edge"
    assert "GPa" in found.message
    assert "ellipse" in found.hint.advice
    even = ScaledProblem.of(roller(12.0, moes_speed=15.0, profile=LOGARITHMIC))
    assert likely_cause(grid, even) is None


def test_all_likely_causes_are_reported_and_the_first_names_the_cause():
    found = cause_of(changed("surface_1", temperature=240.0), 33)
    assert found is not None
    assert found.cause == "body_temperature"
    assert "nodes per direction" in found.message
    assert "surface_1" in str(found.hint)


def test_the_status_of_a_diverged_run_has_the_likely_cause_and_its_hint():
    problem, options = changed("surface_1", temperature=240.0), Options(points=65)
    scaled = ScaledProblem.of(problem)
    first = COUPLED[0]
    run = FilmSolver(
        Hierarchy.on(finest_grid(scaled, options), scaled, options, first.first_relaxation),
        first,
    )
    status = diverged(run)
    assert (status.kind, status.cause) == ("diverged", "body_temperature")
    assert "65 x 65" in status.message
    assert "below the oil at the inlet" in status.message
    assert "within 40 K" in str(status.hint)


@pytest.mark.parametrize(
    ("kelvin", "heats", "words"),
    [
        (0.0, True, "the residual is 2.0e-03"),
        (5.0, True, "the temperature still changes by 5 K per cycle"),
        (5.0, False, "the residual is 2.0e-03"),  # a film that thins while its sliding is raised
    ],
)
def test_what_has_not_converged_is_named(kelvin, heats, words):
    report = CycleReport(
        **{"points": (65, 65), "cycle": 9, "residual": 2e-3, "change": 1e-3, "load_error": 1e-8},
        **{"film_central": 1.0, "film_minimum": 0.5, "smoother": "fast"},
        **{"temperature_change": kelvin, "temperature_rise": 10.0},
    )
    run = SimpleNamespace(
        options=Options(accuracy="tight", max_cycles=1),
        traces=[SimpleNamespace(reports=[report])],
        strategy=SimpleNamespace(patience=1),
        hierarchy=Mock(),
    )
    run.hierarchy.scaled.problem.thermal = Mock() if heats else None
    assert not_reached(run).message.startswith(f"After 1 cycle on 65 x 65 nodes {words}")
