"""Elements that several parts of the page share: quiet buttons, and pictures of maps."""

from collections.abc import Callable
from typing import Any

from nicegui import ui

from tehl.explore.axes import Picture


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


POINTER = """(event) => {
    const box = event.currentTarget.getBoundingClientRect();
    emit([event.clientX - box.left, event.clientY - box.top]);
}"""


def plain(arguments: Any) -> Any:
    """Return the first argument of an event."""
    return arguments[0] if isinstance(arguments, list) else arguments


def read_at_pointer(
    over: ui.element, readout: ui.label, words: Callable[[float, float], str]
) -> None:
    """Show in ``readout`` what ``words`` returns for the pixel under the pointer."""

    def point(event: Any) -> None:
        place = event.args[0] if isinstance(event.args[0], list) else event.args
        readout.set_text(words(*map(float, place)) or " ")

    over.on("mousemove", point, js_handler=POINTER, throttle=0.04)
    over.on("mouseleave", lambda: readout.set_text(" "))


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
        left, top, width, height = picture.frame.place
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
