"""The pages: Markdown for the documentation, and one self-contained HTML page of all of it."""

import base64
import io
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt
from PIL import Image

import tehl
from paper.conclusions import Conclusion
from paper.figures import Figure
from paper.runs import Runs
from paper.tables import Table
from paper.verdict import Finding, Statement, Verdict, counted

SHOWN = ("F3", "F7", "F19", "X1")
"""Figures that the documentation shows."""
TITLE = "The paper, recomputed"
RUNS = """\
tehl {version}, {seconds:.0f} s of CPU time for all runs. Residual: mean residual scaled by its
diagonal. Change: largest change of pressure in the last cycle, in Hertz pressures. Runs on the
paper's grid stop by the rule of the paper, which limits neither."""
_HERE = Path(__file__).parent
_COLOURS = {
    "reproduced": "good",
    "true": "good",
    "trend only": "some",
    "only": "some",
    "cannot be reproduced": "bad",
    "false": "bad",
}


@dataclass(frozen=True, slots=True)
class Report:
    """All that the pages show."""

    runs: Runs
    tables: list[Table]
    figures: list[tuple[Figure, Verdict]]
    conclusions: list[Conclusion]

    @property
    def verdicts(self) -> list[tuple[str, str, Verdict]]:
        """Name, title and verdict of all tables and figures."""
        tables = [(one.name, one.title, one.verdict) for one in self.tables]
        return tables + [(one.name, one.title, verdict) for one, verdict in self.figures]


def pages(report: Report) -> dict[str, str]:
    """Return the pages of the documentation as Markdown, by the name of their file."""
    contents = "```{toctree}\n:maxdepth: 1\n\ntables\nstatements\nfigures\nconclusions\n```"
    shown = [_picture(figure) for figure, _ in report.figures if figure.name in SHOWN]
    judged = [(name, verdict.statements) for name, _, verdict in report.verdicts]
    texts = {
        "index": (TITLE, _method(), _verdicts(report, str), contents),
        "tables": ("Tables", *map(_table, report.tables)),
        "statements": ("Statements", _statements(judged, _truth)),
        "figures": ("Figures", *shown),
        "conclusions": ("Conclusions", *map(_conclusion, report.conclusions)),
    }
    return {f"{name}.md": "# " + "\n\n".join(parts) + "\n" for name, parts in texts.items()}


def html(report: Report, folder: Path) -> str:
    """Return everything as one HTML page that needs no other file.

    The pictures are taken from ``figures`` in ``folder``.
    """
    parts = [
        f"# {TITLE}",
        _method(),
        _verdicts(report, lambda name: f"[{name}](#{name})"),
        "# Tables",
        *(f"{_table(one)}\n\n{_details(one.name, one.verdict)}" for one in report.tables),
        "# Figures",
        *(_figure(figure, verdict) for figure, verdict in report.figures),
        "# Conclusions",
        *map(_conclusion, report.conclusions),
        "# Runs",
        _runs(report.runs),
    ]
    body = MarkdownIt("commonmark", {"html": True}).enable("table").render("\n\n".join(parts))
    for word, colour in _COLOURS.items():
        body = re.sub(f"<td>({word}\\b)", f'<td class="{colour}">\\1', body)
    body = re.sub(r"<h2>(\w+)", r'<h2 id="\1">\1', body)
    body = re.sub(r'src="(figures/\w+\.png)"', lambda m: f'src="{_embedded(folder / m[1])}"', body)
    style = (_HERE / "style.css").read_text(encoding="utf-8")
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{TITLE}</title>\n<style>{style}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _embedded(picture: Path) -> str:
    """Return a picture as an address that holds it, in few bytes."""
    content = io.BytesIO()
    with Image.open(picture) as image:
        image.convert("RGB").save(content, "webp", quality=82)
    return f"data:image/webp;base64,{base64.b64encode(content.getvalue()).decode('ascii')}"


def _method() -> str:
    return (_HERE / "method.md").read_text(encoding="utf-8").strip()


def _rows(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(_escaped, line))} |" for line in lines)


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*")


def _bullets(lines: Iterable[str]) -> str:
    return "\n".join(f"- {_escaped(line)}" for line in lines)


def _verdicts(report: Report, name: Callable[[str], str]) -> str:
    """Return how many verdicts there are of each kind, and all of them."""
    rows = [(name(one), title, str(v.word), v.reason) for one, title, v in report.verdicts]
    rows += [(name(one.name), one.text, one.verdict, one.brief) for one in report.conclusions]
    count = counted(v for one, _, v in report.verdicts if not one.startswith("X"))
    return f"**Tables and figures: {count}.**\n\n{_rows(('', '', 'verdict', 'reason'), rows)}"


def _table(one: Table) -> str:
    title = f"## {one.name}: {one.title}"
    return f"{title}\n\n{_rows(one.head, one.rows)}\n\n{_bullets(one.notes)}"


def _picture(figure: Figure) -> str:
    title = f"## {figure.name}: {figure.title}"
    return f"{title}\n\n![{figure.title}](figures/{figure.name}.png)\n\n{figure.panels}."


def _figure(figure: Figure, verdict: Verdict) -> str:
    links = " ".join(f"[{kind}](figures/{figure.name}.{kind.lower()})" for kind in ("PNG", "PDF"))
    words = f"**{verdict.word}.** {verdict.reason} {links}"
    return f"{_picture(figure)}\n\n{words}\n\n{_details(figure.name, verdict)}"


def _statements(
    judged: Iterable[tuple[str, Sequence[Statement]]], cell: Callable[[Finding], str]
) -> str:
    """Return numbered statements with their findings, as ``cell`` writes them."""
    rows = [
        (f"{name}.{n}", one.text, *(cell(f) if f else "does not apply" for f in one[1:]))
        for name, statements in judged
        for n, one in enumerate(statements, 1)
    ]
    return _rows(("", "statement", "paper's grid", "converged"), rows)


def _truth(found: Finding) -> str:
    return "true" if found.holds else "false"


def _numbers(found: Finding) -> str:
    return f"{_truth(found)}: {found.numbers}"


def _details(name: str, verdict: Verdict) -> str:
    return _folded("statements", _statements([(name, verdict.statements)], _numbers))


def _folded(title: str, text: str) -> str:
    return f"<details><summary>{title}</summary>\n\n{text}\n\n</details>"


def _conclusion(one: Conclusion) -> str:
    verdict = f"{one.verdict}; {one.brief}" if one.brief else one.verdict
    statements = _statements([(one.name, one.statements)], _numbers)
    return f"## {one.name}\n\n> {one.text}\n\n**{verdict}**\n\n{statements}"


def _runs(runs: Runs) -> str:
    """Return how all runs ended, and why some did not converge, folded."""
    keys = ("outcome", "grid", "domain", "cycles", "residual", "change", "load_error", "seconds")
    head = ("run", "outcome", "grid", "domain", "cycles", "residual", "change", "load error", "s")
    known = runs.store.rows(runs.cases)
    rows, reasons = [], []
    for case in runs.cases:
        run = runs.numbers.get(case.key, {})
        rows.append([case.name, *(_shown(run.get(key, "")) for key in keys)])
        if case.key in known and not run.get("ok"):
            reasons.append(f"{case.name}: {known[case.key].message}")
    seconds = sum(row.cost.cpu_seconds for row in known.values())
    every, failed = (
        _folded("all runs", _rows(head, rows)),
        _folded("why some did not converge", _bullets(reasons)),
    )
    return f"{RUNS.format(version=tehl.__version__, seconds=seconds)}\n\n{every}\n\n{failed}"


def _shown(value: object) -> str:
    return f"{value:.2g}" if isinstance(value, float) else str(value)
