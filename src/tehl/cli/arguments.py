"""Arguments and options that several subcommands share."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

CaseFile = Annotated[Path, Argument(help="Case file.", show_default=False)]
Stored = Annotated[Path, Argument(metavar="RESULT", help="Result file (.nc).")]
Overrides = Annotated[
    list[str],
    Option(
        "--set",
        metavar="KEY=VALUE",
        help="Override a key of the case.",
        default_factory=list,
        show_default=False,
    ),
]
Jobs = Annotated[
    str | None, Option("--jobs", "-j", metavar="N", help="Processes; one per core if left out.")
]
Scheduler = Annotated[
    str | None, Option(metavar="ADDRESS", help="Running dask cluster, tcp://HOST:8786.")
]
AsJson = Annotated[bool, Option("--json", help="Print one JSON object.")]
Quiet = Annotated[bool, Option("--quiet", "-q", help="Show no progress.")]
