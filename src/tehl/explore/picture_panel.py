"""The middle of the page: the chosen view of the present state, beside that of the pinned one."""

from typing import Any

import numpy as np
from nicegui import ui

from tehl.explore.colour_map import (
    Picture,
    film_picture,
    fringes_picture,
    pressure_picture,
    section_picture,
    value_at,
)
from tehl.explore.curves import line_charts
from tehl.explore.relief import relief_figure
from tehl.explore.shown import Shown
from tehl.explore.tab import Tab, joined

_POINTER = """(event) => {
    const box = event.currentTarget.getBoundingClientRect();
    emit([event.clientX - box.left, event.clientY - box.top]);
}"""
_GAP = 16.0


class Slot:
    """A place for the view of one state."""

    def __init__(self, name: str) -> None:
        self.shown: Shown | None = None
        self.picture: Picture | None = None
        with ui.element("div").classes("slot") as self.place:
            self.title = ui.label(name).classes("slot-title")
            with ui.element("div").classes("picture"):
                self.image = ui.element("img").props('alt="" draggable=false')
                self.drawing = ui.html("", sanitize=False).classes("drawing")
            self.readout = ui.label(" ").classes("readout")
            self.relief: ui.plotly | None = None
            self.drawing.on("mousemove", self._point, js_handler=_POINTER, throttle=0.04)
            self.drawing.on("mouseleave", lambda: self.readout.set_text(" "))

    def draw(
        self, view: str, shown: Shown, limits: dict[str, Any], size: tuple[float, float]
    ) -> None:
        """Draw a view of a state."""
        self.shown, self.picture = shown, None
        if view == "relief":
            self._turn(relief_figure(shown.maps, limits["film"], size))
            return
        if self.relief is not None:
            self.relief.delete()
            self.relief = None
        if view == "lines":
            charts = line_charts(shown.lines, size, limits["lines"])
            self._put(None, "".join(chart.drawing for chart in charts))
            return
        picture = _picture(view, shown, limits, size)
        if picture is None:
            self._put(None, f'<p class="empty">{_REASONS.get(view, "")}</p>')
            return
        self.picture = picture
        self._put(picture, picture.overlay)

    def _turn(self, figure: dict[str, Any]) -> None:
        """Draw the relief, which keeps its angle of view."""
        self._put(None, "")
        if self.relief is None:
            with self.place:
                self.relief = ui.plotly(figure)
        else:
            self.relief.update_figure(figure)

    def _put(self, picture: Picture | None, drawing: str) -> None:
        if picture is None:
            self.image.style("display:none")
        else:
            left, top, width, height = picture.place
            self.image.props["src"] = picture.image
            self.image.style(
                f"display:block;left:{left:.1f}px;top:{top:.1f}px;"
                f"width:{width:.1f}px;height:{height:.1f}px"
            )
        self.drawing.set_content(drawing)

    def _point(self, event: Any) -> None:
        """Show the values under the pointer."""
        picture, shown = self.picture, self.shown
        if picture is None or shown is None:
            return
        place = event.args[0] if isinstance(event.args[0], list) else event.args
        x, y = picture.frame.x.data(place[0]), picture.frame.y.data(place[1])
        self.readout.set_text(_values(shown, x, y) or " ")

    def rise(self, x: float, zeta: float) -> float | None:
        """Return the temperature rise at a place of the section."""
        section = self.shown.section if self.shown else None
        if section is None:
            return None
        return value_at(section.x, np.linspace(0.0, 1.0, len(section.rise)), section.rise, x, zeta)


_REASONS = {
    "temperature": "This contact is isothermal. Switch the heat on under “Heat”.",
    "fringes": "The interferogram is being computed.",
}


def _picture(
    view: str, shown: Shown, limits: dict[str, Any], size: tuple[float, float]
) -> Picture | None:
    if view == "temperature":
        section = shown.section
        if section is None:
            return None
        return section_picture(section, shown.maps, limits["temperature"], size)
    if view == "fringes":
        return None if shown.fringes is None else fringes_picture(shown, size)
    if view == "pressure":
        return pressure_picture(shown.maps, limits["pressure"], size)
    return film_picture(shown.maps, limits["film"], size)


def _values(shown: Shown, x: float, y: float) -> str:
    maps = shown.maps
    film = value_at(maps.x, maps.y, maps.film, x, y)
    pressure = value_at(maps.x, maps.y, maps.pressure, x, y)
    if film is None or pressure is None:
        return ""
    return f"x = {x:.0f} µm, y = {y:.0f} µm:  h = {film:.4g} nm,  p = {pressure:.3g} GPa"


class PicturePanel:
    """The view of the present state, and of the pinned one at its left."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        self.size = (720.0, 620.0)
        with ui.element("div").classes("slots") as self.place:
            self.pinned, self.present = Slot("pinned"), Slot("present")
        self.pinned.place.set_visibility(False)
        self.present.title.set_visibility(False)
        tab.listeners.append(self._hear)

    def resize(self, width: float, height: float) -> None:
        """Draw in another size."""
        if abs(width - self.size[0]) > 4 or abs(height - self.size[1]) > 4:
            self.size = (width, height)
            self.draw()

    def _hear(self, topic: str) -> None:
        if topic == "picture":
            self.draw()

    def draw(self) -> None:
        """Draw the chosen view."""
        tab, view = self.tab, self.tab.view
        if tab.shown is None or view in ("movie", "curves"):
            return
        pinned = tab.pinned
        self.pinned.place.set_visibility(pinned is not None)
        self.present.title.set_visibility(pinned is not None)
        limits, size = tab.limits, self.size
        if pinned is not None:
            if self.size[0] > 700:
                size = (0.5 * (size[0] - _GAP), size[1])
            self.pinned.draw(view, pinned.shown, limits, size)
        self.present.draw(view, tab.shown, limits, size)


def common(first: dict[str, Any], second: dict[str, Any]) -> dict[str, Any]:
    """Return scales that have two states."""
    return {key: joined(first[key], second[key]) for key in first if key in second}
