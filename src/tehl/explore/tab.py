"""One tab of the page without its elements: the case, what is solved of it, what is compared."""

from dataclasses import dataclass, replace
from typing import Any

from tehl.api.problem import ContactProblem
from tehl.base.errors import InputError
from tehl.explore.by_formula import scaled_by_formula
from tehl.explore.case_text import CaseText
from tehl.explore.editor import CaseEditor
from tehl.explore.files import Files
from tehl.explore.jobs import Ask, End, Explained, Failure, Note, Part, TooCoarse
from tehl.explore.scales import Scales
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


@dataclass(frozen=True, slots=True)
class Pinned:
    """A state that is compared."""

    case: CaseText
    shown: Shown


class Tab(CaseEditor):
    """A case, its controls, and the result on screen.

    ``shown`` is on screen: the last film that converged, scaled by formula while ``is_old``, until
    that of the present contact has converged. ``latest`` is how the last solve ended.

    Further topics of ``notify`` are "status", "picture", "numbers", "explained".
    """

    def __init__(self, owner: str, case: CaseText, files: Files, solver: Solver) -> None:
        super().__init__(case, files)
        self.owner, self.solver = owner, solver
        self.shown: Shown | None = None
        self.latest: Shown | None = None
        self.explained: Explained | None = None
        self.pinned: Pinned | None = None
        self.note, self.coarse = "", ""
        self.view, self.scales = "film", Scales()
        self._newest: Ask | None = None
        self._solved: tuple[ContactProblem, Shown] | None = None

    def open(self, case: CaseText) -> None:
        """Take another case."""
        self.scales.limits.clear()
        super().open(case)

    @property
    def is_busy(self) -> bool:
        """Whether a request is being solved."""
        return self._newest is not None

    @property
    def is_old(self) -> bool:
        """Whether the film on screen is not a solution of the present contact."""
        return self._solved is not None and self._solved[0] != self.problem

    def solve(self) -> None:
        """Solve the case: on the coarse grid while a slider moves, then as the case asks."""
        try:
            tables = self.tables
        except InputError as error:
            self._blame(self.files.hidden(str(error)))
            return
        problem = self.problem
        assert problem is not None
        self.note, self.coarse = "", ""
        ask = self._newest = Ask(tables=tables, quick=self.is_moving, view=self.view)
        self.solver.submit(self.owner, ask, lambda message: self._receive(ask, problem, message))
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
        self._newest, self.note = None, "stopped"
        self.notify("status")

    def _receive(self, ask: Ask, problem: ContactProblem, message: Any) -> None:
        """Take a message of the worker; results of an older place of the slider are shown too."""
        newest = ask is self._newest
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
            self._blame(self.files.hidden(message.text), again=message.again)
        elif isinstance(message, End):
            self._newest, self.note = None, ""
            self.coarse = self.coarse if self.is_moving else ""

    def _look(self) -> None:
        """Show the last solution, scaled by formula if it is not of the present contact."""
        assert self._solved is not None
        assert self.problem is not None
        solved, shown = self._solved
        self.shown = scaled_by_formula(shown, solved, self.problem) if self.is_old else shown
        self._fit()
        self.notify("picture", "numbers")

    # ---- comparing

    def pin(self) -> None:
        """Keep the state on screen to compare; the scales of colours then hold still."""
        if self.shown is not None and not self.is_old:
            self.pinned = Pinned(CaseText(self.case.text), self.shown)
            self.scales.held = True
            self.notify("picture", "numbers")

    def unpin(self) -> None:
        """Stop comparing."""
        self.pinned, self.scales.held = None, False
        self._fit()
        self.notify("picture", "numbers")

    def hold(self, *, held: bool) -> None:
        """Hold the scales of colours, or fit them to each result."""
        if held != self.scales.held:
            self.scales.held = held
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
                self._blame(f"{ON_REQUEST[view]} of the pinned state: {message.text}")

        ask = Ask(tables=self.files.resolved(pinned.case.tables), view=view)
        self.solver.submit(f"{self.owner} pinned", ask, receive)

    def _fit(self) -> None:
        """Fit the scales to the film on screen."""
        if self.shown is not None:
            self.scales.fit(self.shown, is_moving=self.is_moving)
