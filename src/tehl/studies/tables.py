"""The table of a study: a row per case, a column per label and per number of the summary."""

import difflib
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tehl.base.lazy import lazy
from tehl.io.summary import history_columns
from tehl.result.registry import OWNERS, columns
from tehl.result.solution import settings_text
from tehl.studies.case import Case, Scalar, unit_of
from tehl.studies.store import Store

if TYPE_CHECKING:
    import pandas as pd

    from tehl.studies import frame as frames
else:
    frames = lazy("tehl.studies.frame")

OPEN = "open"
"""Status of a case that is not finished."""
_OUTCOME = ("status", "cause", "message")
_BUILT_IN = ("name", *_OUTCOME, "hint", "retry_settings", "key")
"""Columns that every table has, the hint of a case, and the settings of a retry."""

_START = "start."
_MIRROR = "uncertainty"
"""Block that repeats the names of others."""
_INDEX = re.compile(r"\.\d+(?=\.|$)")


def table(
    cases: Iterable[Case], store: Store, units: Mapping[str, str] | None = None
) -> "pd.DataFrame":
    """Return the outcome of each case, those that are not finished as ``status = "open"``.

    Parameters
    ----------
    cases : iterable of Case
        The study; the table has their order.
    store : Store
        Where their rows are.
    units : mapping of str to str
        Units of the labels, ``"1"`` where they have none.

    Returns
    -------
    pandas.DataFrame
        A notebook shows its main columns and a curve.
        Columns ``name``, the labels, ``status``, ``cause``, ``message``, every scalar of the
        summary by its dotted name: ``film.h_min_m``, and ``key``, under which fields are kept.
        ``attrs["units"]`` has the unit of each column of numbers.
    """
    cases = list(cases)
    rows = store.rows(cases)
    lines: list[dict[str, Scalar]] = []
    for case in cases:
        line: dict[str, Scalar] = {"name": case.name, **case.labels}
        row = rows.get(case.key)
        if row is None:
            line |= {"status": OPEN, "cause": None, "message": None}
        else:
            line |= {name: getattr(row, name) for name in _OUTCOME} | dict(row.summary)
            if row.retry_settings:
                line["retry_settings"] = settings_text(row.retry_settings)
        lines.append(line | {"key": case.key})
    labels = [label for case in cases for label in case.labels]
    names = dict.fromkeys(["name", *labels, *_OUTCOME, *(name for line in lines for name in line)])
    frame = frames.StudyTable(lines, columns=[*(name for name in names if name != "key"), "key"])
    numbers = frame.select_dtypes("number").columns
    known = units or {}
    frame.attrs["units"] = {name: known.get(name) or unit_of(name) for name in numbers}
    return frame


def is_reserved(name: str) -> bool:
    """Return whether a column of this name has another meaning in every table."""
    block, dot, _ = name.partition(".")
    return name in _BUILT_IN or bool(dot and (block in OWNERS or block == _MIRROR))


def is_number(name: str) -> bool:
    """Return whether a summary may have a column of this full name."""
    if name.startswith(_START):  # the steady film of a transient run
        return is_number(name.removeprefix(_START))
    if name in history_columns():
        return True
    return _INDEX.sub(".0", name) in columns() or name.partition(".")[0] == _MIRROR


def missing_column(labels: Iterable[str], name: str) -> str | None:
    """Return why a table with these axes cannot have a column, None where it can.

    A picture names the column in full or by its last part, optionally with a minus before it.

    Parameters
    ----------
    labels : iterable of str
        Names of the axes of the study.
    name : str
        Full path or last part of it, perhaps with a minus before it.
    """
    wanted = name.removeprefix("-")
    known = [*labels, *_BUILT_IN, *columns(), *history_columns()]
    endings = (f".{wanted}", f".{_INDEX.sub('.0', wanted)}")
    if is_number(wanted) or any(f".{column}".endswith(endings) for column in known):
        return None
    last = [column.rpartition(".")[2] for column in known]
    close = difflib.get_close_matches(wanted, [*known, *last], n=1, cutoff=0.6)
    hint = f"did you mean {close[0]}?" if close else f"it has {', '.join(known[:8])} ..."
    return f"the table will have no column {wanted}: {hint}"
