"""``tehl surface``: a measured surface at a glance."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option, echo

from tehl.base.atomic import check_writable, replacing
from tehl.base.errors import InputError
from tehl.cli.arguments import AsJson
from tehl.cli.lazily import (
    case_files,
    explanations,
    mistakes,
    previews,
    problems,
    rendering,
    roughness,
    surface_pictures,
    units,
)
from tehl.cli.lines import show

if TYPE_CHECKING:
    from tehl.roughness import Map
    from tehl.roughness.preview import Mesh, Preview

_ROUGHNESS = ("Sq_m", "Sa_m", "Sz_m", "Ssk", "Sku", "Sdq")
_OPTIONS = ("unit", "pixel", "size", "level")
"""Keys of a map that are options of the command; the others are stated by ``--set``."""
_KEY = re.compile(r'(?P<key>\w+) = (?P<value>".*?"|\[.*?\])')
"""A key with its value in a message."""
_INFINITE_LENGTH = 1e300
"""Lengths beyond are infinite [m]."""
_LEVELS = {
    "none": "nothing",
    "mean": "the mean",
    "plane": "a plane by least squares",
    "quadratic": "a quadratic form by least squares",
}


def surface(  # noqa: PLR0913, PLR0917 (the options of the command)
    file: Annotated[Path, Argument(help="Measured heights.", show_default=False)],
    unit: Annotated[str | None, Option(help="Unit of the heights, um.")] = None,
    pixel: Annotated[
        str | None, Option(help='Distance of the points, "2 um" or "2 um, 3 um".')
    ] = None,
    size: Annotated[
        str | None, Option(help='Edges along x and y, "1 mm" or "1 mm, 0.5 mm".')
    ] = None,
    level: Annotated[
        str | None, Option(help="What is taken off: none, mean, plane, quadratic.")
    ] = None,
    overrides: Annotated[
        list[str],
        Option("--set", metavar="KEY=VALUE", help="Another key of a map, lambda_s=10 um."),
    ] = [],  # noqa: B006 (nothing writes it)
    contact: Annotated[
        Path | None, Option(metavar="CASE", help="Case whose contact and grid to compare.")
    ] = None,
    half_width: Annotated[
        str | None, Option(help='Half-width of a contact to compare, "0.2 mm".')
    ] = None,
    points: Annotated[
        int | None, Option(min=9, help="Nodes per direction of the grid; 257 if left out.")
    ] = None,
    output: Annotated[
        Path | None, Option("-o", "--output", metavar="PNG", help="Picture to draw.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show a measured surface: size, unit, roughness, spectrum, and what a grid resolves of it."""
    if output is not None:
        check_writable(output, sources=(file,))
    values = (unit, _pair(pixel), _pair(size), level)
    stated = dict(zip(_OPTIONS, values, strict=True))
    keys = {key: value for key, value in stated.items() if value is not None}
    mesh = _mesh(contact, half_width, points)
    try:
        found = previews.preview(_map(file, keys, overrides), mesh)
    except InputError as error:
        raise InputError(_with_options(str(error))) from None
    if as_json:
        echo(json.dumps(as_summary(found)))
    else:
        show(as_text(found))
    if output is not None:
        with replacing(output) as temporary:
            surface_pictures.surface_preview(found).savefig(temporary, dpi=150, format="png")
        echo(output, err=as_json)


def _with_options(message: str) -> str:
    """Return a message that says how the command, in place of a case, states what is missing."""
    text, give, advice = message.partition(": give ")
    return text + give + _KEY.sub(_as_option, advice)


def _as_option(stated: re.Match[str]) -> str:
    key, value = stated["key"], ", ".join(re.findall(r'"(.*?)"', stated["value"]))
    return f'--{key} "{value}"' if key in _OPTIONS else f'--set {key}="{value}"'


def _pair(text: str | None) -> list[str] | str | None:
    if text is None or "," not in text:
        return text
    return [part.strip() for part in text.split(",")]


def _map(file: Path, keys: dict[str, Any], overrides: list[str]) -> "Map":
    from pydantic import ValidationError

    stated = {"file": str(file), **keys}
    for override in overrides:
        stated = case_files.overridden(stated, override)
    try:
        return roughness.Map.model_validate(stated)
    except ValidationError as error:
        raise InputError(mistakes.describe(error, stated, roughness.Map)) from None


def _mesh(contact: Path | None, half_width: str | None, points: int | None) -> "Mesh | None":
    if contact is not None:
        if half_width is not None:
            raise InputError("--contact and --half-width both state a contact; expected one")
        return _mesh_of_case(contact, points)
    if half_width is None:
        if points is not None:
            raise InputError('--points needs a contact: give --half-width "0.2 mm" or --contact')
        return None
    try:
        width = units.quantity(units.Length).parse(half_width)
    except ValueError as error:
        raise InputError(f"--half-width = {half_width!r}: {error}") from None
    count = points or 257
    spacing = 6.0 * width / (count - 1)  # the usual domain has six half-widths
    return previews.Mesh(spacing=(spacing,) * 2, half_widths=(width, width), points=(count, count))


def _mesh_of_case(case: Path, points: int | None) -> "Mesh":
    changes = [] if points is None else [f"numerics.points={points}"]
    problem, options = problems.read_case_and_options(case, changes)
    plan, hertz = explanations.explain(problem, options), problem.hertz
    domain, (ny, nx) = plan.domain, plan.options.shape
    along = (domain.x[1] - domain.x[0]) * hertz.half_width_x / (nx - 1)
    across = along  # of a line, as its mesh carries heights
    if ny > 1:
        across = (domain.y[1] - domain.y[0]) * hertz.half_width_y / (ny - 1)
    return previews.Mesh(
        spacing=(along, across),
        half_widths=(hertz.half_width_x, hertz.half_width_y),
        points=(nx, ny),
        skew=hertz.skew,
        straight=problem.contact.has_lines,
    )


def as_text(found: "Preview") -> str:
    """Return a preview in lines for people."""
    return rendering.render(
        "surface.txt", found=found, levels=_LEVELS, longest=_INFINITE_LENGTH
    ).rstrip()


def as_summary(found: "Preview") -> dict[str, Any]:
    """Return the numbers of a preview, in SI, for programs."""
    surface, heights, numbers = found.surface, found.heights, found.statistics
    lengths = [
        length if length < _INFINITE_LENGTH else None for length in numbers.correlation_lengths
    ]
    return {
        "file": found.file,
        "kind": found.raw.kind,
        "points": list(reversed(heights.values.shape)),
        "size_m": list(heights.size),
        "pixel_m": list(heights.pixel),
        "rotate_rad": surface.rotate,
        "middle_m": [surface.x, surface.y],
        "missing": found.missing,
        "spikes": heights.spikes,
        "level": surface.level,
        "lambda_c_m": surface.lambda_c,
        "lambda_s_m": surface.lambda_s,
        **{key: getattr(numbers, key.removesuffix("_m").lower()) for key in _ROUGHNESS},
        "correlation_lengths_m": lengths,
        "mean_wavelength_m": surface.shortest_wavelength,
        "mesh_m": None if found.mesh is None else list(found.mesh.spacing),
        "lost_share": found.lost,
        "notes": list(heights.notes),
        "questions": list(found.sentences),
    }
