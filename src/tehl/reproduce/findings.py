"""All that was found: tables, verdicts of figures, statements, and where it comes from."""

from dataclasses import dataclass

from tehl.reproduce.book import Book
from tehl.reproduce.claims import checks_of
from tehl.reproduce.figures import FigureSpec
from tehl.reproduce.judge import Verdict, judged
from tehl.reproduce.open_runs import open_runs
from tehl.reproduce.printed import printed
from tehl.reproduce.propositions import PROPOSITIONS, Proposition
from tehl.reproduce.tables import TABLES, Table
from tehl.reproduce.wishes import Wishes


@dataclass(frozen=True, slots=True)
class Drawn:
    """A figure with its verdict.

    Attributes
    ----------
    spec : FigureSpec
        The figure.
    panels : str
        What varies from panel to panel.
    verdict : Verdict
        What can be said of it.
    """

    spec: FigureSpec
    panels: str
    verdict: Verdict


@dataclass(frozen=True, kw_only=True, slots=True)
class RunLine:
    """A run in the list of all runs.

    Attributes
    ----------
    name, outcome, why : str
        Which, how it ended, and why it is no answer.
    grid, domain : str
        Nodes, and edges in half-widths.
    cycles : int
        On the finest grid.
    residual, change, load_error, seconds : float
        Of the last cycle, and of the solve.
    """

    name: str
    outcome: str
    why: str
    grid: str
    domain: str
    cycles: int
    residual: float
    change: float
    load_error: float
    seconds: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Findings:
    """Everything that the page tells.

    Attributes
    ----------
    citation : str
        Which paper.
    tables : tuple of Table
        Tables.
    figures : tuple of Drawn
        Figures.
    propositions : tuple of Proposition
        Conclusions and added statements.
    runs : tuple of RunLine
        All runs.
    versions : dict
        Of the packages at work.
    made : (str, str)
        When the first and the last run were made.
    solving, seconds : float
        Processor time of all solves, and time of this run of the command [s].
    reused : int
        Runs that were finished before.
    """

    citation: str
    tables: tuple[Table, ...]
    figures: tuple[Drawn, ...]
    propositions: tuple[Proposition, ...]
    runs: tuple[RunLine, ...]
    versions: dict[str, str]
    made: tuple[str, str]
    solving: float
    seconds: float
    reused: int


def findings(book: Book, wanted: Wishes, *, seconds: float, reused: int) -> Findings:
    """Return what was found, of what was asked for."""
    measured = [(run, m) for run in book.runs if (m := book.measures(run)) is not None]
    made = sorted(m.quality.made for _, m in measured) or ["", ""]
    rows = [row for run in book.runs if (row := book.row(run)) is not None]
    return Findings(
        citation=printed().citation,
        tables=tuple(TABLES[name][0](book) for name in wanted.tables),
        figures=tuple(_drawn(book, spec) for spec in wanted.figures),
        propositions=tuple(PROPOSITIONS[name][0](book) for name in wanted.propositions),
        runs=tuple(_line(book, number) for number in range(len(book.runs))),
        versions=measured[0][1].versions if measured else {},
        made=(made[0], made[-1]),
        solving=sum(row.cost.cpu_seconds for row in rows),
        seconds=seconds,
        reused=reused,
    )


def _drawn(book: Book, spec: FigureSpec) -> Drawn:
    one = book.series[spec.series]
    values = spec.values or one.values
    heats = " and ".join(spec.heat)
    panels = f"{one.symbol} = {', '.join(f'{v:g}' for v in values)}; {heats}"
    unanswered = open_runs(book, [spec.series], spec.heat, spec.values)
    return Drawn(spec, panels, judged(checks_of(spec, book), unanswered))


def _line(book: Book, number: int) -> RunLine:
    run = book.runs[number]
    measures, row = book.measures(run), book.row(run)
    if measures is None:
        outcome = "open" if row is None else row.status.replace("_", " ")
        return RunLine(
            name=run.case.name,
            outcome=outcome,
            why=(row.message or "") if row is not None else "",
            grid="",
            domain="",
            cycles=0,
            residual=0.0,
            change=0.0,
            load_error=0.0,
            seconds=0.0,
        )
    quality = measures.quality
    west, east, south, north = quality.domain
    return RunLine(
        name=run.case.name,
        outcome=("certified" if quality.certified else quality.outcome),
        why="" if quality.converged else quality.message or "",
        grid="{} × {}".format(*quality.points),
        domain=f"[{west:g}, {east:g}] × [{south:g}, {north:g}]",
        cycles=quality.cycles,
        residual=quality.residual,
        change=quality.change,
        load_error=quality.load_error,
        seconds=quality.seconds,
    )
