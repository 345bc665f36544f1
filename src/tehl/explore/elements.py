"""Elements that several parts of the page share: quiet buttons, and pictures of maps."""

from collections.abc import Callable
from typing import Any

from nicegui import ui

from tehl.explore.colour_map import Picture


def button(
    words: str, action: Callable[[], Any] | None = None, *, icon: str | None = None, name: str = ""
) -> ui.button:
    """Return a button without a ground of its own; ``name`` is for screen readers."""
    made = ui.button(words, on_click=action, icon=icon, color=None)
    made.props("flat dense no-caps")
    if not words:
        made.props("round").tooltip(name)
    return made.props(f'aria-label="{name or words}"')


def main_button(words: str, action: Callable[[], Any], *, icon: str | None = None) -> ui.button:
    """Return the button of the main action of a panel."""
    made = ui.button(words, on_click=action, icon=icon, color=None)
    return made.props("no-caps unelevated").classes("main-button")


def mark(element: ui.element, style: str, *, on: bool) -> None:
    """Give a class to an element, or take it away."""
    element.classes(add=style) if on else element.classes(remove=style)


class Drawing:
    """An image in colours with a drawing over it; either may be left out."""

    def __init__(self) -> None:
        with ui.element("div").classes("picture"):
            self._image = ui.element("img").props('alt="" draggable=false')
            self.overlay = ui.html("", sanitize=False).classes("drawing")

    def show(self, picture: Picture) -> None:
        """Show a map."""
        left, top, width, height = picture.place
        self._image.props["src"] = picture.image
        self._image.style(
            f"display:block;left:{left:.1f}px;top:{top:.1f}px;"
            f"width:{width:.1f}px;height:{height:.1f}px"
        )
        self.overlay.set_content(picture.overlay)

    def show_lines(self, drawing: str) -> None:
        """Show a drawing without colours."""
        self._image.style("display:none")
        self.overlay.set_content(drawing)
