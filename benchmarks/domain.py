"""What the edges of the default domain do to the film."""

from tests.reference import DOMAIN, moes_contact

from benchmarks.table import Table
from tehl.options import Domain, Options
from tehl.problem import ContactProblem
from tehl.result import Result
from tehl.solver import solve

LOADS = (5, 7, 10, 15, 20, 40, 57.21, 100, 200, 500, 1000)
POINTS = 257
WIDER = 2


def widened(problem: ContactProblem, run: Result) -> Result:
    """Solve on a domain twice as large with the mesh width of ``run``."""
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
    return solve(problem, options)


def table(*, quick: bool = False) -> Table:
    """Return the change of the film on a domain twice as large, at the same mesh width."""
    made = Table(
        title=f"Domain: default and stated against twice as large, {POINTS} points, L = 10",
        columns=("M", "X_in", "|Y|", "H_central", "default %", "H_min %", "[-4.5, 1.5] x 3 %"),
        notes=["the part of the default domain must stay below 0.3 % of H_central"],
    )
    for load in (5, 20, 100) if quick else LOADS:
        problem = moes_contact(load, 10.0)
        tight = {"points": POINTS, "accuracy": "tight", "tolerance": 1e-5}
        run = solve(problem, Options.model_validate(tight))
        wide = widened(problem, run)
        stated = solve(problem, Options.model_validate(tight | {"domain": DOMAIN}))
        finer = widened(problem, stated)
        made.rows.append(
            (
                load,
                float(run.scaled.x[0]),
                float(run.scaled.y[-1]),
                f"{run.film_scaled.central:.5f}",
                100 * (run.film_scaled.central / wide.film_scaled.central - 1),
                100 * (run.film_scaled.minimum / wide.film_scaled.minimum - 1),
                100 * (stated.film_scaled.central / finer.film_scaled.central - 1),
            )
        )
    return made
