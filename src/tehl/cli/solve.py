"""``tehl solve``: from a case file to a stored film."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from tehl.options import Options
    from tehl.post.thermal_effect import ThermalEffect
    from tehl.problem import ContactProblem
    from tehl.result import Result

COMPARED_TO = 1e-4
"""Tolerance of two runs whose difference counts."""


def solve(  # noqa: PLR0913, PLR0917 (the options of the command)
    case: Annotated[Path, typer.Argument(help="Case file.", show_default=False)],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Result file; CASE.nc here if left out."),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", metavar="DIR", help="Draw all pictures into DIR.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the summary as one JSON object.")
    ] = False,
    changes: Annotated[
        list[str], typer.Option("--set", metavar="KEY=VALUE", help="Change a key of the case.")
    ] = [],  # noqa: B006 (typer reads the default, nobody writes it)
    certify: Annotated[
        bool,
        typer.Option("--certify", help="Solve on three grids and a larger domain: error bars."),
    ] = False,
    with_isothermal: Annotated[
        bool,
        typer.Option(
            "--with-isothermal", help="Solve without heat too: what heat does to the film."
        ),
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
) -> None:
    """Solve a case and store the result.

    Exit code 0: converged; 1: not converged, the result is stored and marked; 2: bad input,
    nothing is written; 3: the environment failed.
    """
    from tehl.io.case import read_case_and_options
    from tehl.memory import check_memory

    target = Path(f"{case.stem}.nc") if output is None else output
    problem, options = read_case_and_options(case, changes)
    _check_output(target, case, plot)
    check_memory(options, problem)
    twin = _twin(problem) if with_isothermal else None
    if twin is not None and options.accuracy != "tight":  # small differences need settled films
        options = options.model_copy(update={"accuracy": "tight", "tolerance": COMPARED_TO})
    result, failure = _run(problem, options, certify=certify, quiet=quiet)
    if as_json:
        result = _with_work(result)
    result.save(target)
    effect = None
    if twin is not None and failure is None:
        effect = _effect(result, twin, quiet=quiet)
        _save_effect(result, effect, target)
    _tell(result, effect, as_json=as_json, compared=twin is not None)
    typer.echo(f"written: {target}", err=True)
    if plot is not None:
        _draw(result, plot)
    if failure is not None:
        _explain_failure(result, failure)
        raise typer.Exit(1)


def _check_output(target: Path, case: Path, plot: Path | None) -> None:
    from tehl.errors import InputError
    from tehl.io.atomic import check_folder, check_writable

    check_writable(target, sources=(case,))
    if plot is None:
        return
    check_folder(plot)
    if plot.resolve() in (target.resolve(), *target.resolve().parents) and not plot.is_dir():
        raise InputError(
            f"output {target} and the folder of pictures {plot} are in each other's way"
        )


def _run(
    problem: "ContactProblem", options: "Options", *, certify: bool, quiet: bool
) -> tuple["Result", str | None]:
    """Return the result, and why it is no answer, None if it is one."""
    from tehl import solver
    from tehl.cli.progress import progress
    from tehl.errors import ConvergenceError

    work = solver.certify if certify else solver.solve
    try:
        with progress(
            quiet=quiet, thermal=problem.thermal is not None, coupled=problem.is_coupled
        ) as monitor:
            return work(problem, options, monitor=monitor), None
    except ConvergenceError as error:
        return error.result, str(error)


def _with_work(result: "Result") -> "Result":
    """Measure the unit of work too: only who reads the numbers by program waits for it."""
    from tehl.solver import with_work

    return with_work(result)


def _twin(problem: "ContactProblem") -> "ContactProblem":
    from tehl.post.thermal_effect import isothermal_twin

    return isothermal_twin(problem)


def _effect(result: "Result", twin: "ContactProblem", *, quiet: bool) -> "ThermalEffect | None":
    """Solve the isothermal twin; return the comparison, None when the twin has no answer."""
    from tehl.post.thermal_effect import thermal_effect

    if not quiet:
        typer.echo("without heat", err=True)
    other, failure = _run(twin, result.options, certify=False, quiet=quiet)
    if failure is not None:
        typer.echo(f"tehl: no answer without heat to compare with: {failure}", err=True)
        return None
    return thermal_effect(result, other)


def _save_effect(result: "Result", effect: "ThermalEffect | None", target: Path) -> None:
    from tehl.io.store import save

    save(result, target, extra=_block(effect))


def _block(effect: "ThermalEffect | None") -> dict[str, Any]:
    """Return what the summary says of the comparison, null where there is none."""
    from tehl.io.summary import plain
    from tehl.post.thermal_effect import effect_block

    return {"thermal_effect": None if effect is None else plain(effect_block(effect))}


def _tell(
    result: "Result", effect: "ThermalEffect | None", *, as_json: bool, compared: bool
) -> None:
    import json

    from tehl.cli.words import as_text, effect_as_text

    if as_json:
        summary = result.summary() | (_block(effect) if compared else {})
        typer.echo(json.dumps(summary, allow_nan=False))
        return
    typer.echo(as_text(result))
    if effect is not None:
        typer.echo(effect_as_text(effect))


def _draw(result: "Result", folder: Path) -> None:
    from tehl.plots.save import save_all

    for path in save_all(result, folder):
        typer.echo(f"written: {path}", err=True)


def _explain_failure(result: "Result", failure: str) -> None:
    status = result.status
    typer.echo(f"tehl: not an answer ({status.kind}): {status.message or failure}", err=True)
    if status.hint:
        typer.echo(f"hint: {status.hint}", err=True)
