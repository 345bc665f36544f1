"""The files of series and printed numbers hold what the paper and its reading state."""

import pytest

from tehl.operators.heights import heights_of
from tehl.reproduce.open_runs import nodes_needed
from tehl.reproduce.printed import printed
from tehl.reproduce.series import NAMES, all_series, parameter_set, runs_of, series
from tehl.scaling import ScaledProblem, groups
from tehl.solver.steady import finest_grid

HERTZ = {20: 0.5145, 40: 0.6482, 60: 0.7420, 80: 0.8167, 100: 0.8797}
"""p_h of series A [GPa], with G = 5115: ours is 5117 since 1/5.1e-9 Pa is rounded to 196 MPa."""


def problems(name, treatment="paper", heat="isothermal"):
    return {
        run.value: run.case.problem
        for run in runs_of(series(name))
        if (run.treatment, run.heat) == (treatment, heat)
    }


@pytest.mark.parametrize(
    ("name", "key", "values"),
    [
        ("A", "moes_load", (20, 40, 60, 80, 100)),
        ("B", "moes_speed", (13.05, 13.63, 14.27, 14.83)),
        ("C", "moes_load", (126, 150, 200, 350, 500)),
        ("D", "slide_roll_ratio", (-1, -0.5, 0, 0.5, 1)),
        ("D-prime", "slide_roll_ratio", (-1, -0.5, 0, 0.5, 1)),
    ],
)
def test_series_are_those_of_the_figures(name, key, values):
    one = series(name)
    assert (one.key, one.values) == (key, values)


def test_what_does_not_vary_is_that_of_the_captions():
    assert series("A").contact == {"moes_speed": 12.04, "slide_roll_ratio": 0.25}
    assert series("B").contact == {"moes_load": 20, "slide_roll_ratio": 0.25}
    assert series("C").contact == {"moes_speed": 12.34, "slide_roll_ratio": 0.25}
    assert series("D").contact == {"moes_load": 57.21, "moes_speed": 10.52}


@pytest.mark.parametrize("load", HERTZ)
def test_set_a_closes_the_contacts_of_series_a(load):
    problem = problems("A")[load]
    assert problem.hertz.pressure * 1e-9 == pytest.approx(HERTZ[load], rel=1e-3)
    assert problem.entrainment_speed == pytest.approx(1.357, rel=3e-3)
    assert (groups(problem).M, groups(problem).L) == pytest.approx((load, 12.04))


def test_set_b_has_the_same_groups_and_four_times_the_speed():
    hot, usual = problems("hot", "converged")[0.0], problems("D-prime")[0.0]
    assert groups(hot).M == pytest.approx(groups(usual).M)
    assert groups(hot).alpha_bar == pytest.approx(groups(usual).alpha_bar)
    assert hot.entrainment_speed == pytest.approx(4 * usual.entrainment_speed)
    assert parameter_set("B")["lubricant"] == parameter_set("A")["lubricant"]


def test_the_paper_is_treated_on_64_intervals_with_five_cycles_and_mean_properties():
    for one in all_series().values():
        for kind in one.runs:
            if kind.treatment != "paper":
                continue
            assert kind.numerics["points"] == 65
            assert kind.numerics["domain"] == {"x": [-4.0, 1.5], "y": [-2.0, 2.0]}
            assert (kind.numerics["accuracy"], kind.numerics["max_cycles"]) == ("change", 5)
            assert kind.heat == "isothermal" or kind.thermal["reynolds"] == "mean"


def test_crests_narrow_the_film_as_minus_a_cosine_in_the_film_equation_does():
    run = next(one for one in runs_of(series("C")) if one.treatment == "paper")
    problem = run.case.problem
    scaled = ScaledProblem.of(problem)
    grid = finest_grid(scaled, run.case.options)
    heights = heights_of(scaled, grid)
    row, column = grid.ny // 2, int(abs(grid.x).argmin())
    outward = heights.surface_2[row, column] * scaled.scales.film_thickness
    assert outward == pytest.approx(0.495e-6, rel=0.03)  # X = 0 is no node


def test_points_change_the_fine_grids_only():
    runs = runs_of(series("A"), 129)
    assert {r.case.options.points for r in runs if r.treatment == "paper"} == {65}
    assert {r.case.options.points for r in runs if r.treatment != "paper"} == {129}
    assert any(r.case.certify for r in runs)
    assert not any(r.case.certify for r in runs_of(series("A"), 65))


def test_names_of_runs_are_unique():
    names = [run.case.name for one in all_series().values() for run in runs_of(one)]
    assert len(names) == len(set(names))
    assert tuple(all_series()) == NAMES


def test_table_2_is_printed_so():
    table = printed()
    assert table.column("T2", "isothermal_minimum", corrected=False) == [0.6199, 0.1190, 0.0730]
    assert table.column("T2", "isothermal_minimum") == [0.1699, 0.1190, 0.0730]
    assert table.column("T2", "thermal_central") == [0.2585, 0.1944, 0.1335]
    assert table.films("A", "thermal")[60] == (0.1178, 0.1944)
    assert table.films("B", "thermal") == {}


def test_the_misprint_exceeds_the_central_film_of_its_row_and_its_correction_does_not():
    table = printed()
    central = table.column("T2", "isothermal_central")[0]
    assert table.column("T2", "isothermal_minimum", corrected=False)[0] > central
    assert table.column("T2", "isothermal_minimum")[0] < central


def test_table_3_is_printed_so():
    table = printed()
    assert table.column("T3", "thermal_minimum") == [0.0818, 0.1498, 0.1684, 0.1530, 0.1117]
    assert table.films("D", "isothermal")[-1.0] == (0.1683, 0.2433)
    assert [printed().conclusion(k)[:12] for k in (1, 5)] == ["The pressure", "Minimum film"]


def test_an_oil_that_thins_is_that_of_set_a_but_for_its_stress():
    thins, usual = parameter_set("E"), parameter_set("A")
    assert thins["lubricant"] == usual["lubricant"] | {
        "shear": {"law": "eyring", "stress": "5 MPa"}
    }
    assert thins["contact"] == usual["contact"]
    assert series("C-eyring").surfaces == series("C").surfaces
    assert series("C-eyring").values == series("C").values


def test_heat_is_compared_on_the_domain_of_the_paper():
    kinds = {kind.heat: kind for kind in series("A").runs if kind.treatment == "domain"}
    assert set(kinds) == {"isothermal", "thermal"}
    assert kinds["thermal"].thermal == {"reynolds": "generalised"}
    paper = next(kind for kind in series("A").runs if kind.treatment == "paper")
    assert all(kind.numerics["domain"] == paper.numerics["domain"] for kind in kinds.values())


@pytest.mark.parametrize(("nodes", "error", "needed"), [(129, 0.05, 129), (129, 0.71, 513)])
def test_the_grid_that_a_film_needs_follows_from_second_order(nodes, error, needed):
    assert nodes_needed(nodes, error) == needed
