"""The notebook of the tutorial runs from top to bottom, and its page shows what each cell gives."""

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
NOTEBOOK = ROOT / "examples" / "tutorial.ipynb"


@pytest.fixture(scope="module")
def maker() -> ModuleType:
    """Return the module that makes the page."""
    place = importlib.util.spec_from_file_location("notebook", ROOT / "docs" / "notebook.py")
    module = importlib.util.module_from_spec(place)
    place.loader.exec_module(module)
    return module


def test_the_notebook_is_stored_without_outputs():
    content = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert content["nbformat"] == 4
    assert all(not cell.get("outputs") for cell in content["cells"])


def test_the_page_of_the_notebook_shows_texts_tables_and_pictures(maker, tmp_path):
    page = maker.page_text(NOTEBOOK, tmp_path / "pictures")
    pictures = sorted(path.name for path in (tmp_path / "pictures").glob("[0-9]*.png"))
    assert len(pictures) == 2
    assert all(f"![output](pictures/{name})" in page for name in pictures)
    assert 'Contact.load = "80 mm": has the unit of a length' in page
    assert "by the minimum film: full film" in page
    assert "<caption>Steel ball on a steel disc</caption>" in page
    assert "roughness.lambda_minimum</th>" in page
