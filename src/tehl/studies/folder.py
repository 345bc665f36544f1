"""The folder of a study: its plan, its lock, its table."""

import errno
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from pydantic import TypeAdapter

from tehl.base.atomic import check_folder, check_place, replacing
from tehl.base.errors import FileFormatError, InputError
from tehl.studies.plan import Plan
from tehl.studies.store import Store

if TYPE_CHECKING:
    import pandas as pd

PLAN, TABLE, LOCK = "study.json", "table.csv", "study.lock"
_PARQUET, _UNITS = "table.parquet", "units.json"
_FORMAT = 1
_REMEDY = (
    "run the study file again with -o and --replace, which writes it anew and keeps finished cases"
)


def store_of(plan: Plan, folder: Path) -> Store:
    """Return the store of a study, in its folder if it names no other."""
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
                f"another tehl study runs in {folder}: wait until it ends, or take another "
                "folder with -o"
            ) from None


def save_plan(plan: Plan, folder: Path) -> bool:
    """Keep a plan, so that the folder can be run again; return whether it is the first."""
    check_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    content = {"tehl_study": _FORMAT, "plan": TypeAdapter(Plan).dump_python(plan, mode="json")}
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
    if not isinstance(content, dict) or content.get("tehl_study") != _FORMAT:
        raise FileFormatError(f"{path} is not the plan of a study of format {_FORMAT}: {_REMEDY}")
    try:
        return TypeAdapter(Plan).validate_python(content["plan"])
    except (KeyError, ValueError) as error:
        reason = str(error).splitlines()[0]
        raise FileFormatError(f"{path} is damaged ({reason}): {_REMEDY}") from None


def check_same(plan: Plan, folder: Path) -> None:
    """Raise if a folder holds a study with another base case or other axes.

    Other values along the same axes, and another title, are accepted.
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

    Returns the files; each appears whole or not at all.
    """
    written = [folder / TABLE, folder / _UNITS]
    with replacing(written[0]) as temporary:
        frame.to_csv(temporary, index=False)
    with replacing(written[1]) as temporary:
        temporary.write_text(json.dumps(frame.attrs["units"], indent=1), encoding="utf-8")
    if find_spec("pyarrow") is not None:
        written.append(folder / _PARQUET)
        with replacing(written[2]) as temporary:
            _for_parquet(frame).to_parquet(temporary, index=False, engine="pyarrow")
    return written


def _for_parquet(frame: "pd.DataFrame") -> "pd.DataFrame":
    """Return the table with columns of one kind: those of mixed labels become text."""
    mixed = {
        name: frame[name].map(lambda v: f"{v:.12g}" if isinstance(v, float) else str(v), "ignore")
        for name in frame
        if frame[name].dtype == object and len({type(v) for v in frame[name].dropna()}) > 1
    }
    return frame.assign(**mixed)
