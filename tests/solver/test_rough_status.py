"""What counts as a film between rough surfaces, and how an open minimum is reported."""

from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from tehl.api.results import Result
from tehl.cli.text import as_text
from tehl.contact.options import Options
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import ScaledProblem
from tehl.io.summary import summary
from tehl.operators.flow import flow_table
from tehl.report.page import report_text
from tehl.result.bars import ErrorEstimate
from tehl.result.solution import Hint, Status
from tehl.solver.cycle.equations import Equations
from tehl.solver.judging.certify import _ending
from tehl.solver.judging.verdict import _no_film_status, is_film, no_film
from tests.reference import DOMAIN, heated_contact

FLOOR = 0.01
VAGUE = Status(kind="converged", message="The minimum film is uncertain.", hint=Hint("Take more."))


def level(smallest: float, *, valley: bool = False) -> SimpleNamespace:
    """Return a level with one thin spot; ``valley``: midway between two nodes of equal film."""
    grid = Grid(nx=33, ny=33, domain=DOMAIN, mirror=False)
    centre = 0.5 * grid.dx if valley else 0.0
    there = (grid.x[None, :] + 1.5 - centre) ** 2 + grid.y[:, None] ** 2
    h = smallest + 3.0 * (there - centre**2)
    film, equations = SimpleNamespace(h=h), SimpleNamespace(floor=FLOOR)
    return SimpleNamespace(grid=grid, film=film, equations=equations)


def errors(grid: float) -> ErrorEstimate:
    """Return errors of the minimum film."""
    return ErrorEstimate(
        discretisation_central=0.01,
        discretisation_minimum=grid,
        iteration_central=0.0,
        iteration_minimum=0.0,
    )


@pytest.mark.parametrize(
    ("smallest", "estimate", "held"),
    [
        (0.02, None, True),
        (0.02, errors(5.0), True),
        (-0.02, errors(5.0), False),
        (float("nan"), errors(5.0), False),
        (0.008, None, False),
        (0.008, errors(0.1), False),  # the floor is beyond its error
        (0.008, errors(0.5), True),
        (0.004, errors(1e4), False),  # too far below the floor of the conductance
    ],
)
def test_a_film_is_positive_and_within_its_error_above_the_floor(smallest, estimate, held):
    assert is_film(level(smallest), estimate) is held


def test_a_film_that_is_negative_between_two_nodes_is_not_a_film():
    between = level(0.011, valley=True)
    assert between.film.h.min() > FLOOR
    assert not is_film(between, errors(0.1))
    assert "not positive: smallest H = -0." in no_film(between)


def test_a_film_that_inlet_heating_thins_has_a_lower_floor():
    """By the formula of Wilson and Sheu it is 0.768 and 0.977 of the isothermal one."""
    options = Options(points=33)
    floors = []
    for slip in (0.0, 1.5):
        scaled = ScaledProblem.of(heated_contact(slip))
        grid = Grid(nx=33, ny=33, domain=DOMAIN, mirror=False)
        floors.append(Equations.on(grid, scaled, flow_table(scaled), options).floor)
    assert floors[1] == pytest.approx(0.768 / 0.977 * floors[0], rel=1e-3)


def test_a_film_below_the_floor_is_reported_as_such():
    assert "thinner than H = 0.01, the floor of the conductance" in no_film(level(0.004))


@pytest.mark.parametrize(("slip", "named"), [(1.2, True), (0.0, False)])
def test_an_oil_under_incredible_stress_is_named_where_hot_asperities_would_touch(
    slip: float, named: bool
) -> None:
    """Its heat makes the film thinner than the heights: another law of the oil, not others."""
    run = SimpleNamespace(finest=level(0.001), hierarchy=Mock())
    run.hierarchy.scaled = ScaledProblem.of(heated_contact(slip))
    status = _no_film_status(run, None)
    assert ("lubricant.shear" in status.hint.settings) is named
    assert ("lubricant.shear.law" in status.message) is named


@pytest.mark.usefixtures("no_pictures")
def test_an_open_minimum_is_reported_everywhere(result: Result, monkeypatch):
    monkeypatch.setattr("tehl.report.page.CAPTIONS", {})
    vague = replace(result, status=VAGUE)
    assert vague.status.is_vague
    assert vague.status.outcome == "converged, minimum film open"
    assert "uncertain        The minimum film is uncertain." in as_text(vague)
    assert "<p>The minimum film is uncertain.</p><p>Take more.</p>" in report_text(vague)
    found = summary(vague)
    assert (found["status"], found["message"], found["hint"]) == (
        "converged",
        VAGUE.message,
        str(VAGUE.hint),
    )
    assert "too coarse for the film" in _ending(vague)
    assert "too coarse for the film" not in _ending(result)


def test_a_certified_result_is_not_vague():
    certified = Status(kind="converged", message="Grids of the error bars: ...")
    assert not certified.is_vague
    assert not Status(kind="stalled", hint=Hint("More.")).is_vague
