"""``tehl solve``: from a case file to a stored result, steady or transient."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Exit, Option

from tehl.base.lazy import lazy
from tehl.cli.arguments import AsJson, CaseFile, Overrides, Quiet
from tehl.cli.ending import NOT_CONVERGED

if TYPE_CHECKING:
    from tehl.cli import job as jobs
else:
    jobs = lazy("tehl.cli.job")


def solve(  # noqa: PLR0913 (the options of the command)
    case: CaseFile,
    *,
    output: Annotated[
        Path | None, Option("-o", "--output", help="Result file; CASE.nc here if left out.")
    ] = None,
    plot: Annotated[
        Path | None, Option("--plot", metavar="DIR", help="Draw all pictures into DIR.")
    ] = None,
    as_json: AsJson = False,
    overrides: Overrides,
    certify: Annotated[
        bool, Option("--certify", help="Solve on three grids and a larger domain: error bars.")
    ] = False,
    stress: Annotated[
        bool, Option("--stress", help="Stress below the surfaces, by the defaults of [stress].")
    ] = False,
    with_isothermal: Annotated[
        bool, Option("--with-isothermal", help="Reference run without heat: what heat changes.")
    ] = False,
    with_smooth: Annotated[
        bool,
        Option("--with-smooth", help="Reference run with smooth surfaces: what roughness changes."),
    ] = False,
    quiet: Quiet = False,
    resume: Annotated[
        bool, Option("--resume", help="Continue an interrupted transient run or repeated passes.")
    ] = False,
) -> None:
    """Solve a case and store the result.

    Exit code 0: converged; 1: not converged, the result is stored and marked; 2: bad input, nothing
    is written; 3: the environment failed.
    """
    arguments = locals()

    if not jobs.run(jobs.Job(**arguments)):
        raise Exit(NOT_CONVERGED)
