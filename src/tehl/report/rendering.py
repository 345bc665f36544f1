"""Templates of the texts and pages of a case or result, and the units in which they show values."""

import math
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from tehl.estimate.film_formulas import lubrication
from tehl.report.readable import error_text, length, seconds
from tehl.result import quantity

if TYPE_CHECKING:
    from jinja2 import Environment

    from tehl.result.bars import Estimate

FILTERS = {
    **{"": "plain", "nm": "nm", "um": "um", "MPa": "mpa", "GPa": "gpa", "K": "kelvin"},
    **{"°C": "celsius", "N": "newton", "W": "watt", "N/um": "newton_per_um"},
    "N/mm": "newton_per_mm",
    **{"N s/m": "newton_second_per_m", "N mm": "newton_mm", "mrad": "mrad", "%": "share"},
}
"""Names of the filters by the units of `tehl.result.quantity`."""
UNITS = {
    name: (quantity.UNITS[unit][0], f" {unit}".replace("um", "µm").rstrip())
    for unit, name in FILTERS.items()
    if unit != "°C"
}
"""Factor from SI and unit, by name of the filter."""


def render(template: str, **content: Any) -> str:
    """Return a template of ``report/templates`` filled with ``content``."""
    return _environment().get_template(template).render(content)


@cache
def _environment() -> "Environment":
    """Return the templates with their filters; all values of pages are escaped."""
    # Takes 0.1 s, which `tehl explain --json` and studies need not spend.
    from jinja2 import Environment, PackageLoader, StrictUndefined  # noqa: PLC0415

    found = Environment(
        loader=PackageLoader("tehl", "report/templates"),
        autoescape=lambda name: str(name).endswith(".html"),
        extensions=["jinja2.ext.do"],
        lstrip_blocks=True,
        trim_blocks=True,
        undefined=StrictUndefined,
    )
    found.filters |= {name: partial(_in_unit, name) for name in UNITS} | {
        "bar": _bar,
        "celsius": lambda kelvin: f"{kelvin - 273.15:.4g} °C",
        "degc": lambda kelvin: f"{kelvin - 273.15:.4g} degC",
        "degrees": math.degrees,
        "error": error_text,
        "about": lambda number: f"{float(f'{number:.2g}'):,.0f}",
        "g": lambda value, digits=4: f"{value:.{digits}g}",
        "plain": lambda value, digits=1: f"{float(f'{value:.{digits}g}'):g}",  # 20, not 2e+01
        "lubrication": lubrication,
        "metres": lambda value: _in_unit("nm" if value < 1e-6 else "um", value),
        "off": lambda formula, value: f"{100 * (formula / value - 1):+.1f} %",
        "percent": lambda part, digits=2: f"{float(f'{100 * part:.{digits}g}'):g} %",
        "seconds": lambda time: seconds(time).replace("us", "µs"),
        "size": length,
        "time": seconds,
        "unit": lambda value, name: _in_unit(name, value),
        "filter": lambda one: FILTERS[one.unit],
    }
    found.tests["numeral"] = _is_numeral
    found.globals["zip"] = zip
    return found


def _in_unit(name: str, value: float, digits: int = 4) -> str:
    """Return a value in SI with its unit."""
    factor, word = UNITS[name]
    return f"{value * factor:.{digits}g}{word}"


def _bar(estimate: "Estimate | None", name: str) -> str:
    """Return a certified value in SI with its error bar."""
    if estimate is None:
        return ""
    factor, word = UNITS[name]
    return f"{estimate.value * factor:.5g} ± {estimate.uncertainty * factor:.2g}{word}"


def _is_numeral(text: str) -> bool:
    """Return whether a cell is a number, perhaps with a unit or an error bar."""
    begins = text[:1].isdigit() or text[:2].lstrip("-+±").isdigit()
    return begins and len(text.split()) <= 4
