"""What runs in the worker of the page: solve a case on finer and finer grids, and report."""

import signal
import time
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from threading import Thread
from typing import TYPE_CHECKING, Any

from tehl.api.problem import ContactProblem, case_from_tables
from tehl.api.results import ConvergenceError, Result
from tehl.base.errors import InputError, TehlError
from tehl.base.lazy import lazy
from tehl.base.wording import duration
from tehl.contact.options import Options
from tehl.explore.shown import Shown, shown
from tehl.post.micro_film import smooth_reference
from tehl.report.explain import Explanation, explain
from tehl.result.solution import CycleReport
from tehl.studies.engines import end_with_parent

if TYPE_CHECKING:
    from tehl.api import solvers
    from tehl.estimate import film_formulas
    from tehl.kernels import cache as kernel_cache
    from tehl.kernels import warmup
else:
    solvers = lazy("tehl.api.solvers")
    film_formulas = lazy("tehl.estimate.film_formulas")
    kernel_cache = lazy("tehl.kernels.cache")
    warmup = lazy("tehl.kernels.warmup")

QUICK_NODES, MIDDLE_NODES = 65, 129
"""Nodes per direction while a slider moves, and on the way to the accuracy of the case."""

Send = Callable[[Any], None]


@dataclass(frozen=True, kw_only=True, slots=True)
class Ask:
    """A case to solve."""

    tables: dict[str, Any]
    """Tables of the case, with paths of its files."""
    quick: bool = False
    """Whether the coarse grid suffices."""
    view: str = ""
    """View of the page: the interferogram and stresses are computed for theirs."""


@dataclass(frozen=True, slots=True)
class Explained:
    """What formulas say about a case, before it is solved."""

    groups: tuple[tuple[str, str], ...]
    questions: tuple[str, ...]
    seconds: float
    """Expected time of the solve."""


@dataclass(frozen=True, slots=True)
class Note:
    """A message on a solve that goes on."""

    text: str


@dataclass(frozen=True, slots=True)
class Part:
    """A result, of the last grid or on the way."""

    shown: Shown
    final: bool


@dataclass(frozen=True, slots=True)
class TooCoarse:
    """The film did not converge on a grid on the way, and is not shown."""

    text: str


@dataclass(frozen=True, slots=True)
class Failure:
    """A sentence on why there is no result."""

    text: str
    again: bool = False
    """Whether the same case may be solved the next time."""


@dataclass(frozen=True, slots=True)
class End:
    """The job is done; the worker waits for the next one."""

    cancelled: bool = False


@dataclass(frozen=True, slots=True)
class Warm:
    """Load the solver and its kernels before the first case."""

    def __call__(self, desk: "Desk") -> Iterator[Note]:
        """Yield a note where kernels are compiled first."""
        yield from desk.compiled(coupled=False)
        yield from desk.compiled(coupled=True)


class CancelledError(Exception):
    """The page does not want the result any more."""


@dataclass
class Cycles:
    """Monitor of a solve that passes messages on and ends it when the page cancels it."""

    connection: Connection
    send: Send
    _last: float = field(default=0.0)

    def message(self, text: str) -> None:
        """Pass a message on."""
        self.check()
        self.send(Note(text))

    def cycle(self, report: CycleReport) -> None:
        """Note the cycle of a slow solve; end a cancelled one."""
        self.check()
        now = time.monotonic()
        if now - self._last > 0.5 and self._last:
            nodes = "{} × {} nodes".format(*report.points)
            self.send(Note(f"{nodes}, cycle {report.cycle}, residual {report.residual:.1e}"))
        self._last = self._last if self._last and now - self._last <= 0.5 else now

    def check(self) -> None:
        """Raise CancelledError if the page has sent anything: a running job is then cancelled."""
        if self.connection.poll():
            self.connection.recv()
            raise CancelledError


def serve(connection: Connection) -> None:
    """Solve what the page asks for until it closes the connection; Ctrl-C is for the page."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=end_with_parent, daemon=True).start()
    desk = Desk(connection)
    with suppress(EOFError, ConnectionError, BrokenPipeError):
        connection.send("ready")
        while True:
            job = connection.recv()
            if job is not None:  # a cancellation that came too late
                desk.perform(job)


class Desk:
    """Performs jobs one after the other, and keeps the last results."""

    def __init__(self, connection: Connection) -> None:
        self.connection, self.send = connection, connection.send
        self.kept: OrderedDict[str, Result] = OrderedDict()
        self.warm = set[bool]()

    def perform(self, job: Any) -> None:
        """Perform a job; whatever happens, the last message is `End`."""
        try:
            for message in job(self) if callable(job) else self.solve(job):
                self.send(message)
        except CancelledError:
            self.send(End(cancelled=True))
            return
        except TehlError as error:
            self.send(Failure(str(error)))
        except MemoryError:
            self.send(Failure("not enough memory: take fewer points"))
        except (EOFError, ConnectionError):
            raise
        except Exception as error:  # the page shows it; the worker goes on
            self.send(Failure(f"{type(error).__name__}: {error}"))
        self.send(End())

    def solve(self, ask: Ask) -> Iterator[Explained | Note | Part | TooCoarse]:
        """Yield what formulas say, and results on finer and finer grids.

        A film that did not converge on a grid on the way is not a result: it may be far off.
        """
        problem, options = case_from_tables(ask.tables)
        found = explain(problem, options)
        yield Explained(facts(found), found.questions, found.seconds)
        yield from self.compiled(coupled=problem.is_coupled)
        for stage, final in self.stages(steady(problem), options, found, quick=ask.quick):
            asked = final and ask.view == "dynamics"
            wanted = with_stiffness(ask.tables) if asked else problem
            result = self.result(steady(wanted), stage)
            if final or result.status.converged:
                yield Part(shown(result, found, view=ask.view), final)
            else:
                yield too_coarse(stage, options, found, quick=ask.quick)

    def result(self, problem: ContactProblem, options: Options) -> Result:
        """Return the result of a problem, converged or not; a recent one is not solved again."""
        key = _key(problem, options)
        if key not in self.kept:
            monitor = Cycles(self.connection, self.send)
            monitor.check()
            work = solvers.solve_passes if problem.has_passes else solvers.solve
            try:
                found = work(problem, options, monitor=monitor)
            except ConvergenceError as error:
                found = error.result
            self.kept[key] = found
        self.kept.move_to_end(key)
        while len(self.kept) > 6:  # for pictures and files
            self.kept.popitem(last=False)
        return self.kept[key]

    def stages(
        self, problem: ContactProblem, options: Options, found: Explanation, *, quick: bool
    ) -> list[tuple[Options, bool]]:
        """Return the options of the grids to show; only the last if it is solved already."""
        grids = list(_stages(options, found, quick=quick))
        return grids[-1:] if _key(problem, grids[-1][0]) in self.kept else grids

    def compiled(self, *, coupled: bool) -> Iterator[Note]:
        """Load the kernels, and compile those that are not in the cache, which takes a while."""
        if coupled in self.warm:
            return
        import tehl.solver  # noqa: F401, PLC0415 (a second, in the worker only)

        if kernel_cache.is_cold(coupled=coupled):
            yield Note("compiling the inner loops once, which takes 10 to 60 s")
        warmup.warm_up(coupled=coupled)
        self.warm.add(coupled)


def with_stiffness(tables: dict[str, Any]) -> ContactProblem:
    """Return the contact with stiffness and damping, where it can have them."""
    try:
        return case_from_tables({"dynamics": {}, **tables})[0]
    except InputError:
        return case_from_tables(tables)[0]


def _key(problem: ContactProblem, options: Options) -> str:
    return f"{problem.model_dump_json()}{options.model_dump_json()}"


def steady(problem: ContactProblem) -> ContactProblem:
    """Return the steady problem at the start of a transient one: without what moves in later."""
    if problem.transient is None:
        return problem
    if problem.is_rough:
        return ContactProblem.of(smooth_reference(problem))
    return problem.model_copy(update={"transient": None})


def _stages(options: Options, found: Explanation, *, quick: bool) -> Iterator[tuple[Options, bool]]:
    """Yield the options of the grids to show, and whether they are those of the case."""
    stated = options.points != "auto"
    finest = min(options.shape if stated else found.expected_shape)
    nodes = QUICK_NODES if quick else MIDDLE_NODES
    if nodes < finest:
        yield options.model_copy(update={"points": nodes, "error": None}), False
    if not quick or finest <= QUICK_NODES:
        yield options, True


def too_coarse(stage: Options, options: Options, found: Explanation, *, quick: bool) -> TooCoarse:
    """Return what to say of a grid on which the film did not converge."""
    nx, ny = stage.shape[::-1]
    words = f"{nx} × {ny} is too coarse"
    if quick:
        return TooCoarse(f"{words}: solved when the slider is released")
    rows, columns = found.expected_shape if options.points == "auto" else options.shape
    return TooCoarse(
        f"{words}, solving {columns} × {rows}, about {duration(max(1.0, found.seconds))}"
    )


def facts(found: Explanation) -> tuple[tuple[str, str], ...]:
    """Return load, Hertz contact, groups and regime in words."""
    problem, groups = found.scaled.problem, found.scaled.groups
    hertz = problem.hertz
    is_line = problem.contact.is_line  # its load is that of one metre
    load = f"{1e-3 * problem.load:.4g} N/mm" if is_line else f"{problem.load:.4g} N"
    return (
        ("load", load),
        ("Hertz pressure", f"{hertz.pressure * 1e-9:.4g} GPa"),
        ("half-width a_x", f"{hertz.half_width_x * 1e6:.4g} µm"),
        *(() if is_line else (("a_y / a_x", f"{groups.ellipticity:.4g}"),)),
        ("Moes M", f"{groups.M:.4g}"),
        ("Moes L", f"{groups.L:.4g}"),
        ("regime", film_formulas.regime(groups)),
    )
