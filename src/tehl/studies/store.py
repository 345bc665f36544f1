"""Finished cases on disk: rows in one SQLite file, fields in one NetCDF file per case.

Only the process that runs a study writes rows, a transaction for those of a task; workers write
fields, each file whole or not at all. So a kill at any time costs the tasks in work and no row.
"""

import errno
import json
import os
import sqlite3
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import fields
from pathlib import Path
from typing import Literal, get_args

from tehl.errors import FileFormatError, InputError
from tehl.io.atomic import check_place
from tehl.result import Cost, Result
from tehl.studies.case import Case
from tehl.studies.row import Row

Keep = Literal["summary", "fields"]

FORMAT = 1
_ROWS, _FIELDS = "rows.sqlite", "fields"
_PATIENCE = 60.0
"""Seconds to wait for another study that writes into the same store."""
_ANEW = "bring back a copy of it, or remove it and all its cases are solved again"
_AT_ONCE = 500
"""Keys of one query."""
_COLUMNS = "key, status, cause, message, hint, summary, cpu_seconds, wall_seconds"
_WHOLE = "CASE WHEN json_valid(summary) THEN json_type(summary) = 'object' ELSE 0 END"
"""Whether the numbers of a row can be read, so that one without them is not taken for finished."""
_SCHEMA = f"""
CREATE TABLE IF NOT EXISTS rows (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, cause TEXT, message TEXT, hint TEXT,
    summary TEXT NOT NULL, cpu_seconds REAL NOT NULL, wall_seconds REAL NOT NULL
) WITHOUT ROWID;
PRAGMA user_version = {FORMAT};
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
        If the folder cannot be.
    FileFormatError
        If what lies there is no store of this version.
    """

    def __init__(self, directory: str | Path, keep: Keep = "summary") -> None:
        if keep not in get_args(Keep):
            raise InputError(f'keep = "{keep}" is not known: known are summary and fields')
        self.directory, self.keep = Path(directory), keep
        check_place(self.directory)
        self._connection: sqlite3.Connection | None = None
        if self._file.exists():
            self._open()

    def __del__(self) -> None:
        if getattr(self, "_connection", None) is not None:
            self.close()

    @property
    def _file(self) -> Path:
        return self.directory / _ROWS

    @property
    def fields_folder(self) -> Path:
        """The folder of the fields."""
        return self.directory / _FIELDS

    def fields_path(self, case: Case) -> Path:
        """Return where the fields of a case lie, if they are kept."""
        return self.fields_folder / f"{case.key}.nc"

    @property
    def is_begun(self) -> bool:
        """Whether there is a file for rows."""
        return self._file.exists()

    def row(self, case: Case) -> Row | None:
        """Return the row of a case, None when it is not finished."""
        return self.rows([case]).get(case.key)

    def rows(self, cases: Iterable[Case], *, summaries: bool = True) -> dict[str, Row]:
        """Return the rows of those cases that are finished, by key, if wanted without numbers.

        A row that is damaged is none.
        """
        columns = _COLUMNS if summaries else _COLUMNS.replace("summary", "'{}'")
        keys = list(dict.fromkeys(case.key for case in cases))
        if self._connection is None and not self._file.exists():
            return {}
        found: dict[str, Row] = {}
        with self._telling() as connection:
            for start in range(0, len(keys), _AT_ONCE):
                some = keys[start : start + _AT_ONCE]
                marks = ", ".join("?" * len(some))
                query = f"SELECT {columns} FROM rows WHERE key IN ({marks}) AND {_WHOLE}"
                rows = map(_row, connection.execute(query, some))
                found |= {row.key: row for row in rows if row is not None}
        return found

    def finished(self, cases: Iterable[Case]) -> dict[str, Row]:
        """Return the outcome of the cases that need no work, by key, without their numbers.

        Lost fields are work.
        """
        cases = list(cases)
        rows = self.rows(cases, summaries=False)
        if self.keep == "summary":
            return rows
        lost = {
            case.key
            for case in cases
            if case.key in rows
            and rows[case.key].has_fields
            and not self.fields_path(case).is_file()
        }
        return {key: row for key, row in rows.items() if key not in lost}

    def result(self, case: Case) -> Result | None:
        """Return the result of a case with all its fields, None when they are not kept.

        Raises
        ------
        FileFormatError
            If the file is damaged.
        """
        from tehl.io.store import load_as  # noqa: PLC0415 (rows do without HDF5)

        path = self.fields_path(case)
        return load_as(Result, path) if path.is_file() else None

    def put(self, *rows: Row) -> None:
        """Keep rows, all or none, in the place of older ones of the same keys.

        Raises
        ------
        OSError
            If they cannot be written: a full disk, a quota.
        """
        lines = [_line(row) for row in rows]
        self.prepare()
        with self._telling() as connection, connection:
            marks = ", ".join("?" * len(_COLUMNS.split(",")))
            connection.executemany(
                f"INSERT OR REPLACE INTO rows ({_COLUMNS}) VALUES ({marks})", lines
            )

    def prepare(self) -> None:
        """Make the folder and its files, if they are missing."""
        if self._connection is None:
            self.directory.mkdir(parents=True, exist_ok=True)
            self._open()
        if self.keep == "fields":
            self.fields_folder.mkdir(exist_ok=True)

    def sweep(self, cases: Collection[Case]) -> None:
        """Remove what killed workers left of writing the fields of ``cases``."""
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
        place, is_uri = self._address()
        self._connection = sqlite3.connect(
            place,
            timeout=_PATIENCE,
            isolation_level="IMMEDIATE",
            check_same_thread=False,
            uri=is_uri,
        )
        # half a letter is no reason not to read the others
        self._connection.text_factory = lambda text: text.decode("utf-8", "replace")
        with self._telling() as connection:
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            if version not in (0, FORMAT):
                self.close()
                raise FileFormatError(
                    f"{self._file} is a store of format {version}, this tehl knows {FORMAT}: "
                    f"{_ANEW}"
                )
            # a kill loses nothing that was committed, and no commit waits for the disk
            with suppress(sqlite3.OperationalError):  # file systems without shared memory
                connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = NORMAL")
            if version == 0:
                connection.executescript(_SCHEMA)

    def _address(self) -> tuple[str, bool]:
        """Return how to open the file of rows, and whether that is a URI: to read it only."""
        if os.access(self.directory, os.W_OK):
            return str(self._file), False
        log = self._file.with_name(f"{self._file.name}-wal")
        how = "mode=ro" if log.exists() else "immutable=1"  # without a log nobody writes it
        return f"{self._file.resolve().as_uri()}?{how}", True

    @contextmanager
    def _telling(self) -> Iterator[sqlite3.Connection]:
        """Yield the connection; its errors become ours."""
        if self._connection is None:
            self._open()
        assert self._connection is not None
        try:
            yield self._connection
        except sqlite3.OperationalError as error:
            full = "full" in str(error)
            code = errno.ENOSPC if full else errno.EIO
            raise OSError(code, f"{error}", str(self._file)) from error
        except sqlite3.DatabaseError as error:
            raise FileFormatError(
                f"{self._file} is no store of a study ({error}): {_ANEW}"
            ) from None


def _text(words: str | None) -> str | None:
    """Return words that a file can hold: names of files may have half letters."""
    return None if words is None else words.encode("utf-8", "replace").decode("utf-8")


def _line(row: Row) -> tuple[str | float | None, ...]:
    """Return a row as the columns have it."""
    return (
        row.key,
        row.status,
        *map(_text, (row.cause, row.message, row.hint)),
        json.dumps(dict(row.summary), allow_nan=False),
        row.cost.cpu_seconds,
        row.cost.wall_seconds,
    )


def _row(line: tuple[str, ...]) -> Row | None:
    """Return a row as the columns have it, None if it is damaged."""
    names = [f.name for f in fields(Row)][:5]
    try:
        return Row(
            **dict(zip(names, line[:5], strict=True)),
            summary=json.loads(line[5]),
            cost=Cost(cpu_seconds=float(line[6]), wall_seconds=float(line[7])),
        )
    except (ValueError, TypeError):
        return None
