"""Case files: TOML in, problem and options out."""

import os
import re
import stat
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError, create_model

from tehl.base.atomic import shortened
from tehl.base.encoding import encoding_of
from tehl.base.errors import InputError
from tehl.base.keys import field_at, models_at
from tehl.base.lists import plain_value
from tehl.base.mistakes import describe
from tehl.base.units import Quantity
from tehl.base.wording import short, shown
from tehl.contact.materials import SOLIDS
from tehl.contact.options import NUMERICS, Options, check_nodes
from tehl.contact.problem import ContactProblem
from tehl.estimate.settled import settled
from tehl.lubricant.fluid import OILS
from tehl.roughness import Map, Sum

if TYPE_CHECKING:
    from tehl.result.solution import Settings

_LONG_KEY = re.compile(r"(?m)^[\s\[]*(?:[^\s.,=#]+\s*\.\s*){100}")
"""A key of more than a hundred parts."""
_LARGEST_CASE = 10**6
"""Bytes of a case file."""
_MOST_KEYS = 8
"""Parts of the key path of an override."""
REPLACED = {"points": "error", "error": "points"}
"""Keys that a change of another one removes: nodes and error exclude each other."""
_LIBRARIES = {"lubricant": OILS.key, "material": SOLIDS.key}
"""Keys whose value may be a name, and the key that starts from this name in a table."""
Model = TypeVar("Model", bound=BaseModel)


def read_case_and_options(
    path: str | Path, overrides: Sequence[str] = ()
) -> tuple[ContactProblem, Options]:
    """Return problem and numerical options of a case file: see `tehl.api.problem`."""
    try:
        tables = toml_tables(Path(path))
        for override in overrides:
            tables = overridden(tables, override)
        return case_from_tables(tables, Path(path).parent)
    except InputError as error:
        raise InputError(f"{shortened(path)}: {error}") from error
    except RecursionError:
        raise InputError(f"{shortened(path)}: nested too deeply") from None


def case_from_tables(
    tables: Mapping[str, Any], folder: Path | None = None
) -> tuple[ContactProblem, Options]:
    """Return problem and options of the tables of a case: see `tehl.api.problem`."""
    if "axes" in tables:
        raise InputError("is a study, not a case: solve it with tehl study")
    physics = {key: value for key, value in tables.items() if key != NUMERICS}
    problem = _validated(ContactProblem, physics, prefix="", folder=folder)
    _check_maps(problem)
    options = _validated(Options, tables.get(NUMERICS, {}), prefix=NUMERICS)
    check_nodes(options)
    settled(problem, options)  # raises where they do not suit the shape of the contact
    return problem, options


def _validated(
    model: type[Model], data: object, *, prefix: str, folder: Path | None = None
) -> Model:
    try:
        return model.model_validate(data, context={"folder": folder})
    except ValidationError as error:
        raise InputError(describe(error, data, model, prefix)) from error


def _check_maps(problem: ContactProblem) -> None:
    """Raise if the file of a measured surface cannot be read; the message names its key."""
    stated: dict[str, object] = {"asperities.map": getattr(problem.asperities, "map", None)}
    for name in ("surface_1.roughness", "surface_2.roughness"):
        rough = getattr(problem, name.partition(".")[0]).roughness
        parts = rough.parts if isinstance(rough, Sum) else ()
        stated |= {name: rough} | {f"{name}.{n}": part for n, part in enumerate(parts)}
    for name, surface in stated.items():
        if isinstance(surface, Map):
            try:
                surface.stamp  # noqa: B018 (raises)
            except InputError as error:
                raise InputError(f"{name}.file: {error}") from None


def case_schema() -> dict[str, Any]:
    """Return the JSON schema of a case file, for editors."""
    case = create_model("Case", __base__=ContactProblem, numerics=(Options, Options()))
    schema = case.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["description"] = "A case file of tehl; numbers are SI, strings carry units."
    return schema


def toml_tables(path: Path) -> dict[str, Any]:
    """Return the tables of a TOML file, unchecked; messages of errors do not name the file."""
    return tables_of_text(_text(path))


def tables_of_text(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text as :func:`toml_tables`."""
    # tomllib takes time and memory that grow with the square of the parts of a key
    if _LONG_KEY.search(text):
        raise InputError("nested too deeply")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax(str(error), text)) from None
    except ValueError:  # an integer of thousands of digits
        raise InputError("a number has too many digits") from None
    except RecursionError:
        raise InputError("nested too deeply") from None


def _text(path: Path) -> str:
    """Return the text of a case file, which may come through an unnamed pipe."""
    try:
        mode = path.stat().st_mode
        named_pipe = stat.S_ISFIFO(mode) and Path(os.path.realpath(path)).exists()
        if named_pipe or stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISSOCK(mode):
            raise InputError("not a regular file, so not a case file")
        with path.open("rb") as file:
            content = file.read(_LARGEST_CASE + 1)
    except FileNotFoundError:
        raise InputError("case file does not exist") from None
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})") from None
    return text_of(content)


def text_of(content: bytes) -> str:
    """Return the text of the content of a case file; an InputError if it is not one."""
    if len(content) > _LARGEST_CASE:
        raise InputError(f"larger than {_LARGEST_CASE // 10**6} MB, so not a case file")
    try:
        return content.decode(encoding_of(content))
    except UnicodeDecodeError:
        raise InputError(
            "not a text file in UTF-8 or UTF-16; if it is a case file, save it as UTF-8"
        ) from None


def _syntax(message: str, text: str) -> str:
    """Return the error of the TOML parser with the line it is about."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)", message)
    lines = text.split("\n")
    number = int(place[1]) if place and place[1] else len(text.rstrip("\n").split("\n"))
    reason = message[: place.start()] if place else message
    line = lines[number - 1].strip()
    remedy = _remedy(line) or short(reason, 100)
    return f"line {number}: {short(repr(line), 60)} is not valid TOML: {remedy}"


def _remedy(line: str) -> str:
    """Return how to write a line with one of the usual mistakes; empty if it has none of them."""
    key, _, value = (part.strip() for part in line.partition("#")[0].partition("="))
    if re.search("[“”„‘’«»]", value):
        return 'write straight quotes "'
    if re.fullmatch(r"[+-]?\d+,\d+", value):
        return "write a decimal point in place of the comma"
    if re.fullmatch(r"[\w.+-][^=\"'\[{]*", value) and plain_value(value) == value:
        return f'write texts and numbers with units in quotes, {key} = "{value}"'
    return ""


def changed(tables: Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a copy of tables with another value at a path.

    Parameters
    ----------
    tables : mapping
        Tables of a case.
    path : str
        Dotted path; a name on the way, such as that of an oil, becomes a table that starts from it.
    value
        The value; ``False`` removes the key, unless it is a switch.

    Raises
    ------
    InputError
        If the path goes through a key that is not a table.
    """
    removes = value is False and not _is_switch(path)
    return _changed(tables, [part.strip() for part in path.split(".")], value, removes=removes)


def _changed(
    tables: Mapping[str, Any], keys: Sequence[str], value: Any, *, removes: bool
) -> dict[str, Any]:
    (key, *deeper), after = keys, dict(tables)
    if removes and key not in after:
        return after
    if deeper:
        below = after.get(key, {})
        if isinstance(below, str) and key in _LIBRARIES:
            below = {_LIBRARIES[key]: below}  # the table that starts from this name
        if not isinstance(below, Mapping):
            raise InputError(f"{'.'.join(keys)} goes through {short(key)}, which is not a table")
        after[key] = _changed(below, deeper, value, removes=removes)
    elif removes:
        after.pop(key)
    else:
        after[key] = value
        after.pop(REPLACED.get(key, ""), None)
    return after


def _is_switch(path: str) -> bool:
    """Return whether the value of a key may be false."""
    root, _, inside = path.partition(".")
    model, keys = (Options, inside) if root == NUMERICS else (ContactProblem, path)
    *above, last = keys.split(".")
    field = field_at(models_at(model, tuple(above))[-1], last)
    return field is not None and bool in (field.annotation, *get_args(field.annotation))


def found_at(problem: ContactProblem, options: Options, path: str) -> tuple[Any, Quantity | None]:
    """Return the validated value at a path of a case, and its kind if it is a quantity.

    Both are None where the case has no such place, as another law was chosen.
    """
    keys = [part.strip() for part in path.split(".")]
    node: Any = problem
    if keys[0] == NUMERICS:
        node, keys = options, keys[1:]
    kind = None
    for key in keys:
        if not isinstance(node, BaseModel) or key not in type(node).model_fields:
            return None, None
        field = type(node).model_fields[key]
        kind = next(_kinds([*field.metadata, field.annotation]), None)
        node = getattr(node, key)
    return node, kind


def _kinds(notes: Iterable[Any]) -> Iterator[Quantity]:
    """Yield the quantities among the metadata of a field and in its annotation."""
    for note in notes:
        if isinstance(note, Quantity):
            yield note
        else:
            yield from _kinds(get_args(note))


def with_settings(options: Options, settings: "Settings") -> Options:
    """Return options with the numerical settings of a hint.

    Parameters
    ----------
    options : Options
        Not changed.
    settings : Settings
        Values by key path, such as ``numerics.points``; paths of other tables have no effect.

    Raises
    ------
    InputError
        If a value is invalid.
    """
    tables: dict[str, Any] = {NUMERICS: options.model_dump(exclude_defaults=True)}
    for path, value in settings.items():
        tables = changed(tables, path, value)
    return _validated(Options, tables[NUMERICS], prefix=NUMERICS)


def overridden(tables: Mapping[str, Any], override: str) -> dict[str, Any]:
    """Return a copy of the tables of a case with one override.

    Parameters
    ----------
    tables : mapping
        Parsed case; missing tables on the path are added.
    override : str
        ``key.path=value``; the value ``false`` removes a key that is not a switch.

    Raises
    ------
    InputError
        If the override is invalid; the message has the form that is expected.
    """
    key, equals, text = (part.strip() for part in override.partition("="))
    names = key.split(".")
    expected = ""
    if not equals or not all(names):
        expected = "expected key.path=value, such as numerics.points=513"
    elif any("\ud800" <= letter <= "\udfff" for letter in override):
        expected = "not UTF-8 text"
    elif len(names) > _MOST_KEYS:
        expected = f"{len(names)} parts; expected at most {_MOST_KEYS}"
    if expected:
        raise InputError(f"invalid override {shown(override)}: {expected}")
    try:
        return changed(tables, key, plain_value(text))
    except InputError as error:
        raise InputError(f"invalid override {shown(override)}: {error}") from None
