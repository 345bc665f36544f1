"""Examples of the pages for developers do what they say on the code of today."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from pydantic import Field

from tehl.api.solvers import solve
from tehl.base import units
from tehl.contact.options import Options
from tehl.estimate import film_formulas
from tehl.estimate.scaling import ScaledProblem
from tehl.lubricant import law, viscosity
from tehl.solver.cycle import level
from tehl.solver.physics import solid_shares
from tests.reference import moes_contact

PAGES = Path(__file__).parents[2] / "docs" / "dev"


def added(page: str, file: str) -> str:
    """Return the lines that the examples of a page add to a file, up to the next hunk."""
    text = (PAGES / page).read_text(encoding="utf-8")
    hunk = re.search(rf"\+\+\+ b/{re.escape(file)}\n((?:[+ ].*\n|\+\n| \n)+)", text)
    assert hunk is not None, f"{page} changes {file} no more"
    return "\n".join(line[1:] for line in hunk[1].splitlines() if line.startswith("+"))


def test_the_share_of_the_page_carries_load_beside_the_oil(monkeypatch):
    names = dict(vars(solid_shares))
    exec(added("adding-a-share.md", "src/tehl/solver/physics/solid_shares.py"), names)
    problem, options = moes_contact(50.0, 5.0), Options(points=65)
    alone, found = solve(problem, options), []
    for stiffness in (0.0, 0.5):
        bed = names["Springs"]
        monkeypatch.setattr(
            level, "share_of", lambda equations, k=stiffness, bed=bed: bed(equations, k, 0.3)
        )
        found.append(solve(problem, options))
    without, carried = found
    assert without.film.central == pytest.approx(alone.film.central, rel=1e-9)
    assert carried.scaled.pressure.max() < 0.98 * alone.scaled.pressure.max()
    assert carried.status.converged


def test_the_formula_of_the_page_has_the_value_that_it_states():
    names = dict(vars(film_formulas))
    lines = added("adding-a-formula.md", "src/tehl/estimate/film_formulas.py")
    exec(lines[lines.index("def ") :], names)
    groups = ScaledProblem.of(moes_contact(100.0, 0.1)).groups
    film = names["hamrock_dowson_soft"](replace(groups, U=3.8e-8, M=1.9e-4 * 7.6e-8**-0.75))
    assert film.central == pytest.approx(3.918e-4, rel=1e-3)


def test_the_law_of_the_page_has_the_value_that_it_states():
    names = {**vars(law), **vars(units), **vars(viscosity), "Field": Field}
    lines = added("adding-a-law.md", "src/tehl/lubricant/viscosity.py")
    exec(lines, names)
    mcewen = names["McEwen"](eta_0=0.04, alpha=2.2e-8, q=10.0, gamma=0.042)
    # (1 + 22 * 0.5 / 10)^10 = 2.1^10 at 0.5 GPa
    assert mcewen.viscosity(5e8, 313.15) == pytest.approx(0.04 * 2.1**10, rel=1e-12)


def test_the_pages_name_files_and_functions_that_are_there():
    text = (PAGES / "architecture.md").read_text(encoding="utf-8")
    table = text[text.index("## Where it is") : text.index("## Results on disk")]
    named = re.findall(r"`([\w/]+\.\w+)`((?:: `\w+`(?:, `\w+`)*)?)", table)
    assert len(named) > 15
    for file, names in named:
        found = sorted((PAGES.parents[1] / "src/tehl").rglob(file))
        there = "".join(one.read_text(encoding="utf-8") for one in found)
        words = {*re.findall(r"\w+", there)}
        assert found, file
        assert {*re.findall(r"`(\w+)`", names)} <= words, file


@pytest.mark.parametrize(
    ("page", "file"),
    [
        ("adding-a-quantity.md", "src/tehl/result/quantities.py"),
        ("adding-a-quantity.md", "src/tehl/post/film.py"),
        ("adding-a-quantity.md", "src/tehl/post/following.py"),
        ("adding-a-quantity.md", "src/tehl/solver/judging/measures.py"),
        ("adding-an-entrainment.md", "src/tehl/operators/turning.py"),
        ("adding-an-entrainment.md", "src/tehl/solver/cycle/level.py"),
        ("adding-a-share.md", "src/tehl/contact/shape.py"),
    ],
)
def test_what_a_page_shows_of_the_code_stands_there(page: str, file: str):
    stated = [line.strip() for line in added(page, file).splitlines() if '"""' not in line]
    there = (PAGES.parents[1] / file).read_text(encoding="utf-8")
    assert [line for line in stated if line not in there] == []
