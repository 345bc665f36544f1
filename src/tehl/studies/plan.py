"""A plan, the base case with blocks of values; the study, its cases; the folder that keeps both."""

import errno
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from importlib.util import find_spec
from itertools import islice, product
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from pydantic import TypeAdapter

from tehl.api.problem import case_from_tables
from tehl.base.atomic import check_folder, check_place, replacing
from tehl.base.errors import FileFormatError, InputError
from tehl.contact.options import check_certifiable
from tehl.io.case import changed, found_at
from tehl.studies.axes import Block, Setting
from tehl.studies.case import Case, Label
from tehl.studies.output import Picture
from tehl.studies.store import Keep, Store

if TYPE_CHECKING:
    import pandas as pd


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
    if problem.has_passes and plan.certify:
        raise InputError("certify is for a single pass: leave it out, or supply.passes")
    if plan.certify and options.points != "auto":
        check_certifiable(options, transient=problem.transient is not None)
    labels: dict[str, Label] = {}
    for path, name, setting in settings:
        found, kind = found_at(problem, options, path)
        labels[name] = setting.name or _label(setting.value, found)
        if kind is not None and not setting.name:
            units[name] = "1" if kind.unit == "-" else kind.unit
    titles = [b.titles[row] for b, row in zip(plan.blocks, rows, strict=True) if b.titles]
    name = ", ".join(titles or _phrases(labels, units)) or problem.title or "base case"
    return Case(name, problem, options, labels, plan.certify)


def _settings(plan: Plan, rows: tuple[int, ...]) -> Iterator[tuple[str, str, Setting]]:
    """Yield path, name and value of each column that changes the base case."""
    for block, row in zip(plan.blocks, rows, strict=True):
        for path, name, setting in zip(block.paths, block.names, block.rows[row], strict=True):
            if setting is not None:
                yield path, name, setting


def _label(stated: Any, found: Any) -> Label:
    """Return a value as the table shows it: numbers in SI, as the case has ``found`` them."""
    if isinstance(found, bool):
        return str(found).lower()
    if stated is False:
        return "none"
    if isinstance(found, int | float):
        return float(found)
    if isinstance(stated, str):
        return stated
    if isinstance(stated, Mapping):
        words = [stated[key] for key in ("law", "name", "type") if key in stated]
        if words:
            return str(words[0])
    return json.dumps(stated, ensure_ascii=False, default=str)[:60]  # characters of a label


def _phrases(labels: Mapping[str, Label], units: Mapping[str, str]) -> Iterator[str]:
    """Yield the first labels for the name of a case: load = 20 N."""
    for name, value in islice(labels.items(), 5):
        number, unit = str(value), ""
        if isinstance(value, float):
            number, unit = f"{value:.6g}", f" {units.get(name, '1')}".removesuffix(" 1")
        yield f"{name.rpartition('.')[2]} = {number}{unit}"


# ---- the folder of a study: plan, lock, table

PLAN, TABLE, LOCK = "study.json", "table.csv", "study.lock"
_PARQUET, _UNITS = "table.parquet", "units.json"
_PLAN_FORMAT = 1
_REMEDY = (
    "run the study file again with -o and --replace, which writes it anew and keeps finished cases"
)


def store_of(plan: Plan, folder: Path) -> Store:
    """Return the store of a study, in its folder if it names no other.

    Parameters
    ----------
    plan : Plan
        Names the folder of the store, or none, and what is kept of a case.
    folder : Path
        Of the study.
    """
    return Store(plan.store or folder, keep=plan.keep)


def check_can_write(folder: Path) -> None:
    """Raise an InputError for a file in the place of a folder, an OSError for a read-only one."""
    check_place(folder)
    try:
        check_folder(folder)
    except InputError as error:
        raise OSError(str(error)) from None


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Make a folder and hold its lock; remove the folder if nothing came of it.

    The system releases the lock however the program ends. Where it has no locks (Windows, some
    network drives), nothing is held.
    """
    check_can_write(folder)
    missing = [place for place in (folder, *folder.parents) if not place.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / LOCK).open("ab") as file:
        _lock(file, folder)
        try:
            yield
        finally:
            if missing and {path.name for path in folder.iterdir()} <= {LOCK}:
                (folder / LOCK).unlink(missing_ok=True)
                for place in missing:
                    with suppress(OSError):
                        place.rmdir()


def _lock(file: IO[bytes], folder: Path) -> None:
    try:
        import fcntl  # noqa: PLC0415 (not on Windows)

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ModuleNotFoundError:
        pass
    except OSError as error:
        if error.errno in (errno.EAGAIN, errno.EACCES):
            raise OSError(
                f"another run of tehl writes into {folder}: wait until it ends, or take another "
                "output with -o"
            ) from None


def save_plan(plan: Plan, folder: Path) -> bool:
    """Keep a plan, so that the folder can be run again.

    Parameters
    ----------
    plan : Plan
        Axes, base case and settings.
    folder : Path
        Of the study; made if it is missing.

    Returns
    -------
    bool
        Whether the folder had no plan before.
    """
    check_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    content = {"tehl_study": _PLAN_FORMAT, "plan": TypeAdapter(Plan).dump_python(plan, mode="json")}
    path, text = folder / PLAN, json.dumps(content, default=str, indent=1)
    is_first = not path.is_file()
    if is_first or path.read_bytes() != text.encode():  # a study continues in a full folder
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return is_first


def load_plan(folder: Path) -> Plan:
    """Return the plan in the folder of a study; raise if it is damaged or of another version."""
    path = folder / PLAN
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{folder} is not the folder of a study: it has no {PLAN}") from None
    except (OSError, ValueError) as error:
        raise FileFormatError(f"{path} cannot be read ({error}): {_REMEDY}") from None
    if not isinstance(content, dict) or content.get("tehl_study") != _PLAN_FORMAT:
        raise FileFormatError(
            f"{path} is not the plan of a study of format {_PLAN_FORMAT}: {_REMEDY}"
        )
    try:
        return TypeAdapter(Plan).validate_python(content["plan"])
    except (KeyError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise FileFormatError(f"{path} is damaged ({reason}): {_REMEDY}") from None


def check_same(plan: Plan, folder: Path) -> None:
    """Check that a folder holds the same study, if any.

    Other values along the same axes, and another title, are accepted.

    Parameters
    ----------
    plan : Plan
        Of the study to run.
    folder : Path
        Perhaps with the plan of an earlier run.

    Raises
    ------
    InputError
        If the base case or the axes differ.
    """
    if not (folder / PLAN).is_file():
        return
    mine, other = _identity(plan), _identity(load_plan(folder))
    for what in mine:
        if mine[what] != other[what]:
            raise InputError(
                f"{folder} holds a study with another {what}: take another folder with -o, or give "
                "--replace to put this study in its place"
            )


def _identity(plan: Plan) -> dict[str, Any]:
    """Return base case and axes of a study, as JSON holds them, without title and values."""
    base = json.loads(json.dumps(plan.base, default=str))
    columns = [column for b in plan.blocks for column in zip(b.paths, b.names, strict=True)]
    return {
        "base case": {key: value for key, value in base.items() if key != "title"},
        "choice of axes": sorted(columns),
    }


def remove_outcome(folder: Path) -> None:
    """Remove plan, table and pictures of the study in a folder; its finished cases stay."""
    try:
        pictures = load_plan(folder).pictures
    except (InputError, FileFormatError):
        pictures = ()
    for name in (*(one.file_name for one in pictures), TABLE, _UNITS, _PARQUET, PLAN):
        (folder / name).unlink(missing_ok=True)


def write_table(frame: "pd.DataFrame", folder: Path) -> list[Path]:
    """Write a table as CSV, its units beside it, and as Parquet where pyarrow is installed.

    Parameters
    ----------
    frame : DataFrame
        With the units of its columns in ``attrs``.
    folder : Path
        Of the study.

    Returns
    -------
    list of Path
        The files; each appears whole or not at all.
    """
    written = [folder / TABLE, folder / _UNITS]
    with replacing(written[0]) as temporary:
        frame.to_csv(temporary, index=False)
    with replacing(written[1]) as temporary:
        temporary.write_text(json.dumps(frame.attrs["units"], indent=1), encoding="utf-8")
    if find_spec("pyarrow") is not None:
        written.append(folder / _PARQUET)
        with replacing(written[2]) as temporary:
            for_parquet(frame).to_parquet(temporary, index=False, engine="pyarrow")
    return written


def for_parquet(frame: "pd.DataFrame") -> "pd.DataFrame":
    """Return the table with columns of one kind: those of mixed labels become text."""
    mixed = {
        name: frame[name].map(lambda v: f"{v:.12g}" if isinstance(v, float) else str(v), "ignore")
        for name in frame
        if frame[name].dtype == object and len({type(v) for v in frame[name].dropna()}) > 1
    }
    return frame.assign(**mixed)
