"""The structure of the package in numbers: ``python tests/house.py`` prints them as a table.

A room is a folder of the package with all that is in it, or a module beside the folders. An arrow
is an import from one room into another. Imports inside functions, for types only, and by name in
a string are counted.
"""

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

PACKAGE = Path(__file__).parents[1] / "src" / "tehl"
Arrows = dict[str, set[str]]
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
LONGEST_FILE, MOST_ATTRIBUTES = 450, 12


class Aim(NamedTuple):
    """A number of the structure: where it began, and where it should arrive."""

    start: int
    aim: str


AIMS = {
    "rooms": Aim(52, "<= 22"),
    "floors": Aim(19, "<= 13"),
    "arrows between rooms": Aim(300, "<= 120"),
    "files in the largest circle": Aim(102, "<= 6"),
    f"files over {LONGEST_FILE} lines": Aim(5, "the largest kernel"),
    f"classes over {MOST_ATTRIBUTES} attributes": Aim(25, "<= 8"),
    "imports inside functions": Aim(149, "< 60"),
    "files that name load_share": Aim(12, "<= 2"),
    "files that name mid_film_rise_central": Aim(10, "<= 2"),
    "lines": Aim(46727, "<= 38000"),
    "numeric constants of modules": Aim(678, "< 300"),
    "% of public docstrings with sections": Aim(25, ">= 60"),
}


@cache
def trees(package: Path = PACKAGE) -> dict[str, ast.Module]:
    """Return the parsed modules of a package by their dotted names."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = (package.name, *path.relative_to(package).with_suffix("").parts)
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


@cache
def imports(package: Path = PACKAGE) -> Arrows:
    """Return the modules that each module imports."""
    modules = trees(package)

    def targets(node: ast.AST) -> Iterator[str]:
        if isinstance(node, ast.ImportFrom) and node.module:
            for one in node.names:
                whole = f"{node.module}.{one.name}"
                yield whole if whole in modules else node.module
        elif isinstance(node, ast.Import):
            yield from (one.name for one in node.names)
        elif isinstance(node, ast.Constant) and str(node.value).startswith(f"{package.name}."):
            yield str(node.value)

    return {
        name: {to for node in ast.walk(tree) for to in targets(node) if to in modules} - {name}
        for name, tree in modules.items()
    }


def room_of(module: str) -> str:
    """Return the room of a module: the first name after that of the package."""
    return ".".join(module.split(".")[:2])


@cache
def arrows(package: Path = PACKAGE) -> Arrows:
    """Return the rooms that each room imports."""
    found: Arrows = {}
    for name, targets in imports(package).items():
        room = room_of(name)
        found.setdefault(room, set()).update(map(room_of, targets))
        found[room].discard(room)
    return found


def circles(graph: Mapping[str, set[str]]) -> list[set[str]]:
    """Return the circles of a graph, nodes that reach each other, the lowest first (Tarjan)."""
    order: dict[str, int] = {}
    least: dict[str, int] = {}
    waiting: list[str] = []
    found: list[set[str]] = []

    def visit(node: str) -> None:
        order[node] = least[node] = len(order)
        waiting.append(node)
        for other in graph.get(node, ()):
            if other not in order:
                visit(other)
                least[node] = min(least[node], least[other])
            elif other in waiting:
                least[node] = min(least[node], order[other])
        if least[node] == order[node]:
            place = waiting.index(node)
            found.append(set(waiting[place:]))
            del waiting[place:]

    for node in graph:
        if node not in order:
            visit(node)
    return found


def floors(graph: Arrows) -> int:
    """Return the number of rooms in the longest chain of imports; a circle is one floor."""
    floor: dict[str, int] = {}
    for circle in circles(graph):
        below = [floor[to] for node in circle for to in graph.get(node, ()) if to not in circle]
        floor |= dict.fromkeys(circle, 1 + max(below, default=0))
    return max(floor.values())


def imports_inside_functions(package: Path = PACKAGE) -> int:
    """Return the number of import statements inside functions, those of libraries included."""
    return sum(
        len(
            {
                id(node)
                for function in ast.walk(tree)
                if isinstance(function, FUNCTIONS)
                for node in ast.walk(function)
                if isinstance(node, ast.Import | ast.ImportFrom)
            }
        )
        for tree in trees(package).values()
    )


def attributes(owner: ast.ClassDef) -> set[str]:
    """Return the attributes of the objects of a class: its fields, and what methods assign."""
    fields = {
        node.target.id
        for node in owner.body
        if isinstance(node, ast.AnnAssign)
        and isinstance(node.target, ast.Name)
        and "ClassVar" not in ast.dump(node.annotation)
    }
    stored = (
        node.attr
        for node in ast.walk(owner)
        if isinstance(node, ast.Attribute)
        and isinstance(node.ctx, ast.Store)
        and isinstance(node.value, ast.Name)
        and node.value.id == "self"
    )
    return fields | set(stored)


def is_number(value: ast.AST | None) -> bool:
    """Return whether an expression is made of numbers only."""
    if isinstance(value, ast.UnaryOp):
        return is_number(value.operand)
    if isinstance(value, ast.BinOp):
        return is_number(value.left) and is_number(value.right)
    return isinstance(value, ast.Constant) and type(value.value) in (int, float)


def numeric_values(tree: ast.Module) -> list[tuple[str, float]]:
    """Return the names and values of the constants of a module that are numbers."""
    found = []
    for node in tree.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            pairs = [(node.target, node.value)]
        elif isinstance(node, ast.Assign):
            pairs = [pair for target in node.targets for pair in assigned(target, node.value)]
        else:
            continue
        found += [
            (target.id, eval(ast.unparse(value)))
            for target, value in pairs
            if isinstance(target, ast.Name) and value is not None and is_number(value)
        ]
    return found


def assigned(target: ast.expr, value: ast.expr) -> list[tuple[ast.expr, ast.expr]]:
    """Return the names that an assignment sets with their values, those of a tuple one by one."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return list(zip(target.elts, value.elts, strict=True))
    return [(target, value)]


def numeric_constants(tree: ast.Module) -> int:
    """Return the number of constants of a module that are numbers."""
    return len(numeric_values(tree))


def with_sections(package: Path = PACKAGE) -> float:
    """Return the percentage of public functions of two parameters or more with sections."""
    found = []
    for tree in trees(package).values():
        for node in ast.walk(tree):
            if isinstance(node, FUNCTIONS) and not node.name.startswith("_"):
                given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                if sum(one.arg not in ("self", "cls") for one in given) >= 2:
                    found.append("Parameters\n" in (ast.get_docstring(node) or ""))
    return 100.0 * sum(found) / len(found)


def files_that_name(word: str, package: Path = PACKAGE) -> int:
    """Return the number of modules and templates that name a quantity, with a unit or without."""
    named = re.compile(rf"\b{word}(_[a-z]{{1,3}})?\b")
    paths = (path for path in package.rglob("*") if path.suffix in (".py", ".html", ".txt", ".js"))
    return sum(bool(named.search(path.read_text(encoding="utf-8"))) for path in paths)


def numbers(package: Path = PACKAGE) -> dict[str, int]:
    """Return the numbers of the structure, by the names of `AIMS`."""
    modules, graph = trees(package), arrows(package)
    lines = {path: len(path.read_bytes().splitlines()) for path in package.rglob("*.py")}
    classes = [
        node
        for tree in modules.values()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
    ]
    values = (
        len(graph),
        floors(graph),
        sum(map(len, graph.values())),
        max(map(len, circles(imports(package)))),
        sum(count > LONGEST_FILE for count in lines.values()),
        sum(len(attributes(one)) > MOST_ATTRIBUTES for one in classes),
        imports_inside_functions(package),
        files_that_name("load_share", package),
        files_that_name("mid_film_rise_central", package),
        sum(lines.values()),
        sum(map(numeric_constants, modules.values())),
        round(with_sections(package)),
    )
    return dict(zip(AIMS, values, strict=True))


def main() -> None:
    """Print the table; the argument is another folder of the package, if any."""
    package = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else PACKAGE
    print(f"{'what':<40}{'at the start':>14}{'aimed':>20}{'reached':>10}")  # noqa: T201
    for what, reached in numbers(package).items():
        start, aim = AIMS[what]
        print(f"{what:<40}{start:>14}{aim:>20}{reached:>10}")  # noqa: T201


if __name__ == "__main__":
    main()
