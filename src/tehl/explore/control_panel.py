"""The left side of the page: a row for each control, made again when others are needed."""

import math
from collections.abc import Callable
from typing import Any

from nicegui import ui

from tehl.explore.elements import button, plain
from tehl.explore.knobs import Choice, Group, Knob
from tehl.explore.tab import Tab

_SLIDER_PLACES, _EDGE_PLACES = 200, 2
"""Places of a slider, and those at either end from which its range moves on."""


class ControlPanel:
    """The controls of a tab; ``measured`` asks for a measured surface."""

    def __init__(self, tab: Tab, measured: Callable[[], None]) -> None:
        self.tab, self.measured = tab, measured
        self.rows: dict[str, Row] = {}
        self.opened = dict[str, bool]()
        self.place = ui.column().classes("controls")
        tab.listeners.append(self._hear)

    def _hear(self, topic: str) -> None:
        if topic == "controls":
            self.build()
        elif topic == "fault":
            self._show_fault()

    def build(self) -> None:
        """Make the rows of the present controls."""
        self.place.clear()
        self.rows = {}
        with self.place:
            for group in self.tab.groups:
                self._build_group(group)
        self._show_fault()

    def _build_group(self, group: Group) -> None:
        is_open = self.opened.get(group.name, group.is_open)
        with ui.expansion(group.name, value=is_open).classes("group") as part:
            part.props("dense header-class=group-head")
            part.on_value_change(lambda event: self.opened.update({group.name: event.value}))
            for item in group.items:
                if isinstance(item, Knob):
                    self.rows[item.path] = KnobRow(self.tab, item)
                else:
                    self.rows[item.path] = ChoiceRow(self.tab, item)
            if group.name == "Surfaces":
                button("Measured surface", self.measured, icon="upload")

    def _show_fault(self) -> None:
        """Show what is wrong beside its control."""
        fault = self.tab.fault
        for path, row in self.rows.items():
            row.blame(fault.text if fault is not None and fault.path == path else "")


class Row:
    """A control with a place for what is wrong with it."""

    def __init__(self) -> None:
        self.fault = ui.label("").classes("fault").props('role="alert"')
        self.fault.set_visibility(False)

    def blame(self, text: str) -> None:
        """Show a sentence below the control, none if it is empty."""
        self.fault.set_text(text)
        self.fault.set_visibility(bool(text))


class KnobRow(Row):
    """Label, exact entry, unit and slider of a number."""

    def __init__(self, tab: Tab, knob: Knob) -> None:
        self.tab, self.knob, self.unit = tab, knob, knob.unit
        self.value, self.reach = knob.value, knob.reach(knob.value)
        self.left_at: float | None = None
        self.is_refused = False
        with ui.element("div").classes("knob"):
            with ui.element("div").classes("knob-head"):
                ui.label(knob.label).classes("knob-label")
                self.entry = ui.input(value=self._words()).props("dense outlined hide-bottom-space")
                self.entry.props(f'input-class="entry" aria-label="{knob.label}"').classes("entry")
                self.entry.on("keydown.enter", self._typed).on("blur", self._typed)
                self._unit_selector()
            self.slider = ui.slider(min=0, max=_SLIDER_PLACES, step=1, value=self._place())
            self.slider.props(f'aria-label="{knob.label}" dense').classes("knob-slider")
            self.slider.on(
                "update:model-value", self._moved, [None], throttle=0.03, leading_events=True
            )
            self.slider.on("change", self._released, [None])
            super().__init__()

    def _unit_selector(self) -> None:
        if len(self.knob.units) > 1:
            names = {unit: unit.replace("degC", "°C") for unit in self.knob.units}
            chosen = ui.select(names, value=self.unit, on_change=self._other_unit)
            chosen.props(f'dense borderless options-dense aria-label="unit of {self.knob.label}"')
            chosen.classes("unit")
        else:
            ui.label(self.unit.replace("degC", "°C")).classes("unit lone")

    def _words(self) -> str:
        return f"{self.knob.number(self.value, self.unit):.5g}"

    # ---- the slider

    def _place(self) -> int:
        return round(_SLIDER_PLACES * self.knob.part(self.value, self.reach))

    def _at(self, place: float) -> float:
        """Return the value at a place of the slider, to three digits."""
        number = self.knob.number(self.knob.at(place / _SLIDER_PLACES, self.reach), self.unit)
        size = abs(number)
        if not self.knob.spreads(self.reach):
            low, high = (self.knob.number(end, self.unit) for end in self.reach)
            size = abs(high - low)
        step = 10.0 ** (math.floor(math.log10(max(size, 1e-12))) - 2)
        return round(number / step) * step

    def _moved(self, event: Any) -> None:
        place = float(plain(event.args))
        if place != self.left_at:  # the last place is sent again after the release
            self._set(place, moving=True)

    def _released(self, event: Any) -> None:
        self.left_at = float(plain(event.args))
        self._set(self.left_at, moving=False)
        if self.knob.is_log and not _EDGE_PLACES < self.left_at < _SLIDER_PLACES - _EDGE_PLACES:
            self._centre()

    def _set(self, place: float, *, moving: bool) -> None:
        if moving:
            self.left_at = None
        number = self._at(place)
        self.value, self.is_refused = self.knob.si(number, self.unit), False
        self.entry.set_value(f"{number:.5g}")
        self.tab.turn(self.knob, number, self.unit, moving=moving)

    def _centre(self) -> None:
        self.reach = self.knob.reach(self.value)
        self.slider.set_value(self._place())

    # ---- the entry

    def _typed(self) -> None:
        words = str(self.entry.value)
        if words == self._words() and not self.is_refused:
            return
        self.tab.type(self.knob, words, self.unit)
        stated = self.tab.case.get(self.knob.path)
        try:
            self.value = self.knob.kind.parse(stated)
            if not math.isfinite(self.value):  # a flat has no such control
                return
        except ValueError:  # it stays in the entry, beside the sentence on it
            self.is_refused = True
            return
        self.is_refused = False
        self.entry.set_value(self._words())
        self._centre()

    def _other_unit(self, event: Any) -> None:
        self.unit = event.value
        self.entry.set_value(self._words())


class ChoiceRow(Row):
    """Label and selector of one of several words."""

    def __init__(self, tab: Tab, choice: Choice) -> None:
        self.tab, self.choice = tab, choice
        with ui.element("div").classes("choice"):
            ui.label(choice.label).classes("knob-label")
            self.selector = ui.select(
                {option: name for option, (name, _) in choice.options.items()},
                value=choice.value,
                on_change=lambda event: tab.choose(choice.path, event.value),
            )
            self.selector.props(f'dense outlined options-dense aria-label="{choice.label}"')
            self.selector.classes("choice-selector")
            super().__init__()
