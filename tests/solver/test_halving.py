"""Runs of contacts that grow, on half the nodes from some step on."""

import numpy as np
import pytest

from tehl import InputError, certify_transient, solve_transient
from tehl.api.problem import ContactProblem
from tehl.contact.options import Options
from tehl.estimate.halving import LEAST_AFTER, PART_OF_ERROR, halvings, parts_of_run
from tehl.estimate.scaling import ScaledProblem, scales
from tehl.report.explain import as_text, explain
from tehl.solver.monitor import SILENT
from tehl.solver.transient.coarser import at_nodes
from tehl.solver.transient.run import Run
from tehl.solver.transient.snapshot import COLUMNS, Snapshot, pack, unpack
from tests.solver.test_line import line

UNITS = scales(line(20, 5))
UNIT = UNITS.half_width_x / UNITS.speed
GROWS = {"radius": [[0.0, 0.15], [4.0 * UNIT, 1.0]]}
FASTER = {"entrainment_speed": [[0.0, 0.8], [4.0 * UNIT, 1.0]]}


def growing(tables: dict | None = None, **transient: object) -> ContactProblem:
    """Return a line (M = 20, L = 5) whose radius grows from 0.15 of its own."""
    changes = {"duration": 4.0 * UNIT, "frames": 3} | GROWS | FASTER | transient
    case = line(20, 5, transient={key: one for key, one in changes.items() if one is not None})
    if tables is None:
        return case
    found = case.model_dump(exclude_none=True) | tables
    found["contact"] |= {"slide_roll_ratio": 0.4}
    found["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    found["lubricant"]["viscosity"] |= {"gamma": 0.04, "reference_temperature": 313.15}
    return ContactProblem.model_validate(found)


HEATED = {
    "thermal": {},
    "surface_1": {"material": "steel"},
    "surface_2": {"material": "steel"},
}


@pytest.fixture(scope="module")
def run() -> Run:
    case = growing()
    found = Run(case, Options(), case.transient, SILENT)
    found.advance(SILENT, None)
    return found


def test_a_contact_that_grows_goes_on_with_fewer_nodes(run):
    """Its film errs by less than what was asked, as judged by the nodes of its start."""
    nodes, first = run.start.x.size, run.halvings[0]
    assert run.level.grid.nx == (nodes - 1) // 2 ** len(run.halvings) + 1 < nodes
    case = growing()
    whole = solve_transient(case, Options(), one_grid=True).history
    found = run.record.history(run.scaled.scales)
    np.testing.assert_allclose(found.time, whole.time, rtol=1e-12)
    np.testing.assert_array_equal(found.film_central[:first], whole.film_central[:first])
    np.testing.assert_allclose(found.film_central, whole.film_central, rtol=1e-3)
    for name in ("film_minimum", "rolling_moment"):
        np.testing.assert_allclose(getattr(found, name), getattr(whole, name), rtol=0.01)
    spike = np.abs(found.pressure_max / whole.pressure_max - 1.0)  # too narrow for either grid
    assert np.median(spike) < 1e-3
    assert spike.max() < 0.1
    assert found.film_central[first] != whole.film_central[first]
    # cheaper steps, not fewer
    assert found.time.size == run.steps + 1


def test_profiles_and_fields_keep_the_nodes_of_the_start(run):
    solution, grid = run.result(run.start.status), run.level.grid
    assert solution.profiles.film.shape == (run.steps + 1, solution.x.size)
    assert solution.frames.pressure.shape == (3, 1, solution.x.size)
    every = (solution.x.size - 1) // (grid.nx - 1)
    unit = run.scaled.scales.film_thickness
    last = solution.profiles.film[-1]
    np.testing.assert_allclose(last[::every] / unit, run.level.film.h[0], rtol=1e-12)
    assert last[every // 2] == pytest.approx(0.5 * (last[0] + last[every]))  # linear between them


def test_the_plan_says_when(run):
    """The formula alone knows the start less well than its solution does."""
    found = explain(growing()).time
    assert len(found.halved_s) == len(run.halvings)
    assert found.halved_s == pytest.approx(np.array(run.halvings) * run.seconds, rel=0.3)
    nodes = run.start.x.size
    assert f"{(nodes - 1) // 2 + 1} nodes, as the contact has grown" in as_text(explain(growing()))
    stated = explain(growing(), Options(points=nodes)).time
    assert stated.halved_s == ()
    assert stated.seconds > found.seconds


def test_parts_of_a_run_have_all_of_its_steps():
    parts = tuple(parts_of_run(1025, 4, 200, (21, 21, 90)))
    assert parts == ((1025, 4, 20), (513, 2, 0), (257, 1, 69), (129, 0, 111))
    assert tuple(parts_of_run(1025, 3, 200, ())) == ((1025, 3, 200),)


def test_a_film_whose_error_is_small_has_half_the_nodes_sooner():
    scaled, steps = ScaledProblem.of(growing()), 200

    def first(bar: float | None) -> int:
        return next(iter(halvings(scaled, Options(), (1025, bar), 4, steps)), steps)

    error = Options().target
    assert 1 == first(0.1 * PART_OF_ERROR * error) < first(0.5 * error) < first(error) < steps
    assert first(1e3 * error) == steps
    when = first(2.0 * error)
    assert not halvings(scaled, Options(), (1025, 2.0 * error), 4, LEAST_AFTER)  # none for a few
    assert first(error) < when < steps


@pytest.mark.parametrize(
    "transient",
    [
        {"radius": [[0.0, 1.0], [4.0 * UNIT, 0.15]]},
        {"radius": [[0.0, 0.15], [2.0 * UNIT, 1.0], [4.0 * UNIT, 0.15]]},
    ],
)
def test_a_contact_that_shrinks_keeps_its_nodes(transient):
    scaled = ScaledProblem.of(growing(**transient))
    assert halvings(scaled, Options(), (2049, Options().target), 4, 200) == ()


def test_stated_nodes_an_odd_stride_and_certified_runs_keep_their_grid(monkeypatch):
    case = growing()
    assert halvings(ScaledProblem.of(case), Options(), (1025, 1e-4), 3, 200) == ()
    stated = Run(case, Options(points=1025), case.transient, SILENT)
    assert stated.halvings == ()
    seen = []

    def solved(*_: object, **keywords: object) -> None:
        seen.append(keywords["one_grid"])
        raise InputError("enough")

    monkeypatch.setattr("tehl.solver.transient.certify.solve_transient", solved)
    with pytest.raises(InputError, match="enough"):
        certify_transient(case)
    assert seen == [True]


CASES = {
    "speeds that vary": ({}, None),
    "a load that varies": ({"entrainment_speed": None, "load": [[0.0, 1.0], [UNIT, 1.2]]}, None),
    "heat": ({}, HEATED),
    "heat, the same speeds": ({"entrainment_speed": None}, HEATED),
}


@pytest.mark.parametrize("name", CASES)
def test_a_run_goes_on_from_its_state_on_half_the_nodes(name):
    """Bit by bit from a checkpoint too, before the halving and after it."""
    transient, tables = CASES[name]
    case = growing(tables, radius=[[0.0, 0.9], [4.0 * UNIT, 1.0]], stride=2, **transient)
    runs = [Run(case, Options(points=513), case.transient, SILENT) for _ in range(4)]
    kept: list[Snapshot] = []
    for one in runs:
        one.steps = 9
    for one in (runs[1], *runs[2:]):
        one.halvings = (5,)
    runs[0].advance(SILENT, None)
    runs[1].advance(SILENT, lambda snapshot: kept.append(unpack(pack(snapshot.copy()))))
    rows = [np.array(one.record.rows) for one in runs[:2]]
    np.testing.assert_array_equal(rows[1][:5, :-2], rows[0][:5, :-2])
    for key in ("film_central", "film_minimum", "pressure_max"):
        column = COLUMNS.index(key)
        np.testing.assert_allclose(rows[1][:, column], rows[0][:, column], rtol=0.01)
    for one, at in ((runs[2], 3), (runs[3], 6)):
        one.restore(kept[at])
        one.advance(SILENT, None)
        np.testing.assert_array_equal(np.array(one.record.rows), rows[1])


def test_values_at_nodes_that_both_grids_have():
    fine = np.arange(2.0 * 9).reshape(2, 9)
    np.testing.assert_array_equal(at_nodes(fine, (2, 5), 9), fine[:, ::2])
    # beyond the edges: as many nodes on either side, the last one again where there is none
    wide = np.arange(-2.0, 11.0)
    np.testing.assert_array_equal(at_nodes(wide, (7,), 9), np.arange(-2.0, 11.0, 2.0))
    np.testing.assert_array_equal(
        at_nodes(wide, (9,), 9), [-2.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 10.0]
    )
    np.testing.assert_array_equal(at_nodes(fine, (2, 9), 9), fine)
