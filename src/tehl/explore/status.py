"""The line above the pictures: how the solve stands, what is wrong, what to try."""

from collections.abc import Callable

from nicegui import ui

from tehl.explore.elements import button
from tehl.explore.tab import Tab

ACCURACIES = {
    "numerics.error=5 %": "error 5 %",
    "numerics.error=2 %": "error 2 %",
    "numerics.error=1 %": "error 1 %",
    "numerics.error=0.5 %": "error 0.5 %",
    "numerics.points=129": "129² nodes",
    "numerics.points=257": "257² nodes",
    "numerics.points=513": "513² nodes",
}
"""Accuracies to choose from: key and value, by what is shown."""


class StatusLine:
    """State of the solve, accuracy, and a card with what is wrong."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab
        tab.listeners.append(self._hear)

    def build(self, at_the_end: Callable[[], None]) -> None:
        """Make the line; ``at_the_end`` adds to it."""
        with ui.element("div").classes("status").props('role="status" aria-live="polite"'):
            self.light = ui.element("span").classes("light")
            self.words = ui.label("starting").classes("status-words")
            self.stop = button("Stop", self.tab.stop)
            self.stop.set_visibility(False)
            self.accuracy = ui.select(
                dict(ACCURACIES), value=None, on_change=lambda event: self._choose(event.value)
            )
            self.accuracy.props('dense options-dense borderless aria-label="accuracy"')
            self.accuracy.classes("accuracy")
            at_the_end()
        with ui.element("div").classes("card").props('role="alert"') as self.card:
            self.what = ui.label("").classes("what")
            self.hint = ui.label("").classes("hint")
            self.apply = button("Apply the hint", self._apply)
            self.again = button("Solve again", self.tab.solve)
        self.card.set_visibility(False)

    def _hear(self, topic: str) -> None:
        if topic in ("status", "fault", "picture", "controls"):
            self._show()
        if topic == "controls":
            self._show_accuracy()

    def _show(self) -> None:
        tab, latest = self.tab, self.tab.latest
        self.stop.set_visibility(tab.is_busy and bool(tab.note))
        waits = tab.is_busy or tab.is_moving  # a coarse grid may fail where the fine one converges
        failed = latest.outcome if latest and not (waits or latest.outcome.converged) else None
        state = "busy" if tab.is_busy else "bad" if failed or tab.fault else "good"
        self.light.classes(replace=f"light {state}")
        self.words.set_text(self._sentence())
        fault = tab.fault
        words = (failed.words, failed.message) if failed else ()
        text = fault.text if fault is not None else ": ".join(filter(None, words))
        self.card.set_visibility(bool(text))
        self.what.set_text(text)
        tried = failed if fault is None else None
        self.hint.set_text(f"hint: {tried.hint}" if tried and tried.hint else "")
        self.apply.set_visibility(bool(tried and tried.settings))
        self.again.set_visibility(fault is not None and fault.again)

    def _sentence(self) -> str:
        tab, latest = self.tab, self.tab.latest
        if tab.is_busy or tab.coarse or latest is None:
            parts = ["by formula" if tab.is_old else "", tab.coarse, tab.note]
            doing = "" if any(parts[1:]) else self._doing()
            return ", ".join(filter(None, [*parts, doing]))
        nodes = "{} × {} nodes".format(*latest.points)
        words = f"{latest.outcome.words} on {nodes} in {1e3 * latest.seconds:.0f} ms"
        if tab.fault is not None:
            return f"shown is the last valid case, {words}"
        if tab.is_old:
            return f"by formula, {words}"
        if tab.problem is not None and tab.problem.transient is not None:
            return f"{words}, at the start of the run"
        return words

    def _doing(self) -> str:
        """Return what goes on in a word or two."""
        tab = self.tab
        if not tab.is_busy:
            return "no result yet" if tab.shown is None else "not solved"
        if tab.shown is None or tab.is_old:
            return "solving"
        return "{} × {} nodes, refining".format(*tab.shown.points)

    def _show_accuracy(self) -> None:
        key, options = self._stated(), dict(ACCURACIES)
        if key not in options:
            path, _, value = key.partition("=")
            options[key] = f"{value}² nodes" if path.endswith("points") else f"error {value}"
        self.accuracy.set_options(options, value=key)

    def _choose(self, key: str | None) -> None:
        path, _, value = (key or "").partition("=")
        if key is None or key == self._stated():
            return
        self.tab.apply({path: int(value) if path.endswith("points") else value})

    def _stated(self) -> str:
        """Return the key and value of the accuracy that the case states."""
        case = self.tab.case
        points, error = case.get("numerics.points"), case.get("numerics.error")
        return f"numerics.points={points}" if points else f"numerics.error={error or '2 %'}"

    def _apply(self) -> None:
        latest = self.tab.latest
        if latest is not None and latest.outcome.settings:
            self.tab.apply(latest.outcome.settings)
