"""One tab of the page without its elements: the case, what is solved of it, what is compared."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.base.errors import InputError
from tehl.explore.by_formula import scaled_by_formula
from tehl.explore.case_text import CaseText
from tehl.explore.colour_map import film_limits, pressure_limits, section_limits, stress_limits
from tehl.explore.controls import groups
from tehl.explore.curves import line_tops
from tehl.explore.files import Files
from tehl.explore.jobs import Ask, End, Explained, Failure, Note, Part, TooCoarse
from tehl.explore.knobs import Choice, Group, Knob
from tehl.explore.shown import Shown
from tehl.explore.worker import Solver

VIEWS = {
    "film": "Film",
    "pressure": "Pressure",
    "lines": "Centre lines",
    "temperature": "Temperature",
    "fringes": "Interferogram",
    "stress": "Stress",
    "dynamics": "Stiffness",
    "relief": "3-D film",
    "movie": "Movie",
    "curves": "Curves",
}
"""Views of a contact, by name."""
ON_REQUEST = {
    **{"fringes": "the interferogram", "stress": "the stress"},
    "dynamics": "stiffness and damping",
}
"""Views that are computed when they are shown."""

Listener = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Fault:
    """A sentence on what is wrong with a case, and the control that it belongs to."""

    text: str
    path: str = ""
    again: bool = False
    """Whether it may be gone if the case is solved again."""


@dataclass(frozen=True, slots=True)
class Pinned:
    """A state that is compared."""

    case: CaseText
    shown: Shown


class Tab:
    """A case, its controls, and the result on screen.

    ``shown`` is on screen: the last film that converged, scaled by formula while ``is_old``, until
    that of the present contact has converged. ``latest`` is how the last solve ended.
    ``is_stepping`` while undo or redo takes another case.

    ``notify`` is called with the topic of each change: "controls", "fault", "status", "picture",
    "numbers", "explained".
    """

    def __init__(self, owner: str, case: CaseText, files: Files, solver: Solver) -> None:
        self.owner, self.case, self.files, self.solver = owner, case, files, solver
        self.listeners: list[Listener] = []
        self.problem: ContactProblem | None = None
        self.groups: tuple[Group, ...] = ()
        self.fault: Fault | None = None
        self.shown: Shown | None = None
        self.latest: Shown | None = None
        self.coarse = ""
        self.explained: Explained | None = None
        self.pinned: Pinned | None = None
        self.note, self.is_busy, self.is_moving = "", False, False
        self.view, self.held = "film", False
        self.limits: dict[str, Any] = {}
        self.is_stepping = False
        self._undo: list[str] = []
        self._redo: list[str] = []
        self._is_valid = False
        self._request = 0
        self._solved: tuple[ContactProblem, Shown] | None = None

    def notify(self, topic: str) -> None:
        """Report a change."""
        for listener in self.listeners:
            listener(topic)

    # ---- the case

    @property
    def tables(self) -> dict[str, Any]:
        """Tables of the case with the paths of its files; an InputError if one is not known."""
        return self.files.resolved(self.case.tables)

    def open(self, case: CaseText) -> None:
        """Take another case."""
        self._remember()
        self.case = case
        self.limits.clear()
        self._check(rebuild=True)

    def turn(self, knob: Knob, number: float, unit: str, *, moving: bool) -> None:
        """Set a control to a number in a unit; ``moving`` solves on the coarse grid only."""
        if not self.is_moving:
            self._remember()
        self.is_moving = moving
        self._edit(knob.path, lambda case: case.set(knob.path, knob.stated(number, unit)))

    def type(self, knob: Knob, words: str, unit: str) -> bool:
        """Set a control to what was typed, a number or a number with its unit."""
        self._remember()
        try:
            number = float(words.replace(",", "."))
        except ValueError:
            number = math.nan
        if not math.isfinite(number):  # a quantity, or "inf" for the radius of a flat
            change = partial(CaseText.set, path=knob.path, value=words.strip())
            return self._edit(knob.path, change, rebuild=math.isinf(number))
        return self._edit(knob.path, lambda case: case.set(knob.path, knob.stated(number, unit)))

    def choose(self, path: str, option: str) -> None:
        """Choose one of several words, for the values that the case has now."""
        items = (item for group in self.groups for item in group.items)
        choice = next(one for one in items if isinstance(one, Choice) and one.path == path)
        self.apply(choice.options[option][1], path)

    def apply(self, settings: Mapping[str, Any], path: str = "") -> None:
        """Set what a hint or a choice names; the controls are made again."""
        self._remember()
        stated = {key: None if value is False else value for key, value in settings.items()}
        self._edit(path, lambda case: case.update(stated), rebuild=True)

    def undo(self) -> None:
        """Take the case before the last change."""
        self._step(self._undo, self._redo)

    def redo(self) -> None:
        """Take the case after the change that was undone last."""
        self._step(self._redo, self._undo)

    def visit(self, case: CaseText) -> None:
        """Take a case of the history of the browser, by undo or redo where it is one of theirs."""
        for stack, step in ((self._undo, self.undo), (self._redo, self.redo)):
            if case.text != self.case.text and case.text in stack:
                while case.text != self.case.text:
                    step()
        if case.text != self.case.text:
            self.open(case)

    def _step(self, source: list[str], target: list[str]) -> None:
        """Take the last case of one stack, and keep the present one on the other."""
        if not source:
            return
        if self._is_valid:
            target.append(self.case.text)
        self.case = CaseText(source.pop())
        self.is_stepping = True
        self._check(rebuild=True)
        self.is_stepping = False

    def _remember(self) -> None:
        """Keep the present case for undo; a faulty one is not worth it."""
        self._redo.clear()
        if self._is_valid and self._undo[-1:] != [self.case.text]:
            self._undo = [*self._undo[-50:], self.case.text]  # what can be undone

    def _edit(
        self, path: str, change: Callable[[CaseText], None], *, rebuild: bool = False
    ) -> bool:
        """Change the case and check it; a faulty change is shown, and not solved."""
        case = CaseText(self.case.text)
        try:
            change(case)
        except InputError as error:
            self._blame(str(error), path)
            return False
        self.case = case
        return self._check(path, rebuild=rebuild)

    def _check(self, path: str = "", *, rebuild: bool = False) -> bool:
        """Check the case; solve it if it is valid."""
        try:
            if "axes" in self.case.tables:
                raise InputError("this is a study, not a case: solve it with tehl study")
            self.problem, _ = case_from_tables(self.tables)
            made = groups(self.case, self.problem)
        except InputError as error:
            self._is_valid = False
            self._blame(self.files.hidden(str(error)), path)
            return False
        self._is_valid = True
        had_fault, self.fault = self.fault is not None, None
        others, self.groups = rebuild or not self.groups, made
        if others:
            self.notify("controls")
        if had_fault:
            self.notify("fault")
        self.solve()
        return True

    def _blame(self, text: str, path: str) -> None:
        """Show what is wrong beside the control that the sentence names, else that of ``path``."""
        paths = (item.path for group in self.groups for item in group.items)
        named = (one for one in paths if text.startswith(f"{one} = "))
        self.fault = Fault(text, next(named, path))
        self.notify("fault")

    # ---- the result

    @property
    def is_old(self) -> bool:
        """Whether the film on screen is not a solution of the present contact."""
        return self._solved is not None and self._solved[0] != self.problem

    def solve(self) -> None:
        """Solve the case: on the coarse grid while a slider moves, then as the case asks."""
        try:
            tables = self.tables
        except InputError as error:
            self._blame(self.files.hidden(str(error)), "")
            return
        self._request += 1
        number = self._request
        problem = self.problem
        assert problem is not None
        self.is_busy, self.note, self.coarse = True, "", ""
        ask = Ask(tables=tables, quick=self.is_moving, view=self.view)
        self.solver.submit(self.owner, ask, lambda message: self._receive(number, problem, message))
        if self.is_old:
            self.latest = None
            self._look()
        self.notify("status")

    def close(self) -> None:
        """Cancel all solves, and report no more changes."""
        self.listeners.clear()
        self.solver.cancel(self.owner)
        self.solver.cancel(f"{self.owner} pinned")

    def stop(self) -> None:
        """Cancel what is being solved."""
        self.solver.cancel(self.owner)
        self.is_busy, self.note = False, "stopped"
        self.notify("status")

    def _receive(self, number: int, problem: ContactProblem, message: Any) -> None:
        """Take a message of the worker; results of an older place of the slider are shown too."""
        newest = number == self._request
        if isinstance(message, Part):
            if newest or self.is_moving:
                self._take(problem, message.shown)
        elif newest:
            self._read(message)
        self.notify("status")

    def _take(self, problem: ContactProblem, found: Shown) -> None:
        """Take a result; a film that did not converge is not shown."""
        self.latest = found
        if found.outcome.converged:
            self._solved = problem, found
            self._look()

    def _read(self, message: Any) -> None:
        """Take what the worker says of the newest request."""
        if isinstance(message, Explained):
            self.explained = message
            self.notify("explained")
        elif isinstance(message, Note):
            self.note = message.text
        elif isinstance(message, TooCoarse):
            self.coarse = message.text
        elif isinstance(message, Failure):
            self.fault = Fault(self.files.hidden(message.text), again=message.again)
            self.notify("fault")
        elif isinstance(message, End):
            self.is_busy, self.note = False, ""
            self.coarse = self.coarse if self.is_moving else ""

    def _look(self) -> None:
        """Show the last solution, scaled by formula if it is not of the present contact."""
        assert self._solved is not None
        assert self.problem is not None
        solved, shown = self._solved
        self.shown = scaled_by_formula(shown, solved, self.problem) if self.is_old else shown
        self._fit()
        self.notify("picture")
        self.notify("numbers")

    # ---- comparing

    def pin(self) -> None:
        """Keep the state on screen to compare; the scales of colours then hold still."""
        if self.shown is not None and not self.is_old:
            self.pinned = Pinned(CaseText(self.case.text), self.shown)
            self.held = True
            self.notify("picture")
            self.notify("numbers")

    def unpin(self) -> None:
        """Stop comparing."""
        self.pinned, self.held = None, False
        self._fit()
        self.notify("picture")
        self.notify("numbers")

    def hold(self, *, held: bool) -> None:
        """Hold the scales of colours, or fit them to each result."""
        if held != self.held:
            self.held = held
            self._fit()
            self.notify("picture")

    def show(self, view: str) -> None:
        """Choose what is shown."""
        self.view = view
        if view in ON_REQUEST and getattr(self.shown, view, None) is None:
            self.solve()
        pinned = self.pinned
        if view in ON_REQUEST and pinned is not None and getattr(pinned.shown, view) is None:
            self._complete(pinned, view)
        self.notify("picture")

    def _complete(self, pinned: Pinned, view: str) -> None:
        """Compute a view of a pinned state, which the worker may still hold."""

        def receive(message: Any) -> None:
            if self.pinned is not pinned:
                return
            if isinstance(message, Part) and message.final:
                self.pinned = replace(pinned, shown=message.shown)
                self.notify("picture")
            elif isinstance(message, Failure):
                self._blame(f"{ON_REQUEST[view]} of the pinned state: {message.text}", "")

        ask = Ask(tables=self.files.resolved(pinned.case.tables), view=view)
        self.solver.submit(f"{self.owner} pinned", ask, receive)

    def _fit(self) -> None:
        """Fit the scales to the result, unless they are held or a slider moves."""
        shown = self.shown
        if shown is None:
            return
        wanted: dict[str, Any] = {
            "film": film_limits(shown.maps),
            "pressure": pressure_limits(shown.maps),
            "lines": line_tops(shown.lines),
        }
        if shown.section is not None:
            wanted["temperature"] = section_limits(shown.section)
        if shown.stress is not None:
            wanted["stress"] = stress_limits(shown.stress)
        if self.held or self.is_moving:
            film, pressure = (
                max(ends)
                for ends in zip(wanted["lines"], self.limits.get("lines", (0.0, 0.0)), strict=True)
            )
            before, central = self.limits.get("film"), shown.maps.central
            # a film above the range would have no colour
            # the colours reach beyond the central film
            if before is not None and before.high < 1.1 * central:
                self.limits["film"] = before.joined(wanted["film"])
            wanted |= {key: value for key, value in self.limits.items() if key in wanted}
            wanted["lines"] = film, pressure  # lines stay in their frame
        self.limits = wanted
