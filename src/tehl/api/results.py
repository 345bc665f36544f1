"""Results as users have them: a solution with all that follows from it, saved and shown.

The solver and files give plain solutions. The rooms below take these; nothing below needs a
`Result`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar, overload

from tehl.api.problem import ContactProblem
from tehl.base.lazy import lazy
from tehl.base.typing import Array
from tehl.contact.stress import Stress
from tehl.post import transient_numbers
from tehl.post.boundary_contact import Touching, touching
from tehl.post.heat import Temperature, temperature
from tehl.post.rolling import Rolling, rolling_friction
from tehl.post.roughness import RoughFilm, rough_film
from tehl.post.starvation import Starvation, starvation
from tehl.post.stress.numbers import StressNumbers, stress_numbers
from tehl.post.summits import LoadSharing, load_sharing
from tehl.post.traction import Traction, traction
from tehl.report.headline import as_line
from tehl.result import solution as plain
from tehl.result.solution import Solution
from tehl.result.transient import TransientSolution

if TYPE_CHECKING:
    import xarray as xr

    from tehl.io import store
    from tehl.io import summary as summaries
    from tehl.post.stress import below
    from tehl.report import notebook
else:
    below = lazy("tehl.post.stress.below")
    store, summaries = lazy("tehl.io.store"), lazy("tehl.io.summary")
    notebook = lazy("tehl.report.notebook")


class Saved:
    """What steady and transient results have in common: they are saved, summarised and shown."""

    __slots__ = ()

    def save(self: Any, path: str | Path) -> None:
        """Write the result to a NetCDF-4 file; an error leaves no partial file."""
        store.save(self, path)

    def to_xarray(self: Any) -> "xr.Dataset":
        """Return a dataset with units and long names, see `tehl.io.store.to_dataset`."""
        return store.to_dataset(self)

    def summary(self: Any) -> dict[str, Any]:
        """Return the JSON summary that ``tehl solve --json`` prints."""
        return summaries.summary(self)

    def __repr__(self: Any) -> str:
        """Return the main numbers in one line."""
        return as_line(type(self).__name__, self.summary())

    def _repr_html_(self: Any) -> str:
        """Return the main numbers beside a picture, for notebooks."""
        return notebook.result_html(self)


class Result(Saved, Solution):
    """Result of one steady solve."""

    __slots__ = ()
    if TYPE_CHECKING:
        problem: ContactProblem

    @classmethod
    def of(cls, solution: Solution) -> Self:
        """Return the result of a solution."""
        if isinstance(solution, cls):
            return solution
        return cls(**_values(solution) | {"problem": ContactProblem.of(solution.problem)})

    @property
    def traction(self) -> Traction | None:
        """Traction coefficients, None without shear stresses."""
        return traction(self)

    @property
    def temperature(self) -> Temperature | None:
        """Temperatures of the film, None for an isothermal run."""
        return temperature(self)

    @property
    def roughness(self) -> RoughFilm | None:
        """Film numbers of rough surfaces, None if no surface states heights or their Sq."""
        return rough_film(self)

    @property
    def load_sharing(self) -> LoadSharing | None:
        """Load and friction of film and asperities, None without asperities finer than the grid."""
        return load_sharing(self)

    @property
    def touching(self) -> Touching | None:
        """Load and friction of film and contact, None without a boundary film."""
        return touching(self)

    @property
    def rolling(self) -> Rolling | None:
        """Rolling friction of one metre of a line contact, None for other shapes."""
        return rolling_friction(self)

    def with_stress(self, **settings: Any) -> Self:
        """Return the result with the stress below its surfaces; nothing is solved.

        Parameters
        ----------
        **settings
            Keys of the table ``[stress]``; that of the case without any, or the defaults.
        """
        table = Stress(**settings) if settings else self.problem.stress or Stress()
        problem = self.problem.model_copy(update={"stress": table})
        return self.but(problem=problem, stress=below.stress_below(self, table))

    @property
    def stress_numbers(self) -> StressNumbers | None:
        """Largest stresses below the surfaces, None if they were not computed."""
        return stress_numbers(self)

    @property
    def starvation(self) -> Starvation | None:
        """How far the film is starved, None if no supply is stated."""
        return starvation(self)


class TransientResult(Saved, TransientSolution):
    """Result of one transient solve."""

    __slots__ = ()
    if TYPE_CHECKING:
        start: Result

    @classmethod
    def of(cls, solution: TransientSolution) -> Self:
        """Return the result of a solution."""
        if isinstance(solution, cls):
            return solution
        return cls(**_values(solution) | {"start": Result.of(solution.start)})

    @property
    def friction(self) -> Array | None:
        """Friction of film and solid contact together over the load at that time, positive [-].

        None without asperities or a boundary film, and where the share of these is not known.
        """
        return transient_numbers.friction(self)

    @property
    def lambda_central(self) -> Array | None:
        """Central film at each time over Sq of both surfaces [-]; None where the film has it."""
        return transient_numbers.lambda_central(self)

    @property
    def sliding_power(self) -> Array | None:
        """Power by sliding at each time [W], of one metre of a line contact; None if unknown."""
        return transient_numbers.sliding_power(self)

    @property
    def late_extremes(self) -> tuple[str, ...]:
        """Extremes that were reached at the end of a run whose duration is not stated.

        They may grow in a longer one: a periodic or mirrored map goes on to pass the contact.
        """
        return transient_numbers.late_extremes(self)

    @property
    def longer_duration(self) -> float | None:
        """Duration to state where the default one ended early [s]; None where it did not.

        It lasts until maps that repeat at their edges have passed whole, or twice as long where
        extremes changed at the end.
        """
        return transient_numbers.longer_duration(self)


def _values(solution: Solution | TransientSolution) -> dict[str, Any]:
    return {one.name: getattr(solution, one.name) for one in fields(solution)}


@overload
def result_of(solution: Solution) -> Result: ...


@overload
def result_of(solution: TransientSolution) -> TransientResult: ...


def result_of(solution: Solution | TransientSolution) -> Result | TransientResult:
    """Return the result of a steady or transient solution."""
    if isinstance(solution, TransientSolution):
        return TransientResult.of(solution)
    return Result.of(solution)


Kind = TypeVar("Kind", Result, TransientResult)


class ConvergenceError(plain.ConvergenceError):
    """The solver did not converge; ``result`` is the last finite state, with its history."""

    result: Result


@contextmanager
def failures_with_results() -> Iterator[None]:
    """Raise failures of the solver with the `Result` of their solution."""
    try:
        yield
    except plain.ConvergenceError as error:
        whole = ConvergenceError(str(error), Result.of(error.result))
        raise whole.with_traceback(error.__traceback__) from None


def load(path: str | Path) -> Result | TransientResult:
    """Read a result that ``save`` wrote, with its fields bit by bit; nothing is compiled.

    Raises
    ------
    InputError
        If the file does not exist.
    FileFormatError
        If it is truncated, foreign or of an unknown format.
    """
    return result_of(store.load(path))


def load_as(kind: type[Kind], path: str | Path) -> Kind:
    """Read a result of one kind, `Result` or `TransientResult`.

    Raises
    ------
    InputError
        If the file does not exist.
    FileFormatError
        If it is not a result, or one of the other kind.
    """
    solution: Any = TransientSolution if kind is TransientResult else Solution
    return kind.of(store.load_as(solution, path))
