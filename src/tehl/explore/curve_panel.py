"""The view of curves: a control is swept in the background, points appear as they are solved."""

import math
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


class CurvePanel(JobPanel):
    """Curves of a tab, solved in the background."""

    def __init__(self, tab: Tab, sweeps: Sweeps) -> None:
        super().__init__(tab, sweeps, "sweep")
        self.points: list[Swept] = []
        self.knob: Knob | None = None
        self.span, self.wanted, self.size = (1.0, 10.0), 0, (720.0, 480.0)
        self._drawn: tuple[Frame | None, list[Point], tuple[str, str]] = None, [], ("", "")
        self._around: Any = None  # the case of the curve, without what is swept
        with ui.element("div").classes("curves") as self.place:
            self._build_choices()
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

    def _build_choices(self) -> None:
        with ui.element("div").classes("sweep-choices"):
            self.quantity = ui.select({}, label="quantity", on_change=self.draw)
            self.over = ui.select({}, label="over", on_change=self._take_range)
            self.low = ui.input("from").classes("sweep-end")
            self.high = ui.input("to").classes("sweep-end")
            self.count = ui.number(
                "points", value=_DEFAULT_POINTS, min=3, max=_MOST_POINTS, precision=0
            )
            self.count.classes("sweep-end")
            for field in (self.quantity, self.over, self.low, self.high, self.count):
                field.props("dense outlined options-dense")
            main_button("Solve", self.start, icon="play_arrow")
            self.halt = button("Cancel", self.cancel)
            self.halt.set_visibility(False)

    # ---- what is swept

    def _hear(self, topic: str) -> None:
        if topic == "controls":
            self._offer()
        elif topic == "picture" and self.points and self._around != self._others():
            self._progress()
        if topic in ("picture", "numbers") and self.tab.view == "curves":
            self.show()

    def _offer(self) -> None:
        """Offer the controls of the case."""
        names = {path: knob.label for path, knob in swept_knobs(self.tab.groups).items()}
        kept = self.over.value if self.over.value in names else None
        self.over.set_options(names, value=kept or next(iter(names), None))

    def show(self, key: str | None = None) -> None:
        """Show the panel, with the curve of a quantity."""
        shown = self.tab.shown
        self.place.set_visibility(self.tab.view == "curves")
        if shown is None:
            return
        names = {one.key: one.name for one in shown.numbers}
        chosen = key or self.quantity.value or "h_central"
        if names != self.quantity.options or chosen != self.quantity.value:
            self.quantity.set_options(names, value=chosen if chosen in names else "h_central")
        if key is not None:
            wanted = _ABOVE.get(key, _SPEED)
            if wanted in self.over.options:
                self.over.set_value(wanted)
            self._take_range()
        elif not self.low.value:
            self._take_range()
        self.draw()

    def _take_range(self) -> None:
        """Propose the range around the present value."""
        knob = swept_knobs(self.tab.groups).get(str(self.over.value))
        if knob is None:
            return
        low, high = knob.reach(knob.value)
        if knob.path == _ABOVE["friction"]:
            low, high = _SLIDING
        self.low.set_value(f"{knob.number(low, knob.unit):.4g}")
        self.high.set_value(f"{knob.number(high, knob.unit):.4g}")
        unit = f" [{knob.unit.replace('degC', '°C')}]" if knob.unit else ""
        self.low.props(f'label="from{unit}"')
        self.high.props(f'label="to{unit}"')

    # ---- the sweep

    def start(self) -> None:
        """Solve the curve in the background."""
        knob = swept_knobs(self.tab.groups).get(str(self.over.value))
        if knob is not None and self.submit(lambda: self._sweep(knob)):
            self._around = self._others()
            self.halt.set_visibility(True)
            self._progress()
            self.draw()

    def _sweep(self, knob: Knob) -> Sweep:
        """Return the sweep that is asked for, of which no point is solved yet."""
        tables, (low, high) = self.tab.tables, ends(str(self.low.value), str(self.high.value))
        count = int(min(max(self.count.value or _DEFAULT_POINTS, 3), _MOST_POINTS))
        self.points, self.knob, self.span, self.wanted = [], knob, (low, high), count
        values = ((x, knob.stated(x, knob.unit)) for x in spread(low, high, count))
        return Sweep(tables, knob.path, tuple(values))

    def _others(self) -> dict[str, Any] | None:
        """Return the tables of the contact without the key that is swept."""
        if self.knob is None:
            return None
        case = CaseText(self.tab.case.text)
        case.set(self.knob.path, None)
        return {name: table for name, table in case.tables.items() if name != "numerics"}

    def _take(self, swept: Swept) -> None:
        self.points.append(swept)
        self._progress()
        self.draw()

    def _end(self, *, cancelled: bool) -> None:
        self.halt.set_visibility(False)
        if cancelled:
            self.state.set_text(f"cancelled after {len(self.points)} of {self.wanted} points")

    def _progress(self) -> None:
        failed = [point for point in self.points if not point.numbers]
        words = f"{len(self.points)} of {self.wanted} points"
        if failed:
            words += f", {len(failed)} not converged: {failed[-1].words}"
        if self._around != self._others():
            words += ". The contact has changed since: solve again"
        self.state.set_text(words)
        self.bar.set_value(len(self.points) / max(self.wanted, 1))

    # ---- the picture

    def resize(self, width: float, height: float) -> None:
        """Draw in another size."""
        self.size = (width, max(260.0, min(height - 110.0, 0.7 * width)))
        self.draw()

    def draw(self) -> None:
        """Draw the points that are there."""
        key, knob, shown = str(self.quantity.value), self.knob, self.tab.shown
        if knob is None or shown is None or self.tab.view != "curves":
            if knob is None:
                self.drawing.set_content(_INVITATION)
            return
        named = value_of(shown.numbers, key)
        unit = f" [{named.unit}]" if named and named.unit else ""
        x_unit = f" [{knob.unit.replace('degC', '°C')}]" if knob.unit else ""
        labels = (f"{knob.label}{x_unit}", f"{named.name if named else key}{unit}")
        points = [self._point(one, key) for one in self.points]
        chart = swept_chart(points, labels, self.size, self.span, self._here(knob, key))
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
        if self.points and self.knob is not None:
            ui.download.content(_table_of(self.knob, self.points), "curve.csv", "text/csv")


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


def _table_of(knob: Knob, points: list[Swept]) -> str:
    """Return a sweep as CSV: the control, then each quantity with its relative error."""
    known = [point for point in points if point.numbers]
    keys = [one.key for one in known[0].numbers] if known else []
    head = [f"{knob.path} [{knob.unit or '1'}]"]
    for key in keys:
        one = value_of(known[0].numbers, key)
        unit = one.unit if one is not None else ""
        head += [f"{key} [{unit or '1'}]", f"{key}_error"]
    lines = [",".join(head)]
    for point in sorted(known, key=lambda point: point.x):
        cells = [f"{point.x:.6g}"]
        for key in keys:
            one = value_of(point.numbers, key)
            value, error = (one.value, one.error) if one is not None else (None, None)
            cells += ["" if cell is None else f"{cell:.6g}" for cell in (value, error)]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"
