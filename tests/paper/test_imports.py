"""The folder ``paper`` is a client of the public interface only."""

import ast
from pathlib import Path

import pytest

import paper
import tehl

FILES = sorted(Path(paper.__file__).parent.glob("*.py"))
REFERENCE = Path(paper.__file__).parents[1] / "docs" / "reference" / "api.md"


def names_from_tehl(file):
    """Yield the full names that a file imports from ``tehl``."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module.partition(".")[0] == "tehl":
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.startswith("tehl."))


def is_public(name):
    module, _, last = name.rpartition(".")
    exported = {"tehl": tehl.__all__, "tehl.studies": tehl.studies.__all__}
    documented = REFERENCE.read_text(encoding="utf-8")
    return last in exported.get(module, ()) or f":: {name}\n" in documented


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_only_public_names_of_tehl_are_imported(file):
    assert [name for name in names_from_tehl(file) if not is_public(name)] == []


def test_an_internal_name_would_be_found(tmp_path):
    file = tmp_path / "module.py"
    text = "from tehl.plots.frame import span_part\nimport tehl.estimate.grid\n"
    file.write_text(text, encoding="utf-8")
    assert [name for name in names_from_tehl(file) if not is_public(name)] == [
        "tehl.plots.frame.span_part",
        "tehl.estimate.grid",
    ]
