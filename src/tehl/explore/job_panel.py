"""A part of the page with a job in the background, of which only the newest one is heard."""

from collections.abc import Callable
from typing import Any

from nicegui import ui

from tehl.base.errors import InputError
from tehl.explore.jobs import End, Failure, Note
from tehl.explore.tab import Tab
from tehl.explore.worker import Queue


class JobPanel:
    """A part of a tab with a job called ``name``, which is cancelled when the tab is closed.

    A kind of panel takes results, has a label ``state``, and may do more at the end of a job.
    """

    state: ui.label

    def __init__(self, tab: Tab, queue: Queue, name: str) -> None:
        self.tab, self._queue, self._owner = tab, queue, f"{tab.owner} {name}"
        self._newest: Any = None
        ui.context.client.on_delete(self.cancel)

    def submit(self, make: Callable[[], Any]) -> bool:
        """Submit the job that ``make`` returns; return False if it raises an InputError."""
        try:
            job = self._newest = make()
        except InputError as error:
            self._fail(self.tab.files.hidden(str(error)))
            return False
        self._queue.submit(self._owner, job, lambda message: self._receive(job, message))
        return True

    def cancel(self) -> None:
        """Cancel the job."""
        self._queue.cancel(self._owner)

    def _receive(self, job: Any, message: Any) -> None:
        if job is not self._newest:
            return
        if isinstance(message, Failure):
            self._fail(self.tab.files.hidden(message.text))
        elif isinstance(message, Note):
            self._say(message.text)
        elif isinstance(message, End):
            self._end(cancelled=message.cancelled)
        else:
            self._take(message)

    def _take(self, result: Any) -> None: ...

    def _end(self, *, cancelled: bool) -> None: ...

    def _say(self, words: str) -> None:
        self.state.set_text(words)

    def _fail(self, words: str) -> None:
        self._say(words)
