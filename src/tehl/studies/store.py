"""Finished cases on disk: rows in one SQLite file, fields in one NetCDF file per case.

Only the process that runs a study writes rows, one transaction per task; workers write fields,
each file whole or not at all. A kill at any time loses the tasks in work and no row.
"""

import errno
import json
import os
import sqlite3
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Literal, get_args

from tehl.api.results import Result, TransientResult, load_as
from tehl.base.atomic import check_place
from tehl.base.errors import FileFormatError, InputError
from tehl.result.solution import Cost, Hint
from tehl.studies.case import Case, Row

Keep = Literal["summary", "fields"]

_STORE_FORMAT = 2
_REMEDY = "bring back a copy of it, or remove it and all its cases are solved again"
_COLUMNS = "key, status, cause, message, hint, retry_settings, summary, cpu_seconds, wall_seconds"
_READABLE = "CASE WHEN json_valid(summary) THEN json_type(summary) = 'object' ELSE 0 END"
"""Whether the summary of a row can be read; a row where it cannot is not finished."""
_SCHEMA = f"""
CREATE TABLE IF NOT EXISTS rows (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, cause TEXT, message TEXT, hint TEXT,
    retry_settings TEXT NOT NULL, summary TEXT NOT NULL,
    cpu_seconds REAL NOT NULL, wall_seconds REAL NOT NULL
) WITHOUT ROWID;
PRAGMA user_version = {_STORE_FORMAT};
"""


class Store:
    """Finished cases in a folder, found by their keys.

    Several studies may share a store, also at the same time.

    Parameters
    ----------
    directory : str or Path
        The folder; made when the first case is finished.
    keep : {"summary", "fields"}
        Whether results are kept with their fields.

    Raises
    ------
    InputError
        If the path is not that of a folder.
    FileFormatError
        If the folder holds a store of another version, or something else under its name.
    """

    def __init__(self, directory: str | Path, keep: Keep = "summary") -> None:
        if keep not in get_args(Keep):
            raise InputError(f'keep = "{keep}" is not known: known are summary and fields')
        self.directory, self.keep = Path(directory), keep
        check_place(self.directory)
        self._file = self.directory / "rows.sqlite"
        self._connection: sqlite3.Connection | None = None
        if self.exists:
            self._open()

    def __del__(self) -> None:
        if getattr(self, "_connection", None) is not None:
            self.close()

    @property
    def exists(self) -> bool:
        """Whether there is a file for rows."""
        return self._file.exists()

    @property
    def fields_folder(self) -> Path:
        """The folder of the fields."""
        return self.directory / "fields"

    def fields_path(self, case: Case) -> Path:
        """Return the file of the fields of a case, if they are kept."""
        return self.fields_folder / f"{case.key}.nc"

    def row(self, case: Case) -> Row | None:
        """Return the row of a case, None when it is not finished."""
        return self.rows([case]).get(case.key)

    def rows(self, cases: Iterable[Case], *, summaries: bool = True) -> dict[str, Row]:
        """Return the rows of the finished cases by key, optionally without their summaries.

        A case whose row is damaged is not finished.

        Parameters
        ----------
        cases : iterable of Case
            Looked up by their keys.
        summaries : bool
            Whether the numbers are read too, which takes most of the time.
        """
        columns = _COLUMNS if summaries else _COLUMNS.replace("summary", "'{}'")
        keys = json.dumps([case.key for case in cases])
        if self._connection is None and not self.exists:
            return {}
        which = f"{_READABLE} AND key IN (SELECT value FROM json_each(?))"
        with self._connected() as connection:
            rows = map(
                _row, connection.execute(f"SELECT {columns} FROM rows WHERE {which}", [keys])
            )
            return {row.key: row for row in rows if row is not None}

    def finished(self, cases: Iterable[Case]) -> dict[str, Row]:
        """Return the rows of the cases that need no work, by key, without their summaries.

        A case whose fields are wanted and lost needs work.
        """
        cases = list(cases)
        rows = self.rows(cases, summaries=False)
        for case in cases if self.keep == "fields" else ():
            row = rows.get(case.key)
            if row is not None and row.has_fields and not self.fields_path(case).is_file():
                del rows[case.key]
        return rows

    def result(self, case: Case) -> Result | None:
        """Return the result of a case with all its fields, None when they are not kept."""
        path = self.fields_path(case)
        return load_as(Result, path) if path.is_file() else None

    def run(self, case: Case) -> TransientResult | None:
        """Return the same of a transient case."""
        path = self.fields_path(case)
        return load_as(TransientResult, path) if path.is_file() else None

    def put(self, *rows: Row) -> None:
        """Keep rows, all or none; they replace older ones of the same keys."""
        lines = [_line(row) for row in rows]
        self.prepare()
        with self._connected() as connection, connection:
            marks = ", ".join("?" * len(_COLUMNS.split(",")))
            query = f"INSERT OR REPLACE INTO rows ({_COLUMNS}) VALUES ({marks})"
            connection.executemany(query, lines)

    def prepare(self) -> None:
        """Make the folder and its files, if they are missing."""
        if self._connection is None:
            self.directory.mkdir(parents=True, exist_ok=True)
            self._open()
        if self.keep == "fields":
            self.fields_folder.mkdir(exist_ok=True)

    def sweep(self, cases: Collection[Case]) -> None:
        """Remove the incomplete files that killed workers left of the fields of ``cases``."""
        if not self.fields_folder.is_dir():
            return
        begun = {case.key[:40] for case in cases}
        for part in self.fields_folder.glob(".*.part"):
            if part.name[1:41] in begun:
                part.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the file of rows; the next access opens it again."""
        if self._connection is not None:
            self._connection.close()
        self._connection = None

    def _open(self) -> None:
        place, is_uri = str(self._file), False
        if not os.access(self.directory, os.W_OK):
            log = self._file.with_name(f"{self._file.name}-wal")
            how = "mode=ro" if log.exists() else "immutable=1"  # nothing writes it without a log
            place, is_uri = f"{self._file.resolve().as_uri()}?{how}", True
        # waits for another study that writes into the same store
        self._connection = sqlite3.connect(
            place, 60.0, isolation_level="IMMEDIATE", check_same_thread=False, uri=is_uri
        )
        # text that is not UTF-8 must not hide the other rows
        self._connection.text_factory = lambda text: text.decode("utf-8", "replace")
        with self._connected() as connection:
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            if version not in (0, _STORE_FORMAT):
                self.close()
                found = f"{self._file} is a store of format {version}"
                raise FileFormatError(f"{found}, this tehl reads {_STORE_FORMAT}: {_REMEDY}")
            # a kill loses nothing that was committed, and no commit waits for the disk
            with suppress(sqlite3.OperationalError):  # file systems without shared memory
                connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = NORMAL")
            if version == 0:
                connection.executescript(_SCHEMA)

    @contextmanager
    def _connected(self) -> Iterator[sqlite3.Connection]:
        """Yield the connection; raise its errors as those of a file."""
        if self._connection is None:
            self._open()
        assert self._connection is not None
        try:
            yield self._connection
        except sqlite3.OperationalError as error:
            code = errno.ENOSPC if "full" in str(error) else errno.EIO
            raise OSError(code, f"{error}", str(self._file)) from error
        except sqlite3.DatabaseError as error:
            message = f"{self._file} is not a store of a study ({error}): {_REMEDY}"
            raise FileFormatError(message) from None


class Memory(Store):
    """Finished cases in memory, without fields."""

    def __init__(self) -> None:
        self.keep, self._known = "summary", dict[str, Row]()

    @property
    def exists(self) -> bool:
        """Whether any case is known."""
        return bool(self._known)

    def rows(self, cases: Iterable[Case], *, summaries: bool = True) -> dict[str, Row]:
        """Return the rows of the finished cases by key."""
        del summaries
        keys = dict.fromkeys(case.key for case in cases)
        return {key: self._known[key] for key in keys if key in self._known}

    def result(self, case: Case) -> None:
        """Return None: fields are not kept."""
        del case

    def run(self, case: Case) -> None:
        """Return None: fields are not kept."""
        del case

    def put(self, *rows: Row) -> None:
        """Keep rows; they replace older ones of the same keys."""
        self._known |= {row.key: row for row in rows}

    def forget_failed(self) -> None:
        """Forget the cases that did not converge, so that they are solved again."""
        self._known = {key: row for key, row in self._known.items() if row.converged}

    def prepare(self) -> None:
        """Do nothing: there are no files."""

    def sweep(self, cases: Collection[Case]) -> None:
        """Do nothing: there are no files."""
        del cases

    def close(self) -> None:
        """Do nothing: the rows stay."""


def opened(place: Store | str | Path | None) -> Store:
    """Return a store, that of a folder, or one in memory if there is no place."""
    if place is None:
        return Memory()
    return place if isinstance(place, Store) else Store(place)


def _line(row: Row) -> tuple[str | float | None, ...]:
    hint = json.dumps(asdict(row.hint)) if row.hint else None
    words = (row.cause, row.message, hint)
    return (
        row.key,
        row.status,
        # names of files may hold characters that UTF-8 cannot
        *(word and word.encode("utf-8", "replace").decode("utf-8") for word in words),
        json.dumps(dict(row.retry_settings)),
        json.dumps(dict(row.summary), allow_nan=False),
        row.cost.cpu_seconds,
        row.cost.wall_seconds,
    )


def _row(line: tuple[str, ...]) -> Row | None:
    """Return a row from the columns of the table, None if it is damaged."""
    key, status, cause, message, hint, retry_settings, summary, cpu, wall = line
    try:
        cost = Cost(cpu_seconds=float(cpu), wall_seconds=float(wall))
        return Row(
            key=key,
            status=status,
            cause=cause,
            message=message,
            hint=Hint(**json.loads(hint)) if hint else None,
            retry_settings=json.loads(retry_settings),
            summary=json.loads(summary),
            cost=cost,
        )
    except (ValueError, TypeError):
        return None
