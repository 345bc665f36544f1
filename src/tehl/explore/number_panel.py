"""The right side of the page: numbers with error bars and formulas, status, questions."""

import math
import re
from collections.abc import Callable
from functools import partial
from html import escape

from nicegui import ui

from tehl.explore.elements import button, mark
from tehl.explore.numbers import Number, value_of
from tehl.explore.tab import Tab
from tehl.report.readable import LARGEST_SHOWN_ERROR, error_text

_BAR_RANGE = 0.3
"""Relative deviation at the ends of the drawn error bar."""
_MAIN = ("h_central", "h_min", "p_max", "friction")
"""Numbers that stay in sight on a narrow screen."""


class NumberPanel:
    """The numbers of a tab; ``sweep`` is called with a quantity whose curve is wanted."""

    def __init__(self, tab: Tab, sweep: Callable[[str], None]) -> None:
        self.tab, self.sweep = tab, sweep
        self.rows: dict[str, ui.html] = {}
        self.place = ui.column().classes("numbers")
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        if topic == "numbers":
            self.update()
        elif topic == "status":
            mark(self.place, "old", on=self.tab.is_old)

    def update(self) -> None:
        """Show the numbers of the present result."""
        shown = self.tab.shown
        if shown is None:
            return
        keys = [one.key for one in shown.numbers]
        if keys != list(self.rows):
            self._build(shown.numbers)
        pinned = self.tab.pinned
        for one in shown.numbers:
            other = value_of(pinned.shown.numbers, one.key) if pinned else None
            self.rows[one.key].set_content(number_html(one, other))

    def _build(self, found: tuple[Number, ...]) -> None:
        self.place.clear()
        self.rows = {}
        with self.place:
            for one in found:
                with ui.element("div").classes("number"):
                    row = ui.html("", sanitize=False).classes("number-text")
                    row.props(f'data-key="{one.key}"')
                    self.rows[one.key] = row
                    name = f"curve of the {one.name}"
                    sweep = partial(self.sweep, one.key)
                    button("", sweep, icon="show_chart", name=name).classes("sweep")


class MainNumbers:
    """The main numbers in one line, which stays in sight on a narrow screen."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.line = ui.html("", sanitize=False).classes("main-numbers")
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        shown = self.tab.shown
        if topic == "numbers" and shown is not None:
            found = (value_of(shown.numbers, key) for key in _MAIN)
            self.line.set_content("".join(_in_brief(one) for one in found if one is not None))
        elif topic == "status":
            mark(self.line, "old", on=self.tab.is_old)


def _in_brief(one: Number) -> str:
    value = "" if one.value is None else f"{_rounded(one.value, 3)} {escape(one.unit)}"
    return f"<span><i>{_marked(one.symbol)}</i> {value or '–'}</span>"


def number_html(one: Number, other: Number | None) -> str:
    """Return a number with its error bar, its formulas and the pinned one."""
    name = f'<span class="name">{escape(one.name)}</span> <i>{_marked(one.symbol)}</i>'
    if one.value is None:
        return f'<div class="head">{name}</div><div class="remark">{escape(one.remark)}</div>'
    parts = [f'<div class="head">{name}</div>']
    parts.append(f'<div class="value">{value_text(one)}{_change(one, other)}</div>')
    parts.append(_bar(one))
    if one.formulas:
        words = " · ".join(
            f"<span>{escape(author)} {_rounded(value, 3)}</span>" for author, value in one.formulas
        )
        parts.append(f'<div class="formulas">{words}</div>')
    if one.remark:
        parts.append(f'<div class="remark">{escape(one.remark)}</div>')
    return "".join(parts)


def value_text(one: Number) -> str:
    """Return a number with its error bar and unit."""
    assert one.value is not None
    unit = f" <small>{escape(one.unit)}</small>" if one.unit else ""
    if one.by_formula:
        return f'<b>{_rounded(one.value, 3)}</b>{unit} <span class="bar">by formula</span>'
    if one.error is None or not math.isfinite(one.error) or one.value == 0.0:
        return f"<b>{_rounded(one.value, 4)}</b>{unit}"
    if abs(one.error) > LARGEST_SHOWN_ERROR:
        words = f"error {error_text(one.error)}"
        return f'<b>{_rounded(one.value, 4)}</b>{unit} <span class="bar">{words}</span>'
    half = abs(one.value * one.error)
    places = max(0, 1 - math.floor(math.log10(half))) if half > 0 else 4
    value, bar = (f"{number:.{places}f}".replace("-", "−") for number in (one.value, half))
    return f'<b>{value}</b> <span class="bar">± {bar}</span>{unit}'


def _rounded(value: float, digits: int) -> str:
    """Round a number to significant digits, without an exponent from 1e-5 to 1e7."""
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-5 < abs(value) < 1e7:
        text = f"{float(text):.10f}".rstrip("0").rstrip(".")
    return text.replace("-", "−")


def _marked(words: str) -> str:
    """Return words with their indices set low."""
    return re.sub(r"_(\w+)", r"<sub>\1</sub>", escape(words))


def _change(one: Number, other: Number | None) -> str:
    if other is None or other.value is None or one.value is None:
        return ""
    if one.unit == "°C":  # a ratio of temperatures on this scale has no meaning
        change = f"{one.value - other.value:+.1f} K"
    elif other.value:
        change = f"{100.0 * (one.value / other.value - 1.0):+.1f} %"
    else:
        return ""
    words = f"{change} from pinned {_rounded(other.value, 4)}".replace("-", "−")
    return f' <span class="change">{words}</span>'


def _bar(one: Number) -> str:
    """Return a drawing of the relative error bar, with the formulas as marks."""
    if not one.value or (one.error is None and not one.by_formula):
        return ""
    parts = ['<path d="M0 7H100" class="track"/>', '<path d="M50 2V12" class="middle"/>']
    words = "no error bar yet"
    if one.error is not None:
        half = min(abs(one.error) / _BAR_RANGE, 1.0) * 50.0
        parts.insert(1, f'<path d="M{50 - half:.2f} 7H{50 + half:.2f}" class="band"/>')
        words = f"error bar {error_text(one.error)}"
    for author, value in one.formulas:
        away = (value / one.value - 1.0) / _BAR_RANGE
        if abs(away) <= 1.0:
            at = 50 + 50 * away
            name = f"<title>{escape(author)}</title>"
            parts.append(f'<path d="M{at:.2f} 3V11" class="formula">{name}</path>')
    drawing = "".join(parts)
    return (
        f'<svg class="error-bar" viewBox="0 0 100 14" preserveAspectRatio="none" role="img" '
        f'aria-label="{words}">{drawing}</svg>'
    )


class Explanation:
    """What formulas say about the case, and its odd values."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.groups = ui.html("", sanitize=False).classes("groups")
        self.questions = ui.html("", sanitize=False).classes("questions")
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        found = self.tab.explained
        if topic != "explained" or found is None:
            return
        rows = "".join(f"<dt>{_marked(a)}</dt><dd>{escape(b)}</dd>" for a, b in found.groups)
        self.groups.set_content(f"<dl>{rows}</dl>")
        if found.questions:
            items = "".join(f"<li>{escape(one)}</li>" for one in found.questions)
            self.questions.set_content(f"<h3>Worth a look</h3><ul>{items}</ul>")
        else:
            self.questions.set_content('<p class="fine">All values are plausible.</p>')
