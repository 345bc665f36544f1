"""Libraries of named things: files of tables, each found by its name or an alias."""

import difflib
import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

_ALIASES = "aliases"
_SEPARATORS = r"[\W_]*"
Tables = dict[str, dict[str, Any]]


@cache
def read_tables(path: Path) -> Tables:
    """Return the tables of a TOML file by name, each with its own name; the file is read once."""
    return {
        name: {"name": name} | {key: value for key, value in table.items() if key != _ALIASES}
        for name, table in _content(path).items()
    }


@cache
def _content(path: Path) -> Tables:
    return tomllib.loads(path.read_text(encoding="utf-8"))


@cache
def _names(path: Path) -> dict[str, str]:
    """Return the name of each table by it and its aliases, all plain."""
    return {
        _plain(word): name
        for name, table in _content(path).items()
        for word in (name, *table.get(_ALIASES, ()))
    }


def known_names(path: Path) -> dict[str, Any]:
    """Return the JSON schema of a name: the tables of a file with their aliases.

    Editors complete the ``enum``; the ``pattern`` accepts all that `find_table` does.
    """
    words = [
        word for name, one in _content(path).items() for word in (name, *one.get(_ALIASES, ()))
    ]
    alike = "|".join(_SEPARATORS.join(map(_any_case, word)) for word in _names(path))
    pattern = f"^{_SEPARATORS}({alike}){_SEPARATORS}$"
    return {"type": "string", "anyOf": [{"enum": words}, {"pattern": pattern}]}


def _any_case(letter: str) -> str:
    return f"[{letter}{letter.upper()}]" if letter.isalpha() else letter


def _plain(name: str) -> str:
    """Return a name without what people write differently: capitals, blanks, hyphens, dots."""
    return re.sub(_SEPARATORS, "", name.lower())


def find_table(path: Path, name: str, kind: str, needs: str) -> dict[str, Any]:
    """Return the table called ``name`` or with that alias, whatever its capitals and hyphens.

    Parameters
    ----------
    path, name : Path, str
        The TOML file, and the name of the table.
    kind, needs : str
        What the tables describe, and what a table without a name must have, for the message.

    Raises
    ------
    ValueError
        If there is none; the message has the closest name and all others.
    """
    names, tables = _names(path), read_tables(path)
    if (plain := _plain(name)) in names:
        return tables[names[plain]]
    close = difflib.get_close_matches(plain, names, n=1)
    guess = f"did you mean {names[close[0]]}? " if close else ""
    raise ValueError(
        f"is not a known {kind}: {guess}known are {', '.join(tables)}; or give a table with {needs}"
    )
