"""The floors of the package as a drawing, and the list of its files.

``python docs/floors.py`` writes `docs/dev/floors.svg` and the end of `docs/dev/architecture.md`:
floors are those that import-linter checks, subjects the first lines of the modules' docstrings.
"""

import ast
import re
import tomllib
from functools import cache
from pathlib import Path

HERE = Path(__file__).parent
PACKAGE = HERE.parent / "src" / "tehl"
DRAWING, PAGE = HERE / "dev" / "floors.svg", HERE / "dev" / "architecture.md"
HEADING = "\n## Files\n"

NAMES = (
    "commands",
    "live page",
    "studies",
    "public interface",
    "pages",
    "solver, files, plots",
    "derived quantities",
    "one grid, one result",
    "before the solve",
    "the question",
    "pieces of physics",
    "base",
)
WIDTH, LEFT, ROW, BOX = 860, 150, 38, 28
EQUATIONS = ("solver", "operators", "kernels")
WAY = (
    *("cli", "api", "io", "contact", "estimate", "solver"),
    *("operators", "kernels", "result", "post", "report"),
)
"""Modules in the order in which a case passes them."""


def floors() -> list[list[str]]:
    """Return the modules of each floor, from the top to the bottom."""
    settings = tomllib.loads((HERE.parent / "pyproject.toml").read_text())
    contract = settings["tool"]["importlinter"]["contracts"][0]
    return [re.findall(r"\w+", layer) for layer in contract["layers"]]


def drawing() -> str:
    """Return the floors as SVG: one row per floor, one box per room, numbers along a solve."""
    rows = floors()
    height = ROW * len(rows) + 40
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}"'
        f' width="{WIDTH}" height="{height}" font-family="sans-serif" font-size="13">',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
    ]
    for number, (name, modules) in enumerate(zip(NAMES, rows, strict=True)):
        top = 8 + ROW * number
        parts.append(f'<text x="10" y="{top + 19}" fill="#555">{name}</text>')
        parts.append(
            f'<line x1="0" x2="{WIDTH}" y1="{top + ROW - 5}" y2="{top + ROW - 5}" stroke="#ddd"/>'
        )
        left = LEFT
        for module in modules:
            width = 7.6 * len(module) + 18
            colour = "#ffd9a8" if module in EQUATIONS else "#dbe9f6"
            parts.append(
                f'<rect x="{left:.1f}" y="{top}" width="{width:.1f}" height="{BOX}" rx="4"'
                f' fill="{colour}" stroke="#555"/>'
                f'<text x="{left + width / 2:.1f}" y="{top + 19}"'
                f' text-anchor="middle">{module}</text>'
            )
            if module in WAY:
                parts.append(badge(WAY.index(module) + 1, left + width - 2, top + 3))
            left += width + 8
    parts.append(
        f'<text x="10" y="{height - 12}" fill="#555">Imports go to lower floors only. Orange:'
        " where the equations are solved. Numbers: the way of a case.</text></svg>"
    )
    return "\n".join(parts) + "\n"


def badge(number: int, x: float, y: float) -> str:
    """Return a number in a circle as SVG."""
    return (
        f'<circle cx="{x:.1f}" cy="{y}" r="9" fill="#1f4e9c"/>'
        f'<text x="{x:.1f}" y="{y + 4}" fill="white" font-size="11"'
        f' text-anchor="middle">{number}</text>'
    )


@cache
def subject(path: Path) -> str:
    """Return the first line of the docstring of a module."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return text.partition("\n")[0].rstrip(".")


def files_of(module: str) -> list[Path]:
    """Return the files of a module or folder, its `__init__` first."""
    single = PACKAGE / f"{module}.py"
    return [single] if single.exists() else sorted((PACKAGE / module).rglob("*.py"))


def file_list() -> str:
    """Return the page that lists all files, floor by floor."""
    lines = ["", "From the top floor to the bottom, made by `python docs/floors.py`."]
    for name, modules in zip(NAMES, floors(), strict=True):
        lines += ["", f"### {name.capitalize()}", "", "| file | subject |", "|---|---|"]
        for path in (path for module in modules for path in files_of(module)):
            shown = path.relative_to(PACKAGE).as_posix().replace("__init__.py", "")
            lines.append(f"| `{shown}` | {subject(path)} |")
    return "\n".join(lines) + "\n"


def page() -> str:
    """Return the page on the architecture with the present list of files."""
    text = PAGE.read_text(encoding="utf-8")
    return text.partition(HEADING)[0] + HEADING + file_list()


def main() -> None:
    """Write both."""
    DRAWING.write_text(drawing(), encoding="utf-8")
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
