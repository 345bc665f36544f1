"""Line contacts with heat, thinning, scarce oil, asperities, waves and loads that change."""

import math
import re

import numpy as np
import pandas as pd
import pytest
from pydantic import ValidationError

import tehl
from benchmarks import any_contacts
from tehl.cli.text import as_text
from tehl.contact.options import Domain, Options
from tests.solver.test_line import BOX, CITED, line

STEEL = {"young_modulus": 2.0566e11, "poisson_ratio": 0.3} | {
    "density": 7850.0,
    "heat_capacity": 470.0,
    "conductivity": 46.0,
}
OIL = {
    "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9, "gamma": 0.042}
    | {"reference_temperature": 313.0},
    "density": {"law": "dowson-higginson", "rho_0": 890.0, "beta": 6.5e-4, "form": "additive"},
    "conductivity": 0.14,
    "heat_capacity": 2000.0,
}


def hot(sliding: float, sources: str = "line") -> tehl.ContactProblem:
    """Return a heated line contact of 0.8 GPa."""
    tables = {
        "contact": {"type": "line", "radius": 0.02, "hertz_pressure": 8e8, "entrainment_speed": 1.5}
        | {"slide_roll_ratio": sliding},
        "surface_1": {"material": STEEL},
        "surface_2": {"material": STEEL},
        "lubricant": OIL,
        "thermal": {"temperature": 313.0, "sources": sources, "layers": 13},
    }
    return tehl.ContactProblem.model_validate(tables)


def test_heat_is_that_of_another_program():
    found, cited = tehl.solve(hot(0.5), Options(points=513, domain=BOX)), CITED["heated"]
    summary = found.summary()
    words = as_text(found)
    for power in ("friction loss .* in the film, .* of one metre", "which take .* W of one metre"):
        assert re.search(power, words)
    assert found.film_scaled.central == pytest.approx(cited["h_central"], rel=1e-3)
    assert found.film_scaled.minimum == pytest.approx(cited["h_minimum"], rel=1e-3)
    rise = summary["temperature"]["mid_film_rise_central_k"]
    assert rise == pytest.approx(cited["mid_film_rise"], rel=3e-4)
    traction = summary["traction"]["mid_film"]
    assert traction == pytest.approx(cited["mid_film_traction"], rel=1e-3)
    assert abs(summary["convergence"]["heat_balance_error"]) < 2e-3
    assert abs(summary["convergence"]["work_balance_error"]) < 4e-3  # falls with the mesh


def test_coarser_grids_of_a_fast_line_are_heated_too():
    problem = tehl.ContactProblem.model_validate(
        {
            "contact": {"type": "line", "radius": 0.01, "hertz_pressure": 6e8}
            | {"entrainment_speed": 10.0},
            "surface_1": {"material": "steel"},
            "surface_2": {"material": "steel"},
            "lubricant": "mineral-oil",
            "thermal": {},
        }
    )
    found = tehl.solve(problem, Options(points=513))  # heated on the last grid alone it diverges
    heated = {one.points[0] for one in found.history if one.temperature_rise != 0.0}
    assert heated >= {129, 257, 513}
    # oil that flows back heats the inlet far upstream: the domain and its error bar follow
    found = tehl.solve(problem)
    assert found.scaled.x[0] < -15.0
    assert 1e-3 < found.errors.central < 5e-3
    # 4097 nodes from X = -20; from X = -27 0.02 % less
    assert found.film_scaled.central == pytest.approx(1.2005, rel=found.errors.central)
    assert np.trapezoid(found.scaled.pressure[0], found.scaled.x) == pytest.approx(
        0.5 * math.pi, rel=2e-3
    )


def test_the_film_between_heated_eddies_is_within_its_bars():
    """Heat that flows back at the inlet came upstream by a node per sweep: the film stood still."""
    problem = tehl.ContactProblem.model_validate(
        {
            "contact": {"type": "line", "radius": 0.0776, "moes_load": 6.28, "moes_speed": 5.12}
            | {"slide_roll_ratio": 0.115},
            "surface_1": {"material": "glass"},
            "surface_2": {"material": "silicon-nitride"},
            "lubricant": {
                "viscosity": {"law": "roelands", "eta_0": 0.0356, "alpha": 1.5e-8, "gamma": 0.0263}
                | {"reference_temperature": 366.7},
                "density": {"law": "dowson-higginson", "rho_0": 880.0, "beta": 6.5e-4},
                "conductivity": 0.13,
                "heat_capacity": 2240.0,
                "temperature": 366.7,
            },
            "thermal": {},
        }
    )
    near, films = Domain(x=(-3.935925, 1.789057)), []
    for cells, x in ((256, near.x), (256, near.x), (512, tuple(2 * edge for edge in near.x))):
        stated = {"accuracy": "tight"} if films else {}
        options = {"points": cells + 1, "domain": {"x": x}, "edges": "far_field"} | stated
        films.append(tehl.solve(problem, Options.model_validate(options)))
    film, tight, wide = (one.film_scaled.central for one in films)
    errors = films[0].errors
    assert abs(film / tight - 1.0) < errors.iteration_central + 1e-4 < 0.005
    assert 0.3 * errors.domain < abs(tight / wide - 1.0) < errors.domain


def test_heat_that_a_longer_domain_gives_to_the_other_surface_lies_in_the_bars():
    """A line (M = 6, L = 6) between glass and steel that rolls: 3 % of its heat go to the other."""
    problem = any_contacts.contact(525, 49)[2]
    near = tehl.solve(problem, Options(error=0.02))
    x = tuple(2.0 * float(edge) for edge in near.scaled.x[[0, -1]])
    settings = {"points": 2 * near.scaled.x.size - 1, "domain": {"x": x}, "edges": "far_field"}
    wide = tehl.solve(problem, Options.model_validate(settings | {"extrapolate": True}))
    for name in ("surface_1", "surface_2"):
        here, there = (getattr(one.heat.balance, name) for one in (near, wide))
        off, bar = abs(there / here - 1.0), near.errors.bars[f"heat_{name}"]
        assert 0.3 * bar < off < bar


def test_the_full_source_is_near_that_of_a_line_at_high_speed():
    rises = {}
    for sources in ("line", "full"):
        options = Options(points=513, domain=BOX)
        rises[sources] = tehl.solve(hot(0.5, sources), options).summary()["temperature"]
    # solid Peclet numbers of 14 and 20
    for name in ("surface_1_rise_max_k", "surface_2_rise_max_k"):
        assert rises["full"][name] == pytest.approx(rises["line"][name], rel=0.05)


def test_what_enters_a_starved_line_is_what_passes():
    for ratio in (0.3, 0.9):
        found = tehl.solve(line(20.0, 8.0, supply={"ratio": ratio}))
        starved = found.summary()["starvation"]
        assert starved["degree"] == pytest.approx(ratio, rel=1e-3)  # exact: no oil flows aside
        assert starved["meniscus_m"] < 0.0
    flooded = tehl.solve(line(20.0, 8.0)).film_scaled
    for tables in ({"supply": {"ratio": 2.0}}, {"cavitation": {"model": "conserving"}}):
        same = tehl.solve(line(20.0, 8.0, **tables)).film_scaled
        assert same.central == pytest.approx(flooded.central, rel=1e-3)


def films(stress: str, sliding: float) -> tehl.Result:
    """Return the film of an Eyring oil that slides."""
    oil = OIL | {"shear": {"law": "eyring", "stress": stress}}
    return tehl.solve(line(20.0, 8.0, lubricant=oil, contact={"slide_roll_ratio": sliding}))


def test_thinning_has_its_limits():
    newtonian = tehl.solve(line(20.0, 8.0, lubricant=OIL)).film_scaled.central
    limit = films("1e12 Pa", 1.0)
    assert limit.film_scaled.central == pytest.approx(newtonian, rel=limit.errors.central)
    thin = films("1 MPa", 1.0)
    assert thin.film_scaled.central == pytest.approx(0.977 * newtonian, rel=2e-3)
    assert abs(thin.summary()["traction"]["mid_film"]) < 0.02


def test_summits_far_apart_carry_nothing():
    rough = {"material": "steel", "rms_roughness": "5 nm"}
    summits = {"model": "greenwood-tripp", "summit_radius": "20 um", "summit_density": "3e10 1/m^2"}
    tables = {"surface_1": rough, "surface_2": rough, "asperities": summits}
    found = tehl.solve(line(20.0, 8.0, **tables))
    assert found.summary()["load_sharing"]["share"] < 1e-6  # lambda is 30
    smooth = tehl.solve(line(20.0, 8.0)).film_scaled.central
    assert found.film_scaled.central == pytest.approx(smooth, rel=1e-3)


def test_a_wave_passes_with_the_amplitude_of_theory():
    still = line(20.0, 10.0)
    width = still.hertz.half_width_x
    seconds, unit = width / still.entrainment_speed, width**2 / still.radius_x
    wave = {"type": "wave", "amplitude": 2e-3 * unit, "wavelength": 0.5 * width}
    rough = {"material": "steel", "roughness": wave}
    moving = line(20.0, 10.0, surface_1=rough, transient={"duration": 6.0 * seconds})
    run = tehl.solve_transient(moving, Options(points=257, domain=BOX))
    late = run.history.time > 4.5 * seconds
    film = run.history.film_central[late] / unit
    assert 0.5 * np.ptp(film) / 2e-3 == pytest.approx(CITED["wave"]["ratio"], rel=0.01)


def test_a_load_that_changes_squeezes_the_film():
    still = line(20.0, 10.0)
    width = still.hertz.half_width_x
    seconds, unit = width / still.entrainment_speed, width**2 / still.radius_x
    load = [[0.05 * k * seconds, 1.0 + 0.3 * math.sin(0.05 * k)] for k in range(180)]
    problem = line(20.0, 10.0, transient={"duration": 8.0 * seconds, "load": load})
    films = {}
    for points, order in ((97, 2), (193, 2), (193, None)):
        options = Options(points=points, domain=BOX, wedge_order=order)
        run = tehl.solve_transient(problem, options)
        time, film = run.history.time / seconds, run.history.film_central / unit
        found = np.interp([one for one, _ in CITED["load"]["films"]], time, film)
        films[points if order else "stated"] = found
    cited = np.array([film for _, film in CITED["load"]["films"]])
    assert (films[97] - cited) / (films[193] - cited) == pytest.approx(4.0, rel=0.05)
    limit = films[193] + (films[193] - films[97]) / 3.0
    assert limit == pytest.approx(cited, rel=1e-3)
    # stated nodes of a smooth line have a wedge of third order, in time as in the steady film
    assert np.abs(films["stated"] - cited).max() < 0.2 * np.abs(films[193] - cited).max()


def test_a_certified_line_has_bars():
    from tehl.api.solvers import certify  # noqa: PLC0415 (beside the only use)

    found = certify(line(20.0, 8.0), Options(points=257))
    bar = found.certified["film_central"]
    finer = tehl.solve(line(20.0, 8.0), Options(points=2049)).film.central
    assert abs(bar.value - finer) < bar.uncertainty + 1e-4 * finer


@pytest.mark.parametrize(
    ("tables", "why"),
    [
        ({"supply": {"layer": "0.2 um", "track": "0.2 m"}}, "no oil flows aside"),
    ],
)
def test_what_lines_do_not_have_is_refused(tables, why):
    with pytest.raises(ValidationError, match=why):
        line(20.0, 8.0, **tables)
    with pytest.raises(ValidationError, match="surface at rest"):
        hot(2.0)


def test_a_line_with_a_random_profile_has_its_numbers(recwarn):
    profile = {"type": "random", "rms": "5 nm", "correlation_length": "15 um", "seed": 1}
    problem = line(20.0, 10.0, surface_1={"material": "steel", "roughness": profile})
    summary = tehl.solve(problem, Options(points=257, domain=BOX)).summary()
    assert 0.0 < summary["roughness"]["lambda_central"]
    assert not [one for one in recwarn if issubclass(one.category, RuntimeWarning)]


def test_pictures_show_a_heated_rough_line(tmp_path):
    problem = hot(0.3)
    wave = {"type": "wave", "amplitude": "0.01 um", "wavelength": "0.2 mm"}
    rough = problem.model_dump(exclude_none=True)
    rough["surface_2"]["roughness"] = wave
    found = tehl.solve(tehl.ContactProblem.model_validate(rough), Options(points=257, domain=BOX))
    pictures = tehl.plots.pictures_of(found)
    assert "film" not in pictures
    paths = tehl.plots.save_all(found, tmp_path, dpi=30)
    assert {path.stem for path in paths} == set(pictures)
    assert {"centre_lines", "rough_centre_line", "temperature_section"} < set(pictures)
    assert "rolling" in found.summary()


def test_a_list_of_contacts_may_have_lines():
    row = {"type": "line", "radius [mm]": 20, "load per length [N/mm]": 200, "speed [m/s]": 1.5}
    table = tehl.solve_contacts(pd.DataFrame([row]))
    assert table["status"].tolist() == ["converged"]
    assert table["Moes M"].iloc[0] == pytest.approx(8.58, rel=1e-3)
    assert table["rolling moment [N mm]"].iloc[0] > 0.0
