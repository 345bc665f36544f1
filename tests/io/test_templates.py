"""Each template is a case."""

from pathlib import Path

import pytest

from tehl.errors import InputError
from tehl.io.case import read_case_and_options
from tehl.io.templates import template_text, templates


@pytest.mark.parametrize("name", list(templates()))
def test_every_template_is_a_case(name: str, tmp_path: Path):
    path = tmp_path / "case.toml"
    path.write_text(template_text(name), encoding="utf-8")
    problem, options = read_case_and_options(path)
    assert problem.title
    assert options.points == 257
    assert 0.3e9 < problem.hertz.pressure < 2e9


def test_the_titles_are_sentences():
    assert all(len(title) > 20 for title in templates().values())


def test_an_unknown_template_lists_the_known():
    with pytest.raises(InputError, match="did you mean moes"):
        template_text("mose")
