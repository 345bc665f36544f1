"""Libraries of named things: files of tables, each found by its name."""

import difflib
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

Tables = dict[str, dict[str, Any]]


@cache
def read_tables(path: Path) -> Tables:
    """Return the tables of a TOML file by name, each with its own name; the file is read once."""
    text = path.read_text(encoding="utf-8")
    return {name: {"name": name} | table for name, table in tomllib.loads(text).items()}


def find_table(tables: Tables, name: str, kind: str, needs: str) -> dict[str, Any]:
    """Return the table called ``name``.

    Parameters
    ----------
    tables, name : dict, str
        The library, and the name of the table.
    kind, needs : str
        What the tables describe, and what a table without a name must have, for the message.

    Raises
    ------
    ValueError
        If there is none; the message has the closest name and all others.
    """
    if name in tables:
        return tables[name]
    close = difflib.get_close_matches(name, tables, n=1)
    guess = f"did you mean {close[0]}? " if close else ""
    raise ValueError(
        f"is not a known {kind}: {guess}known are {', '.join(tables)}; or give a table with {needs}"
    )
