"""The page on the architecture shows the tree as it is; rooms and imports are few, none climbs."""

import importlib.util
from pathlib import Path

from tests import house

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


def test_imports_close_no_circle():
    """Those inside functions, for types only and by name in a string are counted."""
    assert [circle for circle in house.circles(house.imports()) if len(circle) > 1] == []
    assert [circle for circle in house.circles(house.arrows()) if len(circle) > 1] == []


def test_no_import_climbs():
    """Those by name in a string are counted too, which import-linter does not see."""
    rows = enumerate(reversed(floors.floors()))
    floor = {f"tehl.{room}": number for number, row in rows for room in row}
    top = {"tehl", "tehl.__main__"}
    climbs = {
        (room, target)
        for room, targets in house.arrows().items()
        for target in targets
        if room not in top and not floor[target] < floor[room]
    }
    assert climbs == set()


def test_the_house_is_seen_in_a_minute():
    found = house.numbers()
    assert found["rooms"] <= 20
    assert found["floors"] <= 13
    assert found["arrows between rooms"] <= 120
    assert found["files over 450 lines"] <= 1  # the largest kernel
    assert found["classes over 12 attributes"] <= 8
    assert found["imports inside functions"] < 60
    assert found["files that name load_share"] <= 2
    assert found["files that name mid_film_rise_central"] <= 2
    assert found["% of public docstrings with sections"] >= 60


def test_a_circle_is_found():
    graph = {"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}
    assert house.circles(graph) == [{"d"}, {"b", "c"}, {"a"}]
    assert house.floors(graph) == 3
