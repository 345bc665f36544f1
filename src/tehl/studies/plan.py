"""A plan, the base case with blocks of values, and the study, its cases."""

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice, product
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.base.errors import InputError
from tehl.base.units import Quantity
from tehl.contact.options import Options, check_certifiable
from tehl.io.case import changed
from tehl.studies.axes import Block, Setting
from tehl.studies.case import Case, Label
from tehl.studies.pictures import Picture
from tehl.studies.store import Keep

_SHOWN = 5
"""Labels in the name of a case."""
_LONGEST = 60
"""Characters of a label."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """A study before its cases are made, with the keys of a study file.

    ``base`` has the tables of the base case, whose relative paths begin in ``folder``; the cases
    are the grid of ``blocks``, the last one the fastest.
    """

    title: str
    base: Mapping[str, Any]
    folder: Path
    blocks: tuple[Block, ...]
    certify: bool = False
    keep: Keep = "summary"
    warm_start: bool = False
    store: Path | None = None
    pictures: tuple[Picture, ...] = ()

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(len(block.rows) for block in self.blocks)


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """The cases of a plan, and the units of their labels."""

    plan: Plan
    cases: tuple[Case, ...]
    units: Mapping[str, str]


def study_of(plan: Plan) -> Study:
    """Return all cases of a plan; an InputError names the first that is not valid, and why."""
    units: dict[str, str] = {}
    names: dict[str, int] = {}
    cases = []
    for number, rows in enumerate(product(*(range(len(b.rows)) for b in plan.blocks)), start=1):
        try:
            case = _case(plan, rows, units)
        except (InputError, ValueError) as error:
            raise InputError(f"case {number} of {plan.count}: {error}") from None
        names[case.name] = count = names.get(case.name, 0) + 1
        cases.append(case if count == 1 else replace(case, name=f"{case.name} ({count})"))
    if plan.warm_start and not any(case.options.accuracy == "tight" for case in cases):
        raise InputError(
            'warm_start saves nothing at this accuracy: state numerics.accuracy = "tight" too'
        )
    return Study(plan=plan, cases=tuple(cases), units=units)


def _case(plan: Plan, rows: tuple[int, ...], units: dict[str, str]) -> Case:
    """Return the case at some rows of the blocks; add the units of its labels."""
    settings = list(_settings(plan, rows))
    tables: Mapping[str, Any] = plan.base
    for path, _, setting in settings:
        tables = changed(tables, path, setting.value)
    problem, options = case_from_tables(tables, plan.folder)
    if problem.transient is not None:
        raise InputError("has a table [transient]: a study is one of steady films")
    if problem.has_passes and plan.certify:
        raise InputError("certify is for a single pass: leave it out, or supply.passes")
    if plan.certify and options.points != "auto":
        check_certifiable(options)
    labels: dict[str, Label] = {}
    for path, name, setting in settings:
        found, unit = _found_at(problem, options, path)
        labels[name] = setting.name or _label(setting.value, found)
        if unit and not setting.name:
            units[name] = unit
    titles = [b.titles[row] for b, row in zip(plan.blocks, rows, strict=True) if b.titles]
    name = ", ".join(titles or _phrases(labels, units)) or problem.title or "base case"
    return Case(name, problem, options, labels, plan.certify)


def _settings(plan: Plan, rows: tuple[int, ...]) -> Iterator[tuple[str, str, Setting]]:
    """Yield path, name and value of each column that changes the base case."""
    for block, row in zip(plan.blocks, rows, strict=True):
        for path, name, setting in zip(block.paths, block.names, block.rows[row], strict=True):
            if setting is not None:
                yield path, name, setting


def _found_at(problem: ContactProblem, options: Options, path: str) -> tuple[Any, str | None]:
    """Return the validated value at a path of a case, and its SI unit if it is a quantity.

    Both are None where the case no longer has such a place, as another law was chosen.
    """
    keys = [part.strip() for part in path.split(".")]
    node: Any = problem
    if keys[0] == "numerics":
        node, keys = options, keys[1:]
    unit = None
    for key in keys:
        if not isinstance(node, BaseModel) or key not in type(node).model_fields:
            return None, None
        field = type(node).model_fields[key]
        unit = next(_units([*field.metadata, field.annotation]), None)
        node = getattr(node, key)
    return node, unit


def _units(notes: Iterable[Any]) -> Iterator[str]:
    """Yield the units among the metadata of a field and in its annotation."""
    for note in notes:
        if isinstance(note, Quantity):
            yield "1" if note.unit == "-" else note.unit
        else:
            yield from _units(get_args(note))


def _label(stated: Any, found: Any) -> Label:
    """Return a value as the table shows it: numbers in SI, as the case has ``found`` them."""
    if stated is False:
        return "none"
    if isinstance(found, bool):
        return str(found).lower()
    if isinstance(found, int | float):
        return float(found)
    if isinstance(stated, str):
        return stated
    if isinstance(stated, Mapping):
        words = [stated[key] for key in ("law", "name", "type") if key in stated]
        if words:
            return str(words[0])
    return json.dumps(stated, ensure_ascii=False, default=str)[:_LONGEST]


def _phrases(labels: Mapping[str, Label], units: Mapping[str, str]) -> Iterator[str]:
    """Yield the first labels for the name of a case: load = 20 N."""
    for name, value in islice(labels.items(), _SHOWN):
        number, unit = str(value), ""
        if isinstance(value, float):
            number, unit = f"{value:.6g}", f" {units.get(name, '1')}".removesuffix(" 1")
        yield f"{name.rpartition('.')[2]} = {number}{unit}"
