"""A table of measurements: printed as aligned text, stored as JSON."""

from dataclasses import dataclass, field

Cell = str | float | int | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """Rows of one topic.

    Attributes
    ----------
    title : str
        What the rows measure.
    columns : tuple of str
        Names with units.
    rows : list of tuple
        One cell per column.
    notes : list of str
        Lines below the table.
    """

    title: str
    columns: tuple[str, ...]
    rows: list[tuple[Cell, ...]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def text(self) -> str:
        """Return the table as aligned text."""
        lines = [self.columns, *(tuple(map(show, row)) for row in self.rows)]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        body = [
            "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True))
            for line in lines
        ]
        return "\n".join([self.title, "-" * len(self.title), *body, *self.notes, ""])

    def as_dict(self) -> dict[str, object]:
        """Return the table for JSON."""
        return {
            "title": self.title,
            "rows": [dict(zip(self.columns, row, strict=True)) for row in self.rows],
            "notes": self.notes,
        }


def show(cell: Cell) -> str:
    """Return a cell as text, numbers to three or four digits."""
    if cell is None:
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
