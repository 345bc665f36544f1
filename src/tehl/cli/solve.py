"""``tehl solve``: from a case file to a stored film."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tehl.cli.twins import Effects, Twins
    from tehl.options import Options
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
    with_smooth: Annotated[
        bool,
        typer.Option(
            "--with-smooth",
            help="Solve between smooth surfaces too: what roughness does to the film.",
        ),
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a transient run that was interrupted.")
    ] = False,
) -> None:
    """Solve a case and store the result.

    Exit code 0: converged; 1: not converged, the result is stored and marked; 2: bad input,
    nothing is written; 3: the environment failed.
    """
    from tehl.cli.failure import explain_failure
    from tehl.cli.transient import Wishes, refuse, solve_transient_case
    from tehl.cli.twins import smooth_file, twins_of
    from tehl.io.case import read_case_and_options
    from tehl.memory import check_memory

    target = Path(f"{case.stem}.nc") if output is None else output
    problem, options = read_case_and_options(case, changes)
    _check_output(target, case, plot)
    check_memory(options, problem)
    steady_only = {"--with-isothermal": with_isothermal, "--with-smooth": with_smooth}
    refuse(problem, steady_only=steady_only, in_time_only={"--resume": resume})
    if problem.transient is not None:
        wishes = Wishes(
            target=target,
            plot=plot,
            as_json=as_json,
            quiet=quiet,
            resume=resume,
            certify=certify,
        )
        solve_transient_case(problem, options, wishes)
        return
    twins = twins_of(problem, cold=with_isothermal, smooth=with_smooth)
    if twins.smooth is not None:
        _check_output(smooth_file(target), case, plot)
    if twins.wanted and options.accuracy != "tight":  # small differences need settled films
        options = options.model_copy(update={"accuracy": "tight", "tolerance": COMPARED_TO})
    result, failure = _run(problem, options, certify=certify, quiet=quiet)
    if as_json:
        result = _with_work(result)
    result.save(target)
    effects = _effects(result, twins, target, quiet=quiet) if failure is None else _no_effects()
    _tell(result, effects, as_json=as_json)
    typer.echo(f"written: {target}", err=True)
    if effects.smooth is not None:
        typer.echo(f"written: {smooth_file(target)}", err=True)
    if plot is not None:
        _draw(result, plot, effects.smooth)
    if failure is not None:
        explain_failure(result.status, failure)
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


def _no_effects() -> "Effects":
    from tehl.cli.twins import Effects

    return Effects()


def _effects(result: "Result", twins: "Twins", target: Path, *, quiet: bool) -> "Effects":
    """Solve the twins, store what they show, and return it."""
    from tehl.cli.twins import effects_of, smooth_file
    from tehl.io.store import save

    def solved(twin: "ContactProblem", what: str) -> "Result | None":
        if not quiet:
            typer.echo(what, err=True)
        other, failure = _run(twin, result.options, certify=False, quiet=quiet)
        if failure is None:
            return other
        typer.echo(f"tehl: no answer {what} to compare with: {failure}", err=True)
        return None

    if not twins.wanted:
        return _no_effects()
    effects = effects_of(result, twins, solved)
    save(result, target, extra=effects.blocks)
    if effects.smooth is not None:
        effects.smooth.save(smooth_file(target))
    return effects


def _tell(result: "Result", effects: "Effects", *, as_json: bool) -> None:
    import json

    from tehl.cli.words import as_text, effect_as_text, roughness_effect_as_text

    if as_json:
        typer.echo(json.dumps(result.summary() | effects.blocks, allow_nan=False))
        return
    typer.echo(as_text(result, rough=effects.rough_film))
    if effects.heat is not None:
        typer.echo(effect_as_text(effects.heat))
    if effects.roughness is not None:
        typer.echo(roughness_effect_as_text(effects.roughness))


def _draw(result: "Result", folder: Path, smooth: "Result | None") -> None:
    from tehl.plots.save import save_all

    for path in save_all(result, folder, smooth=smooth):
        typer.echo(f"written: {path}", err=True)
