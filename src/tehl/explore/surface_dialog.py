"""A measured surface comes in: upload, unit and levelling, preview, and use on a surface."""

from functools import partial
from typing import Any

from nicegui import ui

from tehl.base.errors import InputError
from tehl.explore.colour_map import heights_picture
from tehl.explore.elements import Drawing, button, main_button
from tehl.explore.files import LARGEST_UPLOAD
from tehl.explore.job_panel import JobPanel
from tehl.explore.tab import Tab
from tehl.explore.tasks import Heights, Look
from tehl.explore.worker import Solver

LEVELS = {"plane": "plane", "quadratic": "quadratic form", "mean": "mean", "none": "nothing"}
_SIZE = (420.0, 340.0)


class SurfaceDialog(JobPanel):
    """A dialog that adds a measured surface to the case of a tab."""

    def __init__(self, tab: Tab, background: Solver) -> None:
        super().__init__(tab, background, "surface")
        self.name, self.place = "", ui.element()  # not in the controls, which are made again

    def open(self) -> None:
        """Show the dialog."""
        with self.place, ui.dialog() as self.dialog, ui.card().classes("open-card"):
            ui.label("Measured surface").classes("dialog-title")
            upload = ui.upload(
                label="choose or drop a map of heights",
                max_file_size=LARGEST_UPLOAD,
                auto_upload=True,
                on_rejected=lambda: self._say("larger than 50 MB; crop the map before"),
            )
            upload.props("flat bordered").classes("w-full").on_upload(self._uploaded)
            self._build_settings()
            with ui.element("div").classes("preview"):
                self.state = ui.label("").classes("preview-words")
                self.drawing = Drawing()
            with ui.row().classes("w-full justify-end"):
                button("Cancel", self.dialog.close)
                self.uses = [
                    main_button(f"Use on surface {number}", partial(self._use, number))
                    for number in (1, 2)
                ]
        for use in self.uses:
            use.disable()
        self.dialog.on_value_change(lambda event: None if event.value else self.dialog.delete())
        self.dialog.open()

    def _build_settings(self) -> None:
        with ui.element("div").classes("sweep-choices"):
            self.unit = ui.input("unit of heights", placeholder="um")
            self.pixel = ui.input("distance of points", placeholder="2 um")
            self.level = ui.select(LEVELS, value="plane", label="take off")
            self.level.classes("take-off")
            for field in (self.unit, self.pixel, self.level):
                field.props("dense outlined")
            for entry in (self.unit, self.pixel):
                entry.on("change", self.preview)
            self.level.on_value_change(self.preview)

    async def _uploaded(self, event: Any) -> None:
        try:
            self.name = self.tab.files.keep(event.file.name, await event.file.read())
        except InputError as error:
            self._say(str(error))
            return
        self.preview()

    def settings(self) -> dict[str, Any]:
        """Return the settings of the map as a case states them."""
        stated = {"type": "map", "file": self.name, "level": self.level.value}
        for key, entry in (("unit", self.unit), ("pixel", self.pixel)):
            if entry.value:
                stated[key] = entry.value
        return stated

    def preview(self) -> None:
        """Read and level the map in the background."""
        if not self.name:
            return
        settings = self.settings() | {"file": str(self.tab.files.uploads / self.name)}
        self._say("reading")
        self.submit(lambda: Look(settings))

    def _receive(self, job: Any, message: Any) -> None:
        if not self.dialog.is_deleted:
            super()._receive(job, message)

    def _take(self, found: Heights) -> None:
        self.drawing.show(heights_picture((found.x, found.y), found.values, _SIZE))
        self._say("\n".join(found.words))
        for use in self.uses:
            use.enable()

    def _fail(self, words: str) -> None:
        self._say(words)
        for use in self.uses:
            use.disable()

    def _use(self, number: int) -> None:
        settings, key = self.settings(), f"surface_{number}"
        self.dialog.close()
        self.tab.apply(
            {
                f"{key}.rms_roughness": False,
                f"{key}.ra_roughness": False,
                f"{key}.roughness": settings,
            }
        )
