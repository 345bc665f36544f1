"""The table of a study as a notebook shows it: the main columns with units, and a picture."""

from html import escape
from typing import TYPE_CHECKING, Any

import pandas as pd

from tehl.base.lazy import lazy
from tehl.result.quantity import UNITS
from tehl.result.registry import shown_in

if TYPE_CHECKING:
    from tehl import plots
    from tehl.report import notebook as notebooks
else:
    plots = lazy("tehl.plots")
    notebooks = lazy("tehl.report.notebook")

_SHOWN_ROWS = 30
_LEAST_ROWS = 3
"""Rows that are shown, and converged cases from which on a curve is drawn."""


class StudyTable(pd.DataFrame):
    """A table of cases; a notebook shows its main columns and a curve, and all of it is there."""

    @property
    def _constructor(self) -> Any:
        return StudyTable

    def _repr_html_(self) -> str:
        """Return status, labels and main numbers as HTML, with a curve of the film."""
        if not {"status", "name", "film.h_central_m"} <= set(self.columns):
            return str(super()._repr_html_())
        labels = list(self.columns[1 : list(self.columns).index("status")])
        known = _columns()
        shown = [key for key in known if key in self.columns and self[key].notna().any()]
        units = self.attrs.get("units", {})
        heads = [_head(label, units.get(label, "1")) for label in labels]
        heads += ["status", *(known[key][0] for key in shown)]
        factors = {key: known[key][1] for key in shown}
        rows = "".join(
            self._row(row, labels, factors) for row in range(min(len(self), _SHOWN_ROWS))
        )
        rest = f"<p>{len(self) - _SHOWN_ROWS} more cases</p>" if len(self) > _SHOWN_ROWS else ""
        head = "".join(f"<th>{escape(word)}</th>" for word in heads)
        page = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{rest}"
        return page + self._curve(labels)

    def _row(self, number: int, labels: list[str], factors: dict[str, float]) -> str:
        line = self.iloc[number]
        cells = [_cell(line[label]) for label in labels]
        status = str(line["status"]).replace("_", " ")
        cause = line.get("cause")
        cells.append(status if not isinstance(cause, str) else f"{status}: {cause}")
        cells += [_cell(factor * line[key]) for key, factor in factors.items()]
        return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"

    def _curve(self, labels: list[str]) -> str:
        """Return the central film over the first label of numbers, nothing with too few cases."""
        numbers = [label for label in labels if pd.api.types.is_numeric_dtype(self[label])]
        converged = self[self["status"] == "converged"]
        if not numbers or converged[numbers[0]].nunique() < _LEAST_ROWS:
            return ""

        values = converged[numbers[0]]
        log = "x" if values.min() > 0 and values.max() > 8 * values.min() else ""
        figure = plots.curves(self, numbers[0], "film.h_central_m", log=log)
        return notebooks.image_html(figure, f"central film over {numbers[0]}")


def _columns() -> dict[str, tuple[str, float]]:
    """Return heading and factor from SI of the columns that are shown, films with their bars."""
    found: dict[str, tuple[str, float]] = {}
    for one in shown_in("notebook"):
        found[one.path] = (_head(one.words["notebook"], one.unit or "1"), UNITS[one.unit][0])
        if one.block == "film":
            found[one.error_path] = ("± [%]", 100.0)
    return found


def _head(label: str, unit: str) -> str:
    return label if unit == "1" else f"{label} [{unit}]"


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return value
    return "–" if pd.isna(value) else f"{value:.4g}"
