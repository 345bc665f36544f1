"""The case of a tab without its elements: edited by controls, checked, with undo and redo."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.base.errors import InputError
from tehl.explore.case_text import CaseText
from tehl.explore.controls import groups
from tehl.explore.files import Files
from tehl.explore.knobs import Choice, Group, Knob

Listener = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Fault:
    """A sentence on what is wrong with a case, and the control that it belongs to."""

    text: str
    path: str = ""
    again: bool = False
    """Whether it may be gone if the case is solved again."""


class CaseEditor:
    """A case and its controls; what its text states is checked after each change.

    ``is_moving`` while a slider moves, ``is_stepping`` while undo or redo takes another case.

    ``notify`` is called with the topic of each change: "controls" and "fault", and those of a kind
    of editor.
    """

    def __init__(self, case: CaseText, files: Files) -> None:
        self.case, self.files = case, files
        self.listeners: list[Listener] = []
        self.problem: ContactProblem | None = None
        self.groups: tuple[Group, ...] = ()
        self.fault: Fault | None = None
        self.is_moving = self.is_stepping = self._is_valid = False
        self._undo: list[str] = []
        self._redo: list[str] = []

    def solve(self) -> None:
        """Solve the case, which is valid; a kind of editor says how."""

    def notify(self, *topics: str) -> None:
        """Report changes."""
        for topic in topics:
            for listener in self.listeners:
                listener(topic)

    @property
    def tables(self) -> dict[str, Any]:
        """Tables of the case with the paths of its files; an InputError if one is not known."""
        return self.files.resolved(self.case.tables)

    def open(self, case: CaseText) -> None:
        """Take another case."""
        self._remember()
        self.case = case
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

    def _blame(self, text: str, path: str = "", *, again: bool = False) -> None:
        """Show what is wrong beside the control that the sentence names, else that of ``path``."""
        paths = (item.path for group in self.groups for item in group.items)
        named = (one for one in paths if text.startswith(f"{one} = "))
        self.fault = Fault(text, next(named, path), again)
        self.notify("fault")
