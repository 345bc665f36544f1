"""Case files: TOML in, problem and options out, and every mistake told in one sentence."""

import difflib
import json
import os
import re
import stat
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError, create_model
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from tehl.errors import InputError
from tehl.io.atomic import shortened
from tehl.io.field_words import example, limits_in_words
from tehl.io.law_words import chosen_law, not_of_this_law, tags, whole_table
from tehl.options import Options
from tehl.problem import ContactProblem
from tehl.units import Quantity

_NUMERICS = "numerics"
_LARGEST = 10**6
"""Bytes of a case file."""
_DEEPEST = 8
"""Parts of the key path of a change."""
Model = TypeVar("Model", bound=BaseModel)


def read_case(path: str | Path) -> ContactProblem:
    """Return the problem of a case file; its ``[numerics]`` are checked and left.

    Raises
    ------
    InputError
        If the file is no case; the message names key, value, unit and what would be right.
    """
    problem, _ = read_case_and_options(path)
    return problem


def read_case_and_options(
    path: str | Path, overrides: Sequence[str] = ()
) -> tuple[ContactProblem, Options]:
    """Return problem and numerical options of a case file.

    Parameters
    ----------
    path : str or Path
        TOML file.
    overrides : sequence of str
        Changes such as ``"numerics.points=513"`` or ``"contact.load=100 N"``, made before
        anything is checked.

    Raises
    ------
    InputError
        If the file or a change is no case; the message names key, value, unit and what would be
        right.
    """
    try:
        tables = toml_tables(Path(path))
        for override in overrides:
            change(tables, override)
        return case_from_tables(tables, Path(path).parent)
    except InputError as error:
        raise InputError(f"{shortened(path)}: {error}") from error
    except RecursionError:
        raise InputError(f"{shortened(path)}: is nested too deep for a case") from None


def case_from_tables(
    tables: Mapping[str, Any], folder: Path | None = None
) -> tuple[ContactProblem, Options]:
    """Return problem and options of the parsed tables of a case.

    Parameters
    ----------
    tables : mapping
        As a case file has them.
    folder : Path
        Where relative paths of measured surfaces begin; the working directory if left out.

    Raises
    ------
    InputError
        As :func:`read_case`.
    """
    question = {key: value for key, value in tables.items() if key != _NUMERICS}
    problem = _validated(ContactProblem, question, prefix="", folder=folder)
    options = _validated(Options, tables.get(_NUMERICS, {}), prefix=_NUMERICS)
    return problem, options


def case_schema() -> dict[str, Any]:
    """Return the JSON schema of a case file, for editors."""
    case = create_model("Case", __base__=ContactProblem, numerics=(Options, Options()))
    schema = case.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["description"] = "A case file of tehl; numbers are SI, strings carry units."
    return schema


def describe(error: ValidationError, data: object, prefix: str = "") -> str:
    """Return the first mistake of a validation in one sentence.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    data : object
        What it was given.
    prefix : str
        Key path of ``data`` in its file.
    """
    model = Options if error.title == Options.__name__ else ContactProblem
    first = min(error.errors(include_url=False), key=_rank)
    path = _path(first, data)
    mistake = _Mistake(
        name=".".join(_key(part) for part in ((prefix, *path) if prefix else path)),
        path=path,
        value=first["input"],
        error=first,
        models=_models_at(model, path),
        table=_table_at(data, path[:-1]),
    )
    return _TELL.get(first["type"], _pydantic_words)(mistake)


# ---- reading


def toml_tables(path: Path) -> dict[str, Any]:
    """Return the tables of a file in TOML, unchecked.

    Raises
    ------
    InputError
        If it cannot be read as TOML; the message does not name the file.
    """
    text = _text(path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax(str(error), text)) from None
    except ValueError:  # what Python says of an integer of thousands of digits
        raise InputError("a number has too many digits") from None


def _text(path: Path) -> str:
    """Return the text of a case file, which may come through a pipe without a name."""
    try:
        mode = path.stat().st_mode
        named = stat.S_ISFIFO(mode) and Path(os.path.realpath(path)).exists()
        if named or stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISSOCK(mode):
            raise InputError("is no file, so no case file")
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
    except FileNotFoundError:
        raise InputError("there is no such case file") from None
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})") from None
    if len(content) > _LARGEST:
        raise InputError(f"is larger than {_LARGEST // 10**6} MB, so no case file")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("is no text file in UTF-8, so no case file") from None


def _syntax(message: str, text: str) -> str:
    """Return the complaint of the TOML reader with the line that it is about."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", message)
    lines = text.split("\n")
    number = int(place[1]) if place and place[1] else len(text.rstrip("\n").split("\n"))
    what = message[: place.start()] if place else message
    line = _short(repr(lines[number - 1].strip()), 60)
    return f"line {number}: {line} is no TOML: {_short(what, 100)}"


def change(tables: dict[str, Any], override: str) -> None:
    """Make one change ``key.path=value`` in place.

    Raises
    ------
    InputError
        If that is no change.
    """
    key, equals, text = (part.strip() for part in override.partition("="))
    names, shown = key.split("."), _shown(override)
    if not equals or not all(names):
        raise InputError(f"{shown} is no change: give key.path=value, numerics.points=513")
    if any("\ud800" <= letter <= "\udfff" for letter in override):
        raise InputError(f"{shown} is no text in UTF-8")
    if len(names) > _DEEPEST:
        raise InputError(f"{shown} changes no key of a case: it has {len(names)} parts")
    node = tables
    for name in names[:-1]:
        node = node.setdefault(name, {})
        if not isinstance(node, dict):
            raise InputError(f"{shown} changes a key of {_short(name, 40)}, which is no table")
    node[names[-1]] = plain_value(text)


def plain_value(text: str) -> object:
    """Return a value as TOML reads it, and what is no TOML as a word."""
    try:
        tables = tomllib.loads(f"value = {text}")
    except ValueError:
        return text
    return tables["value"] if len(tables) == 1 else text


def _validated(
    model: type[Model], data: object, *, prefix: str, folder: Path | None = None
) -> Model:
    try:
        return model.model_validate(data, context={"folder": folder})
    except ValidationError as error:
        raise InputError(describe(error, data, prefix)) from error


# ---- telling mistakes

_NO_TABLE = ("model_type", "model_attributes_type", "dict_type")
_RANKS = {"extra_forbidden": 0, "value_error": 1, "missing": 2, "literal_error": 4}


def _rank(error: ErrorDetails) -> tuple[int, int]:
    """Order mistakes: those that explain others first, those of an unused alternative last."""
    kind = error["type"]
    if kind in _NO_TABLE and len(error["loc"]) == 1:  # deeper ones may be of a union
        return 0, 0
    if kind == "literal_error" and isinstance(error["input"], dict | list):
        return 6, 0
    return _RANKS.get(kind, 5 if kind.endswith("_type") else 3), -len(error["loc"])


def _path(error: ErrorDetails, data: object) -> tuple[str | int, ...]:
    """Return the keys that lead to a mistake, without the labels of unions."""
    path: list[str | int] = []
    node: Any = data
    for part in error["loc"]:
        in_table = isinstance(node, Mapping) and part in node
        in_list = isinstance(node, list | tuple) and isinstance(part, int) and part < len(node)
        if in_table or in_list:
            path.append(part)
            node = node[part]
    if error["type"] == "missing":
        path.append(error["loc"][-1])
    return tuple(path)


def _models(annotation: object) -> Iterator[type[BaseModel]]:
    """Yield the models an annotation may hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models(argument)


def _field(models: Sequence[type[BaseModel]], key: str | int) -> FieldInfo | None:
    found = (model.model_fields[key] for model in models if key in model.model_fields)
    return next(found, None) if isinstance(key, str) else None


def _models_at(root: type[BaseModel], path: tuple[str | int, ...]) -> list[list[type[BaseModel]]]:
    """Return the possible models of each step of ``path``, the root first."""
    steps = [[root]]
    for key in path:
        field = _field(steps[-1], key)
        inside = steps[-1] if isinstance(key, int) else []
        steps.append(list(_models(field.annotation)) if field else inside)
    return steps


def _table_at(data: object, path: tuple[str | int, ...]) -> Any:
    """Return what was given at ``path``."""
    node: Any = data
    for part in path:
        node = node[part]
    return node


@dataclass(frozen=True, kw_only=True, slots=True)
class _Mistake:
    """One mistake with what is known about it.

    ``models`` are the possible models of each step of ``path``, the root first; ``table`` is what
    was given where the last key of ``path`` belongs.
    """

    name: str
    path: tuple[str | int, ...]
    value: object
    error: ErrorDetails
    models: list[list[type[BaseModel]]]
    table: Any


def _unknown_key(mistake: _Mistake) -> str:
    law = chosen_law(mistake.models[-2], mistake.table)
    keys = _keys([law] if law else mistake.models[-2], mistake.path)
    word = str(mistake.path[-1])
    if law is not None and any(word in model.model_fields for model in mistake.models[-2]):
        return not_of_this_law(mistake.name, law, mistake.table)
    near = difflib.get_close_matches(word, keys, n=1, cutoff=0.55)
    alike = [path for path in _key_paths() if path.split(".")[-1] == word]
    elsewhere = alike if not near and len(word) > 1 else []
    suggestion = f"did you mean {elsewhere[0]}?" if elsewhere else _suggest(word, keys)
    return f"{mistake.name} is no key of a case: {suggestion}"


def _missing(mistake: _Mistake) -> str:
    if isinstance(mistake.path[-1], int):
        name = mistake.name.rpartition(".")[0]
        return f"{name} = {_shown(mistake.value)} must have two numbers"
    laws = [tag for model in mistake.models[-1] for tag in tags(model)]
    if laws:
        return f"{mistake.name} is missing: give a table with law, one of {', '.join(laws)}"
    return f"{mistake.name} is missing{_wanted(_field(mistake.models[-2], mistake.path[-1]))}"


def _law_missing(mistake: _Mistake) -> str:
    key = _discriminator(mistake)
    known = [tag for model in mistake.models[-1] for tag in tags(model, key)]
    if isinstance(mistake.path[-1], int):  # a sum within a sum
        known = [tag for tag in known if tag != "sum"]
    return f"{mistake.name}.{key} is missing: known are {', '.join(known)}"


def _law_unknown(mistake: _Mistake) -> str:
    tag, tags = mistake.error["ctx"]["tag"], mistake.error["ctx"]["expected_tags"]
    known = re.findall(r"'([^']+)'", tags)
    key = _discriminator(mistake)
    return f"{mistake.name}.{key} = {_shown(tag)} is not known: {_suggest(str(tag), known)}"


def _discriminator(mistake: _Mistake) -> str:
    """Return the key that chooses among several tables: law or type."""
    return str(mistake.error["ctx"]["discriminator"]).strip("'")


def _word_unknown(mistake: _Mistake) -> str:
    known = [
        word.strip("'") for word in re.findall(r"'[^']+'|\d+", mistake.error["ctx"]["expected"])
    ]
    suggestion = _suggest(str(mistake.value), known)
    keys = [key for model in mistake.models[-1] for key in model.model_fields]
    table = f", or a table with {' and '.join(keys)}" if keys else ""
    return f"{mistake.name} = {_shown(mistake.value)} is not known: {suggestion}{table}"


def _own_words(mistake: _Mistake) -> str:
    """Join a message of our own models to the key it is about."""
    message = str(mistake.error["ctx"]["error"])
    if not isinstance(mistake.value, Mapping):
        return f"{mistake.name} = {_shown(mistake.value)} {message}"
    if not mistake.name:
        return message
    first = re.split(r"[ .]", message, maxsplit=1)[0]
    about_a_key = first in mistake.value or _field(mistake.models[-1], first) is not None
    return f"{mistake.name}{'.' if about_a_key else ' '}{message}"


def _pydantic_words(mistake: _Mistake) -> str:
    words = mistake.error["msg"]
    if mistake.error["type"] in _NO_TABLE:
        words = _no_table(mistake)
    elif mistake.error["type"] in _OUTSIDE:
        words = _within(mistake) or words
    for theirs, ours in _WORDING:
        words = re.sub(theirs, ours, words)
    return f"{mistake.name} = {_shown(mistake.value)} {words}"


def _no_table(mistake: _Mistake) -> str:
    if str(mistake.value).startswith("{"):
        return f"is no table: {_QUOTES}"
    laws = (model for model in mistake.models[-1] if mistake.value in tags(model))
    return "must be a table" + "".join(f" such as {whole_table(law, {})}" for law in laws)


def _within(mistake: _Mistake) -> str:
    """Return between which numbers a value must lie, nothing when there are no limits."""
    steps = len(mistake.path) - (1 if isinstance(mistake.path[-1], int) else 0)
    field = _field(mistake.models[steps - 1], mistake.path[steps - 1])
    return "" if field is None else limits_in_words(field)


_OUTSIDE = (
    "greater_than",
    "greater_than_equal",
    "less_than",
    "less_than_equal",
    "int_type",
    "int_parsing",
    "int_from_float",
    "int_parsing_size",
)
_QUOTES = 'its words and quantities need double quotes, { law = "eyring", stress = "5 MPa" }'
_WORDING = (
    ("Input should be", "must be"),
    ("Tuple should have", "must have"),
    ("greater than or equal to", "at least"),
    ("less than or equal to", "at most"),
    ("a valid integer", "a whole number"),
    ("a valid tuple", "a list of two numbers"),
    ("valid ", ""),
    (", unable to parse .*|, got a number with a fractional part", ""),
    ("items after validation.*", "numbers"),
)
_TELL = {
    "extra_forbidden": _unknown_key,
    "missing": _missing,
    "union_tag_not_found": _law_missing,
    "union_tag_invalid": _law_unknown,
    "literal_error": _word_unknown,
    "value_error": _own_words,
}


def _keys(models: list[type[BaseModel]], path: tuple[str | int, ...]) -> list[str]:
    keys = [key for model in models for key in model.model_fields]
    return [*dict.fromkeys(keys), *([_NUMERICS] if len(path) == 1 and "contact" in keys else [])]


def _key_paths() -> Iterator[str]:
    """Yield the path of every key of a case."""
    yield from _paths_below(ContactProblem, "")
    yield from _paths_below(Options, f"{_NUMERICS}.")


def _paths_below(model: type[BaseModel], prefix: str) -> Iterator[str]:
    for key, field in model.model_fields.items():
        yield f"{prefix}{key}"
        for deeper in _models(field.annotation):
            yield from _paths_below(deeper, f"{prefix}{key}.")


def _suggest(word: str, known: list[str]) -> str:
    close = difflib.get_close_matches(word[:100], known, n=1, cutoff=0.55)
    return f"did you mean {close[0]}?" if close else f"known are {', '.join(known)}"


def _wanted(field: FieldInfo | None) -> str:
    if field is None or (shown := example(field)) is None:
        return ""
    kinds = [note.name for note in field.metadata if isinstance(note, Quantity)]
    return f": give {kinds[0] if kinds else 'a number'} such as {shown}"


def _key(part: str | int) -> str:
    """Return a part of a key path as the file would show it, shortened."""
    text = str(part)
    bare = re.fullmatch(r"[A-Za-z0-9_-]+", text)
    return _short(text if bare else json.dumps(text), 60)


def _shown(value: object) -> str:
    """Return a value as the file would show it, shortened."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except RecursionError:
        text = "a table or list of many floors"
    except (TypeError, ValueError):
        text = _plain(value)
    return _short("".join(c if c.isprintable() else "?" for c in text), 60)


def _plain(value: object) -> str:
    """Return a value that JSON does not know as text."""
    try:
        return str(value)
    except ValueError:  # what Python says of an integer of thousands of digits
        return "a number of thousands of digits"


def _short(text: str, length: int) -> str:
    return text if len(text) <= length else f"{text[: length - 3]}..."
