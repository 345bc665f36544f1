"""What a list of contacts gives back: a line per row with its answers and bars, in a table."""

import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tehl.api.problem import ContactProblem
from tehl.base.atomic import replacing
from tehl.base.lists import check_format, lines_of_frame, plain_value
from tehl.base.units import percentage
from tehl.base.wording import grid_size
from tehl.estimate.scaling import ScaledProblem
from tehl.report.plausibility import untypical
from tehl.result.derived import film_loss, is_unphysical
from tehl.result.quantity import Quantity
from tehl.result.registry import shown_in
from tehl.studies.case import Row
from tehl.studies.contacts import (
    TITLE,
    Contacts,
    Listed,
    contacts_of,
    stated_in,
    template_tables,
)
from tehl.studies.headings import Column, column_of
from tehl.studies.plan import for_parquet
from tehl.studies.runner import QUIET, StudyMonitor, run
from tehl.studies.store import Store, opened

if TYPE_CHECKING:
    import pandas as pd

_CHUNK = 500
"""Rows whose outcome is in memory at a time."""


def heading_of(one: Quantity) -> str:
    """Return the heading of a quantity in a list, with its unit."""
    return f"{one.words['list']} [{one.unit}]" if one.unit else one.words["list"]


def values_of(numbers: Mapping[str, Any]) -> dict[str, float]:
    """Return the answers of a converged row by their headings, each followed by its bar.

    Parameters
    ----------
    numbers : mapping of str to number
        Those of the summary of the row.
    """
    found: dict[str, float] = {}
    for one in shown_in("list"):
        if is_unphysical(one.path, numbers):
            continue
        value = numbers.get(one.path) if one.block else one.of(numbers)
        if not isinstance(value, int | float):
            continue
        found[heading_of(one)] = shown = one.shown(value)
        bar = one.error_in(numbers)
        if isinstance(bar, int | float):
            found[f"± {heading_of(one)}"] = abs(shown * bar)
    return found


def answers(contacts: Contacts, store: Store) -> Iterator[dict[str, Any]]:
    """Yield a line for each row: cells, answers with their bars, regime, and how it was obtained.

    An answer that the row states itself, such as its tilting moment, is left out. Rows are taken
    from the store in parts, so that the memory does not grow with the list.

    Parameters
    ----------
    contacts : Contacts
        Rows of the list; one without a valid case has its message only.
    store : Store
        With the finished cases; the other rows have their cells only.
    """
    for first in range(0, len(contacts.rows), _CHUNK):
        part = contacts.rows[first : first + _CHUNK]
        known = store.rows([row.case for row in part if row.case is not None])
        for row in part:
            found = None if row.case is None else known.get(row.case.key)
            yield _line(row, contacts.columns, found)


def _line(row: Listed, columns: Sequence[Column], found: Row | None) -> dict[str, Any]:
    line: dict[str, Any] = {
        one.heading: cell for one, cell in zip(columns, row.cells, strict=True) if one.heading
    }
    if found is not None and found.converged:
        stated = stated_in(columns, row.cells)
        values = values_of(found.summary)
        line |= {name: value for name, value in values.items() if _key_of(name) not in stated}
        line["regime"] = found.summary.get("roughness.lubrication")
    doubts = [] if row.case is None else untypical(ScaledProblem.of(row.case.problem))
    line["status"] = "wrong row" if row.case is None else found.status if found else "open"
    obtained = row.message if row.case is None else _obtained(found, row.taken)
    line["obtained"] = "; please check: ".join([obtained, *doubts])
    return line


@cache
def _key_of(name: str) -> str | None:
    """Return the key of the case that the heading of an answer, or of its bar, states."""
    return column_of(name.removeprefix("± ")).key


_EYRING = "state lubricant.shear.law = eyring and lubricant.shear.stress = 5 MPa"


def _obtained(row: Row | None, taken: Sequence[str] = ()) -> str:
    """Return how a row was obtained, or why not, in a sentence.

    ``taken`` are the columns that the template states for it.
    """
    if row is None:
        return "not solved yet"
    if not row.converged:
        hint = f" {row.hint}" if row.hint else ""
        return f"{row.message or row.cause or row.status}{hint}"
    errors = [row.summary.get(f"errors.{name}") for name in ("central", "minimum")]
    worst = max((one for one in errors if isinstance(one, int | float)), default=None)
    nx, ny = (int(row.summary.get(f"cost.points.{axis}") or 0) for axis in (0, 1))
    text = f"solved on {grid_size((nx, ny))}"
    if worst is not None:
        text = f"{text}, film to {percentage(worst)}"
    if taken:
        text = f"{text}; of the template: {', '.join(taken)}"
    if row.summary.get("traction.credible") is False:
        why = "as this oil shears at more stress than oils bear"
        text = f"{text}; no friction or heat, {why}: {_EYRING}"
    elif (
        row.summary.get("traction.friction_power_w") is not None and film_loss(row.summary) is None
    ):
        text = f"{text}; no loss, as that by rolling comes out negative in the loaded zone"
    return f"{text}. {row.message} {row.hint}" if row.hint else text  # converged, but uncertain


def _headings_of(lines: Iterable[Mapping[str, Any]], contacts: Contacts) -> list[str]:
    """Return the columns of the answers: those of the list, and those that any line has."""
    seen = dict.fromkeys(name for line in lines for name in line)
    stated = [one.heading for one in contacts.columns if one.heading]
    ordered = [
        name
        for one in shown_in("list")
        for name in (heading_of(one), f"± {heading_of(one)}")
        if name in seen
    ]
    rest = [name for name in ("regime", "status", "obtained") if name in seen]
    return [*stated, *(name for name in ordered if name not in stated), *rest]


# ---- writing


def check_output(path: Path) -> None:
    """Raise if the format of the answers is not known, or needs a package that is missing."""
    check_format(path, (".csv", ".xlsx", ".parquet"), "a list")


def write_answers(contacts: Contacts, store: Store, path: Path) -> None:
    """Write the answers as CSV in the spelling of the list, Excel or Parquet.

    Parameters
    ----------
    contacts : Contacts
        Rows of the list.
    store : Store
        With the finished cases.
    path : Path
        Ends in .csv, .xlsx or .parquet; written whole or not at all.
    """
    check_output(path)
    headings = _headings_of(answers(contacts, store), contacts)
    lines = answers(contacts, store)
    with replacing(path) as temporary:
        if path.suffix.lower() == ".xlsx":
            known = (one for one in contacts.columns if one.key not in (None, TITLE))
            _write_sheet(headings, lines, temporary, numeric={one.heading for one in known})
        else:
            frame = _frame_of(headings, lines)
            if path.suffix.lower() == ".csv":
                contacts.spelling.write(frame, temporary)
            else:
                for_parquet(frame).to_parquet(temporary, index=False)


def _frame_of(headings: Sequence[str], lines: Iterable[Mapping[str, Any]]) -> "pd.DataFrame":
    """Return lines as a frame with these columns; texts stay what they are, `Doubtful` too."""
    import pandas as pd  # noqa: PLC0415 (0.5 s)

    columns: dict[str, list[Any]] = {name: [] for name in headings}
    for line in lines:
        for name, column in columns.items():
            column.append(line.get(name))
    has_text = {name: any(isinstance(one, str) for one in columns[name]) for name in headings}
    return pd.DataFrame(
        {
            name: pd.Series(column, dtype=object if has_text[name] else None)
            for name, column in columns.items()
        }
    )


def _number_of(value: Any) -> Any:
    """Return the number that a cell of a list shows as text, such as "80"; else what it has."""
    found = plain_value(value) if isinstance(value, str) else value
    return found if isinstance(found, int | float) else value


def _write_sheet(
    headings: Sequence[str],
    lines: Iterable[Mapping[str, Any]],
    path: Path,
    *,
    numeric: Container[str],
) -> None:
    """Write a sheet as engineers do: headings, a row of units, both frozen, numbers formatted.

    Texts of the columns ``numeric`` are numbers where they can be; no text is a formula.
    """
    from openpyxl import Workbook  # noqa: PLC0415 (an extra)
    from openpyxl.styles import Alignment, Font  # noqa: PLC0415
    from openpyxl.utils import get_column_letter  # noqa: PLC0415

    book = Workbook()
    page = book.active
    page.title = "contacts"
    split = [re.fullmatch(r"(.*?)(?: \[(.*)\])?", name, re.DOTALL) for name in headings]
    names = [match[1] if match else name for match, name in zip(split, headings, strict=True)]
    page.append(names)
    page.append([(match[2] or "") if match else "" for match in split])
    formats = {heading_of(one): one.digits for one in shown_in("list")}
    formats |= {f"± {name}": f"{digits}0" for name, digits in formats.items()}
    widest = [len(name) for name in names]
    for number, line in enumerate(lines, 3):
        for place, name in enumerate(headings, 1):
            value = line.get(name)
            if value is None:
                continue
            value = _number_of(value) if name in numeric else value
            cell = page.cell(number, place, value)
            if name in formats:
                cell.number_format = formats[name]
            elif isinstance(value, str):
                cell.data_type = "s"  # not a formula
                widest[place - 1] = max(widest[place - 1], min(len(value), 60))
    for place, width in enumerate(widest, 1):
        page.column_dimensions[get_column_letter(place)].width = max(8, width + 2)
        for row in (1, 2):
            page.cell(row, place).font = Font(bold=row == 1, italic=row == 2)
            page.cell(row, place).alignment = Alignment(wrap_text=row == 1, vertical="top")
    page.freeze_panes = "A3"
    page.auto_filter.ref = f"A2:{get_column_letter(len(headings))}{page.max_row}"
    book.save(path)


def solve_contacts(
    frame: "pd.DataFrame",
    template: str | Path | ContactProblem | None = None,
    *,
    jobs: int = 1,
    store: str | Path | None = None,
    monitor: StudyMonitor = QUIET,
) -> "pd.DataFrame":
    """Solve a list of contacts; return the list with what was found beside each row.

    Parameters
    ----------
    frame : pandas.DataFrame
        A row per contact. Columns are keys of the case file or words for them, with a unit:
        ``"load [N]"``, ``"p_h (GPa)"``, ``"contact.slide_roll_ratio"``; numbers without one are SI.
    template : str, Path, ContactProblem or None
        Case file or contact with what the columns do not state; that of
        ``tehl new ball-on-disc`` if left out.
    jobs : int
        Processes. With more than one, a script needs ``if __name__ == "__main__":``.
    store : str, Path or None
        Folder in which finished contacts are kept and found again; nowhere if left out.
    monitor : StudyMonitor
        Takes the reports.

    Returns
    -------
    pandas.DataFrame
        The columns of ``frame``, the quantities that a list shows (`tehl.result.quantities`) with
        units and bars, ``regime``, ``status`` and ``obtained``, with the index of ``frame``.

    Raises
    ------
    InputError
        If a column is not known. A wrong row has the status ``"wrong row"``, and the others are
        solved.
    """
    if isinstance(template, ContactProblem):
        base, folder = template.model_dump(mode="json", exclude_unset=True), None
    else:
        base, folder = template_tables(None if template is None else Path(template))
    contacts = contacts_of(lines_of_frame(frame), base, folder)
    with closing(opened(store)) as kept:
        run(contacts.cases, kept, jobs=jobs, monitor=monitor)
        lines = list(answers(contacts, kept))
    found = _frame_of(_headings_of(lines, contacts), lines)
    found.index = frame.index[-len(found) :]
    return found
