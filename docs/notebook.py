"""Make the page of a notebook: run its cells and show what each one prints, returns and draws."""

import ast
import io
import json
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from pathlib import Path
from typing import Any, NamedTuple


class Cell(NamedTuple):
    """A cell with what its run gave: printed text, and the value of its last expression."""

    kind: str
    source: str
    printed: str = ""
    value: Any = None


def run(notebook: Path, folder: Path) -> Iterator[Cell]:
    """Run the cells of a notebook one after another; files that they write land in ``folder``."""
    names: dict[str, Any] = {}
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] != "code":
            yield Cell(cell["cell_type"], source)
            continue
        printed = io.StringIO()
        with chdir(folder), redirect_stdout(printed):
            value = evaluated(source, names)
        yield Cell("code", source, printed.getvalue(), value)


def evaluated(source: str, names: dict[str, Any]) -> Any:
    """Run code and return the value of its last expression, None if it ends with a statement."""
    *body, last = ast.parse(source).body
    if not isinstance(last, ast.Expr):
        body, last = [*body, last], None
    exec(compile(ast.Module(body, []), "<cell>", "exec"), names)
    return (
        None if last is None else eval(compile(ast.Expression(last.value), "<cell>", "eval"), names)
    )


def make(notebook: Path, page: Path) -> None:
    """Write the page of a notebook, and its pictures in a folder of the same name."""
    text = page_text(notebook, page.with_suffix(""))
    source = f"This is `examples/{notebook.name}`, run when this page was built.\n\n"
    title, rest = text.split("\n\n", 1)
    page.write_text(f"{title}\n\n{source}{rest}", encoding="utf-8")


def page_text(notebook: Path, folder: Path) -> str:
    """Return the page of a notebook in Markdown; its pictures land in ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    parts = []
    for number, cell in enumerate(run(notebook, folder)):
        if cell.kind == "markdown":
            parts.append(cell.source)
            continue
        parts.append(f"```python\n{cell.source}\n```")
        if cell.printed:
            parts.append(f"```text\n{cell.printed.rstrip()}\n```")
        if cell.value is not None:
            parts.append(shown(cell.value, folder / f"{number}.png"))
    return "\n\n".join(parts) + "\n"


def shown(value: Any, path: Path) -> str:
    """Return a value as a notebook shows it: a picture, HTML or text."""
    if hasattr(value, "_repr_png_"):
        path.write_bytes(value._repr_png_())
        return f"![output]({path.parent.name}/{path.name})"
    if (page := getattr(value, "_repr_html_", None)) is not None:
        return f'```{{raw}} html\n<div class="output">{page()}</div>\n```'
    return f"```text\n{value!r}\n```"
