"""Lines of text: as they are on a pipe, wrapped at the width of a terminal."""

import re
import shutil
import sys
import textwrap
from collections import Counter

import typer

_LABEL = re.compile(r"\s*\S.*?\s{2,}|\s*- ")
"""What stands before the text of a line: a label with two spaces or more behind it, or a dash."""
_WIDEST_LABEL = 0.5
"""Widest label under which the text is not continued, over the width."""


def show(text: str, *, err: bool = False) -> None:
    """Print text to stdout or stderr; on a terminal long lines go on below their beginning."""
    stream = sys.stderr if err else sys.stdout
    if stream is not None and stream.isatty():
        text = wrapped(text, shutil.get_terminal_size().columns)
    typer.echo(text, err=err)


def wrapped(text: str, width: int) -> str:
    """Return a text whose lines are broken between words, their further parts indented."""
    lines = text.split("\n")
    ends = Counter(label.end() for line in lines if (label := _LABEL.match(line)))
    column = max(ends, key=lambda end: ends[end], default=0)
    return "\n".join(_wrapped(line, width, column) for line in lines)


def _wrapped(line: str, width: int, column: int) -> str:
    """Return a line in parts; ``column`` is where the text of most lines begins."""
    if len(line) <= width:
        return line
    label = _LABEL.match(line)
    # further indent of the lines that follow one without a label
    indent = len(line) - len(line.lstrip()) + 2
    if column <= _WIDEST_LABEL * width and line[:column].strip() and line[column - 1] == " ":
        indent = column
    elif label is not None and label.end() <= _WIDEST_LABEL * width:
        indent = label.end()
    return textwrap.fill(
        line,
        max(width, 2 * indent),
        subsequent_indent=indent * " ",
        replace_whitespace=False,
        break_long_words=False,
        break_on_hyphens=False,
    )
