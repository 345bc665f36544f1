"""The study files and the printed numbers hold what the paper and its reading state."""

from dataclasses import replace

import pytest
from paper.runs import SERIES, read_series
from paper.tables import TABLES, printed, printed_films

from tehl import Options, solve

HERTZ = {20: 0.5145, 40: 0.6482, 60: 0.7420, 80: 0.8167, 100: 0.8797}
"""p_h of series A [GPa], with G = 5115: ours is 5117 since 1/5.1e-9 Pa is rounded to 196 MPa."""


def cases(name, treatment="paper", heat="isothermal"):
    """Return the cases of a series by what varies."""
    return {
        value: case
        for case in read_series(name).cases
        for _, *way, value in [case.labels.values()]
        if way == [treatment, heat]
    }


@pytest.mark.parametrize(
    ("name", "symbol", "values"),
    [
        ("A", "M", (20, 40, 60, 80, 100)),
        ("B", "L", (13.05, 13.63, 14.27, 14.83)),
        ("C", "M", (126, 150, 200, 350, 500)),
        ("D", "SRR", (-1, -0.5, 0, 0.5, 1)),
        ("D-prime", "SRR", (-1, -0.5, 0, 0.5, 1)),
    ],
)
def test_series_are_those_of_the_figures(name, symbol, values):
    series = read_series(name)
    assert (series.symbol, series.values) == (symbol, values)


def test_what_does_not_vary_is_that_of_the_captions():
    assert read_series("A").fixed == "L = 12.04, SRR = 0.25, smooth"
    assert read_series("B").fixed == "M = 20, SRR = 0.25, smooth"
    assert read_series("C").fixed == "L = 12.34, SRR = 0.25, wavy surface"
    assert read_series("D").fixed == "M = 57.21, L = 10.52, wavy surface"


@pytest.mark.parametrize("load", HERTZ)
def test_set_a_closes_the_contacts_of_series_a(load):
    problem = cases("A")[load].problem
    assert problem.hertz.pressure * 1e-9 == pytest.approx(HERTZ[load], rel=1e-3)
    assert problem.entrainment_speed == pytest.approx(1.357, rel=3e-3)
    assert problem.contact.moes_load == load
    assert problem.contact.moes_speed == 12.04


def test_table_1_states_sets_a_and_b():
    stated = {name: values for name, _, *values in TABLES["T1"]["rows"]}
    set_a, set_b = (cases(name, "converged")[0.0].problem for name in ("D-prime", "hot"))
    assert stated["entrainment speed"][:2] == [
        f"{one.entrainment_speed:.3g} m/s" for one in (set_a, set_b)
    ]
    assert stated["reduced radius"][:2] == [
        f"{1e3 * one.contact.radius:g} mm" for one in (set_a, set_b)
    ]
    modulus, alpha = set_a.reduced_modulus, set_a.pressure_coefficient
    assert stated["reduced modulus E'"][0] == f"{modulus * 1e-9:.4g} GPa"
    assert stated["reduced modulus E'"][2].endswith(f"G = {alpha * modulus:.0f}")
    assert stated["pressure index z of Roelands' law"][2] == f"alpha = {alpha * 1e9:.5g} 1/GPa"
    solid, oil = set_a.surface_1.material, set_a.lubricant
    for name, value in {
        "Thermal conductivity of surfaces (W/mK)": solid.conductivity,
        "Thermal conductivity of lubricant (W/mK)": oil.conductivity,
        "Density (Kg/m^3)": solid.density,
        "Specific heat of contact solids": solid.heat_capacity,
        "Specific heat of lubricant (J/KgK)": oil.heat_capacity,
        "Ambient density (Kg/m3)": oil.density.rho_0,
        "Temperature-density coefficient of lubricant (K^{-1})": oil.density.beta,
        "ambient viscosity": oil.viscosity.eta_0,
        "inlet temperature": oil.viscosity.reference_temperature,
    }.items():
        assert float(stated[name][0].partition(" ")[0]) == pytest.approx(value)


def test_set_b_has_the_same_groups_and_four_times_the_speed():
    hot, usual = (cases(name, "converged")[0.0].problem for name in ("hot", "D-prime"))
    assert hot.contact.moes_load == usual.contact.moes_load
    assert hot.contact.moes_speed == usual.contact.moes_speed
    assert hot.entrainment_speed == pytest.approx(4 * usual.entrainment_speed)
    assert hot.lubricant == usual.lubricant


def test_the_paper_is_solved_on_64_intervals_with_five_cycles_and_mean_properties():
    for name in SERIES:
        for heat in ("isothermal", "thermal"):
            for case in cases(name, "paper", heat).values():
                options = case.options
                domain = options.domain
                assert options.points == 65
                assert (tuple(domain.x), tuple(domain.y)) == ((-4.0, 1.5), (-2.0, 2.0))
                assert (options.accuracy, options.max_cycles) == ("change", 5)
                assert heat == "isothermal" or case.problem.thermal.reynolds == "mean"


def test_crests_narrow_the_film_as_minus_a_cosine_in_the_film_equation_does():
    case = cases("C")[126.0]
    options = Options(points=129, domain=case.options.domain)
    wave = case.problem.surface_2.roughness
    low = wave.model_copy(update={"amplitude": 0.01 * wave.amplitude})
    surface = case.problem.surface_2.model_copy(update={"roughness": low})
    result = solve(case.problem.model_copy(update={"surface_2": surface}), options)
    assert result.heights is not None
    row, column = abs(result.y).argmin(), abs(result.x).argmin()
    outward = result.heights.surface_2[row, column]
    assert outward == pytest.approx(0.01 * 0.495e-6, rel=0.03)  # X = 0 is between nodes


def test_points_change_the_fine_grids_only():
    fine, paper = (
        [case for case in read_series("A", 129).cases if (case.labels["treatment"] == "paper") == p]
        for p in (False, True)
    )
    assert {case.options.points for case in paper} == {65}
    assert {case.options.points for case in fine} == {129}
    assert any(case.certify for case in fine)
    assert not any(case.certify for case in read_series("A", 65).cases)


def test_names_of_runs_are_unique():
    names = [case.name for name in SERIES for case in read_series(name).cases]
    assert len(names) == len(set(names)) == 174


def test_table_2_is_printed_so():
    assert list(printed("T2", corrected=False).isothermal_H_min) == [0.6199, 0.1190, 0.0730]
    assert list(printed("T2").isothermal_H_min) == [0.1699, 0.1190, 0.0730]
    assert list(printed("T2").thermal_H_c) == [0.2585, 0.1944, 0.1335]
    assert tuple(printed_films("A", "thermal").loc[60]) == (0.1178, 0.1944)
    assert printed_films("B", "thermal").empty


def test_the_misprint_exceeds_the_central_film_of_its_row_and_its_correction_does_not():
    central = printed("T2").isothermal_H_c[40]
    assert printed("T2", corrected=False).isothermal_H_min[40] > central
    assert printed("T2").isothermal_H_min[40] < central


def test_table_3_is_printed_so():
    assert list(printed("T3").thermal_H_min) == [0.0818, 0.1498, 0.1684, 0.1530, 0.1117]
    assert tuple(printed_films("D", "isothermal").loc[-1.0]) == (0.1683, 0.2433)


def test_the_shear_thinning_oil_is_that_of_set_a_but_for_its_stress():
    thinning, usual = (cases(name, "converged", "thermal") for name in ("C-eyring", "C"))
    assert list(thinning) == list(usual)
    for one, other in zip(thinning.values(), usual.values(), strict=True):
        assert one.problem.lubricant.shear.stress == 5e6
        changed = one.problem.lubricant.model_copy(update={"shear": other.problem.lubricant.shear})
        assert replace(one, problem=one.problem.model_copy(update={"lubricant": changed})).key == (
            other.key
        )


def test_heat_is_compared_on_the_domain_of_the_paper():
    paper = cases("A")[20.0]
    thermal, isothermal = (cases("A", "domain", heat)[20.0] for heat in ("thermal", "isothermal"))
    assert thermal.problem.thermal.reynolds == "generalised"
    assert isothermal.problem.thermal is None
    assert thermal.options.domain == isothermal.options.domain == paper.options.domain
