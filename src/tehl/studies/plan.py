"""What a study is: a base case, and blocks of values whose grid are the cases."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

from tehl.errors import InputError
from tehl.io.case import case_from_tables
from tehl.options import Options, check_certifiable
from tehl.problem import ContactProblem
from tehl.studies.axes import Block, Setting
from tehl.studies.case import Case, Label
from tehl.studies.change import changed, found_at, label_of
from tehl.studies.pictures import Picture
from tehl.studies.store import Keep

SHOWN = 5
"""Labels in the name of a case."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """A study that was read and can be made into cases.

    Attributes
    ----------
    title : str
        For people.
    base : mapping
        Tables of the base case.
    folder : Path
        Where relative paths of measured surfaces begin.
    blocks : tuple of Block
        The cases are their grid, the last one the fastest.
    certify : bool
        Error bars for each case.
    keep : {"summary", "fields"}
        What the store keeps.
    warm_start : bool
        Start from the nearest finished case.
    store : Path or None
        Where finished cases are kept, if not in the folder of the study.
    pictures : tuple of Picture
        What to draw.
    """

    title: str
    base: Mapping[str, Any]
    folder: Path
    blocks: tuple[Block, ...]
    certify: bool = False
    keep: Keep = "summary"
    warm_start: bool = False
    store: Path | None = None
    pictures: tuple[Picture, ...] = field(default_factory=tuple)

    @property
    def count(self) -> int:
        """Number of cases."""
        return math.prod(len(block.rows) for block in self.blocks)


@dataclass(frozen=True, kw_only=True, slots=True)
class Study:
    """The cases of a plan, with the units of their labels."""

    plan: Plan
    cases: tuple[Case, ...]
    units: Mapping[str, str]


def study_of(plan: Plan) -> Study:
    """Return all cases of a plan, each of them checked.

    Raises
    ------
    InputError
        If one of them is no case; the message says which and why.
    """
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
    tables: Mapping[str, Any] = plan.base
    for path, _, setting in _settings(plan, rows):
        tables = changed(tables, path, setting.value)
    problem, options = case_from_tables(tables, plan.folder)
    if problem.transient is not None:
        raise InputError("has a [transient] table: a study is one of steady films")
    if plan.certify:
        check_certifiable(options)
    labels = _labels(plan, rows, (problem, options), units)
    titles = [b.titles[row] for b, row in zip(plan.blocks, rows, strict=True) if b.titles]
    name = ", ".join(titles) or _name(labels, units) or problem.title or "base case"
    return Case(name, problem, options, labels, plan.certify)


def _settings(plan: Plan, rows: tuple[int, ...]) -> Iterator[tuple[str, str, Setting]]:
    """Yield path, name and value of each column that changes the base case."""
    for block, row in zip(plan.blocks, rows, strict=True):
        for path, name, setting in zip(block.paths, block.names, block.rows[row], strict=True):
            if setting is not None:
                yield path, name, setting


def _labels(
    plan: Plan, rows: tuple[int, ...], case: tuple[ContactProblem, Options], units: dict[str, str]
) -> dict[str, Label]:
    labels: dict[str, Label] = {}
    for path, name, setting in _settings(plan, rows):
        found, unit = found_at(*case, path)
        labels[name] = setting.name or label_of(setting.value, found)
        if unit and not setting.name:
            units[name] = unit
    return labels


def _name(labels: Mapping[str, Label], units: Mapping[str, str]) -> str:
    parts = [
        f"{name.rpartition('.')[2]} = {_in_words(value, units.get(name, '1'))}"
        for name, value in labels.items()
    ]
    return ", ".join(parts[:SHOWN])


def _in_words(value: Label, unit: str) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.6g}" if unit == "1" else f"{value:.6g} {unit}"
