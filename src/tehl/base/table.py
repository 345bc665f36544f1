"""Tables of case and study files: constant models whose mistakes are one sentence."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import BaseModel, ConfigDict, ValidationError, ValidationInfo

from tehl.base.errors import InputError
from tehl.base.mistakes import describe

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)  # pydantic does not export it


class _OneSentence(ModelMetaclass):
    """Class of tables: a mistake of a call in Python is an InputError of one sentence."""

    def __call__(self, *args: Any, **values: Any) -> Any:
        try:
            return super().__call__(*args, **values)
        except ValidationError as error:
            model: Any = self
            raise InputError(describe(error, values, model, model.__name__)) from None


class Table(BaseModel, metaclass=_OneSentence):
    """Base of the tables of a case or study file: constant, without unknown keys."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", defer_build=True, use_attribute_docstrings=True
    )

    other_words: ClassVar[Mapping[str, str]] = {}
    """What to write for keys that are not a misspelling of the right one."""
    synonyms: ClassVar[Mapping[str, str]] = {}
    """Other words for a key, in lower case; a key of another table has its path."""
    not_tables: ClassVar[Mapping[str, str]] = {}
    """What to write for keys whose tables are taken for a number or a word."""


def folder_of(info: ValidationInfo) -> Path | None:
    """Return the folder of the case that is validated, None if it has none."""
    context: Any = info.context
    folder = context.get("folder") if isinstance(context, dict) else None
    return None if folder is None else Path(folder)
