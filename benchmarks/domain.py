"""Error of the film by the edges of the default domain."""

from tests.reference import DOMAIN, moes_contact

from benchmarks.measure import attempt
from benchmarks.table import Cell, Table
from tehl.api.problem import ContactProblem
from tehl.api.results import Result
from tehl.contact.options import Domain, Options

LOADS = (5, 7, 10, 15, 20, 40, 57.21, 100, 200, 500, 1000)
POINTS = 257
WIDER = 2


def widened(problem: ContactProblem, run: Result) -> Result:
    """Return the result on a domain twice as large with the mesh width of ``run``."""
    x, y = run.scaled.x, run.scaled.y
    options = Options(
        points=(WIDER * (x.size - 1) + 1, WIDER * (y.size - 1) + 1),
        domain=Domain(
            x=(WIDER * float(x[0]), WIDER * float(x[-1])),
            y=(WIDER * float(y[0]), WIDER * float(y[-1])),
        ),
        accuracy="tight",
        tolerance=1e-5,
    )
    return attempt(problem, options)


def change(run: Result, wide: Result, name: str) -> Cell:
    """Return the difference to the film of the larger domain [%], or the cause of a failure."""
    for result in (run, wide):
        if not result.status.converged:
            return result.status.cause
    values = [getattr(result.film_scaled, name) for result in (run, wide)]
    return 100 * (values[0] / values[1] - 1)


def table(*, quick: bool = False) -> Table:
    """Return the change of the film on a domain twice as large, at the same mesh width."""
    made = Table(
        title=f"Domain: default and stated against twice as large, {POINTS} points, L = 10",
        columns=("M", "X_in", "|Y|", "H_central", "default %", "H_min %", "[-4.5, 1.5] x 3 %"),
        notes=["the error of the default domain must stay below 0.3 % of H_central"],
    )
    tight = {"points": POINTS, "accuracy": "tight", "tolerance": 1e-5}
    for load in (5, 20, 100) if quick else LOADS:
        problem = moes_contact(load, 10.0)
        run = attempt(problem, Options.model_validate(tight))
        wide = widened(problem, run)
        stated = attempt(problem, Options.model_validate(tight | {"domain": DOMAIN}))
        made.rows.append(
            (
                load,
                float(run.scaled.x[0]),
                float(run.scaled.y[-1]),
                f"{run.film_scaled.central:.5f}",
                change(run, wide, "central"),
                change(run, wide, "minimum"),
                change(stated, widened(problem, stated), "central"),
            )
        )
    return made
