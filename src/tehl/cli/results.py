"""``tehl plot``, ``animate``, ``export`` and ``report``: what can be made of a stored result."""

from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Context, Option, echo

from tehl.base.atomic import check_folder, check_writable, replacing
from tehl.base.errors import InputError, TehlError
from tehl.base.lazy import lazy
from tehl.cli.arguments import Stored
from tehl.cli.lazily import (
    animation,
    exports,
    micro_film,
    pages,
    plots,
    results,
    store,
    summaries,
    thermal_effect,
)

if TYPE_CHECKING:
    from tehl.api.results import Result, TransientResult
    from tehl.cli import reference_runs
    from tehl.plots import Pictures
else:
    reference_runs = lazy("tehl.cli.reference_runs")

Format = StrEnum("Format", ["csv", "vtk", "npz", "mat"])
Image = StrEnum("Image", ["png", "pdf", "svg"])
What = StrEnum("What", ["lines", "fields", "history", "depths", "section", "dynamics"])


def _pictures(ctx: Context, incomplete: str) -> list[str]:
    """Return the pictures of the result on the command line, the last of which the shell completes.

    Without a result that can be read there are none.
    """
    before, comma, begun = incomplete.rpartition(",")
    words = [ctx.params.get("stored"), *ctx.args]  # what follows an unfinished option is left
    for stored in filter(None, words):
        with suppress(TehlError, OSError):
            names = plots.pictures_of(results.load(stored))
            return [f"{before}{comma}{name}" for name in names if name.startswith(begun)]
    return []


def plot(  # noqa: PLR0913 (the options of the command)
    stored: Stored,
    *,
    output: Annotated[
        Path | None,
        Option(
            "-o",
            "--output",
            help="Folder, RESULT_plots if left out; or a file .png, .pdf or .svg for one picture.",
        ),
    ] = None,
    only: Annotated[
        str | None,
        Option(
            metavar="NAME,NAME",
            help="Draw these pictures only, such as film,pressure.",
            autocompletion=_pictures,
        ),
    ] = None,
    show_list: Annotated[
        bool, Option("--list", help="List the names of the pictures; draw nothing.")
    ] = False,
    ending: Annotated[
        Image, Option("--format", help="Format of the files in a folder.")
    ] = Image.png,
    title: Annotated[bool, Option(help="Draw titles.")] = True,
    dpi: Annotated[int, Option(min=30, max=1200, help="Dots per inch.")] = 150,
) -> None:
    """Draw the pictures of a stored result, steady or transient; nothing is solved."""
    file, folder = _destination(stored, output)
    result = results.load(stored)
    found = plots.pictures_of(result, reference_runs.smooth_beside(stored, result))
    pictures = plots.chosen(found, only.replace(",", " ").split() if only else ())
    if show_list:
        echo("\n".join(pictures))
    elif file is not None:
        _draw_one(result, pictures, file, title=title, dpi=dpi)
    else:
        style: dict[str, Any] = {"dpi": dpi, "ending": ending.value, "title": title}
        for path in plots.save_all(result, folder, pictures=pictures, **style):
            echo(path)


def _beside(stored: Path, ending: str) -> Path:
    """Return the path of an output beside the result."""
    if not stored.name:  # "." or the root
        raise InputError(f"{stored} is a folder; expected a result file such as film.nc")
    return stored.with_name(f"{stored.stem}{ending}")


def _destination(stored: Path, output: Path | None) -> tuple[Path | None, Path]:
    """Return file, if the output is one, and folder of the pictures, both checked."""
    folder = _beside(stored, "_plots") if output is None else output
    if output is not None and output.suffix[1:].lower() in tuple(Image) and not output.is_dir():
        check_writable(output, sources=(stored,))
        return output, output.parent
    check_folder(folder)
    return None, folder


def _draw_one(
    result: "Result | TransientResult", pictures: "Pictures", path: Path, *, title: bool, dpi: int
) -> None:
    """Draw one picture into a file."""
    if len(pictures) != 1:
        raise InputError(
            f"output {path}: a file holds one picture, not {len(pictures)}; "
            f"choose one by --only: {', '.join(pictures)}"
        )
    ((_, draw),) = pictures.items()
    plots.save_picture(draw(result, title=title), path, dpi=dpi)
    echo(path)


def animate(
    stored: Stored,
    output: Annotated[
        Path | None,
        Option("-o", "--output", help="File: .gif, .mp4 or .html; RESULT.gif if left out."),
    ] = None,
    per_second: Annotated[
        int, Option("--fps", min=1, max=100, help="Frames shown per second.")
    ] = 10,
    dpi: Annotated[int, Option(min=30, max=600, help="Dots per inch.")] = 100,
    stress: Annotated[
        int | None,
        Option(min=1, max=2, metavar="BODY", help="Show the shear stress below this surface."),
    ] = None,
) -> None:
    """Animate a stored transient result; nothing is solved.

    It shows the frames of the result (transient.frames of its case).
    """
    target = _beside(stored, ".gif") if output is None else output
    animation.check_format(target)
    check_writable(target, sources=(stored,))
    run = results.load_as(results.TransientResult, stored)
    animation.animate(run, target, per_second=per_second, dpi=dpi, stress=stress)
    echo(target)


def export(
    stored: Stored,
    to: Annotated[
        Format | None, Option("--to", help="Format; by the ending of -o if left out.")
    ] = None,
    output: Annotated[
        Path | None, Option("-o", "--output", help="File; beside RESULT if left out.")
    ] = None,
    what: Annotated[
        What | None,
        Option(
            help="csv only: centre lines (default), fields at all nodes, the history of the cycles "
            "or time steps (default of a transient result), stresses over depth or on y = 0, "
            "or stiffness and damping over frequency."
        ),
    ] = None,
) -> None:
    """Write a stored result as CSV, VTK (ParaView), npz (numpy) or mat (MATLAB).

    VTK: of a steady result the ending .vtr gives the plane of the film, .vts the film as a volume
    with its temperatures; of a transient result .pvd gives all frames, one .vtr file each.
    """
    result = results.load(stored)
    path = _beside(stored, exports.ending_of(result, to)) if output is None else output
    check_writable(path, sources=(stored,))
    for written in exports.export(result, path, to, what or ""):
        echo(written)


def report(
    stored: Stored,
    output: Annotated[
        Path | None, Option("-o", "--output", help="HTML file; beside RESULT if left out.")
    ] = None,
) -> None:
    """Write one self-contained HTML page of a steady or transient result.

    It has numbers, pictures, formulas, inputs, groups, errors and convergence.
    """
    path = _beside(stored, ".html") if output is None else output
    check_writable(path, sources=(stored,))
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"output {path}: a report ends in .html; print it as PDF in a browser")
    result = results.load(stored)
    summary = store.load_summary(stored)
    page = pages.report_text(
        result,
        effect=summaries.from_block(thermal_effect.ThermalEffect, summary.get("thermal_effect")),
        roughness=summaries.from_block(micro_film.RoughnessEffect, summary.get("roughness_effect")),
        smooth=reference_runs.smooth_beside(stored, result),
    )
    with replacing(path) as temporary:
        temporary.write_text(page, encoding="utf-8")
    echo(path)
