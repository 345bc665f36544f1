"""Parts of a page that needs nothing else: style, sections, tables."""

from collections.abc import Iterable, Sequence
from html import escape

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.45 system-ui, sans-serif; color: #1b1f24; max-width: 62rem;
       margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.5rem; margin: .2rem 0 .6rem; }
h2 { font-size: 1.1rem; margin: 1.8rem 0 .5rem; border-bottom: 1px solid #d0d7de; }
.status { padding: .5rem .8rem; border-radius: .3rem; font-weight: 600; }
.good { background: #dafbe1; color: #0b4a1d; }
.bad { background: #b3001b; color: #fff; }
.status p { margin: .3rem 0 0; font-weight: 400; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem .2rem 0; text-align: left; vertical-align: top;
         border-bottom: 1px solid #eaeef2; }
th { font-weight: 600; }
td.number { text-align: right; white-space: nowrap; }
.pictures { display: grid; gap: 2rem; grid-template-columns: minmax(0, 1fr); }
figure { margin: 0; min-width: 0; break-inside: avoid; }
img { max-width: 100%; height: auto; }
h1, .status { overflow-wrap: anywhere; }
td.text { max-width: 26rem; overflow-wrap: break-word; }
h3 { font-size: .95rem; margin: 1rem 0 .2rem; }
figcaption, .small { font-size: .85rem; color: #57606a; }
pre { white-space: pre-wrap; font-size: .85rem; }
@media (min-width: 90rem) { body { max-width: 84rem; }
               .pictures { grid-template-columns: repeat(2, minmax(0, 1fr)); } }
@media (max-width: 40rem) { body { padding: .6rem; font-size: 14px; }
               th, td { padding-right: .5rem; } td.text { max-width: 60vw; } }
@media print { body { font-size: 11px; max-width: none; padding: 0; }
               h2 { break-after: avoid; } tr { break-inside: avoid; } }
"""
"""Style sheet of a page."""


def section(title: str, body: str) -> str:
    """Return a section under a heading; both are HTML."""
    return f"<section>\n<h2>{title}</h2>\n{body}\n</section>\n"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; cells that begin like numbers are set to the right."""
    lines = [f"<tr>{''.join(f'<th>{escape(cell)}</th>' for cell in head)}</tr>"]
    lines += [f"<tr>{''.join(_cell(cell) for cell in row)}</tr>" for row in rows]
    return f'<div class="wide"><table>\n{chr(10).join(lines)}\n</table></div>'


def _cell(text: str) -> str:
    number = text[:1].isdigit() or text[:2].lstrip("-+±").isdigit()
    return f"<td class={'number' if number else 'text'}>{escape(text)}</td>"
