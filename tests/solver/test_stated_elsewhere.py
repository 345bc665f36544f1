"""A contact that is stated at one moment, and runs at another, has the film of that one."""

from typing import Any

import pytest

from tehl import solve, solve_transient
from tehl.api.problem import ContactProblem
from tehl.contact.moment import frozen, moment_at
from tehl.contact.options import Options
from tehl.estimate.scaling import ScaledProblem
from tests.reference import moes_contact

OIL = {"conductivity": 0.14, "heat_capacity": 2000.0, "shear": {"law": "eyring", "stress": 5e6}}
CIRCLE = {"radius_x": 0.02, "radius_y": 0.03, "load": 60.0, "entrainment_speed": 1.0}
LINE = {"type": "line", "radius": 0.01, "moes_load": 30.0, "moes_speed": 8.0}
ROLLER = {"type": "roller", "length": 0.01, "profile": {"shape": "crown", "radius": 2.0}}
CHANGES = {"radius": 1.6, "load": 0.7, "entrainment_speed": 1.5}


def case(contact: dict[str, Any], *, thins: bool, heats: bool, **changes: float) -> ContactProblem:
    """Return a run in which nothing changes, but is not as stated."""
    given = moes_contact(20.0, 8.0).model_dump(exclude_none=True)
    given["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": 313.15}
    given["lubricant"] |= OIL if thins else {}
    courses = {key: [[0.0, value], [1.0, value]] for key, value in changes.items()}
    run = {"duration": 2e-5, "frames": 0} | courses
    tables = given | {"contact": contact | {"slide_roll_ratio": 0.2}, "transient": run}
    return ContactProblem.model_validate(tables | ({"thermal": {}} if heats else {}))


@pytest.mark.parametrize(
    ("contact", "points", "thins", "heats", "changes"),
    [
        (CIRCLE, 65, False, False, CHANGES),
        (CIRCLE | {"sliding_angle": 1.2}, 65, True, True, CHANGES),
        (LINE, 257, True, False, CHANGES | {"radius": 3.0, "entrainment_speed": 2.0}),
        (LINE, 257, True, True, CHANGES),
        (LINE | ROLLER, 129, False, False, CHANGES),
    ],
    ids=["circle", "heated circle", "thinning line", "heated line", "roller"],
)
def test_a_run_has_the_film_of_its_own_moment(contact, points, thins, heats, changes):
    """Starts of thinning and heated films were 30 to 60 % too thick, and their runs for a while.

    Films and moments are those of the same grid, within what transient line sources change.
    """
    problem = case(contact, thins=thins, heats=heats, **changes)
    own, units = frozen(problem, moment_at(problem, 0.0)), ScaledProblem.of(problem).scales
    run = solve_transient(problem, Options(points=points, wedge_order=3, extrapolate=False))
    scales, here = ScaledProblem.of(own).scales, run.start.scaled
    along, across = (
        getattr(units, key) / getattr(scales, key) for key in ("half_width_x", "half_width_y")
    )
    edges = {"x": [along * here.x[0], along * here.x[-1]]}
    if here.y.size > 1:
        edges["y"] = [across * here.y[0], across * here.y[-1]]
    options = Options(
        points=points,
        domain=edges,
        edges="far_field",
        wedge_order=3,
        extrapolate=False,
        accuracy="tight",
    )
    steady, history, error = solve(own, options), run.history, 2e-3 if heats else 5e-4
    for films, film in (
        (history.film_central, steady.film.central),
        (history.film_minimum, steady.film.minimum),
    ):
        assert films[[0, -1]] == pytest.approx(film, rel=error)
    if steady.rolling is not None:
        moment = steady.rolling.moment
        assert history.rolling_moment[[0, -1]] == pytest.approx(moment, rel=error)


@pytest.mark.parametrize(
    "contact",
    [CIRCLE | {"sliding_angle": 1.2}, CIRCLE | {"spin_1": 800.0, "spin_2": -300.0}],
    ids=["across", "spin"],
)
def test_power_and_lambda_over_time_begin_with_those_of_the_steady_film(contact):
    problem = case(contact, thins=True, heats=False, load=1.0)
    rough = problem.surface_1.model_copy(update={"rms_roughness": 1e-7})
    run = solve_transient(problem.model_copy(update={"surface_1": rough}), Options(points=65))
    power, found = run.start.traction.sliding_power, run.start.roughness
    assert power > 0.3
    assert run.sliding_power[0] == pytest.approx(power, rel=1e-6)
    assert run.sliding_power[-1] == pytest.approx(power, rel=1e-4)
    assert run.lambda_central[0] == pytest.approx(found.lambda_central, rel=1e-6)
