"""``tehl explore``: the live page."""

import os
from contextlib import suppress
from pathlib import Path
from typing import Annotated

from typer import Argument, Option, echo

from tehl.base.errors import InputError
from tehl.cli.lazily import case_text, problems, server

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables that limit the threads of linear algebra, read when numpy is loaded."""
TEMPLATE = "ball-on-disc"
"""What the page opens without a case."""


def explore(
    case: Annotated[Path | None, Argument(help="Case file.", show_default=False)] = None,
    port: Annotated[
        int | None, Option(min=1024, max=65535, help="Port; one that is free if left out.")
    ] = None,
    browser: Annotated[bool, Option(help="Open the page in the browser.")] = True,
) -> None:
    """Turn the knobs of a contact on a live page: film, pressure and heat follow.

    The page is served to this machine only, to whoever has the address. Ctrl-C ends it.
    """
    for name in THREADS:  # small products of matrices are ten times as slow on two threads
        os.environ.setdefault(name, "1")
    if case is not None:
        problems.read_case_and_options(case)  # for its errors, before a page opens
    _check_extra()

    text = case.read_text(encoding="utf-8-sig") if case else case_text.template_case(TEMPLATE).text
    with suppress(KeyboardInterrupt):  # the usual end
        server.serve(case, text, port, browser=browser, report=_report)


def _check_extra() -> None:
    from importlib.util import find_spec

    missing = [name for name in ("nicegui", "tomlkit") if find_spec(name) is None]
    if missing:
        raise InputError(
            f"the page needs {' and '.join(missing)}: install them with pip install 'tehl[explore]'"
        )


def _report(address: str) -> None:
    echo(f"{address}   (Ctrl-C ends)")
