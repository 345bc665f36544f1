"""``tehl solve``: from a case file to a stored result, steady or transient."""

from pathlib import Path
from typing import Annotated

import typer

from tehl.cli.ending import NOT_CONVERGED


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
    from tehl.cli.job import Job, run

    job = Job(
        case=case,
        overrides=overrides,
        target=Path(f"{case.stem}.nc") if output is None else output,
        plot=plot,
        as_json=as_json,
        certify=certify,
        isothermal=with_isothermal,
        smooth=with_smooth,
        quiet=quiet,
        resume=resume,
    )
    if not run(job):
        raise typer.Exit(NOT_CONVERGED)
