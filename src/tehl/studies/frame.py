"""The table of a study as a notebook shows it: the main columns with units, and a picture."""

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
"""Rows that are shown."""


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
        known, units = _columns(), self.attrs.get("units", {})
        shown = [key for key in known if key in self.columns and self[key].notna().any()]
        rows = self.iloc[:_SHOWN_ROWS]
        causes = rows["cause"] if "cause" in rows else [None] * len(rows)
        outcomes = [
            status.replace("_", " ") + (f": {cause}" if isinstance(cause, str) else "")
            for status, cause in zip(rows["status"], causes, strict=True)
        ]
        cells = [*(rows[label] for label in labels), pd.Series(outcomes, rows.index)]
        page = pd.concat([*cells, *(known[key][1] * rows[key] for key in shown)], axis=1)
        heads = [_head(label, units.get(label, "1")) for label in labels]
        page.columns = pd.Index([*heads, "status", *(known[key][0] for key in shown)])
        rest = f"<p>{len(self) - _SHOWN_ROWS} more cases</p>" if len(self) > _SHOWN_ROWS else ""
        style: Any = {"index": False, "border": 0, "na_rep": "–", "float_format": "{:.4g}".format}
        return f"{page.to_html(**style)}{rest}{self._curve(labels)}"

    def _curve(self, labels: list[str]) -> str:
        """Return the central film over the first label of numbers, nothing with two cases."""
        numbers = [label for label in labels if pd.api.types.is_numeric_dtype(self[label])]
        converged = self[self["status"] == "converged"]
        if not numbers or converged[numbers[0]].nunique() < 3:
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
