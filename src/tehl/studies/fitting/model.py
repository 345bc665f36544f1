"""What the solver says for all points of a test: values as a function of the constants sought."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tehl.api.problem import ContactProblem
from tehl.api.results import ConvergenceError, Result
from tehl.api.solvers import solve
from tehl.base.errors import InputError
from tehl.base.typing import Array
from tehl.contact.options import Options
from tehl.kernels.warmup import warm_up
from tehl.studies.engines import Engine
from tehl.studies.fitting.constants import Constant, with_value
from tehl.studies.fitting.measured import KINDS, Point

FIT_ERROR = 0.03
"""Error of the films if the case does not state it: bars are then about 1 %."""
_DIFFERENCE = 0.02
"""Change of the logarithm of a constant for its derivatives, which are within 1 %."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a solve gives for a point: values and relative error bars by kind, and its grid."""

    values: dict[str, float]
    bars: dict[str, float]
    reached: float
    """Largest shear stress in the loaded zone over that of the shear law [-]."""
    options: Options
    """Those with which it is repeated on the same nodes."""


def answer(problem: ContactProblem, options: Options) -> Answer | str:
    """Return what a solve gives for a point, or why it did not converge.

    Parameters
    ----------
    problem : ContactProblem
        Steady.
    options : Options
        The first solve chooses the nodes by its error, later ones state them.
    """
    try:
        result = solve(problem, options)
    except ConvergenceError as error:
        return str(error)
    found = {kind: one.value(result) for kind, one in KINDS.items()}
    errors = result.errors
    known = {} if errors is None else dict(errors.bars)
    if errors is not None:
        known["central"] = errors.central
    return Answer(
        values={kind: value for kind, value in found.items() if value is not None},
        bars={kind: known.get(one.bar) or 0.0 for kind, one in KINDS.items()},
        reached=_reached(result),
        options=result.grid_options.model_copy(update={"error": None}),
    )


def _reached(result: Result) -> float:
    shear, law = result.shear, result.problem.lubricant.shear
    if shear is None or law.is_newtonian:
        return 0.0
    loaded = result.pressure > 0.5 * result.pressure.max()
    stress = np.abs(shear.mid_film[loaded]) / law.stress_scale(result.pressure[loaded])
    return float(stress.max())


class Model:
    """Values of all points over the logarithms of the constants, each over its start.

    Parameters
    ----------
    points : sequence of (Point, Options)
        The test, and the options of the first solves, which choose the nodes of all later ones.
    constants : sequence of Constant
        Sought.
    lubricant : dict
        Table of the oil with the starts.
    engine : Engine
        Where points are solved.
    report : callable
        Takes a line on what is being done.
    """

    def __init__(
        self,
        points: Sequence[tuple[Point, Options]],
        constants: Sequence[Constant],
        lubricant: dict[str, Any],
        engine: Engine,
        report: Callable[[str], None],
    ) -> None:
        self.points, self.constants = [point for point, _ in points], constants
        self.lubricant, self.engine, self.report = lubricant, engine, report
        self.options = [options for _, options in points]
        self.places = [(k, kind) for k, one in enumerate(self.points) for kind in one.measured]
        self.solves = 0
        self._known: dict[bytes, list[Answer | str]] = {}
        self._jacobians: list[tuple[Array, Array]] = []

    def values(self, x: Array) -> Array:
        """Return the values of all places at logarithms ``x``; NaN where no film converges."""
        return self._vector(self.answers(x)[0])

    def jacobian(self, x: Array) -> Array:
        """Return the derivatives of the values by ``x``, by differences here or close to it."""
        for place, known in self._jacobians:
            if np.abs(place - x).max() < 0.03:  # they change by a few per cent
                return known
        steps = _DIFFERENCE * np.eye(x.size)
        base, *moved = (self._vector(one) for one in self.answers(x, *(x + step for step in steps)))
        columns = [(one - base) / _DIFFERENCE for one in moved]
        for k, column in enumerate(columns):
            if not np.isfinite(column).all():  # on the other side films may converge
                columns[k] = (base - self.values(x - steps[k])) / _DIFFERENCE
                self.check(x - steps[k])
        found = np.column_stack(columns)
        self._jacobians.append((x.copy(), found))
        return found

    def shown(self, x: Array) -> str:
        """Return the constants at logarithms ``x`` as people read them."""
        return ", ".join(
            f"{one.name} {one.shown(one.start * math.exp(log))}"
            for one, log in zip(self.constants, x, strict=True)
        )

    def check(self, x: Array) -> None:
        """Raise the failure of the first point whose film does not converge at ``x``."""
        for point, found in zip(self.points, self.answers(x)[0], strict=True):
            if isinstance(found, str):
                raise FitError(f"{point.label}: the film does not converge: {found}")
            for kind in point.measured:
                if kind not in found.values:
                    raise InputError(f"{point.label}: the solve gives no {kind} to compare with")

    def at(self, x: Array) -> dict[str, Any]:
        """Return the table of the lubricant at logarithms ``x``."""
        table = self.lubricant
        for one, log in zip(self.constants, x, strict=True):
            table = with_value(table, one, float(one.start * np.exp(log)))
        return table

    def fix_nodes(self) -> None:
        """Choose the nodes of each point at the start; all later solves are on them."""
        zero = np.zeros(len(self.constants))
        self.check(zero)
        found = self.answers(zero)[0]
        self.options = [one.options for one in found if isinstance(one, Answer)]
        self._known.clear()

    def answers(self, *places: Array) -> list[list[Answer | str]]:
        """Return the answers of all points at some logarithms, solved side by side if not known."""
        new = {x.tobytes(): x for x in places if x.tobytes() not in self._known}
        tasks = deque[tuple[Any, ContactProblem, Options]]()
        for key, x in new.items():
            self._known[key] = [""] * len(self.points)
            oil = self.at(x)
            for k, point in enumerate(self.points):
                try:
                    tasks.append(((key, k), point.problem(oil), self.options[k]))
                except InputError as error:  # constants that no law has
                    self._known[key][k] = str(error)
        warm_up(coupled=any(problem.is_coupled for _, problem, _ in tasks))
        self.solves += len(tasks)
        busy = 0
        while tasks or busy:
            while tasks and busy < max(self.engine.workers(), 1):
                ticket, *arguments = tasks.popleft()
                self.engine.submit(ticket, answer, *arguments)
                busy += 1
            for (key, k), found in self.engine.take():
                busy -= 1
                if isinstance(found, Exception):
                    raise found
                self._known[key][k] = found
        return [self._known[x.tobytes()] for x in places]

    def _vector(self, answers: list[Answer | str]) -> Array:
        found = [answers[k] for k, _ in self.places]
        return np.array(
            [
                one.values.get(kind, np.nan) if isinstance(one, Answer) else np.nan
                for one, (_, kind) in zip(found, self.places, strict=True)
            ]
        )


class FitError(InputError):
    """A film of the test does not converge, so that nothing can be fitted."""
