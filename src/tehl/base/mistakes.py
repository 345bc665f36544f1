"""The first mistake of a case in one sentence: key, value, what is wrong, what is expected."""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from tehl.base.keys import (
    COMPARISONS,
    KeyPath,
    Model,
    example,
    field_at,
    key_paths,
    limits_of,
    models_at,
    tags,
)
from tehl.base.units import Quantity, percentage
from tehl.base.wording import closest, key_text, shown, suggestion_for

AnyModel = TypeVar("AnyModel", bound=Model)

_CASE: dict[str, Model] = {}
"""Models whose keys together make a case file, by the table that holds these; "" is the file."""
_MISPLACED: list[str] = []
"""Tables of a case whose keys are stated in others by mistake."""


def part_of_case(table: str, *misplaced: str) -> Callable[[AnyModel], AnyModel]:
    """Return a decorator of a model whose keys stand in a table of the case, in the file for "".

    ``misplaced`` are tables whose keys are stated in others by mistake.
    """

    def enter(model: AnyModel) -> AnyModel:
        _CASE[table] = model
        _MISPLACED.extend(misplaced)
        return model

    return enter


class _Mistake(NamedTuple):
    """One mistake: its key path as text and as keys, and the error of pydantic.

    ``models`` are the possible models of each step of ``path``, the root first; ``table`` is the
    table of the last key of ``path``.
    """

    name: str
    path: KeyPath
    error: ErrorDetails
    models: list[list[Model]]
    table: Any

    @property
    def value(self) -> object:
        """What was given."""
        return self.error["input"]

    @property
    def stated(self) -> str:
        """Key path and value as the file would show them."""
        return f"{self.name} = {shown(self.value)}"


def describe(error: ValidationError, data: object, model: Model, prefix: str = "") -> str:
    """Return the first mistake of a validation in one sentence.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    data : object
        The input.
    model : type
        The model that was validated.
    prefix : str
        Key path of ``data`` in its file.
    """
    first = min(error.errors(include_url=False), key=_rank)
    path = _path(first, data)
    table: Any = data
    for part in path[:-1]:
        table = table[part]
    name = ".".join(key_text(part) for part in ((prefix, *path) if prefix else path))
    mistake = _Mistake(name, path, first, models_at(model, path), table)
    sentence = _SENTENCES.get(first["type"], _pydantic_sentence)
    return _of_heading(mistake) or sentence(mistake)


# ---- where the mistake is


_NOT_A_TABLE = ("model_type", "model_attributes_type", "dict_type")


_RANKS = {"extra_forbidden": 0, "value_error": 1, "missing": 2, "literal_error": 4}


def _rank(error: ErrorDetails) -> tuple[int, int]:
    """Order mistakes: causes of others first, those of unused alternatives of a union last."""
    kind = error["type"]
    if kind in _NOT_A_TABLE and len(error["loc"]) == 1:  # deeper ones may be of a union
        return 0, 0
    if kind == "literal_error" and isinstance(error["input"], dict | list):
        return 6, 0
    return _RANKS.get(kind, 5 if kind.endswith("_type") else 3), -len(error["loc"])


def _path(error: ErrorDetails, data: object) -> KeyPath:
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


# ---- one sentence per type of mistake


ALIKE = 0.72
"""Likeness of a misspelled key and the right one."""


def _unknown_key(mistake: _Mistake) -> str:
    models, word = mistake.models[-2], str(mistake.path[-1])
    law = _chosen_law(models, mistake.table)
    if law is not None and any(word in model.model_fields for model in models):
        return _key_of_another_law(mistake, law)
    known = list(dict.fromkeys(key for m in ([law] if law else models) for key in m.model_fields))
    if len(mistake.path) == 1 and any(_is_part(model, "") for model in models):
        known += filter(None, _CASE)
    suggestion = (
        _stated(models, "other_words").get(word)
        or _right_word(models, word)
        or closest(word, known, ALIKE)
        or _in_another_table(mistake, word)
        or f"known are {', '.join(known)}"
    )
    return f"{mistake.name} is not a known key; {suggestion}"


def _is_part(model: Model, table: str) -> bool:
    """Return whether a model is that of a table of the case."""
    return table in _CASE and issubclass(model, _CASE[table])


def _stated(models: Sequence[Model], what: str) -> dict[str, str]:
    """Return what the models of a table say about its keys: an attribute of all of them."""
    return {key: words for one in models for key, words in getattr(one, what, {}).items()}


def _right_word(models: Sequence[Model], word: str) -> str:
    """Return the question after the right key for another word; empty without one."""
    synonyms = _stated(models, "synonyms")
    right = (key for key, words in synonyms.items() if word.lower() in words.split())
    return "".join(f"did you mean {key}?" for key in right)


def _in_another_table(mistake: _Mistake, word: str) -> str:
    """Return the question after the only plausible table that has a key; empty without one.

    That is one within the table of the mistake, or one or two of those that `part_of_case` names.
    """
    root = mistake.models[0][0]
    if not any(_is_part(root, table) for table in _CASE) or len(word) < 2:
        return ""
    tables = tuple(f"{name}." for name in _MISPLACED)
    own = f"{mistake.name.partition('.')[0]}." if "." in mistake.name else "\n"
    paths = [
        path
        for path in _paths_of_case()
        if path.split(".")[-1] == word
        and (path.startswith(own) or (path.startswith(tables) and path.count(".") == 1))
    ]
    if not paths and own == "\n":
        paths = [
            f"{table}.{key}"
            for table in _MISPLACED
            for model in ([_CASE[table]] if table in _CASE else models_at(root, (table,))[-1])
            for key, words in getattr(model, "synonyms", {}).items()
            if word.lower() in words.split()
        ]
    is_plausible = len(paths) == 1 or (len(paths) == 2 and all(p.count(".") == 1 for p in paths))
    return f"did you mean {' or '.join(paths)}?" if is_plausible else ""


def _paths_of_case() -> dict[str, None]:
    """Return the paths of all keys of a case, those of its file first."""
    parts = sorted(_CASE.items())
    paths = (key_paths(model, f"{table}." if table else "") for table, model in parts)
    return dict.fromkeys(path for some in paths for path in some)


def _missing(mistake: _Mistake) -> str:
    if isinstance(mistake.path[-1], int):
        name = mistake.name.rpartition(".")[0]
        return f"{name} = {shown(mistake.value)}: must have two numbers"
    laws = [tag for model in mistake.models[-1] for tag in tags(model)]
    if laws:
        return f"{mistake.name} is missing; expected a table with law, one of {', '.join(laws)}"
    field = field_at(mistake.models[-2], mistake.path[-1])
    if field is None or (good := example(field)) is None:
        return f"{mistake.name} is missing"
    kinds = [note.name for note in field.metadata if isinstance(note, Quantity)]
    return f"{mistake.name} is missing; expected {(*kinds, 'a number')[0]} such as {good}"


def _discriminator_missing(mistake: _Mistake) -> str:
    key = _discriminator(mistake)
    known = [tag for model in mistake.models[-1] for tag in tags(model, key)]
    if isinstance(mistake.path[-1], int):  # a sum within a sum
        known = [tag for tag in known if tag != "sum"]
    return f"{mistake.name}.{key} is missing; known are {', '.join(known)}"


def _discriminator_unknown(mistake: _Mistake) -> str:
    tag = mistake.error["ctx"]["tag"]
    known = re.findall(r"'([^']+)'", mistake.error["ctx"]["expected_tags"])
    key = _discriminator(mistake)
    known += [word for one in mistake.models[-1] for word in tags(one, key) if word not in known]
    name = f"{mistake.name}.{key}"
    return f"{name} = {shown(tag)}: unknown; {suggestion_for(str(tag), known)}"


def _discriminator(mistake: _Mistake) -> str:
    """Return the key that chooses among several tables: law or type."""
    return str(mistake.error["ctx"]["discriminator"]).strip("'")


def _word_unknown(mistake: _Mistake) -> str:
    expected = mistake.error["ctx"]["expected"]
    known = [word.strip("'") for word in re.findall(r"'[^']+'|\d+", expected)]
    keys = [key for model in mistake.models[-1] for key in model.model_fields]
    table = f", or a table with {' and '.join(keys)}" if keys else ""
    suggestion = suggestion_for(str(mistake.value), known)
    return f"{mistake.stated}: unknown; {suggestion}{table}"


def _own_sentence(mistake: _Mistake) -> str:
    """Join an error raised by one of our models to the key it is about."""
    message = str(mistake.error["ctx"]["error"])
    if not isinstance(mistake.value, Mapping):
        return f"{mistake.stated}: {message}"
    if not mistake.name:
        return message
    first = re.split(r"[ .]", message, maxsplit=1)[0]
    about_a_key = first in mistake.value or field_at(mistake.models[-1], first) is not None
    return f"{mistake.name}{'.' if about_a_key else ' '}{message}"


def _pydantic_sentence(mistake: _Mistake) -> str:
    words = mistake.error["msg"]
    if mistake.error["type"] in _NOT_A_TABLE:
        words = _not_a_table(mistake)
    elif mistake.error["type"] in _OUTSIDE:
        words = _limits(mistake) or words
    elif mistake.error["type"] == "tuple_type" and _is_open_list(mistake):
        words = "must be a list, in square brackets"
    for theirs, ours in _WORDING:
        words = re.sub(theirs, ours, words)
    return f"{mistake.stated}: {words}"


def _is_open_list(mistake: _Mistake) -> bool:
    """Whether the value of a key is a list of any length."""
    field = field_at(mistake.models[-2], mistake.path[-1])
    kinds = [] if field is None else [field.annotation]
    for kind in kinds:  # grows
        kinds += get_args(kind)
    return Ellipsis in kinds


def _not_a_table(mistake: _Mistake) -> str:
    if str(mistake.value).startswith("{"):
        quoted = '{ law = "eyring", stress = "5 MPa" }'
        return f"not a TOML table; put words and quantities in double quotes, {quoted}"
    if mistake.path and isinstance(mistake.value, int | float | str):
        own = _stated(mistake.models[-2], "not_tables").get(str(mistake.path[-1]))
        if own is not None:
            return own
    models = mistake.models[-1]
    laws = [model for model in models if tags(model)]
    if laws:
        chosen = next((law for law in laws if mistake.value in tags(law)), laws[0])
        return f"must be a table such as {_whole_table(chosen, {})}"
    fields = (pair for model in models for pair in model.model_fields.items())
    keys = (f"{key} = {good}" for key, field in fields if (good := example(field)))
    key = next(keys, "its keys")
    words = f"must be a table: write [{mistake.name}] on a line of its own and {key} below it"
    parent = field_at(mistake.models[-2], mistake.path[-1]) if mistake.path else None
    required = [field.is_required() for model in models for field in model.model_fields.values()]
    if parent is None or parent.is_required() or any(required):
        return words
    return f"{words}, or {{}} in place of {shown(mistake.value)} for its defaults"


def _of_heading(mistake: _Mistake) -> str:
    """Return what is wrong with a table in place of a number; nothing of another mistake."""
    if not isinstance(mistake.value, Mapping) or "." not in mistake.name:
        return ""
    if mistake.error["type"] in ("missing", "extra_forbidden"):  # of a key in this table
        return ""
    key, field = mistake.path[-1], field_at(mistake.models[-2], mistake.path[-1])
    if field is None or mistake.models[-1] or (good := example(field)) is None:
        return ""
    parent = mistake.name.rpartition(".")[0]
    return f"{mistake.name} is a number, not a table: write {key} = {good} below [{parent}]"


def _limits(mistake: _Mistake) -> str:
    """Return the numbers between which a value must lie; empty without limits."""
    steps = len(mistake.path) - (1 if isinstance(mistake.path[-1], int) else 0)
    field = field_at(mistake.models[steps - 1], mistake.path[steps - 1])
    found = {} if field is None else dict(limits_of(field.annotation, field.metadata))
    if found.pop("whole", False) and {"ge", "le"} <= found.keys():
        return f"must be a whole number from {found['ge']} to {found['le']}"
    is_share, value = found.pop("is_share", False), mistake.value
    write = percentage if is_share else "{:g}".format
    words = [f"{text} {write(found[name])}" for name, text in COMPARISONS.items() if name in found]
    meant = is_share and isinstance(value, int | float) and 1.0 <= value <= 100.0
    better = f'; did you mean "{value:g} %"?' if meant else ""
    return f"must be {' and '.join(words)}{better}" if words else ""


_OUTSIDE = (
    *("greater_than", "greater_than_equal", "less_than", "less_than_equal"),
    *("int_type", "int_parsing", "int_from_float", "int_parsing_size"),
)
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
    ("1 item after validation.*", "one number"),
)
_SENTENCES = {
    "extra_forbidden": _unknown_key,
    "missing": _missing,
    "union_tag_not_found": _discriminator_missing,
    "union_tag_invalid": _discriminator_unknown,
    "literal_error": _word_unknown,
    "value_error": _own_sentence,
}


# ---- laws, which are tables chosen by their key ``law``


def _chosen_law(models: Sequence[Model], table: object) -> Model | None:
    """Return which of several laws a table states, None without a choice."""
    if len(models) < 2 or not isinstance(table, Mapping):
        return None
    return next((model for model in models if table.get("law") in tags(model)), None)


def _key_of_another_law(mistake: _Mistake, law: Model) -> str:
    *first, last = [key for key in law.model_fields if key != "law"] or ["no other key"]
    keys = f"{', '.join(first)} and {last}" if first else last
    where = mistake.name.rpartition(".")[0]
    return (
        f'{mistake.name} is not a key of law = "{tags(law)[0]}", which takes {keys}; '
        f"replace the whole table, {where} = {_whole_table(law, mistake.table)}"
    )


def _whole_table(law: Model, table: Mapping[str, object]) -> str:
    """Return a law in TOML with the values that ``table`` states, and examples of missing ones."""
    fields = {key: field for key, field in law.model_fields.items() if key != "law"}
    kept = any(key in table and not field.is_required() for key, field in fields.items())
    entries = [f'law = "{tags(law)[0]}"']
    for key, field in fields.items():
        wanted = field.is_required() or (field.examples and not kept)
        if key in table:
            entries.append(f"{key} = {json.dumps(table[key], ensure_ascii=False, default=str)}")
        elif wanted and (value := example(field)) is not None:
            entries.append(f"{key} = {value}")
    return "{ " + ", ".join(entries) + " }"
