"""Make the gallery: run each example; show its text, its output and its pictures."""

import ast
import subprocess
import sys
from pathlib import Path

import tehl

PAGE = """# {title}

{text}

{pictures}

It prints

```text
{output}
```

## The script

`examples/{name}.py`; run it with `python examples/{name}.py FOLDER`.

```{{literalinclude}} {script}
:language: python
:start-at: import
```
"""

INDEX = """# Gallery

Each page shows a script of the folder `examples` with the output and the pictures of its last run.

{thumbnails}

```{{toctree}}
:hidden:

{names}
```
"""
COLUMNS = 3
"""Thumbnails in a row."""


def make(examples: Path, folder: Path) -> None:
    """Write one page per example into ``folder``, and an index; run only outdated examples."""
    folder.mkdir(exist_ok=True)
    scripts = sorted(examples.glob("*.py"))
    for script in scripts:
        page = folder / f"{script.stem}.md"
        if not page.exists() or page.stat().st_mtime < newest(script):
            page.write_text(page_text(script, folder), encoding="utf-8")
    names = "\n".join(script.stem for script in scripts)
    text = INDEX.format(names=names, thumbnails=thumbnails(scripts, folder))
    index = folder / "index.md"
    if not index.exists() or index.read_text(encoding="utf-8") != text:
        index.write_text(text, encoding="utf-8")


def thumbnails(scripts: list[Path], folder: Path) -> str:
    """Return a table with picture and title of each example, which lead to its page."""
    cells = []
    for script in scripts:
        title, picture = title_of(script), min((folder / script.stem).glob("*.png"))
        image = f"![{title}]({script.stem}/{picture.name})"
        cells.append(f"[{image}]({script.stem}.md) [{title}]({script.stem}.md)")
    cells += [""] * (-len(cells) % COLUMNS)
    rows = [cells[i : i + COLUMNS] for i in range(0, len(cells), COLUMNS)]
    lines = ["| " + " | ".join(row) + " |" for row in ([""] * COLUMNS, ["---"] * COLUMNS, *rows)]
    return ":::{container} thumbnails\n" + "\n".join(lines) + "\n:::"


def title_of(script: Path) -> str:
    """Return the first line of the docstring of a script."""
    doc = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or script.stem
    return doc.partition("\n")[0].rstrip(".")


def newest(script: Path) -> float:
    """Return the time of the last change of the script, this file or the package."""
    sources = [script, Path(__file__), *Path(tehl.__file__).parent.rglob("*.py")]
    return max(path.stat().st_mtime for path in sources)


def page_text(script: Path, folder: Path) -> str:
    """Run ``script`` and return its page."""
    pictures = folder / script.stem
    done = subprocess.run(
        [sys.executable, str(script), str(pictures)], check=True, capture_output=True, text=True
    )
    doc = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or script.stem
    title, text = title_of(script), doc.partition("\n")[2]
    shown = [
        f"![{title} {path.stem.replace('_', ' ')}]({script.stem}/{path.name})"
        for path in sorted(pictures.glob("*.png"))
    ]
    return PAGE.format(
        title=title,
        text=text.strip(),
        pictures="\n\n".join(shown),
        output=done.stdout.rstrip(),
        name=script.stem,
        script=f"../../examples/{script.name}",
    )
