"""The middle of the page: the chosen view of the present state, beside that of the pinned one."""

from dataclasses import replace
from typing import Any

import numpy as np
from nicegui import ui

from tehl.explore.axes import Picture
from tehl.explore.colour_map import (
    film_picture,
    fringes_picture,
    pressure_picture,
    section_picture,
    stress_picture,
    value_at,
)
from tehl.explore.curves import (
    line_charts,
    response_charts,
    values_at_frequency,
    values_on_line,
)
from tehl.explore.elements import Drawing, mark, read_at_pointer
from tehl.explore.relief import relief_figure
from tehl.explore.shown import Shown
from tehl.explore.tab import Tab


class Slot:
    """A place for the view of one state."""

    def __init__(self, name: str, *, bar: bool) -> None:
        self.bar, self.view = bar, ""
        self.shown: Shown | None = None
        self.picture: Picture | None = None
        self.charts: list[Picture] = []
        with ui.element("div").classes("slot") as self.place:
            self.title = ui.label(name).classes("slot-title")
            self.drawing = Drawing()
            self.readout = ui.label(" ").classes("readout")
            self.relief: ui.plotly | None = None
            read_at_pointer(self.drawing.overlay, self.readout, self._values_at)

    def draw(
        self,
        view: str,
        shown: Shown,
        limits: dict[str, Any],
        size: tuple[float, float],
        other: Shown | None = None,
    ) -> None:
        """Draw a view of a state; centre lines of another state are fainter."""
        self.view = view
        self.shown, self.picture = shown, None
        if view == "relief":
            self._turn(relief_figure(shown.maps, limits["film"], size))
            return
        if self.relief is not None:
            self.relief.delete()
            self.relief = None
        empty = f'<p class="empty">{_REASONS.get(view, "")}</p>'
        if view in ("lines", "dynamics"):
            self.charts = (
                line_charts(shown, size, limits["lines"], other)
                if view == "lines"
                else response_charts(shown, size)
            )
            self.drawing.show_lines("".join(chart.overlay for chart in self.charts) or empty)
            return
        picture = _picture(view, shown, limits, size, bar=self.bar)
        if picture is None:
            self.drawing.show_lines(empty)
            return
        self.picture = picture
        self.drawing.show(picture)

    def _turn(self, figure: dict[str, Any]) -> None:
        """Draw the relief, which keeps its angle of view."""
        self.drawing.show_lines("")
        if self.relief is None:
            with self.place:
                self.relief = ui.plotly(figure)
        else:
            self.relief.update_figure(figure)

    def _values_at(self, right: float, down: float) -> str:
        """Return the values at a pixel."""
        picture, shown = self.picture, self.shown
        if shown is not None and self.view == "lines":
            return values_on_line(shown.lines, self.charts, right, down)
        if shown is not None and self.view == "dynamics":
            return values_at_frequency(shown, self.charts, right)
        if picture is None or shown is None:
            return ""
        values = {"temperature": _rise, "stress": _shear}.get(self.view, _values)
        return values(shown, picture.frame.x.data(right), picture.frame.y.data(down))


_REASONS = {
    "temperature": "This contact is isothermal. Switch the heat on under “Heat”.",
    "fringes": "The interferogram is being computed.",
    "stress": "The stress is being computed.",
    "dynamics": "Stiffness and damping follow the film on its last grid, of steady films that oil "
    "alone carries.",
}


def _picture(
    view: str, shown: Shown, limits: dict[str, Any], size: tuple[float, float], *, bar: bool
) -> Picture | None:
    if view == "temperature":
        section = shown.section
        if section is None:
            return None
        return section_picture(section, shown.maps, limits["temperature"], size)
    if view == "stress":
        deep = shown.stress
        return None if deep is None else stress_picture(deep, shown.maps, limits["stress"], size)
    if view == "fringes":
        return None if shown.fringes is None else fringes_picture(shown, size)
    if view == "pressure":
        return pressure_picture(shown.maps, limits["pressure"], size, bar=bar)
    return film_picture(shown.maps, limits["film"], size, bar=bar)


def _values(shown: Shown, x: float, y: float) -> str:
    maps = shown.maps
    film = value_at(maps.x, maps.y, maps.film, x, y)
    pressure = value_at(maps.x, maps.y, maps.pressure, x, y)
    if film is None or pressure is None:
        return ""
    return f"x = {x:.0f} µm, y = {y:.0f} µm:  h = {film:.4g} nm,  p = {pressure:.3g} GPa"


def _rise(shown: Shown, x: float, zeta: float) -> str:
    section = shown.section
    if section is None:
        return ""
    across = np.linspace(0.0, 1.0, len(section.rise))
    rise = value_at(section.x, across, section.rise, x, zeta)
    if rise is None:
        return ""
    return f"x = {x:.0f} µm, z/h = {zeta:.2f}:  {section.inlet + rise:.4g} °C, {rise:+.3g} K"


def _shear(shown: Shown, x: float, z: float) -> str:
    deep = shown.stress
    value = None if deep is None else value_at(deep.x, deep.z, deep.shear, x, z)
    return "" if value is None else f"x = {x:.0f} µm, {-z:.0f} µm deep:  {value:.3g} GPa"


class PicturePanel:
    """The view of the present state, and of the pinned one at its left."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.size = (720.0, 620.0)
        with ui.element("div").classes("slots") as self.place:
            self.pinned, self.present = Slot("pinned", bar=False), Slot("present", bar=True)
        self.below = ui.html("", sanitize=False).classes("drawing")
        self.pinned.place.set_visibility(False)
        self.present.title.set_visibility(False)
        tab.listeners.append(self._hear)

    def set_visibility(self, visible: bool) -> None:
        """Show or hide all of it."""
        self.place.set_visibility(visible)
        self.below.set_visibility(visible)

    def resize(self, width: float, height: float) -> None:
        """Draw in another size."""
        if abs(width - self.size[0]) > 4 or abs(height - self.size[1]) > 4:
            self.size = (width, height)
            self.draw()

    def _hear(self, topic: str) -> None:
        if topic == "picture":
            self.draw()
        elif topic == "status":
            mark(self.present.place, "old", on=self.tab.is_old)

    def draw(self) -> None:
        """Draw the chosen view."""
        tab, view, shown, pinned = self.tab, self.tab.view, self.tab.shown, self.tab.pinned
        if shown is None or view in ("movie", "curves"):
            return
        beside = pinned is not None and view != "lines"
        self.pinned.place.set_visibility(beside)
        self.present.title.set_visibility(beside)
        self.below.set_content("")
        if pinned is None:
            self.present.draw(view, shown, tab.scales.limits, self.size)
            return
        present, other = _seen_in(shown, pinned.shown), _seen_in(pinned.shown, shown)
        if view == "lines":
            self.present.draw(view, present, tab.scales.limits, self.size, other)
            return
        self._draw_beside(view, present, other)

    def _draw_beside(self, view: str, present: Shown, other: Shown) -> None:
        """Draw two states side by side, above their centre lines along x; all sizes in pixels."""
        (width, height), limits = self.size, self.tab.scales.limits
        wide = width > 560.0
        bar = 70.0 if view in ("film", "pressure") else 0.0
        less, more = bar, 0.0  # both maps are of one size, and one has a colour bar
        if wide:
            width = 0.5 * (width - 16.0)
            less = more = 0.5 * bar
        self.pinned.draw(view, other, limits, (width - less, height))
        self.present.draw(view, present, limits, (width + more, height))
        if wide:
            chart = line_charts(present, (self.size[0], 440.0), limits["lines"], other)[0]
            self.below.set_content(chart.overlay)


def _seen_in(shown: Shown, other: Shown) -> Shown:
    """Return what is shown in the window that has those of two states."""
    spans = zip(shown.maps.window, other.maps.window, strict=True)
    x, y = ((min(a[0], b[0]), max(a[1], b[1])) for a, b in spans)
    return replace(shown, maps=replace(shown.maps, window=(x, y)))
