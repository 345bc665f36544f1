"""Lists of contacts: a row of a spreadsheet per contact, and its film, friction and bars beside it.

A heading states a key of the case file, or a word for it, and a unit: ``load [N]``, ``p_h (GPa)``,
``temperature / degC``, ``speed in m/s``, ``load_N``; the units may stand in a row of their own.
What a row does not state is that of the template.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tehl.api.problem import case_from_tables
from tehl.base.atomic import shortened
from tehl.base.errors import InputError
from tehl.base.lists import Doubtful, Spelling, lines_of, spelling_of, value_of
from tehl.contact.problem import ContactProblem
from tehl.io.case import changed, tables_of_text, toml_tables
from tehl.io.templates import template_text
from tehl.studies.case import Case
from tehl.studies.headings import (
    NO_WORDS,
    Column,
    are_units,
    by_unit,
    check_columns,
    column_of,
    unit_of,
)

TEMPLATE = "ball-on-disc"
"""The template of a list that has none."""
TITLE = "title"
"""Key of a text, which numbers of rows are too."""
_RADII = ("radius", "radius_x", "radius_y")


_ALTERNATIVES = (
    ("contact.load", "contact.load_per_length", "contact.hertz_pressure", "contact.moes_load"),
    ("contact.entrainment_speed", "contact.moes_speed"),
    ("surface_1.rms_roughness", "surface_1.ra_roughness"),
    ("surface_2.rms_roughness", "surface_2.ra_roughness"),
    ("numerics.error", "numerics.points"),
    *(
        tuple(f"surface_{side}.{key}" for key in ("temperature", "thermal_resistance", "cooling"))
        for side in (1, 2)
    ),
    ("lubricant.temperature", "thermal.temperature"),
)
"""Keys of which a case states one: a row that states another removes that of the template."""


WALTHER = "walther"
"""The law of the viscosities of a data sheet."""
_DATA_SHEET = ("lubricant.viscosity.nu_40", "lubricant.viscosity.nu_100")
"""Keys of Walther's law alone: a row that states them replaces another law of the template."""
_ON, _OFF = ("yes", "true", "x", "ja"), ("no", "false", "nein")
"""Words below the name of a table, such as ``thermal``, which a contact has, or has not."""


@dataclass(frozen=True, slots=True)
class Listed:
    """A row of a list: where it stands, its cells, and its case or what is wrong with it."""

    number: int
    """Of the row in the file, from 1."""
    cells: tuple[Any, ...]
    case: Case | None
    message: str = ""
    taken: tuple[str, ...] = ()
    """Columns whose cell is empty, so that the template states it."""


@dataclass(frozen=True, slots=True)
class Contacts:
    """A list that was read."""

    columns: tuple[Column, ...]
    rows: tuple[Listed, ...]
    spelling: Spelling = Spelling()  # noqa: RUF009 (frozen)
    """Of the file, in which its answers are written as CSV."""

    @property
    def cases(self) -> list[Case]:
        """Cases of the rows that are right."""
        return [row.case for row in self.rows if row.case is not None]

    @property
    def carried(self) -> list[str]:
        """Headings of columns of words that state nothing of a contact."""
        return [one.heading for one in self.columns if one.key is None and one.heading]

    @property
    def wrong(self) -> list[Listed]:
        """Rows that are not."""
        return [row for row in self.rows if row.case is None]


# ---- reading


def read_contacts(path: Path, template: Path | None = None) -> Contacts:
    """Return the list of contacts of a file.

    Parameters
    ----------
    path : Path
        CSV as spreadsheets save it, Excel or Parquet.
    template : Path or None
        Case file with what the rows do not state; that of ``tehl new ball-on-disc`` if left out.

    Raises
    ------
    InputError
        If the file cannot be read, or a heading is not known; wrong rows are kept with their
        message.
    """
    base, folder = template_tables(template)
    lines = lines_of(path, "list of contacts")
    try:
        return replace(contacts_of(lines, base, folder), spelling=spelling_of(path))
    except InputError as error:
        raise InputError(f"{shortened(path)}: {error}") from None


def template_tables(template: Path | None) -> tuple[dict[str, Any], Path | None]:
    """Return the tables of a template and the folder in which its files are.

    Without one the error of the films is the default.
    """
    if template is None:
        tables = tables_of_text(template_text(TEMPLATE))
        return {name: keys for name, keys in tables.items() if name != "numerics"}, None
    try:
        return toml_tables(template), template.parent
    except InputError as error:
        raise InputError(f"template {shortened(template)}: {error}") from None


def contacts_of(
    lines: list[tuple[int, list[Any]]], base: dict[str, Any], folder: Path | None
) -> Contacts:
    """Return the list of contacts of lines.

    Parameters
    ----------
    lines : list of (int, list)
        Numbers and cells of the rows, headings with units first.
    base : dict
        Tables of a case that each row completes.
    folder : Path or None
        Where relative paths of measured surfaces begin.
    """
    columns, body = columns_and_rows(lines)
    rows = tuple(_listed(number, cells, columns, base, folder) for number, cells in body)
    return Contacts(columns=tuple(columns), rows=rows)


def columns_and_rows(
    lines: list[tuple[int, list[Any]]], others: Mapping[str, str] = NO_WORDS
) -> tuple[list[Column], list[tuple[int, list[Any]]]]:
    """Return the columns of a list, and its rows below the headings and units.

    Parameters
    ----------
    lines : list of (int, list)
        Numbers and cells of the rows, headings first.
    others : Mapping
        Names of columns that are not keys of a case, by words of their headings.

    Raises
    ------
    InputError
        If there is no row, or a heading is not known.
    """
    if len(lines) < 2:
        raise InputError("has no contacts: the first row has the headings, each other one contact")
    columns = [column_of("" if cell is None else str(cell), others) for cell in lines[0][1]]
    body = lines[1:]
    if are_units(body[0][1]):
        units = ["" if cell is None else str(cell) for cell in body[0][1]]
        columns = [
            Column(_with_unit(one, unit), one.key, unit_of(unit) or one.unit)
            for one, unit in zip(columns, units, strict=True)
        ]
        body = body[1:]
    columns = [by_unit(one) for one in columns]
    check_columns(columns, [line for _, line in body])
    if not body:
        raise InputError("has no contacts below its units")
    return columns, body


def _with_unit(column: Column, unit: str) -> str:
    """Return the heading with a unit that stands below it: answers have it in one row."""
    stated = not column.heading or column.unit or not unit
    return column.heading if stated else f"{column.heading} [{unit.strip('[]() ')}]"


def stated_in(columns: Sequence[Column], cells: Sequence[Any]) -> dict[str, Any]:
    """Return the values that a row states by the keys of its columns, with their units.

    Parameters
    ----------
    columns : sequence of Column
        Those without a key are left out.
    cells : sequence
        Of the row, in the same order; None is empty.

    Raises
    ------
    InputError
        If a cell that is not the title may be two numbers.
    """
    stated = [
        (one, cell)
        for one, cell in zip(columns, cells, strict=True)
        if one.key is not None and cell is not None
    ]
    for one, cell in stated:
        if isinstance(cell, Doubtful) and one.key != TITLE:
            raise InputError(f'column "{one.heading}": {cell.mistake}')
    return {
        str(one.key): str(cell) if one.key == TITLE else value_of(cell, one.unit)
        for one, cell in stated
    }


def _listed(
    number: int,
    cells: Sequence[Any],
    columns: Sequence[Column],
    base: dict[str, Any],
    folder: Path | None,
) -> Listed:
    """Return a row with its case, or with what is wrong in it."""
    try:
        stated = stated_in(columns, cells)
        problem, options = case_from_tables(tables_of(base, stated), folder)
        if problem.transient is not None or problem.has_passes:
            raise InputError("a list of contacts has steady ones: leave out transient and passes")
    except InputError as error:
        text = str(error)
        for one in columns:
            if one.key is not None and text.startswith(one.key):
                text = f'column "{one.heading}": {text}'
                break
        return Listed(number, tuple(cells), None, f"row {number}: {text}")
    labels: dict[str, float | str] = {"row": float(number)}
    if "max_time" not in options.model_fields_set:  # starts no finer grid after a minute
        options = options.model_copy(update={"max_time": 60.0})
    case = Case(name=f"row {number}", problem=problem, options=options, labels=labels)
    known = {*stated, *_replaced(stated), TITLE}
    taken = (one.heading for one in columns if one.key not in known and _states(base, one.key))
    return Listed(number, tuple(cells), case, taken=tuple(taken))


def _states(tables: Any, key: str | None) -> bool:
    """Return whether tables have a value at a key path."""
    for name in (key or "").split("."):
        if not isinstance(tables, Mapping) or name not in tables:
            return False
        tables = tables[name]
    return True


def tables_of(base: dict[str, Any], stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a case.

    Parameters
    ----------
    base : dict
        Tables of the template, which are not changed.
    stated : Mapping
        What a row states instead, by key path.
    """
    tables = base
    for key in _replaced(stated):
        tables = changed(tables, key, value=False)
    if "lubricant.oil" in stated:
        before = tables.get("lubricant")
        kept = before.items() if isinstance(before, dict) else ()
        tables = tables | {"lubricant": {k: v for k, v in kept if k == "temperature"}}
    elif any(key in stated for key in _DATA_SHEET) and _law_of(tables) != WALTHER:
        tables = changed(tables, "lubricant.viscosity", {"law": WALTHER})
    for key, value in stated.items():
        tables = changed(tables, key, _switched(key, value, base))
    return tables


def _switched(key: str, value: Any, base: Mapping[str, Any]) -> Any:
    """Return the table that a row switches on or off, as that of the template; else ``value``."""
    word = str(value).lower()
    if word in (*_ON, *_OFF) and "." not in key and key != TITLE:
        return base.get(key, {}) if word in _ON else False
    table = ContactProblem.model_fields.get(key)
    if table is not None and table.default is None and isinstance(value, str):
        raise InputError(f"{key} = {value}: must be yes or no, with or without the table [{key}]")
    return value


def _law_of(tables: Mapping[str, Any]) -> str:
    """Return the law of viscosity that tables state; Walther's where they leave it to an oil."""
    lubricant = tables.get("lubricant")
    viscosity = lubricant.get("viscosity") if isinstance(lubricant, dict) else None
    return str(viscosity.get("law", WALTHER)) if isinstance(viscosity, dict) else WALTHER


def _replaced(stated: Mapping[str, Any]) -> Iterator[str]:
    """Yield keys of a template that cannot stand beside those that a row states."""
    for group in _ALTERNATIVES:
        if any(key in stated for key in group):
            yield from group
    for table in {key.partition(".")[0] for key in stated if key.rpartition(".")[2] in _RADII}:
        others = ("surface_1", "surface_2") if table == "contact" else (table,)
        for name in ("contact", *others):
            yield from (f"{name}.{key}" for key in _RADII)
