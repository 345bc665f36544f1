"""Laws of other packages, which register them by name in the entry-point group ``tehl.laws``.

A case states that name as ``law``, and a result file stores it with the constants. A name of this
package's own laws is never looked up.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, get_args

from pydantic import BaseModel, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from tehl.lubricant.law import Law

GROUP = "tehl.laws"


@dataclass(frozen=True, slots=True)
class RegisteredLaws:
    """Annotation of a union of laws: those of other packages belong to it too.

    Attributes
    ----------
    kind : type
        Base class of the laws.
    check : callable
        Raises on a law that is not of use.
    """

    kind: type[Law]
    check: Callable[[Any], None]

    @property
    def models(self) -> tuple[type[BaseModel], ...]:
        """Classes of all packages, for messages on a case; without those that cannot be loaded."""
        found: list[type[BaseModel]] = []
        for entry in entry_points(group=GROUP):
            try:
                found.extend(model for model, _ in _registered(entry.name))
            except ValueError:
                continue
        return tuple(model for model in found if issubclass(model, self.kind))

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Return the schema of the union, which also takes and stores registered laws."""
        own = {word for model in get_args(source) for word in tags(model)}

        def validated(value: Any, inside: Callable[[Any], Any]) -> Any:
            name = value.get("law") if isinstance(value, Mapping) else getattr(value, "law", None)
            if not isinstance(name, str) or name in own:
                return inside(value)
            for model, owner in _registered(name):
                if issubclass(model, self.kind):
                    return self._checked(model.model_validate(value), _whose(name, owner))
            return value if isinstance(value, self.kind) else inside(value)

        return core_schema.no_info_wrap_validator_function(
            validated, handler(source), serialization=core_schema.simple_ser_schema("any")
        )

    def _checked(self, law: BaseModel, whose: str) -> BaseModel:
        try:
            self.check(law)
        except Exception as error:  # the code of a user raises anything
            raise ValueError(f"{whose} cannot be used: it {_said(error, 'gives')}") from None
        return law


def package_of(law: BaseModel) -> str | None:
    """Return name and version of the package that registers the class of ``law``, None if none."""
    name = getattr(law, "law", None)
    found = _registered(name) if isinstance(name, str) else ()
    return next((owner for model, owner in found if model is type(law)), None)


def is_registered(name: str) -> bool:
    """Return whether an installed package registers a law called ``name``."""
    return bool(entry_points(group=GROUP, name=name))


def tags(model: Any) -> tuple[Any, ...]:
    """Return the values of the key ``law`` of a class."""
    field = getattr(model, "model_fields", {}).get("law")
    return get_args(field.annotation) if field else ()


@cache
def _registered(name: str) -> tuple[tuple[type[BaseModel], str], ...]:
    """Return the classes that are registered by a name, each with its package.

    Raises ValueError if one cannot be loaded or is not a law.
    """
    return tuple(_loaded(entry) for entry in entry_points(group=GROUP, name=name))


def _loaded(entry: EntryPoint) -> tuple[type[BaseModel], str]:
    owner = f"{entry.dist.name} {entry.dist.version}" if entry.dist else entry.value
    whose = _whose(entry.name, owner)
    try:
        model = entry.load()
    except Exception as error:  # importing the code of a user raises anything
        raise ValueError(f"{whose} cannot be loaded: {_said(error)}") from None
    if not (isinstance(model, type) and issubclass(model, Law)):
        raise ValueError(
            f"{whose} is not a law: {entry.value} must be a class with the base ViscosityModel, "
            "DensityModel or ShearModel of tehl.lubricant"
        )
    if tags(model) != (entry.name,):
        raise ValueError(
            f"{whose} has another name in its class: {entry.value} needs the field law: "
            f'Literal["{entry.name}"] = "{entry.name}"'
        )
    return model, owner


def _whose(name: str, owner: str) -> str:
    return f'has law = "{name}" of {owner}, which'


def _said(error: Exception, verb: str = "") -> str:
    """Return the first line of an error; that of another code has its kind, after ``verb``."""
    text = str(error).partition("\n")[0]
    if isinstance(error, ValueError) and text:
        return text
    return ": ".join(filter(None, (f"{verb} {type(error).__name__}".strip(), text)))
