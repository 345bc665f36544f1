"""Studies from TOML files or from Python; every mistake is one sentence before any work."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, StrictBool, ValidationError

from tehl.api.problem import ContactProblem, check_call
from tehl.base.atomic import shortened
from tehl.base.errors import InputError
from tehl.base.mistakes import describe
from tehl.base.table import Table
from tehl.base.wording import short
from tehl.contact.options import Options
from tehl.io.case import overridden, toml_tables
from tehl.studies.axes import (
    Axis,
    Sample,
    block_of,
    block_of_file,
    check_axes,
    count_of,
    groups_of,
)
from tehl.studies.output import Picture, checked_pictures
from tehl.studies.plan import Plan, Study, study_of
from tehl.studies.runner import run
from tehl.studies.store import Keep, Store, opened
from tehl.studies.tables import table

if TYPE_CHECKING:
    import pandas as pd

Axes = Mapping[str, Sequence[Any]] | Sequence[Axis]


class StudyFile(Table):
    """The keys of a study file, as the user guide explains them."""

    title: str = ""
    case: str | dict[str, Any]
    axes: list[Axis] = Field(default_factory=list)
    sample: Sample | None = None
    cases: str | None = None
    certify: StrictBool = False
    keep: Keep = "summary"
    warm_start: StrictBool = False
    store: str | None = None
    largest: Annotated[int, Field(ge=1)] | None = None
    pictures: list[Picture] = Field(default_factory=list)


def read_study(path: str | Path, overrides: Sequence[str] = (), *, unlimited: bool = False) -> Plan:
    """Return the plan of a study file.

    Parameters
    ----------
    path : str or Path
        TOML file.
    overrides : sequence of str
        Changes of the base case such as ``"numerics.points=129"``.
    unlimited : bool
        Accept any number of cases.

    Raises
    ------
    InputError
        If the file is not a valid study; the message says what is wrong and what is expected.
    """
    shown, tables = shortened(path), dict[str, Any]()
    try:
        tables = _study_tables(Path(path))
        stated = StudyFile.model_validate(tables)
        return _plan_of(stated, Path(path).parent, overrides, unlimited=unlimited)
    except ValidationError as error:
        raise InputError(f"{shown}: {_first_mistake(error, tables)}") from None
    except (InputError, ValueError) as error:
        raise InputError(f"{shown}: {error}") from None


def _study_tables(path: Path) -> dict[str, Any]:
    """Return the tables of a file; detect ``[axes]`` for ``[[axes]]``, and a case for a study."""
    try:
        tables = toml_tables(path)
    except InputError as error:
        message = str(error).replace("case file", "study file")
        once = re.search(r"Cannot declare \('(axes|pictures)',\) twice", message)
        raise InputError(message + (f": {_brackets(once[1])}" if once else "")) from None
    for key in ("axes", "pictures"):
        if isinstance(tables.get(key), dict):
            raise InputError(f"{key} must be a list of tables: {_brackets(key)}")
    if "contact" in tables:
        raise InputError("is a case file: solve it with tehl solve, or name it as case = ...")
    return tables


def _brackets(key: str) -> str:
    return f"write [[{key}]], with two brackets"


def _plan_of(
    stated: StudyFile, folder: Path, overrides: Sequence[str] = (), *, unlimited: bool = False
) -> Plan:
    """Return the plan of a study whose relative paths begin in ``folder``.

    An invalid one raises an InputError or ValueError.
    """
    groups = groups_of([axis.with_values(folder) for axis in stated.axes])
    listed = () if stated.cases is None else (block_of_file(folder / stated.cases),)
    count = math.prod(count_of(group, stated.sample) for group in groups)
    count *= math.prod(len(block.rows) for block in listed)
    _check_keys(stated, count, unlimited=unlimited)
    blocks = (*listed, *(block_of(group, stated.sample) for group in groups))
    check_axes(blocks)
    labels = [name for block in blocks for name in block.names]
    pictures = checked_pictures(stated.pictures, labels, folder)
    base, place = _base(stated, folder, overrides)
    return Plan(
        title=stated.title or str(base.get("title", "")),
        base=base,
        folder=place,
        blocks=blocks,
        certify=stated.certify,
        keep=stated.keep,
        warm_start=stated.warm_start,
        store=None if stated.store is None else folder / stated.store,
        pictures=pictures,
    )


def _check_keys(stated: StudyFile, count: int, *, unlimited: bool) -> None:
    """Raise for too many cases, and for keys without those that they need."""
    limit = stated.largest or 10_000
    if count > limit and not unlimited:
        raise InputError(
            f"has {count:,} cases, more than {limit:,}: if this is intended, state "
            f"largest = {count} in the file or give --yes"
        )
    if stated.sample is not None and not any(axis.is_sampled for axis in stated.axes):
        raise InputError("sample is stated, but no axis is sampled: give one uniform = [low, high]")
    if stated.warm_start and stated.keep != "fields":
        raise InputError('warm_start takes the fields of neighbours: give keep = "fields" too')


def _base(stated: StudyFile, folder: Path, overrides: Sequence[str]) -> tuple[dict[str, Any], Path]:
    """Return the tables of the base case with the overrides, and the folder of its files."""
    base, place = stated.case, folder
    if isinstance(base, str):
        path = folder / base
        try:
            base, place = toml_tables(path), path.parent
        except InputError as error:
            raise InputError(f"case {shortened(path)}: {error}") from None
    for override in overrides:
        base = overridden(base, override)
    return base, place


_NEEDED = {
    "case": '; give the base case, case = "case.toml" or a table [case]',
    "path": '; give the path of the case that the axis varies, path = "contact.load"',
    "number": "; give the number of points, number = 100",
}
"""What to give for a key that is missing."""


def _first_mistake(error: ValidationError, tables: Mapping[str, Any]) -> str:
    """Return the first mistake that pydantic found in the tables of a study, in one sentence."""
    sentence = describe(error, tables, StudyFile).replace("a boolean", "true or false")
    missing = [key for key in _NEEDED if sentence.endswith(f"{key} is missing")]
    place = re.match(r"(axes|pictures)\.(\d+)(\S*)", sentence)
    if place is None:
        return sentence + "".join(_NEEDED[key] for key in missing)
    kind, number, rest = place[1], int(place[2]), sentence[place.end() :]
    table = tables[kind][number]
    path = table.get("path") if isinstance(table, Mapping) else None
    if "space" in place[3]:
        rest = rest.replace("two numbers", "first, last and number")
    name = f"{kind}[{number + 1}]{place[3]}{f' ({short(str(path))})' if path else ''}"
    return name + rest + "".join(_NEEDED[key] for key in missing)


def cases_of(
    problem: ContactProblem,
    axes: Axes,
    options: Options | None = None,
    *,
    sample: Sample | None = None,
    certify: bool = False,
) -> Study:
    """Return the cases of a problem along axes, and the units of their labels.

    Parameters
    ----------
    problem : ContactProblem
        The base case.
    axes : mapping of str to sequence, or sequence of Axis
        Dotted paths of the case with their values, numbers in SI or strings with units:
        ``{"contact.load": ["20 N", "50 N"]}``. The cases are their grid, the last axis the
        fastest. An :class:`Axis` can be sampled and zipped too.
    options : Options
        Numerical options; paths that begin with ``numerics`` change them.
    sample : Sample or None
        How sampled axes take their values.
    certify : bool
        Error bars for each case.

    Raises
    ------
    InputError
        If an axis is not valid; the message names it.
    """
    check_call(problem, options)
    base = problem.model_dump(mode="json", exclude_unset=True)
    base["numerics"] = (options or Options()).model_dump(mode="json", exclude_unset=True)
    listed: list[Any] = (
        [{"path": path, "values": _values(path, values)} for path, values in axes.items()]
        if isinstance(axes, Mapping)
        else list(axes)
    )
    tables = {"case": base, "axes": listed, "sample": sample, "certify": certify}
    try:
        stated = StudyFile.model_validate(tables | {"title": problem.title})
        return study_of(_plan_of(stated, Path(), unlimited=True))
    except ValidationError as error:
        raise InputError(_first_mistake(error, tables)) from None
    except ValueError as error:
        raise InputError(str(error)) from None


def _values(path: str, values: Iterable[Any]) -> list[Any]:
    """Return the values of an axis; one in a text alone is a mistake, not a list of letters."""
    if isinstance(values, str):
        raise InputError(f'axis {path} = "{values}": must be a list, such as ["{values}"]')
    return list(values)


def study(
    problem: ContactProblem,
    axes: Axes,
    options: Options | None = None,
    *,
    store: Store | str | Path | None = None,
    jobs: int = 1,
    certify: bool = False,
) -> "pd.DataFrame":
    """Solve a problem along axes; return one row per case.

    For clusters, sampled axes and kept fields, take its parts :func:`cases_of`, :func:`run` and
    :func:`table`.

    Parameters
    ----------
    problem, axes, options, certify
        As in :func:`cases_of`.
    store : Store, str, Path or None
        Where finished cases are kept and found again; nowhere if left out.
    jobs : int
        Processes. With more than one, a script needs ``if __name__ == "__main__":``.

    Returns
    -------
    pandas.DataFrame
        As :func:`table` returns it: ``frame.attrs["units"]`` has the units. Of a full grid,
        ``frame.set_index(list(axes)).to_xarray()`` is the dataset over the axes.

    Raises
    ------
    InputError
        If an axis is not valid; the message names it.
    """
    found = cases_of(problem, axes, options, certify=certify)
    with closing(opened(store)) as kept:
        run(found.cases, kept, jobs=jobs)
        return table(found.cases, kept, found.units)
