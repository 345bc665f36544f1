"""Libraries of named things: tables of the package and of the user, found by name or alias.

A table may say in ``evidence`` how each of its numbers is known, ``"measured, 3 %, key"``: the
kind, the range, and a key of the table ``sources`` of its file. Evidence, family and aliases stay
in the library; what follows from them is the text ``source``, which goes with the numbers.
"""

import difflib
import json
import os
import re
import sys
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from pydantic import BaseModel, GetJsonSchemaHandler, ValidationError
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from tehl.base.encoding import encoding_of
from tehl.base.mistakes import describe

_OWN_KEYS = ("aliases", "family", "evidence")
"""Keys of the library, not of the tables."""
_SOURCES = "sources"
_SEPARATORS = r"[\W_]*"
_RIVALS = {"alpha": "z", "z": "alpha", "gamma": "S0", "S0": "gamma"}
"""Keys that exclude each other: one that is stated replaces the other."""
_CONDITIONS = frozenset(("name", "source", "temperature", "limits", "law"))
"""Keys that are not constants of an oil or a solid."""


@dataclass(frozen=True, slots=True)
class Named:
    """One entry of a library."""

    table: dict[str, Any]
    """What a case would state, with ``name`` and ``source``."""
    aliases: tuple[str, ...]
    family: str
    evidence: dict[str, tuple[str, str, str]] = field(hash=False)
    """Kind, range and source of each number by its key."""
    path: Path
    """The file."""

    @property
    def words(self) -> tuple[str, ...]:
        """The name and the aliases."""
        return self.table["name"], *self.aliases

    @property
    def texts(self) -> tuple[str, str]:
        """What a filter looks at: names and family, and then the source."""
        return " ".join((*self.words, self.family)).lower(), self.table.get("source", "").lower()


@dataclass(frozen=True, slots=True)
class Library:
    """Named tables of one kind.

    Attributes
    ----------
    path : Path
        File of the package; one of the same name beside a case or in `config_folder` adds to it.
    kind, key, needs : str
        What a table describes, the key that names one to start from, and what one without a name
        must have.
    model : type
        Class of the tables.
    """

    path: Path
    kind: str
    key: str
    needs: str
    model: type[BaseModel]

    def entries(self, folder: Path | None = None) -> dict[str, Named]:
        """Return all entries by name; those beside a case in ``folder`` go before all others.

        Raises ValueError if a file of the user is not a library.
        """
        own = (place / self.path.name for place in (config_folder(), folder) if place is not None)
        found = dict(_read(self.path))
        for path in own:
            if path.is_file() and path != self.path:
                found |= _entries(path)
        return found

    def find(self, name: str, folder: Path | None = None) -> Named:
        """Return the entry called ``name``, whatever its capitals and hyphens.

        Parameters
        ----------
        name : str
            Its name or an alias.
        folder : Path, optional
            That of the case.

        Raises
        ------
        ValueError
            If there is none; the message has the closest name.
        """
        entries = self.entries(folder)
        names = {_plain(word): one for one in entries.values() for word in one.words}
        if (plain := _plain(str(name))) in names:
            return self.checked(names[plain])
        close = difflib.get_close_matches(plain, names, n=1)
        guess = f"did you mean {names[close[0]].table['name']}? " if close else ""
        raise ValueError(
            f"is not a known {self.kind}: {guess}{self.listed(folder)}; or give a table with "
            f"{self.needs}"
        )

    def checked(self, one: Named) -> Named:
        """Return an entry; raise ValueError if that of the user has a mistake."""
        if one.path != self.path:
            try:
                self.model.model_validate(one.table)
            except ValidationError as error:
                mistake = describe(error, one.table, self.model, one.table["name"])
                raise ValueError(f"cannot be used: {one.path}: {mistake}") from None
        return one

    def listed(self, folder: Path | None = None) -> str:
        """Return how to find the known names; ``folder`` is that of the case."""
        entries = self.entries(folder)
        return f"tehl {self.kind}s lists {len(entries)}, such as {next(iter(entries))}"

    def stated(self, value: object, folder: Path | None = None, key: str = "") -> object:
        """Return the table that a case states: of a name, or of a name and keys that replace some.

        Parameters
        ----------
        value : object
            What stands in the case; tables without ``key`` are returned as they are.
        folder : Path, optional
            That of the case.
        key : str
            Key with the name, in place of that of the library.
        """
        key = key or self.key
        if isinstance(value, str):
            return self.find(value, folder).table
        if not isinstance(value, Mapping) or key not in value:
            return value
        name, over = value[key], {one: stated for one, stated in value.items() if one != key}
        if not isinstance(name, str):
            raise ValueError(f"{key} must be a name: {self.listed(folder)}")
        try:
            base = self.find(name, folder).table
        except ValueError as error:
            raise ValueError(f"{key} = {json.dumps(name)} {error}") from None
        changed = ", ".join(key for key in _constants(over))
        note = {"source": f"{base.get('source', '')}; stated in the case: {changed}"}
        return _over(base, over) | (note if changed and "source" not in over else {})

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe a name: editors complete the ``enum``, the ``pattern`` accepts what is found."""
        del schema, handler
        words = [word for one in _read(self.path).values() for word in one.words]
        alike = "|".join(_SEPARATORS.join(map(_any_case, _plain(word))) for word in words)
        pattern = f"^{_SEPARATORS}({alike}){_SEPARATORS}$"
        return {"type": "string", "anyOf": [{"enum": words}, {"pattern": pattern}]}


def config_folder() -> Path:
    """Return the folder of the user's own libraries, as the platform has it."""
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA") or home / "AppData/Roaming") / "tehl"
    if sys.platform == "darwin":
        return home / "Library/Application Support/tehl"
    return Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config") / "tehl"


@cache
def _read(path: Path) -> dict[str, Named]:
    return _entries(path)


def _entries(path: Path) -> dict[str, Named]:
    """Return the entries of a file by name; raise ValueError if it is not a library."""
    try:
        text = path.read_bytes()
        content = tomllib.loads(text.decode(encoding_of(text[:2])))
    except (OSError, ValueError) as error:
        raise ValueError(f"cannot be looked up: {path} is not a TOML file ({error})") from None
    sources = content.pop(_SOURCES, {})
    for name, table in content.items():
        if not isinstance(table, Mapping):
            raise ValueError(f"cannot be looked up: {path}: {name} is not a table, write [{name}]")
    try:
        return {name: _entry(path, name, table, sources) for name, table in content.items()}
    except (AttributeError, TypeError):
        raise ValueError(
            f"cannot be looked up: {path}: sources and evidence are tables of texts, aliases a list"
        ) from None


def _entry(path: Path, name: str, table: dict[str, Any], sources: Mapping[str, str]) -> Named:
    evidence: dict[str, tuple[str, str, str]] = {}
    for keys, words in table.get("evidence", {}).items():
        kind, span, source = (part.strip(" ,") for part in f"{words},,".split(",", 2))
        evidence |= dict.fromkeys(keys.split(), (kind, span, sources.get(source, source)))
    values = {key: value for key, value in table.items() if key not in _OWN_KEYS}
    source = table.get("source") or _summary(evidence)
    return Named(
        table={"name": name} | values | ({"source": source} if source else {}),
        aliases=tuple(table.get("aliases", ())),
        family=table.get("family", ""),
        evidence=evidence,
        path=path,
    )


def _summary(evidence: Mapping[str, tuple[str, str, str]]) -> str:
    """Return the evidence as one text, in which each source stands once."""
    known: dict[str, dict[str, list[str]]] = {}
    for key, (kind, span, source) in evidence.items():
        known.setdefault(source, {}).setdefault(f"({kind}, {span})", []).append(key)
    return "; ".join(
        ", ".join(f"{', '.join(keys)} {how}" for how, keys in numbers.items())
        + (f": {source}" if source else "")
        for source, numbers in known.items()
    )


def _over(base: Mapping[str, Any], stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table with stated keys in place of its own, key by key unless its law differs."""
    found = {key: value for key, value in base.items() if _RIVALS.get(key) not in stated}
    for key, value in stated.items():
        old = base.get(key)
        found[key] = value
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            law = old.get("law")
            found[key] = _over(old, value) if value.get("law", law) == law else value
    return found


def _constants(stated: Mapping[str, Any], path: str = "") -> Iterable[str]:
    """Yield the paths of the numbers that a table states."""
    for key, value in stated.items():
        if isinstance(value, Mapping):
            yield from _constants(value, f"{path}{key}.")
        elif key not in _CONDITIONS:
            yield f"{path}{key}"


def _any_case(letter: str) -> str:
    return f"[{letter}{letter.upper()}]" if letter.isalpha() else letter


@lru_cache(maxsize=2048)  # all names of a library, for each that is looked up
def _plain(name: str) -> str:
    """Return a name without what people write differently: capitals, blanks, hyphens, dots."""
    return re.sub(_SEPARATORS, "", name.lower())
