"""The page of a tab: its parts side by side, and the files that come in and go out."""

import asyncio
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

from nicegui import Client, ui

from tehl.base.errors import InputError
from tehl.explore.case_text import CaseText
from tehl.explore.control_panel import ControlPanel
from tehl.explore.curve_panel import CurvePanel
from tehl.explore.elements import button, mark, plain
from tehl.explore.files import Files
from tehl.explore.header import THEME, Header
from tehl.explore.jobs import End, Warm
from tehl.explore.movie_panel import MoviePanel
from tehl.explore.number_panel import Explanation, MainNumbers, NumberPanel
from tehl.explore.picture_panel import PicturePanel
from tehl.explore.status import StatusLine
from tehl.explore.surface_dialog import SurfaceDialog
from tehl.explore.sweeps import Sweeps
from tehl.explore.tab import VIEWS, Tab
from tehl.explore.worker import Solver

STYLE = Path(__file__).with_name("style.css")
SCRIPT = Path(__file__).with_name("page.js")
_MEASURE = """(size) => emit([size.width, window.innerHeight])"""


class Page:
    """Makes the page of each tab; they share the processes that solve."""

    def __init__(self, opened: CaseText, files: Files) -> None:
        self.opened, self.files = opened, files
        self.workers: tuple[Solver, Solver, Sweeps] | None = None

    def start(self) -> None:
        """Start the worker before the first tab."""
        loop = asyncio.get_running_loop()
        live, background, _ = self.workers = Solver(loop), Solver(loop), Sweeps(loop)

        def warmed(message: Any) -> None:
            if isinstance(message, End):  # the second worker starts once the first one is warm
                loop.call_later(10.0, background.submit, "warm", Warm(), lambda _: None)

        live.submit("warm", Warm(), warmed)

    def close(self) -> None:
        """End the workers."""
        for worker in self.workers or ():
            worker.close()

    def build(self, client: Client, case: str = "") -> None:
        """Make the page of a tab, with the case of its address or the one opened."""
        assert self.workers is not None
        live, background, sweeps = self.workers
        opened, fault = self.opened, ""
        if case:
            try:
                opened = CaseText.unpacked(case)
            except InputError as error:
                fault = str(error)
        tab = Tab(client.id, CaseText(opened.text), self.files, live)
        TabPage(tab, client).build(background, sweeps)
        tab.open(tab.case)
        if fault:
            ui.notify(fault, type="negative", timeout=0, close_button="close")

        client.on_delete(tab.close)


class TabPage:
    """The elements of a tab."""

    def __init__(self, tab: Tab, client: Client) -> None:
        self.tab, self.client = tab, client
        self._address = ""

    def build(self, background: Solver, sweeps: Sweeps) -> None:
        """Make all parts; the workers solve what takes long."""
        ui.colors(primary="#1f4e9c", negative="#b3001b")
        ui.add_css(STYLE.read_text(encoding="utf-8"))
        ui.add_body_html(f"<script>{SCRIPT.read_text(encoding='utf-8')}</script>")
        ui.query(".nicegui-content").classes("page")
        request = self.client.request
        Header(self.tab, background).build(request.cookies.get(THEME, "") if request else "")
        with ui.element("div").classes("columns"):
            with ui.element("section").classes("left").props('aria-label="the contact"'):
                dialog = SurfaceDialog(self.tab, background)
                ControlPanel(self.tab, dialog.open)
            self.middle = ui.element("section").classes("middle").props('aria-label="pictures"')
            with self.middle:
                self._build_middle(background, sweeps)
            with ui.element("section").classes("right").props('aria-label="numbers"'):
                NumberPanel(self.tab, self._sweep)
                Explanation(self.tab)
            MainNumbers(self.tab)
        self.tab.listeners.append(self._hear)
        ui.on("visited", lambda event: self._visit(plain(event.args)))

    def _build_middle(self, background: Solver, sweeps: Sweeps) -> None:
        tab = self.tab
        StatusLine(tab).build(self._build_compare)
        with ui.element("div").classes("view-bar"):
            with ui.tabs(on_change=lambda event: self._show(event.value)) as tabs:
                tabs.props(
                    "dense no-caps align=left inline-label outside-arrows mobile-arrows"
                ).classes("views")
                for name, label in VIEWS.items():
                    ui.tab(name, label=label)
            self.tabs = tabs
        with ui.element("div").classes("pictures"):
            self.pictures = PicturePanel(tab)
            self.curves = CurvePanel(tab, sweeps)
            self.movie = MoviePanel(tab, background)
            watcher = ui.element("q-resize-observer")
            watcher.on("resize", self._resized, js_handler=_MEASURE)
        self.tabs.set_value(tab.view)

    def _build_compare(self) -> None:
        tab = self.tab
        with ui.element("div").classes("compare"):
            self.hold = ui.switch("hold scales", on_change=lambda event: tab.hold(held=event.value))
            self.hold.props("dense")
            self.pin = button("Pin", tab.pin, icon="push_pin")
            self.pin.tooltip("keep this state to compare")
            self.unpin = button("Unpin", tab.unpin)
            self.unpin.set_visibility(False)

    def _resized(self, event: Any) -> None:
        width, window = event.args[0] if isinstance(event.args[0], list) else event.args
        # 250 pixels of the window are above and below a picture
        height = max(320.0, min(float(window) - 250.0, 0.95 * float(width)))
        for panel in (self.pictures, self.curves, self.movie):
            panel.resize(float(width), height)

    def _show(self, view: str) -> None:
        """Show a view; those of curves and of the movie are panels of their own."""
        self.pictures.set_visibility(view not in ("curves", "movie"))
        self.tab.show(view)
        self.curves.show()
        self.movie.show()

    def _sweep(self, key: str) -> None:
        """Show the curve of a quantity, and solve it."""
        self.tabs.set_value("curves")
        self.curves.show(key)
        self.curves.start()

    def _hear(self, topic: str) -> None:
        """Put the state into the address once no slider moves any more."""
        if topic == "picture":
            self.hold.set_value(self.tab.scales.held)
            compares = self.tab.pinned is not None
            self.unpin.set_visibility(compares)
            mark(self.middle, "comparing", on=compares)
        if topic == "status":
            self.pin.set_enabled(not self.tab.is_old)
        if topic == "status" and not self.tab.is_moving:
            link = self.tab.case.link or "/"
            if link != self._address and self.client.has_socket_connection:
                new = bool(self._address) and not self.tab.is_stepping
                change = "pushState" if new else "replaceState"  # the back button undoes
                self._address = link
                self.client.run_javascript(f'history.{change}(null, "", "{link}")')

    def _visit(self, link: str) -> None:
        """Take the case of an address that the back or the forward button has gone to."""
        self._address = link
        packed = parse_qs(link.partition("?")[2]).get("case", [""])[0]
        if packed:
            self.tab.visit(CaseText.unpacked(packed))
