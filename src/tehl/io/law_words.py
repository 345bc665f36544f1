"""What a law takes, in words: for who changes the law of a table and leaves the keys of another."""

import json
from collections.abc import Mapping, Sequence
from typing import Literal, get_args, get_origin

from pydantic import BaseModel

from tehl.io.field_words import example


def tags(model: type[BaseModel], key: str = "law") -> tuple[str, ...]:
    """Return the words under ``key`` that choose a law; none for a model that is no law."""
    law = model.model_fields.get(key)
    annotation = law.annotation if law else None
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def chosen_law(models: Sequence[type[BaseModel]], table: object) -> type[BaseModel] | None:
    """Return which of several laws a table states, None where there is no choice or no law."""
    if len(models) < 2 or not isinstance(table, Mapping):
        return None
    return next((model for model in models if table.get("law") in tags(model)), None)


def keys_of(model: type[BaseModel]) -> list[str]:
    """Return the keys of a law besides the word itself."""
    return [key for key in model.model_fields if key != "law"]


def whole_table(model: type[BaseModel], table: Mapping[str, object]) -> str:
    """Return a table of a law in TOML: what ``table`` states of it, and examples of what it lacks.

    Parameters
    ----------
    model : type
        The law.
    table : mapping
        What the case states, keys of other laws among it.
    """
    fields = {key: model.model_fields[key] for key in keys_of(model)}
    kept = any(key in table and not field.is_required() for key, field in fields.items())
    entries = [f'law = "{tags(model)[0]}"']
    for key, field in fields.items():
        wanted = field.is_required() or (field.examples and not kept)
        if key in table:
            entries.append(f"{key} = {json.dumps(table[key], ensure_ascii=False, default=str)}")
        elif wanted and (value := example(field)) is not None:
            entries.append(f"{key} = {value}")
    return "{ " + ", ".join(entries) + " }"


def listed(words: Sequence[str]) -> str:
    """Return words as a sentence lists them: ``a, b and c``."""
    *first, last = words or ("no other key",)
    return f"{', '.join(first)} and {last}" if first else last


def not_of_this_law(name: str, model: type[BaseModel], table: Mapping[str, object]) -> str:
    """Return what is wrong with a key that belongs to another law.

    Parameters
    ----------
    name : str
        Path of the key.
    model : type
        The law that the table states.
    table : mapping
        The table.
    """
    where = name.rpartition(".")[0]
    return (
        f'{name} is no key of law = "{tags(model)[0]}", which takes {listed(keys_of(model))}: '
        f"replace the whole table, {where} = {whole_table(model, table)}"
    )
