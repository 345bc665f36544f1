"""``tehl fit``: the oil from a test, films and tractions in, the table of a lubricant out."""

import json
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from tehl.base.atomic import check_folder, check_writable, replacing
from tehl.base.errors import InputError
from tehl.cli.arguments import AsJson, Jobs, Quiet
from tehl.cli.lines import show


def fit(  # noqa: PLR0913 (the options of the command)
    data: Annotated[
        list[Path],
        Argument(metavar="DATA...", help="Texts of an MTM or EHD2, or lists with units."),
    ],
    *,
    case: Annotated[
        list[Path],
        Option(
            "--case", metavar="CASE", help="Case of the rig: one for all files, or one for each."
        ),
    ],
    output: Annotated[
        Path, Option("-o", "--output", metavar="OIL", help="Table of the lubricant, .toml.")
    ],
    names: Annotated[
        str | None,
        Option("--fit", metavar="NAMES", help="Constants, such as alpha,eyring_stress."),
    ] = None,
    noise: Annotated[
        list[str] | None,
        Option("--noise", metavar="KIND=VALUE", help="Standard deviation, such as film=3% ."),
    ] = None,
    probe: Annotated[
        str | None,
        Option(metavar="lube|pot", help="Which temperature of a rig is that of the oil."),
    ] = None,
    plot: Annotated[
        Path | None, Option("--plot", metavar="DIR", help="Draw the fit into this folder.")
    ] = None,
    jobs: Jobs = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Fit constants of an oil to measured films and tractions.

    Prints them with 95 % intervals and what the data do not determine.
    """
    if probe not in (None, "lube", "pot"):
        raise InputError(f"--probe {probe}: must be lube or pot")
    check_writable(output, sources=(*data, *case))
    if plot is not None:
        check_folder(plot)
    stated = dict(_noise(text) for text in noise or ())
    from tehl.cli.study_job import number_of_workers
    from tehl.studies.fitting.oil import fit as fitted

    found = fitted(
        data,
        case,
        None if names is None else [name.strip() for name in names.split(",") if name.strip()],
        noise=stated,
        probe=probe,  # type: ignore[arg-type]  # checked above
        jobs=number_of_workers(jobs),
        forked=True,
        report=(lambda _: None) if quiet else lambda text: show(f"tehl: {text}", err=True),
    )
    found.save(output)
    if as_json:
        typer.echo(json.dumps(found.as_json(), allow_nan=False))
    else:
        show(found.text())
    typer.echo(f"written: {output}", err=True)
    if plot is not None:
        from tehl.plots import oil_fit

        plot.mkdir(parents=True, exist_ok=True)
        with replacing(plot / "fit.png") as temporary:
            oil_fit(found.table).savefig(temporary, format="png", dpi=130)
        typer.echo(f"written: {plot / 'fit.png'}", err=True)


def _noise(text: str) -> tuple[str, str]:
    """Return the kind and the standard deviation of an argument."""
    kind, equals, value = (part.strip() for part in text.partition("="))
    if not (equals and value):
        raise InputError(f"--noise {text}: expected KIND=VALUE, such as film=3% or traction=0.001")
    return kind, value
