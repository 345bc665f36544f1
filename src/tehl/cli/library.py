"""``tehl oils`` and ``solids``: the named oils and solids, with sources and ranges."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option, echo

from tehl.base.errors import InputError
from tehl.base.wording import aligned, toml_value
from tehl.cli.arguments import AsJson
from tehl.cli.lazily import oil_laws, oil_library, solid_library
from tehl.cli.lines import show

if TYPE_CHECKING:
    from tehl.base.named import Library, Named

Text = Annotated[
    str | None,
    Argument(help="A name shows its constants; other text filters the list.", show_default=False),
]
AsTable = Annotated[bool, Option("--table", help="Print the table of a case file only.")]


def oils(text: Text = None, *, table: AsTable = False, as_json: AsJson = False) -> None:
    """List the named oils, or show one with sources and ranges."""
    library = oil_library.OILS

    def row(one: "Named") -> tuple[str, ...]:
        law = oil_library.Lubricant.model_validate(one.table).viscosity
        degrees = oil_laws.FORTY_DEGREES
        eta, alpha = 1e3 * law.ambient(degrees), 1e9 * law.pressure_coefficient_at(degrees)
        known = next((one.evidence[key][0] for key in ("alpha", "B") if key in one.evidence), "")
        return f"{eta:.4g}", f"{alpha:.3g}", known

    heading = ("mPa s, 40 degC", "alpha, 1/GPa", "alpha is")
    _show(library, text, (row, heading), table, as_json)


def solids(text: Text = None, *, table: AsTable = False, as_json: AsJson = False) -> None:
    """List the named solids, or show one with sources and ranges."""
    library = solid_library.SOLIDS

    def row(one: "Named") -> tuple[str, ...]:
        solid = solid_library.Solid.model_validate(one.table)
        heat = "" if solid.conductivity is None else f"{solid.conductivity:g}"
        return f"{1e-9 * solid.young_modulus:g}", f"{solid.poisson_ratio:g}", heat

    _show(library, text, (row, ("E, GPa", "nu", "W/m/K")), table, as_json)


def _show(
    library: "Library", text: str | None, columns: tuple[Any, tuple[str, ...]], *flags: bool
) -> None:
    """Print one entry, or the list of those with ``text`` in name or family, else in the source."""
    table, as_json = flags
    try:
        here, wanted = Path.cwd(), (text or "").lower()
        every = library.entries(here).values()
        found = ([one for one in every if wanted in one.texts[place]] for place in range(2))
        kept: list[Named] = next(filter(None, found), [])
        names = {word for one in kept for word in one.words}
        if table or not kept or text in names:
            _show_one(library, library.find(text or "", here), table, as_json)
            return
        kept = [library.checked(one) for one in kept]
    except ValueError as error:
        raise InputError(f'"{text}" {error}' if text else f"the library {error}") from None
    echo(json.dumps([_plain(one) for one in kept])) if as_json else show(_list(kept, *columns))


def _show_one(library: "Library", one: "Named", *flags: bool) -> None:
    table, as_json = flags
    if as_json:
        echo(json.dumps(_plain(one)))
        return
    if not table:
        show(_text(one))
    echo(_toml(library, one))


def _plain(one: "Named") -> dict[str, Any]:
    evidence = {
        key: dict(zip(("kind", "range", "source"), known, strict=True))
        for key, known in one.evidence.items()
    }
    return one.table | {"aliases": one.aliases, "family": one.family, "evidence": evidence}


def _list(kept: "list[Named]", row: Any, heading: tuple[str, ...]) -> str:
    """Return one line per entry, in columns."""
    rows = [("name", "family", *heading)]
    rows += [(one.table["name"], one.family, *row(one)) for one in kept]
    return "\n".join(aligned(rows))


def _text(one: "Named") -> str:
    """Return the constants of an entry with evidence, and its sources."""
    also = [f"also {', '.join(one.aliases)}"] if one.aliases else []
    words = ", ".join([one.family] * bool(one.family) + also)
    lines = [f"{one.table['name']}{': ' if words else ''}{words}"]
    sources = list(dict.fromkeys(source for _, _, source in one.evidence.values()))
    numbers = list(_numbers(one.table))
    width = max(len(path) for path, _ in numbers)
    for path, value in numbers:
        keys = reversed(path.split("."))
        found = (one.evidence[key] for key in keys if key in one.evidence)
        kind, span, source = next(found, ("", "", ""))
        mark = f" [{sources.index(source) + 1}]" if source else ""
        known = f"{kind}, {span}{mark}" if kind else ""
        lines.append(f"  {path:<{width}}  {value:<14}  {known}".rstrip())
    lines += [f"  [{number}]  {source}" for number, source in enumerate(sources, 1) if source]
    if not sources and "source" in one.table:
        lines.append(f"  source  {one.table['source']}")
    return "\n".join([*lines, ""])


def _numbers(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, str]]:
    """Yield the values of a table and of those in it, by dotted path."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _numbers(value, f"{path}{key}.")
        elif key not in ("name", "source"):
            shown = " to ".join(value) if isinstance(value, list) else value
            yield f"{path}{key}", str(shown)


def _toml(library: "Library", one: "Named") -> str:
    """Return the entry as a table of a case file."""
    where = "lubricant" if library.kind == "oil" else "surface_1.material"
    lines = (f"{key} = {toml_value(value)}" for key, value in one.table.items())
    return "\n".join([f"[{where}]", *lines])
