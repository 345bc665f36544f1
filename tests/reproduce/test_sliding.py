"""Sliding: films that must not know it, or only its size; all of it is slow."""

import pytest

from tehl.reproduce.propositions import PROPOSITIONS
from tehl.reproduce.series import runs_of, series
from tehl.reproduce.tables import TABLES, asymmetry
from tehl.studies.worker import work


def film_of(name, treatment, heat, ratio):
    """Return minimum and central film of one run, computed now."""
    for run in runs_of(series(name), 65):
        if (run.treatment, run.heat, run.value) == (treatment, heat, ratio):
            summary = work(run.case, None).summary
            return summary["film.H_min"], summary["film.H_central"]
    raise LookupError(ratio)


@pytest.mark.parametrize("treatment", ["paper", "converged"])
def test_equal_solids_do_not_know_the_sign(treatment):
    one, other = (film_of("D-prime", treatment, "thermal", ratio) for ratio in (-1.0, 1.0))
    assert one == pytest.approx(other, rel=1e-6)


@pytest.mark.parametrize("treatment", ["paper", "converged"])
def test_a_cold_film_does_not_know_sliding(treatment):
    one, other = (film_of("D-prime", treatment, "isothermal", ratio) for ratio in (0.0, 1.0))
    assert one == pytest.approx(other, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("treatment", ["paper", "converged"])
@pytest.mark.parametrize("name", ["D", "D-prime", "D-prime-wavy"])
def test_isothermal_films_do_not_know_sliding(sliding, name, treatment):
    films = [m.film for m in sliding.line(name, treatment, "isothermal").values()]
    assert len(films) == 5
    for film in films:
        assert film.minimum == pytest.approx(films[0].minimum, rel=1e-6)
        assert film.central == pytest.approx(films[0].central, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("treatment", ["paper", "converged"])
@pytest.mark.parametrize("name", ["D", "D-prime"])
def test_equal_solids_do_not_know_the_sign_of_sliding(sliding, name, treatment):
    assert len(sliding.line(name, treatment, "thermal")) == 5
    assert asymmetry(sliding, name, treatment) < 1e-6


@pytest.mark.slow
def test_bodies_and_sign_may_be_exchanged(sliding):
    one, other = (sliding.line(f"glass-{k}", "converged", "thermal") for k in (1, 2))
    for ratio, measures in one.items():
        assert measures.film.minimum == pytest.approx(other[-ratio].film.minimum, rel=1e-6)


@pytest.mark.slow
def test_heat_depends_on_which_body_is_glass(sliding):
    assert PROPOSITIONS["C4"][0](sliding).verdict.startswith(
        "only if the solids differ so: surface 1"
    )
    assert PROPOSITIONS["C5"][0](sliding).verdict.startswith("first half only if the solids differ")
    assert PROPOSITIONS["P0"][0](sliding).verdict == "true"


@pytest.mark.slow
def test_table_3_belongs_to_another_contact_than_its_label(sliding):
    table = TABLES["T3"][0](sliding)
    assert "nearest to M = 40, L = 12.04, smooth" in table.notes[0]
    assert table.verdict.word == "cannot be"
