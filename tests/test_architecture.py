"""The page on the architecture shows the tree as it is, and imports close one circle only."""

import importlib.util
from pathlib import Path

import grimp

DOCS = Path(__file__).parents[1] / "docs"
SPEC = importlib.util.spec_from_file_location("floors", DOCS / "floors.py")
floors = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(floors)

HINT = "run python docs/floors.py"


def test_the_drawing_has_the_floors_that_are_checked():
    assert floors.DRAWING.read_text(encoding="utf-8") == floors.drawing(), HINT


def test_the_list_has_all_files_with_their_subjects():
    assert floors.PAGE.read_text(encoding="utf-8") == floors.page(), HINT
    assert all(floors.subject(path) for path in floors.PACKAGE.rglob("*.py"))


def test_each_file_is_on_one_floor():
    listed = [path for row in floors.floors() for module in row for path in floors.files_of(module)]
    outside = {floors.PACKAGE / "__init__.py", floors.PACKAGE / "__main__.py"}
    assert sorted(listed) == sorted(set(floors.PACKAGE.rglob("*.py")) - outside)


def test_imports_close_one_circle_those_inside_functions_and_for_types_counted():
    graph = grimp.build_graph("tehl", cache_dir=None)
    above, below = graph.find_downstream_modules, graph.find_upstream_modules
    circles = {frozenset({name} | (above(name) & below(name))) for name in graph.modules}
    saved = ("saved", "result", "transient_result", "io.content", "io.store", "io.summary")
    assert {circle for circle in circles if len(circle) > 1} == {
        frozenset(f"tehl.{name}" for name in saved)
    }
