"""The folder of a study: its plan, its store, its table and its pictures."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from tehl.errors import FileFormatError, InputError
from tehl.io.atomic import check_folder, check_place, replacing
from tehl.studies.plan import Plan
from tehl.studies.store import Store

if TYPE_CHECKING:
    import pandas as pd

PLAN, TABLE, PARQUET, UNITS = "study.json", "table.csv", "table.parquet", "units.json"
_FORMAT = 1
_ANEW = (
    "run the study file again with -o and --replace, which writes it anew and keeps finished cases"
)


def store_of(plan: Plan, folder: Path) -> Store:
    """Return the store of a study, in its folder if it names no other."""
    return Store(plan.store or folder, keep=plan.keep)


def check_can_write(folder: Path) -> None:
    """Refuse a folder that takes no files.

    Raises
    ------
    InputError
        If something else is in its way.
    OSError
        If it cannot be written.
    """
    check_place(folder)
    try:
        check_folder(folder)
    except InputError as error:
        raise OSError(str(error)) from None


def save_plan(plan: Plan, folder: Path) -> bool:
    """Keep a plan, so that the folder alone says what was studied; return whether it is the first.

    Raises
    ------
    InputError
        If the folder cannot be, or holds something else under this name.
    """
    check_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    content = {"tehl_study": _FORMAT, "plan": TypeAdapter(Plan).dump_python(plan, mode="json")}
    path, text = folder / PLAN, json.dumps(content, default=str, indent=1)
    is_first = not path.is_file()
    if not is_first and path.read_bytes() == text.encode():
        return False  # so that a study goes on where nothing more can be written
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return is_first


def load_plan(folder: Path) -> Plan:
    """Return the plan that a folder of a study holds.

    Raises
    ------
    InputError
        If it is no folder of a study.
    FileFormatError
        If its plan is damaged or of another version.
    """
    path = folder / PLAN
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{folder} is no folder of a study: it has no {PLAN}") from None
    except (OSError, ValueError) as error:
        raise FileFormatError(f"{path} cannot be read ({error}): {_ANEW}") from None
    if not isinstance(content, dict) or content.get("tehl_study") != _FORMAT:
        raise FileFormatError(f"{path} is not the plan of a study of format {_FORMAT}: {_ANEW}")
    try:
        return TypeAdapter(Plan).validate_python(content["plan"])
    except (KeyError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise FileFormatError(f"{path} is damaged ({reason}): {_ANEW}") from None


def check_same(plan: Plan, folder: Path) -> None:
    """Refuse a folder that holds a study with another question.

    Other values along the same axes are the same question, and so is another title.

    Raises
    ------
    InputError
        If base case or axes differ; the message says which, and how to go on.
    FileFormatError
        If the plan in the folder is damaged or of another version.
    """
    if not (folder / PLAN).is_file():
        return
    mine, other = _question(plan), _question(load_plan(folder))
    differ = next((what for what in mine if mine[what] != other[what]), None)
    if differ is not None:
        raise InputError(
            f"{folder} holds a study with another {differ}: take another folder with -o, or give "
            "--replace to put this study in its place"
        )


def _question(plan: Plan) -> dict[str, Any]:
    """Return what a study asks, as JSON holds it, without its values."""
    base = json.loads(json.dumps(plan.base, default=str))
    columns = [column for b in plan.blocks for column in zip(b.paths, b.names, strict=True)]
    return {
        "base case": {key: value for key, value in base.items() if key != "title"},
        "choice of axes": sorted(columns),
    }


def forget_outcome(folder: Path) -> None:
    """Remove plan, table and pictures of a study; its finished cases stay for those who ask them.

    Parameters
    ----------
    folder : Path
        Of the study; pictures are those that its plan names.
    """
    try:
        pictures = load_plan(folder).pictures
    except (InputError, FileFormatError):
        pictures = ()
    files = [f"{picture.stem}.{picture.format}" for picture in pictures]
    for name in (*files, TABLE, UNITS, PARQUET, PLAN):
        (folder / name).unlink(missing_ok=True)


def write_table(frame: "pd.DataFrame", folder: Path) -> list[Path]:
    """Write a table as CSV, its units beside it, and as Parquet where pyarrow is installed.

    Parameters
    ----------
    frame : pandas.DataFrame
        As :func:`tehl.studies.table` gives it.
    folder : Path
        Where.

    Returns
    -------
    list of Path
        What was written; each file appears whole or not at all.
    """
    with replacing(folder / TABLE) as temporary:
        frame.to_csv(temporary, index=False)
    units: dict[str, Any] = frame.attrs["units"]
    with replacing(folder / UNITS) as temporary:
        temporary.write_text(json.dumps(units, indent=1), encoding="utf-8")
    written = [folder / TABLE, folder / UNITS]
    if _has_pyarrow():
        with replacing(folder / PARQUET) as temporary:
            _for_parquet(frame).to_parquet(temporary, index=False, engine="pyarrow")
        written.append(folder / PARQUET)
    return written


def _has_pyarrow() -> bool:
    from importlib.util import find_spec  # noqa: PLC0415

    return find_spec("pyarrow") is not None


def _for_parquet(frame: "pd.DataFrame") -> "pd.DataFrame":
    """Return the table with columns of one kind: those of mixed labels become words."""
    mixed = {
        name: frame[name].map(_word, na_action="ignore")
        for name in frame
        if frame[name].dtype == object and len({type(v) for v in frame[name].dropna()}) > 1
    }
    return frame.assign(**mixed)


def _word(value: object) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)
