"""``tehl solve``: from a case file to a stored result, steady or transient."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tehl.cli.ending import NOT_CONVERGED

if TYPE_CHECKING:
    from tehl.cli.reference_runs import Comparisons
    from tehl.options import Options
    from tehl.problem import ContactProblem
    from tehl.result import Result
    from tehl.transient_result import TransientResult

    AnyResult = Result | TransientResult

COMPARED_TO = 1e-4
"""Tolerance of runs that are compared: small differences need tightly converged films."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Job:
    """Options of the command, apart from the case."""

    target: Path
    plot: Path | None
    as_json: bool
    certify: bool
    with_isothermal: bool
    with_smooth: bool
    quiet: bool
    resume: bool


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
    overrides: Annotated[
        list[str], typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the case.")
    ] = [],  # noqa: B006 (typer reads the default, nothing writes it)
    certify: Annotated[
        bool,
        typer.Option("--certify", help="Solve on three grids and a larger domain: error bars."),
    ] = False,
    with_isothermal: Annotated[
        bool,
        typer.Option("--with-isothermal", help="Reference run without heat: what heat changes."),
    ] = False,
    with_smooth: Annotated[
        bool,
        typer.Option(
            "--with-smooth", help="Reference run with smooth surfaces: what roughness changes."
        ),
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue an interrupted transient run.")
    ] = False,
) -> None:
    """Solve a case and store the result.

    Exit code 0: converged; 1: not converged, the result is stored and marked; 2: bad input, nothing
    is written; 3: the environment failed.
    """
    from tehl.cli.reference_runs import reference_cases
    from tehl.io.case import read_case_and_options

    problem, options = read_case_and_options(case, overrides)
    job = Job(
        target=Path(f"{case.stem}.nc") if output is None else output,
        plot=plot,
        as_json=as_json,
        certify=certify,
        with_isothermal=with_isothermal,
        with_smooth=with_smooth,
        quiet=quiet,
        resume=resume,
    )
    _check_outputs(case, job)
    _check_case(problem, options, job)
    references = reference_cases(problem, isothermal=with_isothermal, smooth=with_smooth)
    if references and options.accuracy != "tight":
        options = options.model_copy(update={"accuracy": "tight", "tolerance": COMPARED_TO})
    result, failure = _solved(problem, options, job)
    if as_json and problem.transient is None:
        result = _with_work(result)
    compared = _stored(result, references if failure is None else {}, job)
    _show(result, compared, job)
    if failure is not None:
        _print_failure(result, failure)
        raise typer.Exit(NOT_CONVERGED)


# ---- before the solve


def _check_outputs(case: Path, job: Job) -> None:
    from tehl.cli.reference_runs import smooth_file
    from tehl.errors import InputError
    from tehl.io.atomic import check_folder, check_writable

    target, folder = job.target, job.plot
    check_writable(target, sources=(case,))
    if job.with_smooth:
        check_writable(smooth_file(target), sources=(case,))
    if folder is not None:
        check_folder(folder)
        if (
            folder.resolve() in (target.resolve(), *target.resolve().parents)
            and not folder.is_dir()
        ):
            raise InputError(f"output {target} and the folder of pictures {folder} conflict")


def _check_case(problem: "ContactProblem", options: "Options", job: Job) -> None:
    """Raise if the memory does not suffice or an option does not apply to the case."""
    from tehl.errors import InputError
    from tehl.memory import check_memory

    check_memory(options, problem)
    steady_only = {"--with-isothermal": job.with_isothermal, "--with-smooth": job.with_smooth}
    for option, given in steady_only.items():
        if given and problem.transient is not None:
            raise InputError(f"{option} is for steady cases: remove it or [transient]")
    if job.resume and problem.transient is None:
        raise InputError("--resume is for transient runs, and the case has no [transient]")
    if job.resume and job.certify:
        raise InputError(
            "--certify makes several runs and keeps no checkpoint, which belongs to a single one: "
            "leave --resume out, or --certify"
        )


# ---- the solve


def _solved(
    problem: "ContactProblem", options: "Options", job: Job
) -> tuple["AnyResult", str | None]:
    """Return the result, and why it did not converge, None if it did.

    A transient run whose start does not converge gives that start, a steady result.
    """
    from tehl.errors import ConvergenceError

    run = _steady if problem.transient is None else _transient
    try:
        result = run(problem, options, job)
    except ConvergenceError as error:
        return error.result, str(error)
    status = result.status
    return result, None if status.converged else status.message or status.outcome


def _steady(problem: "ContactProblem", options: "Options", job: Job) -> "AnyResult":
    from tehl import solver
    from tehl.cli.progress import progress

    work = solver.certify if job.certify else solver.solve
    thermal, coupled = problem.thermal is not None, problem.is_coupled
    with progress(quiet=job.quiet, thermal=thermal, coupled=coupled) as monitor:
        return work(problem, options, monitor=monitor)


def _transient(problem: "ContactProblem", options: "Options", job: Job) -> "AnyResult":
    """Solve a transient case; when it is interrupted, a checkpoint is left beside the target."""
    from tehl import solver
    from tehl.cli.checkpoint import Keeper
    from tehl.cli.step_progress import step_progress
    from tehl.io.checkpoint import checkpoint_of, fingerprint
    from tehl.scaling import scales

    keep = Keeper(checkpoint_of(job.target), fingerprint(problem, options))
    start, coupled = keep.begin(resume=job.resume), problem.is_coupled
    with (
        keep.on_interrupt(),
        step_progress(scales(problem), quiet=job.quiet, coupled=coupled) as monitor,
    ):
        if job.certify:
            return solver.certify_transient(problem, options, monitor=monitor)
        return solver.solve_transient(problem, options, monitor=monitor, resume=start, keep=keep)


def _with_work(result: "AnyResult") -> "AnyResult":
    """Measure the unit of work too: for programs only, as it takes a moment."""
    from tehl.result import Result as SteadyResult
    from tehl.solver import with_work

    return with_work(result) if isinstance(result, SteadyResult) else result


# ---- after the solve


def _stored(
    result: "AnyResult", references: dict[str, "ContactProblem"], job: Job
) -> "Comparisons":
    """Store the result, then its reference runs and the comparisons with them."""
    from tehl.cli.reference_runs import Comparisons, compare, smooth_file
    from tehl.io.store import save
    from tehl.result import Result as SteadyResult

    save(result, job.target)
    if not isinstance(result, SteadyResult):
        _remove_checkpoint(job.target)
    if not references or not isinstance(result, SteadyResult):
        return Comparisons()

    def solved(problem: "ContactProblem", what: str) -> "Result | None":
        if not job.quiet:
            typer.echo(f"reference run {what}", err=True)
        other, failure = _solved(problem, result.options, replace(job, certify=False))
        if failure is None and isinstance(other, SteadyResult):
            return other
        typer.echo(f"tehl: reference run {what} did not converge: {failure}", err=True)
        return None

    compared = compare(result, references, solved)
    save(result, job.target, extra=compared.blocks)
    if compared.smooth is not None:
        save(compared.smooth, smooth_file(job.target))
    return compared


def _remove_checkpoint(target: Path) -> None:
    from tehl.io.atomic import remove_with_parts
    from tehl.io.checkpoint import checkpoint_of

    remove_with_parts(checkpoint_of(target))


def _show(result: "AnyResult", compared: "Comparisons", job: Job) -> None:
    """Print the numbers, draw the pictures, and list the files written."""
    from tehl.cli.reference_runs import smooth_file
    from tehl.cli.text import as_text

    if job.as_json:
        typer.echo(json.dumps(result.summary() | compared.blocks, allow_nan=False))
    else:
        typer.echo(as_text(result, compared))
    typer.echo(f"written: {job.target}", err=True)
    if compared.smooth is not None:
        typer.echo(f"written: {smooth_file(job.target)}", err=True)
    if job.plot is not None:
        from tehl.plots.save import save_all

        for path in save_all(result, job.plot, smooth=compared.smooth):
            typer.echo(f"written: {path}", err=True)


def _print_failure(result: "AnyResult", reason: str) -> None:
    from tehl.cli.text import failure_text

    typer.echo(failure_text(result.status, reason), err=True)
