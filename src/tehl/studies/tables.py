"""One tidy table of a study: a row per case, a column per label and per number of the summary."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from tehl.studies.case import Case
from tehl.studies.columns import OUTCOME
from tehl.studies.row import Scalar, unit_of
from tehl.studies.store import Store

if TYPE_CHECKING:
    import pandas as pd

_OPEN = "open"
"""Status of a case that is not finished."""


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
        Columns ``name``, the labels, ``status``, ``cause``, ``message``, every scalar of the
        summary by its dotted name: ``film.h_min_m``, and ``key``, under which fields are kept.
        ``attrs["units"]`` has the unit of each column of numbers.
    """
    import pandas as pd  # noqa: PLC0415 (0.5 s)

    cases = list(cases)
    rows = store.rows(cases)
    lines: list[dict[str, Scalar]] = []
    for case in cases:
        row = rows.get(case.key)
        outcome = (_OPEN, None, None) if row is None else (row.status, row.cause, row.message)
        line = {"name": case.name, **case.labels, **dict(zip(OUTCOME, outcome, strict=True))}
        lines.append(line | dict({} if row is None else row.summary) | {"key": case.key})
    frame = pd.DataFrame(lines, columns=_columns(cases, lines))
    numbers = [
        name
        for name, kind in frame.dtypes.items()
        if pd.api.types.is_numeric_dtype(kind) and not pd.api.types.is_bool_dtype(kind)
    ]
    known = units or {}
    frame.attrs["units"] = {name: known.get(name) or unit_of(name) for name in numbers}
    return frame


def _columns(cases: list[Case], lines: list[dict[str, Scalar]]) -> list[str]:
    """Return the names of the columns: labels first, numbers in the order of the summary."""
    labels = [label for case in cases for label in case.labels]
    numbers = [name for line in lines for name in line]
    names = dict.fromkeys(["name", *labels, *OUTCOME, *numbers])
    return [name for name in names if name != "key"] + ["key"]
