"""One job of ``tehl solve``: checks, the solve, reference runs, what is stored and printed."""

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from tehl.api.problem import read_case_and_options
from tehl.api.results import ConvergenceError, Result, TransientResult
from tehl.base.atomic import check_folder, check_writable, remove_with_parts
from tehl.base.errors import InputError
from tehl.base.lazy import lazy
from tehl.cli.lazily import explanations, plots, solvers
from tehl.cli.lines import show
from tehl.cli.progress import busy, progress
from tehl.cli.reference_runs import REFERENCES, Comparisons, compare, smooth_file
from tehl.cli.text import as_text, failure_text
from tehl.contact.options import Options
from tehl.contact.problem import ContactProblem
from tehl.contact.stress import Stress
from tehl.estimate.memory import check_memory
from tehl.estimate.settled import keeping_order
from tehl.io.checkpoint import checkpoint_of, fingerprint
from tehl.io.store import check_name, save
from tehl.result.transient import TIME_OVER

if TYPE_CHECKING:
    from tehl.cli import checkpoint as checkpoints
else:
    checkpoints = lazy("tehl.cli.checkpoint")


@dataclass(frozen=True, kw_only=True, slots=True)
class Job:
    """Arguments of the command."""

    case: Path
    output: Path | None
    plot: Path | None
    as_json: bool
    overrides: list[str]
    certify: bool
    stress: bool
    with_isothermal: bool
    with_smooth: bool
    quiet: bool
    resume: bool

    @property
    def target(self) -> Path:
        """The result file."""
        return Path(f"{self.case.stem}.nc") if self.output is None else self.output


def run(job: Job) -> bool:
    """Solve the case, store and print the result; return whether it converged.

    Invalid case, overrides, outputs or arguments are an InputError before anything is solved.
    """
    problem, options = read_case_and_options(job.case, job.overrides)
    if job.stress and problem.stress is None:
        problem = problem.model_copy(update={"stress": Stress()})
    _check_outputs(job)
    check_memory(options, problem)
    _check_arguments(problem, job)
    wanted = zip(REFERENCES, (job.with_isothermal, job.with_smooth), strict=True)
    references = {name: REFERENCES[name](problem) for name, is_wanted in wanted if is_wanted}
    if references and options.accuracy != "tight":  # small differences need it
        options = options.model_copy(update={"accuracy": "tight", "tolerance": 1e-4})
    result, failure = _solved(problem, options, job)
    if job.as_json and problem.transient is None and isinstance(result, Result):
        result = solvers.with_work(result)  # takes a moment, so for programs only
    with busy(f"writing {job.target}", quiet=job.quiet):
        save(result, job.target)
    compared = Comparisons()
    if isinstance(result, TransientResult) or (problem.has_passes and failure is None):
        if result.status.cause != TIME_OVER:
            remove_with_parts(checkpoint_of(job.target))
    elif references and failure is None:
        compared = _compared(result, references, job)
    _show(result, compared, job)
    _ask(problem, options)
    if failure is not None:
        show(failure_text(result.status, failure), err=True)
    return failure is None


def _ask(problem: ContactProblem, options: Options) -> None:
    """Print which values of the case are not plausible on stderr, as ``tehl explain`` does."""
    questions = explanations.explain(problem, options).questions
    if questions:
        show("\n".join(["Please check", *(f"  - {one}" for one in questions)]), err=True)


def _check_outputs(job: Job) -> None:
    target, folder = job.target, job.plot
    check_writable(target, sources=(job.case,))
    check_name(target)
    if job.with_smooth:
        check_writable(smooth_file(target), sources=(job.case,))
    if folder is not None:
        check_folder(folder)
        within = folder.resolve() in (target.resolve(), *target.resolve().parents)
        if within and not folder.is_dir():
            raise InputError(f"output {target} and the folder of pictures {folder} conflict")


def _check_arguments(problem: ContactProblem, job: Job) -> None:
    """Raise if an argument does not apply to the case, or two exclude each other."""
    for option, given in (
        ("--with-isothermal", job.with_isothermal),
        ("--with-smooth", job.with_smooth),
    ):
        if given and problem.transient is not None:
            raise InputError(f"{option} is for steady cases: remove it or [transient]")
    if job.resume and problem.transient is None and not problem.has_passes:
        raise InputError(
            "--resume is for transient runs and repeated passes, and the case has neither "
            "[transient] nor supply.passes"
        )
    if job.certify and problem.has_passes:
        raise InputError("--certify is for a single pass: leave it out, or supply.passes")
    if job.resume and job.certify:
        raise InputError(
            "--certify makes several runs and keeps no checkpoint, which belongs to a single one: "
            "leave --resume out, or --certify"
        )


def _solved(
    problem: ContactProblem, options: Options, job: Job
) -> tuple[Result | TransientResult, str | None]:
    """Return the result, and why it did not converge, None if it did.

    A transient run whose start does not converge gives that start, a steady result.
    """
    solve = _resumable if problem.has_passes or problem.transient else _steady
    try:
        result = solve(problem, options, job)
    except ConvergenceError as error:
        return error.result, str(error)
    status = result.status
    return result, None if status.converged else status.message or status.outcome


def _steady(problem: ContactProblem, options: Options, job: Job) -> Result | TransientResult:
    with busy("loading the solver", quiet=job.quiet):
        from tehl.api.solvers import certify, solve

    work = certify if job.certify else solve
    with progress(problem, quiet=job.quiet) as monitor:
        return work(problem, options, monitor=monitor)


def _resumable(problem: ContactProblem, options: Options, job: Job) -> Result | TransientResult:
    """Solve repeated passes or a transient case; an interrupt leaves a checkpoint at the target."""
    with busy("loading the solver", quiet=job.quiet):
        from tehl.api.solvers import certify_transient, solve_passes, solve_transient

    kind: checkpoints.Kind[Any] = checkpoints.PASSES if problem.has_passes else checkpoints.STEPS
    keep = checkpoints.Keeper(checkpoint_of(job.target), fingerprint(problem, options), kind)
    start = keep.begin(resume=job.resume)
    with keep.on_interrupt(), progress(problem, quiet=job.quiet) as monitor:
        if problem.has_passes:
            return solve_passes(problem, options, monitor=monitor, resume=start, keep=keep)
        if job.certify:
            return certify_transient(problem, options, monitor=monitor)
        result = solve_transient(problem, options, monitor=monitor, resume=start, keep=keep)
    if result.status.cause == TIME_OVER:
        keep.leave()
    return result


def _compared(result: Result, cases: dict[str, ContactProblem], job: Job) -> Comparisons:
    """Make the reference runs, and store the comparisons and the smooth film."""
    found: dict[str, Result | None] = {}
    options = keeping_order(result.problem, result.options, result.grid_options)
    for what, problem in cases.items():
        if not job.quiet:
            typer.echo(f"reference run {what}", err=True)
        other, failure = _solved(problem, options, replace(job, certify=False))
        found[what] = other if failure is None and isinstance(other, Result) else None
        if found[what] is None:
            show(f"tehl: reference run {what} did not converge: {failure}", err=True)
    compared = compare(result, found)
    with busy(f"writing {job.target}", quiet=job.quiet):
        save(result, job.target, extra=compared.blocks)
        if compared.smooth is not None:
            save(compared.smooth, smooth_file(job.target))
    return compared


def _show(result: Result | TransientResult, compared: Comparisons, job: Job) -> None:
    """Print the numbers, list the files written, and draw the pictures."""
    if job.as_json:
        typer.echo(json.dumps(result.summary() | compared.blocks, allow_nan=False))
    else:
        show(as_text(result, compared))
    typer.echo(f"written: {job.target}", err=True)
    if compared.smooth is not None:
        typer.echo(f"written: {smooth_file(job.target)}", err=True)
    if job.plot is not None:
        with busy("drawing pictures", quiet=job.quiet):
            files = plots.save_all(
                result, job.plot, pictures=plots.pictures_of(result, compared.smooth)
            )
        for path in files:
            typer.echo(f"written: {path}", err=True)
