"""The README shows what the commands print."""

import re
import tomllib
from pathlib import Path

import pytest

from tehl import solve
from tehl.api.problem import case_from_tables
from tehl.cli.text import as_text
from tehl.io.templates import template_text

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"\d+\.?\d*")


def test_the_sample_of_the_readme_is_what_solve_prints():
    shown = README.split("```text\n")[1].split("  ...\n")[0].splitlines()
    case = case_from_tables(tomllib.loads(template_text("ball-on-disc")))
    for line, printed in zip(shown, as_text(solve(*case)).splitlines(), strict=False):
        assert NUMBER.sub("", line) == NUMBER.sub("", printed)
        found, wanted = (list(map(float, NUMBER.findall(text))) for text in (line, printed))
        assert found == pytest.approx(wanted, rel=0.02)
    assert len(shown) == 5


def test_the_files_to_which_the_readme_leads_exist():
    links = re.findall(r"\]\(([\w/.-]+)\)", README)
    assert all((Path(__file__).parents[2] / link).exists() for link in links)
