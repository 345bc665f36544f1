"""``tehl layer``: how a starved film decays over hours of running, by the law of side flow."""

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Exit, Option, echo

from tehl.base.atomic import check_writable, replacing
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.cli.arguments import AsJson, CaseFile, Overrides, Quiet
from tehl.cli.ending import NOT_CONVERGED
from tehl.cli.lazily import layers, problems, results, solvers, units
from tehl.cli.lines import show

if TYPE_CHECKING:
    from tehl.api.problem import ContactProblem
    from tehl.cli import progress as live
    from tehl.post.layer import LayerDecay
else:
    live = lazy("tehl.cli.progress")

COLUMNS = ("time_s", "film_m", "film_by_formula_m")
"""Columns of the table: time, and film with F by the solved pressure and by the closed form."""
LEAST_FILM_RATIO = 0.35
"""Film over the flooded one up to which the law of side flow holds."""
Rows = list[tuple[float, float, float]]


def layer(  # noqa: PLR0913 (the options of the command)
    case: CaseFile,
    *,
    time: Annotated[str, Option("--time", help='How long it runs, such as "20 min".')],
    steps: Annotated[int, Option(min=1, max=10000, help="Rows of the table.")] = 10,
    output: Annotated[
        Path | None, Option("-o", "--output", help="Also write the table to this CSV file.")
    ] = None,
    overrides: Overrides,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Show how a starved film decays over time by side flow."""
    import numpy as np

    try:
        end = units.quantity(units.Duration).parse(time)
    except ValueError as error:
        raise InputError(f'--time = "{time}": {error}') from None
    stated, options = problems.read_case_and_options(case, overrides)
    if output is not None:
        check_writable(output, sources=(case,))
    problem = _single(stated, case)

    solve = solvers.solve  # loaded before the progress is shown
    with live.progress(problem, quiet=quiet) as monitor:
        try:
            result = solve(problem, options, monitor=monitor)
        except results.ConvergenceError as error:
            show(f"tehl: not converged: {error}", err=True)
            raise Exit(NOT_CONVERGED) from None
    decay, times = layers.layer_decay(result), np.linspace(0.0, end, steps + 1)
    films = decay.film(times), decay.film(times, by_formula=True)
    rows: Rows = list(zip(times.tolist(), *(film.tolist() for film in films), strict=True))
    starved = result.starvation
    degree = None if starved is None else starved.degree
    title = problem.title or case.stem
    if as_json:
        echo(_json(decay, rows))
    else:
        show(_text(title, decay, rows, degree))
    if output is not None:
        _write(output, rows)


def _single(problem: "ContactProblem", case: Path) -> "ContactProblem":
    """Return the first pass of a case; raise if the law of side flow does not apply to it."""
    try:
        layers.check_layer(problem)
    except InputError as error:
        raise InputError(f"{case}: {error}") from None
    assert problem.supply is not None
    if problem.is_rough or problem.transient is not None:
        raise InputError(
            f"{case}: the law of side flow is for steady contacts of smooth surfaces: remove "
            "roughness and [transient]"
        )
    return problem.model_copy(update={"supply": problem.supply.model_copy(update={"passes": None})})


def _write(path: Path, rows: Rows) -> None:
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    echo(f"written: {path}", err=True)


def _json(decay: "LayerDecay", rows: Rows) -> str:
    numbers = {
        "rate_1_m2_s": decay.rate,
        "rate_by_formula_1_m2_s": decay.rate_by_formula,
        "start_m": decay.start,
        "limit_m": decay.limit,
    }
    columns = zip(COLUMNS, map(list, zip(*rows, strict=True)), strict=True)
    return json.dumps(numbers | dict(columns))


def _text(title: str, decay: "LayerDecay", rows: Rows, severe: float | None) -> str:
    lines = [
        f"{title}: decay of the central film by side flow",
        f"  F                {decay.rate:.3g} 1/(m^2 s) by the pressure of this contact, "
        f"{decay.rate_by_formula:.3g} by the closed form for the Hertz pressure",
    ]
    if decay.replenishment:
        lines.append(f"  limit            {1e9 * decay.limit:.4g} nm, where as much oil comes back")
    if severe is not None and severe > LEAST_FILM_RATIO:
        lines.append(
            f"  note             the film begins at {severe:.2g} of the flooded one: the law is "
            f"for severe starvation, below {LEAST_FILM_RATIO:g}; until then it decays "
            "somewhat faster"
        )
    lines.append("  time [s]         film [nm]   by the closed form [nm]")
    lines += [f"  {at:<16.5g} {1e9 * film:<11.4g} {1e9 * other:.4g}" for at, film, other in rows]
    return "\n".join(lines)
