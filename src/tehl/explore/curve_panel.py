"""The view of curves: a control is swept in the background, points appear as they are solved."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from nicegui import ui

from tehl.base.errors import InputError
from tehl.explore.case_text import CaseText
from tehl.explore.controls import swept_knobs
from tehl.explore.curves import Point, nearest, swept_chart
from tehl.explore.elements import button, main_button, read_at_pointer
from tehl.explore.job_panel import JobPanel
from tehl.explore.knobs import Knob
from tehl.explore.numbers import value_of
from tehl.explore.sweeps import Sweep, Sweeps, Swept
from tehl.explore.tab import Tab

if TYPE_CHECKING:
    from tehl.explore.axes import Frame

_DEFAULT_POINTS = 13
_MOST_POINTS = 101
_ABOVE = {
    "friction": "contact.slide_roll_ratio",
    "power": "contact.slide_roll_ratio",
    "t_max": "contact.slide_roll_ratio",
    "p_max": "contact.load",
}
"""What a quantity is swept over at first; the others over speed."""
_SPEED = "contact.entrainment_speed"
_SLIDING = (0.003, 1.0)


@dataclass
class Curve:
    """A curve that is solved: what is swept between which ends, and its points so far."""

    knob: Knob
    span: tuple[float, float]
    wanted: int
    """Number of its points."""
    others: dict[str, Any]
    """Tables of the contact without the key that is swept."""
    points: list[Swept] = field(default_factory=list)

    @property
    def progress(self) -> str:
        """How many points are solved, and why the last one that failed did."""
        failed = [point for point in self.points if not point.numbers]
        words = f"{len(self.points)} of {self.wanted} points"
        return words + (f", {len(failed)} not converged: {failed[-1].words}" if failed else "")


class SweepForm:
    """Fields that state a sweep: a quantity, over which control, between which ends."""

    def __init__(self, tab: Tab, draw: Callable[[], None]) -> None:
        self.tab = tab
        self.quantity = ui.select({}, label="quantity", on_change=draw)
        self.over = ui.select({}, label="over", on_change=self.take_range)
        self.low = ui.input("from").classes("sweep-end")
        self.high = ui.input("to").classes("sweep-end")
        self.count = ui.number(
            "points", value=_DEFAULT_POINTS, min=3, max=_MOST_POINTS, precision=0
        )
        self.count.classes("sweep-end")
        for one in (self.quantity, self.over, self.low, self.high, self.count):
            one.props("dense outlined options-dense")

    @property
    def knob(self) -> Knob | None:
        """The control that is swept."""
        return swept_knobs(self.tab.groups).get(str(self.over.value))

    def offer(self) -> None:
        """Offer the controls of the case."""
        names = {path: knob.label for path, knob in swept_knobs(self.tab.groups).items()}
        kept = self.over.value if self.over.value in names else None
        self.over.set_options(names, value=kept or next(iter(names), None))

    def choose(self, key: str | None) -> None:
        """Choose a quantity, and what it is swept over at first."""
        assert self.tab.shown is not None
        names = {one.key: one.name for one in self.tab.shown.numbers}
        chosen = key or self.quantity.value or "h_central"
        if names != self.quantity.options or chosen != self.quantity.value:
            self.quantity.set_options(names, value=chosen if chosen in names else "h_central")
        if key is not None:
            wanted = _ABOVE.get(key, _SPEED)
            if wanted in self.over.options:
                self.over.set_value(wanted)
        if key is not None or not self.low.value:
            self.take_range()

    def take_range(self) -> None:
        """Propose the range around the present value."""
        knob = self.knob
        if knob is None:
            return
        low, high = knob.reach(knob.value)
        if knob.path == _ABOVE["friction"]:
            low, high = _SLIDING
        self.low.set_value(f"{knob.number(low, knob.unit):.4g}")
        self.high.set_value(f"{knob.number(high, knob.unit):.4g}")
        self.low.props(f'label="from{_in_brackets(knob.unit)}"')
        self.high.props(f'label="to{_in_brackets(knob.unit)}"')

    def stated(self) -> tuple[tuple[float, float], int]:
        """Return the ends and the number of points; an InputError if they are not valid."""
        span = ends(str(self.low.value), str(self.high.value))
        return span, int(min(max(self.count.value or _DEFAULT_POINTS, 3), _MOST_POINTS))


def _in_brackets(unit: str) -> str:
    return f" [{unit.replace('degC', '°C')}]" if unit else ""


class CurvePanel(JobPanel):
    """Curves of a tab, solved in the background."""

    def __init__(self, tab: Tab, sweeps: Sweeps) -> None:
        super().__init__(tab, sweeps, "sweep")
        self.curve: Curve | None = None
        self.size = (720.0, 480.0)
        self._drawn: tuple[Frame | None, list[Point], tuple[str, str]] = None, [], ("", "")
        with ui.element("div").classes("curves") as self.place:
            with ui.element("div").classes("sweep-choices"):
                self.form = SweepForm(tab, self.draw)
                main_button("Solve", self.start, icon="play_arrow")
                self.halt = button("Cancel", self.cancel)
                self.halt.set_visibility(False)
            with ui.element("div").classes("sweep-state"):
                self.state = ui.label("").classes("status-words")
                self.bar = ui.linear_progress(0.0, show_value=False).props('aria-label="progress"')
                self.bar.classes("sweep-bar")
                button("", self._save, icon="download", name="save the table, CSV")
            self.drawing = ui.html("", sanitize=False).classes("drawing")
            self.readout = ui.label(" ").classes("readout")
            read_at_pointer(self.drawing, self.readout, self._value_at)
        self.place.set_visibility(False)
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        if topic == "controls":
            self.form.offer()
        elif topic == "picture" and self.curve is not None and self._has_changed(self.curve):
            self._progress(self.curve)
        if topic in ("picture", "numbers") and self.tab.view == "curves":
            self.show()

    def show(self, key: str | None = None) -> None:
        """Show the panel, with the curve of a quantity."""
        self.place.set_visibility(self.tab.view == "curves")
        if self.tab.shown is not None:
            self.form.choose(key)
            self.draw()

    # ---- the sweep

    def start(self) -> None:
        """Solve the curve in the background."""
        knob = self.form.knob
        if knob is not None and self.submit(lambda: self._sweep(knob)) and self.curve is not None:
            self.halt.set_visibility(True)
            self._progress(self.curve)
            self.draw()

    def _sweep(self, knob: Knob) -> Sweep:
        """Return the sweep that is asked for, of which no point is solved yet."""
        tables, ((low, high), count) = self.tab.tables, self.form.stated()
        self.curve = Curve(knob, (low, high), count, self._others(knob))
        values = ((x, knob.stated(x, knob.unit)) for x in spread(low, high, count))
        return Sweep(tables, knob.path, tuple(values))

    def _others(self, knob: Knob) -> dict[str, Any]:
        """Return the tables of the contact without the key that is swept."""
        case = CaseText(self.tab.case.text)
        case.set(knob.path, None)
        return {name: table for name, table in case.tables.items() if name != "numerics"}

    def _has_changed(self, curve: Curve) -> bool:
        """Return whether the contact is no longer that of a curve."""
        return bool(curve.points) and curve.others != self._others(curve.knob)

    def _take(self, swept: Swept) -> None:
        if self.curve is not None:
            self.curve.points.append(swept)
            self._progress(self.curve)
            self.draw()

    def _end(self, *, cancelled: bool) -> None:
        self.halt.set_visibility(False)
        if cancelled and self.curve is not None:
            solved, wanted = len(self.curve.points), self.curve.wanted
            self.state.set_text(f"cancelled after {solved} of {wanted} points")

    def _progress(self, curve: Curve) -> None:
        changed = ". The contact has changed since: solve again" * self._has_changed(curve)
        self.state.set_text(curve.progress + changed)
        self.bar.set_value(len(curve.points) / max(curve.wanted, 1))

    # ---- the picture

    def resize(self, width: float, height: float) -> None:
        """Draw in another size."""
        self.size = (width, max(260.0, min(height - 110.0, 0.7 * width)))
        self.draw()

    def draw(self) -> None:
        """Draw the points that are there."""
        key, curve, shown = str(self.form.quantity.value), self.curve, self.tab.shown
        if curve is None:
            self.drawing.set_content(_INVITATION)
        if curve is None or shown is None or self.tab.view != "curves":
            return
        named, knob = value_of(shown.numbers, key), curve.knob
        name, unit = (named.name, named.unit) if named else (key, "")
        labels = (f"{knob.label}{_in_brackets(knob.unit)}", f"{name}{_in_brackets(unit)}")
        points = [self._point(one, key) for one in curve.points]
        chart = swept_chart(points, labels, self.size, curve.span, self._here(knob, key))
        self.drawing.set_content(chart.overlay)
        self._drawn = chart.frame, points, labels

    def _value_at(self, right: float, down: float) -> str:
        """Return the swept value nearest to a pixel."""
        del down
        frame, points, labels = self._drawn
        point = nearest(points, frame, right) if frame is not None else None
        if point is None or point.y is None:
            return ""
        bar = f" ± {abs(point.y * point.error):.2g}" if point.error else ""
        return f"{labels[0]} = {point.x:.4g}:  {labels[1]} = {point.y:.4g}{bar}"

    def _point(self, one: Swept, key: str) -> Point:
        found = value_of(one.numbers, key)
        value = found.value if found is not None else None
        return Point(one.x, value, (found.error or 0.0) if found is not None else 0.0)

    def _here(self, knob: Knob, key: str) -> Point | None:
        """Return the place of the present state, which moves with the slider."""
        stated, shown = self.tab.case.get(knob.path), self.tab.shown
        found = value_of(shown.numbers, key) if shown is not None else None
        if stated is None or found is None or self.tab.fault is not None:
            return None
        return Point(knob.number(knob.kind.parse(stated), knob.unit), found.value)

    def _save(self) -> None:
        if self.curve is not None and self.curve.points:
            table = table_of(self.curve.knob, self.curve.points)
            ui.download.content(table, "curve.csv", "text/csv")


_INVITATION = (
    '<p class="empty">Choose a quantity and what to sweep, then solve. '
    "Each point is a solve of its own, with its error bar.</p>"
)


def ends(low: str, high: str) -> tuple[float, float]:
    """Return the ends of a sweep as they were typed."""
    try:
        found = float(low.replace(",", ".")), float(high.replace(",", "."))
    except ValueError:
        raise InputError("from and to must be numbers") from None
    if not all(map(math.isfinite, found)):
        raise InputError("from and to must be finite numbers")
    if not found[0] < found[1]:
        raise InputError(f"from = {found[0]:g}: must be below to = {found[1]:g}")
    return found


def spread(low: float, high: float, count: int) -> tuple[float, ...]:
    """Return places from ``low`` to ``high``, the ends first and then ever closer ones.

    Equal steps of the logarithm over more than a factor of eight.
    """
    parts = [k / (count - 1) for k in range(count)]
    if low > 0 and high / low > 8.0:
        places = [low * (high / low) ** part for part in parts]
    else:
        places = [low + part * (high - low) for part in parts]
    order, step = [0, count - 1], count - 1
    while step > 1:
        step = math.ceil(step / 2)
        order += [k for k in range(0, count, step) if k not in order]
    return tuple(float(f"{places[k]:.5g}") for k in order)


def table_of(knob: Knob, points: list[Swept]) -> str:
    """Return a sweep as CSV: the control, then each quantity with its relative error."""
    import pandas as pd  # noqa: PLC0415 (0.5 s)

    swept = f"{knob.path} [{knob.unit or '1'}]"
    rows = list[dict[str, float | None]]()
    for point in (point for point in points if point.numbers):
        rows.append({swept: point.x})
        for one in point.numbers:
            rows[-1] |= {f"{one.key} [{one.unit or '1'}]": one.value, f"{one.key}_error": one.error}
    table = pd.DataFrame(rows, columns=None if rows else [swept]).sort_values(swept)
    return table.to_csv(index=False, float_format="%.6g")
