"""Study files: TOML in, a plan out, and every mistake told in one sentence before any work."""

import difflib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, cast

from pydantic import BaseModel, ConfigDict, Field, StrictBool, ValidationError

from tehl.errors import InputError
from tehl.io.atomic import shortened
from tehl.io.case import change, toml_tables
from tehl.studies.axes import Axis, Sample, block_of, count_of, groups_of
from tehl.studies.checks import check_axes, checked_pictures
from tehl.studies.listed import block_of_file
from tehl.studies.pictures import Picture
from tehl.studies.plan import Plan
from tehl.studies.store import Keep

LARGEST = 10_000
"""Cases of a study that does not say that it wants more."""


class StudyFile(BaseModel):
    """What a study file holds.

    Attributes
    ----------
    title : str
        For people.
    case : str or table
        The base case: a case file, or its tables.
    axes : list of Axis
        What varies; the cases are the grid of all axes.
    sample : Sample or None
        How sampled axes take their values.
    cases : str or None
        A CSV file that lists cases, one axis more.
    certify : bool
        Error bars for each case.
    keep : {"summary", "fields"}
        Whether the fields of each case are kept too.
    warm_start : bool
        Start from the nearest finished case.
    store : str or None
        Folder of finished cases that several studies share.
    largest : int or None
        Most cases that are meant.
    pictures : list of Picture
        What to draw of the table.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    title: str = ""
    case: str | dict[str, Any]
    axes: list[Axis] = []
    sample: Sample | None = None
    cases: str | None = None
    certify: StrictBool = False
    keep: Keep = "summary"
    warm_start: StrictBool = False
    store: str | None = None
    largest: Annotated[int, Field(ge=1)] | None = None
    pictures: list[Picture] = []


def read_study(path: str | Path, overrides: Sequence[str] = (), *, huge: bool = False) -> Plan:
    """Return the plan of a study file.

    Parameters
    ----------
    path : str or Path
        TOML file.
    overrides : sequence of str
        Changes of the base case such as ``"numerics.points=129"``.
    huge : bool
        Any number of cases is meant.

    Raises
    ------
    InputError
        If the file is no study; the message says what is wrong and what would be right.
    """
    shown = shortened(path)
    try:
        tables = toml_tables(Path(path))
    except InputError as error:
        raise InputError(f"{shown}: {_as_study(str(error))}") from None
    try:
        stated = StudyFile.model_validate(tables)
        return plan_of(stated, Path(path).parent, overrides, huge=huge)
    except ValidationError as error:
        raise InputError(f"{shown}: {told(error, tables)}") from None
    except (InputError, ValueError) as error:
        raise InputError(f"{shown}: {error}") from None


def plan_of(
    stated: StudyFile, folder: Path, overrides: Sequence[str] = (), *, huge: bool = False
) -> Plan:
    """Return the plan of a study that was read.

    Parameters
    ----------
    stated : StudyFile
        The study.
    folder : Path
        Where relative paths begin.
    overrides, huge
        As of :func:`read_study`.

    Raises
    ------
    InputError, ValueError
        If it cannot be.
    """
    groups = groups_of(stated.axes)
    listed = () if stated.cases is None else (block_of_file(folder / stated.cases),)
    count = 1
    for group in groups:
        count *= count_of(group, stated.sample)
    count *= len(listed[0].rows) if listed else 1
    _check_count(count, stated, huge=huge)
    if stated.sample is not None and not any(axis.is_drawn for axis in stated.axes):
        raise InputError("sample is stated, but no axis is sampled: give one uniform = [low, high]")
    if stated.warm_start and stated.keep != "fields":
        raise InputError('warm_start takes the fields of neighbours: give keep = "fields" too')
    blocks = (*listed, *(block_of(group, stated.sample) for group in groups))
    check_axes(blocks)
    pictures = checked_pictures(stated.pictures, blocks)
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
        pictures=tuple(_placed(picture, folder) for picture in pictures),
    )


def _check_count(count: int, stated: StudyFile, *, huge: bool) -> None:
    most = stated.largest or LARGEST
    if count > most and not huge:
        raise InputError(
            f"has {count:,} cases, more than {most:,}: if they are meant, state largest = {count} "
            "in the file or give --yes"
        )


def _base(
    stated: StudyFile, folder: Path, overrides: Sequence[str]
) -> tuple[Mapping[str, Any], Path]:
    """Return the tables of the base case with the changes made, and the folder of its files."""
    if isinstance(stated.case, str):
        path = folder / stated.case
        try:
            base, place = toml_tables(path), path.parent
        except InputError as error:
            raise InputError(f"case {shortened(path)}: {error}") from None
    else:
        base, place = cast("dict[str, Any]", _copy(stated.case)), folder
    for override in overrides:
        change(base, override)
    return base, place


def _copy(value: object) -> object:
    """Return tables that may be changed."""
    if isinstance(value, dict):
        return {key: _copy(item) for key, item in value.items()}
    return value


def _placed(picture: Picture, folder: Path) -> Picture:
    """Let the file of measured points lie beside the study."""
    if picture.overlay is None:
        return picture
    return picture.model_copy(update={"overlay": str(folder / picture.overlay)})


# ---- telling mistakes


def _as_study(message: str) -> str:
    again = re.search(r"Cannot declare \('(axes|pictures)',\) twice", message)
    hint = f": write [[{again[1]}]], with two brackets" if again else ""
    return message.replace("case file", "study file") + hint


def told(error: ValidationError, tables: Mapping[str, Any]) -> str:
    """Return the first mistake of a study in one sentence.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    tables : mapping
        What it was given.
    """
    first = min(error.errors(include_url=False), key=lambda one: one["type"] != "extra_forbidden")
    where = [part for part in first["loc"] if part not in ("str", "dict[str,any]")]
    name = _place(where, tables)
    if first["type"] == "extra_forbidden" and where == ["contact"]:
        return "is a case file: tehl solve takes it; a study has it as its base, case = ..."
    if first["type"] == "extra_forbidden":
        return f"{name} is no key of a study: {_near(where)}"
    if first["type"] == "missing":
        return f"{name} is missing{_WANTED.get(str(where[-1]), '')}"
    message = first["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if first["type"] == "value_error":
        return f"{name} {message}"
    if first["type"] == "list_type" and len(where) == 1 and where[0] in ("axes", "pictures"):
        return f"{name} must be a list of tables: write [[{name}]], with two brackets"
    if first["type"] == "bool_type":
        message = "must be true or false"
    shown = repr(first["input"])
    return f"{name} = {shown if len(shown) <= 60 else f'{shown[:57]}...'} {message}"


_WANTED = {
    "case": ': give the base case, case = "case.toml" or a table [case]',
    "path": ': give the path of the case that the axis varies, path = "contact.load"',
    "number": ": give how many points to sample, number = 100",
}


def _place(where: Sequence[int | str], tables: Mapping[str, Any]) -> str:
    """Return a key path as people count, with the path of the axis that it is about."""
    words = [f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in where]
    name = "".join(words).lstrip(".")
    if len(where) >= 2 and where[0] == "axes" and isinstance(where[1], int):
        axes = tables.get("axes")
        axis = axes[where[1]] if isinstance(axes, list) else None
        if isinstance(axis, Mapping) and isinstance(axis.get("path"), str):
            return f"{name} ({axis['path'][:60]})"
    return name


def _near(where: Sequence[int | str]) -> str:
    models: dict[str, type[BaseModel]] = {"axes": Axis, "sample": Sample, "pictures": Picture}
    model = models.get(str(where[0]), StudyFile) if len(where) > 1 else StudyFile
    known = list(model.model_fields)
    close = difflib.get_close_matches(str(where[-1]), known, n=1, cutoff=0.55)
    return f"did you mean {close[0]}?" if close else f"known are {', '.join(known)}"
