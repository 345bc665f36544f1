"""Columns of a table as people know them: names, units that suit, axes."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tehl.errors import InputError
from tehl.typing import Array

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

_WORDS = {
    "film.h_central_m": "central film thickness $h_c$",
    "film.h_min_m": "minimum film thickness $h_{min}$",
    "film.H_central_moes": "central film $H_c$ (Moes)",
    "film.H_min_moes": "minimum film $H_{min}$ (Moes)",
    "film.H_central": "central film $H_c$",
    "film.H_min": "minimum film $H_{min}$",
    "pressure.max_pa": "largest pressure",
    "groups.M": "M",
    "groups.L": "L",
    "groups.hertz_pressure_pa": "Hertz pressure $p_h$",
    "traction.mid_film": "traction coefficient",
    "temperature.film_rise_max_k": "largest temperature rise of the film",
    "temperature.mid_film_rise_central_k": "central temperature rise at mid-film",
    "roughness.lambda_ratio": "film over roughness λ",
    "contact.slide_roll_ratio": "slide-to-roll ratio $(u_1 - u_2)/u_m$",
    "contact.entrainment_speed": "entrainment speed $u_m$",
    "contact.load": "load $w$",
    "contact.hertz_pressure": "Hertz pressure $p_h$",
    "contact.moes_load": "M",
    "contact.moes_speed": "L",
}
"""Columns that have a name in words."""
_SUITABLE: dict[str, tuple[tuple[float, float, str], ...]] = {
    "m": ((1e-7, 1e9, "nm"), (1e-3, 1e6, "µm"), (1.0, 1e3, "mm")),
    "Pa": ((1e4, 1.0, "Pa"), (3e8, 1e-6, "MPa"), (np.inf, 1e-9, "GPa")),
    "Pa s": ((0.1, 1e3, "mPa s"),),
}
"""By SI unit: up to which value, by which factor, to which unit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Column:
    """Numbers of a table in the unit in which they are shown.

    Attributes
    ----------
    name : str
        Of the column.
    values : array
        As shown.
    factor : float
        From SI to what is shown; negative where the sign is turned.
    unit, si : str
        Unit as shown, and in SI; ``"1"`` where there is none.
    """

    name: str
    values: Array
    factor: float
    unit: str
    si: str

    @property
    def title(self) -> str:
        """What to write along an axis."""
        words = _WORDS.get(self.name, self.name.replace("_", " "))
        return words if self.unit == "1" else f"{words} [{self.unit}]"


def find_column(table: "pd.DataFrame", name: str) -> str:
    """Return the full name of a column; the last part will do where it tells columns apart.

    Raises
    ------
    InputError
        If there is none, or more than one.
    """
    names = [str(known) for known in table.columns]
    if name in names:
        return name
    alike = [known for known in names if known.endswith(f".{name}") and _is_value(known)]
    labels = [known for known in alike if known in names[: names.index("status")]]
    if 1 in (len(alike), len(labels)):
        return (labels or alike)[0]
    if alike:
        raise InputError(f"the table has several columns {name}: {', '.join(alike)}")
    close = [known for known in names if name.lower() in known.lower() and _is_value(known)][:6]
    hint = f"did you mean {' or '.join(close)}?" if close else f"it has {', '.join(names[:12])} ..."
    raise InputError(f"the table has no column {name}: {hint}")


def _is_value(name: str) -> bool:
    return not name.startswith("uncertainty.")


def numbers(table: "pd.DataFrame", name: str) -> Column:
    """Return a column of numbers; a minus before its name turns its sign.

    Raises
    ------
    InputError
        If there is no such column of numbers.
    """
    full = find_column(table, name.removeprefix("-"))
    try:
        values = table[full].to_numpy(np.float64, na_value=np.nan)
    except (TypeError, ValueError):
        raise InputError(f"the column {full} does not hold numbers") from None
    units: Mapping[str, str] = table.attrs.get("units", {})
    si = units.get(full, "1")
    finite = np.abs(values[np.isfinite(values)])
    factor, unit = _suitable(si, float(finite.max()) if finite.size else 0.0)
    factor = -factor if name.startswith("-") else factor
    return Column(name=full, values=values * factor, factor=factor, unit=unit, si=si)


def _suitable(si: str, largest: float) -> tuple[float, str]:
    for limit, factor, unit in _SUITABLE.get(si, ()):
        if largest < limit:
            return factor, unit
    return 1.0, si


def answers(table: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows that converged.

    Raises
    ------
    InputError
        If there are none.
    """
    found = table[table["status"] == "converged"]
    if not len(found):
        raise InputError("the table has no case that converged, so nothing to draw")
    return found


def dress(axes: "Axes", x: Column, y: Column, log: str) -> None:
    """Give axes their titles, scales and a light grid."""
    axes.set(xlabel=x.title, ylabel=y.title)
    for letter, axis, setter in (
        ("x", axes.xaxis, axes.set_xscale),
        ("y", axes.yaxis, axes.set_yscale),
    ):
        if letter in log:
            setter("log")
            _plain_decades(axis)
    axes.grid(lw=0.3, which="both" if log else "major")


def _plain_decades(axis: "Axis") -> None:
    """Label a logarithmic axis with plain numbers, and with 2 and 5 between few decades."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: PLC0415

    low, high = axis.get_view_interval()
    if 0 < low and high / low < 2e3:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def note_left_out(axes: "Axes", table: "pd.DataFrame") -> None:
    """Tell below the axes how many cases have no answer and are not shown."""
    unfinished = int((table["status"] == "open").sum())
    count = int((table["status"] != "converged").sum()) - unfinished
    words = f"{count} of {len(table)} cases have no answer and are left out" if count else ""
    if unfinished:
        words += f"{'; ' if count else ''}{unfinished} of {len(table)} are not finished yet"
    if words:
        axes.figure.supxlabel(words, fontsize=8, color="#b3001b")


def kinds(table: "pd.DataFrame", name: str | None) -> list[Any]:
    """Return the different values of a column in their order; one None without a column."""
    if name is None:
        return [None]
    found = table[find_column(table, name)]
    values = list(dict.fromkeys(found.dropna().tolist()))
    return sorted(values) if all(isinstance(v, int | float) for v in values) else values
