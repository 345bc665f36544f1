"""Memory that a solve needs against memory that is available."""

import tomllib

import pytest

from tehl.base.errors import InputError
from tehl.contact.options import Options
from tehl.estimate.memory import (
    USUAL_MEMORY,
    available_memory,
    check_memory,
    memory_limit,
    needed_memory,
)
from tehl.io.case import case_from_tables
from tehl.io.templates import template_text


def test_the_memory_of_the_machine_is_found():
    available = available_memory()
    assert available is not None
    assert 1e7 < available < 1e15


def test_needed_memory_grows_with_the_nodes():
    small, large = needed_memory(Options(points=129)), needed_memory(Options(points=(257, 129)))
    assert large / small == pytest.approx(257 / 129)


@pytest.mark.parametrize(
    ("dropped", "measured"), [((), 753), (("asperities",), 664), (("thermal",), 275)]
)
def test_needed_memory_is_what_solves_took(dropped: tuple[str, ...], measured: float):
    """On 769 x 769 nodes, per node; heat between asperities needed more than was planned."""
    case = tomllib.loads(template_text("mixed")) | {"thermal": {}}
    for name in dropped:
        del case[name]
    del case["lubricant"]["shear"]
    case["lubricant"] |= {"conductivity": 0.14, "heat_capacity": 2000.0}
    problem, _ = case_from_tables(case)
    needed = needed_memory(Options(points=769), problem)
    assert measured < needed / 769**2 < 1.1 * measured


@pytest.mark.parametrize("available", [None, 1e12])
def test_a_grid_that_fits_or_may_fit_is_accepted(monkeypatch, available):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: available)
    check_memory(Options(points=16385))


def test_a_grid_that_does_not_fit_is_rejected_with_one_that_does(monkeypatch):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: 2e9)
    with pytest.raises(InputError, match=r"points = 16385 x 16385: .* 59 GB .* take 2945 or fewer"):
        check_memory(Options(points=16385))
    check_memory(Options(points=2945))
    check_memory(Options(error=1e-4))  # the solve fits its grid


def test_no_grid_is_proposed_if_none_fits(monkeypatch):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: 1e4)
    with pytest.raises(InputError, match=r"are available$"):
        check_memory(Options(points=513))


def test_small_grids_are_not_checked(monkeypatch):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: pytest.fail("checked"))
    check_memory(Options(points=257))


def test_the_limit_of_a_container_counts(monkeypatch, tmp_path):
    (tmp_path / "max").write_text("1000000\n")
    limits = (str(tmp_path / "max"), str(tmp_path / "none"))
    monkeypatch.setattr("tehl.estimate.memory._LIMITS", limits)
    assert available_memory() == 1e6
    (tmp_path / "max").write_text("max\n")
    assert available_memory() != 1e6


def test_a_solve_takes_no_more_than_usual_unless_it_may(monkeypatch):
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: 1e12)
    assert memory_limit(Options()) == USUAL_MEMORY
    assert memory_limit(Options.model_validate({"max_memory": "4 GB"})) == 4e9
    monkeypatch.setattr("tehl.estimate.memory.available_memory", lambda: 1e9)
    assert memory_limit(Options()) == 5e8
