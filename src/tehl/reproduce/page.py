"""What was found as one page that needs nothing else."""

import base64
from html import escape
from pathlib import Path

from tehl.reproduce.draw.gallery import SMALL
from tehl.reproduce.findings import Drawn, Findings
from tehl.reproduce.judge import Check, Finding, Verdict
from tehl.reproduce.parts import STYLE, section, table
from tehl.reproduce.propositions import Proposition
from tehl.reproduce.tables import Table
from tehl.reproduce.words import MEANING, RUNS, SETS, TREATMENTS, counted, run_cells

_MORE = """
.verdict { display: inline-block; padding: .05rem .5rem; border-radius: .8rem; font-weight: 600;
           white-space: nowrap; font-size: .85rem; }
.reproduced, .true { background: #dafbe1; color: #0b4a1d; }
.trend { background: #fff1c2; color: #5c4300; }
.cannot, .false { background: #ffdcd7; color: #7d1108; }
.summary td { vertical-align: middle; }
details { margin: .4rem 0 1rem; } summary { cursor: pointer; color: #57606a; font-size: .85rem; }
blockquote { margin: .2rem 0 .5rem; padding-left: .8rem; border-left: 3px solid #d0d7de;
             color: #57606a; }
li { margin: .15rem 0; } figure { margin: 1.4rem 0 .4rem; } img { width: 100%; }
nav a { margin-right: .8rem; } a { color: #0a58a8; }
@media print { details > *:not(summary) { display: block; } figure { break-inside: avoid; }
               nav { display: none; } }
"""
_CLASSES = {"reproduced": "reproduced", "trend only": "trend", "cannot be": "cannot"}


def page(found: Findings, folder: Path) -> str:
    """Return the page.

    Parameters
    ----------
    found : Findings
        What it tells.
    folder : Path
        Where the figures are.
    """
    parts = [
        section("At a glance", _glance(found)),
        section("Tables", "\n".join(_table(one) for one in found.tables)) if found.tables else "",
        section("Figures", "\n".join(_figure(one, folder) for one in found.figures))
        if found.figures
        else "",
        section("Conclusions", "\n".join(_proposition(one) for one in found.propositions))
        if found.propositions
        else "",
        section("Where the numbers come from", _provenance(found)),
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>The founding paper, reproduced</title>\n<style>{STYLE}{_MORE}</style>\n</head>\n"
        "<body>\n<h1>The founding paper, reproduced and judged</h1>\n"
        f"<p>{escape(found.citation)}.</p>\n{''.join(parts)}</body>\n</html>\n"
    )


def _glance(found: Findings) -> str:
    told = "".join(f"<p>{escape(text)}</p>" for text in (TREATMENTS, SETS, MEANING))
    rows = [
        _row(one.name, f"Table {one.name[1:]}: {one.title}", _badge(one.verdict), one.verdict.why)
        for one in found.tables
    ]
    rows += [
        _row(
            one.spec.name,
            f"{one.spec.label}: {one.spec.title}",
            _badge(one.verdict),
            one.verdict.why,
        )
        for one in found.figures
    ]
    rows += [
        _row(one.name, _title(one), _truth(one.verdict), one.told) for one in found.propositions
    ]
    return (
        f"{told}<p><b>{escape(counted(found))}</b></p>"
        f'<div class="wide"><table class="summary">{"".join(rows)}</table></div>'
    )


def _row(name: str, title: str, badge: str, why: str) -> str:
    return (
        f'<tr><td><a href="#{name}">{name}</a></td><td class="text">{escape(title)}</td>'
        f'<td>{badge}</td><td class="text">{escape(why)}</td></tr>'
    )


def _badge(verdict: Verdict) -> str:
    return f'<span class="verdict {_CLASSES[verdict.word]}">{verdict.word}</span>'


def _truth(verdict: str) -> str:
    kind = {"true": "true", "false": "false"}.get(verdict, "trend")
    word = verdict if kind != "trend" else "only if"
    return f'<span class="verdict {kind}">{word}</span>'


def _title(one: Proposition) -> str:
    return f"Conclusion {one.name[1:]}" if one.name.startswith("C") else f"Added: {one.text}"


def _table(one: Table) -> str:
    notes = "".join(f"<li>{escape(note)}</li>" for note in one.notes)
    return (
        f'<h3 id="{one.name}">Table {one.name[1:]}. {escape(one.title)} {_badge(one.verdict)}</h3>'
        f"<p>{escape(one.verdict.why)}</p>{table(one.head, one.rows)}"
        f"<ol class=small>{notes}</ol>{_checks(one.verdict)}"
    )


def _figure(one: Drawn, folder: Path) -> str:
    name, spec = one.spec.name, one.spec
    content = base64.b64encode((folder / SMALL / f"{name}.webp").read_bytes()).decode("ascii")
    caption = f"{spec.label}. {spec.title}: {one.panels}."
    return (
        f'<figure id="{name}"><img alt="{escape(caption)}" loading="lazy" '
        f'src="data:image/webp;base64,{content}"><figcaption>{escape(caption)} '
        f'<a href="figures/{name}.png">PNG</a> '
        f'<a href="figures/{name}.pdf">PDF</a></figcaption></figure>'
        f"<p>{_badge(one.verdict)} {escape(one.verdict.why)}</p>{_checks(one.verdict)}"
    )


def _checks(verdict: Verdict) -> str:
    """Return the statements behind a verdict, folded away."""
    rows = "".join(_check(one) for one in verdict.checks)
    return (
        "<details><summary>what it was judged by</summary>"
        f'<div class="wide"><table><tr><th>statement</th><th>on the paper\'s grid</th>'
        f"<th>converged</th></tr>{rows}</table></div></details>"
    )


def _check(one: Check) -> str:
    cells = "".join(_finding(found) for found in (one.paper, one.converged))
    return f'<tr><td class="text">{escape(one.statement)}</td>{cells}</tr>'


def _finding(found: Finding | None) -> str:
    if found is None:
        return '<td class="text">does not apply</td>'
    word = "true" if found.holds else "false"
    return f'<td class="text">{_truth(word)} {escape(found.numbers)}</td>'


def _proposition(one: Proposition) -> str:
    lines = "".join(f"<li>{escape(line)}</li>" for line in one.numbers)
    return (
        f'<h3 id="{one.name}">{one.name} {_truth(one.verdict)}</h3>'
        f"<blockquote>{escape(one.text)}</blockquote><p><b>{escape(one.told)}</b></p>"
        f"<ul class=small>{lines}</ul>"
    )


def _provenance(found: Findings) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in sorted(found.versions.items()))
    told = (
        f"<p>{escape(versions)}. Runs made {escape(found.made[0])} to {escape(found.made[1])}; "
        f"{found.solving:.0f} s of one processor for all solves. This run of the command took "
        f"{found.seconds:.0f} s and found {found.reused} of {len(found.runs)} runs finished.</p>"
        f"<p class=small>{escape(RUNS)}</p>"
    )
    head = ("run", "outcome", "grid", "domain", "cycles", "residual", "change", "load error", "s")
    rows = [run_cells(one) for one in found.runs]
    why = "".join(
        f"<li>{escape(one.name)}: {escape(one.why)}</li>" for one in found.runs if one.why
    )
    return (
        f"{told}<details><summary>all runs</summary>{table(head, rows)}</details>"
        f"<details><summary>runs that are no converged answer, and why</summary><ul class=small>"
        f"{why}</ul></details>"
    )
