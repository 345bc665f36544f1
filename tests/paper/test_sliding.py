"""Films that must not depend on sliding, or only on its size."""

import pytest
from paper.conclusions import CONCLUSIONS
from paper.runs import read_series
from paper.tables import asymmetry, make_table

from tehl.studies import Store, run, table


def films(folder, treatment, heat, ratios):
    """Return minimum and central films of series D-prime, computed now."""
    cases = [
        case
        for case in read_series("D-prime", 65).cases
        if tuple(case.labels.values())[1:3] == (treatment, heat) and case.labels["SRR"] in ratios
    ]
    store = Store(folder)
    run(cases, store)
    frame = table(cases, store)
    return frame[["film.H_min", "film.H_central"]].to_numpy()


@pytest.mark.parametrize("treatment", ["paper", "converged"])
def test_equal_solids_do_not_depend_on_the_sign(tmp_path, treatment):
    one, other = films(tmp_path, treatment, "thermal", (-1.0, 1.0))
    assert one == pytest.approx(other, rel=1e-6)


@pytest.mark.parametrize("treatment", ["paper", "converged"])
def test_an_isothermal_film_does_not_depend_on_sliding(tmp_path, treatment):
    one, other = films(tmp_path, treatment, "isothermal", (0.0, 1.0))
    assert one == pytest.approx(other, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("treatment", ["paper", "converged"])
@pytest.mark.parametrize("name", ["D", "D-prime", "D-prime-wavy"])
def test_isothermal_films_do_not_depend_on_sliding(sliding, name, treatment):
    line = sliding.line(name, treatment, "isothermal")
    assert len(line) == 5
    for film in ("H_min_on_grid", "H_c_on_grid"):
        assert line[film].to_numpy() == pytest.approx(line[film].iloc[0], rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("treatment", ["paper", "converged"])
@pytest.mark.parametrize("name", ["D", "D-prime"])
def test_equal_solids_do_not_depend_on_the_sign_of_sliding(sliding, name, treatment):
    assert len(sliding.line(name, treatment, "thermal")) == 5
    assert asymmetry(sliding, name, treatment) < 1e-6


@pytest.mark.slow
def test_bodies_and_sign_may_be_exchanged(sliding):
    one, other = (sliding.line(f"glass-{k}", "converged", "thermal") for k in (1, 2))
    for ratio, film in one.H_min_on_grid.items():
        assert film == pytest.approx(other.H_min_on_grid[-ratio], rel=1e-6)


@pytest.mark.slow
def test_heat_depends_on_which_body_is_glass(sliding):
    c4, c5, p0 = (CONCLUSIONS[name][0](name, sliding).verdict for name in ("C4", "C5", "P0"))
    assert c4.startswith("only if the solids differ so: surface 1")
    assert c5.startswith("first half only if the solids differ")
    assert p0 == "true"


@pytest.mark.slow
def test_table_3_belongs_to_another_contact_than_its_label(sliding):
    table_3 = make_table("T3", sliding)
    assert "nearest to M = 40, L = 12.04, smooth" in table_3.notes[0]
    assert table_3.verdict.word == "cannot be reproduced"
