"""What was found as Markdown, for the documentation."""

from collections.abc import Iterable, Sequence

from tehl.reproduce.findings import Findings
from tehl.reproduce.propositions import Proposition
from tehl.reproduce.tables import Table
from tehl.reproduce.words import MEANING, SETS, TREATMENTS, counted

SHOWN = ("F3", "F7", "F19", "X1")
"""Figures that the text shows."""


def text(found: Findings) -> str:
    """Return the findings as Markdown; a few figures are linked beside it."""
    blocks = [
        "# The founding paper, reproduced",
        f"{found.citation}.",
        "Made by `tehl reproduce -o DIR`; the page `index.html` in that folder has all figures and "
        "what each verdict rests on.",
        TREATMENTS,
        SETS,
        "## Verdicts",
        MEANING,
        f"**{counted(found)}**",
        _table(("", "", "verdict", "why"), _verdicts(found)),
    ]
    for one in found.tables:
        blocks += _one_table(one)
    shown = [one for one in found.figures if one.spec.name in SHOWN]
    if shown:
        blocks.append("## Some of the figures")
    for drawn in shown:
        spec = drawn.spec
        blocks.append(f"![{spec.title}](figures/{spec.name}.png)")
        blocks.append(f"*{spec.label}: {spec.title}. {drawn.panels}.*")
    if found.propositions:
        blocks.append("## Conclusions")
    blocks += [_proposition(one) for one in found.propositions]
    return "\n\n".join(blocks) + "\n"


def _verdicts(found: Findings) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (t.name, t.title, t.verdict.word, t.verdict.why) for t in found.tables
    ]
    rows += [
        (one.spec.name, one.spec.title, one.verdict.word, one.verdict.why) for one in found.figures
    ]
    return rows


def _one_table(one: Table) -> list[str]:
    notes = "\n".join(f"- {note}" for note in one.notes)
    return [f"## Table {one.name[1:]}: {one.title}", _table(one.head, one.rows), notes]


def _proposition(one: Proposition) -> str:
    lines = "\n".join(f"- {line}" for line in one.numbers)
    return f"### {one.name}\n\n> {one.text}\n\n**{one.told}**\n\n{lines}"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [_line(head), _line(["---"] * len(head))]
    return "\n".join([*lines, *map(_line, rows)])


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|").replace("*", "\\*") for cell in cells) + " |"
