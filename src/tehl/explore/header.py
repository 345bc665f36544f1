"""The top of the page: title, templates, open, save, undo, redo, dark or light."""

from typing import Any

from nicegui import ui

from tehl.base.errors import InputError
from tehl.explore.case_text import LARGEST_TEXT, CaseText, template_case
from tehl.explore.elements import button, main_button
from tehl.explore.job_panel import JobPanel
from tehl.explore.tab import Tab
from tehl.explore.tasks import Export, Saved
from tehl.explore.worker import Solver
from tehl.io.templates import templates

FILES = {
    "nc": "Result, NetCDF",
    "html": "Report, HTML",
    "film.png": "Picture, PNG",
    "film.svg": "Picture, SVG",
}
"""Files made from a result, by kind."""
THEME = "tehl-theme"
"""Cookie of the browser with the choice of dark or light."""
IS_DARK = "document.body.classList.contains('body--dark')"
PICTURES = {
    "film": "film",
    "pressure": "pressure",
    "lines": "centre_lines",
    "temperature": "temperature_section",
    "fringes": "interferogram_white",
    "stress": "stress",
    "dynamics": "dynamics",
    "relief": "film",
}
"""Pictures of the package that show a view."""


class Header(JobPanel):
    """Title and actions of a tab."""

    def __init__(self, tab: Tab, background: Solver) -> None:
        super().__init__(tab, background, "file")
        self.client = ui.context.client
        tab.listeners.append(self._hear)

    def build(self, theme: str) -> None:
        """Make the header; ``theme`` is "dark", "light" or that of the system."""
        with ui.element("header").classes("top"):
            ui.html('<b>tehl</b> <span class="thin">explore</span>', sanitize=False).classes(
                "brand"
            )
            self.title = ui.label("").classes("case-title")
            self.title.props('role="heading" aria-level="1"')
            ui.element("span").classes("grow")
            self._templates()
            button("Open", self._open_dialog, icon="folder_open")
            self._save_menu()
            button("", self.tab.undo, icon="undo", name="undo, Ctrl+Z")
            button("", self.tab.redo, icon="redo", name="redo, Ctrl+Y")
            self.dark = ui.dark_mode(value={"dark": True, "light": False}.get(theme))
            button("", self._shade, icon="contrast", name="dark or light")
        self.state = ui.label("").classes("progress-note")
        self.state.bind_visibility_from(self.state, "text", bool)
        ui.keyboard(on_key=self._key, ignore=["input", "textarea", "select"])

    def _templates(self) -> None:
        with button("Templates", icon="auto_awesome"), ui.menu():
            for name, words in templates().items():
                item = ui.menu_item(on_click=lambda name=name: self._take_template(name))
                with item, ui.column().classes("gap-0"):
                    ui.label(name).classes("menu-name")
                    ui.label(words).classes("menu-words")

    def _save_menu(self) -> None:
        with button("Save", icon="download"), ui.menu():
            ui.menu_item("Case, TOML", on_click=self._save_case)
            ui.menu_item("Copy as Python", on_click=self._copy_python)
            ui.menu_item("Copy the link", on_click=self._copy_link)
            ui.separator()
            for kind, words in FILES.items():
                ui.menu_item(words, on_click=lambda kind=kind: self._export(kind))

    def _hear(self, topic: str) -> None:
        if topic == "controls" and self.tab.problem is not None:
            self.title.set_text(self.tab.problem.title or "untitled contact")

    async def _shade(self) -> None:
        """Change between dark and light; a cookie of the browser keeps the choice."""
        is_dark = self.dark.value
        if is_dark is None:  # as the system has it, which only the browser knows
            is_dark = await ui.run_javascript(IS_DARK, timeout=20.0)  # while it draws
        self.dark.value = not is_dark
        theme = "light" if is_dark else "dark"
        ui.run_javascript(
            f'document.cookie = "{THEME}={theme}; path=/; max-age=31536000; SameSite=Lax"'
        )

    def _key(self, event: Any) -> None:
        if not event.action.keydown or not (event.modifiers.ctrl or event.modifiers.meta):
            return
        key = str(event.key).lower()
        if key == "y" or (key == "z" and event.modifiers.shift):
            self.tab.redo()
        elif key == "z":
            self.tab.undo()

    # ---- cases

    def _take_template(self, name: str) -> None:
        self.tab.open(template_case(name))

    def _open_dialog(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("open-card"):
            ui.label("Open a case").classes("dialog-title")
            upload = ui.upload(
                label="choose or drop a case file (.toml)",
                max_file_size=LARGEST_TEXT,
                auto_upload=True,
                on_rejected=lambda: ui.notify(
                    "larger than 200 kB, so not a case file", type="negative"
                ),
            ).props('accept=".toml,.txt" flat bordered')

            async def uploaded(event: Any) -> None:
                self._open(await event.file.read(), dialog)

            upload.on_upload(uploaded).classes("w-full")
            text = ui.textarea("text of the case", value=self.tab.case.text)
            text.props('outlined input-class="case-text" spellcheck=false').classes("w-full")
            with ui.row().classes("w-full justify-end"):
                button("Cancel", dialog.close)
                main_button("Take this text", lambda: self._open(str(text.value).encode(), dialog))
        dialog.on_value_change(lambda event: None if event.value else dialog.delete())
        dialog.open()

    def _open(self, content: bytes, dialog: ui.dialog) -> None:
        try:
            case = CaseText.of_bytes(content)
        except InputError as error:
            ui.notify(str(error), type="negative", timeout=0, close_button="close")
            return
        dialog.close()
        self.tab.open(case)

    def _stem(self) -> str:
        title = self.tab.problem.title if self.tab.problem is not None else ""
        words = "".join(c if c.isalnum() else "-" for c in title.lower())
        return "-".join(filter(None, words.split("-")))[:40] or "case"

    def _save_case(self) -> None:
        ui.download.content(self.tab.case.text, f"{self._stem()}.toml", "application/toml")

    def _copy_python(self) -> None:
        ui.clipboard.write(_python_of(self.tab.case.text, self._stem()))
        ui.notify("Python code copied")

    def _copy_link(self) -> None:
        link = self.tab.case.link
        if not link:
            ui.notify(
                "this case is too long for a link: save it as a file instead", type="negative"
            )
            return
        ui.run_javascript(f'navigator.clipboard.writeText(location.origin + "{link}")')
        ui.notify("link copied")

    # ---- files of a result

    def _export(self, kind: str) -> None:
        tab = self.tab
        if kind.startswith("film."):
            kind = kind.replace("film", PICTURES.get(tab.view, "film"))
        if self.submit(lambda: Export(tab.tables, kind, self._stem())):
            self._say("solving for the file")

    def _take(self, saved: Saved) -> None:
        with self.client:
            ui.download.content(saved.content, saved.name)

    def _fail(self, words: str) -> None:
        with self.client:
            ui.notify(words, type="negative", timeout=0, close_button="close")

    def _end(self, *, cancelled: bool) -> None:
        del cancelled
        self._say("")


def _python_of(text: str, stem: str) -> str:
    """Return a script that solves a case."""
    quoted = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    return (
        "from pathlib import Path\n\nimport tehl\n\n"
        f'case = Path("{stem}.toml")\n'
        f'case.write_text("""\\\n{quoted}""", encoding="utf-8")\n'
        "problem, options = tehl.read_case_and_options(case)\n"
        "result = tehl.solve(problem, options)\n"
        "print(result.film.central, result.film.minimum)  # metres\n"
        f'tehl.plots.film_map(result).savefig("{stem}.png")\n'
    )
